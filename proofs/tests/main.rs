//! Tests of the lemmas, of the Coq development, and of the harnesses for Kani and for symbolic execution.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

mod argument;
mod coq;
mod harnesses;
mod symbolic;
