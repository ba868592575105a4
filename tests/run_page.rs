#![allow(clippy::unwrap_used, reason = "a test may panic")]
//! x
mod journal;
#[test]
fn look() {
    for world in ["shape-6", "shape-8", "building-12", "building-25"] {
        let journal = journal::journal(world, pictures());
        let svg = toposlam::picture::run_svg(&journal);
        println!(
            "{world}: rounds {} calls {} maps {} story {} svg {} {:?}",
            journal.rounds.len(),
            journal.calls.len(),
            journal.maps.len(),
            journal.story.len(),
            svg.len(),
            journal.ending
        );
        std::fs::write(format!("/tmp/page-{world}.html"), toposlam::page::run_page(&journal))
            .unwrap();
        std::fs::write(format!("/tmp/page-{world}.png"), toposlam::picture::png(&svg).unwrap())
            .unwrap();
    }
}

fn pictures() -> Vec<Vec<u8>> {
    let jpeg = |shade: u8| {
        let image =
            image::RgbImage::from_fn(64, 48, |x, y| image::Rgb([shade, 4 * x as u8, 5 * y as u8]));
        let mut file = std::io::Cursor::new(Vec::new());
        image.write_to(&mut file, image::ImageFormat::Jpeg).unwrap();
        file.into_inner()
    };
    [60, 120, 200].map(jpeg).to_vec()
}
