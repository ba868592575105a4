//! Deterministic topological SLAM that can be trusted.
//!
//! This package contains the command line, one verb a file in `cli/`. The specification is [`toposlam_model`].

#![warn(clippy::print_stderr, reason = "`remark!` obeys --quiet")]

#[macro_use(remark)]
extern crate toposlam_terminal;

mod cli;

pub use cli::{command, run};
use toposlam_draw::{explorer_run, page, picture, run_page_data, story};
