//! The topic of the commands to the wheels, and what keeps the wheels still: a pause, or a hazard.

use std::{
    sync::{
        Arc, Condvar, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicU64, Ordering},
    },
    time::{Duration, SystemTime, UNIX_EPOCH},
};

use super::{messages::WheelsType, node::Writer};
use crate::{
    live::{Nanoseconds, SECOND, Wheels},
    robot::RobotError,
    superscout::WheelSpeeds,
};

/// The present time for stamps.
#[derive(Clone, Debug)]
pub(super) enum StampClock {
    System,
    /// That of the last message on `/clock`.
    Simulated(Arc<AtomicU64>),
}

impl StampClock {
    pub(super) fn now(&self) -> Nanoseconds {
        match self {
            Self::System => {
                let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
                now.as_secs() * SECOND + u64::from(now.subsec_nanos())
            }
            Self::Simulated(last) => last.load(Ordering::Relaxed),
        }
    }
}

/// Commands to the wheels of a robot. Other threads can make it stand.
pub(super) struct WheelsTopic {
    pub(super) wheels_type: WheelsType,
    pub(super) writer: Writer,
    pub(super) clock: StampClock,
    /// Whether the run is to stop.
    pub(super) stop: fn() -> bool,
    pub(super) standstill: Standstill,
}

/// Why the wheels must not turn, if they must not.
#[derive(Default)]
pub(super) struct Standstill {
    cause: Mutex<StandstillCause>,
    over: Condvar,
}

#[derive(Clone, Debug, Default, PartialEq)]
enum StandstillCause {
    #[default]
    None,
    Pause,
    Hazard(RobotError),
}

/// Interval of stop commands during a pause.
const REPEAT: Duration = Duration::from_millis(50);

impl WheelsTopic {
    fn cause(&self) -> MutexGuard<'_, StandstillCause> {
        // The guarded data is valid at any time, even after a panic.
        self.standstill.cause.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn publish(&self, wheels: WheelSpeeds) -> Result<(), RobotError> {
        self.writer.publish(self.wheels_type.body(self.clock.now(), wheels))
    }

    /// Stops the wheels until [`resume`](Self::resume). Whether they were not paused before.
    pub(super) fn pause(&self) -> bool {
        let mut cause = self.cause();
        let is_new = *cause == StandstillCause::None;
        if is_new {
            *cause = StandstillCause::Pause;
            // The command is repeated when the run goes on.
            let _ = self.publish(WheelSpeeds::STOP);
        }
        is_new
    }

    /// Ends a pause. Whether there was one.
    pub(super) fn resume(&self) -> bool {
        let mut cause = self.cause();
        let was_paused = *cause == StandstillCause::Pause;
        if was_paused {
            *cause = StandstillCause::None;
            self.standstill.over.notify_all();
        }
        was_paused
    }

    /// Stops the wheels for good: the next command to move is this error. Whether it is the first one.
    pub(super) fn end(&self, hazard: RobotError) -> bool {
        let mut cause = self.cause();
        let is_new = !matches!(*cause, StandstillCause::Hazard(_));
        if is_new {
            *cause = StandstillCause::Hazard(hazard);
            self.standstill.over.notify_all();
            // The run ends with the hazard, not with an error of stopping.
            let _ = self.publish(WheelSpeeds::STOP);
        }
        is_new
    }
}

impl Wheels for Arc<WheelsTopic> {
    fn wait(&self) -> Result<(), RobotError> {
        let mut cause = self.cause();
        while matches!(*cause, StandstillCause::Pause) {
            if (self.stop)() {
                return Err(RobotError::Stopped);
            }
            self.publish(WheelSpeeds::STOP)?;
            let waited = self.standstill.over.wait_timeout(cause, REPEAT);
            cause = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
        Ok(())
    }

    fn command(&self, wheels: WheelSpeeds) -> Result<bool, RobotError> {
        // Nobody pauses the run until the command is sent.
        let cause = self.cause();
        match &*cause {
            StandstillCause::Hazard(hazard) if wheels != WheelSpeeds::STOP => Err(hazard.clone()),
            StandstillCause::Pause if wheels != WheelSpeeds::STOP => Ok(false),
            _ => self.publish(wheels).map(|()| true),
        }
    }
}
