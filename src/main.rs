//! The program `toposlam`.

use std::process::ExitCode;

fn main() -> ExitCode {
    // The revision of the sources, from the environment of the build.
    toposlam::run(option_env!("TOPOSLAM_REVISION"))
}
