//! `toposlam train`, on a few small rendered images and their labels.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::LazyLock,
};

use image::{Rgb, RgbImage};
use serde_json::{Value, json};
use toposlam_vision::{
    camera::{Camera, calibration},
    colour::{ColourModel, Stripe, StripeKind},
};

use super::{folder, names_in, objects, run, stderr, stdout, stdout_of};

const SIZE: [u32; 2] = [320, 240];
/// A PNG of 69 bytes whose header claims 16384 x 16384 pixels.
const PROMISES_MUCH: &str =
    concat!(env!("CARGO_MANIFEST_DIR"), "/fuzz/corpus/image/error-promises-much");
const CLASSES: [&str; 4] = ["floor", "stripe", "marker", "other"];

/// A folder with images, their labels and the calibration of their camera.
#[derive(Clone)]
struct Set(PathBuf);

/// Seven PNG and JPEG images of shape 8 on the way to its marked corner.
static RENDERED: LazyLock<Set> = LazyLock::new(|| {
    let set = Set::empty("train");
    for n in 1..=7 {
        let ending = if n % 2 == 0 { "jpg" } else { "png" };
        let [image, labels] = [format!("images/{n}.{ending}"), format!("labels/{n}.png")];
        set.render(&format!("0,{n},{}", 50 * n), &image, &["--labels", &set.path(&labels)]);
    }
    set
});

impl Set {
    fn empty(name: &str) -> Self {
        let folder = folder(name);
        for inside in ["images", "labels"] {
            fs::create_dir(folder.join(inside)).unwrap();
        }
        let camera = calibration::to_toml(&Camera::superscout().sized(SIZE));
        fs::write(folder.join("camera.toml"), camera).unwrap();
        Self(folder)
    }

    /// A copy of some of the rendered images.
    fn copy(name: &str, images: usize) -> Self {
        let set = Self::empty(name);
        for inside in ["images", "labels"] {
            for name in names_in(&RENDERED.0.join(inside)).iter().take(images) {
                let [from, to] = [&RENDERED, &set].map(|set| set.0.join(inside).join(name));
                fs::copy(from, to).unwrap();
            }
        }
        set
    }

    fn path(&self, name: &str) -> String {
        self.0.join(name).to_str().unwrap().to_owned()
    }

    fn render(&self, pose: &str, image: &str, more: &[&str]) {
        let [image, camera] = [image, "camera.toml"].map(|name| self.path(name));
        let what = ["draw", "worlds/shape-8.toml", "--with-marker", "--effects", "none"];
        let how = ["--pose", pose, "--calibration", &camera, "--out", &image];
        stdout_of([&what[..], &how, more].concat());
    }

    fn write(&self, name: &str, bytes: &[u8]) {
        fs::write(self.0.join(name), bytes).unwrap();
    }

    fn paint(&self, name: &str, size: [u32; 2], colour: [u8; 3]) {
        RgbImage::from_pixel(size[0], size[1], Rgb(colour)).save(self.0.join(name)).unwrap();
    }

    /// Arguments that learn from this set.
    fn train(&self, more: &[&str]) -> Vec<String> {
        let named = ["images", "labels", "camera.toml", "colours.toml"].map(|name| self.path(name));
        let flags = ["--images", "--labels", "--calibration", "--out"].map(str::to_owned);
        let pairs = flags.into_iter().zip(named).flat_map(|(flag, path)| [flag, path]);
        let more = more.iter().map(|&argument| argument.to_owned());
        ["camera", "train"].map(str::to_owned).into_iter().chain(pairs).chain(more).collect()
    }

    /// The JSON object.
    fn report(&self, more: &[&str]) -> Value {
        let text = stdout_of(self.train(&[&["--json"], more].concat()));
        let [report]: [Value; 1] = objects(&text).try_into().unwrap();
        report
    }

    fn model(&self) -> ColourModel {
        ColourModel::read(&fs::read(self.0.join("colours.toml")).unwrap()).unwrap()
    }

    /// The error message. Nothing is written.
    fn error_message(&self, more: &[&str]) -> String {
        let output = run(self.train(more));
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert_eq!((message.lines().count(), stdout(&output).as_str()), (1, ""), "{message}");
        assert!(!self.0.join("colours.toml").exists(), "{message}");
        message.strip_prefix("error: ").unwrap().to_owned()
    }
}

// paper: sense.classify, marker-sense.colour
#[test]
fn every_class_of_a_rendered_building_is_recognized() {
    let set = Set::copy("train-json", 7);
    let report = set.report(&[]);
    assert_eq!((&report["images"], &report["folds"]), (&json!(7), &json!(5)));
    assert_eq!(report["left_out"], json!([]));
    assert_eq!(report["stripe"], json!({ "kind": "floor", "width": 0.05 }));
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
    assert_eq!(names_in(&set.0), ["camera.toml", "colours.toml", "images", "labels"]);
}

#[test]
fn the_text_is_a_table() {
    let set = Set::copy("train-table", 7);
    let text = stdout_of(set.train(&["--folds", "7", "--stripe", "wall", "--stripe-width", "0.1"]));
    let stripe = Stripe { kind: StripeKind::OnWall, width: 0.1 };
    assert_eq!(set.model().stripe, stripe);
    assert!(text.starts_with("stripe  a baseboard on the wall, 0.1 m wide\nimages  7\n"), "{text}");
    assert!(text.contains("\nCross-validation in 7 parts:\n"), "{text}");
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
fn the_same_images_give_the_same_colours() {
    let [one, other] = ["train-one", "train-other"].map(|name| Set::copy(name, 5));
    let learned = |set: &Set| (stdout_of(set.train(&[])), set.model().to_toml());
    let first = learned(&one);
    assert_eq!(first, learned(&other));
    assert_eq!(first, learned(&one));
}

#[test]
fn sensing_works_with_the_learned_colours() {
    let set = Set::copy("train-sense", 7);
    stdout_of(set.train(&[]));
    // In the hallway, between two junctions; and 0.6 m before the marked corner, which turns to the right.
    set.render("0.1,2,86", "hallway.png", &[]);
    set.render("0.05,7.4,91", "corner.png", &[]);
    let [hallway, corner, camera, colours] =
        ["hallway.png", "corner.png", "camera.toml", "colours.toml"].map(|name| set.path(name));
    let files = ["--calibration", &camera, "--colours", &colours, "--json"];
    let text = stdout_of([&["sense", &hallway, &corner], &files[..]].concat());
    let [hallway, corner] = &objects(&text)[..] else { panic!("{text}") };
    assert_eq!(hallway["scene"], "hallway", "{text}");
    assert!((hallway["right"].as_f64().unwrap() - 0.7).abs() < 0.05, "{text}");
    assert_eq!((&corner["scene"], &corner["degree"]), (&json!("junction"), &json!(2)), "{text}");
    assert!((corner["doors"][1].as_f64().unwrap() + 1.57).abs() < 0.1, "{text}");
    assert!(corner["marker"].is_object(), "{text}");
}

#[test]
fn one_image_is_enough_but_is_not_cross_validated() {
    // The last image shows the marker.
    let set = Set::copy("train-single", 7);
    for name in names_in(&set.0.join("images")).iter().filter(|name| *name != "7.png") {
        fs::remove_file(set.0.join("images").join(name)).unwrap();
        let labels = Path::new(name).with_extension("png");
        fs::remove_file(set.0.join("labels").join(labels)).unwrap();
    }
    let text = stdout_of(set.train(&[]));
    let line = &objects(&stdout_of(set.train(&["--json"])))[0];
    assert_eq!(line["not_validated"], "there is only one image to learn from");
    let why = "\nnot cross-validated: there is only one image to learn from\n";
    assert!(text.ends_with(why), "{text}");
    let report = set.report(&[]);
    assert_eq!((&report["images"], &report["folds"]), (&json!(1), &Value::Null));
    assert_eq!(
        (&report["confusion"], &report["classes"][0]["recall"]),
        (&Value::Null, &Value::Null)
    );
    assert!(report["classes"][2]["pixels"].as_u64().unwrap() > 0, "{report}");
    fs::remove_file(set.0.join("colours.toml")).unwrap();
    let error_message = set.error_message(&["--folds", "2"]);
    assert_eq!(error_message, "--folds: 1 image cannot be divided; there must be at least 2\n");
}

#[test]
fn images_that_are_too_dark_or_bright_are_left_out_and_reported() {
    let set = Set::copy("train-dark", 7);
    for (name, level) in [("black", 0), ("white", 255)] {
        set.paint(&format!("images/{name}.png"), SIZE, [level; 3]);
        set.paint(&format!("labels/{name}.png"), SIZE, [0, 255, 0]);
    }
    let output = run(set.train(&["--json"]));
    let report = &objects(&stdout(&output))[0];
    let [black, white] = ["black", "white"].map(|name| set.path(&format!("images/{name}.png")));
    let dark = "the floor beside the robot's body is too dark";
    let burnt = "the floor beside the robot's body is overexposed";
    assert_eq!(stderr(&output), format!("left out: {black}: {dark}\nleft out: {white}: {burnt}\n"));
    let left_out = [(black, dark), (white, burnt)];
    let left_out = left_out.map(|(image, reason)| json!({ "image": image, "reason": reason }));
    assert_eq!((&report["images"], &report["left_out"]), (&json!(7), &json!(left_out)));
    let text = stdout_of(set.train(&[]));
    assert!(text.contains("\nimages  7, and 2 left out\n"), "{text}");
    // The colours are the same as without them.
    let model = set.model();
    stdout_of(RENDERED.train(&[]));
    assert_eq!(model, RENDERED.model());
}

/// Breaks a set. Returns the beginning of the error message.
type Breaking = fn(&Set) -> String;

#[test]
#[expect(clippy::too_many_lines, reason = "a list")]
fn invalid_images_and_labels_are_refused_with_the_file() {
    let cases: [(&str, Breaking); 18] = [
        ("no-image", |set| {
            fs::remove_dir_all(set.0.join("images")).unwrap();
            fs::create_dir(set.0.join("images")).unwrap();
            set.write("images/notes.txt", b"");
            set.write("images/.7.png", b"");
            let images = set.path("images");
            format!("{images}: there is no image in this folder: no .png, .jpg or .jpeg")
        }),
        ("no-folder", |set| {
            fs::remove_dir_all(set.0.join("labels")).unwrap();
            format!("{}: cannot be read as a folder: ", set.path("labels"))
        }),
        ("image-alone", |set| {
            fs::remove_file(set.0.join("labels/6.png")).unwrap();
            let [image, labels] = ["images/6.jpg", "labels/6.png"].map(|name| set.path(name));
            format!("{image}: its labels, {labels}, are not there")
        }),
        ("labels-alone", |set| {
            fs::remove_file(set.0.join("images/6.jpg")).unwrap();
            let [labels, images] = ["labels/6.png", "images"].map(|name| set.path(name));
            format!("{labels}: there is no image of this name in {images}")
        }),
        ("twice", |set| {
            fs::copy(set.0.join("images/6.jpg"), set.0.join("images/6.PNG")).unwrap();
            let [first, second] = ["images/6.PNG", "images/6.jpg"].map(|name| set.path(name));
            format!("{second}: its labels would be those of {first}")
        }),
        ("text", |set| {
            set.write("images/7.png", b"a picture");
            format!("{}: this is not an image; it must be PNG or JPEG", set.path("images/7.png"))
        }),
        ("truncated-png", |set| {
            let png = fs::read(set.0.join("images/7.png")).unwrap();
            set.write("images/7.png", &png[..png.len() / 2]);
            format!("{}: this cannot be read as an image: ", set.path("images/7.png"))
        }),
        ("truncated-jpeg", |set| {
            let jpeg = fs::read(set.0.join("images/6.jpg")).unwrap();
            set.write("images/6.jpg", &jpeg[..jpeg.len() - 9]);
            let image = set.path("images/6.jpg");
            format!("{image}: this cannot be read as an image: the file is truncated")
        }),
        ("image-size", |set| {
            set.paint("images/7.png", [640, 480], [90; 3]);
            let image = set.path("images/7.png");
            format!("{image}: the image has 640 x 480 pixels; those of the calibrated camera have ")
        }),
        ("image-promises-much", |set| {
            fs::copy(PROMISES_MUCH, set.0.join("images/7.png")).unwrap();
            format!("{}: the image has 16384 x 16384 pixels; those of", set.path("images/7.png"))
        }),
        ("labels-promise-much", |set| {
            fs::copy(PROMISES_MUCH, set.0.join("labels/7.png")).unwrap();
            format!("{}: the labels have 16384 x 16384 pixels; their", set.path("labels/7.png"))
        }),
        ("labels-size", |set| {
            set.paint("labels/7.png", [240, 320], [0, 255, 0]);
            let labels = set.path("labels/7.png");
            format!("{labels}: the labels have 240 x 320 pixels; their image has 320 x 240")
        }),
        ("label-colour", |set| {
            let path = set.0.join("labels/7.png");
            let mut labels = image::open(&path).unwrap().into_rgb8();
            labels.put_pixel(3, 5, Rgb([255, 0, 255]));
            labels.save(path).unwrap();
            let labels = set.path("labels/7.png");
            format!(
                "{labels}: the label at pixel (3, 5) has the colour (255, 0, 255); there can be \
                 floor (0,255,0), stripe (255,0,0), marker (0,0,255), other (0,0,0), ignore \
                 (255,255,255)"
            )
        }),
        ("labels-are-text", |set| {
            set.write("labels/7.png", b"floor");
            format!("{}: this is not an image; it must be PNG or JPEG", set.path("labels/7.png"))
        }),
        ("no-stripe", |set| relabelled(set, [255, 0, 0], "stripe (255,0,0)")),
        ("no-light", |set| {
            for name in names_in(&set.0.join("images")) {
                set.paint(&format!("images/{name}"), SIZE, [0; 3]);
            }
            format!("left out: {}: ", set.path("images/1.png"))
        }),
        ("calibration", |set| {
            let text = fs::read_to_string(set.0.join("camera.toml")).unwrap();
            set.write(
                "camera.toml",
                text.replace("camera_height = 0.9", "camera_height = 90").as_bytes(),
            );
            let camera = set.path("camera.toml");
            format!(
                "{camera}: line 8, column 17: camera.camera_height: 90 is out of range; a height above the floor in \
                 metres lies between 0.01 and 10"
            )
        }),
        ("no-calibration", |set| {
            fs::remove_file(set.0.join("camera.toml")).unwrap();
            format!("{}: cannot be read: ", set.path("camera.toml"))
        }),
    ];
    for (name, breaking) in cases {
        let set = Set::copy(&format!("train-rejected-{name}"), 7);
        let expected = breaking(&set);
        if name == "no-light" {
            // Each image is named before the error_message.
            let output = run(set.train(&[]));
            let message = stderr(&output);
            assert_eq!(output.status.code(), Some(2), "{message}");
            assert!(message.starts_with(&expected), "{message}");
            let last = format!("\nerror: {}: every image was left out\n", set.path("images"));
            assert!(message.ends_with(&last), "{message}");
            continue;
        }
        let error_message = set.error_message(&[]);
        assert!(error_message.starts_with(&expected), "{name}: {error_message}");
    }
}

#[test]
fn without_a_labelled_marker_the_other_classes_are_learned() {
    let set = Set::copy("train-no-marker", 7);
    relabelled(&set, [0, 0, 255], "");
    let output = run(set.train(&["--json"]));
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{message}");
    assert_eq!(message, "no marker is labelled: sensing with these colours sees no marker\n");
    let line = &objects(&stdout(&output))[0];
    let pixels: Vec<_> =
        line["classes"].as_array().unwrap().iter().map(|class| class["pixels"] != 0).collect();
    assert_eq!(pixels, [true, true, false, true]);
    // Nothing is taken for a marker.
    let marker = |class: &str| &line["confusion"][class]["marker"];
    assert!(CLASSES.iter().all(|class| marker(class) == 0), "{line}");
}

/// Sets one label colour to ignore. Returns the message that the class is missing.
fn relabelled(set: &Set, colour: [u8; 3], missing: &str) -> String {
    for name in names_in(&set.0.join("labels")) {
        let path = set.0.join("labels").join(name);
        let mut labels = image::open(&path).unwrap().into_rgb8();
        for label in labels.pixels_mut().filter(|label| label.0 == colour) {
            *label = Rgb([255; 3]);
        }
        labels.save(path).unwrap();
    }
    format!("{}: no pixel within 3 m is labelled as {missing}", set.path("labels"))
}

#[test]
fn invalid_options_are_refused_with_the_allowed_values() {
    let set = Set::copy("train-arguments", 7);
    let cases: [(&[&str], &str); 6] = [
        (
            &["--folds", "1"],
            "--folds: 7 images cannot be divided into 1; there can be from 2 to 7 parts",
        ),
        (
            &["--folds", "8"],
            "--folds: 7 images cannot be divided into 8; there can be from 2 to 7 parts",
        ),
        (
            &["--stripe-width", "5"],
            "--stripe-width: 5 is out of range; the width of a stripe in metres lies between 0.005 \
             and 0.5",
        ),
        (&["--stripe-width", "nan"], "--stripe-width: NaN is out of range"),
        (&["--stripe-width=-1"], "--stripe-width: -1 is out of range"),
        (&["--stripe-width", "0"], "--stripe-width: 0 is out of range"),
    ];
    for (arguments, message) in cases {
        let error_message = set.error_message(arguments);
        assert!(error_message.starts_with(message), "{arguments:?}: {error_message}");
    }
    let output = run(set.train(&["--stripe", "ceiling"]));
    assert!(stderr(&output).contains("[possible values: floor, wall]"));
    for (place, cause) in [
        (set.path("colours.json"), "the name must end in .toml"),
        (set.path("no/colours.toml"), "there is no folder "),
        (set.path(""), "this is a folder, not a file"),
    ] {
        let mut arguments = set.train(&[]);
        let out = arguments.iter().position(|argument| argument == "--out").unwrap();
        arguments[out + 1].clone_from(&place);
        let output = run(arguments);
        assert_eq!(output.status.code(), Some(2));
        assert!(
            stderr(&output).starts_with(&format!("error: {place}: {cause}")),
            "{}",
            stderr(&output)
        );
    }
    assert_eq!(names_in(&set.0), ["camera.toml", "images", "labels"]);
}

#[test]
fn a_class_that_occurs_in_one_part_only_is_reported() {
    // One of the two images has no stripe, so that neither part can be classified from the other.
    let set = Set::copy("train-parts", 7);
    for name in names_in(&set.0.join("images"))
        .iter()
        .filter(|name| !["6.jpg", "7.png"].contains(&name.as_str()))
    {
        fs::remove_file(set.0.join("images").join(name)).unwrap();
        let labels = Path::new(name).with_extension("png");
        fs::remove_file(set.0.join("labels").join(labels)).unwrap();
    }
    let path = set.0.join("labels/6.png");
    let mut labels = image::open(&path).unwrap().into_rgb8();
    for label in labels.pixels_mut().filter(|label| label.0 == [255, 0, 0]) {
        *label = Rgb([255; 3]);
    }
    labels.save(path).unwrap();
    let why = "without part 2 of the images no pixel within 3 m is labelled as stripe\n";
    assert!(stdout_of(set.train(&[])).ends_with(&format!("\nnot cross-validated: {why}")));
    fs::remove_file(set.0.join("colours.toml")).unwrap();
    assert_eq!(set.error_message(&["--folds", "2"]), format!("--folds: {why}"));
}
