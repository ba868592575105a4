//! How a robot in corridors feels for walls that its scanner does not see, as those of glass and black ones.

use nalgebra::Point2;
use toposlam_logs::record::{Frame, RunObserver};
use toposlam_model::driving::scene::wrapped;
use toposlam_vision::{
    geometry::{direction, distance, from_robot, nearest, unit},
    laser::local_map::FeltWall,
};

use super::{CorridorExplorer, Stop};
use crate::robot::Robot;

/// A straight piece of a gap in which a robot felt for a wall, in the frame of odometry.
#[derive(Clone, Copy, Debug)]
pub(super) struct Felt {
    /// Where it stood then.
    robot: Point2<f64>,
    piece: [Point2<f64>; 2],
    is_wall: bool,
}

impl<R: Robot, O: RunObserver> CorridorExplorer<R, O> {
    /// Goes to the nearest gap ahead from which nothing comes back, to find out whether a wall is there. Returns false if there is
    /// no gap where it has not done so. If something stops it, it comes back.
    pub(super) fn feels_for_wall(&mut self) -> Result<bool, Stop> {
        let Some([one, other]) = self.gap_ahead() else { return Ok(false) };
        let middle = nalgebra::center(&one, &other);
        let (first, begin, heading) = (self.trail.len(), self.at(), self.heading);
        let is_wall = loop {
            let before = self.at();
            if distance(before, middle) < self.driving.at_point {
                break false;
            }
            self.step_to(middle)?;
            if distance(before, self.at()) < self.driving.stuck {
                break true;
            }
        };
        let (at, towards) = (self.at(), direction(begin, middle));
        let stopped_by = at + distance(at, middle).min(self.driving.touch) * unit(towards);
        let along = self.driving.felt * unit(direction(one, other));
        let piece = [stopped_by - along, stopped_by + along];
        self.felt.push(Felt { robot: at, piece, is_wall });
        if is_wall {
            self.remember_walls(self.felt.len() - 1);
            self.drive_along([begin])?;
            self.trail.end_side_trip(first);
            self.look_around()?;
            self.heading = heading;
        } else {
            self.heading = towards;
        }
        Ok(true)
    }

    /// Puts the walls that it has felt from this number on into its local map.
    pub(super) fn remember_walls(&mut self, begin: usize) {
        let map_from_odometry = self.odometry_from_map.inverse();
        for Felt { robot, piece, .. } in self.felt.iter().skip(begin).filter(|felt| felt.is_wall) {
            let wall = piece.map(|end| map_from_odometry * end);
            self.visits.sensor_mut().feel(FeltWall { robot: map_from_odometry * robot, wall });
        }
    }

    /// The directions of the gaps from which nothing comes back, from where it is.
    pub(super) fn silent_ways(&self) -> Vec<f64> {
        let Some(Frame { odometry, scan: Some(scan), .. }) = &self.last else { return Vec::new() };
        let odometry_from_robot = from_robot(odometry);
        let gaps = scan.silent_gaps(self.driving.gap).into_iter();
        let middles = gaps.map(|[one, other]| odometry_from_robot * nalgebra::center(&one, &other));
        middles.map(|middle| direction(self.at(), middle)).collect()
    }

    /// The nearest part of a gap ahead in which it has not felt for a wall yet.
    fn gap_ahead(&self) -> Option<[Point2<f64>; 2]> {
        if self.felt.len() >= self.driving.feels {
            return None;
        }
        let Frame { odometry, scan, .. } = self.last.as_ref()?;
        let odometry_from_robot = from_robot(odometry);
        let gaps = scan.as_ref()?.silent_gaps(self.driving.gap).into_iter();
        let gaps = gaps.map(|ends| ends.map(|end| odometry_from_robot * end));
        let parts = gaps.flat_map(|gap| parts_not_felt(gap, &self.felt, self.driving.touch));
        let (at, back) = (self.at(), self.back(self.driving.near_place));
        let middle = |[one, other]: &[Point2<f64>; 2]| nalgebra::center(one, other);
        let is_ahead = |part: &[Point2<f64>; 2]| {
            let towards = direction(at, middle(part));
            distance(part[0], part[1]) >= self.driving.felt
                && wrapped(towards - back).abs() > self.driving.not_back
        };
        nearest(parts.filter(is_ahead), |part| distance(at, middle(part)))
    }
}

/// The parts of a gap in which a robot has not felt for a wall: at most this far from it.
fn parts_not_felt(
    [one, other]: [Point2<f64>; 2],
    felt: &[Felt],
    touch: f64,
) -> Vec<[Point2<f64>; 2]> {
    let (along, length) = (unit(direction(one, other)), distance(one, other));
    let mut parts = vec![[0.0, length]];
    for Felt { piece, .. } in felt {
        let off = (nalgebra::center(&piece[0], &piece[1]) - one).perp(&along).abs();
        if off <= touch {
            let [end, other_end] = piece.map(|end| (end - one).dot(&along));
            let (begin, end) = (end.min(other_end), end.max(other_end));
            let beside = |[from, to]: [f64; 2]| [[from, to.min(begin)], [from.max(end), to]];
            parts = parts.into_iter().flat_map(beside).filter(|[from, to]| from < to).collect();
        }
    }
    parts.into_iter().map(|part| part.map(|at| one + at * along)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_in_which_a_robot_felt_for_a_wall_is_left_on_both_sides() {
        let point = |x: f64, y: f64| Point2::new(x, y);
        let gap = [point(0.0, 2.0), point(3.0, 2.0)];
        let felt = |from: f64, to: f64, y: f64| Felt {
            robot: point(from, y - 0.3),
            piece: [point(from, y), point(to, y)],
            is_wall: true,
        };
        let left = |felt: &[Felt]| -> Vec<[f64; 2]> {
            let parts = parts_not_felt(gap, felt, 0.5);
            assert!(parts.iter().flatten().all(|end| (end.y - 2.0).abs() < 1e-9));
            parts.into_iter().map(|part| part.map(|end| end.x)).collect()
        };
        assert_eq!(left(&[]), [[0.0, 3.0]]);
        assert_eq!(left(&[felt(1.25, 1.75, 2.25)]), [[0.0, 1.25], [1.75, 3.0]]);
        assert_eq!(left(&[felt(1.25, 1.75, 2.75)]), [[0.0, 3.0]], "that was another gap");
        // The second piece is beyond an end of the gap, and its ends are the other way round.
        let both = [felt(1.25, 1.75, 2.0), felt(0.5, -0.25, 2.0)];
        assert_eq!(left(&both), [[0.5, 1.25], [1.75, 3.0]]);
        assert_eq!(left(&[felt(-1.0, 4.0, 2.0)]), [[0.0; 2]; 0]);
    }
}
