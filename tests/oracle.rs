//! Algorithm 1 against a second implementation of it, in Python, which shares nothing with it but the
//! reading of the paper.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::process::Command;

use serde_json::Value;

/// The JSON objects that a command prints.
fn objects(command: &mut Command) -> Vec<Value> {
    let output = command.current_dir(env!("CARGO_MANIFEST_DIR")).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// Every key that the oracle prints has the same value in what `check` prints.
fn agree(choices: &str, up_to: &str) {
    if Command::new("python3").arg("--version").output().is_err() {
        eprintln!("skipped: there is no python3 to run tests/oracle/algorithm1.py");
        return;
    }
    let oracle =
        objects(Command::new("python3").args(["tests/oracle/algorithm1.py", choices, up_to]));
    let sizes = format!("1..={up_to}");
    let ours = objects(Command::new(env!("CARGO_BIN_EXE_toposlam")).args([
        "check",
        "--json",
        "--choices",
        choices,
        "--edges",
        &sizes,
    ]));
    assert_eq!(oracle.len(), ours.len());
    for (oracle, ours) in oracle.iter().zip(&ours) {
        for (key, value) in oracle.as_object().unwrap() {
            assert_eq!(&ours[key], value, "{key}: {oracle} against {ours}");
        }
    }
}

#[test]
fn the_default_choices_cost_the_same() {
    agree("default", "5");
}

#[test]
fn all_choices_have_the_same_states_runs_and_costs() {
    agree("all", "3");
}
