//! Options of every verb: `--version`, `--color`, `-o`, and commands and options that have another name now. `--quiet`
//! and `-` for standard input are in `tests/facts/input.txt`.

use std::fs;

use toposlam_logs::{entries::Content, reader::Log, topic_map::TopicMap};

use super::{Scratch, names_in, stderr, stdout};

/// The standard output of a successful run with a file as its standard input.
fn printed(scratch: &Scratch, line: &str, file: &str) -> String {
    let file = fs::File::open(scratch.path(file)).unwrap();
    let output = scratch.command(line).stdin(file).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{line}: {}", stderr(&output));
    stdout(&output)
}

#[test]
fn the_version_is_that_of_the_package_with_the_revision_of_the_build() {
    let scratch = Scratch::new("version");
    let version = scratch.out("--version", 0);
    let package = version.trim_end().split('+').next().unwrap();
    assert_eq!(package, concat!("toposlam ", env!("CARGO_PKG_VERSION")));
    assert_eq!(version, scratch.out("-V", 0));
}

#[test]
fn old_commands_and_options_work_or_are_refused_with_their_new_names() {
    let scratch = Scratch::new("old_names");
    let render = "render worlds/shape-6.toml --size 640x480 -o view.png";
    for (line, message, code) in [
        (render, "`render` is now `draw --pose=start`\n", 0),
        (&format!("{render} --pose 0,2,90"), "`render` is now `draw --pose=start`\n", 0),
        ("--color never calibrate --help", "", 0),
        ("merge no.jsonl", "error: no.jsonl: ", 2),
        ("replay no.mcap", "error: no.mcap: ", 2),
        ("paper", "error: paper: this command is gone; see docs/paper.md\n", 2),
    ] {
        let output = scratch.command(line).output().unwrap();
        let all = stderr(&output);
        assert!(all.contains(message), "{all}");
        assert_eq!(output.status.code(), Some(code), "{all}");
    }
    for (verb, rest, old, new) in [
        ("check", "4", "--max-edges", "--edges"),
        ("counterexample", "4", "--edges", "--max-edges"),
        ("counterexample", "x", "--out", "--out-dir"),
        ("conform", "30 x.mcap", "--edges", "--max-edges"),
        ("camera calibrate", "x.toml x.png", "--start", "--initial"),
    ] {
        let message = scratch.error(&format!("{verb} {old} {rest}"));
        assert!(message.starts_with(&format!("error: unexpected argument '{old}")), "{message}");
        assert!(message.contains(new), "{message}");
        let help = scratch.out(&format!("{verb} --help"), 0);
        assert!(!help.contains(&format!(" {old} ")) && help.contains(new), "{help}");
    }
    // -o is --out or --out-dir in every verb.
    for (verb, long) in [
        ("counterexample", "--out-dir <DIR>"),
        ("draw", "--out <FILE>"),
        ("camera calibrate", "--out <FILE>"),
        ("camera train", "--out <FILE>"),
        ("sense", "--out <FILE>"),
    ] {
        let help = scratch.out(&format!("{verb} --help"), 0);
        assert!(help.contains(&format!("-o, {long}")), "{help}");
    }
}

#[test]
fn colours_are_used_if_they_are_asked_for_and_not_in_a_pipe() {
    let scratch = Scratch::new("colours");
    for line in ["chekc", "explore missing.toml", "check --edges x"] {
        let message = |more: &str, no_color: &str| {
            let mut command = scratch.command(&format!("{line} {more}"));
            stderr(&command.env("NO_COLOR", no_color).output().unwrap())
        };
        let plain = message("", "");
        assert!(plain.starts_with("error: "), "{plain}");
        assert_eq!(message("--color never", ""), plain);
        assert_eq!(message("--color=auto", "1"), plain);
        let coloured = message("--color always", "");
        assert!(coloured.starts_with("\u{1b}[") && coloured.contains("error:"), "{coloured:?}");
        assert_eq!(message("--color=always", "1"), coloured);
    }
    for (choice, coloured) in [("always", true), ("auto", false), ("never", false)] {
        let help = scratch.out(&format!("check --help --color {choice}"), 0);
        assert_eq!(help.contains('\u{1b}'), coloured, "{choice}");
    }
}

#[test]
fn colours_and_their_images_can_come_from_standard_input() {
    let scratch = Scratch::new("image_from_standard_input");
    let world = "worlds/shape-6.toml";
    scratch.out(&format!("draw {world} --pose start --size 640x480 -o v.png"), 0);
    scratch.write("c.toml", scratch.out("camera calibrate v.png", 0));
    // The colours are those in the log of a short run.
    scratch.out(&format!("simulate {world} --max-darts 3 --log run.mcap"), 3);
    let log = Log::open(&scratch.path("run.mcap")).unwrap();
    let bound = TopicMap::unambiguous(&log).bind(&log).unwrap();
    let run = log.entries(&bound).find_map(|entry| match entry.unwrap().content {
        Content::Run(run) => Some(run),
        _ => None,
    });
    scratch.write("colours.toml", run.unwrap().colours);
    let sense = "sense v.png --calibration c.toml --colours colours.toml";
    let expected = scratch.out(sense, 0);
    for input in ["v.png", "c.toml", "colours.toml"] {
        let read = printed(&scratch, &sense.replace(input, "-"), input);
        assert_eq!(read.replace("-\n", "v.png\n"), expected, "{input}");
    }
    printed(&scratch, &format!("{} --stages steps", sense.replace("v.png", "-")), "v.png");
    let names = names_in(&scratch.path("steps"));
    assert!(names.iter().all(|name| name.starts_with("stdin-")), "{names:?}");
}

/// Ctrl-C ends each verb with 3, also while it reads.
#[cfg(unix)]
#[test]
fn a_verb_that_is_interrupted_ends_with_3() {
    for line in [
        "draw -",
        "explore -",
        "camera calibrate -",
        "sense x.png --calibration - --colours x.toml",
    ] {
        let output = super::interrupted(line);
        assert_eq!(output.status.code(), Some(3), "{line} {}", stderr(&output));
        assert_eq!(stderr(&output), "interrupted\n");
    }
}
