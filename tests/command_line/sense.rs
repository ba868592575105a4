//! `toposlam sense IMAGE...`, on rendered images.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::{Arc, LazyLock},
};

use image::{ImageFormat, RgbImage};
use serde_json::Value;
use toposlam_robot::{
    evaluation::{learned, view::WhichEffects, views::Views},
    simulator::{Look, Rig},
};
use toposlam_vision::camera::{Camera, calibration};

use crate::{folder, names_in, objects, read_world, run, said, stderr, stdout};

const SIZE: [u32; 2] = [640, 480];

/// A folder with the calibration of a camera and the colours of a look.
struct Files {
    folder: PathBuf,
    calibration: String,
    colours: String,
}

static FILES: LazyLock<Files> = LazyLock::new(|| {
    let folder = folder("sense");
    let camera = Camera::superscout().sized(SIZE);
    let plan = read_world(Path::new("worlds/shape-6.toml")).plan.unwrap();
    let look = Look::named("laboratory").unwrap();
    let views = Views {
        seed: 3,
        plans: vec![("shape-6".to_owned(), Arc::new(plan))],
        random_plans: false,
        looks: vec![look],
        sizes: vec![SIZE],
        effects: WhichEffects::Default,
    };
    let colours = learned(&views, look, &camera, &Rig::new(&camera)).unwrap();
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
    said([
        "render",
        "worlds/shape-6.toml",
        "--pose",
        pose,
        "--size",
        "640x480",
        "--look",
        "laboratory",
        "--effects",
        "none",
        "--marker",
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
fn a_hallway_and_a_junction_are_told_as_the_design_page_has_it() {
    // In the hallway to the ne corner; and on the way into the marked corner, 0.4 m before it.
    let hallway = rendered("hallway.png", "2,4.1,5");
    let corner = rendered("corner.jpg", "0.4,8,180");
    let text = said(sense(&[&hallway, &corner], &["--json"]));
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
        "schema image scene status reason heading left right confidence marker"
    );
    assert_eq!(
        lines[1].join(" "),
        "schema image scene degree doors centre_lines turning_point confidence marker"
    );
}

#[test]
fn people_get_words_and_a_picture_of_each_step() {
    let image = rendered("words.png", "0.4,8,180");
    let steps = folder("sense_steps");
    let text = said(sense(&[&image], &["--stages", steps.to_str().unwrap()]));
    assert!(text.starts_with(&format!("{image}: L, 0.4")), "{text}");
    assert!(text.contains("; doors straight behind, 90 degrees to the left; "), "{text}");
    assert!(text.trim_end().ends_with(", along door 1"), "{text}");
    let names = names_in(&steps);
    let expected = ["1-classes", "2-boundary", "3-clusters", "4-lines", "5-scene", "6-image"];
    assert_eq!(names, expected.map(|step| format!("words-{step}.png")));
    let file = steps.join("words.txt");
    assert_eq!(said(sense(&[&image], &["--out", file.to_str().unwrap()])), "");
    assert_eq!(fs::read_to_string(file).unwrap(), text);
}

#[test]
fn a_useless_image_is_unknown_with_the_reason() {
    let of = |name: &str, colour: [u8; 3]| {
        let path = FILES.folder.join(name);
        RgbImage::from_pixel(SIZE[0], SIZE[1], image::Rgb(colour)).save(&path).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let (black, white) = (of("black.png", [0; 3]), of("white.png", [255; 3]));
    for object in objects(&said(sense(&[&black, &white], &["--json"]))) {
        assert_eq!(object["scene"], "unknown", "{object}");
        assert!(object["reason"].is_string() && object["marker"].is_null(), "{object}");
    }
    assert!(said(sense(&[&black], &[])).starts_with(&format!("{black}: unknown: ")));
}

#[test]
fn what_is_no_image_of_the_camera_is_refused_with_the_reason() {
    let png = fs::read(rendered("whole.png", "2,4,0")).unwrap();
    let jpeg = fs::read(rendered("whole.jpg", "2,4,0")).unwrap();
    let small = RgbImage::new(320, 240);
    let small_path = FILES.folder.join("small.png");
    small.save_with_format(&small_path, ImageFormat::Png).unwrap();
    let refused = [
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
        (FILES.folder.join("none.png").to_str().unwrap().to_owned(), "cannot be read: "),
    ];
    for (path, cause) in refused {
        let output = run(sense(&[&path], &["--json"]));
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.starts_with(&format!("error: {path}: {cause}")), "{message}");
        assert_eq!((message.lines().count(), stdout(&output).as_str()), (1, ""), "{message}");
    }
}

#[test]
fn colours_of_another_version_and_a_calibration_without_a_camera_are_refused() {
    let image = rendered("image.png", "2,4,0");
    let colours = fs::read_to_string(&FILES.colours).unwrap();
    let later = written("later.toml", colours.replacen("version = 1", "version = 2", 1).as_bytes());
    let nothing = written("nothing.toml", b"");
    for (calibration, colours) in [(&FILES.calibration, &later), (&nothing, &FILES.colours)] {
        let output = run(["sense", &image, "--calibration", calibration, "--colours", colours]);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert_eq!(message.matches("error:").count(), 1, "{message}");
    }
    let message =
        stderr(&run(["sense", &image, "--calibration", &FILES.calibration, "--colours", &later]));
    assert!(message.contains("version"), "{message}");
}

#[test]
fn steps_of_images_that_are_called_alike_are_refused() {
    let (one, other) = (rendered("twice.png", "2,4,0"), rendered("twice.jpg", "2,4,0"));
    let steps = folder("sense_alike");
    let output = run(sense(&[&one, &other], &["--stages", steps.to_str().unwrap()]));
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("its pictures would be called as those of"));
    assert!(names_in(&steps).is_empty());
    said(sense(&[&one, &other], &[]));
}
