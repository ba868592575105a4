//! Help, manual pages, completions, the width of the output, and a reader that stops early.

use std::{io::Read, process::Stdio};

#[path = "../../examples/manual.rs"]
#[expect(dead_code, reason = "an example is a program")]
mod manual;

use super::{exit_codes, folder, run, stderr, stdout, stdout_of, toposlam};

const VERBS: [(&str, &[&str]); 13] = [
    (
        "check",
        &[
            "--edges",
            "--class",
            "--marker",
            "--choices",
            "--shard",
            "--from",
            "--worst",
            "--explorer",
            "--add",
            "--journal",
            "--estimate",
            "--hosts",
            "--process",
        ],
    ),
    (
        "explore",
        &["--start", "--marker", "--choices", "--max-darts", "--full", "--doors", "--map", "--svg"],
    ),
    ("compare", &["--marker", "--start", "--walk", "--html", "--json"]),
    (
        "counterexample",
        &[
            "--marker",
            "--class",
            "--max-edges",
            "--all",
            "--out-dir",
            "--html",
            "--expect",
            "--atlas",
            "--hosts",
        ],
    ),
    (
        "draw",
        &[
            "--start",
            "--marker",
            "--out",
            "--format",
            "--pose",
            "--calibration",
            "--size",
            "--look",
            "--effects",
            "--with-marker",
            "--labels",
        ],
    ),
    ("play", &["--random", "--edges", "--class", "--seed", "--start", "--out"]),
    ("proofs", &["--run", "--choices", "--engine", "--json"]),
    ("camera", &["calibrate", "train"]),
    ("sense", &["--calibration", "--colours", "--stages", "--json", "--out"]),
    (
        "simulate",
        &[
            "--start",
            "--seed",
            "--sensor",
            "--scanner",
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
    ("info", &["--topics", "--write-topics", "--json"]),
    (
        "conform",
        &[
            "--rerun",
            "--world",
            "--start",
            "--driver",
            "--max-steps",
            "--quirks",
            "--require-coverage",
            "--map",
            "--minimise",
            "--html",
            "--json",
            "any",
        ],
    ),
];

#[test]
fn the_help_of_every_verb_has_its_flags_and_an_example_of_it() {
    for (verb, flags) in VERBS {
        let help = stdout_of([verb, "--help"]);
        assert!(help.contains("Example"), "{help}");
        assert!(help.contains(&format!("  toposlam {verb} ")), "{help}");
        assert!(flags.iter().all(|flag| help.contains(flag)), "{help}");
        assert!(help.lines().all(|line| line.chars().count() <= 80), "{help}");
    }
}

#[test]
fn no_line_is_wider_than_80_columns() {
    let folder = folder("width");
    let file = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let [page, map, log] = ["page.html", "map.toml", "run.mcap"].map(file);
    let case = ["proofs", "--run", "the_way_back", "--choices", "2,2,1,1,1,0,0,1,2,1,1,0"];
    let runs: [&[&str]; 27] = [
        &[],
        &["check", "--edges", "1..=4"],
        &["check", "--edges", "6", "--estimate", "--probes", "50"],
        &["check", "--edges", "1..=4", "--choices", "all"],
        &["check", "--marker", "movable", "--class", "corridor"],
        &["check", "--from", "worlds/building-25.toml"],
        &["explore", "worlds/building-25.toml", "--full", "--doors"],
        &["explore", "worlds/building-25.toml", "--marker", "movable"],
        &["explore", "worlds/shape-8.toml", "--choices", "all", "--map", &map],
        &["explore", "worlds/shape-6.toml", "--max-darts", "3"],
        &["compare", "worlds/figure-1a.toml", "worlds/figure-1b.toml", "--walk", "0,1,1"],
        &["compare", "worlds/figure-1a.toml", "worlds/figure-1b.toml", "--marker", "undirected"],
        &["compare", "worlds/cycle-3.toml", "worlds/cycle-4.toml", "--marker", "two-distinct"],
        &["compare", "worlds/k4-plane.toml", "worlds/k4-plane.toml", "--html", &page],
        &["counterexample", "--max-edges", "6"],
        &["counterexample", "--max-edges", "4", "--all"],
        &["counterexample", "--marker", "undirected", "--class", "corridor", "--max-edges", "7"],
        &["counterexample", "--marker", "directional", "--max-edges", "5"],
        &["proofs"],
        &case,
        &["proofs", "--run", "the_way_back"],
        &["simulate", "worlds/shape-6.toml", "--by-scene", "--log", &log],
        &["info", &log],
        &["conform", &log, "--world", "worlds/shape-6.toml"],
        &["conform", &log, "--world", "worlds/shape-8.toml"],
        &["conform", &log],
        &["conform", "--rerun", &log],
    ];
    for arguments in runs {
        for line in stdout(&run(arguments)).lines() {
            // The length of a path is not ours to limit.
            let line = line.replace(&log, "run.mcap");
            assert!(line.chars().count() <= 80, "{arguments:?}: {line}");
        }
    }
    for (verb, _) in VERBS {
        for help in ["-h", "--help"] {
            for line in stdout_of([verb, help]).lines() {
                assert!(line.chars().count() <= 80, "{verb}: {line}");
            }
        }
    }
}

#[test]
fn toposlam_alone_prints_its_verbs() {
    let help = stdout_of::<&str>([]);
    assert!(VERBS.iter().all(|(verb, _)| help.contains(&format!("\n  {verb} "))), "{help}");
}

#[test]
fn the_help_of_every_verb_ends_with_its_exit_codes() {
    let parts = ["camera calibrate", "camera train"];
    let verbs = VERBS.iter().map(|(verb, _)| *verb).chain(parts).chain([""]);
    // The verbs that work on what they are given, and have no verdict.
    let without_verdict =
        ["compare", "draw", "play", "camera", "camera calibrate", "camera train", "sense"];
    for verb in verbs {
        let words: Vec<_> = verb.split(' ').filter(|word| !word.is_empty()).collect();
        for help in ["-h", "--help"] {
            let codes = exit_codes(&stdout_of([&words[..], &[help]].concat()));
            assert!(codes.contains_key(&0) && codes.contains_key(&2), "{verb}: {codes:?}");
            assert!(codes.keys().all(|code| (0..=3).contains(code)), "{verb}: {codes:?}");
            assert!(codes.values().all(|meaning| meaning.len() > 8), "{verb}: {codes:?}");
            assert_eq!(codes.contains_key(&1), !without_verdict.contains(&verb), "{verb}");
        }
    }
}

/// The pages of `examples/manual.rs`.
#[test]
fn there_is_a_manual_page_of_every_verb_and_a_completion_for_every_shell() {
    let folder = folder("manual");
    manual::write(&folder).unwrap();
    let (pages, completions) = (folder.join("man"), folder.join("completions"));
    let main = std::fs::read_to_string(pages.join("toposlam.1")).unwrap();
    for (verb, _) in VERBS {
        let page = std::fs::read_to_string(pages.join(format!("toposlam-{verb}.1"))).unwrap();
        let sections = ["NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "NOTES", "\"EXIT STATUS\""];
        for section in sections {
            assert!(page.contains(&format!("\n.SH {section}\n")), "{section}: {page}");
        }
        assert!(page.contains("\n  2  bad usage"), "{page}");
        assert!(main.contains(&format!("toposlam\\-{verb}(1)")), "{main}");
    }
    assert!(pages.join("toposlam-camera-train.1").is_file());
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = completions.join(format!("toposlam.{shell}"));
        let script = std::fs::read_to_string(script).unwrap();
        assert!(VERBS.iter().all(|(verb, _)| script.contains(verb)), "{shell}");
    }
}

/// The program that formats the pages for `man` finds no fault in them.
#[test]
fn the_manual_pages_are_well_formed() {
    let folder = folder("manual_pages");
    manual::write(&folder).unwrap();
    for entry in std::fs::read_dir(folder.join("man")).unwrap() {
        // Without overstriking.
        let options = ["-man", "-ww", "-Tascii", "-rLL=80n", "-P-cbou"];
        let mut groff = std::process::Command::new("groff");
        let Ok(output) = groff.args(options).arg(entry.unwrap().path()).output() else {
            eprintln!("skipped: there is no groff");
            return;
        };
        assert_eq!(stderr(&output), "");
        assert!(stdout(&output).contains("\nEXIT STATUS\n"));
    }
}

#[test]
fn a_reader_that_stops_early_causes_no_panic() {
    let verbs: [&[&str]; 5] = [
        &["explore", "worlds/building-25.toml", "--full"],
        &["explore", "worlds/building-25.toml", "--json"],
        &["check", "--json", "--edges", "1..=5"],
        &["draw", "worlds/building-25.toml"],
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

/// The exit code and the messages of a command whose standard output is closed.
fn without_a_reader(command: &[&str]) -> (Option<i32>, String) {
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let output = toposlam().args(command).stdout(writer).output().unwrap();
    (output.status.code(), stderr(&output))
}

#[test]
fn a_list_or_a_report_of_finished_work_without_a_reader_is_no_error() {
    let commands: [&[&str]; 6] = [
        &[],
        &["proofs", "--json"],
        &["draw", "worlds/building-25.toml"],
        &["explore", "worlds/building-25.toml", "--full"],
        &["compare", "worlds/cycle-3.toml", "worlds/cycle-4.toml", "--marker", "none"],
        &["info", "fuzz/corpus/mcap/of-a-run"],
    ];
    for command in commands {
        assert_eq!(without_a_reader(command), (Some(0), String::new()), "{command:?}");
    }
    // A failure stays one.
    let wrong = ["explore", "worlds/shape-6.toml", "--max-darts", "3"];
    assert_eq!(without_a_reader(&wrong), (Some(3), String::new()));
}

#[test]
fn without_a_reader_a_check_stops_and_does_not_hold_unless_a_file_is_to_be_written() {
    let check = ["check", "--json", "--edges", "1..=5"];
    assert_eq!(without_a_reader(&check), (Some(3), String::new()));
    let folder = folder("without_a_reader");
    let file = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let [worst, page, map, log, run] =
        ["worst.toml", "page.html", "map.toml", "run.mcap", "run.html"].map(file);
    let worlds = ["worlds/cycle-3.toml", "worlds/cycle-4.toml"];
    let commands: [(Vec<&str>, &[&String]); 4] = [
        ([&check[..], &["--worst", &worst]].concat(), &[&worst]),
        ([&["compare"], &worlds[..], &["--marker", "none", "--html", &page]].concat(), &[&page]),
        (vec!["explore", "worlds/shape-8.toml", "--map", &map], &[&map]),
        (
            vec!["simulate", "worlds/shape-6.toml", "--by-scene", "--log", &log, "--html", &run],
            &[&log, &run],
        ),
    ];
    for (command, files) in commands {
        let (code, _) = without_a_reader(&command);
        assert_eq!(code, Some(0), "{command:?}");
        for file in files {
            assert!(std::fs::metadata(file).unwrap().len() > 100, "{file}");
        }
    }
    stdout_of(["conform", &log, "--world", "worlds/shape-6.toml"]);
}
