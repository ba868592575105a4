//! Deterministic topological SLAM that can be trusted.
//!
//! This package contains the command line, one verb a file in `cli/`, and what it draws and writes: pictures of
//! worlds and runs ([`picture`]), pages for a browser ([`page`]), what the page of a simulated run shows
//! ([`run_page_data`]), the story of a mapping run ([`story`]) and the conformance report of a log ([`report`]). The specification is [`model`].

#![warn(clippy::print_stderr, reason = "--quiet is obeyed in `cli/terminal.rs`")]

mod cli;
pub mod moment;
pub mod page;
pub mod picture;
pub mod report;
pub mod run_page_data;
pub mod story;
pub mod text;

pub use cli::{command, run};
pub use toposlam_model as model;
