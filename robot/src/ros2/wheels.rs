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
    state: Mutex<StandstillState>,
    over: Condvar,
}

#[derive(Debug, Default)]
struct StandstillState {
    cause: StandstillCause,
    /// Whether a pause stopped the wheels, and the run does not know it yet.
    is_interrupted: bool,
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

impl Standstill {
    fn state(&self) -> MutexGuard<'_, StandstillState> {
        // The guarded data is valid at any time, even after a panic.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Begins a pause, if nothing keeps the wheels still yet, and stops them.
    fn pause(&self, stop: impl FnOnce() -> Result<(), RobotError>) -> Result<(), PauseRefusal> {
        let mut state = self.state();
        match state.cause {
            StandstillCause::None => {}
            StandstillCause::Pause => return Err(PauseRefusal::Paused),
            StandstillCause::Hazard(_) => return Err(PauseRefusal::Ended),
        }
        *state = StandstillState { cause: StandstillCause::Pause, is_interrupted: true };
        // The run sends it again if this fails.
        stop().map_err(|_| PauseRefusal::NotSent)
    }

    /// Ends a pause. Whether there was one.
    fn resume(&self) -> bool {
        let mut state = self.state();
        let was_paused = state.cause == StandstillCause::Pause;
        if was_paused {
            state.cause = StandstillCause::None;
            self.over.notify_all();
        }
        was_paused
    }

    /// Keeps the wheels still for good, and stops them. Whether this hazard is the first one.
    fn end(&self, hazard: RobotError, stop: impl FnOnce() -> Result<(), RobotError>) -> bool {
        let mut state = self.state();
        let is_new = !matches!(state.cause, StandstillCause::Hazard(_));
        if is_new {
            state.cause = StandstillCause::Hazard(hazard);
            self.over.notify_all();
            // The run ends with the hazard, not with an error of stopping.
            let _ = stop();
        }
        is_new
    }

    /// Waits for the end of a pause, and stops the wheels again and again. Whether a pause began since the last call.
    fn wait(
        &self,
        must_stop: fn() -> bool,
        stop: impl Fn() -> Result<(), RobotError>,
    ) -> Result<bool, RobotError> {
        let mut state = self.state();
        while state.cause == StandstillCause::Pause {
            if must_stop() {
                return Err(RobotError::Stopped);
            }
            stop()?;
            let waited = self.over.wait_timeout(state, REPEAT);
            state = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
        Ok(std::mem::take(&mut state.is_interrupted))
    }

    /// Sends a command, if the wheels may move or it is a stop. Whether it was sent.
    fn command(
        &self,
        wheels: WheelSpeeds,
        send: impl FnOnce(WheelSpeeds) -> Result<(), RobotError>,
    ) -> Result<bool, RobotError> {
        // Nobody pauses the run until the command is sent.
        let state = self.state();
        if wheels != WheelSpeeds::STOP {
            if let StandstillCause::Hazard(hazard) = &state.cause {
                return Err(hazard.clone());
            }
            // Also after a short pause: the command was chosen for a robot that moves.
            if state.is_interrupted {
                return Ok(false);
            }
        }
        send(wheels).map(|()| true)
    }
}

/// Why a request for a pause has no success.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PauseRefusal {
    Paused,
    /// A hazard ended the run.
    Ended,
    /// The run is paused, but the stop command was not sent.
    NotSent,
}

impl PauseRefusal {
    pub(super) fn message(self) -> &'static str {
        match self {
            Self::Paused => "the run is paused already",
            Self::Ended => "the run ends",
            Self::NotSent => "the stop command could not be sent",
        }
    }
}

impl WheelsTopic {
    fn publish(&self, wheels: WheelSpeeds) -> Result<(), RobotError> {
        self.writer.publish(self.wheels_type.body(self.clock.now(), wheels))
    }

    fn stop_command(&self) -> Result<(), RobotError> {
        self.publish(WheelSpeeds::STOP)
    }

    /// Stops the wheels until [`resume`](Self::resume).
    pub(super) fn pause(&self) -> Result<(), PauseRefusal> {
        self.standstill.pause(|| self.stop_command())
    }

    /// Ends a pause. Whether there was one.
    pub(super) fn resume(&self) -> bool {
        self.standstill.resume()
    }

    /// Stops the wheels for good: the next command to move is this error. Whether it is the first one.
    pub(super) fn end(&self, hazard: RobotError) -> bool {
        self.standstill.end(hazard, || self.stop_command())
    }
}

impl Wheels for Arc<WheelsTopic> {
    fn wait(&self) -> Result<bool, RobotError> {
        self.standstill.wait(self.stop, || self.stop_command())
    }

    fn is_interrupted(&self) -> bool {
        self.standstill.state().is_interrupted
    }

    fn command(&self, wheels: WheelSpeeds) -> Result<bool, RobotError> {
        self.standstill.command(wheels, |wheels| self.publish(wheels))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AHEAD: WheelSpeeds = WheelSpeeds { left: 0.2, right: 0.2 };

    fn sent(standstill: &Standstill, wheels: WheelSpeeds) -> Result<bool, RobotError> {
        standstill.command(wheels, |_| Ok(()))
    }

    fn wait(standstill: &Standstill) -> bool {
        standstill.wait(|| false, || Ok(())).unwrap()
    }

    /// A command that was chosen before a pause is not sent, however short the pause was.
    #[test]
    fn after_a_pause_no_command_to_move_is_sent_before_the_run_knows_of_it() {
        let standstill = Standstill::default();
        assert!(!wait(&standstill));
        assert_eq!(sent(&standstill, AHEAD), Ok(true));
        standstill.pause(|| Ok(())).unwrap();
        assert_eq!(sent(&standstill, AHEAD), Ok(false));
        assert!(standstill.resume() && !standstill.resume());
        assert_eq!(sent(&standstill, AHEAD), Ok(false));
        assert_eq!(sent(&standstill, WheelSpeeds::STOP), Ok(true));
        assert!(wait(&standstill));
        assert_eq!(sent(&standstill, AHEAD), Ok(true));
        assert!(!wait(&standstill));
    }

    #[test]
    fn a_pause_has_success_only_if_the_stop_command_is_sent() {
        let standstill = Standstill::default();
        let closed = || Err(RobotError::Closed { topic: "/cmd_vel".to_owned() });
        assert_eq!(standstill.pause(closed), Err(PauseRefusal::NotSent));
        assert_eq!(sent(&standstill, AHEAD), Ok(false));
        assert_eq!(standstill.pause(|| Ok(())), Err(PauseRefusal::Paused));
        let hazard = RobotError::Hazard { topic: "/bumper", what: "the bumper is pressed" };
        assert!(standstill.end(hazard.clone(), || Ok(())));
        assert_eq!(standstill.pause(|| Ok(())), Err(PauseRefusal::Ended));
        assert_eq!(sent(&standstill, AHEAD), Err(hazard));
    }
}
