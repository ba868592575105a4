//! The mirror's rim in drawn images.

use image::{GrayImage, Luma, imageops};
use toposlam_vision::camera::rim::{self, RimDoubt, RimError};

struct Chance(u64);

impl Chance {
    fn number(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.number()
    }

    fn noise(&mut self) -> f64 {
        (0..12).map(|_| self.number()).sum::<f64>() - 6.0
    }
}

#[derive(Clone, Copy)]
struct Drawn {
    size: [u32; 2],
    centre: [f64; 2],
    radius: f64,
    around: f64,
    noise: f64,
    /// A ring around the mirror: its width as a part of the radius, its brightness, and how far it is to the right.
    holder: [f64; 3],
    /// The part of the circle outside of which the scene goes on, so that it has no edge there.
    open: f64,
}

const PLAIN: Drawn = Drawn {
    size: [640, 480],
    centre: [322.3, 241.8],
    radius: 224.6,
    around: 12.0,
    noise: 4.0,
    holder: [0.0; 3],
    open: 0.0,
};

/// A disc with a scene in it: patches of light and dark, and two struts across; vignetting, noise.
fn draw(drawn: &Drawn, seed: u64) -> GrayImage {
    let mut chance = Chance(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
    // Half planes that are brighter or darker.
    let patches: Vec<[f64; 4]> = (0..12)
        .map(|_| {
            let angle = chance.between(0.0, std::f64::consts::TAU);
            let far = chance.between(-1.0, 1.0) * drawn.radius;
            [angle.cos(), angle.sin(), far, chance.between(-45.0, 45.0)]
        })
        .collect();
    let base = chance.between(70.0, 150.0);
    let [width, height] = drawn.size;
    let light = |u: f64, v: f64| {
        let [across, down] = [u - drawn.centre[0], v - drawn.centre[1]];
        let from_centre = across.hypot(down);
        let vignette = 1.0 - 0.35 * (from_centre / drawn.radius).powi(2);
        let strut = (0.3 * across + 0.95 * down).abs() < 0.012 * from_centre;
        let bearing = down.atan2(across) / std::f64::consts::TAU + 0.5;
        let [width, brightness, right] = drawn.holder;
        if from_centre > drawn.radius && bearing >= drawn.open {
            let is_holder = (across - right).hypot(down) < (1.0 + width) * drawn.radius;
            if is_holder { brightness } else { drawn.around }
        } else if strut || from_centre < 0.15 * drawn.radius {
            20.0
        } else {
            let inside = |patch: &&[f64; 4]| patch[0] * across + patch[1] * down > patch[2];
            let patches: f64 = patches.iter().filter(inside).map(|patch| patch[3]).sum();
            (base + patches).clamp(35.0, 250.0) * vignette.max(0.2)
        }
    };
    GrayImage::from_fn(width, height, |u, v| {
        let [across, down] = [f64::from(u) - drawn.centre[0], f64::from(v) - drawn.centre[1]];
        // With more samples at the rim.
        let finely = (across.hypot(down) - drawn.radius).abs() < 2.0;
        let steps = if finely { 8 } else { 1 };
        let within = |step: u32| (f64::from(step) + 0.5) / f64::from(steps) - 0.5;
        let mut sum = 0.0;
        for row in 0..steps {
            for column in 0..steps {
                sum += light(f64::from(u) + within(column), f64::from(v) + within(row));
            }
        }
        let mean = sum / f64::from(steps * steps);
        Luma([(mean + drawn.noise * chance.noise()).round().clamp(0.0, 255.0) as u8])
    })
}

fn images(drawn: &Drawn, count: u64, seed: u64) -> Vec<GrayImage> {
    (0..count).map(|number| draw(drawn, 1000 * seed + number + 1)).collect()
}

fn found(drawn: &Drawn, count: u64, seed: u64) {
    let rim = rim::find(&images(drawn, count, seed)).unwrap();
    let off = (rim.centre[0] - drawn.centre[0]).hypot(rim.centre[1] - drawn.centre[1]);
    let what = format!("{count} images, seed {seed}: {:?} {} {}", rim.centre, rim.radius, rim.seen);
    assert!(off < 0.5 && (rim.radius - drawn.radius).abs() < 0.5, "{what}");
    assert!(rim.spread < 1.0 && rim.seen <= 1.0, "{what} {}", rim.spread);
}

/// A disc somewhere in the middle, with a radius in a range.
fn anywhere(seed: u64, [across, down]: [[f64; 2]; 2], radius: [f64; 2]) -> Drawn {
    let mut chance = Chance(seed);
    let mut between = |[low, high]: [f64; 2]| chance.between(low, high);
    Drawn { centre: [between(across), between(down)], radius: between(radius), ..PLAIN }
}

#[test]
#[ignore = "a long sweep, for `.ci/run --all`"]
fn the_rim_of_a_bright_disc_is_found_within_half_a_pixel() {
    for seed in 0..6 {
        let drawn = anywhere(seed + 77, [[280.0, 360.0], [225.0, 255.0]], [140.0, 220.0]);
        found(&drawn, 1, seed);
        found(&drawn, 4, seed);
    }
}

#[test]
fn a_rim_that_the_images_border_crops_is_found_by_its_arcs() {
    for seed in 0..4 {
        let drawn = anywhere(seed + 7, [[300.0, 340.0], [225.0, 255.0]], [260.0, 290.0]);
        found(&drawn, 4, seed);
    }
}

#[test]
fn noise_does_not_hide_the_rim() {
    found(&Drawn { noise: 25.0, ..PLAIN }, 4, 1);
    found(&Drawn { noise: 12.0, around: 25.0, ..PLAIN }, 3, 2);
}

#[test]
fn a_large_image_is_as_good() {
    let drawn = Drawn {
        size: [1280, 960],
        centre: [652.4, 470.7],
        radius: 447.2,
        around: 9.0,
        noise: 5.0,
        ..PLAIN
    };
    found(&drawn, 2, 3);
}

#[test]
#[ignore = "a long sweep, for `.ci/run --all`"]
fn without_a_mirror_there_is_no_rim() {
    let noise = |seed| {
        let mut chance = Chance(seed);
        GrayImage::from_fn(320, 240, |_, _| Luma([(100.0 + 20.0 * chance.noise()) as u8]))
    };
    for seed in 1..20 {
        let found = rim::find(&[noise(seed), noise(99 * seed)]);
        assert!(found.is_err(), "{seed}: {found:?}");
    }
    for value in [0, 128, 255] {
        let flat = GrayImage::from_pixel(320, 240, Luma([value]));
        assert!(matches!(rim::find(&[flat]), Err(RimError::NoRim)));
    }
    // A disc darker than its surroundings is not a mirror.
    let drawn = Drawn { around: 250.0, ..PLAIN };
    assert!(rim::find(&images(&drawn, 2, 5)).is_err());
}

#[test]
fn the_inner_border_of_a_narrow_dark_holder_is_the_rim() {
    for (width, right) in [(0.03, 0.0), (0.08, 0.0), (0.08, 3.5)] {
        let holder = [width, 8.0, right];
        found(&Drawn { radius: 190.0, around: 130.0, holder, ..PLAIN }, 2, 4);
    }
}

#[test]
fn of_circles_around_one_centre_both_are_named_and_neither_is_found() {
    let wide = [([0.17, 12.0, 0.0], 130.0), ([0.17, 230.0, 2.0], 12.0), ([0.3, 240.0, 0.0], 60.0)];
    let narrow = [([0.035, 235.0, 0.0], 12.0), ([0.08, 240.0, 1.0], 50.0)];
    for (number, (holder, around)) in wide.into_iter().chain(narrow).enumerate() {
        let drawn = Drawn { radius: 170.0, around, holder, ..PLAIN };
        let error = rim::find(&images(&drawn, 1, 6)).unwrap_err();
        let RimError::Uncertain { doubt: RimDoubt::Nested, circles } = &error else {
            panic!("{number}: {error:?}")
        };
        let [u, v] = drawn.centre;
        for expected in [[u, v, drawn.radius], [u + holder[2], v, drawn.radius * (1.0 + holder[0])]]
        {
            let is_near = |circle: &[f64; 3]| {
                circle.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1.0)
            };
            assert!(circles.iter().any(is_near), "{number}: {expected:?} {circles:?}");
        }
    }
}

#[test]
fn a_disc_inside_of_a_mirror_in_a_bright_holder_is_not_taken_for_the_mirror() {
    let mut image = draw(&Drawn { around: 250.0, ..PLAIN }, 8);
    for (u, v, pixel) in image.enumerate_pixels_mut() {
        // Three quarters of the robot's body.
        let is_body = (f64::from(u) - 340.0).hypot(f64::from(v) - 240.0) < 110.0;
        if is_body && (u < 340 || v < 240) {
            *pixel = Luma([245]);
        }
    }
    let error = rim::find(&[image]).unwrap_err();
    let RimError::Uncertain { circles, .. } = &error else { panic!("{error:?}") };
    assert!((circles[0][2] - PLAIN.radius).abs() < 0.5, "{error:?}");
}

#[test]
fn a_clear_leader_is_the_rim_if_two_fifths_of_it_are_seen() {
    for seed in 0..3 {
        found(&Drawn { open: 0.6, noise: 1.0, ..PLAIN }, 1, seed);
    }
}

#[test]
fn a_rim_of_which_the_images_border_cuts_off_half_is_found() {
    for (seed, centre) in [(1, [322.3, 2.0]), (2, [638.0, 241.8])] {
        found(&Drawn { centre, ..PLAIN }, 1, seed);
    }
}

#[test]
fn the_rim_of_a_mirror_that_is_seen_a_little_from_the_side_is_found() {
    let image = draw(&PLAIN, 3);
    // An ellipse whose axes differ by 1.25 %.
    let image = imageops::resize(&image, 640, 474, imageops::FilterType::Triangle);
    let rim = rim::find(&[image]).unwrap();
    assert!((rim.radius - PLAIN.radius).abs() < 0.02 * PLAIN.radius, "{rim:?}");
    assert!(rim.seen > 0.8, "seen {}", rim.seen);
}

#[test]
fn a_smooth_disc_is_not_taken_for_a_mirror() {
    let disc = GrayImage::from_fn(640, 480, |u, v| {
        let off = (f64::from(u) - 320.0).hypot(f64::from(v) - 240.0);
        // Brighter on one side, as a holder is.
        Luma([if off < 170.0 { 120 + (u / 16) as u8 } else { 20 }])
    });
    let error = rim::find(&[disc]).unwrap_err();
    let RimError::Uncertain { doubt: RimDoubt::Smooth, circles } = &error else {
        panic!("{error:?}")
    };
    assert!((circles[0][2] - 170.0).abs() < 1.0, "{circles:?}");
}

#[test]
fn images_of_different_sizes_are_rejected() {
    let small = GrayImage::new(320, 240);
    let error = rim::find(&[small.clone(), GrayImage::new(640, 480)]).unwrap_err();
    assert_eq!(error.to_string(), "image 2 is 640 by 480 pixels, the first is 320 by 240");
    assert_eq!(rim::find(&[]), Err(RimError::NoImage));
    assert!(matches!(rim::find(&[GrayImage::new(320, 20)]), Err(RimError::TooSmall(_))));
}
