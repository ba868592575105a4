//! A robot as a world: Algorithm 1 asks for doors, and Algorithm 2 takes the robot through them.
//! Sections 4.3 and 5.

use thiserror::Error;
use toposlam_model::{
    driving::{
        algorithm2::{Lost, PathExecution, PathState, Standing, Step},
        odometry::Odometry,
        scene::Scene,
    },
    percept::{Door, Percept},
    world::World,
};
use toposlam_vision::{
    image_file::{ImageFile, ImageFileError},
    sensing::{Sensor, WrongSize},
};

use crate::{
    robot::{Picture, Robot, RobotError},
    simulator::ToldScene,
};

/// What makes a scene of what a camera gives.
pub trait Eye<V> {
    /// The scene.
    ///
    /// # Errors
    /// Where the picture cannot be read.
    fn scene(&mut self, view: &V) -> Result<Scene, Unreadable>;
}

/// A picture that cannot be read.
#[derive(Debug, Error)]
pub enum Unreadable {
    /// It is no image.
    #[error(transparent)]
    Image(#[from] ImageFileError),
    /// It is of another camera.
    #[error(transparent)]
    Size(#[from] WrongSize),
    /// There is nothing to look at it with.
    #[error("neither the camera nor the colours of the building are known")]
    NoEyes,
}

/// The file of a photograph is decoded and sensed.
impl Eye<Vec<u8>> for Sensor {
    fn scene(&mut self, view: &Vec<u8>) -> Result<Scene, Unreadable> {
        let image = ImageFile::open(view)?.image()?;
        Ok(self.sense(&image)?)
    }
}

/// A camera that tells scenes itself needs no eye.
#[derive(Clone, Copy, Debug, Default)]
pub struct Told;

impl Eye<ToldScene> for Told {
    fn scene(&mut self, view: &ToldScene) -> Result<Scene, Unreadable> {
        Ok(view.scene.clone())
    }
}

/// A round of Algorithm 2, as it came about.
#[derive(Debug)]
pub struct Round<'a, V> {
    /// How many doors were taken before.
    pub moves: u64,
    /// The door that the robot is to take or has taken; `None` at the start.
    pub door: Option<Door>,
    /// The picture.
    pub picture: &'a Picture<V>,
    /// Where the robot was by odometry when it was taken.
    pub odometry: Odometry,
    /// What sensing told of it.
    pub scene: &'a Scene,
    /// What the robot is about after it.
    pub state: PathState,
    /// What came of it.
    pub step: &'a Result<Step, Lost>,
}

/// Whoever watches a robot explore.
pub trait Observer<R: Robot> {
    /// A round of Algorithm 2.
    fn round(&mut self, _robot: &R, _round: &Round<R::View>) {}

    /// The robot sets out for a door of the junction at which it stands.
    fn leaving(&mut self, _robot: &R, _door: Door) {}

    /// The robot has come to a junction, by a door of the last one unless it is the first.
    fn arrived(&mut self, _robot: &R, _door: Option<Door>, _at: &Standing) {}

    /// Whether the run is to end.
    fn stop(&self) -> bool {
        false
    }
}

impl<R: Robot> Observer<R> for () {}

/// Somebody watches, or nobody.
impl<R: Robot, O: Observer<R>> Observer<R> for Option<O> {
    fn round(&mut self, robot: &R, round: &Round<R::View>) {
        if let Some(observer) = self {
            observer.round(robot, round);
        }
    }

    fn leaving(&mut self, robot: &R, door: Door) {
        if let Some(observer) = self {
            observer.leaving(robot, door);
        }
    }

    fn arrived(&mut self, robot: &R, door: Option<Door>, at: &Standing) {
        if let Some(observer) = self {
            observer.arrived(robot, door, at);
        }
    }

    fn stop(&self) -> bool {
        self.as_ref().is_some_and(Observer::stop)
    }
}

/// Why a robot cannot go on.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ExplorerError {
    /// It no longer knows where it is.
    #[error("on move {moves}, {}: {lost}", by_door(*.door))]
    Lost {
        /// Which move it is, counted from 1; 0 at the start.
        moves: u64,
        /// By which door.
        door: Option<Door>,
        /// What happened.
        lost: Lost,
    },
    /// There is no picture that it could use.
    #[error("on move {moves}, {}: {pictures} pictures in a row cannot be used: {cause}", by_door(*.door))]
    NoPicture {
        /// Which move it is.
        moves: u64,
        /// By which door.
        door: Option<Door>,
        /// How many.
        pictures: u32,
        /// What is wrong with the last.
        cause: String,
    },
    /// The start is none.
    #[error("the robot stands at a junction with {degree} doors; the marker is put down at an L")]
    NotAnL {
        /// How many doors the junction has.
        degree: u32,
    },
    /// The robot does not obey.
    #[error(transparent)]
    Robot(#[from] RobotError),
    /// Somebody ended the run.
    #[error("the run was ended on move {moves}")]
    Stopped {
        /// Which move it was.
        moves: u64,
    },
}

fn by_door(door: Option<Door>) -> String {
    door.map_or_else(|| "at the start".to_owned(), |door| format!("by door {}", door.0))
}

/// A robot that explores.
///
/// At its start it stands at the turning point of an L, its back to the facing hallway, and has put
/// its marker down along it.
// paper: hardware.capture
#[derive(Clone, Debug)]
pub struct Explorer<R: Robot, E, O = ()> {
    robot: R,
    eye: E,
    observer: O,
    standing: Option<Standing>,
    moves: u64,
    door: Option<Door>,
    /// What was last seen, and where by odometry.
    last: Option<(R::View, Odometry)>,
}

/// Why a picture cannot be used.
#[derive(Debug, Error)]
enum Unusable {
    #[error("the camera gives no picture")]
    Missing,
    #[error("it is older than the end of the last motion")]
    Stale,
    #[error("it is the same as before the robot moved")]
    Same,
    #[error(transparent)]
    Unreadable(#[from] Unreadable),
    #[error(transparent)]
    Robot(RobotError),
}

/// So many pictures in a row that cannot be used are too many.
const RETAKES: u32 = 6;

impl<R: Robot, E: Eye<R::View>, O: Observer<R>> Explorer<R, E, O> {
    /// A robot with an eye, and somebody who watches.
    pub fn new(robot: R, eye: E, observer: O) -> Self {
        Self { robot, eye, observer, standing: None, moves: 0, door: None, last: None }
    }

    /// The same robot, where it is known to stand.
    #[must_use]
    pub fn standing_at(mut self, standing: Standing) -> Self {
        self.standing = Some(standing);
        self
    }

    /// The robot.
    pub fn robot(&self) -> &R {
        &self.robot
    }

    /// The robot and whoever watched.
    pub fn into_parts(self) -> (R, O) {
        (self.robot, self.observer)
    }

    /// Drives a path to its end.
    fn drive(&mut self, mut path: PathExecution) -> Result<Standing, ExplorerError> {
        loop {
            let (moves, door) = (self.moves, self.door);
            if self.observer.stop() {
                return Err(ExplorerError::Stopped { moves });
            }
            let odometry = self.robot.odometry().odometry;
            let (picture, scene) = self.look()?;
            let step = path.round(&scene, odometry);
            let round = Round {
                moves,
                door,
                picture: &picture,
                odometry,
                scene: &scene,
                state: path.state(),
                step: &step,
            };
            self.observer.round(&self.robot, &round);
            self.last = Some((picture.view, odometry));
            let command = match step.map_err(|lost| ExplorerError::Lost { moves, door, lost })? {
                Step::Arrived(standing) => return Ok(standing),
                Step::Go(command) => command,
            };
            if command.turn != 0.0 {
                self.robot.turn(command.turn).map_err(|error| self.disobeyed(error))?;
            }
            if command.forward != 0.0 {
                self.robot.forward(command.forward).map_err(|error| self.disobeyed(error))?;
            }
        }
    }

    /// Why the run ends where the robot does not obey.
    fn disobeyed(&self, error: RobotError) -> ExplorerError {
        match error {
            RobotError::Stopped => ExplorerError::Stopped { moves: self.moves },
            error => error.into(),
        }
    }

    /// A picture that can be used.
    // paper: alg2.4, alg2.5
    fn look(&mut self) -> Result<(Picture<R::View>, Scene), ExplorerError> {
        let mut last = Unusable::Missing;
        for _ in 0..RETAKES {
            match self.picture() {
                Ok(seen) => return Ok(seen),
                Err(Unusable::Robot(error)) => return Err(self.disobeyed(error)),
                Err(unusable) => last = unusable,
            }
        }
        let (moves, door, cause) = (self.moves, self.door, last.to_string());
        Err(ExplorerError::NoPicture { moves, door, pictures: RETAKES, cause })
    }

    /// A picture that was taken since the robot last moved, and its scene.
    fn picture(&mut self) -> Result<(Picture<R::View>, Scene), Unusable> {
        let at = self.robot.odometry();
        let picture = self.robot.capture().map_err(|error| match error {
            RobotError::NoPicture => Unusable::Missing,
            RobotError::StalePicture { .. } => Unusable::Stale,
            error => Unusable::Robot(error),
        })?;
        if picture.taken < at.time {
            return Err(Unusable::Stale);
        }
        let same = |(view, odometry): &(R::View, Odometry)| {
            *odometry != at.odometry && *view == picture.view
        };
        if self.last.as_ref().is_some_and(same) {
            return Err(Unusable::Same);
        }
        let scene = self.eye.scene(&picture.view)?;
        Ok((picture, scene))
    }

    /// Where the robot stands; at the very start it finds out.
    fn standing(&mut self) -> Result<Standing, ExplorerError> {
        if let Some(standing) = self.standing {
            return Ok(standing);
        }
        let odometry = self.robot.odometry().odometry;
        let standing = self.drive(PathExecution::at_start(&odometry))?;
        if !standing.form.is_l() {
            return Err(ExplorerError::NotAnL { degree: standing.form.degree() });
        }
        self.observer.arrived(&self.robot, None, &standing);
        Ok(*self.standing.insert(standing))
    }
}

impl<R: Robot, E: Eye<R::View>, O: Observer<R>> World for Explorer<R, E, O> {
    type Error = ExplorerError;

    fn percept(&mut self) -> Result<Percept, ExplorerError> {
        Ok(self.standing()?.percept)
    }

    // paper: validation.traverse, validation.motion, drive.path
    fn traverse(&mut self, door: Door) -> Result<(), ExplorerError> {
        let from = self.standing()?;
        self.observer.leaving(&self.robot, door);
        self.moves += 1;
        self.door = Some(door);
        // Where the robot is, is not known before it has arrived.
        self.standing = None;
        let standing = self.drive(PathExecution::new(&[door], &from))?;
        self.standing = Some(standing);
        self.observer.arrived(&self.robot, Some(door), &standing);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use toposlam_model::driving::scene::{CentreLine, JunctionView, Place};

    use super::*;
    use crate::robot::Reckoned;

    /// A robot at the turning point of an L, whose camera gives what the test says.
    struct Still {
        /// When each picture was taken, or that it does not come; the last again and again.
        pictures: Vec<Option<f64>>,
        asked: usize,
    }

    impl Robot for Still {
        type View = ToldScene;

        fn capture(&mut self) -> Result<Picture<ToldScene>, RobotError> {
            let taken = self.pictures[self.asked.min(self.pictures.len() - 1)];
            self.asked += 1;
            let line = |direction| CentreLine { through: [0.0; 2], direction };
            let doors = vec![line(PI), line(FRAC_PI_2)];
            let junction = JunctionView { doors, turning_point: [0.0; 2], confidence: 1.0 };
            let scene = Scene { place: Place::Junction(junction), marker: None };
            let view = ToldScene { picture: self.asked as u64, scene };
            taken.map(|taken| Picture { taken, view }).ok_or(RobotError::NoPicture)
        }

        fn turn(&mut self, _: f64) -> Result<(), RobotError> {
            Ok(())
        }

        fn forward(&mut self, _: f64) -> Result<(), RobotError> {
            Ok(())
        }

        fn odometry(&self) -> Reckoned {
            Reckoned { time: 2.0, odometry: Odometry::default() }
        }
    }

    fn percept(pictures: &[Option<f64>]) -> (Result<Percept, ExplorerError>, usize) {
        let robot = Still { pictures: pictures.to_vec(), asked: 0 };
        let mut explorer = Explorer::new(robot, Told, ());
        let percept = explorer.percept();
        (percept, explorer.robot().asked)
    }

    // paper: hardware.capture
    // paper: alg2.4
    // paper: alg2.5
    #[test]
    fn a_picture_that_is_older_than_the_last_motion_is_not_used() {
        let (percept, asked) = percept(&[Some(1.9), Some(1.9), Some(2.0), Some(2.5)]);
        // Two pictures decide the start, and there the marker lies along the entry.
        assert_eq!(percept.unwrap().to_string(), "2 doors, marker along door 0");
        assert_eq!(asked, 4);
    }

    #[test]
    fn pictures_that_do_not_come_are_asked_for_again_but_not_for_ever() {
        assert!(percept(&[None, None, None, None, None, Some(3.0)]).0.is_ok());
        let (percept, asked) = percept(&[None]);
        let told = percept.unwrap_err().to_string();
        let cause = "6 pictures in a row cannot be used: the camera gives no picture";
        assert_eq!((told, asked), (format!("on move 0, at the start: {cause}"), 6));
    }
}
