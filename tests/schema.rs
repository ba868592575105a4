//! Each line that a verb prints with `--json` fits the JSON Schema of the verb in `docs/schema`.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod validator;

use std::{
    collections::BTreeSet,
    env,
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
    process::Command,
    sync::LazyLock,
};

use serde_json::{Value, json};
use validator::problem;

/// Commands for each schema, by its name. They are run from top to bottom, in one folder.
const COMMANDS: [(&str, &[&str]); 13] = [
    (
        "proofs",
        &[
            "proofs",
            "proofs --run the_worlds_of_figure_1_differ",
            "proofs --run related_poses_of_figure_1_stay_related --choices 0,0,0",
        ],
    ),
    (
        "check",
        &[
            "check --edges 1..=3 --choices all",
            "check --edges 3 --choices all --max-states 1",
            "check --edges 4 --shard 1/4",
            "check --from worlds/petersen.toml",
            "check --marker movable --class corridor --edges 4",
            "check --explorer cat --edges 1",
            "check --edges 5 --estimate --probes 9",
        ],
    ),
    ("merge", &["check --add shards.jsonl"]),
    ("counterexample", &["counterexample --marker undirected --all"]),
    (
        "compare",
        &[
            "compare worlds/figure-1a.toml worlds/figure-1b.toml --walk 0,1,1",
            "compare worlds/shape-6.toml worlds/shape-8.toml --walk 0,2",
            "compare worlds/cycle-3.toml worlds/cycle-4.toml --marker none",
            "compare worlds/shape-6.toml worlds/shape-6.toml --marker movable",
        ],
    ),
    (
        "explore",
        &[
            "explore worlds/shape-6.toml",
            "explore worlds/shape-6.toml --choices all",
            "explore worlds/shape-8.toml --marker movable",
            "explore worlds/shape-6.toml --max-darts 4",
            "explore worlds/shape-6.toml --certificate",
            "explore worlds/shape-6.toml --audit=2",
        ],
    ),
    (
        "simulate",
        &[
            "simulate worlds/shape-6.toml --by-scene --log run.mcap",
            "simulate worlds/shape-6.toml --by-scene --fault carried@40 --log carried.mcap",
            "simulate worlds/shape-6.toml --by-scene --fault carried@9999",
            "simulate worlds/shape-6.toml --sensor laser",
            "simulate worlds/shape-8.toml --by-scene --recover --fault blocked@20",
        ],
    ),
    (
        "info",
        &[
            "info run.mcap",
            "info run.mcap --verify",
            "info fuzz/corpus/mcap/cut-in-a-chunk",
            "info fuzz/corpus/mcap/error-a-wrong-checksum --verify",
            "info damaged.mcap --verify",
            "info fuzz/corpus/mcap/cut-in-a-chunk --verify",
            "info nothing.mcap",
        ],
    ),
    (
        "conform",
        &[
            "conform run.mcap --world worlds/shape-6.toml",
            "conform run.mcap --world worlds/shape-8.toml --minimise short.mcap",
            "conform run.mcap carried.mcap --require-coverage confirmed",
            "conform run.mcap --max-darts 4 --max-steps 1",
            "conform run.mcap --events recorded",
            "conform run.mcap nothing.mcap",
        ],
    ),
    ("replay", &["conform --rerun run.mcap"]),
    ("calibrate", &["camera calibrate 2.png 5.png 7.png --out camera.toml"]),
    (
        "train",
        &[
            "camera train --images images --labels labels --calibration camera.toml --out colours.toml",
        ],
    ),
    (
        "sense",
        &[
            "sense 2.png 5.png 7.png --calibration camera.toml --colours colours.toml",
            "sense scans.log",
            "sense nothing.mcap",
        ],
    ),
];

/// One needs a live robot, the next a build with the feature `cluster`: `tests/cluster.rs` checks its line. The others
/// are of the program `evaluate`: `simulator/tests/evaluate` checks them.
const NOT_RUN: [&str; 8] = [
    "drive",
    "cluster",
    "evaluate-control",
    "evaluate-laser",
    "evaluate-lengths",
    "evaluate-mistakes",
    "evaluate-runs",
    "evaluate-vision",
];

fn path(of: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(of)
}

fn schema(name: &str) -> Value {
    let text = fs::read(path("docs/schema").join(name).with_extension("json")).unwrap();
    serde_json::from_slice(&text).unwrap()
}

fn names() -> BTreeSet<String> {
    let files = fs::read_dir(path("docs/schema")).unwrap().map(|entry| entry.unwrap().path());
    let schemas = files.filter(|file| file.extension().is_some_and(|is| is == "json"));
    schemas.map(|file| file.file_stem().unwrap().to_str().unwrap().to_owned()).collect()
}

/// The kinds of lines in a schema.
fn kinds(schema: &Value) -> BTreeSet<&str> {
    let lines = schema["oneOf"].as_array().unwrap().iter();
    lines.map(|line| line["properties"]["kind"]["const"].as_str().unwrap()).collect()
}

/// Runs a command in a folder. Returns its lines, none of which is empty.
fn lines(folder: &Path, command: &str) -> String {
    run(folder, command).0
}

/// Runs a command in a folder. Returns its lines and its exit code.
fn run(folder: &Path, command: &str) -> (String, i32) {
    let mut toposlam = Command::new(env!("CARGO_BIN_EXE_toposlam"));
    let output = toposlam.current_dir(folder).args(command.split(' ')).output().unwrap();
    let code = output.status.code().unwrap();
    assert_eq!(code == 2, command.contains(" nothing."), "{command}: {output:?}");
    (String::from_utf8(output.stdout).unwrap(), code)
}

/// The exit code for the verdict of a line, if it has one: the line itself, or the verification of a log.
fn code_of(line: &Value) -> Option<i32> {
    let judged =
        [line, &line["verification"]].into_iter().find(|part| part.get("holds").is_some())?;
    let code = match judged["verdict"].as_str().unwrap() {
        "holds" => 0,
        "violated" | "fails" => 1,
        "not-known" | "excluded" => 3,
        other => panic!("{other}"),
    };
    assert_eq!(judged["holds"], code == 0, "{line}");
    Some(code)
}

fn with_json(command: &str) -> String {
    format!("{command} --json")
}

/// A folder with the worlds, some logs, and images with their labels.
fn folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("schema");
    let _ = fs::remove_dir_all(&folder);
    for inside in ["worlds", "fuzz/corpus/mcap", "images", "labels"] {
        fs::create_dir_all(folder.join(inside)).unwrap();
    }
    for inside in ["worlds", "fuzz/corpus/mcap"] {
        let files = fs::read_dir(path(inside)).unwrap().map(|entry| entry.unwrap().path());
        for file in files.filter(|file| file.is_file()) {
            fs::copy(&file, folder.join(inside).join(file.file_name().unwrap())).unwrap();
        }
    }
    // Without an index its chunk is read at once.
    let mut log = fs::read(path("fuzz/corpus/mcap/of-a-run")).unwrap();
    let in_the_chunk = log.len() - 200;
    log[in_the_chunk] ^= 0x55;
    fs::write(folder.join("damaged.mcap"), log).unwrap();
    let ranges = vec!["3.0"; 181].join(" ");
    let scan = |x: u32| format!("FLASER 181 {ranges} {x} 0 0 {x} 0 0 {x} host {x}\n");
    fs::write(folder.join("scans.log"), scan(1) + &scan(2)).unwrap();
    let shard = |n: u32| lines(&folder, &format!("check --edges 1..=3 --shard {n}/2 --json"));
    fs::write(folder.join("shards.jsonl"), shard(1) + &shard(2)).unwrap();
    for n in [2, 5, 7] {
        let pose = format!("0,{n},{}", 50 * n);
        let render = format!("draw worlds/shape-8.toml --with-marker --size 640x480 --pose {pose}");
        let files = format!("--out images/{n}.png --labels labels/{n}.png");
        lines(&folder, &format!("{render} --seed {n} {files}"));
        fs::copy(folder.join(format!("images/{n}.png")), folder.join(format!("{n}.png"))).unwrap();
    }
    folder
}

/// Whether a line fits the schema of a verb.
pub(crate) fn fits_a_schema(line: &Value) -> bool {
    static SCHEMAS: LazyLock<Vec<Value>> =
        LazyLock::new(|| names().iter().map(|name| schema(name)).collect());
    SCHEMAS.iter().any(|schema| problem(schema, line).is_none())
}

/// What does not fit a schema in a folder of `docs/schema`, if something does not.
pub(crate) fn misfit(name: &str, line: &Value) -> Option<String> {
    problem(&schema(name), line)
}

#[test]
fn the_lines_of_each_verb_fit_its_schema() {
    let folder = folder();
    let mut pairs = Vec::new();
    for (name, commands) in COMMANDS {
        let schema = schema(name);
        let mut printed = String::new();
        for command in commands {
            let (lines, code) = run(&folder, &with_json(command));
            assert!(!lines.is_empty(), "{command}");
            let verdicts =
                lines.lines().filter_map(|line| code_of(&serde_json::from_str(line).unwrap()));
            // 1 is worse than 3.
            let worst = verdicts.min_by_key(|code| [1, 3, 0].iter().position(|one| one == code));
            assert!(worst.is_none_or(|worst| worst == code), "{command} ends with {code}: {lines}");
            write!(printed, "{lines}").unwrap();
        }
        let mut shown = BTreeSet::new();
        for line in printed.lines() {
            let line: Value = serde_json::from_str(line).unwrap();
            if let Some(problem) = problem(&schema, &line) {
                panic!("{name}: {problem}\n{line}");
            }
            shown.insert(line["kind"].as_str().unwrap().to_owned());
        }
        assert!(kinds(&schema).iter().eq(&shown), "{name}: {shown:?}");
        let file = folder.join(name).with_extension("jsonl");
        fs::write(&file, printed).unwrap();
        pairs.extend([path("docs/schema").join(name).with_extension("json"), file]);
    }
    check_by_python(&pairs);
}

/// Validates lines by PyPI's `jsonschema`, too.
fn check_by_python(pairs: &[PathBuf]) {
    let mut python = Command::new("python3");
    if !python
        .args(["-c", "import jsonschema"])
        .output()
        .is_ok_and(|output| output.status.success())
    {
        let required = env::var("TOPOSLAM_PYTHON_LOGS").is_ok_and(|is| is == "required");
        assert!(!required, "there is no python3 with jsonschema");
        return eprintln!("skipped: there is no python3 with jsonschema");
    }
    let mut python = Command::new("python3");
    let output = python.arg("-B").arg(path("tests/oracle/check_lines.py")).args(pairs).output();
    let output = output.unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn each_schema_is_run_and_listed_with_its_kinds() {
    let run = COMMANDS.iter().map(|(name, _)| *name).chain(NOT_RUN);
    assert_eq!(run.map(str::to_owned).collect::<BTreeSet<_>>(), names());
    let table = fs::read_to_string(path("docs/schema/README.md")).unwrap();
    let rows = table.lines().filter(|line| line.starts_with("| ["));
    let mut listed = BTreeSet::new();
    for row in rows {
        let cells: Vec<_> = row.trim_matches('|').split(" | ").map(str::trim).collect();
        let name = cells[0].split_once("](").unwrap().1.strip_suffix(".json)").unwrap();
        let shown: BTreeSet<_> = cells[1].split(", ").map(|kind| kind.trim_matches('`')).collect();
        assert_eq!(shown, kinds(&schema(name)), "{name}");
        listed.insert(name.to_owned());
    }
    assert_eq!(listed, names());
}

#[test]
fn a_line_with_another_kind_key_or_type_does_not_fit() {
    let schema = schema("calibrate");
    let line = json!({
        "schema": 1, "kind": "calibration", "images": 2, "image": [640, 480], "centre": [1.5, 2.5],
        "rim": 3.0, "rim_from": "images", "focal": 4.0, "rim_seen": 0.5, "rim_spread": 0.5,
        "mask_seen": null,
    });
    assert_eq!(problem(&schema, &line), None);
    for (key, value) in [
        ("schema", json!(2)),
        ("kind", json!("comparison")),
        ("more", json!(1)),
        ("images", json!(-1)),
        ("images", json!(1.5)),
        ("images", Value::Null),
        ("image", json!(["640", 480])),
        ("rim_from", json!("unknown")),
        ("mask_seen", json!("none")),
    ] {
        let mut changed = line.clone();
        changed[key] = value;
        assert!(problem(&schema, &changed).is_some(), "{changed}");
    }
    for key in line.as_object().unwrap().keys() {
        let mut without = line.clone();
        without.as_object_mut().unwrap().remove(key);
        assert!(problem(&schema, &without).is_some(), "{without}");
    }
}
