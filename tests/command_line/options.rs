//! Options of every verb: `--version`, `--quiet`, `--color`, `-o`, `-` for standard input, and options that
//! have another name now.

use std::{
    fs,
    path::Path,
    process::{Command, Output, Stdio},
};

use super::{Scratch, objects, stderr, stdout};

/// Runs the program with a file as its standard input.
fn with_input(scratch: &Scratch, line: &str, file: &str) -> Output {
    scratch.command(line).stdin(fs::File::open(scratch.path(file)).unwrap()).output().unwrap()
}

/// The standard output of a successful run with a file as its standard input.
fn printed(scratch: &Scratch, line: &str, file: &str) -> String {
    let output = with_input(scratch, line, file);
    assert_eq!(output.status.code(), Some(0), "{line}: {}", stderr(&output));
    stdout(&output)
}

#[test]
fn the_version_is_that_of_the_package_with_the_revision_of_the_build() {
    let scratch = Scratch::new("version");
    let version = scratch.out("--version", 0);
    let version = version.trim_end().strip_prefix("toposlam ").unwrap();
    let package = version.split_once('+').map_or(version, |(package, _)| package);
    assert_eq!(package, env!("CARGO_PKG_VERSION"));
    assert_eq!(version, scratch.out("-V", 0).trim_end().strip_prefix("toposlam ").unwrap());
}

#[test]
fn an_old_command_works_and_says_its_new_name() {
    let scratch = Scratch::new("old_commands");
    let now = "`render` is now `draw --pose=start`\n";
    let render = "render worlds/shape-6.toml --size 640x480 -o view.png";
    for (line, message, code) in [
        (render, now, 0),
        (&format!("{render} --pose 0,2,90"), now, 0),
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
}

#[test]
fn a_quiet_verb_prints_only_errors_on_standard_error() {
    let scratch = Scratch::new("quiet");
    for line in [
        "check --edges 3",
        "simulate worlds/building-12.toml --by-scene",
        "counterexample --marker directional --max-edges 4 --html page.html",
        "proofs --run the_way_back",
    ] {
        let [usual, quiet] = ["", "--quiet"].map(|option| scratch.run(&format!("{line} {option}")));
        assert_eq!((usual.status.code(), quiet.status.code()), (Some(0), Some(0)), "{line}");
        assert_eq!(stderr(&quiet), "", "{line}");
        if line.starts_with("check") {
            assert!(stderr(&usual).contains(" threads\n"), "{}", stderr(&usual));
            assert_eq!(usual.stdout, quiet.stdout);
            assert_eq!(scratch.run(&format!("-q {line}")).stdout, quiet.stdout);
        }
    }
    assert!(scratch.error("explore missing.toml -q").starts_with("error: missing.toml: "));
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
fn an_option_with_another_name_now_is_refused_with_its_new_name() {
    let scratch = Scratch::new("other_names");
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
}

#[test]
fn the_option_o_is_out_or_out_dir_in_every_verb() {
    let scratch = Scratch::new("option_o");
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
fn a_world_can_come_from_standard_input() {
    let scratch = Scratch::new("world_from_standard_input");
    let world = "worlds/shape-6.toml";
    let from = format!("\"from\":\"{world}\"");
    for line in [
        "explore - --json",
        "draw -",
        "check --from - --json",
        "compare - worlds/shape-8.toml",
        "compare worlds/shape-8.toml - --json",
    ] {
        let named = line.split(' ').map(|word| if word == "-" { world } else { word });
        let expected = scratch.out(&named.collect::<Vec<_>>().join(" "), 0);
        // A check names the file.
        let printed = printed(&scratch, line, world).replace("\"from\":\"-\"", &from);
        assert_eq!(printed, expected, "{line}");
    }
    printed(&scratch, "simulate - --by-scene", world);
    // Without a name of its own, the world has that of the input.
    scratch.write("w.toml", "[clockwise]\na = [\"b\"]\nb = [\"a\"]\n");
    let dot = printed(&scratch, "draw - --format dot", "w.toml");
    assert!(dot.starts_with("graph \"stdin\" {"), "{dot}");
    let wrong = with_input(&scratch, "explore -", "worlds/README.md");
    assert!(stderr(&wrong).starts_with("error: -: line "), "{}", stderr(&wrong));
}

#[test]
fn a_log_can_come_from_standard_input() {
    let scratch = Scratch::new("log_from_standard_input");
    let world = "worlds/shape-6.toml";
    scratch.out(&format!("simulate {world} --by-scene --log run.mcap"), 0);
    let conform = format!("conform - --world {world} --html page.html");
    let text = printed(&scratch, &conform, "run.mcap");
    assert!(text.starts_with("-: conforms\n"), "{text}");
    // The page has the hash of what was read.
    if let Ok(hash) = Command::new("sha256sum").arg(scratch.path("run.mcap")).output() {
        let hash = stdout(&hash);
        assert!(scratch.text("page.html").contains(hash.split(' ').next().unwrap()), "{hash}");
    }
    let text = printed(&scratch, "conform run.mcap --world -", world);
    assert!(text.contains(": conforms\n"), "{text}");
    let of_file = scratch.last("info run.mcap", 0);
    let of_input = objects(&printed(&scratch, "info - --json --verify", "run.mcap"));
    assert_eq!(of_file["topics"], of_input[0]["topics"]);
    assert_eq!(of_input[0]["verification"]["holds"], true);
    assert!(printed(&scratch, "conform --rerun -", "run.mcap").contains("the map is complete"));
}

#[test]
fn images_calibrations_and_colours_can_come_from_standard_input() {
    let scratch = Scratch::new("image_from_standard_input");
    let world = "worlds/shape-6.toml";
    scratch.out(&format!("draw {world} --pose start --size 640x480 -o v.png"), 0);
    assert_eq!(printed(&scratch, "draw - --pose start --size 640x480 -o w.png", world), "");
    assert!(scratch.bytes("v.png") == scratch.bytes("w.png"));
    let calibration = scratch.out("camera calibrate v.png", 0);
    assert_eq!(printed(&scratch, "camera calibrate -", "v.png"), calibration);
    scratch.write("c.toml", calibration);
    let initial = printed(&scratch, "camera calibrate v.png --initial -", "c.toml");
    assert_eq!(initial, scratch.text("c.toml"));
    // The colours are those in the log of a short run.
    scratch.out(&format!("simulate {world} --max-darts 3 --log run.mcap"), 3);
    scratch.write("colours.toml", colours_of(&scratch.path("run.mcap")));
    let sense = "sense v.png --calibration c.toml --colours colours.toml";
    let expected = scratch.out(sense, 0);
    for input in ["v.png", "c.toml", "colours.toml"] {
        let read = printed(&scratch, &sense.replace(input, "-"), input);
        assert_eq!(read.replace("-\n", "v.png\n"), expected, "{input}");
    }
    printed(&scratch, &format!("{} --stages steps", sense.replace("v.png", "-")), "v.png");
    let names = super::names_in(&scratch.path("steps"));
    assert!(names.iter().all(|name| name.starts_with("stdin-")), "{names:?}");
}

/// The colours of the building, as the head of a log has them.
fn colours_of(log: &Path) -> String {
    use toposlam_logs::{entries::Content, reader::Log, topic_map::TopicMap};
    let log = Log::open(log).unwrap();
    let mapping = TopicMap::unambiguous(&log);
    let bound = mapping.bind(&log).unwrap();
    let mut entries = log.entries(&bound).map(Result::unwrap);
    entries
        .find_map(|entry| match entry.content {
            Content::Run(run) => Some(run.colours),
            _ => None,
        })
        .unwrap()
}

#[test]
fn standard_input_is_one_input_and_no_output() {
    let scratch = Scratch::new("one_standard_input");
    let (world, log) = ("worlds/shape-6.toml", "fuzz/corpus/mcap/of-a-run");
    for (line, input) in [("compare - -", world), ("conform - --world -", world), ("info - -", log)]
    {
        let output = with_input(&scratch, line, input);
        let cause =
            "error: -: standard input is one input; give the path of a file for the others\n";
        assert_eq!((output.status.code(), &*stderr(&output)), (Some(2), cause));
    }
    // A pipe that is closed before it is read is an empty file.
    let mut program = scratch.command("explore -");
    let program = program.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = program.spawn().unwrap();
    drop(child.stdin.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(stderr(&output), "error: -: the file is empty\n");
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
