//! Symbolic execution of the compiled harnesses: that each holds, and that a planted fault is found in each.

use std::{
    env,
    path::Path,
    process::{Command, Output},
};

/// Runs the program of `symbolic/` with the Python that has angr; `None` if none has.
fn run(arguments: &[&str]) -> Option<String> {
    let python = env::var_os("TOPOSLAM_SYMBOLIC_PYTHON").unwrap_or_else(|| "python3".into());
    let program = Path::new(env!("CARGO_MANIFEST_DIR")).join("symbolic/run.py");
    let started = Command::new(&python).arg(program).args(arguments).output();
    let skipped = |missing: &str| {
        assert!(env::var_os("TOPOSLAM_SYMBOLIC").is_none_or(|set| set != "required"), "{missing}");
        eprintln!("skipped: {missing}");
        None
    };
    let Ok(Output { status, stdout, stderr }) = started else {
        return skipped(&format!("there is no {}", python.display()));
    };
    let [out, errors] = [stdout, stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    if status.code() == Some(2) && errors.starts_with("This needs angr") {
        return skipped(&errors);
    }
    assert!(status.success(), "{out}{errors}");
    Some(out)
}

#[test]
#[ignore = "it takes many minutes, and needs angr: symbolic/requirements.txt"]
fn each_harness_holds_and_a_planted_fault_is_found_in_each() {
    let Some(names) = run(&["--list"]) else { return };
    let harnesses = names.lines().count();
    assert!(harnesses > 0);
    let verdicts = run(&[]).expect("there is angr");
    let hold = verdicts.lines().filter(|line| line.ends_with(": holds")).count();
    assert_eq!(hold, harnesses, "{verdicts}");
    let found = run(&["--planted"]).expect("there is angr");
    assert!(found.ends_with(&format!("\n{harnesses} of {harnesses} faults found\n")), "{found}");
}
