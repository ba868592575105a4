//! `toposlam sense IMAGE...`, on rendered images.

use std::{f64::consts::PI, io::Cursor, sync::LazyLock};

use image::{ImageFormat, Rgb, RgbImage};
use serde_json::{Value, json};
use toposlam_logs::{
    messages::Stamp,
    recorder::{IMAGE, ODOM},
    standard::{CompressedImage, OdometryMessage, Twist},
    writer::LogWriter,
};
use toposlam_model::driving::odometry::Odometry;
use toposlam_simulator::{BuildingLook, Rig, learned, view_sampler::ViewSampler};
use toposlam_vision::camera::{Camera, calibration};

use super::{Scratch, flat, has, names_in, objects, stderr, stdout};

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
    let look = "--size 640x480 --look laboratory --effect none --marker directional";
    scratch.out(&format!("draw worlds/shape-6.toml --pose {pose} {look} --out {name}"), 0);
}

#[test]
fn a_hallway_and_a_junction_are_reported_in_the_documented_form() {
    let scratch = scratch("sense_form");
    // In the hallway to the ne corner; and on the way into the marked corner, 0.4 m before it.
    render(&scratch, "hallway.png", "2,4.1,5");
    render(&scratch, "corner.jpg", "0.4,8,180");
    let sense = format!("sense hallway.png corner.jpg {FILES}");
    let lines = Value::from(scratch.lines(&sense, 0));
    let expected = json!([
        { "image": "hallway.png", "scene": "hallway", "marker": null },
        // It points along the facing hallway, which goes on to the left.
        { "scene": "junction", "degree": 2, "turning_point.state": "before", "marker.door": 1 },
    ]);
    has(&lines, &expected, &sense);
    for (pointer, expected, off) in [
        ("/0/heading", -PI / 36.0, 0.01),
        ("/0/left", 0.7, 0.02),
        ("/0/right", 0.9, 0.02),
        ("/1/doors/0", PI, 0.02),
        ("/1/doors/1", PI / 2.0, 0.02),
        ("/1/turning_point/distance", 0.4, 0.02),
    ] {
        let found = lines.pointer(pointer).unwrap().as_f64().unwrap();
        let found = if expected > 3.0 { found.abs() } else { found };
        assert!((found - expected).abs() < off, "{pointer}: {found} is not {expected}");
    }
    let keys = [0, 1].map(|line| {
        let keys = lines[line].as_object().unwrap().keys().cloned();
        keys.collect::<Vec<_>>().join(" ")
    });
    assert_eq!(
        keys,
        [
            "schema kind image scene status reason heading left right confidence marker",
            "schema kind image scene degree doors centre_lines turning_point confidence certain marker",
        ]
    );
}

#[test]
fn each_stage_has_a_picture_with_its_legend() {
    let scratch = scratch("sense_stages");
    render(&scratch, "words.png", "0.4,8,180");
    scratch.out(&format!("sense words.png {FILES} --stages steps"), 0);
    let names = names_in(&scratch.path("steps"));
    let expected = ["1-classes", "2-boundary", "3-clusters", "4-lines", "5-scene", "6-image"];
    assert_eq!(names, expected.map(|step| format!("words-{step}.png")));
    for name in &names {
        let picture = image::open(scratch.path("steps").join(name)).unwrap();
        let square = if name.ends_with("image.png") { SIZE[1] } else { 800 };
        assert!((square + 30..square + 200).contains(&picture.height()), "{name}");
    }
    // Stages of images with the same name are refused.
    render(&scratch, "words.jpg", "2,4,0");
    facts! { scratch;
        format!("sense words.png words.jpg {FILES} --stages others") => 2 "words.jpg: its pictures would have";
        format!("sense words.png words.jpg {FILES}") => 0;
    }
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
        (of([0; 3]), "too-dark"),
        (of([255; 3]), "overexposed"),
        (noise, "mixed-floor"),
        (of([206, 190, 158]), "few-walls"),
    ] {
        image.save(scratch.path("image.png")).unwrap();
        let unknown = json!({ "scene": "unknown", "reason": reason, "marker": null });
        scratch.fact(&format!("sense image.png {FILES}"), 0, &unknown);
    }
}

/// A camera with its cap on, a lamp, and a file that is no image.
#[test]
fn if_no_image_of_a_log_can_be_used_the_error_says_why() {
    let scratch = scratch("sense_useless_log");
    let png = |level| {
        let mut bytes = Cursor::new(Vec::new());
        let image = RgbImage::from_pixel(SIZE[0], SIZE[1], Rgb([level; 3]));
        image.write_to(&mut bytes, ImageFormat::Png).unwrap();
        bytes.into_inner()
    };
    let [dark, bright] = [png(0), png(255)];
    let mut log = LogWriter::new(Vec::new()).unwrap();
    for (second, image) in (1..).zip([&dark[..], &bright, &dark, b"no image", &dark]) {
        let stamp = Stamp::from_nanoseconds(second * 1_000_000_000);
        let odometry = OdometryMessage::new(stamp, &Odometry::default(), Twist::default());
        log.write(ODOM, stamp.nanoseconds(), &odometry).unwrap();
        log.write(IMAGE, stamp.nanoseconds(), &CompressedImage::new(stamp, image)).unwrap();
    }
    scratch.write("run.mcap", log.finish().unwrap());
    let error = scratch.error(&format!("conform run.mcap --driver anyone --events images {FILES}"));
    let cause =
        "no junction is visited in its 5 images: 3 too dark, 1 not decodable, 1 overexposed";
    assert!(flat(&error).contains(cause), "{error}");
}

/// `toposlam-vision` has each error in a calibration and in colours.
#[test]
fn other_files_are_refused_and_do_not_stop_the_others() {
    let scratch = scratch("sense_refused");
    render(&scratch, "one.png", "2,4,0");
    render(&scratch, "other.jpg", "2,4,10");
    let [png, jpeg] = ["one.png", "other.jpg"].map(|name| scratch.bytes(name));
    scratch.write("half.png", &png[..png.len() / 2]);
    scratch.write("half.jpg", &jpeg[..jpeg.len() / 2]);
    let small = RgbImage::new(320, 240);
    small.save_with_format(scratch.path("small.png"), ImageFormat::Png).unwrap();
    let alone = scratch.lines(&format!("sense one.png other.jpg {FILES}"), 0);
    let of_camera = "pixels; those of the calibrated camera have 640 x 480";
    for (file, cause) in [
        ("fuzz/corpus/image/error-text", "this is not an image; it must be PNG or JPEG"),
        ("half.png", "this cannot be read as an image: "),
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
    for (file, from, to, cause) in [
        (
            "camera.toml",
            "height = 0.9",
            "height = 90",
            "line 8, column 17: camera.camera_height: 90",
        ),
        (
            "colours.toml",
            "width = 0.05",
            "width = 5",
            "line 6, column 9: stripe.width: 5 is out of",
        ),
    ] {
        let text = scratch.text(file);
        scratch.write(file, text.replace(from, to));
        scratch.fact(&format!("sense one.png {FILES}"), 2, &format!("{file}: {cause}").into());
        scratch.write(file, "");
        scratch.fact(&format!("sense one.png {FILES}"), 2, &format!("{file}: the file is").into());
        scratch.write(file, text);
    }
}
