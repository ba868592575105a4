//! The way of a robot on the local map: where it bends, and where the scanner does not look.

use std::collections::VecDeque;

use nalgebra::Point2;

use crate::{
    geometry::{direction, distance},
    laser::params::{CornerParams, VisitParams},
    place::PlaceView,
};

/// A bend of the robot's way. A robot that passes the corner of a corridor turns there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PassedBend<S> {
    /// Where it is sharpest, in metres.
    pub point: Point2<f64>,
    /// The directions to where the robot came from and to where it went, in radians.
    pub arms: [f64; 2],
    /// The length of the robot's way to the bend, in metres.
    pub way: f64,
    pub at: S,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Bends<S> {
    params: CornerParams,
    /// The last points of the way, with the length of the way to each.
    points: VecDeque<(Point2<f64>, f64, S)>,
    /// How many of them have been judged.
    judged: usize,
    /// The sharpest place of a bend that goes on, and its angle.
    sharpest: Option<(f64, PassedBend<S>)>,
}

impl<S: Copy> Bends<S> {
    pub(super) fn new(params: CornerParams) -> Self {
        Self { params, points: VecDeque::new(), judged: 0, sharpest: None }
    }

    /// Adds the next point of the way, which has this length. Returns the bends that are over now.
    pub(super) fn add(&mut self, point: Point2<f64>, way: f64, at: S) -> Vec<PassedBend<S>> {
        self.points.push_back((point, way, at));
        let CornerParams { arm, memory, .. } = self.params;
        let mut bends = Vec::new();
        while let Some(&(middle, way, at)) = self.points.get(self.judged) {
            if distance(middle, point) < arm {
                break;
            }
            let is_off = |other: &&(Point2<f64>, f64, S)| distance(other.0, middle) >= arm;
            let before = self.points.range(..self.judged).rev().find(is_off);
            let after = self.points.range(self.judged..).find(is_off);
            let bend = before.zip(after).map(|(before, after)| {
                let arms = [before, after].map(|other| direction(middle, other.0));
                let bend = PassedBend { point: middle, arms, way, at };
                (CornerParams::bend(arms), bend)
            });
            match bend.filter(|&(turn, _)| self.params.is_bend(turn)) {
                None => bends.extend(self.sharpest.take().map(|(_, bend)| bend)),
                Some((turn, _)) if self.sharpest.is_some_and(|(most, _)| turn <= most) => {}
                bend => self.sharpest = bend,
            }
            self.judged += 1;
        }
        while self.points.front().is_some_and(|&(_, first, _)| way - first > memory * arm) {
            self.points.pop_front();
            self.judged = self.judged.saturating_sub(1);
        }
        bends
    }
}

/// Notices where a robot drives in a direction in which its scanner does not look: backwards, with a scanner that sees half
/// of a circle. It may pass junctions there that no scan shows.
#[derive(Clone, Debug, Default)]
pub(super) struct UnseenWay {
    /// Where the last step ended.
    last: Option<Point2<f64>>,
    /// The length of the way since the scanner last looked ahead, in metres.
    length: f64,
}

impl UnseenWay {
    /// Takes the next view. Returns whether the way has become too long; of one way only once.
    pub(super) fn add(&mut self, view: &PlaceView, params: &VisitParams) -> bool {
        let position = Point2::from(view.robot.position);
        let last = *self.last.get_or_insert(position);
        let step = distance(last, position);
        if step < params.unseen_step {
            return false;
        }
        self.last = Some(position);
        let ahead = direction(last, position) - view.robot.heading;
        let is_unseen = view.sector.angle_off(ahead) > params.unseen_angle;
        let before = self.length;
        self.length = if is_unseen { before + step } else { 0.0 };
        before < params.unseen_way && self.length >= params.unseen_way
    }
}

/// The distance from a point to a piece of a way.
pub(super) fn distance_to_piece(point: Point2<f64>, [from, to]: [Point2<f64>; 2]) -> f64 {
    let along = to - from;
    let square = along.norm_squared();
    let part = if square > 0.0 { (point - from).dot(&along) / square } else { 0.0 };
    distance(point, from + part.clamp(0.0, 1.0) * along)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

    use nalgebra::Isometry2;
    use toposlam_model::driving::odometry::Odometry;

    use super::*;
    use crate::place::ViewSector;

    /// Where a way along a line becomes too long in a direction in which a scanner that sees the half ahead of it does not look.
    fn unseen(points: &[f64]) -> Vec<bool> {
        let [along_x, along_y] = [0.0, FRAC_PI_2].map(|heading| unseen_along(points, heading));
        assert_eq!(along_x, along_y);
        along_x
    }

    /// The same along a way in this direction.
    fn unseen_along(points: &[f64], heading: f64) -> Vec<bool> {
        let mut unseen = UnseenWay::default();
        let view = |&along: &f64| PlaceView {
            robot: Odometry { position: [along * heading.cos(), along * heading.sin()], heading },
            odometry_from_map: Isometry2::identity(),
            places: Vec::new(),
            possible_places: Vec::new(),
            facts: None,
            sector: ViewSector { first: -FRAC_PI_2, angle: PI },
            width: None,
            scene: None,
        };
        points.iter().map(|x| unseen.add(&view(x), &VisitParams::DEFAULT)).collect()
    }

    #[test]
    fn two_metres_backwards_are_a_way_that_a_scanner_does_not_see() {
        let [no, yes] = [false, true];
        assert_eq!(unseen(&[0.0, -0.5, -1.0, -1.5, -2.0, -2.5]), [no, no, no, no, yes, no]);
        // In small steps, too.
        assert_eq!(
            unseen(&[0.0, -0.4, -0.8, -1.2, -1.6, -2.0, -2.4]).iter().filter(|&&is| is).count(),
            1
        );
        assert!(!unseen(&[0.0, 1.0, 2.0, 3.0]).contains(&yes));
        // What it then sees, it sees.
        assert!(!unseen(&[0.0, -1.5, -0.9, -2.4]).contains(&yes));
        let twice = [0.0, -2.0, -1.0, -3.0];
        assert_eq!(unseen(&twice), [no, yes, no, yes]);
    }

    #[test]
    fn a_point_is_as_far_from_a_piece_of_a_way_as_from_its_nearest_point() {
        let piece = [[1.0, 1.0], [4.0, 5.0]].map(Point2::from);
        let off = |x, y| distance_to_piece(Point2::new(x, y), piece);
        // Beside the middle, and before and behind the ends.
        assert!((off(2.5 + 4.0, 3.0 - 3.0) - 5.0).abs() < 1e-9);
        assert!((off(1.0 - 3.0, 1.0 - 4.0) - 5.0).abs() < 1e-9);
        assert!((off(4.0, 7.0) - 2.0).abs() < 1e-9);
        assert!((distance_to_piece(Point2::new(1.0, 3.0), [piece[0]; 2]) - 2.0).abs() < 1e-9);
    }

    /// The bends of a way along these points, in steps of half a metre.
    fn bends(corners: &[[f64; 2]]) -> Vec<PassedBend<()>> {
        let mut bends = Bends::new(CornerParams::default());
        let mut found = Vec::new();
        let mut way = 0.0;
        for leg in corners.windows(2) {
            let [from, to] = [leg[0], leg[1]].map(Point2::from);
            let steps = (distance(from, to) / 0.5).ceil() as u32;
            for step in 1..=steps {
                way += distance(from, to) / f64::from(steps);
                let point = from + f64::from(step) / f64::from(steps) * (to - from);
                found.extend(bends.add(point, way, ()));
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
    fn sharp_corners_are_bends_and_flat_ones_detours_and_ways_back_are_none() {
        let (sine, cosine) = FRAC_PI_4.sin_cos();
        let square = [[5.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0], [0.0, 0.0], [5.0, 0.0]];
        for (way, expected) in [
            (&square[..], 4),
            (&[[0.0, 0.0], [10.0, 0.0], [10.0 + 8.0 * cosine, 8.0 * sine]], 0),
            // Around a person.
            (&[[0.0, 0.0], [8.0, 0.0], [9.0, 0.7], [10.0, 0.0], [18.0, 0.0]], 0),
            (&[[0.0, 0.0], [10.0, 0.0], [1.0, 0.0]], 0),
            // Around a corner and back at once.
            (&[[0.0, 0.0], [10.0, 0.0], [10.0, 2.0], [10.0, 0.0], [0.0, 0.0]], 0),
        ] {
            assert_eq!(bends(way).len(), expected, "{way:?}");
        }
    }
}
