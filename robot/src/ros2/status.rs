//! What a robot does, for the tools of ROS 2: `diagnostic_msgs/msg/DiagnosticArray` on `/toposlam/state`.

use std::{
    collections::BTreeMap,
    sync::{Mutex, PoisonError},
};

use serde::Serialize;
use toposlam_logs::{
    record::{RunEnd, RunEnding},
    standard::Header,
};

use super::{
    messages::write,
    node::{Writer, node_name},
    wheels::StampClock,
};
use crate::{live::messages::time, robot::RobotError};

pub(super) const STATE: &str = "/toposlam/state";
pub(super) const STATE_TYPE: &str = "diagnostic_msgs/msg/DiagnosticArray";

/// Below this part of its charge, a battery is low; in hundredths.
const LOW_BATTERY: u8 = 15;

/// How good a state is, as in `diagnostic_msgs/msg/DiagnosticStatus`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Ok,
    Warn,
    Error,
}

/// What a robot does at the moment.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RunState {
    pub(super) activity: String,
    /// Whether the run ended without a map.
    has_failed: bool,
    pub(super) is_paused: bool,
    pub(super) moves: u64,
    pub(super) vertices: usize,
    pub(super) edges: usize,
    /// The number of darts that are not explored.
    pub(super) unexplored: usize,
    /// The part of its charge that a battery has, in hundredths.
    pub(super) battery: Option<u8>,
    /// The topics of bumpers, cliff sensors and batteries that are published and cannot be read, and why.
    unread: BTreeMap<&'static str, String>,
}

impl RunState {
    fn new() -> Self {
        Self {
            activity: "looking for the first junction".to_owned(),
            has_failed: false,
            is_paused: false,
            moves: 0,
            vertices: 0,
            edges: 0,
            unexplored: 0,
            battery: None,
            unread: BTreeMap::new(),
        }
    }

    pub(super) fn end(&mut self, end: &RunEnd) {
        self.moves = end.moves;
        self.is_paused = false;
        (self.activity, self.has_failed) = match &end.ending {
            RunEnding::Mapped => ("mapped".to_owned(), false),
            RunEnding::Stopped => ("stopped".to_owned(), false),
            RunEnding::GaveUp(cause) => (format!("gave up: {cause}"), true),
            RunEnding::OutOfBudget(cause) => (format!("out of budget: {cause}"), true),
        };
    }

    pub(super) fn hazard(&mut self, hazard: &RobotError) {
        self.is_paused = false;
        (self.activity, self.has_failed) = (format!("stopped: {hazard}"), true);
    }

    /// Shows why a topic of a sensor is not read; it is if there is no cause.
    pub(super) fn show_unread(&mut self, topic: &'static str, cause: Option<String>) {
        match cause {
            Some(cause) => self.unread.insert(topic, cause),
            None => self.unread.remove(topic),
        };
    }

    fn is_battery_low(&self) -> bool {
        self.battery.is_some_and(|charge| charge < LOW_BATTERY)
    }

    fn level(&self) -> Level {
        if self.has_failed {
            Level::Error
        } else if self.is_paused || self.is_battery_low() || !self.unread.is_empty() {
            Level::Warn
        } else {
            Level::Ok
        }
    }

    fn message(&self) -> String {
        let paused = if self.is_paused { "paused; " } else { "" };
        let low = if self.is_battery_low() { "; the battery is low" } else { "" };
        let unread =
            self.unread.iter().map(|(topic, cause)| format!("; {topic} is not read: {cause}"));
        format!("{paused}{}{low}{}", self.activity, unread.collect::<String>())
    }

    /// The numbers, by their names.
    fn values(&self) -> Vec<NamedValue> {
        let number = |key, value: usize| NamedValue { key, value: value.to_string() };
        let mut values = vec![
            NamedValue { key: "moves", value: self.moves.to_string() },
            number("vertices", self.vertices),
            number("edges", self.edges),
            number("unexplored", self.unexplored),
        ];
        if let Some(charge) = self.battery {
            values.push(NamedValue { key: "battery", value: format!("{charge} %") });
        }
        values
    }

    fn body(&self, header: Header, name: &str) -> Vec<u8> {
        let status = [DiagnosticStatus {
            level: self.level() as u8,
            name,
            message: self.message(),
            hardware_id: "",
            values: self.values(),
        }];
        write(&(header, &status[..]))
    }
}

#[derive(Serialize)]
struct DiagnosticStatus<'n> {
    level: u8,
    name: &'n str,
    message: String,
    hardware_id: &'static str,
    values: Vec<NamedValue>,
}

#[derive(Serialize)]
struct NamedValue {
    key: &'static str,
    value: String,
}

/// The state of a run, which is published when it changes.
pub(super) struct PublishedState {
    writer: Writer,
    clock: StampClock,
    name: String,
    state: Mutex<RunState>,
}

impl PublishedState {
    pub(super) fn new(writer: Writer, clock: StampClock) -> Self {
        Self { writer, clock, name: node_name() + ": run", state: Mutex::new(RunState::new()) }
    }

    pub(super) fn change(&self, change: impl FnOnce(&mut RunState)) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let before = state.clone();
        change(&mut state);
        if *state != before {
            self.send(&state);
        }
    }

    /// Publishes the state again.
    pub(super) fn publish(&self) {
        self.send(&self.state.lock().unwrap_or_else(PoisonError::into_inner));
    }

    fn send(&self, state: &RunState) {
        let header = Header { stamp: time(self.clock.now()), frame_id: "" };
        // A robot maps without spectators, too.
        let _ = self.writer.publish(state.body(header, &self.name));
    }
}

#[cfg(test)]
mod tests {
    use toposlam_logs::messages::Stamp;

    use super::*;

    #[test]
    fn a_low_battery_is_a_warning_and_a_failed_run_an_error() {
        let mut state = RunState::new();
        assert_eq!(state.level(), Level::Ok);
        state.battery = Some(10);
        assert_eq!(state.level(), Level::Warn);
        assert_eq!(state.message(), "looking for the first junction; the battery is low");
        state.end(&RunEnd { moves: 3, ending: RunEnding::GaveUp("lost".to_owned()) });
        assert_eq!((state.level(), state.moves), (Level::Error, 3));
        state.end(&RunEnd { moves: 3, ending: RunEnding::Mapped });
        state.battery = Some(50);
        assert_eq!(state.level(), Level::Ok);
    }

    #[test]
    fn a_sensor_that_cannot_be_read_is_a_warning_until_it_can() {
        let mut state = RunState::new();
        state.show_unread("/events/cliff", Some("its type is std_msgs/msg/String".to_owned()));
        assert_eq!(state.level(), Level::Warn);
        let message = "looking for the first junction; /events/cliff is not read: its type is std_msgs/msg/String";
        assert_eq!(state.message(), message);
        state.show_unread("/events/cliff", None);
        assert_eq!((state.level(), state), (Level::Ok, RunState::new()));
    }

    #[test]
    fn the_state_is_an_array_of_one() {
        let mut state = RunState::new();
        state.activity = "mapped".to_owned();
        let body = state.body(Header { stamp: Stamp { sec: 1, nanosec: 2 }, frame_id: "" }, "n");
        let beginning = b"\x01\0\0\0\x02\0\0\0\x01\0\0\0\0\0\0\0\x01\0\0\0\0\0\0\0\x02\0\0\0n\0\0\0\x07\0\0\0mapped\0";
        assert_eq!(body[..beginning.len()], *beginning);
    }
}
