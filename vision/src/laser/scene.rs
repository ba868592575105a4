//! From a laser scan to the place of a robot in a building with right angles, as Algorithm 2 needs it. Section 3.
//!
//! The hits of the scan take the place of the boundary points of an image; all later steps are the same. A
//! scanner that does not see all round is helped by the hits of the last scans. Where they do not show a hallway, the
//! robot looks around: it turns on the spot, and the scans that it takes meanwhile are the last ones.

use std::{
    collections::VecDeque,
    f64::consts::{FRAC_PI_2, FRAC_PI_6, PI, TAU},
};

use nalgebra::Point2;
use toposlam_model::driving::{
    odometry::Odometry,
    scene::{HallwayStatus, HallwayView, JunctionView, Place, Reason, Unclear, wrapped},
};

use super::scan::Scan;
use crate::{
    bearing::{BEARINGS, bearing},
    boundary::{Boundary, Sight},
    geometry::{angle, from_robot, unit},
    sensing::place_within,
};

/// A scan is remembered if the robot has driven this far since the last one that is, or has turned by [`EVERY_TURN`].
/// Simulated buildings.
const EVERY: f64 = 0.2;
/// See [`EVERY`]. Simulated buildings.
const EVERY_TURN: f64 = 0.2;
/// The number of scans that are remembered. Geometry: the robot has driven a few metres since.
const REMEMBERED: usize = 24;
/// A robot whose scanner does not see all round turns so far that two scans show the same surfaces over this angle.
/// Geometry: more than odometry errs in a turn.
const OVERLAP: f64 = 0.17;
/// It looks around again when it has driven this far since, or has turned by [`LOOK_AGAIN_TURN`]. Simulated buildings.
const LOOK_AGAIN: f64 = 0.1;
/// See [`LOOK_AGAIN`]. Simulated buildings.
const LOOK_AGAIN_TURN: f64 = 0.5;
/// The hits of two successive readings are on one wall if their ranges differ by less than this, and ... Geometry: half
/// a degree before a gap there is no wall.
const STEP: f64 = 0.15;
/// ... by less than this part. Geometry.
const STEP_PART: f64 = 0.1;
/// A robot is at most this far past the turning point of a dead end. Geometry: half of a hallway's width less its
/// radius.
const PAST_DEAD_END: f64 = 0.45;
/// A hallway whose walls are hidden goes on for at most this far. Simulated buildings.
const HIDDEN: f64 = 5.0;
/// What is beside the robot is at most this much farther than the wall. Simulated buildings.
const WALL_SLACK: f64 = 0.25;
/// A robot needs this much free space ahead, ... Geometry: twice its length.
const FREE_AHEAD: f64 = 0.8;
/// ... and this much on both sides of its middle. Geometry: more than its radius.
const FREE_ASIDE: f64 = 0.3;
/// The confidence in a hallway whose walls are hidden, from 0 to 1. Half: it is neither sure nor impossible.
const HIDDEN_CONFIDENCE: f64 = 0.5;
/// Successive readings are neighbours if their bearings differ by less than this. Geometry: scanners have a reading at
/// least every 2 degrees.
const NEXT: f64 = 0.06;

#[derive(Clone, Debug, Default)]
pub struct ScanPlaceSensor {
    /// Where the last scans were taken, with the pieces of wall that they have hit, in the frame of odometry.
    last: VecDeque<(Odometry, Vec<WallPiece>)>,
    /// Where the robot looked around last.
    looked: Option<Odometry>,
    /// The last hallway that was sensed since the last junction.
    hallway: Option<SensedHallway>,
}

/// What a scan has hit between two successive readings, from one to the other; a hit that has no neighbour is a piece
/// without length.
type WallPiece = [Point2<f64>; 2];

#[derive(Clone, Copy, Debug)]
struct SensedHallway {
    /// Where it was sensed last.
    odometry: Odometry,
    view: HallwayView,
    /// Its width, in metres: the greatest that was sensed. Furniture looks like a wall of a narrower one.
    width: f64,
}

impl ScanPlaceSensor {
    /// The place in a scan, and the odometry when it was taken.
    pub fn sense(&mut self, scan: &Scan, odometry: &Odometry) -> Place {
        let place = self.place(scan, odometry);
        self.remember_on_the_way(scan, odometry);
        match place {
            Place::Hallway(view) => {
                let width = view.left + view.right;
                let width = self.hallway.map_or(width, |hallway| hallway.width.max(width));
                self.hallway = Some(SensedHallway { odometry: *odometry, view, width });
            }
            Place::Junction(_) => self.hallway = None,
            Place::Unknown(_) => {
                return self.hidden_hallway(scan, odometry).map_or(place, Place::Hallway);
            }
        }
        place
    }

    /// The headings to which the robot turns to look around, one after the other, relative to its own; empty if it need
    /// not: the scan covers a full circle, or with the last scans it shows a hallway, or a junction where the robot has
    /// just looked around.
    pub fn headings_to_look_around(&self, scan: &Scan, odometry: &Odometry) -> Vec<f64> {
        if sees_all_round(scan) {
            return Vec::new();
        }
        let has_looked_here = self
            .looked
            .is_some_and(|looked| is_near(&looked, odometry, LOOK_AGAIN, LOOK_AGAIN_TURN));
        let is_seen = match self.place(scan, odometry) {
            Place::Hallway(_) => self.looked.is_some(),
            Place::Junction(_) => has_looked_here,
            Place::Unknown(_) => false,
        };
        if is_seen { Vec::new() } else { headings_all_round(scan.field_of_view()) }
    }

    /// The robot begins to look around: the scans of the way are forgotten.
    pub fn begin_to_look_around(&mut self, odometry: &Odometry) {
        self.last.clear();
        self.looked = Some(*odometry);
    }

    pub fn remember(&mut self, scan: &Scan, odometry: &Odometry) {
        let odometry_from_robot = from_robot(odometry);
        let place = |piece: WallPiece| piece.map(|end| odometry_from_robot * end);
        let pieces = wall_pieces(scan).into_iter().map(place).collect();
        self.last.push_back((*odometry, pieces));
        while self.last.len() > REMEMBERED {
            self.last.pop_front();
        }
    }

    fn place(&self, scan: &Scan, odometry: &Odometry) -> Place {
        let (place, trace) = place_within(self.boundary(scan, odometry), 0.0);
        match &place {
            Place::Junction(junction) if is_behind_its_wall(junction) => {
                trace.hallway.map_or(Place::Unknown(Reason::NothingFits), |hallway| {
                    Place::Hallway(hallway.view(0.0))
                })
            }
            _ => place,
        }
    }

    /// The hallway that was sensed last, if furniture along it hides its walls: both sides are closed beside the robot,
    /// and the way ahead is free.
    fn hidden_hallway(&self, scan: &Scan, odometry: &Odometry) -> Option<HallwayView> {
        let SensedHallway { odometry: then, view, width } =
            self.hallway.filter(|hallway| hallway.odometry.distance(odometry) < HIDDEN)?;
        let heading = wrapped(view.heading + then.heading - odometry.heading);
        // How far the robot has come to the left.
        let aside =
            across(from_robot(&then).inverse() * Point2::from(odometry.position), view.heading);
        let (left, right) = (view.left - aside, view.right + aside);
        let slack = WALL_SLACK + width - view.left - view.right;
        let mut beside = [0, 0];
        for (bearing, range) in scan.ranges_hit() {
            let aside = wrapped(bearing - heading);
            let is_beside = (aside.abs() - FRAC_PI_2).abs() < FRAC_PI_6;
            let Some(range) = range else { continue };
            let point = scan.point(bearing, range);
            let (ahead, across) = (unit(heading).dot(&point.coords), across(point, heading));
            let is_in_way = (0.0..FREE_AHEAD).contains(&ahead) && across.abs() < FREE_ASIDE;
            let is_open = is_beside && (across > left + slack || -across > right + slack);
            if is_in_way || is_open {
                return None;
            }
            beside[usize::from(aside < 0.0)] += usize::from(is_beside);
        }
        (beside[0] > 0 && beside[1] > 0).then_some(HallwayView {
            heading,
            left,
            right,
            status: HallwayStatus::Unclear(Unclear::ClustersAhead),
            confidence: HIDDEN_CONFIDENCE,
        })
    }

    /// What the scan shows on each bearing, and behind its field of view the last scans.
    fn boundary(&self, scan: &Scan, odometry: &Odometry) -> Boundary {
        let mut sights = vec![None; BEARINGS];
        for (at, pieces) in &self.last {
            let robot_from_odometry = from_robot(odometry).inverse();
            let is_here = at.distance(odometry) < LOOK_AGAIN;
            let mut add = |bearing: usize, range: f64| {
                let known: &mut Option<f64> = &mut sights[bearing];
                *known = match *known {
                    // What moves is where it was seen last. From elsewhere one may see behind what is nearer.
                    Some(known) if !is_here => Some(known.min(range)),
                    _ => Some(range),
                };
            };
            for piece in pieces {
                let [(from, near), (to, far)] = piece.map(|end| polar(robot_from_odometry * end));
                add(bearing(from), near);
                let turn = wrapped(to - from);
                // The robot may see it from its other side.
                let (from, near, far) =
                    if turn < 0.0 { (to, far, near) } else { (from, near, far) };
                for (bearing, share) in bearings_between(from, turn.abs()) {
                    add(bearing, between_hits(near, far, share));
                }
            }
        }
        let mut sights: Vec<Sight> = sights.into_iter().map(Sight::measured).collect();
        let seen_by_robot = |(bearing, range): (f64, Option<f64>)| match range {
            Some(range) => {
                let (bearing, range) = polar(scan.point(bearing, range));
                (bearing, Some(range))
            }
            None => (bearing, None),
        };
        let readings: Vec<_> = scan.ranges_hit().map(seen_by_robot).collect();
        let next = readings.iter().cycle().skip(1);
        for (&(from, near), &(to, far)) in readings.iter().zip(next) {
            let turn = wrapped(to - from);
            if !(0.0..NEXT).contains(&turn) {
                continue;
            }
            for (bearing, share) in bearings_between(from, turn) {
                sights[bearing] = between(near, far, share);
            }
        }
        Boundary { sights }
    }

    fn remember_on_the_way(&mut self, scan: &Scan, odometry: &Odometry) {
        let moved =
            self.last.back().is_none_or(|(last, _)| !is_near(last, odometry, EVERY, EVERY_TURN));
        // What is seen all around needs no memory.
        if moved && !sees_all_round(scan) {
            self.remember(scan, odometry);
        }
    }
}

/// Whether a robot has moved by less than a distance, and turned by less than an angle.
fn is_near(one: &Odometry, other: &Odometry, distance: f64, turn: f64) -> bool {
    one.distance(other) < distance && wrapped(one.heading - other.heading).abs() < turn
}

fn sees_all_round(scan: &Scan) -> bool {
    scan.geometry().angle_increment * scan.ranges().len() as f64 > TAU - NEXT
}

/// The headings at which scans with this field of view, in radians, cover a full circle: to the left and back, to the
/// right and back. The errors of turns to both sides cancel.
fn headings_all_round(field_of_view: f64) -> Vec<f64> {
    let farthest = PI - field_of_view / 2.0 + OVERLAP;
    // A scan that covers next to nothing never makes a circle.
    let step = (field_of_view - OVERLAP).max(OVERLAP);
    let steps = (farthest / step).ceil().max(1.0);
    let one_side =
        |side: f64| (1..=steps as u32).map(move |index| side * farthest * f64::from(index) / steps);
    let ahead = std::iter::once(0.0);
    one_side(1.0).chain(ahead.clone()).chain(one_side(-1.0)).chain(ahead).collect()
}

/// Whether a robot at a junction would stand behind its wall: furniture along a corridor looks like the end of a
/// narrow one.
fn is_behind_its_wall(junction: &JunctionView) -> bool {
    junction.doors.len() == 1 && junction.distance() < -PAST_DEAD_END
}

/// The pieces of wall that a scan has hit, in the robot's frame.
fn wall_pieces(scan: &Scan) -> Vec<WallPiece> {
    let hit = |(bearing, range): (f64, Option<f64>)| Some((range?, scan.point(bearing, range?)));
    let mut pieces = Vec::new();
    let mut readings = scan.ranges_hit().map(hit).peekable();
    while let Some(reading) = readings.next() {
        let Some((near, from)) = reading else { continue };
        let next = readings.peek().copied().flatten();
        let to = next.filter(|&(far, _)| are_on_one_wall(near, far)).map_or(from, |(_, to)| to);
        pieces.push([from, to]);
    }
    pieces
}

/// The bearings of a boundary from a direction on, over an angle counter-clockwise, and the share of the angle up to
/// each.
fn bearings_between(from: f64, turn: f64) -> impl Iterator<Item = (usize, f64)> {
    let first = (from.rem_euclid(TAU) / TAU * BEARINGS as f64).ceil() as usize;
    let count = (turn / TAU * BEARINGS as f64).ceil() as usize;
    (first..=first + count).filter_map(move |bearing| {
        let share = wrapped(bearing as f64 * TAU / BEARINGS as f64 - from) / turn.max(1e-9);
        (share <= 1.0 + 1e-9).then_some((bearing % BEARINGS, share))
    })
}

fn are_on_one_wall(one: f64, other: f64) -> bool {
    (one - other).abs() < STEP + STEP_PART * one.min(other)
}

/// The range between two hits on one wall. Its inverse hardly bends in a small angle.
fn between_hits(near: f64, far: f64, share: f64) -> f64 {
    1.0 / (1.0 / near + share * (1.0 / far - 1.0 / near))
}

/// What is seen between two readings. A reading without a return shows nothing.
fn between(near: Option<f64>, far: Option<f64>, share: f64) -> Sight {
    let nearest = if share < 0.5 { near } else { far };
    let range = match (near, far) {
        (Some(one), Some(other)) if are_on_one_wall(one, other) => {
            Some(between_hits(one, other, share))
        }
        _ => nearest,
    };
    Sight::measured(range)
}

/// How far a point is to the left of a direction.
fn across(point: Point2<f64>, direction: f64) -> f64 {
    unit(direction).perp(&point.coords)
}

fn polar(point: Point2<f64>) -> (f64, f64) {
    (angle(point.coords), point.coords.norm())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wall or another surface: its ends, in metres.
    type Surface = [[f64; 2]; 2];

    /// A hallway along the x-axis, 1.6 m wide, that ends at 14 m; with a door on the left from 7.2 to 8.8 m, which
    /// leads to a hallway.
    const HALLWAY: [Surface; 7] = [
        [[-6.0, -0.8], [14.0, -0.8]],
        [[-6.0, 0.8], [7.2, 0.8]],
        [[8.8, 0.8], [14.0, 0.8]],
        [[14.0, -0.8], [14.0, 0.8]],
        [[-6.0, -0.8], [-6.0, 0.8]],
        [[7.2, 0.8], [7.2, 9.0]],
        [[8.8, 0.8], [8.8, 9.0]],
    ];

    /// A cabinet at the wall on the right, between two distances.
    fn cabinet(from: f64, to: f64) -> [Surface; 3] {
        [[[from, -0.8], [from, -0.45]], [[from, -0.45], [to, -0.45]], [[to, -0.45], [to, -0.8]]]
    }

    /// The range of a ray to a surface that is parallel to an axis.
    fn range([x, y]: [f64; 2], heading: f64, [from, to]: Surface) -> Option<f64> {
        let (along_x, along_y) = (heading.cos(), heading.sin());
        let is_upright = from[0] == to[0];
        let range = if is_upright { (from[0] - x) / along_x } else { (from[1] - y) / along_y };
        let hit = if is_upright { y + range * along_y } else { x + range * along_x };
        let axis = usize::from(is_upright);
        let within = from[axis].min(to[axis])..=from[axis].max(to[axis]);
        (range > 0.0 && within.contains(&hit)).then_some(range)
    }

    /// The places that a robot senses on its way along the x-axis, each 0.25 m, and whether each is a hallway whose walls
    /// are hidden.
    fn sensed(others: &[Surface], until: f64) -> Vec<(f64, Place, bool)> {
        let mut sensor = ScanPlaceSensor::default();
        let surfaces = [&HALLWAY[..], others].concat();
        let place = |step| {
            let odometry = Odometry { position: [0.25 * f64::from(step), 0.0], heading: 0.0 };
            let scan = Scan::each_degree(-180, 360, |bearing| {
                let ranges =
                    surfaces.iter().filter_map(|&one| range(odometry.position, bearing, one));
                ranges.fold(f64::INFINITY, f64::min)
            });
            let place = sensor.sense(&scan, &odometry);
            let is_hidden = matches!(
                place,
                Place::Hallway(hallway) if hallway.confidence == HIDDEN_CONFIDENCE
            );
            (odometry.position[0], place, is_hidden)
        };
        (0..=(until / 0.25).round() as u32).map(place).collect()
    }

    #[test]
    fn a_hallway_goes_on_beside_furniture() {
        let places = sensed(&cabinet(2.0, 4.0), 5.0);
        for (x, place, is_hidden) in &places {
            let Place::Hallway(hallway) = place else { panic!("{place:?} after {x} m") };
            assert!(hallway.heading.abs() < 0.1, "{hallway:?}");
            assert!((hallway.left - 0.8).abs() < 0.1 || !is_hidden, "{hallway:?}");
        }
        assert!(places.iter().any(|place| place.2));
    }

    #[test]
    fn a_door_beside_the_robot_and_what_is_in_its_way_end_a_hidden_hallway() {
        let crate_ahead = [[[3.4, -0.45], [3.4, 0.1]]];
        let in_way = [&cabinet(2.0, 4.0)[..], &crate_ahead].concat();
        for (others, until, end) in
            [(&cabinet(5.0, 9.5)[..], 9.0, 7.0..9.0), (&in_way, 3.3, 3.4 - FREE_AHEAD..f64::MAX)]
        {
            let places = sensed(others, until);
            let hidden: Vec<f64> =
                places.iter().filter(|place| place.2).map(|place| place.0).collect();
            assert!(!hidden.is_empty() && !hidden.iter().any(|x| end.contains(x)), "{hidden:?}");
        }
    }

    #[test]
    fn the_headings_of_a_look_around_cover_a_full_circle_and_end_ahead() {
        for degrees in [20, 90, 180, 240, 270, 330, 350] {
            let field_of_view = f64::from(degrees).to_radians();
            let headings = headings_all_round(field_of_view);
            assert_eq!(headings.last(), Some(&0.0));
            for bearing in -180..180 {
                let seen = headings.iter().any(|heading| {
                    let off = wrapped(f64::from(bearing).to_radians() - heading).abs();
                    off <= field_of_view / 2.0
                });
                assert!(seen, "{bearing} with {degrees}");
            }
            let turns = headings.windows(2).map(|pair| (pair[1] - pair[0]).abs());
            assert!(turns.chain([headings[0].abs()]).all(|turn| turn < PI), "{degrees}");
        }
    }

    #[test]
    fn a_robot_looks_around_if_its_scanner_does_not_see_all_round() {
        for (count, looks) in [(360, false), (181, true), (271, true)] {
            let scan = Scan::each_degree(-(i32::from(count) / 2), count, |_| 2.0);
            let sensor = ScanPlaceSensor::default();
            let headings = sensor.headings_to_look_around(&scan, &Odometry::default());
            assert_eq!(!headings.is_empty(), looks, "{count}");
        }
    }

    #[test]
    fn no_bearing_passes_between_two_hits_on_one_wall() {
        // Two hits on a wall, 0.4 m apart, 1 m to the left of where the robot is later.
        let mut sensor = ScanPlaceSensor::default();
        let scan = Scan::each_degree(11, 2, |bearing| 1.0 / bearing.sin());
        sensor.remember(&scan, &Odometry::default());
        let later = Odometry { position: [4.8, 0.0], heading: 0.0 };
        let nothing = Scan::each_degree(11, 1, |_| f64::NAN);
        let seen = sensor.boundary(&nothing, &later).points().count();
        assert!(seen > 10, "{seen}");
    }
}
