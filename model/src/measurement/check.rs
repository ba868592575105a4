//! The measurements of a walk whose visits are identified, compared.

use std::{collections::BTreeMap, fmt};

use super::{
    HallwayMeasurement, MeasurementNoise, ONE_DEGREE, ONE_DEGREE_MEDIAN,
    closed_walk::ClosedWalks,
    edge::{Deviation, EdgeMeasurement, EdgeMeasurements},
};
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
        /// By the measurements before it.
        before: f64,
        /// By this one.
        now: f64,
    },
    /// The hallway turns otherwise than before, in radians counter-clockwise.
    Turn {
        /// By the measurement before it, seen in the direction of this one.
        before: f64,
        /// By this one.
        now: f64,
    },
    /// The junction has another shape than before.
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
    /// How.
    pub measurement: ContradictoryMeasurement,
}

/// The comparison of all measurements of a walk.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeasurementCheck {
    /// The number of moves with a measurement.
    pub measured: usize,
    /// The number of those whose hallway was measured before.
    pub compared: usize,
    /// The contradictions, in the order of their visits, at most one at each. A measurement that contradicts others is not
    /// compared with later ones.
    pub contradictions: Vec<MeasurementContradiction>,
}

/// The least number of comparisons from which the noise is estimated.
const ESTIMATED_FROM: usize = 8;

impl MeasurementCheck {
    /// Compares the measurements of a walk. If most deviations are greater than the noise explains, the noise is
    /// larger: it is multiplied so that it explains their median.
    #[must_use]
    pub fn new(visits: &[MeasuredVisit], noise: &MeasurementNoise) -> Self {
        let noise = &widened(visits, noise);
        let mut edges: BTreeMap<Dart, EdgeMeasurements> = BTreeMap::new();
        let mut closed = ClosedWalks::default();
        let mut check = Self::default();
        for (number, visit) in visits.iter().enumerate() {
            let before = number.checked_sub(1).map(|before| &visits[before]);
            check.measured += usize::from(visit.arrived.is_some());
            let mut found = None;
            if let Some((edge, now)) = traversed(number, before, visit) {
                let edge = edges.entry(edge).or_default();
                let deviation = edge.length_deviation(&now.hallway, noise);
                check.compared += usize::from(deviation.is_some());
                found = length(&now, deviation).or_else(|| turn(edge, &now, noise));
                if found.is_none() {
                    edge.add(now);
                }
            }
            let closing = closed.go(number, before, visit, noise);
            found = found.or_else(|| {
                let (earlier, measurement) = closing?;
                Some(MeasurementContradiction { visit: number, earlier, measurement })
            });
            check.contradictions.extend(found);
        }
        check
    }
}

/// The edge by which the robot came to a visit, by its least dart, and its measurement.
fn traversed(
    number: usize,
    before: Option<&MeasuredVisit>,
    visit: &MeasuredVisit,
) -> Option<(Dart, EdgeMeasurement)> {
    let before = before?;
    let entered = *visit.darts.first()?;
    let left = *before.darts.get(before.left_by?.0 as usize)?;
    let measurement =
        EdgeMeasurement { visit: number, hallway: visit.arrived?, forward: left < entered };
    Some((left.min(entered), measurement))
}

fn length(now: &EdgeMeasurement, deviation: Option<Deviation>) -> Option<MeasurementContradiction> {
    let Deviation { before, visit, .. } =
        deviation.filter(|deviation| deviation.statistic > ONE_DEGREE)?;
    let measurement = ContradictoryMeasurement::Length { before, now: now.hallway.length };
    Some(MeasurementContradiction { visit: now.visit, earlier: visit, measurement })
}

fn turn(
    edge: &EdgeMeasurements,
    now: &EdgeMeasurement,
    noise: &MeasurementNoise,
) -> Option<MeasurementContradiction> {
    let deviation = edge.turn_deviation(now, noise);
    let Deviation { before, visit, .. } =
        deviation.filter(|deviation| deviation.statistic > ONE_DEGREE)?;
    let measurement = ContradictoryMeasurement::Turn { before, now: now.hallway.turn? };
    Some(MeasurementContradiction { visit: now.visit, earlier: visit, measurement })
}

/// The noise that explains the median deviation, or this one if it does. A few contradictions do not change a
/// median.
fn widened(visits: &[MeasuredVisit], noise: &MeasurementNoise) -> MeasurementNoise {
    let mut edges: BTreeMap<Dart, EdgeMeasurements> = BTreeMap::new();
    let mut statistics = [Vec::new(), Vec::new()];
    for (number, visit) in visits.iter().enumerate() {
        let before = number.checked_sub(1).map(|before| &visits[before]);
        let Some((edge, now)) = traversed(number, before, visit) else { continue };
        let edge = edges.entry(edge).or_default();
        let deviations =
            [edge.length_deviation(&now.hallway, noise), edge.turn_deviation(&now, noise)];
        for (statistics, deviation) in statistics.iter_mut().zip(deviations) {
            statistics.extend(deviation.map(|deviation| deviation.statistic));
        }
        edge.add(now);
    }
    let [length, turn] = statistics.map(factor);
    noise.times(length, turn)
}

/// The multiple of the noise that explains the median of these statistics, at least 1.
fn factor(mut statistics: Vec<f64>) -> f64 {
    if statistics.len() < ESTIMATED_FROM {
        return 1.0;
    }
    let middle = statistics.len() / 2;
    let (_, &mut median, _) = statistics.select_nth_unstable_by(middle, f64::total_cmp);
    (median / ONE_DEGREE_MEDIAN).sqrt().max(1.0)
}

#[cfg(test)]
mod tests;
