//! `toposlam camera train`, on a few small rendered images and their labels.

use std::{fs, sync::LazyLock};

use image::{Rgb, RgbImage};
use serde_json::json;
use toposlam_vision::{
    camera::{Camera, calibration},
    colour::{ColourModel, Stripe, StripeKind},
};

use super::{Scratch, has, names_in, objects, stderr, stdout};

const SIZE: [u32; 2] = [320, 240];
const CLASSES: [&str; 4] = ["floor", "stripe", "marker", "other"];
const TRAIN: &str = "camera train --images images --labels labels --calibration camera.toml \
                     --out colours.toml";

/// Seven PNG and JPEG images of shape 8 on the way to its marked corner.
static RENDERED: LazyLock<Scratch> = LazyLock::new(|| {
    let set = empty("train");
    for n in 1..=7 {
        let ending = if n % 2 == 0 { "jpg" } else { "png" };
        let files = format!("images/{n}.{ending} --labels labels/{n}.png");
        render(&set, &format!("0,{n},{}", 50 * n), &files);
    }
    set
});

/// A folder for images and their labels, with the calibration of their camera.
fn empty(name: &str) -> Scratch {
    let set = Scratch::new(name);
    for inside in ["images", "labels"] {
        fs::create_dir(set.path(inside)).unwrap();
    }
    let camera = calibration::to_toml(&Camera::superscout().sized(SIZE));
    set.write("camera.toml", camera);
    set
}

/// A copy of some of the rendered images.
fn copied(name: &str, keep: impl Fn(&str) -> bool) -> Scratch {
    let set = empty(name);
    for inside in ["images", "labels"] {
        for name in names_in(&RENDERED.path(inside)).iter().filter(|name| keep(name)) {
            let file = format!("{inside}/{name}");
            set.write(&file, RENDERED.bytes(&file));
        }
    }
    set
}

fn all(name: &str) -> Scratch {
    copied(name, |_| true)
}

fn render(set: &Scratch, pose: &str, out: &str) {
    let what = "draw worlds/shape-8.toml --with-marker --effects none --calibration camera.toml";
    set.out(&format!("{what} --pose {pose} --out {out}"), 0);
}

fn paint(set: &Scratch, name: &str, size: [u32; 2], colour: [u8; 3]) {
    RgbImage::from_pixel(size[0], size[1], Rgb(colour)).save(set.path(name)).unwrap();
}

fn model(set: &Scratch) -> ColourModel {
    ColourModel::read(&set.bytes("colours.toml")).unwrap()
}

/// Sets one label colour to ignore.
fn relabel(set: &Scratch, colour: [u8; 3]) {
    for name in names_in(&set.path("labels")) {
        let path = set.path("labels").join(name);
        let mut labels = image::open(&path).unwrap().into_rgb8();
        for label in labels.pixels_mut().filter(|label| label.0 == colour) {
            *label = Rgb([255; 3]);
        }
        labels.save(path).unwrap();
    }
}

// paper: sense.classify, marker-sense.colour
#[test]
fn every_class_of_a_rendered_building_is_recognized() {
    let set = all("train-json");
    let report = set.last(TRAIN, 0);
    has(
        &report,
        &json!({
            "images": 7, "folds": 5, "left_out": [], "stripe": { "kind": "floor", "width": 0.05 },
        }),
        TRAIN,
    );
    for (figures, class) in report["classes"].as_array().unwrap().iter().zip(CLASSES) {
        assert_eq!(figures["class"], class);
        // In such a small image, mixed pixels of floor and wall look like the stripe.
        for (figure, least) in [("recall", 0.97), ("precision", 0.70)] {
            assert!(figures[figure].as_f64().unwrap() > least, "{class}: {report}");
        }
        // Every pixel is classified once, with the colours learned from the other parts.
        let row = report["confusion"][class].as_object().unwrap();
        let predicted: Vec<&str> = row.keys().map(String::as_str).collect();
        assert_eq!(predicted, [&CLASSES[..], &["unknown"]].concat());
        let all: u64 = row.values().map(|pixels| pixels.as_u64().unwrap()).sum();
        assert!(all > 0 && figures["pixels"] == all, "{class}: {report}");
        let right = row[class].as_f64().unwrap() / all as f64;
        assert!((figures["recall"].as_f64().unwrap() - right).abs() < 1e-9, "{class}: {report}");
    }
    let keys: Vec<_> = report.as_object().unwrap().keys().cloned().collect();
    assert_eq!(
        keys.join(" "),
        "schema kind images left_out folds not_validated confusion classes stripe"
    );
    assert_eq!(set.written(), ["camera.toml", "colours.toml", "images", "labels"]);
    // The same images give the same colours.
    let (text, colours) = (set.out(TRAIN, 0), set.text("colours.toml"));
    assert_eq!((set.out(TRAIN, 0), set.text("colours.toml")), (text, colours));
    // In the hallway, between two junctions; and 0.6 m before the marked corner, which turns to the right.
    render(&set, "0.1,2,86", "hallway.png");
    render(&set, "0.05,7.4,91", "corner.png");
    let sense = "sense hallway.png corner.png --calibration camera.toml --colours colours.toml";
    let lines = set.lines(sense, 0);
    has(
        &lines.clone().into(),
        &json!([
            { "scene": "hallway" }, { "scene": "junction", "degree": 2 },
        ]),
        sense,
    );
    assert!((lines[0]["right"].as_f64().unwrap() - 0.7).abs() < 0.05, "{lines:?}");
    assert!((lines[1]["doors"][1].as_f64().unwrap() + 1.57).abs() < 0.1, "{lines:?}");
    assert!(lines[1]["marker"].is_object(), "{lines:?}");
}

#[test]
fn the_text_is_a_table() {
    let set = all("train-table");
    let text = set.out(&format!("{TRAIN} --stripe wall --stripe-width 0.1"), 0);
    assert_eq!(model(&set).stripe, Stripe { kind: StripeKind::OnWall, width: 0.1 });
    assert!(text.starts_with("stripe  a baseboard on the wall, 0.1 m wide\nimages  7\n"), "{text}");
    assert!(text.contains("\nCross-validation in 5 parts:\n"), "{text}");
    let words = |line: &str| line.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    let table: Vec<_> = text.lines().skip(5).map(words).collect();
    assert_eq!(table[0].join(" "), "class images pixels right");
    assert_eq!(table.len(), 12, "{text}");
    for (row, class) in table[1..5].iter().zip(CLASSES) {
        assert_eq!((row[0].as_str(), row.last().unwrap().as_str()), (class, "%"), "{text}");
    }
    for (row, class) in table[8..].iter().zip(CLASSES) {
        assert!(row[0] == class && row.contains(&class.to_owned()), "{text}");
    }
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
}

#[test]
fn what_cannot_be_cross_validated_is_reported() {
    // The last image shows the marker.
    let set = copied("train-single", |name| name.starts_with('7'));
    let why = "there is only one image to learn from";
    let text = set.out(TRAIN, 0);
    assert!(text.ends_with(&format!("\nnot cross-validated: {why}\n")), "{text}");
    set.facts(&[(TRAIN, 0, json!({
        "images": 1, "folds": null, "not_validated": why, "confusion": null, "classes.0.recall": null,
    }))]);
    // One of the two images has no stripe, so that neither part can be classified from the other.
    let set = copied("train-parts", |name| name.starts_with(['6', '7']));
    let whole = set.bytes("labels/7.png");
    relabel(&set, [255, 0, 0]);
    set.write("labels/7.png", whole);
    let why = "without part 2 of the images no pixel within 3 m is labelled as stripe\n";
    assert!(set.out(TRAIN, 0).ends_with(&format!("\nnot cross-validated: {why}")));
}

#[test]
fn images_that_are_too_dark_or_bright_are_left_out_and_reported() {
    let set = all("train-dark");
    for (name, level) in [("black", 0), ("white", 255)] {
        paint(&set, &format!("images/{name}.png"), SIZE, [level; 3]);
        paint(&set, &format!("labels/{name}.png"), SIZE, [0, 255, 0]);
    }
    let output = set.run(&format!("{TRAIN} --json"));
    let left_out = [
        ("images/black.png", "the floor beside the robot's body is too dark"),
        ("images/white.png", "the floor beside the robot's body is overexposed"),
    ];
    let messages = left_out.map(|(image, reason)| format!("left out: {image}: {reason}\n"));
    assert_eq!(stderr(&output), messages.concat());
    let left_out = left_out.map(|(image, reason)| json!({ "image": image, "reason": reason }));
    has(&objects(&stdout(&output))[0], &json!({ "images": 7, "left_out": left_out }), TRAIN);
    let text = set.out(TRAIN, 0);
    assert!(text.contains("\nimages  7, and 2 left out\n"), "{text}");
    // The colours are the same as without them.
    RENDERED.out(TRAIN, 0);
    assert_eq!(model(&set), model(&RENDERED));
}

#[test]
fn without_a_labelled_marker_the_other_classes_are_learned() {
    let set = all("train-no-marker");
    relabel(&set, [0, 0, 255]);
    let output = set.run(&format!("{TRAIN} --json"));
    let message = "no marker is labelled: sensing with these colours sees no marker\n";
    assert_eq!((output.status.code(), &*stderr(&output)), (Some(0), message));
    let line = &objects(&stdout(&output))[0];
    let pixels: Vec<_> =
        line["classes"].as_array().unwrap().iter().map(|class| class["pixels"] != 0).collect();
    assert_eq!(pixels, [true, true, false, true]);
    // Nothing is taken for a marker.
    assert!(CLASSES.iter().all(|class| line["confusion"][class]["marker"] == 0), "{line}");
}

/// Breaks a set. Returns the beginning of the error message.
type Breaking = fn(&Scratch) -> &'static str;

#[test]
fn invalid_images_and_labels_are_refused_with_the_file() {
    let cases: [Breaking; 17] = [
        |set| {
            fs::remove_dir_all(set.path("images")).unwrap();
            fs::create_dir(set.path("images")).unwrap();
            set.write("images/notes.txt", b"");
            set.write("images/.7.png", b"");
            "images: there is no image in this folder: no .png, .jpg or .jpeg"
        },
        |set| {
            fs::remove_dir_all(set.path("labels")).unwrap();
            "labels: cannot be read as a folder: "
        },
        |set| {
            fs::remove_file(set.path("labels/6.png")).unwrap();
            "images/6.jpg: its labels, labels/6.png, are not there"
        },
        |set| {
            fs::remove_file(set.path("images/6.jpg")).unwrap();
            "labels/6.png: there is no image of this name in images"
        },
        |set| {
            set.write("images/6.PNG", set.bytes("images/6.jpg"));
            "images/6.jpg: its labels would be those of images/6.PNG"
        },
        |set| {
            set.write("images/7.png", b"a picture");
            "images/7.png: this is not an image; it must be PNG or JPEG"
        },
        |set| {
            let png = set.bytes("images/7.png");
            set.write("images/7.png", &png[..png.len() / 2]);
            "images/7.png: this cannot be read as an image: "
        },
        |set| {
            let jpeg = set.bytes("images/6.jpg");
            set.write("images/6.jpg", &jpeg[..jpeg.len() - 9]);
            "images/6.jpg: this cannot be read as an image: the file is truncated"
        },
        |set| {
            paint(set, "images/7.png", [640, 480], [90; 3]);
            "images/7.png: the image has 640 x 480 pixels; those of the calibrated camera have "
        },
        |set| {
            set.write("images/7.png", set.bytes("fuzz/corpus/image/error-promises-much"));
            "images/7.png: the image has 16384 x 16384 pixels; those of"
        },
        |set| {
            set.write("labels/7.png", set.bytes("fuzz/corpus/image/error-promises-much"));
            "labels/7.png: the labels have 16384 x 16384 pixels; their"
        },
        |set| {
            paint(set, "labels/7.png", [240, 320], [0, 255, 0]);
            "labels/7.png: the labels have 240 x 320 pixels; their image has 320 x 240"
        },
        |set| {
            let path = set.path("labels/7.png");
            let mut labels = image::open(&path).unwrap().into_rgb8();
            labels.put_pixel(3, 5, Rgb([255, 0, 255]));
            labels.save(path).unwrap();
            "labels/7.png: the label at pixel (3, 5) has the colour (255, 0, 255); there can be \
             floor (0,255,0), stripe (255,0,0), marker (0,0,255), other (0,0,0), ignore \
             (255,255,255)"
        },
        |set| {
            set.write("labels/7.png", b"floor");
            "labels/7.png: this is not an image; it must be PNG or JPEG"
        },
        |set| {
            relabel(set, [255, 0, 0]);
            "labels: no pixel within 3 m is labelled as stripe (255,0,0)"
        },
        |set| {
            let text = set.text("camera.toml").replace("height = 0.9", "height = 90");
            set.write("camera.toml", text);
            "camera.toml: line 8, column 17: camera.camera_height: 90 is out of range; a height \
             above the floor in metres lies between 0.01 and 10"
        },
        |set| {
            fs::remove_file(set.path("camera.toml")).unwrap();
            "camera.toml: cannot be read: "
        },
    ];
    for breaking in cases {
        let set = all("train-rejected");
        let expected = breaking(&set);
        let message = set.error(TRAIN);
        assert!(message.starts_with(&format!("error: {expected}")), "{message}");
        assert_eq!(message.lines().count(), 1, "{message}");
        assert!(!set.path("colours.toml").exists(), "{message}");
    }
    // Without light each image is named before the error.
    let set = all("train-no-light");
    for name in names_in(&set.path("images")) {
        paint(&set, &format!("images/{name}"), SIZE, [0; 3]);
    }
    let message = set.error(TRAIN);
    assert!(message.starts_with("left out: images/1.png: "), "{message}");
    assert!(message.ends_with("\nerror: images: every image was left out\n"), "{message}");
}

#[test]
fn invalid_options_are_refused_with_the_allowed_values() {
    let set = all("train-arguments");
    let width = "is out of range; the width of a stripe in metres lies between 0.005 and 0.5";
    for (options, cause) in [
        ("--stripe-width 5", &*format!("--stripe-width: 5 {width}")),
        ("--stripe-width nan", "--stripe-width: NaN is out of range"),
        ("--stripe-width=-1", "--stripe-width: -1 is out of range"),
        ("--stripe-width 0", "--stripe-width: 0 is out of range"),
    ] {
        let message = set.error(&format!("{TRAIN} {options}"));
        assert!(message.starts_with(&format!("error: {cause}")), "{options}: {message}");
    }
    let message = set.error(&format!("{TRAIN} --stripe ceiling"));
    assert!(message.contains("[possible values: floor, wall]"), "{message}");
    for (place, cause) in [
        ("colours.json", "the name must end in .toml"),
        ("no/colours.toml", "there is no folder "),
        ("images", "this is a folder, not a file"),
    ] {
        let message = set.error(&TRAIN.replace("colours.toml", place));
        assert!(message.starts_with(&format!("error: {place}: {cause}")), "{message}");
    }
    assert_eq!(set.written(), ["camera.toml", "images", "labels"]);
}
