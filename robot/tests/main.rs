//! Tests of the robot through its public interface.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

mod laser;
mod logs;
mod renderer;
mod rim;
mod scanner;
mod sensing;
