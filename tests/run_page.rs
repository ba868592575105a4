//! The picture and the page of a simulated run. Section 6, Figure 11.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::{fs, io::Cursor, path::Path};

use toposlam_draw::{
    page::run_page,
    picture::{png, run_svg},
};

use crate::{browser, run_page_data};

/// A few small images.
fn images() -> Vec<Vec<u8>> {
    let jpeg = |shade: u8| {
        let pixel = |x, y| image::Rgb([shade, 4 * x as u8, 5 * y as u8]);
        let mut file = Cursor::new(Vec::new());
        let image = image::RgbImage::from_fn(64, 48, pixel);
        image.write_to(&mut file, image::ImageFormat::Jpeg).unwrap();
        file.into_inner()
    };
    [60, 120, 200].map(jpeg).to_vec()
}

#[test]
fn the_picture_of_a_run_shows_its_whole_path_and_every_call() {
    let run_data = run_page_data::run_page_data("shape-6", Vec::new());
    assert_eq!(run_data.ending, "the map is right");
    let svg = run_svg(&run_data);
    let lists = svg.split(" points=\"").skip(1).map(|rest| rest.split('"').next().unwrap());
    let points: Vec<_> = lists.map(|list| list.split(' ').count()).collect();
    // Two pieces of the path share a point.
    assert_eq!(points.iter().sum::<usize>(), run_data.rounds.len() + points.len() - 1);
    assert_eq!(svg.matches("class=\"call\"").count(), run_data.calls.len());
    assert_eq!(svg.matches("class=\"call wrong\"").count(), 0);
    for junction in run_data.plan.junctions() {
        assert!(svg.contains(&format!(">{}</text>", junction.name)));
    }
    assert!(svg.contains(">the map is right</text>"));
    assert_eq!(svg, run_svg(&run_page_data::run_page_data("shape-6", Vec::new())), "the same seed");
    assert!(png(&svg).is_ok());
}

#[test]
fn the_page_of_a_run_follows_it_to_its_end() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let write = |name: &str, page: &str| {
        let file = folder.join(format!("run-{name}.html"));
        fs::write(&file, page).unwrap();
        file
    };
    let run = run_page_data::run_page_data("shape-6", images());
    let mut wrong = run.clone();
    wrong.calls[3].conforms = false;
    let mut empty = run.clone();
    empty.rounds.clear();
    empty.calls.clear();
    let mut blind = run.clone();
    blind.rounds.iter_mut().for_each(|round| round.image = None);
    let large = run_page_data::run_page_data("building-25", Vec::new());
    let pages =
        [("right", run), ("wrong", wrong), ("blind", blind), ("large", large), ("empty", empty)]
            .map(|(name, run_data)| {
                format!("{name}={}", write(name, &run_page(&run_data)).display())
            });
    browser::open("run_page.mjs", &pages);
}
