//! Fuzz targets: what sensing guarantees for any bytes, as an image, a calibration and a colour file.
//!
//! Each target is run by cargo-fuzz, in `fuzz/`, and on stable Rust by `tests/fuzz.rs`, which uses the
//! seeds in `fuzz/corpus/` and mutations of them. A target panics if a guarantee does not hold.

use std::{cell::RefCell, fmt};

use toposlam_model::driving::scene::{Place, Scene};

use crate::{
    camera::{Camera, calibration},
    colour::{ColourModel, FloorRing, Gain},
    image_file::ImageFile,
    sensing::Sensor,
};

/// The name of a target, of its folder in `fuzz/corpus/`, and its body.
pub type VisionFuzzTarget = (&'static str, fn(&[u8]));

pub const TARGETS: &[VisionFuzzTarget] =
    &[("image", image), ("calibration", calibration), ("colours", colours)];

/// The size of the images: the smallest with which hallways and junctions can be distinguished.
const SIZE: [u32; 2] = [96, 72];

const COLOURS: &str = include_str!("../../fuzz/corpus/colours/of-the-images");

thread_local! {
    static SENSOR: RefCell<Sensor> = RefCell::new(Sensor::new(
        &Camera::superscout().sized(SIZE),
        &ColourModel::read(COLOURS.as_bytes())
            .unwrap_or_else(|error| panic!("the colours of the seeds: {error}")),
    ));
}

/// Any bytes are either a PNG or JPEG image, in which sensing finds a scene of finite numbers, twice the
/// same, or an error with one message.
///
/// # Panics
/// Panics if that does not hold.
pub fn image(bytes: &[u8]) {
    let image = match ImageFile::open(bytes) {
        // An image of another size is rejected by its header.
        Ok(file) if file.size() != SIZE => return,
        Ok(file) => file.image(),
        Err(error) => Err(error),
    };
    let image = match image {
        Ok(image) => image,
        Err(error) => return assert_is_a_message(&error),
    };
    assert_eq!(<[u32; 2]>::from(image.dimensions()), SIZE);
    SENSOR.with_borrow_mut(|sensor| match (sensor.sense(&image), sensor.sense(&image)) {
        (Ok(scene), Ok(again)) => {
            assert_eq!(scene, again);
            assert_is_of_numbers(&scene);
        }
        (one, other) => panic!("{one:?}, {other:?}: an image of the right size is rejected"),
    });
}

/// # Panics
/// Panics if a number of a scene is not finite, or a junction has no door or more than four.
pub fn assert_is_of_numbers(scene: &Scene) {
    let mut numbers = Vec::new();
    match &scene.place {
        Place::Hallway(view) => {
            numbers.extend([view.heading, view.left, view.right, view.confidence]);
        }
        Place::Junction(view) => {
            assert!((1..=4).contains(&view.doors.len()), "{scene:?}");
            let lines = view.doors.iter().map(|door| (door.through, door.direction));
            numbers.extend(lines.flat_map(|([x, y], direction)| [x, y, direction]));
            numbers.extend(view.turning_point);
            numbers.push(view.confidence);
        }
        Place::Unknown(_) => {}
    }
    if let Some(marker) = &scene.marker {
        numbers.extend([marker.position[0], marker.position[1], marker.axis]);
    }
    assert!(numbers.iter().all(|number| number.is_finite()), "{scene:?}");
}

/// Any bytes, up to the first zero byte, are either a calibration or an error with one message; what
/// follows is the file that the calibration names. The camera gives finite numbers, and what is written
/// of it can be read.
///
/// # Panics
/// Panics if that does not hold.
pub fn calibration(bytes: &[u8]) {
    let mut parts = bytes.splitn(2, |&byte| byte == 0);
    let (toml, named) = (parts.next().unwrap_or_default(), parts.next());
    let mut read = |_: &str| match named {
        Some(named) => Ok(named.to_vec()),
        None => Err(std::io::ErrorKind::NotFound.into()),
    };
    let camera = match calibration::read(toml, &mut read) {
        Ok(camera) => camera,
        Err(error) => return assert_is_a_message(&error),
    };
    for at in [-1e300, -1e3, 0.0, 0.5, 100.0, 640.0, 1e5, f64::NAN, f64::INFINITY] {
        for other in [-10.0, 0.0, 480.0, 1e200] {
            let shown = camera.pixel_to_ground([at, other]);
            assert!(shown.is_none_or(|at| !at.x.is_nan() && !at.y.is_nan()), "{at}, {other}");
            let found = camera.ground_to_pixel([other, at]);
            assert!(found.is_none_or(|at| at.x.is_finite() && at.y.is_finite()), "{at}, {other}");
        }
    }
    let _ = (camera.sees(camera.image), FloorRing::new(&camera));
    let text = calibration::to_toml(&camera);
    let again = calibration::read(text.as_bytes(), &mut read);
    assert!(again.is_ok(), "{again:?}\n{text}");
}

/// Any bytes are either a colour file or an error with one message. The model is written so that it
/// reads as the same model, and it has a class for every colour in every light.
///
/// # Panics
/// Panics if that does not hold.
pub fn colours(bytes: &[u8]) {
    let model = match ColourModel::read(bytes) {
        Ok(model) => model,
        Err(error) => return assert_is_a_message(&error),
    };
    let text = model.to_toml();
    let again = ColourModel::read(text.as_bytes());
    assert!(again.as_ref() == Ok(&model), "{model:?}\nis written as\n{text}\nread as\n{again:?}");
    let table = model.table();
    for gain in [0.0, 0.3, 1.0, 5.0, f64::NAN] {
        let lit = table.lit(Gain([gain; 3]));
        for level in [0, 1, 127, 255] {
            let _ = lit.class([level, 255 - level, level / 2]);
        }
    }
}

fn assert_is_a_message(error: &impl fmt::Display) {
    let message = error.to_string();
    assert!(!message.is_empty(), "an error has no message");
    assert!(!message.contains(char::is_control), "a message has control characters: {message:?}");
}
