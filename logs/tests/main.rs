//! Tests of the readers and writers of logs through their public interface.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

mod logs;
