//! Visits with measurements, and measurements that contradict each other.

use std::fmt;

use super::HallwayMeasurement;
use crate::{driving::visit::JunctionShape, embedded_graph::Dart, percept::Door};

/// A visit of a vertex, with what was measured on the way there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeasuredVisit {
    /// The darts of the vertex, clockwise from the one by which the robot came in; none if it is not known which
    /// vertex it is. Darts that are proved to be one are equal.
    pub darts: Vec<Dart>,
    /// The junction's shape, if its doors are at right angles and the hallways are straight.
    pub shape: Option<JunctionShape>,
    /// The measurement of the hallway by which the robot came; `None` at the start, and if it was not measured.
    pub arrived: Option<HallwayMeasurement>,
    /// The door by which the robot left; `None` at the end.
    pub left_by: Option<Door>,
}

/// A measurement that contradicts others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContradictoryMeasurement {
    /// The hallway has another length than before, in metres.
    Length {
        before: f64,
        now: f64,
    },
    /// The hallway turns otherwise than before, in radians counter-clockwise.
    Turn {
        /// By the measurement before it, seen in the direction of this one.
        before: f64,
        now: f64,
    },
    Shape,
    /// The turns of a closed walk are this number of quarter turns too many, from 1 to 3.
    ClosedTurns {
        /// Counter-clockwise.
        quarters: u32,
    },
    /// The displacements of a closed walk do not add up.
    ClosedWalk {
        /// The distance between its two ends, in metres.
        off: f64,
        /// The length of the walk, in metres.
        way: f64,
    },
}

impl fmt::Display for ContradictoryMeasurement {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match *self {
            Self::Length { before, now } => {
                write!(out, "the hallway is {now:.1} m long, and was {before:.1} m")
            }
            Self::Turn { before, now } => {
                let [before, now] = [before, now].map(f64::to_degrees);
                write!(out, "the hallway turns by {now:.0} degrees, and by {before:.0}")
            }
            Self::Shape => out.write_str("the junction has another shape than before"),
            Self::ClosedTurns { quarters } => {
                let degrees = 90 * quarters;
                write!(out, "the turns of this closed walk are {degrees} degrees too many")
            }
            Self::ClosedWalk { off, way } => {
                write!(out, "this closed walk of {way:.1} m ends {off:.1} m from where it began")
            }
        }
    }
}

/// Measurements that contradict each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasurementContradiction {
    /// The visit at the end of the measurement.
    pub visit: usize,
    /// The earlier visit that it contradicts: the end of an earlier traversal of the hallway, the beginning of the
    /// closed walk, or the last visit of the junction.
    pub earlier: usize,
    pub measurement: ContradictoryMeasurement,
}
