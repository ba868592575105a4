//! What is there for whoever asks: help, completions, the paper; and a reader who leaves early.

use std::{io::Read, process::Stdio};

use super::{run, said, stderr, toposlam};

const VERBS: [(&str, &[&str]); 18] = [
    ("check", &["--edges", "--class", "--marker", "--choices", "--shard", "--from", "--worst"]),
    (
        "explore",
        &["--start", "--marker", "--choices", "--max-darts", "--full", "--doors", "--map", "--svg"],
    ),
    ("compare", &["--marker", "--start", "--walk", "--html", "--json"]),
    (
        "counterexample",
        &["--marker", "--class", "--edges", "--all", "--out", "--html", "--expect", "--atlas"],
    ),
    ("draw", &["--start", "--marker", "--out", "--format"]),
    ("paper", &["--section", "--open", "--json"]),
    ("proofs", &["--run", "--choices", "--engine", "--json"]),
    ("calibrate", &["--out", "--start", "--mirror-radius", "--picture", "--mask-out", "--json"]),
    ("train", &["--images", "--labels", "--stripe-width", "--folds", "marker (0,0,255)", "--json"]),
    ("sense", &["--calibration", "--colours", "--stages", "--json", "--out"]),
    ("evaluate", &["vision", "control", "runs"]),
    (
        "simulate",
        &[
            "--start",
            "--seed",
            "--by-scene",
            "--fault",
            "--noise",
            "--log",
            "--html",
            "blocked",
            ".mcap",
            "--ros",
            "--speed",
        ],
    ),
    (
        "drive",
        &["--ros", "--calibration", "--log", "--map", "/cmd_vel", "conform", "--features ros1"],
    ),
    (
        "render",
        &["--pose", "--out", "--calibration", "--size", "--look", "--effects", "--labels", "vinyl"],
    ),
    ("info", &["--mapping", "--write-mapping", "--json"]),
    (
        "conform",
        &["--world", "--start", "--driver", "--quirks", "--minimise", "--html", "--json", "any"],
    ),
    ("replay", &["--calibration", "--colours", "--mapping", "--map", "--json"]),
    ("completions", &[]),
];

#[test]
fn the_help_of_every_verb_has_its_flags_and_an_example_of_it() {
    for (verb, flags) in VERBS {
        let help = said([verb, "--help"]);
        assert!(help.contains("Example"), "{help}");
        assert!(help.contains(&format!("  toposlam {verb} ")), "{help}");
        assert!(flags.iter().all(|flag| help.contains(flag)), "{help}");
        assert!(help.lines().all(|line| line.chars().count() <= 100), "{help}");
    }
}

#[test]
fn toposlam_alone_prints_its_verbs() {
    let help = said::<&str>([]);
    assert!(VERBS.iter().all(|(verb, _)| help.contains(&format!("\n  {verb} "))), "{help}");
}

#[test]
fn every_shell_has_completions_of_every_verb() {
    for shell in ["bash", "zsh", "fish"] {
        let script = said(["completions", shell]);
        assert!(VERBS.iter().all(|(verb, _)| script.contains(verb)), "{shell}");
    }
}

#[test]
fn the_paper_is_listed() {
    assert!(run(["paper"]).stdout.starts_with(b"Section 2\n"));
}

#[test]
fn a_reader_who_leaves_early_is_no_panic() {
    let verbs: [&[&str]; 6] = [
        &["explore", "worlds/building-25.toml", "--full"],
        &["explore", "worlds/building-25.toml", "--json"],
        &["check", "--json", "--edges", "1..=5"],
        &["draw", "worlds/building-25.toml"],
        &["paper"],
        &["proofs"],
    ];
    for verb in verbs {
        let mut command = toposlam();
        let mut child =
            command.args(verb).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut out = child.stdout.take().unwrap();
        out.read_exact(&mut [0; 8]).unwrap();
        drop(out);
        let output = child.wait_with_output().unwrap();
        let message = stderr(&output);
        assert!(!message.contains("panicked") && !message.contains("error"), "{message}");
        assert!(output.status.code().is_some(), "{verb:?}");
    }
}

#[test]
fn a_check_that_nobody_hears_does_not_hold() {
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let status = toposlam().args(["check", "--json", "--edges", "1"]).stdout(writer).status();
    assert_eq!(status.unwrap().code(), Some(3));
}
