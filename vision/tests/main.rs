//! Tests of sensing through its public interface.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

mod any_image;
mod calibration;
mod camera;
mod colour;
mod rim;
