//! Stamps that do not grow, as they should from one message of a topic to the next.

use super::messages::{Nanoseconds, SECOND};
use crate::robot::RobotError;

/// A topic has the same stamp again and again if so many messages in a row have it.
const REPEATED: u32 = 5;

/// What is wrong with the stamps of the messages since the last one that was later than those before it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct StampFaults {
    /// How far the last one was before the last good one.
    back: Nanoseconds,
    /// How many were equal to the last good one.
    repeated: u32,
}

impl StampFaults {
    /// Whether a message is later than the last good one. If not, that is recorded.
    pub(super) fn is_later(&mut self, last: Nanoseconds, now: Nanoseconds) -> bool {
        if now > last {
            *self = Self::default();
        } else {
            self.back = last.saturating_sub(now);
            self.repeated = if now == last { self.repeated + 1 } else { 0 };
        }
        now > last
    }

    /// An error, or its cause if that is in the stamps.
    pub(super) fn explain(self, error: RobotError) -> RobotError {
        match error {
            RobotError::Silent { topic, .. } if self.back > 0 => {
                RobotError::ClockWentBack { topic, seconds: self.back as f64 / SECOND as f64 }
            }
            RobotError::Silent { topic, .. } if self.repeated >= REPEATED => {
                RobotError::SameStamp { topic }
            }
            error => error,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A driver that does not set its stamps sends 0.
    #[test]
    fn stamps_that_do_not_grow_are_the_cause_of_silence() {
        let topic = "/odom".to_owned();
        let silent = RobotError::Silent { topic: topic.clone(), seconds: 2.0, unread: 0 };
        let mut stamps = StampFaults::default();
        assert_eq!(stamps.explain(silent.clone()), silent);
        assert!(stamps.is_later(0, 1));
        // A message that comes twice is usual.
        assert!(!stamps.is_later(0, 0));
        assert_eq!(stamps.explain(silent.clone()), silent);
        assert!((0..4).all(|_| !stamps.is_later(0, 0)));
        assert_eq!(stamps.explain(silent.clone()), RobotError::SameStamp { topic: topic.clone() });
        assert!(!stamps.is_later(3 * SECOND, SECOND));
        let back = RobotError::ClockWentBack { topic, seconds: 2.0 };
        assert_eq!(stamps.explain(silent.clone()), back);
        assert_eq!(stamps.explain(RobotError::Stopped), RobotError::Stopped);
        assert!(stamps.is_later(SECOND, 2 * SECOND));
        assert_eq!(stamps.explain(silent.clone()), silent);
    }
}
