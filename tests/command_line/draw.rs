//! What a camera sees, drawn by `toposlam draw --pose`. Most facts are in `tests/facts/draw.txt`.

use toposlam_vision::camera::{Camera, calibration};

use super::Scratch;

#[test]
fn the_image_is_that_of_the_calibrated_camera() {
    let scratch = Scratch::new("draw-calibration");
    let camera = Camera::superscout().sized([800, 600]);
    scratch.write("camera.toml", calibration::to_toml(&camera));
    let render = |options: &str| {
        scratch.out(&format!("draw worlds/shape-8.toml --pose start --out v.png {options}"), 0);
        image::open(scratch.path("v.png")).unwrap().into_rgb8()
    };
    assert_eq!(render("").dimensions(), (1280, 960));
    assert_eq!(render("--calibration camera.toml").dimensions(), (800, 600));
    // The same camera with another image size.
    let one = render("--calibration camera.toml --size 640x480");
    let other = render("--size 640x480");
    assert_eq!(one.dimensions(), (640, 480));
    // The labels of the pixels have four colours: floor, stripe, other, and what does not count.
    scratch
        .out("draw worlds/shape-8.toml --pose start --size 640x480 --out v.png --labels l.png", 0);
    let labels = image::open(scratch.path("l.png")).unwrap().into_rgb8();
    for colour in [[0, 255, 0], [255, 0, 0], [0, 0, 0], [255, 255, 255]] {
        assert!(labels.pixels().any(|pixel| pixel.0 == colour), "{colour:?}");
    }
    let off = one.iter().zip(other.iter()).filter(|(one, other)| one.abs_diff(**other) > 2);
    assert!(off.count() < 5000);
}
