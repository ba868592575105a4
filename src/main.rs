//! The program `toposlam`.

use std::{hint::black_box, process::ExitCode};

/// glibc gives freed memory back to the system and takes it again page by page, which is a tenth of the time of a laser log with
/// its hundreds of local maps. It keeps up to twice the largest piece that was freed, in bytes; a local map takes less.
const FREED: usize = 1 << 20;

fn main() -> ExitCode {
    drop(black_box(vec![0_u8; FREED]));
    // The revision of the sources, from the environment of the build.
    toposlam::run(option_env!("TOPOSLAM_REVISION"))
}
