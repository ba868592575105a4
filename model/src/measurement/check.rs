//! The measurements of a walk whose visits are identified, compared.

use std::collections::BTreeMap;

use super::{
    MeasuredVisit, MeasurementContradiction, MeasurementNoise, ONE_DEGREE_MEDIAN,
    closed_walk::ClosedWalks,
    edge::{EdgeMeasurement, EdgeMeasurements},
};
use crate::embedded_graph::Dart;

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
                let [length, turn] = edge.deviations(&now, noise);
                check.compared += usize::from(length.is_some());
                found = now.contradicts(length, turn);
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

/// The noise that explains the median deviation, or this one if it does. A few contradictions do not change a
/// median.
fn widened(visits: &[MeasuredVisit], noise: &MeasurementNoise) -> MeasurementNoise {
    let mut edges: BTreeMap<Dart, EdgeMeasurements> = BTreeMap::new();
    let mut statistics = [Vec::new(), Vec::new()];
    for (number, visit) in visits.iter().enumerate() {
        let before = number.checked_sub(1).map(|before| &visits[before]);
        let Some((edge, now)) = traversed(number, before, visit) else { continue };
        let edge = edges.entry(edge).or_default();
        for (statistics, deviation) in statistics.iter_mut().zip(edge.deviations(&now, noise)) {
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
