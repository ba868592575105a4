//! `toposlam draw`: pictures of worlds, and of what a camera sees in a floor plan.

use image::ImageFormat;
use toposlam_vision::camera::{Camera, calibration};

use super::Scratch;

#[test]
fn the_extension_of_the_file_decides_the_format_and_svg_is_the_default() {
    let scratch = Scratch::new("draw");
    let svg = scratch.out("draw worlds/shape-6.toml", 0);
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
    for (option, name) in [("--out", "w.svg"), ("-o", "w.png")] {
        assert_eq!(scratch.out(&format!("draw worlds/shape-6.toml {option} {name}"), 0), "");
    }
    assert_eq!(scratch.text("w.svg"), svg);
    assert!(scratch.bytes("w.png").starts_with(b"\x89PNG\r\n\x1a\n"));
    scratch.out("draw worlds/shape-8.toml --pose start --out view.jpg", 0);
    let bytes = scratch.bytes("view.jpg");
    let picture = image::load_from_memory_with_format(&bytes, ImageFormat::Jpeg).unwrap();
    assert_eq!((picture.width(), picture.height()), (1280, 960));
}

#[test]
fn the_same_pose_has_the_same_image() {
    let scratch = Scratch::new("draw-same");
    let render = |options: &str| -> [Vec<u8>; 2] {
        let files = "--size 640x480 --out view.png --labels labels.png";
        assert_eq!(scratch.out(&format!("draw worlds/shape-8.toml {files} {options}"), 0), "");
        ["view.png", "labels.png"].map(|name| scratch.bytes(name))
    };
    let first = render("--pose start");
    let labels = image::load_from_memory_with_format(&first[1], ImageFormat::Png).unwrap();
    let labels = labels.into_rgb8();
    assert_eq!(labels.dimensions(), (640, 480));
    for colour in [[0, 255, 0], [255, 0, 0], [0, 0, 0], [255, 255, 255]] {
        assert!(labels.pixels().any(|pixel| pixel.0 == colour), "{colour:?}");
    }
    assert!(first == render("--pose start --look laboratory --seed 0"));
    // The start is at nw, and facing w, to the south: the robot looks north.
    assert!(first == render("--pose 0,8,90"));
    assert!(first[0] != render("--pose start --seed 1")[0]);
    assert!(first[0] != render("--pose start --effect blur=2")[0]);
    assert!(first != render("--pose start --effects none"));
    // At the start the robot stands on the marker and hides it.
    assert!(render("--pose 0.8,8,90")[1] != render("--pose 0.8,8,90 --with-marker")[1]);
}

#[test]
fn the_image_is_that_of_the_calibrated_camera() {
    let scratch = Scratch::new("draw-calibration");
    let camera = Camera::superscout().sized([800, 600]);
    scratch.write("camera.toml", calibration::to_toml(&camera));
    let render = |options: &str| {
        scratch.out(&format!("draw worlds/shape-8.toml --pose start --out v.png {options}"), 0);
        image::open(scratch.path("v.png")).unwrap().into_rgb8()
    };
    assert_eq!(render("--calibration camera.toml").dimensions(), (800, 600));
    // The same camera with another image size.
    let one = render("--calibration camera.toml --size 640x480");
    let other = render("--size 640x480");
    assert_eq!(one.dimensions(), (640, 480));
    let off = one.iter().zip(other.iter()).filter(|(one, other)| one.abs_diff(**other) > 2);
    assert!(off.count() < 5000);
}
