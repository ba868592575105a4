//! Tests of the whole program: the command line, the pages, the documents.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

mod accepted;
mod architecture;
mod atlas;
mod browser;
mod command_line;
mod conform_page;
mod docs;
mod fuzz;
mod oracle;
mod paper;
mod play_page;
mod run_page;
mod run_page_data;
mod schema;
mod walk_page;
