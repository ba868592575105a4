//! The measurements of one edge.

use super::{
    ContradictoryMeasurement, HallwayMeasurement, MeasurementContradiction, MeasurementNoise,
    ONE_DEGREE,
};
use crate::driving::scene::wrapped;

/// The measurements of an edge that agree with each other.
#[derive(Clone, Debug, Default)]
pub(super) struct EdgeMeasurements(Vec<EdgeMeasurement>);

#[derive(Clone, Copy, Debug)]
pub(super) struct EdgeMeasurement {
    /// The visit at its end.
    pub visit: usize,
    pub hallway: HallwayMeasurement,
    /// In which of its two directions the robot traversed it.
    pub forward: bool,
}

/// How far a measurement is from those before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Deviation {
    /// Twice the logarithm of the likelihood ratio, with one degree of freedom.
    pub statistic: f64,
    /// The value by the measurements before it.
    pub before: f64,
    /// The visit at the end of the last of them.
    pub visit: usize,
}

impl EdgeMeasurement {
    /// How it contradicts those before it, by the deviations of its length and its turn.
    pub(super) fn contradicts(
        &self,
        length: Option<Deviation>,
        turn: Option<Deviation>,
    ) -> Option<MeasurementContradiction> {
        let HallwayMeasurement { length: now, turn: now_turn } = self.hallway;
        let length =
            length.map(|of| (of, ContradictoryMeasurement::Length { before: of.before, now }));
        let turn = turn
            .zip(now_turn)
            .map(|(of, now)| (of, ContradictoryMeasurement::Turn { before: of.before, now }));
        let mut contradictory =
            [length, turn].into_iter().flatten().filter(|(of, _)| of.statistic > ONE_DEGREE);
        let (Deviation { visit: earlier, .. }, measurement) = contradictory.next()?;
        Some(MeasurementContradiction { visit: self.visit, earlier, measurement })
    }
}

impl EdgeMeasurements {
    /// How far a length and a turn are from those before them.
    pub(super) fn deviations(
        &self,
        now: &EdgeMeasurement,
        noise: &MeasurementNoise,
    ) -> [Option<Deviation>; 2] {
        [self.length_deviation(&now.hallway, noise), self.turn_deviation(now, noise)]
    }

    pub(super) fn add(&mut self, measurement: EdgeMeasurement) {
        self.0.push(measurement);
    }

    /// How far a length is from the lengths before it; `None` if there are none.
    fn length_deviation(
        &self,
        now: &HallwayMeasurement,
        noise: &MeasurementNoise,
    ) -> Option<Deviation> {
        let visit = self.0.last()?.visit;
        let weight = |length: f64| 1.0 / noise.length_variance(length);
        let lengths = self.0.iter().map(|before| before.hallway.length);
        let (mut sum, mut weights) = (0.0, 0.0);
        for length in lengths {
            sum += length * weight(length);
            weights += weight(length);
        }
        let before = sum / weights;
        let variance = noise.length_variance(now.length) + 1.0 / weights;
        Some(Deviation { statistic: (now.length - before).powi(2) / variance, before, visit })
    }

    /// How far a turn is from the last one in the same direction, or else in the other; `None` if there is none.
    fn turn_deviation(&self, now: &EdgeMeasurement, noise: &MeasurementNoise) -> Option<Deviation> {
        let turn = now.hallway.turn?;
        let with_turn = || self.0.iter().rev().filter(|before| before.hallway.turn.is_some());
        let last = with_turn()
            .find(|before| before.forward == now.forward)
            .or_else(|| with_turn().next())?;
        let is_same = last.forward == now.forward;
        let before = last.hallway.turn? * if is_same { 1.0 } else { -1.0 };
        let lengths = [last.hallway.length, now.hallway.length];
        let variance = noise.turn_variance(lengths, is_same);
        let statistic = wrapped(turn - before).powi(2) / variance;
        Some(Deviation { statistic, before: wrapped(before), visit: last.visit })
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    const NOISE: MeasurementNoise = MeasurementNoise {
        standing: 0.1,
        wandering: 0.0,
        scale: 0.0,
        door: 0.1,
        turning: 0.0,
        drift: 0.0,
    };

    fn edge(visit: usize, length: f64, turn: f64, forward: bool) -> EdgeMeasurement {
        EdgeMeasurement { visit, hallway: HallwayMeasurement { length, turn: Some(turn) }, forward }
    }

    fn measured(all: &[EdgeMeasurement]) -> EdgeMeasurements {
        EdgeMeasurements(all.to_vec())
    }

    #[test]
    fn a_length_is_compared_with_the_mean_of_those_before() {
        let now = HallwayMeasurement { length: 9.0, turn: None };
        assert_eq!(measured(&[]).length_deviation(&now, &NOISE), None);
        let two = measured(&[edge(1, 7.9, 0.0, true), edge(4, 8.1, 0.0, false)]);
        let found = two.length_deviation(&now, &NOISE).unwrap();
        // 1 m, with the variances 0.02 of one length and 0.01 of the mean of two.
        assert!((found.statistic - 1.0 / 0.03).abs() < 1e-9 && found.visit == 4, "{found:?}");
        assert!((found.before - 8.0).abs() < 1e-12);
    }

    #[test]
    fn a_turn_to_the_left_is_one_to_the_right_on_the_way_back() {
        let one = measured(&[edge(1, 8.0, FRAC_PI_2, true)]);
        let statistic = |turn, forward| {
            one.turn_deviation(&edge(2, 8.0, turn, forward), &NOISE).unwrap().statistic
        };
        assert!(statistic(FRAC_PI_2, true) < 1e-9 && statistic(-FRAC_PI_2, false) < 1e-9);
        assert!(statistic(-FRAC_PI_2, true) > 200.0 && statistic(FRAC_PI_2, false) > 200.0);
        // The last one in the same direction counts.
        let two = measured(&[edge(1, 8.0, 1.0, true), edge(3, 8.0, -0.5, false)]);
        assert_eq!(two.turn_deviation(&edge(5, 8.0, 1.0, true), &NOISE).unwrap().visit, 1);
    }
}
