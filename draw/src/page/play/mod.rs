//! A page on which a person is the robot: it shows percepts only, and judges the person's map at the end. The
//! person is compared with Algorithm 1, with the folding explorer and with the certificate. Sections 2.1 and
//! 2.3.

mod data;

use toposlam_model::{
    embedded_graph::Dart,
    format::named_world::NamedWorld,
    marker::{Directional, Marker},
};

use super::{PAGE_SCRIPT, PAGE_STYLE, template::filled};
use crate::picture::{WorldPicture, escaped, svg};

const PAGE: &str = include_str!("../browser/play.html");
/// In the order of their dependencies; they share one scope.
const SCRIPT: [&str; 8] = [
    PAGE_SCRIPT,
    include_str!("../browser/percepts.js"),
    include_str!("../browser/play_map.js"),
    include_str!("../browser/play_judge.js"),
    include_str!("../browser/play_layout.js"),
    include_str!("../browser/play_drawing.js"),
    include_str!("../browser/play_here.js"),
    include_str!("../browser/play.js"),
];

/// The page as an HTML document: the robot starts by this dart. The same start gives the same bytes.
pub fn play_page(world: &NamedWorld, facing: Dart) -> String {
    let (title, caption, marker) = ("", "", &Directional as &dyn Marker);
    let start = Some(facing);
    let drawn = WorldPicture { start, marker, title, caption, ..WorldPicture::from(world) };
    filled(
        PAGE,
        &[
            ("style", PAGE_STYLE),
            ("name", &escaped(&world.name)),
            ("picture", &svg(&drawn)),
            ("marker", &escaped(&drawn.marker_place().unwrap_or_default())),
            ("data", &data::json(world, facing)),
            ("script", &SCRIPT.concat()),
        ],
    )
}

#[cfg(test)]
mod tests {
    use serde_json::json;
    use toposlam_model::{embedded_graph::EmbeddedGraph, folding};

    use super::*;
    use crate::page::template::checks::{NASTY, assert_escaped, data_of};

    /// An edge with a loop at its end; the start is the other end.
    fn world(name: &str) -> NamedWorld {
        let lists = [("a", vec!["e"]), ("b", vec!["e", "l", "l"])];
        let graph = EmbeddedGraph::from_edge_lists(&lists).unwrap();
        NamedWorld::numbered(name, "", graph, Some(Dart(0)))
    }

    #[test]
    fn the_data_is_the_world_and_the_walks_to_compare_with() {
        let world = world("loop");
        let data = data_of(&play_page(&world, Dart(0)));
        assert_eq!(data["world"], json!([[[1, 0]], [[0, 0], [1, 2], [1, 1]]]));
        assert_eq!(data["start"], json!([0, 0]));
        let walks = data["walks"].as_array().unwrap();
        let names: Vec<_> = walks.iter().map(|walk| walk["name"].as_str().unwrap()).collect();
        assert_eq!(names, ["Certificate", "Folding explorer", "Algorithm 1"]);
        // Over the edge, around the loop, and back: the marker is seen again.
        let certificate = folding::certificate(&world.graph, Dart(0));
        assert_eq!(walks[0]["doors"].as_array().unwrap().len(), certificate.len());
        assert_eq!(walks[0]["doors"], json!([0, 1, 1]));
        for walk in walks {
            assert!(walk["doors"].as_array().unwrap().len() >= certificate.len(), "{walk}");
        }
        assert_eq!(data_of(&play_page(&world, Dart(2)))["start"], json!([1, 1]));
    }

    #[test]
    fn names_are_escaped_everywhere() {
        let document = play_page(&world(NASTY), Dart(0));
        assert_escaped(&document);
        assert_eq!(document, play_page(&world(NASTY), Dart(0)));
    }
}
