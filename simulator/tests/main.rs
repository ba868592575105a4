//! Tests of the simulator through its public interface, and of what it records.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

mod housing;
mod laser;
mod recorded;
mod recorder;
mod renderer;
mod replay;
mod rim;
mod scanner;
mod sensing;
