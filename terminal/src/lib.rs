//! What programs on the command line share: messages and progress on standard error, exit codes, tables and JSON lines,
//! input and output files, and the options of how a robot maps.

#![allow(clippy::missing_errors_doc, reason = "each error names its place and its cause")]
#![warn(clippy::print_stderr, reason = "--quiet is obeyed in `terminal.rs`")]

/// Prints a remark on standard error, unless `--quiet` is given.
#[macro_export]
macro_rules! remark {
    ($($text:tt)*) => { $crate::terminal::remark(format_args!($($text)*)) };
}

pub mod children;
pub mod edge_range;
pub mod exit_codes;
pub mod files;
mod foreign_format;
pub mod input;
pub mod json;
pub mod method_options;
pub mod outcome;
pub mod output;
pub mod picture_file;
mod placed_graph;
pub mod progress;
pub mod report_output;
pub mod scene;
pub mod terminal;
pub mod text;
pub mod thread_option;

pub use outcome::{CliError, Outcome};
