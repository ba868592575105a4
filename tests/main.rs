//! Tests of the whole program: the command line, the pages, the documents.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

mod architecture;
mod assurance;
mod atlas;
mod browser;
mod command_line;
mod conform_page;
mod docs;
mod fuzz;
mod oracle;
mod output;
mod pages;
mod paper;
#[allow(dead_code, reason = "other programs use the rest")]
mod process;
mod schema;
mod scripts;
mod verdicts;

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

/// A file or folder of the repository.
fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn read(path: &str) -> String {
    fs::read_to_string(repository(path)).unwrap()
}

/// The program, in the folder of the repository.
fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_toposlam"));
    command.current_dir(repository("")).stdin(Stdio::null());
    command
}

/// What a successful command prints.
fn printed(command: &mut Command) -> String {
    let output = command.output().unwrap();
    assert!(output.status.success(), "{command:?}: {output:?}");
    String::from_utf8(output.stdout).unwrap()
}
