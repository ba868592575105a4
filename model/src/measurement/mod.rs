//! Measurements beside the percepts: the length of each traversed hallway, and its turn. They never make a map.
//! They contradict: a hallway has one length, and the turns and displacements of a closed walk add up to none.
//!
//! Each test is a likelihood-ratio test of "nothing happened" against "the robot was moved, or its wheels
//! slipped", with errors of a normal distribution ([`MeasurementNoise`]). Twice the logarithm of the likelihood ratio is
//! then of a chi-square distribution (Wilks 1938). It contradicts if it is above the quantile for [`FALSE_ALARMS`].

mod check;
mod closed_walk;
mod contradiction;
mod edge;
mod noise;

pub use check::MeasurementCheck;
pub use contradiction::{ContradictoryMeasurement, MeasuredVisit, MeasurementContradiction};
pub use noise::{HallwayMeasurement, MeasurementNoise};

/// The nominal rate of false alarms: the probability that a test contradicts if nothing happened.
pub const FALSE_ALARMS: f64 = 1e-5;
/// The quantile of the chi-square distribution with 1 degree of freedom for [`FALSE_ALARMS`]: the square of
/// 4.417 standard deviations.
const ONE_DEGREE: f64 = 19.511_421;
/// Its median.
const ONE_DEGREE_MEDIAN: f64 = 0.454_936;

/// The quantile of the chi-square distribution with 2 degrees of freedom for [`FALSE_ALARMS`]. The distribution is
/// exponential.
fn two_degrees() -> f64 {
    -2.0 * FALSE_ALARMS.ln()
}
