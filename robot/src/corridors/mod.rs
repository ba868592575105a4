//! A robot that maps a building by its laser scanner alone: a network of corridors at any angle, with up to eight doors at a
//! junction, or hallways with corners. It goes on with what it derives, right or wrong.
//!
//! It drives along the middle line of its local map until it is within what may be a junction. There it turns around once,
//! and drives into each arm of which it does not see enough, until it has driven as far as makes an arm, or cannot go on. If
//! its scanner does not see far enough for arms, it stops where any ways meet, and drives into each of them. A detector of
//! its own reports the marker. Dead ends are vertices. Bends are if the parameters say so: then the robot begins at a vertex,
//! with its back to a door, and else in a corridor.

mod junction;
mod marking;
mod motion;
mod params;
mod touch;
mod trail;

use std::{
    f64::consts::{FRAC_PI_2, PI},
    sync::Arc,
};

use nalgebra::{Isometry2, Point2};
use toposlam_logs::record::{Arrival, EventKind, Frame, RunObserver};
use toposlam_model::{
    driving::{
        algorithm2::JunctionState,
        odometry::Odometry,
        scene::{MarkerView, wrapped},
        visit::JunctionShape,
    },
    mapping::{MapWalk, MappedWorld, MappingError, Relocate},
    percept::{Door, Percept, Sighting},
    world::{AidHandler, World},
};
use toposlam_vision::{
    geometry::{distance, from_robot},
    laser::{local_map::LocalMap, params::LaserParams, scan::Scan, sensor::LaserSensor},
    place::SeenPlace,
    visits::Visits,
};

use crate::{
    budget::{Allowance, Spent},
    capture::{FrameKind, RETAKES, UnusableFrame, capture},
    event_log::EventLog,
    explorer::{CorridorFailure, ExplorerError, MappingRobot, RunParts},
    robot::{Robot, RobotError},
    run_settings::RunSettings,
};
use marking::Sought;
use params::CorridorParams;
use touch::Felt;
use trail::Trail;

/// A robot that explores a network of corridors. Directions are those of the frame of odometry.
#[derive(Clone, Debug)]
pub struct CorridorExplorer<R, O = ()> {
    robot: R,
    log: EventLog<O>,
    params: LaserParams,
    driving: &'static CorridorParams,
    visits: Visits<LaserSensor, ()>,
    trail: Trail,
    /// The length of the way, in metres, and until it was last at a junction or a dead end.
    way: f64,
    way_to_last: f64,
    /// The direction in which it drove last.
    heading: f64,
    /// Known after the first scan.
    scanner: ScannerReach,
    /// From the local map to the frame of odometry, in the last view.
    odometry_from_map: Isometry2<f64>,
    /// What may be junctions, in each view since it began to look around.
    seen: Vec<Vec<SeenPlace>>,
    /// Where any ways meet near the robot, in each of these views.
    openings: Vec<Option<SeenPlace>>,
    /// The place that it left last, while it is near, on the local map.
    left: Option<LeftPlace>,
    /// Where it turned around last, on the local map, and the length of its way then.
    looked: Option<(Point2<f64>, f64)>,
    /// Whether the last view shows an opening beside it into which its scanner may not have looked.
    is_at_opening: bool,
    /// What it has seen on a side trip while it was near the place where that began.
    side_trip: Option<SideTrip>,
    /// Where it felt for walls that it does not see, since its last place: pieces of wall, or of what is free.
    felt: Vec<Felt>,
    sought: Sought,
    /// The marker, or the other robot of the team, where it was seen last.
    marker: Option<SeenMarker>,
    /// The place where it stands, with the directions of its doors, clockwise from the one by which it came in.
    place: Option<StoodAt>,
    /// Whether it takes what stops it for a dead end, and whether it stands before that.
    returns_at_obstacles: bool,
    is_blocked: bool,
    last_move: u64,
    moves: u64,
    door: Option<Door>,
    allowance: Allowance,
    last: Option<Frame>,
}

/// Whether a scanner sees arms far enough, and beyond their ends, and all round.
#[derive(Clone, Copy, Debug, Default)]
struct ScannerReach {
    sees_arms: bool,
    sees_beyond_arms: bool,
    sees_all_round: bool,
}

#[derive(Clone, Copy, Debug)]
struct SeenMarker {
    at: Point2<f64>,
    /// The direction of its longer side, or the opposite one.
    axis: f64,
    /// The length of the robot's way when it was seen.
    way: f64,
}

#[derive(Clone, Debug)]
struct StoodAt {
    centre: Point2<f64>,
    extent: f64,
    doors: Vec<f64>,
    /// What it sees of the marker there.
    sighting: Sighting,
}

#[derive(Clone, Copy, Debug)]
struct LeftPlace {
    centre: Point2<f64>,
    extent: f64,
    is_junction: bool,
}

#[derive(Clone, Debug)]
struct SideTrip {
    from: Point2<f64>,
    visits: Visits<LaserSensor, ()>,
    near: Vec<(Arc<Scan>, Odometry)>,
}

/// Why the robot stops: an error, or it does not know where it is.
enum Stop {
    Failure(CorridorFailure),
    Error(ExplorerError),
}

impl From<RobotError> for Stop {
    fn from(error: RobotError) -> Self {
        Self::Error(error.into())
    }
}

impl From<CorridorFailure> for Stop {
    fn from(failure: CorridorFailure) -> Self {
        Self::Failure(failure)
    }
}

impl<R: Robot, O: RunObserver> CorridorExplorer<R, O> {
    /// A robot at its start.
    pub fn new(robot: R, params: &LaserParams, observer: O) -> Self {
        let heading = robot.odometry().odometry.heading;
        Self {
            robot,
            log: EventLog::new(observer),
            params: *params,
            driving: CorridorParams::for_corners(params.corner.corners),
            visits: Visits::by_laser(*params),
            trail: Trail::default(),
            way: 0.0,
            way_to_last: 0.0,
            heading,
            scanner: ScannerReach::default(),
            odometry_from_map: Isometry2::identity(),
            seen: Vec::new(),
            openings: Vec::new(),
            left: None,
            looked: None,
            is_at_opening: false,
            side_trip: None,
            felt: Vec::new(),
            sought: Sought::default(),
            marker: None,
            place: None,
            returns_at_obstacles: false,
            is_blocked: false,
            last_move: 0,
            moves: 0,
            door: None,
            allowance: Allowance::default(),
            last: None,
        }
    }

    /// The same robot, if it is already known where it stands: at a place in a building with right angles.
    #[must_use]
    pub fn at_junction(mut self, state: &JunctionState) -> Self {
        let JunctionState { shape: JunctionShape(quarters), percept, entry } = *state;
        let quarters = (0..).zip(quarters).filter(|(_, is_door)| *is_door);
        let doors = quarters.map(|(quarter, _)| wrapped(entry - FRAC_PI_2 * f64::from(quarter)));
        self.place = Some(StoodAt {
            centre: self.at(),
            extent: self.driving.end_extent,
            doors: doors.collect(),
            sighting: percept.sighting,
        });
        self
    }

    /// The moves that ended at a junction or a dead end, with those of recoveries and audits.
    pub fn moves(&self) -> u64 {
        self.moves
    }

    /// The length of the way, in metres.
    pub fn way(&self) -> f64 {
        self.way
    }

    /// Whether it stands before an obstacle that it takes for a dead end.
    pub fn is_at_obstacle(&self) -> bool {
        self.is_blocked
    }

    pub fn robot_mut(&mut self) -> &mut R {
        &mut self.robot
    }

    pub fn into_parts(self) -> (R, O) {
        (self.robot, self.log.observer)
    }

    /// Maps the building, from the first junction to which the robot comes. A robot that recovers returns where something
    /// stops it, as from a dead end. Returns the state of the algorithm, too.
    ///
    /// # Errors
    /// Returns an error if the run ended before the map was complete.
    pub fn map(
        &mut self,
        settings: &RunSettings,
    ) -> (MapWalk, Result<MappedWorld, MappingError<ExplorerError>>) {
        self.returns_at_obstacles |= settings.method.recovers();
        self.sought = Sought::of(settings.method.algorithm().aid());
        self.map_building(settings)
    }

    fn spent(&self) -> Spent {
        Spent::new(self.last_move as f64, self.robot.odometry().time, self.way)
    }

    fn error(&self, stop: Stop) -> ExplorerError {
        match stop {
            Stop::Error(ExplorerError::Robot(RobotError::Stopped)) => {
                ExplorerError::Stopped { moves: self.last_move }
            }
            Stop::Error(error) => error,
            Stop::Failure(cause) => {
                ExplorerError::NoJunction { moves: self.last_move, door: self.door, cause }
            }
        }
    }

    /// The odometry of the last scan: what the robot decides depends on its scans alone.
    fn odometry(&self) -> Odometry {
        let now = || self.robot.odometry().odometry;
        self.last.as_ref().map_or_else(now, |last| last.odometry)
    }

    /// Where it is, in the frame of odometry.
    fn at(&self) -> Point2<f64> {
        self.odometry().position.into()
    }

    /// Where it is on the local map.
    fn on_local_map(&self) -> Point2<f64> {
        self.odometry_from_map.inverse() * self.at()
    }

    /// The angle from the local map to the frame of odometry.
    fn turn_of_map(&self) -> f64 {
        self.odometry_from_map.rotation.angle()
    }

    fn local_map(&self) -> Option<&LocalMap> {
        self.visits.sensor().map()
    }

    /// Takes a scan, and what it shows.
    fn sense(&mut self) -> Result<(), Stop> {
        if self.log.observer.stop() {
            return Err(RobotError::Stopped.into());
        }
        let spent = self.spent();
        if let Some(limit) = self.allowance.limit_reached(spent) {
            let (moves, is_at_marker) = (self.last_move, false);
            return Err(Stop::Error(ExplorerError::Budget { moves, limit, is_at_marker }));
        }
        if self.way > self.driving.longest_way
            || self.way - self.way_to_last > self.driving.longest_search
        {
            return Err(CorridorFailure::TooFar.into());
        }
        let before = self.at();
        let (frame, scan) = self.look()?;
        let Frame { odometry, marker, .. } = frame;
        self.way += distance(before, odometry.position);
        self.emit(EventKind::Frame(frame));
        if self.trail.is_empty() {
            // A scanner that does not know its range may see no farther than any other.
            let range = scan.geometry().range_max;
            let sees = |least: f64| range.is_finite() && range >= least;
            self.scanner = ScannerReach {
                // The arms of hallways are short.
                sees_arms: self.params.corner.corners || sees(self.driving.sees_arms),
                sees_beyond_arms: !self.params.corner.corners
                    || sees(self.driving.sees_beyond * self.params.arm.min_arm),
                sees_all_round: scan.field_of_view() > self.driving.all_around,
            };
        }
        self.trail.push(odometry.position.into());
        if let Some(MarkerView { position, axis, .. }) = marker {
            let at = from_robot(&odometry) * Point2::from(position);
            self.marker = Some(SeenMarker { at, axis: odometry.whither(axis), way: self.way });
        }
        if let Some(view) = self.visits.add_frame((), &scan, &odometry) {
            self.odometry_from_map = view.odometry_from_map;
            // What is far from the place is not on its map.
            let is_near = self.side_trip.as_mut().is_none_or(|trip| {
                let is_near = distance(trip.from, odometry.position) <= self.driving.near_place;
                if is_near {
                    trip.near.push((scan.clone(), odometry));
                }
                is_near
            });
            if is_near && self.scanner.sees_arms {
                self.is_at_opening = self.is_opening();
            } else if is_near {
                self.openings.push(self.opening_at(self.on_local_map()));
            }
            if is_near {
                self.seen.push(view.possible_places);
            }
        }
        let at = self.on_local_map();
        if self.left.is_some_and(|LeftPlace { centre, extent, .. }| {
            distance(centre, at) > extent + 2.0 * self.driving.left_behind
        }) {
            self.left = None;
        }
        Ok(())
    }

    /// Whether the last view shows ways that meet where the robot is, if its scanner does not look behind it and it has not
    /// turned around nearby.
    fn is_opening(&self) -> bool {
        let robot = self.on_local_map();
        let has_looked = self.looked.is_some_and(|(at, way)| {
            distance(at, robot) < self.driving.looked && self.way - way < self.driving.look_memory
        });
        !has_looked
            && !self.scanner.sees_all_round
            && self.local_map().is_some_and(|map| map.meets_near(robot, self.driving.opening))
    }

    /// A scan that was taken since the robot last moved.
    fn look(&mut self) -> Result<(Frame, Arc<Scan>), Stop> {
        let mut last = UnusableFrame::Missing;
        for _ in 0..RETAKES {
            match capture(&mut self.robot, self.last.as_ref()) {
                Ok(frame) => {
                    if let Some(scan) = frame.scan.clone() {
                        self.last = Some(frame.clone());
                        return Ok((frame, scan));
                    }
                }
                Err(UnusableFrame::Robot(error)) => return Err(error.into()),
                Err(unusable) => last = unusable,
            }
        }
        let cause = last.cause(FrameKind::Scan);
        let (moves, door, frame) = (self.last_move, self.door, FrameKind::Scan);
        Err(Stop::Error(ExplorerError::NoImage { moves, door, images: RETAKES, cause, frame }))
    }

    /// It stands at a place of this extent, with doors in these directions.
    fn stand(&mut self, centre: Point2<f64>, extent: f64, doors: Vec<f64>) -> Result<(), Stop> {
        let sighting = self.sighting(centre, extent, &doors)?;
        self.place = Some(StoodAt { centre, extent, doors, sighting });
        self.way_to_last = self.way;
        Ok(())
    }

    /// Reports that it stands at a place, after the move with this number if it is known.
    fn report_arrival(&mut self, number: Option<u64>) {
        let Some(StoodAt { doors, sighting, .. }) = self.place.clone() else { return };
        let percept = Percept { degree: doors.len() as u32, sighting };
        let spent = self.spent();
        self.allowance.perceive(percept, spent);
        self.emit(EventKind::Arrival(Arrival {
            number: number.and_then(|number| u32::try_from(number).ok()),
            degree: percept.degree,
            sighting: Some(percept.sighting),
            shape: None,
            entry: doors.first().copied(),
        }));
    }

    /// The place where it stands. At the very start, it drives to its first one, unless it begins at a vertex.
    fn place(&mut self) -> Result<StoodAt, ExplorerError> {
        if self.place.is_none() && self.last_move == 0 {
            self.begin().map_err(|stop| self.error(stop))?;
            self.report_arrival(Some(0));
        }
        self.place.clone().ok_or_else(|| self.error(CorridorFailure::Missed.into()))
    }
}

impl<R: Robot, O: RunObserver> MappingRobot for CorridorExplorer<R, O> {
    type Robot = R;
    type Observer = O;

    fn parts(&mut self) -> RunParts<'_, R, O> {
        let Self { robot, log, allowance, last_move, moves, .. } = self;
        RunParts { robot, log, allowance, last_move: *last_move, moves: *moves }
    }
}

impl<R: Robot, O: RunObserver> World for CorridorExplorer<R, O> {
    type Error = ExplorerError;

    fn percept(&mut self) -> Result<Percept, ExplorerError> {
        let place = self.place()?;
        Ok(Percept { degree: place.doors.len() as u32, sighting: place.sighting })
    }

    fn traverse(&mut self, door: Door) -> Result<(), ExplorerError> {
        let place = self.place()?;
        let Some(&towards) = place.doors.get(door.0 as usize) else {
            return Err(self.error(CorridorFailure::Missed.into()));
        };
        let spent = self.spent();
        if let Some(limit) = self.allowance.forbids(door, spent) {
            let (moves, is_at_marker) = (self.last_move, false);
            return Err(ExplorerError::Budget { moves, limit, is_at_marker });
        }
        self.allowance.leave(door, spent);
        self.last_move += 1;
        self.door = Some(door);
        let number = u32::try_from(self.last_move).ok();
        self.emit(EventKind::Door { number, door });
        if let Err(stop) = self.drive(towards) {
            self.allowance.lose_way();
            return Err(self.error(stop));
        }
        self.moves += 1;
        self.report_arrival(Some(self.last_move));
        self.turn_away_from_entry().map_err(|stop| self.error(stop))
    }

    fn handler(&mut self) -> Option<&mut dyn AidHandler<Error = ExplorerError>> {
        Some(self)
    }
}

impl<R: Robot, O: RunObserver> Relocate for CorridorExplorer<R, O> {
    /// Drives on, or back, until it derives a junction or comes to a dead end.
    fn relocate(&mut self, error: ExplorerError) -> Result<(), ExplorerError> {
        let can_go_on = match &error {
            ExplorerError::NoJunction { cause, .. } => *cause != CorridorFailure::TooFar,
            ExplorerError::NoImage { .. } => true,
            _ => false,
        };
        if !can_go_on {
            return Err(error);
        }
        for number in 0..self.driving.tries {
            let towards = if number % 2 == 0 { self.heading } else { self.heading + PI };
            match self.drive(wrapped(towards)) {
                Ok(()) => {
                    // How many moves lead there is not known.
                    self.report_arrival(None);
                    return Ok(());
                }
                Err(Stop::Failure(cause)) if cause != CorridorFailure::TooFar => {}
                Err(Stop::Error(ExplorerError::NoImage { .. })) => {}
                Err(stop) => return Err(self.error(stop)),
            }
        }
        Err(error)
    }

    fn is_blocked(&self) -> bool {
        self.is_blocked
    }
}
