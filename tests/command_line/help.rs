//! Help, manual pages, completions, the width of the output, and a reader that stops early.

#[path = "../../examples/manual.rs"]
#[expect(dead_code, reason = "an example is a program")]
mod manual;

use std::{
    io::Read,
    process::{Command, Stdio},
};

use super::{Scratch, exit_codes, names_in, stderr, stdout};

/// The commands, and those below another one.
const VERBS: [&str; 13] = [
    "check",
    "explore",
    "compare",
    "counterexample",
    "draw",
    "play",
    "proofs",
    "camera",
    "sense",
    "simulate",
    "drive",
    "info",
    "conform",
];
const PARTS: [&str; 2] = ["camera calibrate", "camera train"];

/// These work on their input and have no verdict.
const WITHOUT_VERDICT: [&str; 7] =
    ["compare", "draw", "play", "camera", "camera calibrate", "camera train", "sense"];

#[test]
fn the_help_of_every_verb_has_an_example_its_exit_codes_and_80_columns() {
    let scratch = Scratch::new("help");
    let all = scratch.out("", 0);
    for verb in VERBS.into_iter().chain(PARTS).chain([""]) {
        let is_command = VERBS.contains(&verb);
        assert!(!is_command || all.contains(&format!("\n  {verb} ")), "{all}");
        for option in ["-h", "--help"] {
            let help = scratch.out(&format!("{verb} {option}"), 0);
            assert!(help.lines().all(|line| line.chars().count() <= 80), "{help}");
            let example = help.contains("Example") && help.contains(&format!("  toposlam {verb} "));
            assert!(!is_command || example, "{help}");
            let codes = exit_codes(&help);
            assert!(codes.contains_key(&0) && codes.contains_key(&2), "{verb}: {codes:?}");
            assert!(codes.keys().all(|code| (0..=3).contains(code)), "{verb}: {codes:?}");
            assert!(codes.values().all(|meaning| meaning.len() > 8), "{verb}: {codes:?}");
            assert_eq!(codes.contains_key(&1), !WITHOUT_VERDICT.contains(&verb), "{verb}");
        }
    }
}

#[test]
fn no_line_is_wider_than_80_columns() {
    let scratch = Scratch::new("width");
    for line in [
        "check --edges 1..=4",
        "check --edges 7 --shard 1/64",
        "check --edges 6 --estimate --probes 50",
        "check --edges 1..=4 --choices all",
        "check --marker movable --class corridor",
        "check --from worlds/building-25.toml",
        "explore worlds/building-25.toml --full --doors",
        "explore worlds/building-25.toml --marker movable",
        "explore worlds/building-25.toml --algorithm folding",
        "explore worlds/shape-8.toml --choices all --map map.toml",
        "explore worlds/shape-6.toml --max-darts 3",
        "compare worlds/figure-1a.toml worlds/figure-1b.toml --walk 0,1,1",
        "compare worlds/figure-1a.toml worlds/figure-1b.toml --marker undirected",
        "compare worlds/cycle-3.toml worlds/cycle-4.toml --marker two-distinct",
        "compare worlds/k4-plane.toml worlds/k4-plane.toml --html page.html",
        "counterexample --max-edges 6",
        "counterexample --max-edges 4 --all",
        "counterexample --marker undirected --class corridor --max-edges 7",
        "counterexample --marker directional --max-edges 5",
        "proofs",
        "proofs --run the_way_back --choices 2,2,1,1,1,0,0,1,2,1,1,0",
        "proofs --run the_way_back",
        "simulate worlds/shape-6.toml --by-scene --log run.mcap",
        "info run.mcap fuzz/corpus/mcap/lz4",
        "conform run.mcap --world worlds/shape-6.toml",
        "conform run.mcap --world worlds/shape-8.toml",
        "conform run.mcap",
        "conform --rerun run.mcap",
    ] {
        for printed in stdout(&scratch.run(line)).lines() {
            assert!(printed.chars().count() <= 80, "{line}: {printed}");
        }
    }
}

/// The pages of `examples/manual.rs`. The program that formats them for `man` finds no fault in them.
#[test]
fn there_is_a_manual_page_of_every_verb_and_a_completion_for_every_shell() {
    let scratch = Scratch::new("manual");
    manual::write(&scratch.0).unwrap();
    let main = scratch.text("man/toposlam.1");
    for verb in VERBS {
        let page = scratch.text(&format!("man/toposlam-{verb}.1"));
        for section in ["NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "NOTES", "\"EXIT STATUS\""] {
            assert!(page.contains(&format!("\n.SH {section}\n")), "{section}: {page}");
        }
        assert!(page.contains("\n  2  bad usage"), "{page}");
        assert!(main.contains(&format!("toposlam\\-{verb}(1)")), "{main}");
    }
    assert!(scratch.path("man/toposlam-camera-train.1").is_file());
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = scratch.text(&format!("completions/toposlam.{shell}"));
        assert!(VERBS.iter().all(|verb| script.contains(verb)), "{shell}");
    }
    for page in names_in(&scratch.path("man")) {
        // Without overstriking.
        let options = ["-man", "-ww", "-Tascii", "-rLL=80n", "-P-cbou"];
        let mut groff = Command::new("groff");
        let Ok(output) = groff.args(options).arg(scratch.path("man").join(page)).output() else {
            eprintln!("skipped: there is no groff");
            return;
        };
        assert_eq!(stderr(&output), "");
        assert!(stdout(&output).contains("\nEXIT STATUS\n"));
    }
}

#[test]
fn a_reader_that_stops_early_causes_no_panic() {
    let scratch = Scratch::new("early");
    for line in [
        "explore worlds/building-25.toml --full",
        "explore worlds/building-25.toml --json",
        "check --json --edges 1..=5",
        "draw worlds/building-25.toml",
        "proofs",
    ] {
        let mut command = scratch.command(line);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut out = child.stdout.take().unwrap();
        out.read_exact(&mut [0; 8]).unwrap();
        drop(out);
        let output = child.wait_with_output().unwrap();
        let message = stderr(&output);
        assert!(!message.contains("panicked") && !message.contains("error"), "{message}");
        assert!(output.status.code().is_some(), "{line}");
    }
}

/// A list or a report of finished work without a reader is no error. A check stops, and does not hold, unless a
/// file is to be written.
#[test]
fn the_exit_code_without_a_reader() {
    let scratch = Scratch::new("without_a_reader");
    for (line, code, files) in [
        ("", 0, &[][..]),
        ("proofs --json", 0, &[]),
        ("draw worlds/building-25.toml", 0, &[]),
        ("explore worlds/building-25.toml --full", 0, &[]),
        ("compare worlds/cycle-3.toml worlds/cycle-4.toml --marker none", 0, &[]),
        ("info fuzz/corpus/mcap/of-a-run", 0, &[]),
        ("explore worlds/shape-6.toml --max-darts 3", 3, &[]),
        ("check --json --edges 1..=5", 3, &[]),
        ("check --json --edges 1..=5 --worst worst.toml", 0, &["worst.toml"]),
        (
            "compare worlds/cycle-3.toml worlds/cycle-4.toml --marker none --html page.html",
            0,
            &["page.html"],
        ),
        ("explore worlds/shape-8.toml --map map.toml", 0, &["map.toml"]),
        (
            "simulate worlds/shape-6.toml --by-scene --log run.mcap --html run.html",
            0,
            &["run.mcap", "run.html"],
        ),
    ] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = scratch.command(line).stdout(writer).output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{line}: {}", stderr(&output));
        assert!(!files.is_empty() || output.stderr.is_empty(), "{line}: {}", stderr(&output));
        for file in files {
            assert!(scratch.bytes(file).len() > 100, "{file}");
        }
    }
    scratch.out("conform run.mcap --world worlds/shape-6.toml", 0);
}
