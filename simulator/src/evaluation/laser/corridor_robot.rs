//! A simulated robot in a network of corridors, and what it derives there compared with the truth.

use std::sync::Arc;

use nalgebra::{Point2, Vector2};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_logs::record::{Arrival, Event, EventKind, Frame, RunObserver};
use toposlam_model::{
    driving::{
        odometry::Odometry,
        pose::Pose,
        scene::{MarkerView, undirected, wrapped},
    },
    embedded_graph::Dart,
};
use toposlam_robot::robot::{Robot, RobotError, Sample, TimedOdometry};
use toposlam_vision::geometry::{direction, distance, from_robot, nearest, unit};

use super::corridor_world::{CorridorWorld, SmoothedWorld};
use crate::{ConvexPolygon, LaserScanner};

/// A robot that drives on the floor of a building. Furniture and people do not stop it.
#[derive(Debug)]
pub(super) struct CorridorRobot {
    floor: Vec<ConvexPolygon>,
    /// What stops it, and no scan shows.
    pub(super) obstacle: Option<ConvexPolygon>,
    scanner: LaserScanner,
    pose: Pose,
    reading: TimedOdometry,
    /// Of the heading of the odometry, in radians a metre.
    drift: f64,
    /// Where the marker lies, its direction, and the circle in which it is seen.
    marker: (Point2<f64>, f64, f64),
    scans: u64,
    track: Vec<Sample>,
    chance: Xoshiro256PlusPlus,
}

/// Metres and radians a second.
const SPEED: f64 = 0.5;
const TURN_RATE: f64 = 0.5;
/// Noise of the odometry: of a length as a part of it, and of the heading in radians a motion.
const LENGTH_NOISE: f64 = 0.01;
const HEADING_NOISE: f64 = 0.002;
/// The distance from the robot's centre to a wall before which it stops, and the step in which it looks for it, in
/// metres.
const RADIUS: f64 = 0.25;
const STEP: f64 = 0.05;
/// The marker lies this far from the walls of its junction, and is seen from up to this far behind its middle, in metres.
const MARKER: f64 = 0.4;
const MARKER_SEEN: f64 = 2.0;
/// The time to take a scan, in seconds.
const SCAN_TIME: f64 = 0.1;

impl CorridorRobot {
    /// A robot at a pose. The heading of its odometry drifts by so many radians a metre. The marker lies at the first of two
    /// places, in the direction of the other.
    pub(super) fn new(
        world: &CorridorWorld,
        scanner: LaserScanner,
        pose: Pose,
        drift: f64,
        marker: [usize; 2],
        seed: u64,
    ) -> Self {
        let Pose { position, heading } = pose;
        let [place, towards] = marker.map(|place| world.places[place]);
        let (along, clearance) = (direction(place, towards), world.clearance(marker[0]));
        Self {
            floor: world.plan.floor(),
            obstacle: None,
            scanner,
            pose,
            reading: TimedOdometry { time: 0.0, odometry: Odometry { position, heading } },
            drift,
            marker: (place + (clearance + MARKER) * unit(along), along, clearance + MARKER_SEEN),
            scans: 0,
            track: Vec::new(),
            chance: Xoshiro256PlusPlus::seed_from_u64(seed),
        }
    }

    fn has_space_at(&self, point: Point2<f64>) -> bool {
        let [along, across] = [Vector2::new(RADIUS, 0.0), Vector2::new(0.0, RADIUS)];
        let is_floor = |point: Point2<f64>| {
            self.floor.iter().any(|piece| piece.holds(point))
                && !self.obstacle.as_ref().is_some_and(|obstacle| obstacle.holds(point))
        };
        [along, -along, across, -across].into_iter().all(|off| is_floor(point + off))
    }

    /// How far the robot can truly go ahead, up to a distance.
    fn room(&self, distance: f64) -> f64 {
        let at = Point2::from(self.pose.position);
        let steps = (1_u32..).map(|step| STEP * f64::from(step));
        let is_free = |length: &f64| self.has_space_at(at + *length * unit(self.pose.heading));
        let free = steps.take_while(|length| *length <= distance + STEP && is_free(length)).last();
        free.unwrap_or_default().min(distance)
    }

    fn noise(&mut self, deviation: f64) -> f64 {
        let standard: f64 = StandardNormal.sample(&mut self.chance);
        deviation * standard
    }

    /// Ends a motion of so many metres by odometry, and radians.
    fn moved(&mut self, driven: f64, turned: f64) {
        let TimedOdometry { time, odometry } = self.reading;
        let seconds = driven / SPEED + turned.abs() / TURN_RATE;
        let noise = self.noise(HEADING_NOISE);
        let turn = wrapped(turned + self.drift * driven + noise);
        let [x, y] = odometry.moved(0.0, driven).position;
        let odometry = Odometry { position: [x, y], heading: wrapped(odometry.heading + turn) };
        self.reading = TimedOdometry { time: time + seconds, odometry };
        let (speed, turning) = (SPEED.min(driven / seconds.max(1e-9)), turned / seconds.max(1e-9));
        self.track.push(Sample { speed, turning, reading: self.reading });
    }
}

impl Robot for CorridorRobot {
    fn capture(&mut self) -> Result<Frame, RobotError> {
        self.scans += 1;
        self.reading.time += SCAN_TIME;
        self.track.push(Sample { speed: 0.0, turning: 0.0, reading: self.reading });
        let TimedOdometry { time: taken, odometry } = self.reading;
        let scan = self.scanner.scan(self.pose, self.scans, taken);
        let scan = scan.map_err(|_| RobotError::NoImage)?;
        let Pose { position, heading } = self.pose;
        let robot_from_plan = from_robot(&Odometry { position, heading }).inverse();
        let (at, along, seen) = self.marker;
        let marker = (distance(at, position) < seen).then(|| MarkerView {
            position: (robot_from_plan * at).into(),
            axis: undirected(wrapped(along - heading)),
            door: None,
        });
        let scan = Some(Arc::new(scan));
        Ok(Frame { id: self.scans, taken, odometry, scan, marker, ..Frame::default() })
    }

    fn turn(&mut self, angle: f64) -> Result<(), RobotError> {
        self.pose.heading = wrapped(self.pose.heading + angle);
        self.moved(0.0, angle);
        Ok(())
    }

    fn forward(&mut self, distance: f64) -> Result<(), RobotError> {
        let driven = self.room(distance);
        let at = Point2::from(self.pose.position);
        self.pose.position = (at + driven * unit(self.pose.heading)).into();
        let scale = 1.0 + self.noise(LENGTH_NOISE);
        self.moved(scale * driven, 0.0);
        Ok(())
    }

    fn odometry(&self) -> TimedOdometry {
        self.reading
    }

    fn track(&self) -> &[Sample] {
        &self.track
    }

    fn truth(&self) -> Option<Pose> {
        Some(self.pose)
    }
}

/// What the robot has derived, compared with the truth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PerceptTally {
    pub percepts: u64,
    /// Those whose number of doors is wrong, or that are of no junction.
    pub wrong: u64,
    /// The moves that ended at another junction than the next one.
    pub passed: u64,
}

/// Compares what a robot derives with the truth.
#[derive(Debug)]
pub(super) struct PerceptJudge<'w> {
    world: &'w CorridorWorld,
    smoothed: &'w SmoothedWorld,
    /// The angle from the frame of odometry to the plan.
    turn: f64,
    /// The dart by which it comes in next, if it notices the next junction or dead end.
    next: Option<Dart>,
    /// The dart by which it has truly come in, when it last derived where it is.
    pub(super) truth: Option<Dart>,
    pub(super) tally: PerceptTally,
}

impl<'w> PerceptJudge<'w> {
    pub(super) fn new(world: &'w CorridorWorld, smoothed: &'w SmoothedWorld) -> Self {
        let (next, truth) = (None, None);
        Self { world, smoothed, turn: 0.0, next, truth, tally: PerceptTally::default() }
    }

    /// The dart by which a robot has truly come in, from a direction on the plan.
    fn truly_at(&self, robot: Point2<f64>, entry: f64) -> Option<Dart> {
        let ends = |dart: &Dart| {
            self.smoothed.corridors[dart.at()].map(|place| (place, self.world.places[place]))
        };
        let is_here = |dart: &Dart| {
            let [(place, at), _] = ends(dart);
            distance(at, robot) < self.world.clearance(place) + MARKER_SEEN
        };
        let darts = self.smoothed.graph.darts().filter(is_here);
        nearest(darts, |dart| {
            let [(_, from), (_, to)] = ends(dart);
            wrapped(direction(from, to) - entry).abs()
        })
    }
}

impl RunObserver for PerceptJudge<'_> {
    fn event(&mut self, event: &Event) {
        let Some(Pose { position, heading }) = event.truth else { return };
        match &event.kind {
            EventKind::Frame(frame) => self.turn = wrapped(heading - frame.odometry.heading),
            EventKind::Door { door, .. } => {
                let graph = &self.smoothed.graph;
                self.next = self.truth.map(|dart| graph.opposite(graph.behind(dart, *door)));
            }
            EventKind::Arrival(Arrival { number, degree, entry: Some(entry), .. }) => {
                self.truth = self.truly_at(position.into(), wrapped(entry + self.turn));
                let graph = &self.smoothed.graph;
                let is_true = self.truth.is_some_and(|dart| graph.degree_around(dart) == *degree);
                self.tally.percepts += 1;
                self.tally.wrong += u64::from(!is_true);
                // A robot that got lost may come to another one.
                let next = self.next.take().filter(|_| number.is_some());
                if let (Some(next), Some(truth)) = (next, self.truth) {
                    self.tally.passed += u64::from(graph.vertex(next) != graph.vertex(truth));
                }
            }
            _ => {}
        }
    }
}
