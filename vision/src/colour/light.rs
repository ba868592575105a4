//! The light of an image, from the floor beside the robot's body.

use std::ops::RangeInclusive;

use image::RgbImage;
use nalgebra::Point2;
use thiserror::Error;
use toposlam_model::driving::scene::Reason;

use super::Gain;
use crate::{camera::Camera, geometry::unit};

/// The inner and the outer radius of the ring of samples beyond what the body hides, in metres. Geometry: farther away
/// there may be walls.
const RING: [f64; 2] = [0.02, 0.18];
/// The number of bearings with samples. Geometry: every 1.5 degrees.
const BEARINGS: u32 = 240;
/// The number of samples on each bearing. Geometry: every 1.5 cm.
const RANGES: u32 = 12;
/// From this level on, a channel may be saturated. Geometry: a JPEG image blurs the greatest level.
const BURNT: u8 = 250;
/// Below this level of the brightest channel, single levels are too coarse to be multiplied. Geometry.
const DARK: f64 = 16.0;
/// Levels below this are noise. Views.
const NOISE: f64 = 4.0;
/// Samples of the floor differ from its colour by at most this factor. Views.
const SPREAD: f64 = 1.35;
/// At least this part of the samples is floor. Views.
const AGREEING: f64 = 0.3;

/// A ring of samples beside the robot's body, evenly spread in bearing and range. There is floor
/// wherever the robot is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FloorRing {
    size: [u32; 2],
    /// Pixels of an image, row by row.
    pixels: Vec<usize>,
}

impl FloorRing {
    pub fn new(camera: &Camera) -> Self {
        let hidden = camera.hidden_radius();
        let samples = (0..RANGES).flat_map(|nth| {
            let range =
                hidden + RING[0] + (RING[1] - RING[0]) * f64::from(nth) / f64::from(RANGES - 1);
            (0..BEARINGS).map(move |nth| {
                let bearing = std::f64::consts::TAU * f64::from(nth) / f64::from(BEARINGS);
                Point2::from(range * unit(bearing))
            })
        });
        let pixels = samples
            .filter_map(|ground| camera.seen_pixel(ground))
            .map(|pixel| pixel as usize)
            .collect();
        Self { size: camera.image, pixels }
    }

    /// The colours of the ring in an image of this camera; none in an image of another size.
    pub fn colours(&self, image: &RgbImage) -> Vec<[u8; 3]> {
        if <[u32; 2]>::from(image.dimensions()) != self.size {
            return Vec::new();
        }
        let (colours, _) = image.as_raw().as_chunks::<3>();
        self.pixels.iter().filter_map(|&pixel| colours.get(pixel).copied()).collect()
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum LightError {
    #[error("no floor beside the robot's body is seen")]
    Unseen,
    #[error("the floor beside the robot's body is overexposed")]
    BurntOut,
    #[error("the floor beside the robot's body is too dark")]
    TooDark,
    #[error("the floor beside the robot's body has no common colour")]
    Mixed,
}

impl From<LightError> for Reason {
    fn from(error: LightError) -> Self {
        match error {
            LightError::Unseen => Self::NoFloor,
            LightError::BurntOut => Self::Overexposed,
            LightError::TooDark => Self::TooDark,
            LightError::Mixed => Self::MixedFloor,
        }
    }
}

/// The colour of the floor in a ring of samples.
///
/// It starts with the median of each channel and continues with the mean of the samples near it in all
/// channels. Walls, stripes, the marker and reflections of lamps do not move the median far as long as
/// they are less than half of the samples; then they are left out and do not move the mean. If the light
/// changes around the robot, the mean is in the middle; a mode would be at one end.
pub(super) fn floor_colour(ring: &[[u8; 3]]) -> Result<[f64; 3], LightError> {
    let lit: Vec<_> =
        ring.iter().copied().filter(|colour| colour.iter().all(|&level| level < BURNT)).collect();
    if ring.is_empty() {
        return Err(LightError::Unseen);
    }
    if lit.len() * 2 < ring.len() {
        return Err(LightError::BurntOut);
    }
    let mut floor = median(&lit);
    let mut share = 1.0;
    for _ in 0..4 {
        let (mut count, mut sums) = (0_u32, [0_u32; 3]);
        let near = near(floor);
        let is_near = |colour: &&[u8; 3]| {
            let levels = colour.map(|level| f64::from(level).max(NOISE));
            near.iter().zip(&levels).all(|(near, level)| near.contains(level))
        };
        for colour in lit.iter().filter(is_near) {
            count += 1;
            sums = std::array::from_fn(|channel| sums[channel] + u32::from(colour[channel]));
        }
        if count > 0 {
            floor = sums.map(|sum| f64::from(sum) / f64::from(count));
        }
        share = f64::from(count) / ring.len() as f64;
    }
    if floor.into_iter().fold(0.0, f64::max) < DARK {
        Err(LightError::TooDark)
    } else if share < AGREEING {
        Err(LightError::Mixed)
    } else {
        Ok(floor)
    }
}

/// The levels of each channel that are near the colour of a floor.
fn near(floor: [f64; 3]) -> [RangeInclusive<f64>; 3] {
    let floor = floor.map(|level| level.max(NOISE));
    floor.map(|level| level / SPREAD - NOISE..=level * SPREAD + NOISE)
}

fn median(colours: &[[u8; 3]]) -> [f64; 3] {
    std::array::from_fn(|channel| {
        let mut counts = [0; 256];
        for colour in colours {
            counts[usize::from(colour[channel])] += 1;
        }
        let mut below = 0;
        let level = counts.iter().position(|&count: &usize| {
            below += count;
            below * 2 >= colours.len()
        });
        level.unwrap_or_default() as f64
    })
}

/// The gain that changes the floor of an image from one colour to another.
pub(super) fn gain(from: [f64; 3], to: [f64; 3]) -> Gain {
    Gain::between(from.map(|level| level.max(NOISE)), to.map(|level| level.max(NOISE)))
}

#[cfg(test)]
mod tests {
    use proptest::{collection::vec, prelude::*};

    use super::*;

    const FLOOR: [u8; 3] = [104, 106, 110];

    fn ring(floor: usize, others: &[([u8; 3], usize)]) -> Vec<[u8; 3]> {
        let others = others.iter().flat_map(|&(colour, count)| vec![colour; count]);
        vec![FLOOR; floor].into_iter().chain(others).collect()
    }

    #[test]
    fn less_than_half_of_the_ring_moves_nothing() {
        let (wall, marker, lamp, tape) = ([206, 190, 158], [205, 35, 140], [255; 3], [240; 3]);
        for (floor, others) in [
            (100, vec![]),
            (60, vec![(wall, 40)]),
            (55, vec![(wall, 25), (tape, 20)]),
            (70, vec![(marker, 30)]),
            (60, vec![(lamp, 40)]),
            (60, vec![(wall, 20), (marker, 10), (lamp, 10)]),
        ] {
            let found = floor_colour(&ring(floor, &others)).unwrap();
            let mut off = found.iter().zip(FLOOR).map(|(level, exact)| level - f64::from(exact));
            assert!(off.all(|off| off.abs() < 1e-9), "{others:?}: {found:?}");
        }
    }

    #[test]
    fn the_ring_lies_around_what_the_body_hides() {
        for radius in [0.32, 0.7] {
            let mut camera = Camera::superscout().sized([640, 480]);
            camera.hidden.radius = radius;
            let ring = FloorRing::new(&camera).pixels.into_iter().map(|pixel| {
                let pixel = [pixel % 640, pixel / 640].map(|at| at as f64 + 0.5);
                camera.pixel_to_ground(pixel).unwrap().coords.norm()
            });
            let [nearest, farthest] = ring
                .fold([f64::INFINITY, 0.0_f64], |[nearest, farthest], at| {
                    [nearest.min(at), farthest.max(at)]
                });
            let expected = RING.map(|range| radius + range);
            assert!((nearest - expected[0]).abs() < 0.03, "{nearest} for {expected:?}");
            assert!((farthest - expected[1]).abs() < 0.03, "{farthest} for {expected:?}");
        }
    }

    #[test]
    fn if_the_light_changes_around_the_robot_the_middle_counts() {
        // From three quarters to five quarters of the light, as around a circle.
        let bearings = (0..360).map(|degree| f64::from(degree).to_radians().cos());
        let ring: Vec<_> = bearings
            .map(|cosine| [100.0, 120.0, 80.0].map(|level| (level * (1.0 + 0.25 * cosine)) as u8))
            .collect();
        let found = floor_colour(&ring).unwrap();
        for (found, level) in found.into_iter().zip([100.0, 120.0, 80.0]) {
            assert!((found / level - 1.0).abs() < 0.03, "{found} for {level}");
        }
    }

    #[test]
    fn a_ring_that_does_not_give_the_light_gives_the_reason() {
        assert_eq!(floor_colour(&[]), Err(LightError::Unseen));
        assert_eq!(floor_colour(&ring(40, &[([255, 200, 180], 60)])), Err(LightError::BurntOut));
        assert_eq!(floor_colour(&[[15, 12, 3]; 10]), Err(LightError::TooDark));
        assert!(floor_colour(&[[16, 12, 3]; 10]).is_ok());
        let levels = (0..1000).map(|nth| [nth * 7 % 250, nth * 13 % 250, nth * 29 % 250]);
        let mixed: Vec<_> = levels.map(|colour| colour.map(|level| level as u8)).collect();
        assert_eq!(floor_colour(&mixed), Err(LightError::Mixed));
    }

    proptest! {
        #[test]
        fn the_order_of_the_samples_does_not_matter(ring in vec(any::<[u8; 3]>(), 0..60)) {
            let mut sorted = ring.clone();
            sorted.sort_unstable();
            prop_assert_eq!(floor_colour(&ring), floor_colour(&sorted));
        }

        #[test]
        fn a_floor_is_some_colour_of_its_ring(ring in vec(any::<[u8; 3]>(), 0..60)) {
            if let Ok(floor) = floor_colour(&ring) {
                for (channel, level) in floor.into_iter().enumerate() {
                    let levels = ring.iter().map(|colour| f64::from(colour[channel]));
                    let least = levels.clone().fold(255.0, f64::min);
                    prop_assert!((least..=levels.fold(0.0, f64::max)).contains(&level));
                }
            }
        }
    }
}
