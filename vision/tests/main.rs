//! Tests of sensing through its public interface.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

mod any_image;
mod calibration;
mod camera;
mod colour;
mod rim;

use std::{fs, io, path::Path};

/// A file in `tests/cameras`.
fn file(name: &str) -> io::Result<Vec<u8>> {
    fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cameras").join(name))
}

fn text(name: &str) -> String {
    String::from_utf8(file(name).unwrap()).unwrap()
}
