//! The time of a message.

use serde::{Deserialize, Serialize};

/// A time, in seconds and nanoseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Stamp {
    /// Whole seconds.
    pub sec: i32,
    pub nanosec: u32,
}

impl Stamp {
    pub fn from_nanoseconds(nanoseconds: u64) -> Self {
        const SECOND: u64 = 1_000_000_000;
        let sec = i32::try_from(nanoseconds / SECOND).unwrap_or(i32::MAX);
        Self { sec, nanosec: (nanoseconds % SECOND) as u32 }
    }

    /// The time in nanoseconds; 0 before the beginning of time.
    pub fn nanoseconds(self) -> u64 {
        u64::try_from(self.sec).unwrap_or(0) * 1_000_000_000 + u64::from(self.nanosec)
    }
}
