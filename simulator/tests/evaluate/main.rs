//! The program `evaluate` as a developer runs it, on a few cases.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

mod laser;
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

/// Commands for each schema, by its name.
const COMMANDS: [(&str, &[&str]); 6] = [
    (
        "evaluate-control",
        &[
            "control --traversals 60",
            "control --traversals 300 --noise 5",
            "control --traversals 0",
        ],
    ),
    (
        "evaluate-laser",
        &[
            "laser --walks 2 --runs 1 --traversals 2",
            "laser --walk 1 --drift 30",
            "laser --walks 0 --runs 1 --traversals 0 --recover",
        ],
    ),
    (
        "evaluate-lengths",
        &[
            "lengths --plan worlds/shape-6.toml --traversals 300",
            "lengths --plans 1 --traversals 10",
        ],
    ),
    (
        "evaluate-mistakes",
        &["mistakes --edges 1..=3", "mistakes --edges 1..=2 --algorithm folding --recover"],
    ),
    (
        "evaluate-runs",
        &[
            "runs --plans 2 --starts 1",
            "runs --plans 2 --starts 1 --faults",
            "runs --plans 2 --starts 1 --faults 2 --algorithm folding --recover",
        ],
    ),
    (
        "evaluate-vision",
        &[
            "vision --size 640x480 --look tiles --views 12 --visits 1",
            "vision --size 640x480 --look tiles --view 5 --out-dir DIR",
            "vision --size 640x480 --look tiles --views 4 --clutter",
        ],
    ),
];

/// The commands, and the exit codes that their help lists: all but `control` and `runs` have targets.
const PARTS: [&str; 6] = ["vision", "control", "runs", "laser", "mistakes", "lengths"];

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

/// Of the lines, the one with this kind, subject and failure.
fn rate<'l>(lines: &'l [Value], of: &str, what: &str) -> &'l Value {
    let is_it = |line: &&Value| line["kind"] == "rate" && line["of"] == of && line["what"] == what;
    lines.iter().find(is_it).unwrap_or_else(|| panic!("{of} {what}: {lines:?}"))
}

#[test]
fn the_lines_of_each_command_fit_its_schema() {
    let written = folder("schema");
    for (name, commands) in COMMANDS {
        let schema = Schema::read(name);
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
    let cases: [(&[&str], &str); 8] = [
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
fn results_are_the_same_on_any_number_of_threads() {
    for command in [
        "vision --size 640x480 --look tiles --views 24 --visits 2 --json",
        "laser --walks 3 --places 6 --runs 1 --traversals 2 --json",
        "control --traversals 3000 --plans 10 --json",
    ] {
        let measured = |threads| {
            let output = run(command.split(' ').chain(["--threads", threads]));
            (output.status.code(), stdout(&output))
        };
        let (code, text) = measured("1");
        assert_eq!((code, text.clone()), measured("3"), "{command}");
        let lines = objects(&text);
        let verdict = lines.last().unwrap();
        let cases = |of: &str, what: &str| rate(&lines, of, what)["cases"].as_u64().unwrap();
        match command.split(' ').next().unwrap() {
            "vision" => {
                for kind in ["source", "rate", "errors", "confusion", "failures"] {
                    assert!(lines.iter().any(|line| line["kind"] == kind), "{kind}");
                }
                let views = [
                    cases("hallway", "called junction"),
                    cases("junction", "kind or entry wrong"),
                    cases("between", "unknown"),
                    cases("past", "kind or entry wrong"),
                    cases("turned", "kind wrong"),
                ];
                assert_eq!((views.iter().sum::<u64>(), cases("visit", "not decided")), (24, 2));
            }
            "laser" => {
                assert!(cases("visit", "wrong") > 3 && cases("percept", "wrong") > 1, "{text}");
                let whole = ["walk", "run", "control"].map(|of| cases(of, "wrong"));
                assert_eq!(whole, [3, 1, 2]);
                assert!(cases("hallway", "called junction") > 30, "{text}");
                // Three walks are too few to show anything but a miss.
                assert_eq!(code, Some(if verdict["target"] == "missed" { 1 } else { 3 }));
            }
            _ => {
                assert_eq!((code, &verdict["traversals"]), (Some(0), &3000.into()));
                assert_eq!(
                    (&verdict["kind"], &verdict["holds"]),
                    (&"control".into(), &true.into())
                );
            }
        }
    }
}
