//! `toposlam sense IMAGE...`, on rendered images.

use std::{fs, path::PathBuf, sync::LazyLock};

use image::{ImageFormat, Rgb, RgbImage};
use serde_json::Value;
use toposlam_simulator::{BuildingLook, Rig, learned, view_sampler::ViewSampler};
use toposlam_vision::camera::{Camera, calibration};

use super::{folder, names_in, objects, run, stderr, stdout, stdout_of};

const SIZE: [u32; 2] = [640, 480];
/// A PNG of 69 bytes whose header claims 16384 x 16384 pixels.
const PROMISES_MUCH: &str =
    concat!(env!("CARGO_MANIFEST_DIR"), "/fuzz/corpus/image/error-promises-much");

/// A folder with the calibration of a camera and the colours of a look.
struct Files {
    folder: PathBuf,
    calibration: String,
    colours: String,
}

static FILES: LazyLock<Files> = LazyLock::new(|| {
    let folder = folder("sense");
    let camera = Camera::superscout().sized(SIZE);
    let look = BuildingLook::named("laboratory").unwrap();
    let mut views = ViewSampler::of([look], SIZE, 3).unwrap();
    views.plans.retain(|(name, _)| name == "shape-6");
    let colours = learned(&views, look, &camera, &Rig::new(&camera), &()).unwrap();
    let file = |name: &str, text: String| {
        fs::write(folder.join(name), text).unwrap();
        folder.join(name).to_str().unwrap().to_owned()
    };
    Files {
        calibration: file("camera.toml", calibration::to_toml(&camera)),
        colours: file("colours.toml", colours.to_toml()),
        folder,
    }
});

/// An image from a pose in shape 6, with the marker at its corner.
fn rendered(name: &str, pose: &str) -> String {
    let path = FILES.folder.join(name).to_str().unwrap().to_owned();
    stdout_of([
        "draw",
        "worlds/shape-6.toml",
        "--pose",
        pose,
        "--size",
        "640x480",
        "--look",
        "laboratory",
        "--effects",
        "none",
        "--with-marker",
        "--out",
        &path,
    ]);
    path
}

/// The arguments that sense these images.
fn sense<'a>(images: &[&'a str], more: &[&'a str]) -> Vec<&'a str> {
    let files = ["--calibration", &FILES.calibration, "--colours", &FILES.colours];
    [&["sense"], images, &files, more].concat()
}

fn written(name: &str, bytes: &[u8]) -> String {
    let path = FILES.folder.join(name);
    fs::write(&path, bytes).unwrap();
    path.to_str().unwrap().to_owned()
}

#[test]
fn a_hallway_and_a_junction_are_reported_in_the_documented_form() {
    // In the hallway to the ne corner; and on the way into the marked corner, 0.4 m before it.
    let hallway = rendered("hallway.png", "2,4.1,5");
    let corner = rendered("corner.jpg", "0.4,8,180");
    let text = stdout_of(sense(&[&hallway, &corner], &["--json"]));
    let [in_hallway, at_corner] = &objects(&text)[..] else { panic!("{text}") };
    let near = |value: &Value, expected: f64, off: f64| {
        assert!((value.as_f64().unwrap() - expected).abs() < off, "{value} is not {expected}");
    };
    assert_eq!(in_hallway["image"], hallway);
    assert_eq!((&in_hallway["scene"], &in_hallway["marker"]), (&"hallway".into(), &Value::Null));
    near(&in_hallway["heading"], -5_f64.to_radians(), 0.01);
    near(&in_hallway["left"], 0.7, 0.02);
    near(&in_hallway["right"], 0.9, 0.02);
    assert_eq!((&at_corner["scene"], &at_corner["degree"]), (&"junction".into(), &2.into()));
    near(&at_corner["doors"][0].as_f64().unwrap().abs().into(), std::f64::consts::PI, 0.02);
    near(&at_corner["doors"][1], std::f64::consts::FRAC_PI_2, 0.02);
    assert_eq!(at_corner["turning_point"]["state"], "before");
    near(&at_corner["turning_point"]["distance"], 0.4, 0.02);
    // It points along the facing hallway, which goes on to the left.
    assert_eq!(at_corner["marker"]["door"], 1);
    let keys = |line: &str| -> Vec<String> {
        // The keys of the object itself: those that follow a comma or brace outside of brackets.
        let mut depth = 0;
        let mut keys = Vec::new();
        for (at, letter) in line.char_indices() {
            match letter {
                '{' | '[' => depth += 1,
                '}' | ']' => depth -= 1,
                _ => {}
            }
            if depth == 1
                && (letter == '{' || letter == ',')
                && let Some(key) = line[at + 1..].strip_prefix('"')
            {
                keys.push(key[..key.find('"').unwrap()].to_owned());
            }
        }
        keys
    };
    let lines: Vec<_> = text.lines().map(keys).collect();
    assert_eq!(
        lines[0].join(" "),
        "schema kind image scene status reason heading left right confidence marker"
    );
    assert_eq!(
        lines[1].join(" "),
        "schema kind image scene degree doors centre_lines turning_point confidence marker"
    );
}

#[test]
fn the_text_has_labelled_rows_and_each_stage_has_a_picture() {
    let image = rendered("words.png", "0.4,8,180");
    let steps = folder("sense_steps");
    let text = stdout_of(sense(&[&image], &["--stages", steps.to_str().unwrap()]));
    assert!(text.starts_with(&format!("{image}\n  place       L, 0.4")), "{text}");
    let doors = "\n  doors       straight behind, 90 degrees to the left\n";
    assert!(text.contains(doors), "{text}");
    assert!(text.contains("\n  confidence  "), "{text}");
    let [.., marker] = &text.lines().collect::<Vec<_>>()[..] else { panic!("{text}") };
    assert!(marker.starts_with("  marker      ") && marker.ends_with(", along door 1"), "{text}");
    assert!(text.lines().skip(1).all(|line| line.chars().count() <= 80), "{text}");
    let names = names_in(&steps);
    let expected = ["1-classes", "2-boundary", "3-clusters", "4-lines", "5-scene", "6-image"];
    assert_eq!(names, expected.map(|step| format!("words-{step}.png")));
    // Below each picture stands its legend.
    for name in &names {
        let picture = image::open(steps.join(name)).unwrap().to_rgb8();
        let square = if name.ends_with("image.png") { SIZE[1] } else { 800 };
        assert!((square + 30..square + 200).contains(&picture.height()), "{name}");
        let ink = picture.rows().skip(square as usize).flatten();
        assert!(ink.filter(|pixel| pixel.0 == [0x2b, 0x34, 0x40]).count() > 50, "{name}");
    }
    let file = steps.join("words.txt");
    assert_eq!(stdout_of(sense(&[&image], &["--out", file.to_str().unwrap()])), "");
    assert_eq!(fs::read_to_string(file).unwrap(), text);
}

#[test]
fn a_useless_image_is_unknown_with_the_reason() {
    let saved = |name: &str, image: RgbImage| {
        let path = FILES.folder.join(name);
        image.save(&path).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let of = |name, colour| saved(name, RgbImage::from_pixel(SIZE[0], SIZE[1], Rgb(colour)));
    let mut state = 1_u32;
    let mut level = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 24) as u8
    };
    let noise = RgbImage::from_fn(SIZE[0], SIZE[1], |_, _| Rgb([level(), level(), level()]));
    // An image of one colour is taken for floor.
    let cases = [
        (of("black.png", [0; 3]), "no-floor"),
        (of("white.png", [255; 3]), "no-floor"),
        (saved("noise.png", noise), "no-floor"),
        (of("wall.png", [206, 190, 158]), "few-walls"),
    ];
    let images = cases.each_ref().map(|(path, _)| path.as_str());
    let lines = objects(&stdout_of(sense(&images, &["--json"])));
    assert_eq!(lines.len(), cases.len());
    for (object, (path, reason)) in lines.iter().zip(&cases) {
        assert_eq!(
            (&object["image"], &object["scene"]),
            (&path.as_str().into(), &"unknown".into())
        );
        assert_eq!(object["reason"], *reason, "{object}");
        assert!(object["marker"].is_null(), "{object}");
        assert_eq!(
            stdout_of(sense(&[path], &[])),
            format!("{path}\n  place       unknown: {reason}\n")
        );
    }
}

#[test]
fn other_files_than_images_of_the_camera_are_refused_with_the_reason() {
    let png = fs::read(rendered("whole.png", "2,4,0")).unwrap();
    let jpeg = fs::read(rendered("whole.jpg", "2,4,0")).unwrap();
    let small = RgbImage::new(320, 240);
    let small_path = FILES.folder.join("small.png");
    small.save_with_format(&small_path, ImageFormat::Png).unwrap();
    let rejected = [
        (written("text.png", b"a picture"), "this is not an image; it must be PNG or JPEG"),
        (written("empty.png", b""), "this is not an image; it must be PNG or JPEG"),
        (written("half.png", &png[..png.len() / 2]), "this cannot be read as an image: "),
        (written("head.png", &png[..20]), "this cannot be read as an image: "),
        (
            written("half.jpg", &jpeg[..jpeg.len() / 2]),
            "this cannot be read as an image: the file is truncated",
        ),
        (
            small_path.to_str().unwrap().to_owned(),
            "the image has 320 x 240 pixels; those of the calibrated camera have 640 x 480",
        ),
        (
            PROMISES_MUCH.to_owned(),
            "the image has 16384 x 16384 pixels; those of the calibrated camera have 640 x 480",
        ),
        (FILES.folder.join("none.png").to_str().unwrap().to_owned(), "cannot be read: "),
    ];
    for (path, cause) in rejected {
        let output = run(sense(&[&path], &["--json"]));
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.starts_with(&format!("error: {path}: {cause}")), "{message}");
        assert_eq!(message.lines().count(), 1, "{message}");
        let line = &objects(&stdout(&output))[0];
        assert_eq!((&line["kind"], &line["file"]), (&"unread".into(), &path.into()), "{message}");
        assert!(line["cause"].as_str().unwrap().starts_with(cause), "{line}");
    }
}

/// Runs with one of the two files changed. Returns the error message without the file name.
fn error_message(changed: &str, from: &str, to: &str) -> String {
    let image = rendered("image.png", "2,4,0");
    let [mut calibration, mut colours] = [FILES.calibration.clone(), FILES.colours.clone()];
    let file = if changed == "camera.toml" { &mut calibration } else { &mut colours };
    let text = fs::read_to_string(&*file).unwrap();
    assert_eq!(text.matches(from).count(), 1, "{from}");
    *file = written(&format!("changed-{changed}"), text.replace(from, to).as_bytes());
    let message = format!("error: {file}: ");
    let output = run(["sense", &image, "--calibration", &calibration, "--colours", &colours]);
    let text = stderr(&output);
    assert_eq!((output.status.code(), stdout(&output).as_str()), (Some(2), ""), "{text}");
    assert_eq!(text.lines().count(), 1, "{text}");
    text.strip_prefix(&message).unwrap_or_else(|| panic!("{text}")).trim_end().to_owned()
}

#[test]
fn an_invalid_calibration_is_refused_with_the_allowed_values() {
    let cases = [
        ("camera_height = 0.9", "", "line 1, column 2: camera: the key `camera_height` is missing"),
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
    ];
    for (from, to, message) in cases {
        assert_eq!(error_message("camera.toml", from, to), message);
    }
    let image = rendered("image.png", "2,4,0");
    let nothing = written("nothing.toml", b"");
    let output = run(["sense", &image, "--calibration", &nothing, "--colours", &FILES.colours]);
    assert_eq!(stderr(&output), format!("error: {nothing}: the file is empty\n"));
}

#[test]
fn invalid_colours_are_refused_with_the_allowed_values() {
    let cases = [
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
    ];
    for (from, to, message) in cases {
        let error_message = error_message("colours.toml", from, to);
        assert!(error_message.starts_with(message), "{error_message}");
    }
}

#[test]
fn stages_of_images_with_the_same_name_are_refused() {
    let (one, other) = (rendered("twice.png", "2,4,0"), rendered("twice.jpg", "2,4,0"));
    let steps = folder("sense_alike");
    let output = run(sense(&[&one, &other], &["--stages", steps.to_str().unwrap()]));
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("its pictures would have the same names as those of"));
    assert!(names_in(&steps).is_empty());
    stdout_of(sense(&[&one, &other], &[]));
}

#[test]
fn an_unreadable_image_does_not_stop_the_others() {
    let (one, other) = (rendered("one.png", "2,4,0"), rendered("other.png", "2,4,10"));
    let bad = written("between.png", b"a picture");
    let (missing, file) = (FILES.folder.join("missing.png"), FILES.folder.join("scenes.jsonl"));
    let (missing, file) = (missing.to_str().unwrap(), file.to_str().unwrap());
    let alone = stdout_of(sense(&[&one, &other], &["--json"]));
    // The lines without those of the images that cannot be read.
    let read = |text: &str| -> String {
        text.split_inclusive('\n').filter(|line| !line.contains("\"kind\":\"unread\"")).collect()
    };
    let images = [&*one, &bad, missing, &other];
    let output = run(sense(&images, &["--json"]));
    assert_eq!((output.status.code(), read(&stdout(&output))), (Some(2), alone.clone()));
    let message = stderr(&output);
    let lines: Vec<_> = message.lines().collect();
    assert_eq!(lines.len(), 2, "{message}");
    assert!(lines[0].starts_with(&format!("error: {bad}: ")), "{message}");
    assert!(lines[1].starts_with(&format!("error: {missing}: ")), "{message}");
    let output = run(sense(&images, &["--json", "--out", file]));
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(read(&fs::read_to_string(file).unwrap()), alone);
}
