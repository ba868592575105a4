//! Where a robot has been, by odometry. Points are those of its frame.

use std::{f64::consts::FRAC_PI_2, ops::Range};

use nalgebra::Point2;
use toposlam_vision::geometry::{direction, distance, unit};

/// Where a robot has taken its scans, in their order, and what of it was only to look at something.
#[derive(Clone, Debug, Default)]
pub(super) struct Trail {
    points: Vec<Point2<f64>>,
    /// In their order.
    side_trips: Vec<Range<usize>>,
    /// The number of the point at which it left the last place.
    left: usize,
}

/// From here on a robot has moved, in metres.
const MOVED: f64 = 0.05;

/// Where a robot turned on its way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Turn {
    /// The number of points of the trail until then.
    pub number: usize,
    pub at: Point2<f64>,
    /// Where it was before.
    pub before: Point2<f64>,
}

impl Trail {
    pub(super) fn push(&mut self, point: Point2<f64>) {
        self.points.push(point);
    }

    pub(super) fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    pub(super) fn len(&self) -> usize {
        self.points.len()
    }

    /// The robot leaves a place.
    pub(super) fn leave(&mut self) {
        self.left = self.points.len().saturating_sub(1);
    }

    /// What was driven from a number on was only to look at something: the robot has come back.
    pub(super) fn end_side_trip(&mut self, begin: usize) {
        while self.side_trips.pop_if(|last| last.start >= begin).is_some() {}
        let begin = begin.max(self.side_trips.last().map_or(0, |last| last.end));
        self.side_trips.push(begin..self.points.len().max(begin));
    }

    /// The points from a number on, the last one first, at least this far apart.
    pub(super) fn back_to(&self, begin: usize, apart: f64) -> Vec<Point2<f64>> {
        let mut back: Vec<Point2<f64>> = Vec::new();
        for &point in self.points.get(begin..).unwrap_or_default().iter().rev() {
            if back.last().is_none_or(|last| distance(*last, point) >= apart) {
                back.push(point);
            }
        }
        back
    }

    /// The number of the point from a number on that is nearest to another point.
    pub(super) fn nearest(&self, begin: usize, to: Point2<f64>) -> Option<usize> {
        let off = |number: &usize| distance(self.points[*number], to);
        let numbers = begin..self.points.len();
        numbers.min_by(|one, other| off(one).total_cmp(&off(other)))
    }

    /// Where the robot was before it entered a circle the last time, since it left a place and without side trips: at that place
    /// if it has not been outside since. `None` if it was never inside, or has not moved.
    pub(super) fn before_entering(&self, centre: Point2<f64>, radius: f64) -> Option<Point2<f64>> {
        let is_outside = |point: &Point2<f64>| distance(*point, centre) >= radius;
        let since = self.numbered().take_while(|(number, _)| *number > self.left);
        let since = since.map(|(_, point)| point).chain(self.points.get(self.left).copied());
        let mut before = None;
        for point in since.skip_while(is_outside) {
            before = Some(point);
            if is_outside(&point) {
                break;
            }
        }
        before.filter(|before| distance(*before, centre) >= MOVED)
    }

    /// Where the end of the way, of this length and not from before this number, is farthest aside from a straight line;
    /// `None` if that is less than this.
    pub(super) fn last_turn(&self, begin: usize, length: f64, aside: f64) -> Option<Turn> {
        let (_, last) = self.numbered().next()?;
        let (mut driven, mut previous) = (0.0, last);
        let way = self.numbered().take_while(|&(number, point)| {
            driven += distance(previous, point);
            previous = point;
            number >= begin && driven < length
        });
        let way: Vec<_> = way.collect();
        let &(_, before) = way.last()?;
        let across = unit(direction(before, last) + FRAC_PI_2);
        let off = |point: Point2<f64>| (point - last).dot(&across).abs();
        let (number, at) =
            way.into_iter().max_by(|one, other| off(one.1).total_cmp(&off(other.1)))?;
        (off(at) >= aside).then_some(Turn { number: number + 1, at, before })
    }

    /// From the last point to the first, without side trips.
    pub(super) fn without_side_trips(&self) -> impl Iterator<Item = Point2<f64>> + '_ {
        self.numbered().map(|(_, point)| point)
    }

    /// The same with their numbers.
    fn numbered(&self) -> impl Iterator<Item = (usize, Point2<f64>)> + '_ {
        let is_aside = |number: usize| {
            let later = self.side_trips.partition_point(|trip| trip.end <= number);
            self.side_trips.get(later).is_some_and(|trip| trip.contains(&number))
        };
        let points = self.points.iter().enumerate().rev();
        points.filter(move |(number, _)| !is_aside(*number)).map(|(number, point)| (number, *point))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A robot that drives 6 m to the east in steps of 1 m, from its third step on aside and back.
    fn trail() -> Trail {
        let mut trail = Trail::default();
        let on = |x: i32| Point2::new(f64::from(x), 0.0);
        (0..3).for_each(|x| trail.push(on(x)));
        for aside in [1.0, 2.0, 1.0] {
            trail.push(Point2::new(2.0, aside));
        }
        trail.end_side_trip(3);
        (3..=6).for_each(|x| trail.push(on(x)));
        trail
    }

    #[test]
    fn a_side_trip_that_goes_on_is_one() {
        let mut trail = trail();
        trail.end_side_trip(8);
        trail.push(Point2::origin());
        trail.end_side_trip(8);
        assert_eq!(trail.side_trips, [3..6, 8..11]);
        trail.end_side_trip(2);
        assert_eq!(trail.side_trips.len(), 1);
        assert_eq!(trail.side_trips.first(), Some(&(2..11)));
    }

    #[test]
    fn where_a_robot_came_from_is_on_its_way_and_not_on_a_side_trip() {
        let before = trail().before_entering(Point2::new(4.0, 0.0), 1.5);
        // It has left the circle, and was in it before.
        assert_eq!(before, Some(Point2::new(2.0, 0.0)));
        assert_eq!(trail().before_entering(Point2::new(2.0, 5.0), 1.0), None);
        assert_eq!(trail().before_entering(Point2::origin(), 1.0), None, "it was never outside");
        assert_eq!(trail().without_side_trips().count(), 7);
    }

    /// It came to (6, 0) from the west, and goes back there.
    #[test]
    fn where_a_robot_came_from_is_the_place_that_it_left_if_that_is_near() {
        let mut trail = trail();
        trail.leave();
        let before = |trail: &Trail| {
            let here = *trail.points.last().unwrap();
            trail.before_entering(here, 2.5)
        };
        assert_eq!(before(&trail), None, "it has not moved");
        for (x, came_from) in [(5.0, 6.0), (4.0, 6.0), (3.0, 6.0), (2.0, 5.0)] {
            trail.push(Point2::new(x, 0.0));
            assert_eq!(before(&trail), Some(Point2::new(came_from, 0.0)));
        }
    }

    #[test]
    fn a_robot_has_turned_where_its_way_is_farthest_aside_from_a_straight_line() {
        let turn = |aside: f64, begin| {
            let mut trail = Trail::default();
            (0..20).for_each(|x| trail.push(Point2::new(f64::from(x), 0.0)));
            (1..=4).for_each(|y| trail.push(Point2::new(19.0, aside * f64::from(y))));
            trail.last_turn(begin, 9.5, 1.0)
        };
        let (number, at, before) = (20, Point2::new(19.0, 0.0), Point2::new(14.0, 0.0));
        assert_eq!(turn(1.0, 0), Some(Turn { number, at, before }));
        assert_eq!(turn(0.2, 0), None, "that is less than half of a corridor");
        assert_eq!(turn(1.0, 19), None, "it has driven straight on since");
        assert_eq!(trail().last_turn(0, 9.5, 1.0), None, "a side trip is no turn");
    }

    #[test]
    fn the_way_back_is_the_way_with_the_last_point_first() {
        let trail = trail();
        let back = trail.back_to(6, 1.5);
        assert_eq!(back, [[6.0, 0.0], [4.0, 0.0]].map(Point2::from));
        assert_eq!(trail.nearest(0, Point2::new(2.1, 1.8)), Some(4));
    }
}
