//! For any image, sensing finds a scene, and the same one each time: buildings in pieces, lamps and posters
//! anywhere, noise.

use std::sync::LazyLock;

use image::{Rgb, RgbImage};
use proptest::{collection::vec, prelude::*};
use toposlam_vision::{annotate, camera::Camera, colour::ColourModel, fuzz, sensing::Sensor};

const SIZE: [u32; 2] = [160, 120];

/// Floor, stripe, marker and wall in these colours.
const COLOURS: [[u8; 3]; 4] = [[104, 106, 110], [232, 231, 224], [205, 35, 140], [150, 120, 80]];
const MODEL: &str = include_str!("../../fuzz/corpus/colours/of-the-images");

static SENSOR: LazyLock<Sensor> = LazyLock::new(|| {
    let colours = ColourModel::read(MODEL.as_bytes()).unwrap();
    Sensor::new(&Camera::superscout().sized(SIZE), &colours)
});

#[derive(Clone, Debug)]
enum Patch {
    /// From one corner to another.
    Rectangle([u32; 2], [u32; 2]),
    /// Beyond a radius.
    Beyond(f64),
    /// From a direction on, over an angle.
    Sector(f64, f64),
    /// Single pixels at regular distances.
    Specks(usize),
}

impl Patch {
    fn covers(&self, nth: usize, [u, v]: [u32; 2]) -> bool {
        let (x, y) = (f64::from(u) - 80.0, f64::from(v) - 60.0);
        match *self {
            Self::Rectangle([left, top], [right, bottom]) => {
                (left..right).contains(&u) && (top..bottom).contains(&v)
            }
            Self::Beyond(radius) => x.hypot(y) > radius,
            Self::Sector(from, wide) => {
                (y.atan2(x) - from).rem_euclid(std::f64::consts::TAU) < wide
            }
            Self::Specks(step) => nth.is_multiple_of(step),
        }
    }
}

fn any_colour() -> impl Strategy<Value = [u8; 3]> {
    prop_oneof![9 => prop::sample::select(COLOURS.to_vec()), 1 => any::<[u8; 3]>()]
}

fn any_patch() -> impl Strategy<Value = (Patch, [u8; 3])> {
    let corner = || [0..SIZE[0], 0..SIZE[1]];
    let patch = prop_oneof![
        3 => (corner(), corner()).prop_map(|(from, to)| Patch::Rectangle(from, to)),
        2 => (10.0..60.0_f64).prop_map(Patch::Beyond),
        2 => (-3.2..3.2_f64, 0.0..2.0_f64).prop_map(|(from, wide)| Patch::Sector(from, wide)),
        1 => (1..200_usize).prop_map(Patch::Specks),
    ];
    (patch, any_colour())
}

fn painted(patches: &[(Patch, [u8; 3])]) -> RgbImage {
    RgbImage::from_fn(SIZE[0], SIZE[1], |u, v| {
        let nth = (v * SIZE[0] + u) as usize;
        let above = patches.iter().rev().find(|(patch, _)| patch.covers(nth, [u, v]));
        Rgb(above.map_or(COLOURS[0], |(_, colour)| *colour))
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1500) })]

    #[test]
    #[ignore = "a long sweep, for `.ci/run --all`"]
    fn any_image_has_a_scene_of_finite_numbers(patches in vec(any_patch(), 0..14)) {
        let image = painted(&patches);
        let mut sensor = SENSOR.clone();
        let scene = sensor.sense(&image).unwrap();
        prop_assert_eq!(&scene, &sensor.sense(&image).unwrap());
        fuzz::assert_is_of_numbers(&scene);
    }
}

proptest! {
    // Drawing takes longer than sensing.
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(100) })]

    #[test]
    fn the_steps_of_sensing_are_drawn_for_any_image(patches in vec(any_patch(), 0..14)) {
        let image = painted(&patches);
        let mut sensor = SENSOR.clone();
        let scene = sensor.sense(&image).unwrap();
        let (again, stages) = annotate::stages(&mut sensor, &image).unwrap();
        prop_assert_eq!(scene, again);
        prop_assert!(stages.iter().all(|(_, picture)| picture.width() > 0));
    }
}
