//! The frames of a run, and a robot that plays frames back: the off-line version. Section 6.

use std::{collections::VecDeque, iter::Cloned};

use toposlam_logs::record::{Arrival, Event, EventKind, Frame, RunObserver};
use toposlam_model::{
    aid::AidAction,
    driving::algorithm2::Command,
    percept::{OtherRobot, Sighting},
};

use crate::robot::{Robot, RobotError, TimedOdometry};

/// The frames of a run, without decoded images, and the commands after them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    pub frames: Vec<Frame>,
    pub commands: Vec<Command>,
    /// The numbers of doors that the other robot of the team reported, wherever it was not seen.
    pub reports: Vec<u32>,
}

impl Recording {
    pub fn robot(&self) -> RecordedRobot<Cloned<std::slice::Iter<'_, Frame>>> {
        let reports = self.reports.iter().copied().collect();
        RecordedRobot { reports, ..RecordedRobot::new(self.frames.iter().cloned()) }
    }
}

impl RunObserver for Recording {
    fn event(&mut self, event: &Event) {
        match &event.kind {
            EventKind::Frame(frame) => self.frames.push(frame.without_pixels()),
            EventKind::Command { command: Some(command), .. } => self.commands.push(*command),
            EventKind::Arrival(Arrival { sighting: Some(Sighting::Team(team)), .. }) => {
                let reported = team.0.iter().filter_map(|other| match other {
                    OtherRobot::Elsewhere { degree } => Some(*degree),
                    _ => None,
                });
                self.reports.extend(reported);
            }
            _ => {}
        }
    }
}

/// A robot that does not move: it returns recorded frames one after the other, whatever it is commanded.
#[derive(Clone, Debug)]
pub struct RecordedRobot<F> {
    pub(crate) next: Option<Frame>,
    pub(crate) frames: F,
    pub(crate) reports: VecDeque<u32>,
}

impl<F: Iterator<Item = Frame>> RecordedRobot<F> {
    pub(crate) fn new(mut frames: F) -> Self {
        Self { next: frames.next(), frames, reports: VecDeque::new() }
    }
}

impl<F: Iterator<Item = Frame>> Robot for RecordedRobot<F> {
    fn capture(&mut self) -> Result<Frame, RobotError> {
        let frame = self.next.take().ok_or(RobotError::EndOfLog)?;
        self.next = self.frames.next();
        Ok(frame)
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

    fn reported_degree(&mut self) -> Option<u32> {
        self.reports.pop_front()
    }

    /// Where the robot was when the next frame was taken.
    fn odometry(&self) -> TimedOdometry {
        let next = self.next.as_ref();
        next.map_or(TimedOdometry::default(), |frame| TimedOdometry {
            time: frame.taken,
            odometry: frame.odometry,
        })
    }
}
