//! No output replaces an input or another output, of any verb; and no verb reads or writes files past that
//! check.

use std::{collections::BTreeSet, fs, path::Path};

use super::{Scratch, names_in, stderr};

/// An option that writes files.
struct OutputOption {
    verb: &'static str,
    option: &'static str,
    /// Calls whose input IN is also the output OUT, with the name of that file.
    calls: &'static [(&'static str, &'static str)],
}

const fn output(
    verb: &'static str,
    option: &'static str,
    calls: &'static [(&'static str, &'static str)],
) -> OutputOption {
    OutputOption { verb, option, calls }
}

/// All options that write files. WORLD, LOG and IMAGE are other inputs; NEW is another output.
const OUTPUTS: [OutputOption; 37] = [
    // Not with --from, so there is no input that it could replace.
    output("check", "--journal", &[]),
    output("check", "--worst", &[("w.toml", "check --from IN --worst OUT")]),
    output("check", "--junit", &[("w.xml", "check --from IN --junit OUT")]),
    output("check", "--sarif", &[("w.sarif", "check --from IN --sarif OUT")]),
    output("check", "--junit", &[("s.xml", "check --add IN --junit OUT")]),
    output("check", "--sarif", &[("s.sarif", "check --add IN --sarif OUT")]),
    output("explore", "--map", &[("w.toml", "explore IN --map OUT")]),
    output("explore", "--svg", &[("w.svg", "explore IN --svg OUT")]),
    output(
        "compare",
        "--html",
        &[
            ("w.html", "compare IN WORLD --marker none --html OUT"),
            ("w.html", "compare WORLD IN --marker none --html OUT"),
        ],
    ),
    // These read no file.
    output("counterexample", "--out-dir", &[]),
    output("counterexample", "--html", &[]),
    output("counterexample", "--junit", &[]),
    output("counterexample", "--sarif", &[]),
    output("counterexample", "--atlas", &[]),
    output("draw", "--out", &[("w.svg", "draw IN --out OUT")]),
    output(
        "simulate",
        "--log",
        &[
            ("w.mcap", "simulate IN --by-scene --log OUT"),
            ("c.mcap", "simulate WORLD --calibration IN --log OUT"),
            ("c.mcap", "simulate WORLD --colours IN --log OUT"),
        ],
    ),
    output("simulate", "--svg", &[("w.svg", "simulate IN --by-scene --svg OUT")]),
    output("simulate", "--html", &[("w.html", "simulate IN --by-scene --html OUT")]),
    output("simulate", "--map", &[("w.toml", "simulate IN --by-scene --map OUT")]),
    output("drive", "--log", &[]),
    output("drive", "--map", &[]),
    output(
        "draw",
        "--out",
        &[
            ("w.png", "draw IN --pose start --out OUT"),
            ("c.png", "draw WORLD --pose start --calibration IN --out OUT"),
        ],
    ),
    output("draw", "--labels", &[("w.png", "draw IN --pose start --out NEW.png --labels OUT")]),
    output(
        "camera calibrate",
        "--out",
        &[("c.toml", "camera calibrate IMAGE --initial IN --out OUT")],
    ),
    output(
        "camera calibrate",
        "--picture",
        &[
            ("i.png", "camera calibrate IN --picture OUT"),
            ("i.png", "camera calibrate IMAGE IN --picture OUT"),
        ],
    ),
    output(
        "camera calibrate",
        "--mask-out",
        &[("i.png", "camera calibrate IN --out NEW.toml --mask-out OUT")],
    ),
    output(
        "camera train",
        "--out",
        &[("c.toml", "camera train --images DIR --labels DIR --calibration IN --out OUT")],
    ),
    output(
        "sense",
        "--out",
        &[
            ("c.txt", "sense IMAGE --calibration IN --colours COLOURS --out OUT"),
            ("c.txt", "sense IMAGE --calibration CALIBRATION --colours IN --out OUT"),
            ("i.txt", "sense IN --calibration CALIBRATION --colours COLOURS --out OUT"),
        ],
    ),
    output("sense", "--stages", &[]),
    output("info", "--write-topics", &[("l.toml", "info IN --write-topics OUT")]),
    output(
        "conform",
        "--html",
        &[
            ("l.html", "conform IN --html OUT"),
            ("w.html", "conform LOG --world IN --html OUT"),
            ("m.html", "conform LOG --topics IN --html OUT"),
        ],
    ),
    output(
        "conform",
        "--minimise",
        &[
            ("l.mcap", "conform IN --minimise OUT"),
            ("w.mcap", "conform LOG --world IN --minimise OUT"),
        ],
    ),
    output("conform", "--map", &[("l.toml", "conform IN --map OUT")]),
    output("conform", "--picture", &[("q.svg", "conform LOG --quirks IN --picture OUT")]),
    output("conform", "--junit", &[("l.xml", "conform IN --junit OUT")]),
    output("conform", "--sarif", &[("l.sarif", "conform IN --sarif OUT")]),
    output(
        "conform",
        "--map",
        &[
            ("l.toml", "conform --rerun IN --map OUT"),
            ("m.toml", "conform --rerun LOG --topics IN --map OUT"),
        ],
    ),
];

/// Options that read files.
const INPUTS: [(&str, &[&str]); 8] = [
    ("check", &["--from"]),
    ("simulate", &["--calibration", "--colours", "--scanner"]),
    ("drive", &["--calibration", "--colours"]),
    ("draw", &["--calibration"]),
    ("camera calibrate", &["--initial"]),
    ("camera train", &["--images", "--labels", "--calibration"]),
    ("sense", &["--calibration", "--colours", "--laser-params", "--topics"]),
    (
        "conform",
        &["--world", "--topics", "--calibration", "--colours", "--quirks", "--laser-params"],
    ),
];

/// The options of a verb with a file or a folder as their value.
fn file_options(scratch: &Scratch, verb: &str) -> BTreeSet<String> {
    let help = scratch.out(&format!("{verb} --help"), 0);
    let names = help.lines().filter_map(|line| {
        let (option, value) = line.trim_start().split_once(" <")?;
        let is_file = ["FILE>", "DIR>"].contains(&value.trim().trim_end_matches("..."));
        (is_file && option.starts_with('-'))
            .then(|| option.rsplit(' ').next().unwrap_or_default().to_owned())
    });
    names.collect()
}

#[test]
fn every_option_that_writes_a_file_is_in_the_list() {
    let scratch = Scratch::new("file_options");
    let verbs: BTreeSet<_> = OUTPUTS.iter().map(|output| output.verb).collect();
    let others = ["proofs"];
    for verb in verbs.into_iter().chain(others) {
        let outputs = OUTPUTS.iter().filter(|output| output.verb == verb);
        let inputs = INPUTS.iter().filter(|(of, _)| *of == verb).flat_map(|(_, names)| *names);
        let mut known: BTreeSet<_> = outputs.map(|output| output.option.to_owned()).collect();
        known.extend(inputs.map(|&name| name.to_owned()));
        match verb {
            "check" | "counterexample" => {
                known.insert("--hosts".to_owned());
            }
            "info" => {
                known.insert("--topics".to_owned());
            }
            _ => {}
        }
        known.remove("");
        assert_eq!(file_options(&scratch, verb), known, "{verb}");
    }
}

/// A folder with an input for each letter with which the names of inputs begin.
fn inputs() -> Scratch {
    let scratch = Scratch::new("no_output_replaces_an_input");
    scratch.write("w", scratch.bytes("worlds/shape-8.toml"));
    scratch.out("simulate w --by-scene --log l.mcap", 0);
    scratch.out("draw w --pose start --size 640x480 --out i.png", 0);
    scratch.out("camera calibrate i.png --out c.toml", 0);
    scratch.write("s", scratch.out("check --edges 2 --shard 1/2 --json", 0));
    for other in ["m", "q"] {
        scratch.write(other, "# a mapping\n");
    }
    fs::create_dir(scratch.path("empty")).unwrap();
    scratch
}

#[test]
fn no_output_replaces_an_input() {
    let scratch = inputs();
    let before = scratch.written();
    let sources = before.clone();
    for OutputOption { calls, .. } in &OUTPUTS {
        for &(name, call) in *calls {
            let case = scratch.path("case");
            let _ = fs::remove_dir_all(&case);
            fs::create_dir(&case).unwrap();
            let source = sources.iter().find(|source| source.starts_with(&name[..1])).unwrap();
            let content = scratch.bytes(source);
            let input = case.join(name);
            fs::write(&input, &content).unwrap();
            let mut outputs = vec![format!("case/{name}"), format!("empty/../case/./{name}")];
            #[cfg(unix)]
            for link in ["soft", "hard"] {
                let path = case.join(format!("{link}-{name}"));
                if link == "soft" {
                    std::os::unix::fs::symlink(name, &path).unwrap();
                } else {
                    fs::hard_link(&input, &path).unwrap();
                }
                outputs.push(format!("case/{link}-{name}"));
            }
            let there = names_in(&case);
            for output in outputs {
                let word = |word| match word {
                    "IN" => format!("case/{name}"),
                    "OUT" => output.clone(),
                    "WORLD" => "w".to_owned(),
                    "LOG" => "l.mcap".to_owned(),
                    "IMAGE" => "i.png".to_owned(),
                    "CALIBRATION" | "COLOURS" => "c.toml".to_owned(),
                    "DIR" => "empty".to_owned(),
                    word => word.replace("NEW", "new"),
                };
                let line = call.split(' ').map(word).collect::<Vec<_>>().join(" ");
                let result = scratch.run(&line);
                let message = stderr(&result);
                assert_eq!(result.status.code(), Some(2), "{line}: {message}");
                assert!(
                    message.starts_with(&format!("error: {output}: this ")),
                    "{line}: {message}"
                );
                assert!(fs::read(&input).unwrap() == content, "{line} replaced its input");
                assert_eq!(names_in(&case), there, "{line}");
                assert!(result.stdout.is_empty(), "{line}");
            }
            fs::remove_dir_all(&case).unwrap();
        }
    }
    assert_eq!(scratch.written(), before);
}

#[test]
fn two_outputs_of_a_call_are_not_the_same_file() {
    let scratch = Scratch::new("two_outputs");
    scratch.out("draw worlds/shape-8.toml --pose start --size 640x480 --out image.png", 0);
    for line in [
        "draw worlds/shape-8.toml --pose start --out s.png --labels ./s.png",
        "camera calibrate image.png --out new.toml --picture s.png --mask-out ./s.png",
    ] {
        let expected =
            "error: ./s.png: this is the same file as the output s.png; choose another name\n";
        assert_eq!(scratch.error(line), expected, "{line}");
        assert_eq!(scratch.written(), ["image.png"]);
    }
}

#[test]
fn the_verbs_read_and_write_files_only_where_they_are_registered() {
    const PAST_THE_CHECK: [&str; 9] = [
        "fs::read(",
        "fs::read_to_string(",
        "fs::write(",
        "fs::copy(",
        "fs::rename(",
        "File::open(",
        "File::create(",
        "OpenOptions",
        "Log::open(",
    ];
    const REGISTERED: [&str; 3] = ["files.rs", "input.rs", "output.rs"];
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("src/cli")];
    let mut read = 0;
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap().to_owned();
            if path.is_dir() {
                folders.push(path);
            } else if !REGISTERED.contains(&&*name) {
                let source = fs::read_to_string(&path).unwrap();
                let (program, _) = source.split_once("#[cfg(test)]").unwrap_or((&source, ""));
                // This one opens bytes.
                let program = program.replace("ImageFile::open(", "");
                let found = PAST_THE_CHECK.iter().find(|call| program.contains(*call));
                assert_eq!(found, None, "{}", path.display());
                read += 1;
            }
        }
    }
    assert!(read > 60);
}
