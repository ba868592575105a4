//! A recording in memory, and a robot that plays it back: the off-line version. Section 6.

use toposlam_logs::record::{Event, EventKind, Frame, RunObserver};
use toposlam_model::driving::algorithm2::Command;

use crate::robot::{Robot, RobotError, TimedOdometry};

/// The frames and the commands of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    rounds: Vec<(Frame, Command)>,
}

impl Recording {
    /// The number of frames.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rounds.len()
    }

    /// Whether it has no frames.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rounds.is_empty()
    }

    /// A robot that plays the recording back.
    #[must_use]
    pub fn robot(&self) -> RecordedRobot<'_> {
        RecordedRobot { rounds: &self.rounds, next: 0, turned: true, moved: true }
    }
}

impl RunObserver for Recording {
    fn event(&mut self, event: &Event) {
        match &event.kind {
            EventKind::Frame(frame) => {
                self.rounds.push((frame.without_pixels(), Command::default()));
            }
            EventKind::Command { command: Some(command), .. } => {
                if let Some((_, last)) = self.rounds.last_mut() {
                    *last = *command;
                }
            }
            EventKind::LookAround { turn } => {
                if let Some((_, last)) = self.rounds.last_mut() {
                    *last = Command { turn: *turn, forward: 0.0 };
                }
            }
            _ => {}
        }
    }
}

/// A robot that does not move. It returns the recorded frames, as long as its commands are the recorded
/// ones.
#[derive(Clone, Debug)]
pub struct RecordedRobot<'a> {
    rounds: &'a [(Frame, Command)],
    /// The index of the next frame.
    next: usize,
    /// Whether the commands after the last frame were repeated.
    turned: bool,
    moved: bool,
}

impl RecordedRobot<'_> {
    /// The number of frames that were taken.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.next
    }

    fn last(&self) -> Command {
        self.next.checked_sub(1).map_or(Command::default(), |last| self.rounds[last].1)
    }

    fn not_recorded(&self, asked: String) -> RobotError {
        let recorded = match self.rounds.get(self.next) {
            None => "the end".to_owned(),
            Some(_) if !self.turned => format!("a turn by {:.4} rad", self.last().turn),
            Some(_) if !self.moved => format!("{:.4} m ahead", self.last().forward),
            Some(_) => "an image".to_owned(),
        };
        RobotError::NotRecorded { entry: self.next + 1, recorded, asked }
    }
}

impl Robot for RecordedRobot<'_> {
    fn capture(&mut self) -> Result<Frame, RobotError> {
        let round = self.rounds.get(self.next).filter(|_| self.turned && self.moved);
        let Some((frame, command)) = round else {
            return Err(self.not_recorded("an image".to_owned()));
        };
        self.next += 1;
        self.turned = command.turn == 0.0;
        self.moved = command.forward == 0.0;
        Ok(frame.without_pixels())
    }

    fn turn(&mut self, angle: f64) -> Result<(), RobotError> {
        if self.turned || self.last().turn.total_cmp(&angle).is_ne() {
            return Err(self.not_recorded(format!("a turn by {angle:.4} rad")));
        }
        self.turned = true;
        Ok(())
    }

    fn forward(&mut self, distance: f64) -> Result<(), RobotError> {
        if !self.turned || self.moved || self.last().forward.total_cmp(&distance).is_ne() {
            return Err(self.not_recorded(format!("{distance:.4} m ahead")));
        }
        self.moved = true;
        Ok(())
    }

    /// Where the robot was when the next frame was taken; at the end, where it was at the last.
    fn odometry(&self) -> TimedOdometry {
        let round = self.rounds.get(self.next).or(self.rounds.last());
        round.map_or(TimedOdometry::default(), |(frame, _)| TimedOdometry {
            time: frame.taken,
            odometry: frame.odometry,
        })
    }
}

#[cfg(test)]
mod tests {
    use toposlam_model::driving::odometry::Odometry;

    use super::*;

    fn recording() -> Recording {
        let round = |id, taken, turn, forward| {
            let odometry = Odometry { position: [taken, 0.0], heading: 0.0 };
            (Frame { id, taken, odometry, ..Frame::default() }, Command { turn, forward })
        };
        Recording { rounds: vec![round(1, 0.0, 0.5, 0.25), round(2, 3.0, 0.0, 0.0)] }
    }

    #[test]
    fn a_recorded_robot_returns_the_recorded_frames_and_odometry() {
        let recording = recording();
        let mut robot = recording.robot();
        assert_eq!(robot.capture().unwrap().id, 1);
        robot.turn(0.5).unwrap();
        robot.forward(0.25).unwrap();
        let reckoned = robot.odometry();
        assert_eq!((reckoned.time, reckoned.odometry.position[0]), (3.0, 3.0));
        assert_eq!(robot.capture().unwrap().id, 2);
        assert_eq!(robot.frames(), 2);
    }

    #[test]
    fn an_action_that_is_not_recorded_is_an_error_that_names_the_recorded_one() {
        let error = |ask: fn(&mut RecordedRobot) -> Result<(), RobotError>| {
            let recording = recording();
            let mut robot = recording.robot();
            robot.capture().unwrap();
            ask(&mut robot).unwrap_err().to_string()
        };
        let is = "entry 2 of the recording is a turn by 0.5000 rad, but the robot is asked for ";
        assert_eq!(error(|robot| robot.turn(0.4)), format!("{is}a turn by 0.4000 rad"));
        assert_eq!(error(|robot| robot.forward(0.25)), format!("{is}0.2500 m ahead"));
        assert_eq!(error(|robot| robot.capture().map(|_| ())), format!("{is}an image"));
        let recording = recording();
        let mut robot = recording.robot();
        robot.capture().unwrap();
        robot.turn(0.5).unwrap();
        robot.forward(0.25).unwrap();
        robot.capture().unwrap();
        let past = robot.capture().unwrap_err().to_string();
        assert_eq!(
            past,
            "entry 3 of the recording is the end, but the robot is asked for an image"
        );
    }
}
