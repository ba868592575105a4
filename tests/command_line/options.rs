//! Options of every verb: `--version`, `--quiet`, `--color`, `-o`, `-` for standard input, and options that
//! have another name now.

use std::{
    ffi::OsStr,
    fs,
    io::Write,
    path::Path,
    process::{Command, Output, Stdio},
};

use super::{folder, objects, run, stderr, stdout, stdout_of, toposlam};

const WORLD: &str = "worlds/shape-6.toml";

/// Runs the program with a file as its standard input.
fn with_input<A: AsRef<OsStr>>(arguments: impl IntoIterator<Item = A>, file: &Path) -> Output {
    let mut program = toposlam();
    program.args(arguments).stdin(fs::File::open(file).unwrap());
    program.output().unwrap()
}

/// The standard output of a successful run with a file as its standard input.
fn printed<A: AsRef<OsStr>>(arguments: impl IntoIterator<Item = A>, file: &Path) -> String {
    let output = with_input(arguments, file);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    stdout(&output)
}

#[test]
fn the_version_is_that_of_the_package_with_the_revision_of_the_build() {
    let version = stdout_of(["--version"]);
    let version = version.trim_end().strip_prefix("toposlam ").unwrap();
    let package = version.split_once('+').map_or(version, |(package, _)| package);
    assert_eq!(package, env!("CARGO_PKG_VERSION"));
    assert_eq!(version, stdout_of(["-V"]).trim_end().strip_prefix("toposlam ").unwrap());
}

#[test]
fn an_old_command_works_and_says_its_new_name() {
    let folder = folder("old_commands");
    let image = folder.join("view.png");
    let image = image.to_str().unwrap();
    let render = ["render", WORLD, "--size", "640x480", "-o", image];
    let calls: [(&[&str], &str, i32); 6] = [
        (&render, "`render` is now `draw --pose=start`\n", 0),
        (
            &[&render[..], &["--pose", "0,2,90"]].concat(),
            "`render` is now `draw --pose=start`\n",
            0,
        ),
        (&["--color", "never", "calibrate", "--help"], "", 0),
        (&["merge", "no.jsonl"], "error: no.jsonl: ", 2),
        (&["replay", "no.mcap"], "error: no.mcap: ", 2),
        (&["paper"], "error: paper: this command is gone; see docs/paper.md\n", 2),
    ];
    for (call, message, code) in calls {
        let output = run(call);
        let all = stderr(&output);
        assert!(all.contains(message), "{all}");
        assert_eq!(output.status.code(), Some(code), "{all}");
    }
}

#[test]
fn a_quiet_verb_prints_only_errors_on_standard_error() {
    let folder = folder("quiet");
    let page = folder.join("page.html");
    let calls: [(&[&str], i32); 4] = [
        (&["check", "--edges", "3"], 0),
        (&["simulate", "worlds/building-12.toml", "--by-scene"], 0),
        (
            &[
                "counterexample",
                "--marker",
                "directional",
                "--max-edges",
                "4",
                "--html",
                page.to_str().unwrap(),
            ],
            0,
        ),
        (&["proofs", "--run", "the_way_back"], 0),
    ];
    for (call, code) in calls {
        let usual = run(call);
        assert_eq!(usual.status.code(), Some(code), "{}", stderr(&usual));
        let quiet = run([call, &["--quiet"]].concat());
        assert_eq!((quiet.status.code(), stderr(&quiet)), (Some(code), String::new()), "{call:?}");
        if call[0] == "check" {
            assert!(stderr(&usual).contains(" threads\n"), "{}", stderr(&usual));
            assert_eq!(usual.stdout, quiet.stdout);
            assert_eq!(run([&["-q"], call].concat()).stdout, quiet.stdout);
        }
    }
    let wrong = run(["explore", "missing.toml", "-q"]);
    assert!(stderr(&wrong).starts_with("error: missing.toml: "), "{}", stderr(&wrong));
}

#[test]
fn colours_are_used_if_they_are_asked_for_and_not_in_a_pipe() {
    let errors: [&[&str]; 3] =
        [&["chekc"], &["explore", "missing.toml"], &["check", "--edges", "x"]];
    for call in errors {
        let message = |more: &[&str], no_color: &str| {
            let mut program = toposlam();
            let program = program.args(call).args(more).env("NO_COLOR", no_color);
            stderr(&program.output().unwrap())
        };
        let plain = message(&[], "");
        assert!(plain.starts_with("error: "), "{plain}");
        assert_eq!(message(&["--color", "never"], ""), plain);
        assert_eq!(message(&["--color=auto"], "1"), plain);
        let coloured = message(&["--color", "always"], "");
        assert!(coloured.starts_with("\u{1b}[") && coloured.contains("error:"), "{coloured:?}");
        assert_eq!(message(&["--color=always"], "1"), coloured);
    }
    let help = |choice| stdout_of(["check", "--help", "--color", choice]);
    assert!(help("always").contains('\u{1b}'));
    assert!(!help("auto").contains('\u{1b}') && !help("never").contains('\u{1b}'));
    let wrong = run(["check", "--color", "purple"]);
    assert_eq!(wrong.status.code(), Some(2));
    assert!(stderr(&wrong).contains("[possible values: auto, always, never]"));
}

#[test]
fn an_option_with_another_name_now_is_refused_with_its_new_name() {
    let calls: [(&[&str], &str, &str); 5] = [
        (&["check", "--max-edges", "4"], "--max-edges", "--edges"),
        (&["counterexample", "--edges", "4"], "--edges", "--max-edges"),
        (&["counterexample", "--out", "x"], "--out", "--out-dir"),
        (&["conform", "x.mcap", "--edges", "30"], "--edges", "--max-edges"),
        (&["camera", "calibrate", "x.png", "--start", "x.toml"], "--start", "--initial"),
    ];
    for (call, old, new) in calls {
        let output = run(call);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.starts_with(&format!("error: unexpected argument '{old}")), "{message}");
        assert!(message.contains(new), "{message}");
        let words: Vec<_> = call.iter().take_while(|word| **word != old).copied().collect();
        let verb = if words[0] == "camera" { &words[..] } else { &words[..1] };
        let help = stdout_of([verb, &["--help"]].concat());
        assert!(!help.contains(&format!(" {old} ")) && help.contains(new), "{help}");
    }
}

#[test]
fn the_option_o_is_out_or_out_dir_in_every_verb() {
    let calls = [
        ("counterexample", "--out-dir <DIR>"),
        ("draw", "--out <FILE>"),
        ("camera calibrate", "--out <FILE>"),
        ("camera train", "--out <FILE>"),
        ("sense", "--out <FILE>"),
    ];
    for (verb, long) in calls {
        let help = stdout_of(verb.split(' ').chain(["--help"]));
        assert!(help.contains(&format!("-o, {long}")), "{help}");
    }
    let folder = folder("option_o");
    let file = folder.join("w.svg");
    stdout_of(["draw", WORLD, "-o", file.to_str().unwrap()]);
    assert_eq!(fs::read_to_string(file).unwrap(), stdout_of(["draw", WORLD]));
}

#[test]
fn a_world_can_come_from_standard_input() {
    let file = Path::new(WORLD);
    let same: [&[&str]; 5] = [
        &["explore", "-", "--json"],
        &["draw", "-"],
        &["check", "--from", "-"],
        &["compare", "-", "worlds/shape-8.toml"],
        &["compare", "worlds/shape-8.toml", "-", "--json"],
    ];
    for call in same {
        let named = call.iter().map(|word| if *word == "-" { WORLD } else { word });
        // A check names the file.
        let expected =
            stdout_of(named).replace("the worlds of worlds/shape-6.toml", "the worlds of -");
        assert_eq!(printed(call, file), expected, "{call:?}");
    }
    printed(["simulate", "-", "--by-scene"], file);
    // Without a name of its own, the world has that of the input.
    let folder = folder("standard_input");
    let unnamed = folder.join("w.toml");
    fs::write(&unnamed, "[clockwise]\na = [\"b\"]\nb = [\"a\"]\n").unwrap();
    let dot = printed(["draw", "-", "--format", "dot"], &unnamed);
    assert!(dot.starts_with("graph \"stdin\" {"), "{dot}");
    let wrong = with_input(["explore", "-"], Path::new("Cargo.toml"));
    assert!(stderr(&wrong).starts_with("error: -: line "), "{}", stderr(&wrong));
}

#[test]
fn a_log_can_come_from_standard_input() {
    let folder = folder("log_from_standard_input");
    let [log, page] = ["run.mcap", "page.html"].map(|name| folder.join(name));
    stdout_of(["simulate", WORLD, "--by-scene", "--log", log.to_str().unwrap()]);
    let text = printed(["conform", "-", "--world", WORLD, "--html", page.to_str().unwrap()], &log);
    assert!(text.starts_with("-: conforms\n"), "{text}");
    // The page has the hash of what was read.
    let hash = Command::new("sha256sum").arg(&log).output();
    if let Ok(hash) = hash {
        let hash = stdout(&hash);
        let page = fs::read_to_string(&page).unwrap();
        assert!(page.contains(hash.split(' ').next().unwrap()), "{hash}");
    }
    let text = printed(["conform", log.to_str().unwrap(), "--world", "-"], Path::new(WORLD));
    assert!(text.contains(": conforms\n"), "{text}");
    let of_file = objects(&stdout_of(["info", log.to_str().unwrap(), "--json"]));
    let of_input = objects(&printed(["info", "-", "--json", "--verify"], &log));
    assert_eq!(of_file[0]["topics"], of_input[0]["topics"]);
    assert_eq!(of_input[0]["verification"]["holds"], true);
    assert!(printed(["conform", "--rerun", "-"], &log).contains("the map is complete"));
}

#[test]
fn images_calibrations_and_colours_can_come_from_standard_input() {
    let folder = folder("image_from_standard_input");
    let file = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let [image, again, camera, log] = ["v.png", "w.png", "c.toml", "run.mcap"].map(file);
    let render = ["draw", WORLD, "--pose", "start", "--size", "640x480", "-o", &image];
    stdout_of(render);
    let read = printed(
        ["draw", "-", "--pose", "start", "--size", "640x480", "-o", &again],
        Path::new(WORLD),
    );
    assert_eq!(read, "");
    assert!(fs::read(&image).unwrap() == fs::read(&again).unwrap());
    let calibration = stdout_of(["camera", "calibrate", &image]);
    assert_eq!(printed(["camera", "calibrate", "-"], Path::new(&image)), calibration);
    fs::write(&camera, calibration).unwrap();
    let initial = ["camera", "calibrate", &image, "--initial", "-"];
    assert_eq!(printed(initial, Path::new(&camera)), fs::read_to_string(&camera).unwrap());
    // The colours are those in the log of a short run.
    let run = ["simulate", WORLD, "--max-darts", "3", "--log", &log];
    assert_eq!(super::run(run).status.code(), Some(3));
    let colours = colours_of(&log);
    let colours_file = folder.join("colours.toml");
    fs::write(&colours_file, colours).unwrap();
    let colours = colours_file.to_str().unwrap();
    let sense = |image, camera, colours| {
        ["sense", image, "--calibration", camera, "--colours", colours].map(str::to_owned)
    };
    let expected = stdout_of(sense(&image, &camera, colours)).replace(&image, "-");
    let read = printed(sense("-", &camera, colours), Path::new(&image));
    assert_eq!(read, expected);
    for (call, input) in [
        (sense(&image, "-", colours), Path::new(&camera)),
        (sense(&image, &camera, "-"), &colours_file),
    ] {
        assert_eq!(printed(call, input).replace(&image, "-"), expected);
    }
    let steps = file("steps");
    let call =
        [&sense("-", &camera, colours)[..], &["--stages".to_owned(), steps.clone()]].concat();
    printed(call, Path::new(&image));
    let names = super::names_in(Path::new(&steps));
    assert!(names.iter().all(|name| name.starts_with("stdin-")), "{names:?}");
}

/// The colours of the building, as the head of a log has them.
fn colours_of(log: &str) -> String {
    use toposlam_logs::{entries::Content, reader::Log, topic_map::TopicMap};
    let log = Log::open(Path::new(log)).unwrap();
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
    let log = "fuzz/corpus/mcap/of-a-run";
    let twice: [&[&str]; 3] =
        [&["compare", "-", "-"], &["conform", "-", "--world", "-"], &["info", "-", "-"]];
    for call in twice {
        let input = if call[0] == "info" { log } else { WORLD };
        let output = with_input(call, Path::new(input));
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{message}");
        let cause =
            "error: -: standard input is one input; give the path of a file for the others\n";
        assert_eq!(message, cause);
    }
    let output = run(["draw", WORLD, "--out", "-"]);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.starts_with("error: -: an output is a file; only an input can be `-`"));
    // A pipe that is closed before it is read is an empty file.
    let mut program = toposlam();
    let mut child = program
        .args(["explore", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(b"").unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(stderr(&output), "error: -: the file is empty\n");
}

/// Ctrl-C ends each verb with 3, also while it reads.
#[cfg(unix)]
#[test]
fn a_verb_that_is_interrupted_ends_with_3() {
    use super::interrupted;

    let calls: [&[&str]; 4] = [
        &["draw", "-"],
        &["explore", "-"],
        &["camera", "calibrate", "-"],
        &["sense", "x.png", "--calibration", "-", "--colours", "x.toml"],
    ];
    for call in calls {
        let output = interrupted(call);
        assert_eq!(output.status.code(), Some(3), "{call:?} {}", stderr(&output));
        assert_eq!(stderr(&output), "interrupted\n");
    }
}
