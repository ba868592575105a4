//! Each line that a verb prints with `--json` fits the JSON Schema of the verb in `docs/schema`.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
    sync::LazyLock,
};

use serde_json::Value;

use crate::{
    output::{self, Schema, names_in},
    program, read, repository,
};

/// Commands, each behind its schema. They are run from top to bottom, in one folder. Those with `nothing` end with 2.
const COMMANDS: &str = include_str!("schema.txt");

/// One needs a live robot, the next a build with the feature `cluster`: `tests/cluster.rs` checks its line. The others
/// are of the program `evaluate`: `simulator/tests/evaluate` checks them.
const NOT_RUN: [&str; 9] = [
    "drive",
    "cluster",
    "evaluate-control",
    "evaluate-laser",
    "evaluate-lengths",
    "evaluate-logs",
    "evaluate-mistakes",
    "evaluate-runs",
    "evaluate-vision",
];

/// The commands with their schemas.
fn commands() -> impl Iterator<Item = (&'static str, &'static str)> {
    COMMANDS.lines().filter_map(|line| line.split_once(": "))
}

/// The schemas of the verbs.
static SCHEMAS: LazyLock<BTreeMap<String, Schema>> = LazyLock::new(|| {
    let names = names_in(&repository("docs/schema")).into_iter();
    let names = names.filter_map(|name| name.strip_suffix(".json").map(str::to_owned));
    names.map(|name| (name.clone(), Schema::read(&name))).collect()
});

/// Whether a line fits the schema of a verb.
pub(crate) fn fits_a_schema(line: &Value) -> bool {
    SCHEMAS.values().any(|schema| schema.validator.is_valid(line))
}

/// Runs a command in a folder. Returns its lines and its exit code.
fn run(folder: &Path, command: &str) -> (String, i32) {
    let output = program().current_dir(folder).args(command.split(' ')).output().unwrap();
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

/// A folder with the worlds, some logs, and images with their labels.
fn folder() -> PathBuf {
    let folder = output::folder("schema");
    for inside in ["worlds", "fuzz/corpus/mcap", "images", "labels"] {
        fs::create_dir_all(folder.join(inside)).unwrap();
    }
    for inside in ["worlds", "fuzz/corpus/mcap"] {
        let files = fs::read_dir(repository(inside)).unwrap().map(|entry| entry.unwrap().path());
        for file in files.filter(|file| file.is_file()) {
            fs::copy(&file, folder.join(inside).join(file.file_name().unwrap())).unwrap();
        }
    }
    // Without an index its chunk is read at once.
    let mut log = fs::read(repository("fuzz/corpus/mcap/of-a-run")).unwrap();
    let in_the_chunk = log.len() - 200;
    log[in_the_chunk] ^= 0x55;
    fs::write(folder.join("damaged.mcap"), log).unwrap();
    let ranges = vec!["3.0"; 181].join(" ");
    let scan = |x: u32| format!("FLASER 181 {ranges} {x} 0 0 {x} 0 0 {x} host {x}\n");
    fs::write(folder.join("scans.log"), scan(1) + &scan(2)).unwrap();
    let shard = |n: u32| run(&folder, &format!("check --edges 1..=3 --shard {n}/2 --json")).0;
    fs::write(folder.join("shards.jsonl"), shard(1) + &shard(2)).unwrap();
    for n in [2, 5, 7] {
        let pose = format!("0,{n},{}", 50 * n);
        let render =
            format!("draw worlds/shape-8.toml --marker directional --size 640x480 --pose {pose}");
        let files = format!("--out images/{n}.png --labels labels/{n}.png");
        run(&folder, &format!("{render} --seed {n} {files}"));
        fs::copy(folder.join(format!("images/{n}.png")), folder.join(format!("{n}.png"))).unwrap();
    }
    folder
}

#[test]
fn the_lines_of_each_verb_fit_its_schema() {
    let folder = folder();
    let mut printed: BTreeMap<&str, String> = BTreeMap::new();
    for (name, command) in commands() {
        let (lines, code) = run(&folder, &format!("{command} --json"));
        assert!(!lines.is_empty(), "{command}");
        let verdicts =
            lines.lines().filter_map(|line| code_of(&serde_json::from_str(line).unwrap()));
        // 1 is worse than 3.
        let worst = verdicts.min_by_key(|code| [1, 3, 0].iter().position(|one| one == code));
        assert!(worst.is_none_or(|worst| worst == code), "{command} ends with {code}: {lines}");
        *printed.entry(name).or_default() += &lines;
    }
    for (name, lines) in printed {
        let schema = &SCHEMAS[name];
        let mut shown = BTreeSet::new();
        for line in lines.lines() {
            let line: Value = serde_json::from_str(line).unwrap();
            assert_eq!(schema.misfit(&line), None, "{name}: {line}");
            shown.insert(line["kind"].as_str().unwrap().to_owned());
        }
        assert!(schema.kinds().iter().eq(&shown), "{name}: {shown:?}");
    }
}

#[test]
fn each_schema_is_exact_and_is_run_and_listed_with_its_kinds() {
    let run: BTreeSet<_> = commands().map(|(name, _)| name).chain(NOT_RUN).collect();
    assert!(run.iter().eq(SCHEMAS.keys()), "{run:?}");
    let table = read("docs/schema/README.md");
    let mut listed = BTreeSet::new();
    for row in table.lines().filter(|line| line.starts_with("| [")) {
        let cells: Vec<_> = row.trim_matches('|').split(" | ").map(str::trim).collect();
        let name = cells[0].split_once("](").unwrap().1.strip_suffix(".json)").unwrap();
        let shown: BTreeSet<_> = cells[1].split(", ").map(|kind| kind.trim_matches('`')).collect();
        let schema = &SCHEMAS[name];
        assert_eq!(shown, schema.kinds(), "{name}");
        for line in schema.text["oneOf"].as_array().unwrap() {
            assert_eq!(line["properties"]["schema"]["const"], 1, "{name}");
            assert_eq!(line["additionalProperties"], false, "{name}");
        }
        listed.insert(name);
    }
    assert!(listed.iter().eq(SCHEMAS.keys()), "{listed:?}");
}
