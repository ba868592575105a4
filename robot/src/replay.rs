//! The off-line version on a log: sensing, Algorithm 2 and Algorithm 1 on the recorded pictures, without
//! a robot that moves, held against what the robot made of them. Section 6.

use std::{cell::RefCell, fmt, rc::Rc};

use thiserror::Error;
use toposlam_model::{
    driving::{
        algorithm2::{Command, Standing, Step},
        odometry::Odometry,
        scene::Scene,
    },
    mapping::{Exploration, MappingError, Nearest, map_world},
    percept::{Door, Percept, Sighting},
};
use toposlam_vision::{image_file::ImageFile, sensing::Sensor};

use crate::{
    explorer::{Explorer, ExplorerError, Eye, Observer, Round, Unreadable},
    log::{
        entries::{Content, Entries, LoggedImage as Photograph},
        error::LogError,
        messages,
        reader::Log,
        scene_of,
        topic_map::{Role, TopicMap, TopicMapError},
    },
    robot::{Picture, Reckoned, Robot, RobotError},
};

/// What sensing is done on.
#[derive(Clone, Debug, PartialEq)]
pub enum View {
    /// A recorded picture.
    Photograph(Photograph),
    /// The scene that was recorded, where there are no pictures; with the number of its message.
    Scene(u64, Scene),
}

/// Senses recorded pictures, and takes recorded scenes as they are.
#[derive(Clone, Debug)]
pub struct Looker(pub Option<Sensor>);

impl Eye<View> for Looker {
    fn scene(&mut self, view: &View) -> Result<Scene, Unreadable> {
        match (view, &mut self.0) {
            (View::Scene(_, scene), _) => Ok(scene.clone()),
            (View::Photograph(Photograph::Pixels(image)), Some(sensor)) => Ok(sensor.sense(image)?),
            (View::Photograph(Photograph::File(bytes)), Some(sensor)) => {
                Ok(sensor.sense(&ImageFile::open(bytes)?.image()?)?)
            }
            (View::Photograph(_), None) => Err(Unreadable::NoEyes),
        }
    }
}

/// How much of what was recorded comes out again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Agreement {
    /// So many are as recorded,
    pub agree: u64,
    /// of so many.
    pub of: u64,
}

impl Agreement {
    fn note(&mut self, agrees: bool) {
        self.of += 1;
        self.agree += u64::from(agrees);
    }

    /// Whether all are.
    #[must_use]
    pub fn is_whole(self) -> bool {
        self.agree == self.of
    }
}

impl fmt::Display for Agreement {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        write!(out, "{} of {}", self.agree, self.of)
    }
}

/// What the off-line version makes of a log, and how that compares.
#[derive(Debug)]
pub struct Replay {
    /// The map that it makes, and where it takes the robot to be.
    pub exploration: Exploration,
    /// Why it did not come to its end.
    pub error: Option<MappingError<ExplorerError>>,
    /// How many pictures there were until then.
    pub pictures: u64,
    /// Scenes as recorded.
    pub scenes: Agreement,
    /// Commands of Algorithm 2 as recorded.
    pub commands: Agreement,
    /// Percepts as recorded.
    pub percepts: Agreement,
    /// Doors as recorded.
    pub doors: Agreement,
    /// Whether the map is the last one recorded; `None` where none was.
    pub map: Option<bool>,
    /// Where something else than what was recorded came out first.
    pub difference: Option<Difference>,
    /// What was recorded took so long, in seconds.
    pub recorded_seconds: f64,
}

/// Something else than what was recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// At which picture, counted from 1.
    pub picture: u64,
    /// When it was taken, in seconds since the first message of the log.
    pub time: f64,
    /// What is different.
    pub what: &'static str,
    /// As it was recorded.
    pub recorded: String,
    /// As it comes out.
    pub found: String,
}

/// Why a log cannot be replayed.
#[derive(Debug, Error)]
pub enum NotReplayed {
    /// It cannot be read.
    #[error(transparent)]
    Log(#[from] LogError),
    /// The mapping does not fit it.
    #[error(transparent)]
    TopicMap(#[from] TopicMapError),
    /// There is nothing to replay.
    #[error(
        "it has neither pictures nor scenes together with odometry and the commands of Algorithm 2, as \
         far as the mapping tells; a run of another robot is judged by `toposlam conform`"
    )]
    Nothing,
    /// A scene that is none.
    #[error("message {message}: there is no such scene")]
    Scene {
        /// Which message, counted from 1.
        message: u64,
    },
}

/// Runs the off-line version on a log.
///
/// # Errors
/// Where the log cannot be read, or has nothing to replay.
// paper: exp.off-line
pub fn replay(
    log: &Log,
    mapping: &TopicMap,
    sensor: Option<Sensor>,
    dart_bound: usize,
) -> Result<Replay, NotReplayed> {
    let has = |role| mapping.carrier(role).is_some();
    let seen = if has(Role::Image) { Role::Image } else { Role::Scene };
    if !has(seen) || !has(Role::Odometry) || !has(Role::Command) {
        return Err(NotReplayed::Nothing);
    }
    let roles =
        [seen, Role::Scene, Role::Odometry, Role::Command, Role::Percept, Role::Door, Role::Map];
    let bound = mapping.only(&roles).bind(log)?;
    let told = Rc::new(RefCell::new(Told::default()));
    let mut robot = Replayed {
        entries: log.entries(&bound),
        seen,
        begun: log.start().unwrap_or(0),
        next: None,
        odometry: Odometry::default(),
        told: told.clone(),
        failure: None,
    };
    robot.advance();
    let mut explorer = Explorer::new(robot, Looker(sensor), Comparison::new(told));
    let mut exploration = Exploration::new(dart_bound);
    let error = map_world(&mut explorer, &mut Nearest, &mut exploration, &mut ()).err();
    let (mut robot, comparison) = explorer.into_parts();
    // What comes after the last picture that was asked for is told, too.
    while robot.failure.is_none() && robot.next.is_some() {
        robot.advance();
    }
    if let Some(failure) = robot.failure {
        return Err(failure);
    }
    let told = comparison.told.borrow();
    let map = told.map.as_ref().map(|recorded| *recorded == in_numbers(&exploration));
    let length = log.end().unwrap_or(0).saturating_sub(log.start().unwrap_or(0));
    let Comparison { pictures, scenes, commands, percepts, doors, difference, .. } = &comparison;
    let made = |agreement: &Agreement, recorded: usize| Agreement {
        // What was recorded and does not come out does not agree.
        of: agreement.of.max(recorded as u64),
        ..*agreement
    };
    Ok(Replay {
        error,
        pictures: *pictures,
        scenes: *scenes,
        commands: *commands,
        percepts: made(percepts, told.percepts.len()),
        doors: made(doors, told.doors.len()),
        map,
        difference: difference.clone(),
        recorded_seconds: length as f64 / 1e9,
        exploration,
    })
}

/// A map as a log tells it.
fn in_numbers(exploration: &Exploration) -> (Vec<u32>, Vec<i32>) {
    crate::conform::in_numbers(exploration.map())
}

/// What a log tells of what its robot made of its pictures.
#[derive(Debug, Default)]
struct Told {
    /// Of the present picture.
    scene: Option<Scene>,
    command: Option<Command>,
    /// All so far.
    percepts: Vec<Percept>,
    doors: Vec<Door>,
    map: Option<(Vec<u32>, Vec<i32>)>,
}

/// A robot that shows the recorded pictures in turn, whatever it is told to do.
struct Replayed<'l> {
    entries: Entries<'l>,
    /// What stands for a picture.
    seen: Role,
    begun: u64,
    /// The picture that comes next, and where the robot was.
    next: Option<(Picture<View>, Odometry)>,
    odometry: Odometry,
    told: Rc<RefCell<Told>>,
    failure: Option<NotReplayed>,
}

impl Replayed<'_> {
    /// Reads on to the next picture; what stands before it is told of the one before.
    fn advance(&mut self) {
        self.next = None;
        let mut told = self.told.borrow_mut();
        (told.scene, told.command) = (None, None);
        for entry in self.entries.by_ref() {
            let entry = match entry {
                Ok(entry) => entry,
                Err(error) => {
                    self.failure = Some(error.into());
                    return;
                }
            };
            let taken = entry.stamp.nanoseconds().saturating_sub(self.begun) as f64 / 1e9;
            match entry.content {
                Content::Image(picture) if self.seen == Role::Image => {
                    let picture = Picture { taken, view: View::Photograph(picture) };
                    self.next = Some((picture, self.odometry));
                    return;
                }
                Content::Scene(scene) => {
                    let message = entry.number;
                    let Some(scene) = scene_of(&scene) else {
                        self.failure = Some(NotReplayed::Scene { message });
                        return;
                    };
                    if self.seen == Role::Scene {
                        let picture = Picture { taken, view: View::Scene(message, scene) };
                        self.next = Some((picture, self.odometry));
                        return;
                    }
                    told.scene = Some(scene);
                }
                Content::Odometry(odometry) => self.odometry = odometry,
                Content::Command(messages::Command { turn, forward, .. }) => {
                    told.command = Some(Command { turn, forward });
                }
                Content::Percept(percept) => {
                    let sighting = u32::try_from(percept.marker)
                        .map_or(Sighting::Nothing, |door| Sighting::Pointing(Door(door)));
                    told.percepts.push(Percept { degree: percept.degree, sighting });
                }
                Content::Door(door) => told.doors.push(Door(door.door)),
                Content::Map(map) => told.map = Some((map.degrees, map.opposite)),
                _ => {}
            }
        }
    }
}

impl Robot for Replayed<'_> {
    type View = View;

    fn capture(&mut self) -> Result<Picture<View>, RobotError> {
        let next = self.next.take().filter(|_| self.failure.is_none());
        let (picture, _) = next.ok_or(RobotError::EndOfLog)?;
        self.advance();
        Ok(picture)
    }

    fn turn(&mut self, _: f64) -> Result<(), RobotError> {
        Ok(())
    }

    fn forward(&mut self, _: f64) -> Result<(), RobotError> {
        Ok(())
    }

    fn odometry(&self) -> Reckoned {
        let next = self.next.as_ref();
        next.map_or(Reckoned::default(), |(picture, odometry)| Reckoned {
            time: picture.taken,
            odometry: *odometry,
        })
    }
}

/// Compares what comes out with what was recorded.
struct Comparison {
    told: Rc<RefCell<Told>>,
    pictures: u64,
    time: f64,
    scenes: Agreement,
    commands: Agreement,
    percepts: Agreement,
    doors: Agreement,
    difference: Option<Difference>,
}

/// A command differs by no more: odometry goes through a quaternion on its way into a log.
const SAME: f64 = 1e-6;

impl Comparison {
    fn new(told: Rc<RefCell<Told>>) -> Self {
        let none = Agreement::default();
        Self {
            told,
            pictures: 0,
            time: 0.0,
            scenes: none,
            commands: none,
            percepts: none,
            doors: none,
            difference: None,
        }
    }

    fn differs(&mut self, what: &'static str, recorded: &impl fmt::Debug, found: &impl fmt::Debug) {
        let (picture, time) = (self.pictures, self.time);
        self.difference.get_or_insert_with(|| Difference {
            picture,
            time,
            what,
            recorded: format!("{recorded:?}"),
            found: format!("{found:?}"),
        });
    }
}

impl Observer<Replayed<'_>> for Comparison {
    fn round(&mut self, _: &Replayed, round: &Round<View>) {
        self.pictures += 1;
        self.time = round.picture.taken;
        let told = self.told.clone();
        let told = told.borrow();
        if let Some(recorded) = &told.scene {
            let same = recorded == round.scene;
            self.scenes.note(same);
            if !same {
                self.differs("scene", recorded, round.scene);
            }
        }
        if let (Some(recorded), Ok(Step::Go(found))) = (&told.command, round.step) {
            let same = (recorded.turn - found.turn).abs() <= SAME
                && (recorded.forward - found.forward).abs() <= SAME;
            self.commands.note(same);
            if !same {
                self.differs("command", recorded, found);
            }
        }
    }

    fn leaving(&mut self, _: &Replayed, found: Door) {
        let told = self.told.clone();
        // The log may tell it after the next picture only: then it is not known yet.
        let place = self.doors.of as usize;
        let recorded = told.borrow().doors.get(place).copied();
        let same = recorded == Some(found);
        self.doors.note(same);
        if !same {
            self.differs("door", &recorded, &found);
        }
    }

    fn arrived(&mut self, _: &Replayed, _: Option<Door>, at: &Standing) {
        let told = self.told.clone();
        let place = self.percepts.of as usize;
        let recorded = told.borrow().percepts.get(place).copied();
        let same = recorded == Some(at.percept);
        self.percepts.note(same);
        if !same {
            self.differs("percept", &recorded, &at.percept);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        evaluation::{plans, run_sampler::starts_of},
        explorer::Told as Teller,
        log::{recorder::Recorder, shared_buffer::SharedBuffer},
        run::run,
        simulator::SimulationConfig,
    };

    fn recorded(seed: u64) -> (Log, Exploration) {
        let (_, plan) = plans().unwrap().swap_remove(2);
        let facing = starts_of(&plan)[0];
        let mut setting = SimulationConfig::at_start(plan.clone(), facing, seed);
        setting.keeps_track = true;
        let file = SharedBuffer::default();
        let recorder = Recorder::new(file.clone(), &messages::Run::default(), None).unwrap();
        let robot = setting.by_scene();
        let mut story = recorder.clone();
        let (run, robot, _) = run(&plan, facing, robot, Teller, recorder.clone(), &mut story, 200);
        recorder.end(&robot, run.exploration.moves(), run.error.as_ref()).unwrap();
        let bytes = file.0.borrow().clone();
        (Log::of_bytes(bytes).unwrap(), run.exploration)
    }

    // paper: exp.off-line
    #[test]
    fn a_log_gives_the_same_map_again_and_all_that_led_to_it() {
        for seed in 0..4 {
            let (log, exploration) = recorded(seed);
            let mapping = TopicMap::unambiguous(&log);
            let replay = replay(&log, &mapping, None, 200).unwrap();
            assert_eq!((replay.error, replay.difference), (None, None));
            assert_eq!(replay.exploration.map(), exploration.map());
            assert_eq!(replay.map, Some(true));
            let moves = exploration.moves();
            assert_eq!(replay.doors, Agreement { agree: moves, of: moves });
            assert_eq!(replay.percepts, Agreement { agree: moves + 1, of: moves + 1 });
            assert!(replay.commands.is_whole() && replay.commands.of > 20, "{:?}", replay.commands);
        }
    }

    #[test]
    fn a_bound_that_is_too_low_is_told_and_what_was_not_made_does_not_agree() {
        let (log, _) = recorded(0);
        let mapping = TopicMap::unambiguous(&log);
        let replay = replay(&log, &mapping, None, 4).unwrap();
        assert!(matches!(replay.error, Some(MappingError::Bound { .. })));
        assert!(!replay.doors.is_whole() && replay.map == Some(false));
    }

    #[test]
    fn a_log_without_commands_is_not_replayed() {
        let (log, _) = recorded(0);
        let mapping = TopicMap::unambiguous(&log).only(&[Role::Scene, Role::Odometry]);
        assert!(matches!(replay(&log, &mapping, None, 200), Err(NotReplayed::Nothing)));
    }
}
