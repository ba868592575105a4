//! `toposlam camera train`, on a few small rendered images and their labels. Invalid input is in
//! `tests/facts/train.txt`.

use std::{fs, sync::LazyLock};

use image::{Rgb, RgbImage};
use serde_json::json;
use toposlam_vision::{
    camera::{Camera, calibration},
    colour::ColourModel,
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

/// A copy of the rendered images whose numbers are among these.
fn copied(name: &str, numbers: &str) -> Scratch {
    let set = empty(name);
    for inside in ["images", "labels"] {
        for name in names_in(&RENDERED.path(inside)).iter().filter(|n| numbers.contains(&n[..1])) {
            let file = format!("{inside}/{name}");
            set.write(&file, RENDERED.bytes(&file));
        }
    }
    set
}

fn all(name: &str) -> Scratch {
    copied(name, "1234567")
}

fn render(set: &Scratch, pose: &str, out: &str) {
    let what =
        "draw worlds/shape-8.toml --marker directional --effect none --calibration camera.toml";
    set.out(&format!("{what} --pose {pose} --out {out}"), 0);
}

fn paint(set: &Scratch, name: &str, size: [u32; 2], colour: [u8; 3]) {
    RgbImage::from_pixel(size[0], size[1], Rgb(colour)).save(set.path(name)).unwrap();
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
    let stripe = json!({ "kind": "floor", "width": 0.05 });
    let fields = json!({ "images": 7, "folds": 5, "left_out": [], "stripe": stripe });
    has(&report, &fields, TRAIN);
    for (figures, class) in report["classes"].as_array().unwrap().iter().zip(CLASSES) {
        assert_eq!(figures["class"], class);
        // In such a small image, mixed pixels of floor and wall look like the stripe.
        for (figure, least) in [("recall", 0.97), ("precision", 0.70)] {
            assert!(figures[figure].as_f64().unwrap() > least, "{class}: {report}");
        }
        // Every pixel is classified once, with the colours learned from the other parts.
        let row = report["confusion"][class].as_object().unwrap();
        let all: u64 = row.values().map(|pixels| pixels.as_u64().unwrap()).sum();
        assert!(row.len() == 5 && all > 0 && figures["pixels"] == all, "{class}: {report}");
    }
    assert_eq!(set.written(), ["camera.toml", "colours.toml", "images", "labels"]);
    // The same images give the same colours.
    let (text, colours) = (set.out(TRAIN, 0), set.text("colours.toml"));
    assert_eq!((set.out(TRAIN, 0), set.text("colours.toml")), (text, colours));
    // In the hallway, between two junctions; and 0.6 m before the marked corner, which turns to the right.
    render(&set, "0.1,2,86", "hallway.png");
    render(&set, "0.05,7.4,91", "corner.png");
    let sense = "sense hallway.png corner.png --calibration camera.toml --colours colours.toml";
    let lines = set.lines(sense, 0);
    let expected = json!([{ "scene": "hallway" }, { "scene": "junction", "degree": 2 }]);
    has(&lines.clone().into(), &expected, sense);
    assert!((lines[0]["right"].as_f64().unwrap() - 0.7).abs() < 0.05, "{lines:?}");
    assert!((lines[1]["doors"][1].as_f64().unwrap() + 1.57).abs() < 0.1, "{lines:?}");
    assert!(lines[1]["marker"].is_object(), "{lines:?}");

    let other = format!("{TRAIN} --stripe wall=0.1");
    set.fact(&other, 0, &json!({ "folds": 5, "stripe": { "kind": "wall", "width": 0.1 } }));
    let text = set.out(&other, 0);
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
}

#[test]
fn what_cannot_be_cross_validated_is_reported() {
    // The last image shows the marker.
    let set = copied("train-single", "7");
    facts! { set;
        TRAIN => 0 {
            "images": 1, "folds": null, "not_validated": "there is only one image to learn from",
            "confusion": null, "classes.0.recall": null,
        };
    }
    // One of the two images has no stripe, so that neither part can be classified from the other.
    let set = copied("train-parts", "67");
    let whole = set.bytes("labels/7.png");
    relabel(&set, [255, 0, 0]);
    set.write("labels/7.png", whole);
    let why = "without part 2 of the images no pixel within 3 m is labelled as stripe";
    facts! { set;
        TRAIN => 0 { "not_validated": why };
    }
}

#[test]
fn images_without_light_are_left_out_and_a_marker_may_be_missing() {
    let set = all("train-dark");
    for (name, level) in [("black", 0), ("white", 255)] {
        paint(&set, &format!("images/{name}.png"), SIZE, [level; 3]);
        paint(&set, &format!("labels/{name}.png"), SIZE, [0, 255, 0]);
    }
    let left_out = json!([
        { "image": "images/black.png", "reason": "the floor beside the robot's body is too dark" },
        { "image": "images/white.png", "reason": "the floor beside the robot's body is overexposed" },
    ]);
    set.fact(TRAIN, 0, &json!({ "images": 7, "left_out": left_out }));
    // The colours are the same as without them.
    RENDERED.out(TRAIN, 0);
    let [one, other] = [&set, &RENDERED].map(|set| ColourModel::read(&set.bytes("colours.toml")));
    assert_eq!(one.unwrap(), other.unwrap());
    for name in names_in(&set.path("images")) {
        paint(&set, &format!("images/{name}"), SIZE, [0; 3]);
    }
    let message = set.error(TRAIN);
    assert!(message.ends_with("\nerror: images: every image was left out\n"), "{message}");

    let set = all("train-no-marker");
    relabel(&set, [0, 0, 255]);
    let output = set.run(&format!("{TRAIN} --json"));
    let message = "no marker is labelled: sensing with these colours sees no marker\n";
    assert_eq!((output.status.code(), &*stderr(&output)), (Some(0), message));
    let line = &objects(&stdout(&output))[0];
    assert_eq!(line["classes"][2]["pixels"], 0, "{line}");
    // Nothing is taken for a marker.
    assert!(CLASSES.iter().all(|class| line["confusion"][class]["marker"] == 0), "{line}");
    relabel(&set, [255, 0, 0]);
    facts! { set; TRAIN => 2 "labels: no pixel within 3 m is labelled as stripe (255,0,0)"; }
}
