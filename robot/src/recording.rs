//! A run that is recorded, and a robot that answers with what was recorded: the off-line version.
//! Section 6.

use toposlam_model::driving::{
    algorithm2::{Command, Step},
    odometry::Odometry,
};

use crate::{
    explorer::{Observer, Round},
    robot::{Picture, Reckoned, Robot, RobotError},
};

/// All that a robot saw and did, picture by picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording<V> {
    rounds: Vec<Recorded<V>>,
}

/// A picture that was used, and what the robot was told to do then.
#[derive(Clone, Debug, PartialEq)]
struct Recorded<V> {
    picture: Picture<V>,
    odometry: Odometry,
    command: Command,
}

impl<V> Default for Recording<V> {
    fn default() -> Self {
        Self { rounds: Vec::new() }
    }
}

impl<V> Recording<V> {
    /// The number of pictures.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rounds.len()
    }

    /// Whether nothing was recorded.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rounds.is_empty()
    }

    /// A robot that answers with what was recorded.
    #[must_use]
    pub fn robot(&self) -> RecordedRobot<'_, V> {
        RecordedRobot { rounds: &self.rounds, next: 0, turned: true, moved: true }
    }
}

/// Whoever records watches.
impl<R: Robot> Observer<R> for Recording<R::View>
where
    R::View: Clone,
{
    fn round(&mut self, _: &R, round: &Round<R::View>) {
        let command = match round.step {
            Ok(Step::Go(command)) => *command,
            Ok(Step::Arrived(_)) | Err(_) => Command::default(),
        };
        let picture = round.picture.clone();
        self.rounds.push(Recorded { picture, odometry: round.odometry, command });
    }
}

/// A robot that does not move: it answers with what was recorded, as long as it is asked for what was
/// asked for then.
#[derive(Clone, Debug)]
pub struct RecordedRobot<'a, V> {
    rounds: &'a [Recorded<V>],
    /// The picture that comes next.
    next: usize,
    /// Whether what was asked for after the last one has been asked for.
    turned: bool,
    moved: bool,
}

impl<V> RecordedRobot<'_, V> {
    /// How many pictures were taken.
    #[must_use]
    pub fn pictures(&self) -> usize {
        self.next
    }

    fn last(&self) -> Command {
        self.next.checked_sub(1).map_or(Command::default(), |last| self.rounds[last].command)
    }

    fn otherwise(&self, asked: String) -> RobotError {
        let recorded = match self.rounds.get(self.next) {
            None => "the end".to_owned(),
            Some(_) if !self.turned => format!("a turn by {:.4} rad", self.last().turn),
            Some(_) if !self.moved => format!("{:.4} m ahead", self.last().forward),
            Some(_) => "a picture".to_owned(),
        };
        RobotError::NotRecorded { entry: self.next + 1, recorded, asked }
    }
}

impl<V: Clone + PartialEq> Robot for RecordedRobot<'_, V> {
    type View = V;

    fn capture(&mut self) -> Result<Picture<V>, RobotError> {
        let round = self.rounds.get(self.next).filter(|_| self.turned && self.moved);
        let Some(round) = round else { return Err(self.otherwise("a picture".to_owned())) };
        self.next += 1;
        self.turned = round.command.turn == 0.0;
        self.moved = round.command.forward == 0.0;
        Ok(round.picture.clone())
    }

    fn turn(&mut self, angle: f64) -> Result<(), RobotError> {
        if self.turned || self.last().turn.total_cmp(&angle).is_ne() {
            return Err(self.otherwise(format!("a turn by {angle:.4} rad")));
        }
        self.turned = true;
        Ok(())
    }

    fn forward(&mut self, distance: f64) -> Result<(), RobotError> {
        if !self.turned || self.moved || self.last().forward.total_cmp(&distance).is_ne() {
            return Err(self.otherwise(format!("{distance:.4} m ahead")));
        }
        self.moved = true;
        Ok(())
    }

    /// Where the robot was when the next picture was taken; at the end, where it was at the last.
    fn odometry(&self) -> Reckoned {
        let round = self.rounds.get(self.next).or(self.rounds.last());
        round.map_or(Reckoned::default(), |round| Reckoned {
            time: round.picture.taken,
            odometry: round.odometry,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn recording() -> Recording<u8> {
        let round = |taken, view, turn, forward| Recorded {
            picture: Picture { taken, view },
            odometry: Odometry { position: [taken, 0.0], heading: 0.0 },
            command: Command { turn, forward },
        };
        Recording { rounds: vec![round(0.0, 1, 0.5, 0.25), round(3.0, 2, 0.0, 0.0)] }
    }

    #[test]
    fn it_answers_with_what_was_recorded_and_moves_as_it_did() {
        let recording = recording();
        let mut robot = recording.robot();
        assert_eq!(robot.capture().unwrap().view, 1);
        robot.turn(0.5).unwrap();
        robot.forward(0.25).unwrap();
        let reckoned = robot.odometry();
        assert_eq!((reckoned.time, reckoned.odometry.position[0]), (3.0, 3.0));
        assert_eq!(robot.capture().unwrap().view, 2);
        assert_eq!(robot.pictures(), 2);
    }

    #[test]
    fn whoever_asks_for_something_else_is_told_what_is_recorded() {
        let told = |ask: fn(&mut RecordedRobot<u8>) -> Result<(), RobotError>| {
            let recording = recording();
            let mut robot = recording.robot();
            robot.capture().unwrap();
            ask(&mut robot).unwrap_err().to_string()
        };
        let is = "entry 2 of the recording is a turn by 0.5000 rad; what is asked for is ";
        assert_eq!(told(|robot| robot.turn(0.4)), format!("{is}a turn by 0.4000 rad"));
        assert_eq!(told(|robot| robot.forward(0.25)), format!("{is}0.2500 m ahead"));
        assert_eq!(told(|robot| robot.capture().map(|_| ())), format!("{is}a picture"));
        let recording = recording();
        let mut robot = recording.robot();
        robot.capture().unwrap();
        robot.turn(0.5).unwrap();
        robot.forward(0.25).unwrap();
        robot.capture().unwrap();
        let past = robot.capture().unwrap_err().to_string();
        assert_eq!(past, "entry 3 of the recording is the end; what is asked for is a picture");
    }
}
