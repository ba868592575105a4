//! Both algorithms against second implementations of them, in Python. That of Algorithm 1 shares
//! nothing with it but the reading of the paper; that with a movable marker, nothing but its
//! description.

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
fn agree(oracle: &[&str], check: &[&str]) {
    if Command::new("python3").arg("--version").output().is_err() {
        eprintln!("skipped: there is no python3 to run tests/oracle/{}", oracle[0]);
        return;
    }
    let script = format!("tests/oracle/{}", oracle[0]);
    // -B: it leaves nothing behind.
    let oracle = objects(Command::new("python3").args(["-B", &script]).args(&oracle[1..]));
    let check = [&["check", "--json"], check].concat();
    let ours = objects(Command::new(env!("CARGO_BIN_EXE_toposlam")).args(check));
    assert_eq!(oracle.len(), ours.len());
    for (oracle, ours) in oracle.iter().zip(&ours) {
        for (key, value) in oracle.as_object().unwrap() {
            assert_eq!(&ours[key], value, "{key}: {oracle} against {ours}");
        }
    }
}

#[test]
fn the_default_choices_cost_the_same() {
    agree(&["algorithm1.py", "default", "5"], &["--edges", "1..=5"]);
}

#[test]
fn all_choices_have_the_same_states_runs_and_costs() {
    agree(&["algorithm1.py", "all", "3"], &["--edges", "1..=3", "--choices", "all"]);
}

// paper: movable.place, movable.back-link
#[test]
fn with_a_movable_marker_the_moves_are_the_same() {
    agree(&["movable_marker.py", "6"], &["--edges", "1..=6", "--marker", "movable"]);
}
