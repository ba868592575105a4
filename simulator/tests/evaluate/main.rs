//! The program `evaluate` as a developer runs it, on a few cases.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

mod mistakes;
#[allow(dead_code, reason = "other programs use the rest")]
#[path = "../../../tests/output.rs"]
mod output;
mod robots;
mod vision;

use std::{
    collections::BTreeSet,
    ffi::OsStr,
    fs,
    path::Path,
    process::{Command, Output, Stdio},
};

use serde_json::Value;

use output::{Schema, folder, json_lines as objects, names_in, read_world, stderr, stdout};

/// Commands whose lines the schema of their first word describes. DIR is a folder.
const COMMANDS: [&str; 16] = [
    "control --traversals 60",
    "control --traversals 300 --noise 5",
    "control --traversals 0",
    "laser --walks 2 --runs 1 --traversals 2",
    "laser --walk 1 --drift 30",
    "laser --walks 0 --runs 1 --traversals 0 --recover",
    "lengths --plan worlds/shape-6.toml --traversals 300",
    "lengths --plans 1 --traversals 10",
    "mistakes --edges 1..=3",
    "mistakes --edges 1..=2 --algorithm folding --recover",
    "runs --plans 2 --starts 1",
    "runs --plans 2 --starts 1 --faults",
    "runs --plans 2 --starts 1 --faults 2 --algorithm folding --recover",
    "vision --size 640x480 --look tiles --views 12 --visits 1",
    "vision --size 640x480 --look tiles --view 5 --out-dir DIR",
    "vision --size 640x480 --look tiles --views 4 --clutter",
];

/// Commands, their exit codes, and parts of the text that they print, after each `|`. PLAIN is a scanner in empty
/// buildings.
const TEXTS: [(&str, i32, &str); 9] = [
    // Of six junctions: a dead end, four Ls with two entries and two doors each, a T with three.
    (
        "control --traversals 500 --plan worlds/shape-6.toml",
        0,
        "26 pairs of entry door and exit door in 1 floor plan|\
         holds in these traversals: every door leads where it should",
    ),
    (
        "control --images --look tiles --traversals 4 --plan worlds/shape-8.toml",
        0,
        "Driving by rendered images of 640x480",
    ),
    (
        "control --sensor laser --plan worlds/shape-6.toml --traversals 26 --scanner PLAIN",
        0,
        "Driving by scans of a laser scanner|holds in these traversals",
    ),
    (
        "runs --sensor laser --plan worlds/shape-8.toml --starts 1 --scanner PLAIN",
        0,
        "holds in these runs: every map is right, and every move is as specified",
    ),
    (
        "runs --plans 12 --starts 2 --faults",
        0,
        "dropped|frozen|carried|\
         holds in these runs: every map is right, or the robot gave up or was carried",
    ),
    (
        "runs --plans 6 --faults --algorithm folding --recover",
        0,
        "wrong 0 of |holds in these runs: every map is right, or the robot gave up",
    ),
    (
        "lengths --plan worlds/shape-8.toml --traversals 300",
        3,
        "false alarms 0, at most |not shown: there are too few traversals",
    ),
    (
        "laser --walk 4 --places 6",
        3,
        "Laser scanner on 1 walk with |walk 4, | doors, left by door ",
    ),
    (
        "vision --size 640x480 --look tiles --views 24 --visits 2 --calibration-errors",
        3,
        "Sensing on 24 views and 2 visits, seed 1|\
         floor plans building-12, building-25, shape-6, shape-8, random plans|\
         With a right calibration|0.500 %|target 95 % 5 cm: |\
         With a camera 5 pixels, 2 cm and 1 degree off its calibration|\
         True class, and the reported classes",
    ),
];

/// The commands, and the exit codes that their help lists: all but `control` and `runs` have targets.
const PARTS: [&str; 7] = ["vision", "control", "runs", "laser", "logs", "mistakes", "lengths"];

/// Runs the program to its end in the repository.
fn run<A: AsRef<OsStr>>(arguments: impl IntoIterator<Item = A>) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_evaluate"));
    program
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(".."))
        .stdin(Stdio::null())
        .args(arguments)
        .output()
        .unwrap()
}

/// The standard output of a successful run.
fn stdout_of<A: AsRef<OsStr>>(arguments: impl IntoIterator<Item = A>) -> String {
    let output = run(arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    stdout(&output)
}

#[test]
#[ignore = "a long sweep, for `.ci/run --all`"]
fn the_lines_of_each_command_fit_its_schema() {
    let written = folder("schema");
    let part = |command: &str| command.split(' ').next().unwrap().to_owned();
    for commands in COMMANDS.chunk_by(|one, other| part(one) == part(other)) {
        let name = part(commands[0]);
        let schema = Schema::read(&format!("evaluate-{name}"));
        let mut shown = BTreeSet::new();
        for command in commands {
            let command = command.replace("DIR", written.to_str().unwrap());
            let output = run(command.split(' ').chain(["--json"]));
            let lines = objects(&stdout(&output));
            let verdict = lines.last().unwrap();
            let code = match verdict["verdict"].as_str() {
                Some("holds") => Some(0),
                Some("violated") => Some(1),
                Some("not-known") => Some(3),
                _ => None,
            };
            assert!(code.is_none() || code == output.status.code(), "{command}: {verdict}");
            for line in lines {
                assert_eq!(schema.misfit(&line), None, "{command}: {line}");
                shown.insert(line["kind"].as_str().unwrap().to_owned());
            }
        }
        assert!(schema.kinds().iter().eq(&shown), "{name}: {shown:?}");
    }
}

#[test]
#[ignore = "a long sweep, for `.ci/run --all`"]
fn texts_are_at_most_80_columns_wide_and_have_the_expected_parts() {
    let folder = folder("texts");
    let plain = folder.join("plain.toml");
    fs::write(&plain, "glass = 0\nblack = 0\ndoors = 0\nfurniture = 0\npeople = 0\n").unwrap();
    for (command, code, parts) in TEXTS {
        let output = run(command.replace("PLAIN", plain.to_str().unwrap()).split(' '));
        let text = stdout(&output);
        assert_eq!(output.status.code(), Some(code), "{command}: {text}");
        // Cells are wrapped.
        let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
        for part in parts.split('|') {
            assert!(words.contains(part), "{command}: {part}\n{text}");
        }
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
        assert!(stderr(&output).contains(" s on "), "{}", stderr(&output));
    }
}

#[test]
fn help_is_at_most_80_columns_wide_and_ends_with_the_exit_codes() {
    for part in PARTS {
        let help = stdout_of([part, "--help"]);
        assert!(help.lines().all(|line| line.chars().count() <= 80), "{help}");
        let (_, codes) = help.rsplit_once("\nExit codes:\n").unwrap();
        let codes: Vec<_> = codes.lines().map(|line| line.trim().split(' ').next()).collect();
        assert_eq!(codes, ["0", "1", "2", "3"].map(Some), "{help}");
    }
}

#[test]
fn an_option_without_effect_is_an_error() {
    const WORLD: &str = "worlds/shape-8.toml";
    let folder = folder("bad");
    let scanner = folder.join("far.toml");
    fs::write(&scanner, "range = 40.0\n").unwrap();
    let scanner = scanner.to_str().unwrap();
    let cases: [(&[&str], &str); 10] = [
        (&["control", "--look", "vinyl"], "--images"),
        (&["control", "--size", "640x480"], "--images"),
        (&["control", "--plan", WORLD, "--plans", "3"], "cannot be used with"),
        (&["runs", "--look", "vinyl"], "--images"),
        (&["runs", "--plan", WORLD, "--plans", "3"], "cannot be used with"),
        (
            &["control", "--sensor", "laser", "--images"],
            "--images: has no effect with --sensor laser",
        ),
        (&["runs", "--scanner", scanner], "--scanner: the robot has no laser scanner"),
        (&["mistakes", "--recover", "--algorithm", "algorithm1"], "--algorithm folding"),
        (&["runs", "--recover", "--algorithm", "algorithm1"], "--algorithm folding"),
        (&["laser", "--drift", "91"], "expected a number of degrees from 0 to 90"),
    ];
    for (arguments, cause) in cases {
        let output = run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(cause), "{}", stderr(&output));
        assert!(output.stdout.is_empty(), "{arguments:?}");
    }
}

#[test]
#[ignore = "a long sweep, for `.ci/run --all`"]
fn results_are_the_same_on_any_number_of_threads() {
    /// The rates of a report, each by what it is of and what it counts, with its number of cases.
    type Cases = &'static [(&'static str, &'static str, u64)];
    let commands: [(&str, Cases); 3] = [
        (
            "vision --size 640x480 --look tiles --views 24 --visits 2 --json",
            &[("marker", "seen where it is not", 24), ("visit", "not decided", 2)],
        ),
        (
            "laser --walks 3 --places 6 --runs 1 --traversals 2 --json",
            &[("walk", "wrong", 3), ("run", "wrong", 1), ("control", "wrong", 2)],
        ),
        ("control --traversals 3000 --plans 10 --json", &[]),
    ];
    for (command, expected) in commands {
        let [one, three] = ["1", "3"].map(|threads| {
            let output = run(command.split(' ').chain(["--threads", threads]));
            (output.status.code(), stdout(&output))
        });
        assert_eq!(one, three, "{command}");
        let lines = objects(&one.1);
        for &(of, what, cases) in expected {
            let is_it = |line: &&Value| line["of"] == of && line["what"] == what;
            let rate = lines.iter().find(is_it).unwrap();
            assert_eq!(rate["cases"], cases, "{rate}");
        }
    }
}
