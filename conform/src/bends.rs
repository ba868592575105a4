//! Where the way of a robot bends: a robot that passes the corner of a corridor turns there.

use std::{collections::VecDeque, f64::consts::PI};

use nalgebra::Point2;
use toposlam_model::driving::scene::wrapped;
use toposlam_vision::{
    geometry::{direction, distance},
    laser::params::CornerParams,
};

use super::{events::EventSource, params::LASER};

/// A bend of the robot's way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PassedBend {
    /// Where it is sharpest, in metres.
    pub point: Point2<f64>,
    /// The directions to where the robot came from and to where it went, in radians.
    pub arms: [f64; 2],
    /// The length of the robot's way to the bend, in metres.
    pub way: f64,
    /// When the robot was there.
    pub source: EventSource,
}

/// Finds the bends of a way.
#[derive(Clone, Debug)]
pub(super) struct Bends {
    params: CornerParams,
    /// The last points of the way.
    points: VecDeque<PassedPoint>,
    /// How many of them have been judged.
    judged: usize,
    /// The sharpest place of a bend that goes on, and its angle.
    sharpest: Option<(f64, PassedBend)>,
}

#[derive(Clone, Copy, Debug)]
struct PassedPoint {
    point: Point2<f64>,
    way: f64,
    source: EventSource,
}

impl Bends {
    /// A way without a point.
    pub(super) fn new(params: CornerParams) -> Self {
        Self { params, points: VecDeque::new(), judged: 0, sharpest: None }
    }

    /// Adds the next point of the way, which has this length. Returns the bends that are over now.
    pub(super) fn go(
        &mut self,
        point: Point2<f64>,
        way: f64,
        source: EventSource,
    ) -> Vec<PassedBend> {
        self.points.push_back(PassedPoint { point, way, source });
        let arm = self.params.arm;
        let mut bends = Vec::new();
        while let Some(middle) = self.points.get(self.judged).copied() {
            if distance(middle.point, point) < arm {
                break;
            }
            let is_off = |other: &&PassedPoint| distance(other.point, middle.point) >= arm;
            let before = self.points.range(..self.judged).rev().find(is_off);
            let after = self.points.range(self.judged..).find(is_off);
            let bend = before.zip(after).map(|(before, after)| {
                let arms = [before, after].map(|other| direction(middle.point, other.point));
                let PassedPoint { point, way, source } = middle;
                (PI - wrapped(arms[0] - arms[1]).abs(), PassedBend { point, arms, way, source })
            });
            match bend
                .filter(|(turn, _)| (self.params.min_turn..LASER.sharpest_bend).contains(turn))
            {
                None => bends.extend(self.sharpest.take().map(|(_, bend)| bend)),
                Some((turn, bend)) => {
                    if self.sharpest.is_none_or(|(most, _)| turn > most) {
                        self.sharpest = Some((turn, bend));
                    }
                }
            }
            self.judged += 1;
        }
        while self.points.front().is_some_and(|first| way - first.way > LASER.bend_memory * arm) {
            self.points.pop_front();
            self.judged = self.judged.saturating_sub(1);
        }
        bends
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

    use super::*;

    /// The bends of a way along these points, in steps of half a metre.
    fn bends(corners: &[[f64; 2]]) -> Vec<PassedBend> {
        let mut bends = Bends::new(CornerParams::default());
        let mut found = Vec::new();
        let mut way = 0.0;
        for leg in corners.windows(2) {
            let steps = (distance(leg[0], leg[1]) / 0.5).ceil() as u32;
            for step in 1..=steps {
                let part = f64::from(step) / f64::from(steps);
                let [from, to] = [leg[0], leg[1]].map(Point2::from);
                let point = from + part * (to - from);
                way += distance(leg[0], leg[1]) / f64::from(steps);
                found.extend(bends.go(point, way, EventSource::default()));
            }
        }
        found
    }

    #[test]
    fn a_right_angle_is_one_bend_at_its_corner() {
        let [bend] = bends(&[[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]])[..] else { panic!() };
        assert!(distance(bend.point, [10.0, 0.0]) < 1e-9, "{bend:?}");
        assert!((bend.way - 10.0).abs() < 1e-9);
        assert!((bend.arms[0].abs() - PI).abs() < 1e-9 && (bend.arms[1] - FRAC_PI_2).abs() < 1e-9);
    }

    #[test]
    fn each_corner_of_a_square_is_a_bend() {
        let square = [[5.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0], [0.0, 0.0], [5.0, 0.0]];
        assert_eq!(bends(&square).len(), 4);
    }

    #[test]
    fn flat_bends_detours_and_ways_back_are_none() {
        let (sine, cosine) = FRAC_PI_4.sin_cos();
        let flat = [[0.0, 0.0], [10.0, 0.0], [10.0 + 8.0 * cosine, 8.0 * sine]];
        assert_eq!(bends(&flat), []);
        let round_a_person = [[0.0, 0.0], [8.0, 0.0], [9.0, 0.7], [10.0, 0.0], [18.0, 0.0]];
        assert_eq!(bends(&round_a_person), []);
        assert_eq!(bends(&[[0.0, 0.0], [10.0, 0.0], [1.0, 0.0]]), []);
        // Around a corner and back at once.
        assert_eq!(bends(&[[0.0, 0.0], [10.0, 0.0], [10.0, 2.0], [10.0, 0.0], [0.0, 0.0]]), []);
    }
}
