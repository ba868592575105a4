//! `toposlam simulate`. Most facts are in `tests/facts/simulate.txt`.

use super::Scratch;

#[test]
fn a_camera_that_sees_nothing_is_refused() {
    let scratch = Scratch::new("simulate_bad");
    let camera = "[camera]\nkind = \"spherical-mirror\"\nimage = [640, 480]\ncentre = [320.0, 240.0]\n\
         focal = 636.4\nmirror_radius = 0.05\nmirror_distance = 0.15\ncamera_height = 0.9\n\
         ahead = 90.0\nseen_from = \"below\"\nmask = \"dark.png\"\n";
    scratch.write("camera.toml", camera);
    image::GrayImage::new(640, 480).save(scratch.path("dark.png")).unwrap();
    facts! { scratch; "simulate worlds/shape-6.toml --calibration camera.toml" => 2 ""; }
}

/// Far too long to end by itself. Its first line shows that it is at work.
#[cfg(unix)]
#[test]
fn an_interrupted_run_reports_its_results_and_is_incomplete() {
    let run = "simulate worlds/building-25.toml --start north-west:west-upper";
    let text = super::interrupted_after_a_line(run);
    assert!(text.contains("The robot gave up: the run was ended on move "), "{text}");
    assert!(text.contains("  map               "), "{text}");
}
