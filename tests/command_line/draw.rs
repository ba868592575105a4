//! `toposlam draw`, pictures of worlds and of what a camera sees in a floor plan; and the pages of `toposlam play`.

use std::collections::BTreeSet;

use image::ImageFormat;
use serde_json::Value;
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
    assert_eq!((labels.width(), labels.height()), (640, 480));
    assert!(first == render("--pose start --look laboratory --seed 0"));
    // The start is at nw, and facing w, to the south: the robot looks north.
    assert!(first == render("--pose 0,8,90"));
    assert!(first[0] != render("--pose start --seed 1")[0]);
    assert!(first[0] != render("--pose start --effect blur=2")[0]);
    assert!(first != render("--pose start --effects none"));
    // At the start the robot stands on the marker and hides it.
    assert!(render("--pose 0.8,8,90")[1] != render("--pose 0.8,8,90 --with-marker")[1]);

    // The image is that of the calibrated camera.
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

#[test]
fn a_random_world_is_the_same_for_the_same_seed_and_each_start_may_be_one() {
    let scratch = Scratch::new("play_random");
    let random = |options: &str| {
        let page = scratch.out(&format!("play --random {options}"), 0);
        let (_, data) = page.split_once("id=\"data\">").unwrap();
        data.split_once("</script>").unwrap().0.to_owned()
    };
    assert_eq!(random("--seed 5"), random("--seed 5"));
    let seeds: BTreeSet<_> =
        (0..60).map(|n| random(&format!("--edges 2 --class multigraph --seed {n}"))).collect();
    // A000698: there are 10 starts with 2 edges.
    assert_eq!(seeds.len(), 10);
    let largest: Value = serde_json::from_str(&random("--edges 8")).unwrap();
    let world = largest["world"].as_array().unwrap();
    assert_eq!(world.iter().map(|vertex| vertex.as_array().unwrap().len()).sum::<usize>(), 16);

    let play = "play worlds/shape-6.toml --start tee:sw";
    let printed = scratch.out(play, 0);
    assert_eq!(scratch.out(&format!("{play} -o play.html"), 0), "");
    assert_eq!(scratch.text("play.html"), printed);
    let line = |v: usize| format!("v{v} = [\"v{}\", \"v{}\"]\n", (v + 100) % 101, (v + 1) % 101);
    scratch.write("long.toml", format!("[clockwise]\n{}", (0..101).map(line).collect::<String>()));
    facts! { scratch;
        "play long.toml" => 2 "long.toml: it has 101 vertices; a page can have 100 vertices";
    }
}
