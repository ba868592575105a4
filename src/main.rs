//! The program `toposlam`.

use std::process::ExitCode;

fn main() -> ExitCode {
    toposlam::run()
}
