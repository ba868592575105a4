//! A page that shows the run of a simulated robot step by step: where it was, its camera image, its map,
//! and the story of the mapping algorithm. Section 6, Figure 11.

mod data;
mod folding;
mod words;

use super::{PAGE_SCRIPT, PAGE_STYLE, template::filled};
use crate::{
    picture::{OpenGraph, escaped, growth, run_drawing},
    run_page_data::RunPageData,
};

const PAGE: &str = include_str!("../browser/run.html");
/// The panel of the images.
const CAMERA: &str = include_str!("../browser/camera.html");
/// What Algorithm 2 sees and does.
const DRIVING: &str = include_str!("../browser/driving.html");
/// In the order of their dependencies; they share one scope.
const SCRIPT: [&str; 4] = [
    PAGE_SCRIPT,
    include_str!("../browser/floor.js"),
    include_str!("../browser/trail.js"),
    include_str!("../browser/run.js"),
];

/// The page of a run as an HTML document. The same run gives the same bytes.
pub fn run_page(run_data: &RunPageData) -> String {
    let drawn = run_drawing(run_data);
    let has_images = run_data.rounds.iter().any(|round| round.image.is_some());
    let (layout, camera) = if has_images { ("", CAMERA) } else { (" no-camera", "") };
    let driving = if run_data.has_scenes() { DRIVING } else { "" };
    filled(
        PAGE,
        &[
            ("title", &escaped(&run_data.world.name)),
            ("about", &escaped(&words::about(run_data))),
            ("style", PAGE_STYLE),
            ("layout", layout),
            ("plan", &drawn.svg),
            ("camera", camera),
            ("driving", driving),
            ("maps", &maps(run_data)),
            ("data", &data::json(run_data, &drawn)),
            ("script", &SCRIPT.concat()),
        ],
    )
}

/// Every map, each in its own element; the page shows one of them.
fn maps(run_data: &RunPageData) -> String {
    let of = |svg: &String| format!("<div class=\"stage\" tabindex=\"0\" hidden>\n{svg}</div>\n");
    let maps = run_data.maps(usize::MAX).map(OpenGraph::from);
    let moves = run_data.aid.moves();
    let maps = maps.map(|map| if moves { map.without_marker() } else { map });
    let maps: Vec<_> = maps.collect();
    growth(&maps).iter().map(of).collect()
}

/// Rounded to tenths.
fn rounded(number: f64) -> f64 {
    (number * 10.0).round() / 10.0 + 0.0
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};
    use toposlam_model::aid::{AidKind, team::PAIR};

    use super::*;
    use crate::{
        page::template::checks::{NASTY, assert_escaped, data_of},
        picture::example,
    };

    #[test]
    fn names_are_escaped_everywhere() {
        let mut run_data = example::run_page_data();
        for text in [&mut run_data.world.name, &mut run_data.ending] {
            NASTY.clone_into(text);
        }
        let document = run_page(&run_data);
        assert_escaped(&document);
        assert!(data_of(&document)["story"][0].as_str().unwrap().contains(NASTY));
    }

    #[test]
    fn an_image_that_stays_the_same_is_stored_once() {
        let document = run_page(&example::run_page_data());
        let data = data_of(&document);
        let shown: Vec<_> = (0..7).map(|at| data["rounds"][at]["image"].clone()).collect();
        assert_eq!(Value::from(shown), json!([null, 0, 1, 2, 3, 3, 3]));
        assert_eq!(data["images"][3], "data:image/jpeg;base64,BAQE");
        assert_eq!(document.matches("image/jpeg").count(), 4);
    }

    #[test]
    fn a_run_without_images_has_no_camera_panel() {
        let mut run_data = example::run_page_data();
        let camera = "<figure class=\"panel camera\">";
        assert!(run_page(&run_data).contains(camera));
        run_data.rounds.iter_mut().for_each(|round| round.image = None);
        let page = run_page(&run_data);
        assert!(!page.contains(camera) && !page.contains("No image was kept"));
        assert!(page.contains("<div class=\"run no-camera\">"));
    }

    /// A robot that drives by scans makes no scenes, and has no state of Algorithm 2.
    #[test]
    fn a_run_without_scenes_shows_no_state_of_algorithm_2() {
        let mut run_data = example::run_page_data();
        let state = "<dd class=\"state\">";
        assert!(run_page(&run_data).contains(state));
        run_data.rounds.iter_mut().for_each(|round| round.scene = None);
        let page = run_page(&run_data);
        assert!(!page.contains(state));
        let round = &data_of(&page)["rounds"][1];
        assert!(["state", "scene", "command"].iter().all(|key| round.get(key).is_none()));
    }

    #[test]
    fn the_data_has_each_frame() {
        let run_data = example::run_page_data();
        let data = data_of(&run_page(&run_data));
        let round = &data["rounds"][1];
        let field = |key: &str| round[key].clone();
        assert_eq!(field("time"), "0:02.5");
        assert_eq!(field("turn"), -90.0);
        assert_eq!(field("state"), "in a hallway");
        assert_eq!(field("command"), "go 0.50 m ahead");
        assert_eq!((field("moves"), field("story"), field("maps")), (json!(1), json!(2), json!(1)));
        assert_eq!(field("scene"), "unknown: no-floor");
        assert_eq!(data["calls"][2], json!({"rounds": 7, "percept": "3 doors", "conforms": false}));
        // The last frame has the whole story, with what came after it.
        assert_eq!(data["rounds"][6]["story"], data["story"].as_array().unwrap().len());
        assert_eq!(data["rounds"][6]["maps"], run_data.maps(usize::MAX).count());
    }

    /// The other robot waits 0.5 m north of the corner, and then 0.5 m south of the northern dead end.
    #[test]
    fn a_marking_aid_that_moves_is_shown_where_it_is() {
        let mut run_data = example::run_page_data();
        let fixed = run_page(&run_data);
        assert!(data_of(&fixed)["rounds"][0].get("aid").is_none());
        run_data.aid = AidKind::Team(PAIR);
        let graph = run_data.plan.graph();
        let far = graph.opposite(run_data.facing);
        let places = [Some(run_data.facing), Some(far), None];
        for (round, place) in run_data.rounds.iter_mut().zip(places) {
            round.aid = place;
        }
        let data = data_of(&run_page(&run_data));
        let round = |at: usize| &data["rounds"][at];
        let number = |value: &Value| value.as_f64().unwrap();
        let [here, there] = [0, 1].map(|at| &round(at)["aid"]);
        let metre = 70.0;
        let between = number(&here["y"]) - number(&there["y"]);
        assert!((between - 3.0 * metre).abs() < 0.2, "{between}");
        assert_eq!([&here["turn"], &there["turn"]], [-90.0, 90.0]);
        assert!((number(&round(0)["y"]) - number(&here["y"]) - 0.5 * metre).abs() < 0.2);
        assert_eq!(round(2)["aid"], Value::Null);
        assert_eq!(data["trail"], Value::Null);
    }

    #[test]
    fn the_same_run_gives_the_same_page_with_all_its_maps() {
        let run_data = example::run_page_data();
        let document = run_page(&run_data);
        assert_eq!(document, run_page(&run_data));
        assert_eq!(document.matches("class=\"stage\"").count(), run_data.maps(usize::MAX).count());
    }
}
