//! The command line as a user runs it: output, files and exit code of each verb.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

/// Checks a command a row, with [`Scratch::fact`].
macro_rules! facts {
    ($scratch:expr; $(
        $line:expr => $code:literal $({$($object:tt)*})? $([$($list:tt)*])? $(($value:expr))? $($text:literal)?;
    )+) => {$(
        let expected = serde_json::json!(
            [$({$($object)*})? $([$($list)*])? $($value)? $($text)?]
        );
        $scratch.fact(AsRef::<str>::as_ref(&$line), $code, &expected[0]);
    )+};
}

mod bad_input;
mod calibrate;
mod check;
mod ci_report;
mod compare;
mod conform;
mod containers;
mod counterexample;
mod draw;
mod explore;
mod explorer;
mod facts;
mod files;
mod help;
mod laser;
mod log;
mod names;
mod options;
mod proofs;
mod sense;
mod shards;
mod simulate;
mod train;

use std::{
    collections::{BTreeMap, BTreeSet},
    ffi::OsStr,
    fs,
    io::{BufRead, BufReader, Read, Write},
    path::PathBuf,
    process::{Child, Command, Output, Stdio},
    sync::{Mutex, PoisonError},
};

use serde_json::Value;

use crate::{
    output::{folder, json_lines, names_in, read_world, stderr, stdout},
    process::signal,
    program, repository,
    schema::fits_a_schema,
};

/// Runs the program until it reads its standard input, and sends the signal of Ctrl-C.
#[cfg(unix)]
fn interrupted(line: &str) -> Output {
    interrupted_by("-INT", line)
}

#[cfg(unix)]
fn interrupted_by(name: &str, line: &str) -> Output {
    let mut program = program();
    program.args(line.split(' ')).stdin(Stdio::piped());
    let mut program = program.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // More than a pipe holds: the program reads.
    let mut input = program.stdin.take().unwrap();
    input.write_all(&vec![b' '; 1 << 20]).unwrap();
    signal(&program, name);
    let output = program.wait_with_output().unwrap();
    drop(input);
    output
}

/// Runs the program until it prints a line, and sends the signal of Ctrl-C. Its exit code is 3. Returns what it
/// printed.
#[cfg(unix)]
fn interrupted_after_a_line(line: &str) -> String {
    let mut program = program();
    program.args(line.split(' ')).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut program = program.spawn().unwrap();
    let mut out = BufReader::new(program.stdout.take().unwrap());
    let mut text = String::new();
    out.read_line(&mut text).unwrap();
    interrupt(&program);
    out.read_to_string(&mut text).unwrap();
    let output = program.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(3), "{line}: {text}{}", stderr(&output));
    text
}

/// Sends the signal of Ctrl-C.
#[cfg(unix)]
fn interrupt(program: &Child) {
    signal(program, "-INT");
}

/// The exit code is one that the help of the verb has. Bad usage can be an unknown verb.
fn check_exit_code(words: &[String], code: i32) {
    static KNOWN: Mutex<BTreeMap<Vec<String>, BTreeSet<i32>>> = Mutex::new(BTreeMap::new());
    let length = if words.first().is_some_and(|verb| verb == "camera") { 2 } else { 1 };
    let verb = words.get(..length).unwrap_or_default();
    if code == 2 || verb.iter().any(|word| word.starts_with('-')) {
        return;
    }
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let codes = known.entry(verb.to_vec()).or_insert_with(|| {
        let help = program().args(verb).arg("--help").output().unwrap();
        exit_codes(&stdout(&help)).into_keys().collect()
    });
    assert!(codes.contains(&code), "exit code {code} is not in the help: {words:?}");
}

/// The exit codes at the end of a help, with the first lines of their meanings.
fn exit_codes(help: &str) -> BTreeMap<i32, &str> {
    let (_, listed) = help.rsplit_once("\nExit codes:\n").expect(help);
    let lines = listed.lines().map(|line| line.strip_prefix("  ").expect(help));
    let first_lines = lines.filter(|line| !line.starts_with(' '));
    let codes = first_lines.map(|line| line.split_once("  ").expect(help));
    codes.map(|(code, meaning)| (code.parse().expect(help), meaning)).collect()
}

/// A text without line breaks.
fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The JSON objects of an output, one a line. Each fits a schema.
fn objects(text: &str) -> Vec<Value> {
    let objects = json_lines(text);
    assert!(objects.iter().all(fits_a_schema), "{text}");
    objects
}

/// A folder in which a test runs the program. It shows the inputs of the repository by their usual names.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let folder = folder(name);
        for inputs in ["docs", "fuzz", "tests", "vision", "worlds"] {
            let inputs_path = repository(inputs);
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
        let mut command = program();
        command.current_dir(&self.0).args(shlex::split(line).unwrap());
        command
    }

    /// Runs a command line to its end. Its exit code is one that the help of the verb has.
    fn run(&self, line: &str) -> Output {
        let output = self.command(line).output().unwrap();
        let code = output.status.code().expect("the program was killed");
        check_exit_code(&shlex::split(line).unwrap(), code);
        assert!(!stderr(&output).contains("panicked"), "{line}: {}", stderr(&output));
        output
    }

    /// The standard output of a run that ends with this exit code.
    fn out(&self, line: &str, code: i32) -> String {
        let output = self.run(line);
        let [out, error] = [stdout(&output), stderr(&output)];
        assert_eq!(output.status.code(), Some(code), "{line}: {out}{error}");
        out
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

    /// Checks the exit code of a command, and fields of what `--json` prints: of the last object, or, for a list, of
    /// all objects. A text is what its error message begins with, behind `error: `. `[..]` in a text is any text.
    fn fact(&self, line: &str, code: i32, expected: &Value) {
        match expected {
            Value::Null => drop(self.out(line, code)),
            Value::String(message) => {
                let output = self.run(line);
                let error = stderr(&output);
                assert_eq!(output.status.code(), Some(code), "{line}: {}{error}", stdout(&output));
                let is_it = is_like(&error, &format!("error: {message}[..]"));
                assert!(is_it, "{line}: {error} is not {message}");
                assert!(
                    output.stdout.is_empty() && error.matches("error:").count() == 1,
                    "{error}"
                );
            }
            Value::Array(_) => has(&self.lines(line, code).into(), expected, line),
            _ => has(&self.last(line, code), expected, line),
        }
    }

    /// As `fact`, for each of these.
    fn facts(&self, facts: &[(&str, i32, Value)]) {
        for (line, code, expected) in facts {
            self.fact(line, *code, expected);
        }
    }
}

/// Checks that a value has these fields. `a.b` is a field of a field, `a.0` an element, `a.#` the number of
/// elements, and a missing field is `null`. No fields are all fields.
fn has(found: &Value, fields: &Value, place: &str) {
    match fields {
        Value::Object(fields) => {
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
        Value::String(text) if text.contains("[..]") => {
            assert!(found.as_str().is_some_and(|found| is_like(found, text)), "{place}: {found}");
        }
        _ => assert_eq!(found, fields, "{place}"),
    }
}

/// Whether a text is this one, where `[..]` is any text.
fn is_like(text: &str, pattern: &str) -> bool {
    let Some((first, others)) = pattern.split_once("[..]") else { return text == pattern };
    let (others, last) = others.rsplit_once("[..]").unwrap_or(("", others));
    let rest = others.split("[..]").try_fold(text.strip_prefix(first), |rest, part| {
        let (_, after) = rest?.split_once(part)?;
        Some(Some(after))
    });
    rest.flatten().is_some_and(|rest| rest.ends_with(last))
}

/// The numbers that objects have by this name.
fn numbers(lines: &[Value], key: &str) -> Vec<u64> {
    lines.iter().map(|line| line[key].as_u64().unwrap()).collect()
}

/// The world files of the repository.
fn world_files() -> Vec<PathBuf> {
    let worlds = repository("worlds");
    let mut files: Vec<_> = names_in(&worlds).into_iter().map(|name| worlds.join(name)).collect();
    files.retain(|path| path.extension() == Some(OsStr::new("toml")));
    assert!(files.len() >= 18);
    files
}
