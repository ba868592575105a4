//! The bearings on which a robot looks for the end of the floor, and the steps along each. Section 3, Figure 6(d).

use std::{f64::consts::TAU, sync::LazyLock};

use nalgebra::{Point2, Vector2};

use crate::geometry::unit;

/// The number of bearings: one each half degree.
pub const BEARINGS: usize = 720;
/// The length of a step along a bearing, in metres.
pub const STEP: f64 = 0.0075;
/// Where the search for floor begins, in metres: the robot's body hides what is nearer.
const NEAREST: f64 = 0.30;
/// Where it ends, in metres. Farther away a pixel covers more than a stripe.
pub const REACH: f64 = 2.6;
/// The number of steps along a bearing.
pub(crate) const STEPS: usize = ((REACH - NEAREST) / STEP) as usize;

/// The range of a step, in metres.
pub(crate) fn range(step: f64) -> f64 {
    NEAREST + step * STEP
}

/// The direction of a bearing: counter-clockwise from ahead.
pub fn direction(bearing: usize) -> Vector2<f64> {
    static DIRECTIONS: LazyLock<[Vector2<f64>; BEARINGS]> = LazyLock::new(|| {
        std::array::from_fn(|bearing| unit(TAU * bearing as f64 / BEARINGS as f64))
    });
    DIRECTIONS[bearing % BEARINGS]
}

/// The bearing nearest to a direction, in radians counter-clockwise from ahead.
pub fn bearing(direction: f64) -> usize {
    (direction.rem_euclid(TAU) / TAU * BEARINGS as f64).round() as usize % BEARINGS
}

/// The points of the floor on each bearing from the robot outwards, [`STEPS`] for each.
pub(crate) fn ground_on_bearings() -> impl Iterator<Item = Point2<f64>> {
    (0..BEARINGS).flat_map(|bearing| {
        (0..STEPS).map(move |step| Point2::from(range(step as f64) * direction(bearing)))
    })
}
