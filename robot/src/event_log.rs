//! The events of a run, numbered, as they go to its observer.

use toposlam_logs::record::{Event, EventId, EventKind, MapRecord, RunObserver, nanoseconds};
use toposlam_model::mapping::{MapWalk, MappingEvent};

use crate::robot::{Robot, Sample};

#[derive(Clone, Debug)]
pub(crate) struct EventLog<O> {
    pub(crate) observer: O,
    events: u64,
    /// The number of samples of the robot's track that were reported, and the time of the last.
    samples: usize,
    sampled: f64,
}

impl<O: RunObserver> EventLog<O> {
    pub(crate) fn new(observer: O) -> Self {
        Self { observer, events: 0, samples: 0, sampled: 0.0 }
    }

    /// Reports an event that happens now, after the motions that led to it.
    pub(crate) fn emit(&mut self, robot: &impl Robot, kind: EventKind) {
        let samples = robot.track().get(self.samples..).unwrap_or_default();
        self.samples += samples.len();
        for Sample { speed, turning, reading } in samples {
            // The wheels were commanded when they were last read.
            let motion = EventKind::Motion { forward: *speed, turn: *turning };
            self.emit_at(robot, self.sampled, motion);
            self.emit_at(robot, reading.time, EventKind::Odometry(reading.odometry));
            self.sampled = reading.time;
        }
        self.emit_at(robot, robot.odometry().time, kind);
    }

    fn emit_at(&mut self, robot: &impl Robot, seconds: f64, kind: EventKind) {
        self.events += 1;
        let (id, time) = (EventId(self.events), nanoseconds(seconds));
        self.observer.event(&Event { id, time, truth: robot.truth(), kind });
    }

    /// Reports a step of the algorithm.
    pub(crate) fn mapping(&mut self, robot: &impl Robot, journey: &MapWalk, event: MappingEvent) {
        self.observer.mapping(journey, event);
        if matches!(event, MappingEvent::Moved { .. }) {
            return;
        }
        self.emit(robot, EventKind::Hypothesis { moves: journey.moves(), event });
        if event.grows_map() {
            self.emit(robot, EventKind::Map(MapRecord::from_walk(journey)));
        }
    }
}
