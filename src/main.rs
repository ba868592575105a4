//! The command line `toposlam`: one verb a file, in `cli/`.

#![warn(clippy::print_stderr, reason = "--quiet is obeyed in `cli/terminal.rs`")]

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run()
}
