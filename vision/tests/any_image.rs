//! For any image, sensing finds a scene, and the same one each time: buildings in pieces, lamps and posters
//! anywhere, noise.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

use std::sync::LazyLock;

use image::{Rgb, RgbImage};
use proptest::{collection::vec, prelude::*};
use toposlam_model::driving::scene::Place;
use toposlam_vision::{annotate, camera::Camera, colour::ColourModel, sensing::Sensor};

const SIZE: [u32; 2] = [160, 120];

/// Floor, stripe, marker and wall in these colours.
const COLOURS: [[u8; 3]; 4] = [[104, 106, 110], [232, 231, 224], [205, 35, 140], [150, 120, 80]];
const MODEL: &str = include_str!("../../fuzz/corpus/colours/of-the-images");

static SENSOR: LazyLock<Sensor> = LazyLock::new(|| {
    let colours = ColourModel::read(MODEL.as_bytes()).unwrap();
    Sensor::new(&Camera::superscout().sized(SIZE), &colours)
});

/// A patch that is painted over an image.
#[derive(Clone, Debug)]
enum Patch {
    /// A rectangle from one corner to another.
    Rectangle { from: [u32; 2], to: [u32; 2], colour: [u8; 3] },
    /// Everything farther from the middle.
    Beyond { radius: f64, colour: [u8; 3] },
    /// Everything between two bearings.
    Sector { from: f64, wide: f64, colour: [u8; 3] },
    /// Single pixels at regular distances.
    Specks { step: usize, colour: [u8; 3] },
}

impl Patch {
    fn covers(&self, nth: usize, [u, v]: [u32; 2]) -> bool {
        let (x, y) = (f64::from(u) - 80.0, f64::from(v) - 60.0);
        match self {
            Self::Rectangle { from, to, .. } => {
                (from[0]..to[0]).contains(&u) && (from[1]..to[1]).contains(&v)
            }
            Self::Beyond { radius, .. } => x.hypot(y) > *radius,
            Self::Sector { from, wide, .. } => {
                (y.atan2(x) - from).rem_euclid(std::f64::consts::TAU) < *wide
            }
            Self::Specks { step, .. } => nth.is_multiple_of(*step),
        }
    }

    fn colour(&self) -> [u8; 3] {
        match self {
            Self::Rectangle { colour, .. }
            | Self::Beyond { colour, .. }
            | Self::Sector { colour, .. }
            | Self::Specks { colour, .. } => *colour,
        }
    }
}

fn any_colour() -> impl Strategy<Value = [u8; 3]> {
    prop_oneof![9 => prop::sample::select(COLOURS.to_vec()), 1 => any::<[u8; 3]>()]
}

fn any_patch() -> impl Strategy<Value = Patch> {
    let corner = || [0..SIZE[0], 0..SIZE[1]];
    prop_oneof![
        3 => (corner(), corner(), any_colour())
            .prop_map(|(from, to, colour)| Patch::Rectangle { from, to, colour }),
        2 => (10.0..60.0_f64, any_colour())
            .prop_map(|(radius, colour)| Patch::Beyond { radius, colour }),
        2 => (-3.2..3.2_f64, 0.0..2.0_f64, any_colour())
            .prop_map(|(from, wide, colour)| Patch::Sector { from, wide, colour }),
        1 => (1..200_usize, any_colour())
            .prop_map(|(step, colour)| Patch::Specks { step, colour }),
    ]
}

fn painted(patches: &[Patch]) -> RgbImage {
    RgbImage::from_fn(SIZE[0], SIZE[1], |u, v| {
        let nth = (v * SIZE[0] + u) as usize;
        let above = patches.iter().rev().find(|patch| patch.covers(nth, [u, v]));
        Rgb(above.map_or(COLOURS[0], Patch::colour))
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
        let numbers = match &scene.place {
            Place::Hallway(view) => vec![view.heading, view.left, view.right, view.confidence],
            Place::Junction(view) => {
                prop_assert!((1..=4).contains(&view.doors.len()), "{scene:?}");
                let doors = view.doors.iter().map(|door| door.direction);
                doors.chain(view.turning_point).chain([view.confidence]).collect()
            }
            Place::Unknown(_) => Vec::new(),
        };
        prop_assert!(numbers.iter().all(|number| number.is_finite()), "{scene:?}");
        if let Some(marker) = &scene.marker {
            prop_assert!(marker.position.iter().all(|number| number.is_finite()), "{scene:?}");
            prop_assert!(marker.axis.is_finite(), "{scene:?}");
        }
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
