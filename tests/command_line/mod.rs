//! The command line as a user runs it: output, files and exit code of each verb.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

mod bad_input;
mod calibrate;
mod check;
mod compare;
mod conform;
mod conform_report;
mod containers;
mod counterexample;
mod draw;
mod explore;
mod explorer;
mod files;
mod folding;
mod help;
mod info;
mod laser;
mod laser_logs;
mod lines;
mod log;
mod merge;
mod names;
mod options;
mod play;
mod proofs;
mod render;
mod replay;
mod safeguards;
mod sense;
mod simulate;
mod train;

use std::{
    collections::{BTreeMap, BTreeSet},
    ffi::{OsStr, OsString},
    fs,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
    sync::{Mutex, PoisonError},
};

use serde_json::Value;
use toposlam_model::format::{named_world::NamedWorld, world_file};

use crate::schema::fits_a_schema;

/// The program.
fn toposlam() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_toposlam"));
    command.current_dir(env!("CARGO_MANIFEST_DIR")).stdin(Stdio::null());
    command
}

/// Runs the program to its end. Its exit code is one that the help of the verb has.
fn run<A: AsRef<OsStr>>(arguments: impl IntoIterator<Item = A>) -> Output {
    let arguments: Vec<OsString> =
        arguments.into_iter().map(|word| word.as_ref().to_owned()).collect();
    let output = toposlam().args(&arguments).output().unwrap();
    check_exit_code(&arguments, &output);
    output
}

/// Runs the program until it reads its standard input, and sends the signal of Ctrl-C.
#[cfg(unix)]
fn interrupted(arguments: &[&str]) -> Output {
    use std::io::Write as _;

    let mut program = toposlam();
    program.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut program = program.spawn().unwrap();
    // More than a pipe holds: the program reads.
    let mut input = program.stdin.take().unwrap();
    input.write_all(&vec![b' '; 1 << 20]).unwrap();
    let killed = Command::new("kill").args(["-INT", &program.id().to_string()]).status().unwrap();
    assert!(killed.success());
    let output = program.wait_with_output().unwrap();
    drop(input);
    output
}

fn check_exit_code(arguments: &[OsString], output: &Output) {
    static KNOWN: Mutex<BTreeMap<Vec<OsString>, BTreeSet<i32>>> = Mutex::new(BTreeMap::new());
    let words = if arguments.first().is_some_and(|verb| verb == "camera") { 2 } else { 1 };
    let verb = arguments.get(..words).unwrap_or_default().to_vec();
    let code = output.status.code().expect("the program was killed");
    // Bad usage can be an unknown verb.
    if code == 2 || verb.iter().any(|word| word.to_string_lossy().starts_with('-')) {
        return;
    }
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let codes = known.entry(verb.clone()).or_insert_with(|| {
        let help = toposlam().args(&verb).arg("--help").output().unwrap();
        exit_codes(&stdout(&help)).into_keys().collect()
    });
    assert!(codes.contains(&code), "exit code {code} is not in the help: {arguments:?}");
}

/// The exit codes at the end of a help, with their meanings.
fn exit_codes(help: &str) -> BTreeMap<i32, String> {
    let (_, listed) = help.rsplit_once("\nExit codes:\n").expect(help);
    let mut codes = BTreeMap::new();
    for line in listed.lines() {
        match line.strip_prefix("  ").and_then(|line| line.split_once("  ")) {
            Some((code, meaning)) if !code.is_empty() => {
                let twice = codes.insert(code.parse().expect(help), meaning.to_owned());
                assert_eq!(twice, None, "{help}");
            }
            _ => {
                let mut last = codes.last_entry().expect(help);
                last.get_mut().push_str(line.strip_prefix("    ").expect(help));
            }
        }
    }
    codes
}

/// The standard output of a successful run.
fn stdout_of<A: AsRef<OsStr>>(arguments: impl IntoIterator<Item = A>) -> String {
    let output = run(arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    stdout(&output)
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// The JSON objects of an output, one a line. Each fits a schema.
fn objects(text: &str) -> Vec<Value> {
    let lines = text.lines().map(|line| serde_json::from_str(line).unwrap());
    let objects: Vec<Value> = lines.collect();
    assert!(text.ends_with('\n') && objects.iter().all(fits_a_schema), "{text}");
    objects
}

/// An empty folder for a test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("command_line").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// The names in a folder.
fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// The world files of the repository.
fn world_files() -> Vec<PathBuf> {
    let worlds = Path::new(env!("CARGO_MANIFEST_DIR")).join("worlds");
    let mut files: Vec<_> =
        fs::read_dir(worlds).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension() == Some(OsStr::new("toml")));
    files.sort();
    assert!(files.len() >= 18);
    files
}

fn read_world(path: &Path) -> NamedWorld {
    world_file::read(&fs::read(path).unwrap()).unwrap()
}
