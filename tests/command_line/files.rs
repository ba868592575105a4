//! No output replaces an input or another output, of any verb; and no verb reads or writes files past that
//! check.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

use super::{folder, run, stderr, stdout_of};

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
const OUTPUTS: [OutputOption; 41] = [
    // Not with --from, so there is no input that it could replace.
    output("check", "--journal", &[]),
    output("check", "--failed", &[("w.toml", "check --explorer cat --from IN --failed OUT")]),
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
    output("proofs", "--junit", &[]),
    output("proofs", "--sarif", &[]),
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
    // The files in a folder have names of their own; see the test of `files.rs`.
    output("simulate", "--frames", &[]),
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
    ("drive", &["--calibration", "--colours", "--plan"]),
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
fn file_options(verb: &str) -> BTreeSet<String> {
    let help = stdout_of(verb.split(' ').chain(["--help"]));
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
        assert_eq!(file_options(verb), known, "{verb}");
    }
}

/// The inputs of the calls.
struct Inputs {
    folder: PathBuf,
    world: PathBuf,
    log: PathBuf,
    calibration: PathBuf,
    image: PathBuf,
    /// The lines of a shard of a check.
    shard: PathBuf,
}

impl Inputs {
    fn new() -> Self {
        let folder = folder("no_output_replaces_an_input");
        let file = |name: &str| folder.join(name);
        let (world, log, image) = (file("world.toml"), file("run.mcap"), file("image.png"));
        let shard = file("shard.jsonl");
        fs::write(&shard, stdout_of(["check", "--edges", "2", "--shard", "1/2", "--json"]))
            .unwrap();
        fs::copy("worlds/shape-8.toml", &world).unwrap();
        let path = |path: &Path| path.to_str().unwrap().to_owned();
        stdout_of(["simulate", &path(&world), "--by-scene", "--log", &path(&log)]);
        stdout_of([
            "draw",
            &path(&world),
            "--pose",
            "start",
            "--size",
            "640x480",
            "--out",
            &path(&image),
        ]);
        let calibration = file("camera.toml");
        stdout_of(["camera", "calibrate", &path(&image), "--out", &path(&calibration)]);
        fs::create_dir(file("empty")).unwrap();
        Self { folder, world, log, calibration, image, shard }
    }

    /// The content of an input with this name.
    fn content(&self, name: &str) -> Vec<u8> {
        let source = match name.as_bytes()[0] {
            b'w' => &self.world,
            b'l' => &self.log,
            b'i' => &self.image,
            b'c' => &self.calibration,
            b's' => &self.shard,
            _ => return b"# a mapping\n".to_vec(),
        };
        fs::read(source).unwrap()
    }

    fn arguments(&self, call: &str, input: &Path, output: &Path) -> Vec<String> {
        let word = |word: &str| match word {
            "IN" => input.display().to_string(),
            "OUT" => output.display().to_string(),
            "WORLD" => self.world.display().to_string(),
            "LOG" => self.log.display().to_string(),
            "IMAGE" => self.image.display().to_string(),
            "CALIBRATION" | "COLOURS" => self.calibration.display().to_string(),
            "DIR" => self.folder.join("empty").display().to_string(),
            word => word.replace("NEW", &self.folder.join("new").display().to_string()),
        };
        call.split(' ').map(word).collect()
    }
}

#[test]
fn no_output_replaces_an_input() {
    let inputs = Inputs::new();
    for OutputOption { calls, .. } in &OUTPUTS {
        for &(name, call) in *calls {
            let case = inputs.folder.join("case");
            let _ = fs::remove_dir_all(&case);
            fs::create_dir(&case).unwrap();
            let (input, content) = (case.join(name), inputs.content(name));
            fs::write(&input, &content).unwrap();
            let dotted = inputs.folder.join("empty/../case/.").join(name);
            let mut outputs = vec![input.clone(), dotted];
            #[cfg(unix)]
            for link in ["soft", "hard"] {
                let link = case.join(format!("{link}-{name}"));
                if link.to_string_lossy().contains("soft") {
                    std::os::unix::fs::symlink(name, &link).unwrap();
                } else {
                    fs::hard_link(&input, &link).unwrap();
                }
                outputs.push(link);
            }
            for path in outputs {
                let before = super::names_in(&case);
                let result = run(inputs.arguments(call, &input, &path));
                let message = stderr(&result);
                assert_eq!(result.status.code(), Some(2), "{call}: {message}");
                let expected = format!("error: {}: this ", path.display());
                assert!(message.starts_with(&expected), "{call}: {message}");
                assert!(fs::read(&input).unwrap() == content, "{call} replaced its input");
                assert_eq!(super::names_in(&case), before, "{call}");
                assert!(result.stdout.is_empty(), "{call}");
            }
        }
    }
    let written: Vec<_> = super::names_in(&inputs.folder);
    assert_eq!(
        written,
        ["camera.toml", "case", "empty", "image.png", "run.mcap", "shard.jsonl", "world.toml"]
    );
}

#[test]
fn two_outputs_of_a_call_are_not_the_same_file() {
    let folder = folder("two_outputs");
    let file = folder.join("s.png").display().to_string();
    let dotted = folder.join("./s.png").display().to_string();
    let image = folder.join("image.png").display().to_string();
    stdout_of([
        "draw",
        "worlds/shape-8.toml",
        "--pose",
        "start",
        "--size",
        "640x480",
        "--out",
        &image,
    ]);
    let calibration = folder.join("new.toml").display().to_string();
    let calls: [&[&str]; 2] = [
        &["draw", "worlds/shape-8.toml", "--pose", "start", "--out", &file, "--labels", &dotted],
        &[
            "camera",
            "calibrate",
            &image,
            "--out",
            &calibration,
            "--picture",
            &file,
            "--mask-out",
            &dotted,
        ],
    ];
    for call in calls {
        let result = run(call);
        assert_eq!(result.status.code(), Some(2), "{call:?}");
        let expected = format!(
            "error: {dotted}: this is the same file as the output {file}; choose another name\n"
        );
        assert_eq!(stderr(&result), expected);
        assert_eq!(super::names_in(&folder), ["image.png"]);
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
