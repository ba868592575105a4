//! The colour classifier on images of a few colours, in many kinds of light.

#![allow(clippy::cast_sign_loss, reason = "levels are never negative")]

use std::sync::{
    LazyLock,
    atomic::{AtomicU64, Ordering},
};

use image::{Rgb, RgbImage};
use nalgebra::Point2;
use proptest::prelude::*;
use toposlam_model::enumerate::{Interrupted, Watch};
use toposlam_vision::{
    camera::Camera,
    colour::{
        ColourModel, ExampleError, FloorRing, Gain, LightError, PixelClass, Stripe, StripeKind,
        Training, TrainingError,
    },
};

static CAMERA: LazyLock<Camera> = LazyLock::new(Camera::superscout);
/// The point of the floor that each pixel shows.
static GROUND: LazyLock<Vec<Option<Point2<f64>>>> = LazyLock::new(|| {
    let [width, height] = CAMERA.image;
    let pixels = (0..height).flat_map(|v| (0..width).map(move |u| [u, v].map(f64::from)));
    pixels.map(|pixel| CAMERA.pixel_to_ground(pixel)).collect()
});

const TAPE: Stripe = Stripe { kind: StripeKind::OnFloor, width: 0.05 };

const COLOURS: [[f64; 3]; 4] =
    [[104.0, 106.0, 110.0], [225.0, 224.0, 216.0], [205.0, 35.0, 140.0], [176.0, 150.0, 112.0]];

fn class(ground: Point2<f64>) -> PixelClass {
    let [x, y] = [ground.x, ground.y.abs()];
    if y > 0.8 {
        PixelClass::Other
    } else if y > 0.75 {
        PixelClass::Stripe
    } else if (0.4..1.0).contains(&x) && y < 0.09 {
        PixelClass::Marker
    } else {
        PixelClass::Floor
    }
}

fn srgb_light(level: f64) -> f64 {
    ((level / 255.0 + 0.055) / 1.055).powf(2.4)
}

/// A random number from -1 to 1, always from the same seed.
fn chance(seed: u64, nth: u64) -> f64 {
    let mut mixed = (seed << 40 ^ nth).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    mixed = (mixed ^ mixed >> 31).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    (mixed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

#[derive(Clone, Copy, Debug)]
struct Taken {
    light: [f64; 3],
    noise: f64,
    seed: u64,
}

fn taken(Taken { light, noise, seed }: Taken) -> (RgbImage, RgbImage) {
    let [width, height] = CAMERA.image;
    let (mut image, mut labels) = (RgbImage::new(width, height), RgbImage::new(width, height));
    let pixels = image.pixels_mut().zip(labels.pixels_mut()).zip(GROUND.iter());
    for (nth, ((pixel, label), ground)) in pixels.enumerate() {
        let class = ground.map_or(PixelClass::Other, class);
        let place = PixelClass::LEARNED.iter().position(|&learned| learned == class).unwrap();
        *label = Rgb(class.label());
        *pixel = Rgb(std::array::from_fn(|channel| {
            let chance = chance(seed, nth as u64 * 3 + channel as u64);
            (COLOURS[place][channel] * light[channel] + noise * chance).round() as u8
        }));
    }
    (image, labels)
}

const LIGHTS: [[f64; 3]; 4] = [[1.0; 3], [0.6, 0.62, 0.7], [1.1, 1.05, 0.8], [0.8, 0.9, 0.5]];

/// What is learned from images in some of the lights, in this order.
fn trained(lights: &[usize]) -> Training {
    let mut training = Training::new(TAPE);
    for &light in lights {
        let taken_in = Taken { light: LIGHTS[light], noise: 6.0, seed: light as u64 };
        let (image, labels) = taken(taken_in);
        training.add(&CAMERA, &image, &labels).unwrap();
    }
    training
}

static TRAINING: LazyLock<Training> = LazyLock::new(|| trained(&[0, 1, 2, 3]));
static TRAINED: LazyLock<ColourModel> = LazyLock::new(|| TRAINING.model().unwrap());

/// The share of each class that is recognised.
fn recalls(model: &ColourModel, image: &RgbImage, gain: Gain) -> [f64; 4] {
    let table = model.table();
    let lit = table.lit(gain);
    let mut counts = [[0.0; 2]; 4];
    for (pixel, ground) in image.pixels().zip(GROUND.iter()) {
        let near = ground.filter(|at| (0.35..3.0).contains(&at.coords.norm()));
        let Some(class) = near.map(class) else { continue };
        let place = PixelClass::LEARNED.iter().position(|&learned| learned == class).unwrap();
        counts[place][0] += 1.0;
        counts[place][1] += f64::from(u8::from(lit.class(pixel.0) == class));
    }
    counts.map(|[all, right]| right / all)
}

// paper: sense.classify
#[test]
fn colours_are_recognised_in_new_light() {
    let ring = FloorRing::new(&CAMERA);
    for (left_out, &light) in LIGHTS.iter().enumerate() {
        let others: Vec<usize> = (0..LIGHTS.len()).filter(|&nth| nth != left_out).collect();
        let model = trained(&others).model().unwrap();
        let (image, _) = taken(Taken { light, noise: 6.0, seed: 77 });
        let gain = model.gain(&ring.colours(&image)).unwrap();
        let recalls = recalls(&model, &image, gain);
        assert!(recalls.iter().all(|&recall| recall > 0.99), "{light:?}: {recalls:?}");
    }
}

#[test]
fn without_its_gain_an_image_is_not_recognised() {
    let (image, _) = taken(Taken { light: [0.5, 0.5, 0.4], noise: 4.0, seed: 5 });
    let gain = TRAINED.gain(&FloorRing::new(&CAMERA).colours(&image)).unwrap();
    assert!(recalls(&TRAINED, &image, gain)[0] > 0.99);
    assert!(recalls(&TRAINED, &image, Gain([1.0; 3]))[0] < 0.01);
}

#[test]
fn a_colour_that_no_class_has_is_unknown() {
    let table = TRAINED.table();
    let lit = table.lit(Gain([1.0; 3]));
    for colour in [[0, 255, 0], [0, 0, 255], [255, 255, 0], [20, 90, 30], [0, 0, 0]] {
        assert_eq!(lit.class(colour), PixelClass::Unknown, "{colour:?}");
    }
    // In the light of the model.
    let gain = [0, 1, 2]
        .map(|channel| srgb_light(TRAINED.floor[channel]) / srgb_light(COLOURS[0][channel]));
    let lit = table.lit(Gain(gain));
    let seen = COLOURS.map(|colour| lit.class(colour.map(|level| level as u8)));
    assert_eq!(seen, PixelClass::LEARNED);
}

/// An image in which floor and tape mix at the tape's edges, and its labels. On request a patch of floor
/// in the shade has the colour of the mixture.
fn blurred(shade: bool) -> (RgbImage, RgbImage) {
    let (mut image, labels) = taken(Taken { light: [1.0; 3], noise: 0.0, seed: 0 });
    let [width, height] = CAMERA.image;
    let around = |u: u32, v: u32| {
        (v.max(1) - 1..=(v + 1).min(height - 1))
            .flat_map(move |v| (u.max(1) - 1..=(u + 1).min(width - 1)).map(move |u| [u, v]))
    };
    for (nth, (u, v, pixel)) in image.enumerate_pixels_mut().enumerate() {
        let own = *labels.get_pixel(u, v);
        let is_mixed = around(u, v).any(|[u, v]| *labels.get_pixel(u, v) != own);
        let by_tape =
            [PixelClass::Floor, PixelClass::Stripe].map(|class| Rgb(class.label())).contains(&own);
        let in_shade =
            shade && GROUND[nth].is_some_and(|at| (-1.2..-1.0).contains(&at.x) && at.y.abs() < 0.1);
        if is_mixed && by_tape || in_shade {
            *pixel = Rgb(MIXTURE);
        }
    }
    (image, labels)
}

const MIXTURE: [u8; 3] = [172, 172, 170];

#[test]
fn a_mixture_at_a_stripes_edge_is_the_stripe_unless_floor_has_its_colour() {
    for (shade, expected) in [(false, PixelClass::Stripe), (true, PixelClass::Floor)] {
        let (image, labels) = blurred(shade);
        let mut training = Training::new(TAPE);
        training.add(&CAMERA, &image, &labels).unwrap();
        let model = training.model().unwrap();
        let found = model.table().lit(Gain([1.0; 3])).class(MIXTURE);
        assert_eq!(found, expected, "with floor of this colour: {shade}");
    }
}

#[test]
fn cross_validation_counts_every_labelled_pixel_once() {
    for folds in [2, 3, 4] {
        let confusion = TRAINING.cross_validate(folds, &()).unwrap();
        let all: u64 = PixelClass::LEARNED.map(|class| confusion.pixels(class)).iter().sum();
        let shown = |ground: &&Option<Point2<f64>>| {
            ground.is_some_and(|at| (0.32..=3.0).contains(&at.coords.norm()))
        };
        assert_eq!(all, 4 * GROUND.iter().filter(shown).count() as u64);
        for class in PixelClass::LEARNED {
            assert!(confusion.recall(class).unwrap() > 0.98, "{class:?} {confusion:?}");
            assert!(confusion.precision(class).unwrap() > 0.98, "{class:?} {confusion:?}");
        }
    }
    assert_eq!((TRAINING.images(), TRAINED.stripe), (4, TAPE));
}

struct QuestionLimit {
    at: u64,
    asked: AtomicU64,
}

impl Watch for QuestionLimit {
    fn stop(&self) -> bool {
        self.asked.fetch_add(1, Ordering::Relaxed) + 1 >= self.at
    }
}

/// The watch is asked before each part and before each image.
#[test]
fn cross_validation_ends_at_the_question_at_which_it_is_stopped() {
    for at in 1..=2 + 4 {
        let watch = QuestionLimit { at, asked: AtomicU64::new(0) };
        let stopped = TRAINING.cross_validate(2, &watch).unwrap_err();
        assert_eq!(stopped, TrainingError::Interrupted(Interrupted));
        assert_eq!(watch.asked.into_inner(), at);
    }
    let watch = QuestionLimit { at: 7, asked: AtomicU64::new(0) };
    TRAINING.cross_validate(2, &watch).unwrap();
}

#[test]
fn images_and_labels_that_do_not_fit_are_rejected() {
    let (image, labels) = taken(Taken { light: [1.0; 3], noise: 2.0, seed: 1 });
    let mut training = Training::new(TAPE);
    let small = RgbImage::new(640, 480);
    let mut wrong = labels.clone();
    wrong.put_pixel(3, 959, Rgb([0, 254, 0]));
    for (image, labels, message) in [
        (&small, &labels, "the image has 640 x 480 pixels; the calibration is for 1280 x 960"),
        (&image, &small, "the labels have 640 x 480 pixels; their image has 1280 x 960"),
        (
            &image,
            &wrong,
            "the label at pixel (3, 959) has the colour (0, 254, 0); there can be floor (0,255,0), \
             stripe (255,0,0), marker (0,0,255), other (0,0,0), ignore (255,255,255)",
        ),
    ] {
        assert_eq!(training.add(&CAMERA, image, labels).unwrap_err().to_string(), message);
    }
    for (light, cause) in [(0.1, LightError::TooDark), (3.0, LightError::BurntOut)] {
        let (image, labels) = taken(Taken { light: [light; 3], noise: 2.0, seed: 1 });
        let refused = training.add(&CAMERA, &image, &labels).unwrap_err();
        assert_eq!(refused, ExampleError::Light(cause));
        assert_eq!(TRAINED.gain(&FloorRing::new(&CAMERA).colours(&image)), Err(cause));
    }
    assert_eq!(training.images(), 0);
    assert_eq!(training.model().unwrap_err(), TrainingError::NoImage);
    training.add(&CAMERA, &image, &labels).unwrap();
    training.model().unwrap();
    let refused = training.cross_validate(2, &()).unwrap_err();
    assert_eq!(refused, TrainingError::Folds { folds: 2, images: 1 });
}

#[test]
fn floor_and_stripe_are_needed_and_the_marker_is_not() {
    let (image, labels) = taken(Taken { light: [1.0; 3], noise: 2.0, seed: 1 });
    let unlabelled = |missing: PixelClass| {
        let mut labels = labels.clone();
        for label in labels.pixels_mut().filter(|label| label.0 == missing.label()) {
            *label = Rgb(PixelClass::Unseen.label());
        }
        labels
    };
    let without = |missing: PixelClass| {
        let mut training = Training::new(TAPE);
        training.add(&CAMERA, &image, &unlabelled(missing)).unwrap();
        training.model()
    };
    for class in [PixelClass::Floor, PixelClass::Stripe] {
        assert_eq!(without(class).unwrap_err(), TrainingError::NoPixel { class });
    }
    let model = without(PixelClass::Marker).unwrap();
    let marker = COLOURS[2].map(|level| level as u8);
    assert_eq!(model.table().lit(Gain([1.0; 3])).class(marker), PixelClass::Unknown);
    without(PixelClass::Other).unwrap();
    // The first part has a stripe, the second has none.
    let mut training = Training::new(TAPE);
    training.add(&CAMERA, &image, &labels).unwrap();
    training.add(&CAMERA, &image, &unlabelled(PixelClass::Stripe)).unwrap();
    assert_eq!(
        training.cross_validate(2, &()).unwrap_err().to_string(),
        "without part 1 of the images no pixel within 3 m is labelled as stripe"
    );
}

#[test]
fn the_order_of_the_images_does_not_matter() {
    assert_eq!(&trained(&[3, 2, 1, 0]).model().unwrap(), &*TRAINED);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..Default::default() })]

    #[test]
    fn the_ring_gives_any_light(
        light in prop::array::uniform3(0.3..1.1_f64), noise in 0.0..8.0_f64, seed in 0..1000_u64,
    ) {
        let (image, _) = taken(Taken { light, noise, seed });
        let gain = TRAINED.gain(&FloorRing::new(&CAMERA).colours(&image)).unwrap();
        for channel in 0..3 {
            let there = srgb_light(COLOURS[0][channel] * light[channel]);
            let expected = srgb_light(TRAINED.floor[channel]) / there;
            prop_assert!((gain.0[channel] / expected - 1.0).abs() < 0.04, "{gain:?}");
        }
    }
}
