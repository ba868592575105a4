//! The command line as a user runs it: output, files and exit code of each verb.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

mod bad_input;
mod calibrate;
mod check;
mod compare;
mod conform;
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
mod names;
mod options;
mod play;
mod proofs;
mod rerun;
mod safeguards;
mod sense;
mod shards;
mod simulate;
mod train;

use std::{
    collections::{BTreeMap, BTreeSet},
    ffi::{OsStr, OsString},
    fs,
    path::{Path, PathBuf},
    process::{Child, Command, Output, Stdio},
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

/// Runs the program until it reads its standard input, and sends the signal of Ctrl-C.
#[cfg(unix)]
fn interrupted(line: &str) -> Output {
    use std::io::Write as _;

    let mut program = toposlam();
    program.args(line.split(' ')).stdin(Stdio::piped());
    let mut program = program.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // More than a pipe holds: the program reads.
    let mut input = program.stdin.take().unwrap();
    input.write_all(&vec![b' '; 1 << 20]).unwrap();
    interrupt(&program);
    let output = program.wait_with_output().unwrap();
    drop(input);
    output
}

/// Runs the program until it prints a line, and sends the signal of Ctrl-C.
#[cfg(unix)]
fn interrupted_after_a_line(line: &str) -> Output {
    use std::io::{BufRead, BufReader, Read};

    let mut program = toposlam();
    program.args(line.split(' ')).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut program = program.spawn().unwrap();
    let mut out = BufReader::new(program.stdout.take().unwrap());
    let mut text = String::new();
    out.read_line(&mut text).unwrap();
    interrupt(&program);
    out.read_to_string(&mut text).unwrap();
    let output = program.wait_with_output().unwrap();
    Output { stdout: text.into_bytes(), ..output }
}

/// Sends the signal of Ctrl-C.
#[cfg(unix)]
fn interrupt(program: &Child) {
    let killed = Command::new("kill").args(["-INT", &program.id().to_string()]).status().unwrap();
    assert!(killed.success());
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

/// A folder in which a test runs the program. It shows the inputs of the repository by their usual names.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let folder = folder(name);
        for inputs in ["docs", "fuzz", "tests", "vision", "worlds"] {
            let inputs_path = Path::new(env!("CARGO_MANIFEST_DIR")).join(inputs);
            #[cfg(unix)]
            std::os::unix::fs::symlink(inputs_path, folder.join(inputs)).unwrap();
            #[cfg(windows)]
            std::os::windows::fs::symlink_dir(inputs_path, folder.join(inputs)).unwrap();
        }
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).unwrap();
    }

    fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    /// The names of the files that the test and the program wrote.
    fn written(&self) -> Vec<String> {
        let mut names = names_in(&self.0);
        names.retain(|name| !self.path(name).is_symlink());
        names
    }

    fn command(&self, line: &str) -> Command {
        let mut command = toposlam();
        command.current_dir(&self.0).args(shlex::split(line).unwrap());
        command
    }

    /// Runs a command line to its end. Its exit code is one that the help of the verb has.
    fn run(&self, line: &str) -> Output {
        let output = self.command(line).output().unwrap();
        let words: Vec<_> = shlex::split(line).unwrap().into_iter().map(OsString::from).collect();
        check_exit_code(&words, &output);
        output
    }

    /// The standard output of a run that ends with this exit code.
    fn out(&self, line: &str, code: i32) -> String {
        let output = self.run(line);
        assert_eq!(
            output.status.code(),
            Some(code),
            "{line}: {}{}",
            stdout(&output),
            stderr(&output)
        );
        stdout(&output)
    }

    /// The error message of a run that ends with 2.
    fn error(&self, line: &str) -> String {
        let output = self.run(line);
        assert_eq!(output.status.code(), Some(2), "{line}: {}{}", stdout(&output), stderr(&output));
        stderr(&output)
    }

    /// The objects that `--json` prints, in a run that ends with this exit code.
    fn lines(&self, line: &str, code: i32) -> Vec<Value> {
        objects(&self.out(&format!("{line} --json"), code))
    }

    /// The last of these objects.
    fn last(&self, line: &str, code: i32) -> Value {
        self.lines(line, code).pop().unwrap()
    }

    /// Checks fields of what `--json` prints: of the last object, or, for a list, of all objects.
    fn facts(&self, facts: &[(&str, i32, Value)]) {
        for (line, code, fields) in facts {
            let found = self.lines(line, *code);
            match fields {
                Value::Array(_) => has(&Value::Array(found), fields, line),
                // Only the exit code.
                Value::Object(fields) if fields.is_empty() => {}
                _ => has(found.last().unwrap(), fields, line),
            }
        }
    }
}

/// Checks that a value has these fields. `a.b` is a field of a field, `a.0` an element, `a.#` the number of
/// elements, and a missing field is `null`.
fn has(found: &Value, fields: &Value, place: &str) {
    match fields {
        Value::Object(fields) if !fields.is_empty() => {
            for (path, expected) in fields {
                let of = |found: Value, name: &str| match (name.parse::<usize>(), &found) {
                    (_, Value::Array(list)) if name == "#" => list.len().into(),
                    (Ok(index), Value::Array(list)) => list[index].clone(),
                    _ => found[name].clone(),
                };
                let value = path.split('.').fold(found.clone(), of);
                has(&value, expected, &format!("{place}: {path}"));
            }
        }
        Value::Array(expected) => {
            let list = found.as_array().unwrap_or_else(|| panic!("{place}: {found}"));
            assert_eq!(list.len(), expected.len(), "{place}: {found}");
            for (found, expected) in list.iter().zip(expected) {
                has(found, expected, place);
            }
        }
        _ => assert_eq!(found, fields, "{place}"),
    }
}

/// The numbers that objects have by this name.
fn numbers(lines: &[Value], key: &str) -> Vec<u64> {
    lines.iter().map(|line| line[key].as_u64().unwrap()).collect()
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
