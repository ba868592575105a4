//! Help, manual pages, completions, the width of the output, and a reader that stops early.

#[path = "../../examples/manual.rs"]
#[expect(dead_code, reason = "an example is a program")]
mod manual;

use std::{
    io::Read,
    process::{Command, Stdio},
};

use super::{Scratch, exit_codes, names_in, stderr, stdout};

/// The commands with a verdict, those that work on their input and have none, and those below another one.
const WITH_VERDICT: [&str; 8] =
    ["check", "explore", "counterexample", "proofs", "simulate", "drive", "info", "conform"];
const OTHERS: [&str; 5] = ["compare", "draw", "play", "camera", "sense"];
const PARTS: [&str; 2] = ["camera calibrate", "camera train"];

#[test]
fn the_help_of_every_verb_has_an_example_its_exit_codes_and_80_columns() {
    let scratch = Scratch::new("help");
    let all = scratch.out("", 0);
    for verb in WITH_VERDICT.iter().chain(&OTHERS).chain(&PARTS).chain(&[""]) {
        let is_command = WITH_VERDICT.contains(verb) || OTHERS.contains(verb);
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
            let has_verdict = WITH_VERDICT.contains(verb) || verb.is_empty();
            assert_eq!(codes.contains_key(&1), has_verdict, "{verb}");
        }
    }
}

/// Of the snapshots, and of a few more commands; messages may be wider.
#[test]
fn no_line_is_wider_than_80_columns() {
    let scratch = Scratch::new("width");
    let fits = |text: &str| text.lines().all(|line| line.chars().count() <= 80);
    let folders = names_in(&scratch.path("tests/snapshots")).into_iter();
    for folder in folders.map(|name| format!("tests/snapshots/{name}")) {
        for file in names_in(&scratch.path(&folder)).iter().filter(|name| name.contains(".trycmd"))
        {
            for call in scratch.text(&format!("{folder}/{file}")).split("\n$ ").skip(1) {
                let (command, printed) = call.split_once('\n').unwrap();
                let is_text = !printed.starts_with("? 2") && !command.contains("--json");
                assert!(!is_text || fits(printed), "{call}");
            }
        }
    }
    for line in [
        "check --marker movable --class corridor",
        "explore worlds/building-25.toml --story",
        "explore worlds/building-25.toml --marker movable",
        "compare worlds/cycle-3.toml worlds/cycle-4.toml --marker two-distinct",
        "proofs",
        "simulate worlds/building-25.toml --by-scene --log run.mcap",
        "info run.mcap fuzz/corpus/mcap/lz4",
        "conform run.mcap --world worlds/shape-8.toml",
        "conform run.mcap",
        "conform --rerun run.mcap",
    ] {
        let printed = stdout(&scratch.run(line));
        assert!(fits(&printed), "{line}: {printed}");
    }
}

/// The pages of `examples/manual.rs`. The program that formats them for `man` finds no fault in them.
#[test]
fn there_is_a_manual_page_of_every_verb_and_a_completion_for_every_shell() {
    let scratch = Scratch::new("manual");
    manual::write(&scratch.0).unwrap();
    let main = scratch.text("man/toposlam.1");
    let verbs = || WITH_VERDICT.iter().chain(&OTHERS);
    for verb in verbs() {
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
        assert!(verbs().all(|verb| script.contains(verb)), "{shell}");
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

/// A list or a report of finished work without a reader is no error. A check stops, and does not hold, unless a
/// file is to be written.
#[test]
fn the_exit_code_without_a_reader() {
    let scratch = Scratch::new("without_a_reader");
    for (line, code, files) in [
        ("", 0, ""),
        ("proofs --json", 0, ""),
        ("draw worlds/building-25.toml", 0, ""),
        ("explore worlds/building-25.toml --story", 0, ""),
        ("explore worlds/building-25.toml --json", 0, ""),
        ("compare worlds/cycle-3.toml worlds/cycle-4.toml --marker none", 0, ""),
        ("info fuzz/corpus/mcap/of-a-run", 0, ""),
        ("explore worlds/shape-6.toml --max-darts 3", 3, ""),
        ("check --json --edges 1..=5", 3, ""),
        ("check --json --edges 1..=5 --worst worst.toml", 0, "worst.toml"),
        (
            "proofs --run the_way_back --report proofs.xml --report proofs.sarif",
            0,
            "proofs.xml proofs.sarif",
        ),
        ("compare worlds/cycle-3.toml worlds/cycle-4.toml --html page.html", 0, "page.html"),
        ("explore worlds/shape-8.toml --map map.toml", 0, "map.toml"),
        (
            "simulate worlds/shape-6.toml --by-scene --log run.mcap --html run.html",
            0,
            "run.mcap run.html",
        ),
    ] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = scratch.command(line).stdout(writer).output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{line}: {}", stderr(&output));
        assert!(!files.is_empty() || output.stderr.is_empty(), "{line}: {}", stderr(&output));
        for file in files.split_whitespace() {
            assert!(scratch.bytes(file).len() > 100, "{file}");
        }
        // A reader that stops early causes no panic either.
        let mut command = scratch.command(line);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut out = child.stdout.take().unwrap();
        let _ = out.read(&mut [0; 8]).unwrap();
        drop(out);
        let output = child.wait_with_output().unwrap();
        let message = stderr(&output);
        assert!(!message.contains("panicked") && !message.contains("error"), "{message}");
        assert!(output.status.code().is_some(), "{line}");
    }
    scratch.out("conform run.mcap --world worlds/shape-6.toml", 0);
}
