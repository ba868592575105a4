//! What was repaired or skipped when the messages of a log were read.

use std::collections::BTreeMap;

use serde::{Serialize, Serializer};
use thiserror::Error;
use toposlam_model::counts::grouped;

use super::{
    error::{LogError, LogErrorKind},
    no_return::NoReturnSign,
};

/// What was repaired in the messages of a log, and what was skipped.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ReadingRemark {
    #[error(
        "messages of sensors that cannot be used and were skipped: {}, the first at {first}",
        grouped((*count).into())
    )]
    Unusable { count: u64, first: String },
    #[error(
        "the odometry is that of the frame {frame:?}; the transforms lead from there to the robot"
    )]
    TrackedFrame { frame: String },
    #[error("{sign} means that there is no return: {} readings", grouped((*readings).into()))]
    NoReturn { sign: NoReturnSign, readings: u64 },
    #[error(
        "the angle increments of {} scans do not lead to their angle_max; the readings are spread up to it",
        grouped((*scans).into())
    )]
    AngleIncrement { scans: u64 },
    #[error("{} scans have no angle_max; their readings follow the angle increment", grouped((*scans).into()))]
    NoAngleMax { scans: u64 },
}

impl Serialize for ReadingRemark {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// Counts messages that cannot be used, up to a limit.
#[derive(Default)]
pub(super) struct Unusable {
    first: Option<LogError>,
    /// The number on each topic.
    counts: BTreeMap<usize, u64>,
}

/// So many of a topic are always skipped if others can be used, and one in so many of them.
const FEW: u64 = 10;
const SHARE: u64 = 20;

impl Unusable {
    /// Counts a message of a topic with so many messages.
    ///
    /// # Errors
    /// Returns the first error if there are many.
    pub(super) fn add(&mut self, error: LogError, topic: usize, all: u64) -> Result<(), LogError> {
        let first = self.first.get_or_insert(error);
        let count = self.counts.entry(topic).or_default();
        *count += 1;
        if *count <= (all / SHARE).max(FEW.min(all.saturating_sub(1))) {
            return Ok(());
        }
        let LogError { offset, unit, file, cause } =
            std::mem::replace(first, LogErrorKind::Line(String::new()).at(0));
        let cause = if *count == 1 {
            cause
        } else {
            LogErrorKind::Unusable { first: Box::new(cause), count: *count, all }
        };
        Err(LogError { offset, unit, file, cause })
    }

    pub(super) fn remark(&self) -> Option<ReadingRemark> {
        let first = self.first.as_ref()?.to_string();
        Some(ReadingRemark::Unusable { count: self.counts.values().sum(), first })
    }
}
