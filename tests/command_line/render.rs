//! `toposlam draw PLAN --pose`.

use std::fs;

use image::{ImageFormat, RgbImage};
use toposlam_vision::camera::{Camera, calibration};

use super::{folder, names_in, run, stderr, stdout_of};

const PLAN: &str = "worlds/shape-8.toml";
const START: &[&str] = &["--pose", "start"];

fn rejected(arguments: &[&str], message: &str) {
    let output = run([&["draw"], arguments].concat());
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    assert!(stderr(&output).contains(message), "{}", stderr(&output));
}

#[test]
fn the_same_command_writes_the_same_files() {
    let folder = folder("render-same");
    let render = |name: &str, more: &[&str]| -> [Vec<u8>; 2] {
        let files = ["png", "labels.png"].map(|ending| folder.join(format!("{name}.{ending}")));
        let [out, labels] = files.each_ref().map(|file| file.to_str().unwrap());
        let small = ["draw", PLAN, "--size", "640x480", "--out", out, "--labels", labels];
        assert_eq!(stdout_of([&small, more].concat()), "");
        files.map(|file| fs::read(file).unwrap())
    };
    let first = render("first", START);
    assert!(first == render("again", &[START, &["--look", "laboratory", "--seed", "0"]].concat()));
    // The start is at nw, and facing w, to the south: the robot looks north.
    assert!(first == render("there", &["--pose", "0,8,90"]));
    assert!(first[0] != render("other-seed", &[START, &["--seed", "1"]].concat())[0]);
    assert!(first[0] != render("effect", &[START, &["--effect", "blur=2"]].concat())[0]);
    // At the start the robot stands on the marker and hides it.
    let aside = ["--pose", "0.8,8,90"];
    assert!(
        render("aside", &aside)[1]
            != render("marked", &[&aside[..], &["--with-marker"]].concat())[1]
    );
    let plain = render("plain", &[START, &["--effects", "none"]].concat());
    assert!(plain != first);
    let labels = image::load_from_memory_with_format(&first[1], ImageFormat::Png).unwrap();
    let labels: RgbImage = labels.into_rgb8();
    assert_eq!(labels.dimensions(), (640, 480));
    for colour in [[0, 255, 0], [255, 0, 0], [0, 0, 0], [255, 255, 255]] {
        assert!(labels.pixels().any(|pixel| pixel.0 == colour), "{colour:?}");
    }
}

#[test]
fn the_ending_of_the_name_selects_jpeg() {
    let folder = folder("render-jpeg");
    let out = folder.join("view.jpg");
    stdout_of(["draw", PLAN, "--pose", "start", "--out", out.to_str().unwrap()]);
    let bytes = fs::read(out).unwrap();
    let picture = image::load_from_memory_with_format(&bytes, ImageFormat::Jpeg).unwrap();
    assert_eq!((picture.width(), picture.height()), (1280, 960));
}

#[test]
fn the_image_is_that_of_the_calibrated_camera() {
    let folder = folder("render-calibration");
    let [file, default, calibrated, small] =
        ["camera.toml", "default.png", "calibrated.png", "small.png"].map(|name| folder.join(name));
    fs::write(&file, calibration::to_toml(&Camera::superscout().sized([800, 600]))).unwrap();
    let render = |out: &std::path::Path, more: &[&str]| {
        stdout_of(
            [&["draw", PLAN, "--pose", "start", "--out", out.to_str().unwrap()], more].concat(),
        );
        image::open(out).unwrap().into_rgb8()
    };
    let calibration = ["--calibration", file.to_str().unwrap()];
    assert_eq!(render(&calibrated, &calibration).dimensions(), (800, 600));
    let sized = [&calibration[..], &["--size", "640x480"]].concat();
    // The same camera with another image size.
    let (one, other) = (render(&small, &sized), render(&default, &["--size", "640x480"]));
    assert_eq!(one.dimensions(), (640, 480));
    let off = one.iter().zip(other.iter()).filter(|(one, other)| one.abs_diff(**other) > 2);
    assert!(off.count() < 5000);
}

#[test]
fn invalid_input_is_refused_and_nothing_is_written() {
    let folder = folder("render-rejected");
    let out = folder.join("view.png");
    let out = ["--out", out.to_str().unwrap()];
    let with = |arguments: &[&'static str]| [&[PLAN], &out[..], arguments].concat();
    let at_start = |arguments: &[&'static str]| [&with(arguments)[..], START].concat();
    rejected(&with(&["--pose", "2,6,0"]), "--pose: there is no floor at 2,6");
    rejected(&with(&["--pose", "2,8"]), "write three numbers");
    rejected(&with(&["--pose", "2,8,nan"]), "write three numbers");
    rejected(
        &at_start(&["--effect", "fog=1"]),
        "--effect: there is no effect `fog`; the effects are ",
    );
    rejected(&at_start(&["--effect", "blur=9"]), "--effect: `blur` is 9; it must be from 0 to 4");
    rejected(&at_start(&["--effect", "blur"]), "write NAME=VALUE");
    rejected(&at_start(&["--look", "cave"]), "laboratory");
    rejected(&at_start(&["--calibration", "nowhere.toml"]), "nowhere.toml: cannot be read");
    rejected(
        &[&["worlds/figure-1a.toml"], &out[..], START].concat(),
        "figure-1a.toml: this world is not a floor plan",
    );
    rejected(
        &[PLAN, "--pose=start", "--out", "view.gif"],
        "view.gif: the name must end in .png or .jpg or .jpeg",
    );
    rejected(&at_start(&["--labels", "labels.jpg"]), "labels.jpg: the name must end in .png");
    let needs_a_pose = "the following required arguments were not provided:\n  --pose";
    rejected(&with(&["--seed", "1"]), needs_a_pose);
    rejected(&with(&["--look", "tiles"]), needs_a_pose);
    assert!(names_in(&folder).is_empty());
}
