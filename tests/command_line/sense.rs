//! `toposlam sense IMAGE...`, on rendered images.

use std::{fs, sync::LazyLock};

use image::{ImageFormat, Rgb, RgbImage};
use serde_json::{Value, json};
use toposlam_simulator::{BuildingLook, Rig, learned, view_sampler::ViewSampler};
use toposlam_vision::camera::{Camera, calibration};

use super::{Scratch, has, names_in, objects, stderr, stdout};

const SIZE: [u32; 2] = [640, 480];
const FILES: &str = "--calibration camera.toml --colours colours.toml";

/// The calibration of a camera, and the colours of a look.
static SENSING: LazyLock<[String; 2]> = LazyLock::new(|| {
    let camera = Camera::superscout().sized(SIZE);
    let look = BuildingLook::named("laboratory").unwrap();
    let mut views = ViewSampler::from_looks([look], SIZE, 3).unwrap();
    views.plans.retain(|(name, _)| name == "shape-6");
    let colours = learned(&views, look, &camera, &Rig::new(&camera), &()).unwrap();
    [calibration::to_toml(&camera), colours.to_toml()]
});

fn scratch(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    scratch.write("camera.toml", &SENSING[0]);
    scratch.write("colours.toml", &SENSING[1]);
    scratch
}

/// Takes an image from a pose in shape 6, with the marker at its corner.
fn render(scratch: &Scratch, name: &str, pose: &str) {
    let look = "--size 640x480 --look laboratory --effects none --with-marker";
    scratch.out(&format!("draw worlds/shape-6.toml --pose {pose} {look} --out {name}"), 0);
}

#[test]
fn a_hallway_and_a_junction_are_reported_in_the_documented_form() {
    let scratch = scratch("sense_form");
    // In the hallway to the ne corner; and on the way into the marked corner, 0.4 m before it.
    render(&scratch, "hallway.png", "2,4.1,5");
    render(&scratch, "corner.jpg", "0.4,8,180");
    let sense = format!("sense hallway.png corner.jpg {FILES}");
    let lines = scratch.lines(&sense, 0);
    let near = |value: &Value, expected: f64, off: f64| {
        assert!((value.as_f64().unwrap() - expected).abs() < off, "{value} is not {expected}");
    };
    has(
        &lines.clone().into(),
        &json!([
            { "image": "hallway.png", "scene": "hallway", "marker": null },
            // It points along the facing hallway, which goes on to the left.
            { "scene": "junction", "degree": 2, "turning_point.state": "before", "marker.door": 1 },
        ]),
        &sense,
    );
    let [in_hallway, at_corner] = &lines[..] else { panic!("{lines:?}") };
    near(&in_hallway["heading"], -5_f64.to_radians(), 0.01);
    near(&in_hallway["left"], 0.7, 0.02);
    near(&in_hallway["right"], 0.9, 0.02);
    near(&at_corner["doors"][0].as_f64().unwrap().abs().into(), std::f64::consts::PI, 0.02);
    near(&at_corner["doors"][1], std::f64::consts::FRAC_PI_2, 0.02);
    near(&at_corner["turning_point"]["distance"], 0.4, 0.02);
    let keys =
        lines.iter().map(|line| line.as_object().unwrap().keys().cloned().collect::<Vec<_>>());
    let keys: Vec<_> = keys.map(|keys| keys.join(" ")).collect();
    assert_eq!(
        keys,
        [
            "schema kind image scene status reason heading left right confidence marker",
            "schema kind image scene degree doors centre_lines turning_point confidence marker",
        ]
    );
}

#[test]
fn the_text_has_labelled_rows_and_each_stage_has_a_picture() {
    let scratch = scratch("sense_stages");
    render(&scratch, "words.png", "0.4,8,180");
    let text = scratch.out(&format!("sense words.png {FILES} --stages steps"), 0);
    assert!(text.starts_with("words.png\n  place       L, 0.4"), "{text}");
    let doors = "\n  doors       straight behind, 90 degrees to the left\n";
    assert!(text.contains(doors) && text.contains("\n  confidence  "), "{text}");
    let marker = text.lines().last().unwrap();
    assert!(marker.starts_with("  marker      ") && marker.ends_with(", along door 1"), "{text}");
    let names = names_in(&scratch.path("steps"));
    let expected = ["1-classes", "2-boundary", "3-clusters", "4-lines", "5-scene", "6-image"];
    assert_eq!(names, expected.map(|step| format!("words-{step}.png")));
    // Below each picture stands its legend.
    for name in &names {
        let picture = image::open(scratch.path("steps").join(name)).unwrap().to_rgb8();
        let square = if name.ends_with("image.png") { SIZE[1] } else { 800 };
        assert!((square + 30..square + 200).contains(&picture.height()), "{name}");
        let ink = picture.rows().skip(square as usize).flatten();
        assert!(ink.filter(|pixel| pixel.0 == [0x2b, 0x34, 0x40]).count() > 50, "{name}");
    }
    assert_eq!(scratch.out(&format!("sense words.png {FILES} --out words.txt"), 0), "");
    assert_eq!(scratch.text("words.txt"), text);
    // Stages of images with the same name are refused.
    render(&scratch, "words.jpg", "2,4,0");
    let message = scratch.error(&format!("sense words.png words.jpg {FILES} --stages others"));
    assert!(message.contains("its pictures would have the same names as those of"), "{message}");
    assert!(
        !fs::exists(scratch.path("others")).unwrap()
            || names_in(&scratch.path("others")).is_empty()
    );
    scratch.out(&format!("sense words.png words.jpg {FILES}"), 0);
}

#[test]
fn a_useless_image_is_unknown_with_the_reason() {
    let scratch = scratch("sense_useless");
    let mut state = 1_u32;
    let mut level = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 24) as u8
    };
    let noise = RgbImage::from_fn(SIZE[0], SIZE[1], |_, _| Rgb([level(), level(), level()]));
    let of = |colour| RgbImage::from_pixel(SIZE[0], SIZE[1], Rgb(colour));
    // An image of one colour is taken for floor.
    for (image, reason) in [
        (of([0; 3]), "no-floor"),
        (of([255; 3]), "no-floor"),
        (noise, "no-floor"),
        (of([206, 190, 158]), "few-walls"),
    ] {
        image.save(scratch.path("image.png")).unwrap();
        let sense = format!("sense image.png {FILES}");
        let unknown = json!({ "scene": "unknown", "reason": reason, "marker": null });
        scratch.facts(&[(&sense, 0, unknown)]);
        let text = format!("image.png\n  place       unknown: {reason}\n");
        assert_eq!(scratch.out(&sense, 0), text);
    }
}

#[test]
fn other_files_than_images_of_the_camera_are_refused_and_do_not_stop_the_others() {
    let scratch = scratch("sense_refused");
    render(&scratch, "one.png", "2,4,0");
    render(&scratch, "other.jpg", "2,4,10");
    let [png, jpeg] = ["one.png", "other.jpg"].map(|name| scratch.bytes(name));
    scratch.write("half.png", &png[..png.len() / 2]);
    scratch.write("head.png", &png[..20]);
    scratch.write("half.jpg", &jpeg[..jpeg.len() / 2]);
    let small = RgbImage::new(320, 240);
    small.save_with_format(scratch.path("small.png"), ImageFormat::Png).unwrap();
    let alone = scratch.lines(&format!("sense one.png other.jpg {FILES}"), 0);
    let of_camera = "pixels; those of the calibrated camera have 640 x 480";
    for (file, cause) in [
        ("fuzz/corpus/image/error-text", "this is not an image; it must be PNG or JPEG"),
        ("fuzz/corpus/image/error-empty", "this is not an image; it must be PNG or JPEG"),
        ("half.png", "this cannot be read as an image: "),
        ("head.png", "this cannot be read as an image: "),
        ("half.jpg", "this cannot be read as an image: the file is truncated"),
        ("small.png", &format!("the image has 320 x 240 {of_camera}")),
        (
            "fuzz/corpus/image/error-promises-much",
            &format!("the image has 16384 x 16384 {of_camera}"),
        ),
        ("none.png", "cannot be read: "),
    ] {
        let output = scratch.run(&format!("sense one.png {file} other.jpg {FILES} --json"));
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.starts_with(&format!("error: {file}: {cause}")), "{message}");
        assert_eq!(message.lines().count(), 1, "{message}");
        let mut lines = objects(&stdout(&output));
        let unread = lines.remove(1);
        has(&unread, &json!({ "kind": "unread", "file": file }), file);
        assert!(unread["cause"].as_str().unwrap().starts_with(cause), "{unread}");
        assert_eq!(lines, alone);
    }
    scratch.error(&format!("sense one.png none.png other.jpg {FILES} --json --out scenes.jsonl"));
    let mut lines = objects(&scratch.text("scenes.jsonl"));
    lines.retain(|line| line["kind"] != "unread");
    assert_eq!(lines, alone);
}

#[test]
fn an_invalid_calibration_or_colours_are_refused_with_the_allowed_values() {
    let scratch = scratch("sense_invalid");
    render(&scratch, "image.png", "2,4,0");
    for (file, cases) in [
        (
            "camera.toml",
            &[
                (
                    "camera_height = 0.9",
                    "",
                    "line 1, column 2: camera: the key `camera_height` is missing",
                ),
                (
                    "camera_height = 0.9",
                    "camera_height = 90",
                    "line 8, column 17: camera.camera_height: 90 is out of range; a height above the floor in metres lies \
             between 0.01 and 10",
                ),
                (
                    "mirror_radius = 0.05",
                    "mirror_radius = -1",
                    "line 6, column 17: camera.mirror_radius: -1 is out of range; the radius of a mirror in metres lies between \
             0.001 and 1",
                ),
                (
                    "image = [640, 480]",
                    "image = [640, 480000]",
                    "line 3, column 15: camera.image[1]: 480000 is out of range; the side of an image in pixels lies between 16 \
             and 16384",
                ),
                (
                    "seen_from = \"below\"",
                    "seen_from = \"aside\"",
                    "line 11, column 13: camera.seen_from: expected \"below\" or \"above\", found another text",
                ),
            ][..],
        ),
        (
            "colours.toml",
            &[
                (
                    "version = 1",
                    "version = 2",
                    "line 2, column 11: version: this is version 2 of colour files; only version 1 can be read",
                ),
                ("version = 1", "", "the key `version` is missing"),
                (
                    "width = 0.05",
                    "width = 5.0",
                    "line 6, column 9: stripe.width: 5 is out of range; the width in metres lies between 0.005 and 0.5",
                ),
                ("[priors]", "[prior]", "line 11, column 2: prior: unknown key; expected one of: "),
                (
                    "floor = [\n",
                    "floor = [\n  [40, 0, 0, 1],\n",
                    "line 27, column 4: histograms.floor[0][0]: 40 is out of range; the value ",
                ),
                ("[histograms]", "[histograms", "line "),
            ],
        ),
    ] {
        let text = scratch.text(file);
        for (from, to, cause) in cases {
            assert_eq!(text.matches(from).count(), 1, "{from}");
            scratch.write(file, text.replace(from, to));
            let message = scratch.error(&format!("sense image.png {FILES}"));
            assert!(message.starts_with(&format!("error: {file}: {cause}")), "{message}");
            assert_eq!(message.lines().count(), 1, "{message}");
        }
        scratch.write(file, "");
        let message = scratch.error(&format!("sense image.png {FILES}"));
        assert_eq!(message, format!("error: {file}: the file is empty\n"));
        scratch.write(file, text);
    }
}
