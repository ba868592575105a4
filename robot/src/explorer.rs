//! A robot as a world: a mapping algorithm chooses doors, and Algorithm 2 drives the robot through them.
//! Sections 4.3 and 5.

mod error;
mod mapping_run;
mod obstacle;
mod relocation;
mod team;

use toposlam_logs::record::{Arrival, EventKind, Frame, FrameSensor, RunObserver};
use toposlam_model::{
    aid::{AidAction, AidKind},
    driving::{
        algorithm2::{Command, JunctionState, Lost, LostReason, PathExecution, PathState, Step},
        scene::Scene,
        visit::SoughtMarker,
    },
    mapping::{ArrivalMeasurement, MapWalk, MappedWorld, MappingError},
    percept::{Door, Percept, Sighting},
    world::{AidHandler, World},
};

use crate::{
    budget::{Allowance, Spent},
    capture::{RETAKES, UnusableFrame, capture},
    event_log::EventLog,
    measured_hallway::{MeasuredHallway, direction},
    robot::{Robot, RobotError},
    run_settings::RunSettings,
};

pub use crate::capture::FrameKind;
pub use error::{CorridorFailure, ExplorerError};
pub(crate) use mapping_run::{MappingRobot, RunParts};
use obstacle::{DEAD_END, Stall, turning_point};

#[derive(Clone, Copy, Debug, PartialEq)]
enum Standpoint {
    /// At the turning point of a junction.
    Junction(JunctionState),
    /// In a hallway, before an obstacle. The way back is in this direction, in the frame of odometry.
    Obstacle { back: f64 },
}

/// A robot that explores. Everything that happens goes to one observer.
///
/// At its start it stands at the turning point of an L, its back to the facing hallway, and has put
/// its marker down along it.
// paper: hardware.capture
#[derive(Clone, Debug)]
pub struct RobotExplorer<R, S, O = ()> {
    robot: R,
    sensor: S,
    log: EventLog<O>,
    place: Option<Standpoint>,
    /// The number of doors taken: the number of the last move.
    last_move: u64,
    /// The number of moves that ended at a junction or before an obstacle.
    moves: u64,
    door: Option<Door>,
    /// Whether it returns at an obstacle that it cannot pass, as from a dead end, and does not give up.
    returns_at_obstacles: bool,
    sought: SoughtMarker,
    /// Whether another robot belongs to it, which it sends through doors.
    has_team: bool,
    /// Where an obstacle stopped it, since it last stood at a junction.
    stall: Option<Stall>,
    /// Whether the robot may stand anywhere at its start, and not only at an L.
    begins_anywhere: bool,
    allowance: Allowance,
    /// The way that was commanded, in metres.
    metres: f64,
    /// The hallway since the last junction, and what was measured on the way to it.
    hallway: Option<MeasuredHallway>,
    measured: ArrivalMeasurement,
    last: Option<Frame>,
}

impl<R: Robot, S: FrameSensor, O: RunObserver> RobotExplorer<R, S, O> {
    pub fn new(robot: R, sensor: S, observer: O) -> Self {
        Self {
            robot,
            sensor,
            log: EventLog::new(observer),
            place: None,
            returns_at_obstacles: false,
            sought: SoughtMarker::Pointing,
            has_team: false,
            stall: None,
            begins_anywhere: false,
            allowance: Allowance::default(),
            metres: 0.0,
            hallway: None,
            measured: ArrivalMeasurement::default(),
            last_move: 0,
            moves: 0,
            door: None,
            last: None,
        }
    }

    /// The same robot, if it is already known where it stands.
    #[must_use]
    pub fn at_junction(mut self, state: JunctionState) -> Self {
        self.place = Some(Standpoint::Junction(state));
        self
    }

    /// The moves that ended at a junction or before an obstacle, with those of recoveries and audits. A move on which the
    /// robot got lost is not counted.
    pub fn moves(&self) -> u64 {
        self.moves
    }

    pub fn is_at_obstacle(&self) -> bool {
        matches!(self.place, Some(Standpoint::Obstacle { .. }))
    }

    pub fn into_parts(self) -> (R, O) {
        (self.robot, self.log.observer)
    }

    /// Maps the building. A robot that recovers returns at an obstacle, as from a dead end. With earlier walks it may
    /// stand anywhere at its start. Returns the state of the algorithm, too.
    ///
    /// # Errors
    /// Returns an error if the run ended before the map was complete.
    pub fn map(
        &mut self,
        settings: &RunSettings,
    ) -> (MapWalk, Result<MappedWorld, MappingError<ExplorerError>>) {
        self.returns_at_obstacles |= settings.method.recovers();
        self.begins_anywhere = !settings.earlier.is_empty();
        let aid = settings.method.algorithm().aid();
        self.sought = match aid {
            AidKind::Markers(_) => SoughtMarker::Lying,
            AidKind::Team(_) => SoughtMarker::Nothing,
            _ => SoughtMarker::Pointing,
        };
        self.has_team = matches!(aid, AidKind::Team(_));
        self.map_building(settings)
    }

    fn spent(&self) -> Spent {
        Spent::new(self.last_move as f64, self.robot.odometry().time, self.metres)
    }

    /// Drives a path to its end.
    fn drive(&mut self, path: PathExecution) -> Result<JunctionState, ExplorerError> {
        let mut path = path.with_sought(self.sought);
        let mut junction = None;
        loop {
            let (moves, door) = (self.last_move, self.door);
            if self.log.observer.stop() {
                return Err(ExplorerError::Stopped { moves });
            }
            let (frame, scene) = self.look()?;
            if let Some(hallway) = &mut self.hallway {
                hallway.add(frame.odometry);
            }
            let step = path.round(&scene, frame.odometry);
            if let Err(Lost { why: LostReason::Stalled { .. }, .. }) = step {
                self.stall = Some(Stall { back: path.way_back(), junction });
            }
            let is_coming = path.state() == PathState::Junction;
            junction = is_coming.then(|| turning_point(&scene, frame.odometry)).flatten();
            self.last = Some(frame.clone());
            self.emit(EventKind::Frame(Frame { scene: Some(scene), ..frame }));
            let command = match step {
                Ok(Step::Go(command)) => Some(command),
                Ok(Step::Arrived(_)) | Err(_) => None,
            };
            self.emit(EventKind::Command { state: path.state(), command });
            match step.map_err(|lost| ExplorerError::Lost { moves, door, lost })? {
                Step::Arrived(state) => return Ok(state),
                Step::Go(command) => self.carry_out(command)?,
            }
        }
    }

    fn carry_out(&mut self, command: Command) -> Result<(), ExplorerError> {
        if command.turn != 0.0 {
            self.robot.turn(command.turn).map_err(|error| self.robot_error(error))?;
        }
        if command.forward != 0.0 {
            self.metres += command.forward.abs();
            self.robot.forward(command.forward).map_err(|error| self.robot_error(error))?;
        }
        Ok(())
    }

    fn robot_error(&self, error: RobotError) -> ExplorerError {
        match error {
            RobotError::Stopped => ExplorerError::Stopped { moves: self.last_move },
            error => error.into(),
        }
    }

    /// A frame that can be used, and its scene.
    // paper: alg2.4, alg2.5
    fn look(&mut self) -> Result<(Frame, Scene), ExplorerError> {
        let mut last = UnusableFrame::Missing;
        for _ in 0..RETAKES {
            match self.frame() {
                Ok(seen) => return Ok(seen),
                Err(UnusableFrame::Robot(error)) => return Err(self.robot_error(error)),
                Err(unusable) => last = unusable,
            }
        }
        let frame = FrameKind::Image;
        let cause = last.cause(frame);
        let (moves, door) = (self.last_move, self.door);
        Err(ExplorerError::NoImage { moves, door, images: RETAKES, cause, frame })
    }

    /// A frame that was taken since the robot last moved, and its scene.
    fn frame(&mut self) -> Result<(Frame, Scene), UnusableFrame> {
        let frame = self.capture()?;
        let scene = self.sensor.scene(&frame)?;
        Ok((frame, scene))
    }

    fn capture(&mut self) -> Result<Frame, UnusableFrame> {
        capture(&mut self.robot, self.last.as_ref())
    }

    /// Where the robot stands. At the very start, it finds out.
    fn junction_state(&mut self) -> Result<JunctionState, ExplorerError> {
        if let Some(Standpoint::Junction(state)) = self.place {
            return Ok(state);
        }
        let odometry = self.robot.odometry().odometry;
        let state = match self.drive(PathExecution::at_start(&odometry)) {
            Err(ExplorerError::Lost { .. }) if self.begins_anywhere => return self.find_junction(),
            state => state?,
        };
        if !self.begins_anywhere && !state.shape.is_l() {
            return Err(ExplorerError::NotAnL { degree: state.shape.degree() });
        }
        let state = self.with_team(state)?;
        self.arrive(state, Arrival::new(self.last_move, &state));
        Ok(state)
    }

    fn allow_for(&mut self, percept: Percept) {
        let spent = self.spent();
        self.allowance.perceive(percept, spent);
    }

    fn arrive(&mut self, state: JunctionState, arrival: Arrival) {
        self.place = Some(Standpoint::Junction(state));
        self.stall = None;
        let hallway = self.hallway.take().and_then(|hallway| hallway.measured(arrival.entry));
        self.measured = ArrivalMeasurement { hallway, shape: arrival.shape };
        self.hallway = Some(MeasuredHallway::from(Some(self.robot.odometry().odometry)));
        self.allow_for(state.percept);
        self.emit(EventKind::Arrival(arrival));
    }
}

impl<R: Robot, S: FrameSensor, O: RunObserver> MappingRobot for RobotExplorer<R, S, O> {
    type Robot = R;
    type Observer = O;

    fn parts(&mut self) -> RunParts<'_, R, O> {
        let Self { robot, log, allowance, last_move, moves, .. } = self;
        RunParts { robot, log, allowance, last_move: *last_move, moves: *moves }
    }
}

impl<R: Robot, S: FrameSensor, O: RunObserver> World for RobotExplorer<R, S, O> {
    type Error = ExplorerError;

    fn percept(&mut self) -> Result<Percept, ExplorerError> {
        match self.place {
            Some(Standpoint::Obstacle { .. }) => Ok(DEAD_END),
            _ => Ok(self.junction_state()?.percept),
        }
    }

    // paper: validation.traverse, validation.motion, drive.path
    fn traverse(&mut self, door: Door) -> Result<(), ExplorerError> {
        let from = match self.place {
            Some(at) => at,
            None => Standpoint::Junction(self.junction_state()?),
        };
        if let Some(limit) = self.allowance.forbids(door, self.spent()) {
            return Err(ExplorerError::Budget {
                moves: self.last_move,
                limit,
                is_at_marker: false,
            });
        }
        self.allowance.leave(door, self.spent());
        match (&mut self.hallway, &from) {
            (Some(hallway), Standpoint::Junction(from)) => {
                hallway.leave(direction(from.shape, from.entry, door));
            }
            // A way that an obstacle ended is not measured.
            (hallway, _) => *hallway = None,
        }
        self.last_move += 1;
        self.door = Some(door);
        // Until the robot arrives, it does not know where it is.
        self.place = None;
        let number = u32::try_from(self.last_move).ok();
        self.emit(EventKind::Door { number, door });
        let driven = match &from {
            Standpoint::Junction(from) => self.drive(PathExecution::new(&[door], from)),
            Standpoint::Obstacle { back } => self.go_in_direction(*back),
        };
        match driven {
            Ok(state) => {
                self.moves += 1;
                let state = self.with_team(state)?;
                self.arrive(state, Arrival::new(self.last_move, &state));
            }
            Err(error) if self.returns_at_obstacles && error.is_stalled() => {
                self.stand_at_obstacle();
            }
            Err(error) => {
                self.allowance.lose_way();
                return Err(error);
            }
        }
        Ok(())
    }

    fn handler(&mut self) -> Option<&mut dyn AidHandler<Error = ExplorerError>> {
        Some(self)
    }
}

impl<R: Robot, S: FrameSensor, O: RunObserver> AidHandler for RobotExplorer<R, S, O> {
    type Error = ExplorerError;

    /// Picks the marker up or drops it, where the robot stands. Its body hides the floor there; but the gripper feels whether
    /// it holds the marker, so the robot then knows whether one lies here. Or sends the other robot, and looks whether it is here.
    fn handle(&mut self, action: AidAction) -> Result<(), ExplorerError> {
        let state = self.junction_state()?;
        self.robot.handle(action).map_err(|error| self.robot_error(error))?;
        let number = u32::try_from(self.last_move).ok();
        self.emit(EventKind::Action { number, action });
        let sighting = match action {
            AidAction::Send { .. } => return self.see_sent(state),
            AidAction::Drop => Sighting::Lying(1),
            _ => Sighting::Nothing,
        };
        let percept = Percept { sighting, ..state.percept };
        self.place = Some(Standpoint::Junction(JunctionState { percept, ..state }));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use toposlam_logs::record::NoSensor;
    use toposlam_model::driving::{
        odometry::Odometry,
        scene::{CentreLine, JunctionView, Place},
    };

    use super::*;
    use crate::robot::TimedOdometry;

    /// A robot at the turning point of an L.
    struct Still {
        /// When each image is taken; `None` if it does not come. The last repeats.
        images: Vec<Option<f64>>,
        asked: usize,
    }

    impl Robot for Still {
        fn capture(&mut self) -> Result<Frame, RobotError> {
            let taken = self.images[self.asked.min(self.images.len() - 1)];
            self.asked += 1;
            let line = |direction| CentreLine { through: [0.0; 2], direction };
            let doors = vec![line(PI), line(FRAC_PI_2)];
            let junction = JunctionView { doors, turning_point: [0.0; 2], confidence: 1.0 };
            let scene = Scene { place: Place::Junction(junction), marker: None };
            let (id, scene) = (self.asked as u64, Some(scene));
            taken
                .map(|taken| Frame { id, taken, scene, ..Frame::default() })
                .ok_or(RobotError::NoImage)
        }

        fn turn(&mut self, _: f64) -> Result<(), RobotError> {
            Ok(())
        }

        fn forward(&mut self, _: f64) -> Result<(), RobotError> {
            Ok(())
        }

        fn handle(&mut self, _: AidAction) -> Result<(), RobotError> {
            Ok(())
        }

        fn odometry(&self) -> TimedOdometry {
            TimedOdometry { time: 2.0, odometry: Odometry::default() }
        }
    }

    fn percept(images: &[Option<f64>]) -> (Result<Percept, ExplorerError>, usize) {
        let robot = Still { images: images.to_vec(), asked: 0 };
        let mut explorer = RobotExplorer::new(robot, NoSensor, ());
        let percept = explorer.percept();
        (percept, explorer.into_parts().0.asked)
    }

    // paper: hardware.capture, alg2.4, alg2.5
    #[test]
    fn an_image_from_before_the_end_of_the_last_motion_is_not_used() {
        let (percept, asked) = percept(&[Some(1.9), Some(1.9), Some(2.0), Some(2.5)]);
        // Two images decide the start, and there the marker lies along the entry.
        assert_eq!(percept.unwrap().to_string(), "2 doors, marker along door 0");
        assert_eq!(asked, 4);
    }

    #[test]
    fn a_robot_knows_whether_its_marker_lies_below_it() {
        let robot = Still { images: vec![Some(3.0)], asked: 0 };
        let mut explorer = RobotExplorer::new(robot, NoSensor, ());
        let mut perceived = vec![explorer.percept().unwrap().to_string()];
        for action in [AidAction::PickUp, AidAction::Drop] {
            explorer.handle(action).unwrap();
            perceived.push(explorer.percept().unwrap().to_string());
        }
        assert_eq!(perceived, ["2 doors, marker along door 0", "2 doors", "2 doors, marker"]);
    }

    /// It may have turned while it steered past the obstacle.
    #[test]
    fn the_way_back_from_an_obstacle_is_along_the_hallway_whatever_the_heading() {
        let robot = Still { images: vec![Some(3.0)], asked: 0 };
        let mut explorer = RobotExplorer::new(robot, NoSensor, ());
        explorer.stand_at_obstacle();
        assert_eq!(explorer.place, Some(Standpoint::Obstacle { back: PI }));
        explorer.stall = Some(Stall { back: 3.0, junction: None });
        explorer.stand_at_obstacle();
        assert_eq!(explorer.place, Some(Standpoint::Obstacle { back: 3.0 }));
        assert_eq!(explorer.percept().unwrap(), DEAD_END);
    }

    #[test]
    fn a_missing_image_is_retaken_at_most_5_times() {
        assert!(percept(&[None, None, None, None, None, Some(3.0)]).0.is_ok());
        let (percept, asked) = percept(&[None]);
        let error = percept.unwrap_err().to_string();
        let cause = "6 unusable images in a row: the camera gives no image";
        assert_eq!((error, asked), (format!("on move 0, at the start: {cause}"), 6));
    }
}
