//! The documents show what the program prints and draws.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::{
    env,
    ffi::OsString,
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};

use toposlam_draw::picture::{WorldPicture, svg};
use toposlam_model::format::{named_world::NamedWorld, world_file};

fn read(path: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
}

fn output_of(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_toposlam"));
    command.current_dir(env!("CARGO_MANIFEST_DIR")).args(arguments).output().unwrap()
}

fn toposlam(arguments: &[&str]) -> String {
    let output = output_of(arguments);
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// A `text` block shows what the last command of the `sh` block before it prints. The other blocks that
/// run here write what these read. The last of them draws each step of sensing as docs/sensing.md shows
/// it: look at the pictures that changed, and commit them.
#[test]
fn the_documents_show_what_the_commands_print() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("docs");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(folder.join("worlds")).unwrap();
    fs::create_dir_all(folder.join("worlds/laser")).unwrap();
    for world in [
        "worlds/shape-6.toml",
        "worlds/shape-8.toml",
        "worlds/theta-plane.toml",
        "worlds/building-12.toml",
        "worlds/laser/long-8.toml",
    ] {
        fs::write(folder.join(world), read(world)).unwrap();
    }
    for page in ["README.md", "docs/commands.md", "docs/folding.md"] {
        let page_text = read(page);
        let mut blocks = blocks(&page_text).into_iter().peekable();
        while let Some((kind, commands)) = blocks.next() {
            let expected = blocks.next_if(|(kind, _)| *kind == "text");
            let writes = ["--log shape-6.mcap", "--log laser.mcap", "--stages steps"]
                .iter()
                .any(|o| commands.contains(o));
            if kind != "sh" || (expected.is_none() && !writes) {
                continue;
            }
            let printed = commands
                .lines()
                .map(|command| run(command, &folder))
                .fold(String::new(), |_, printed| printed);
            if let Some((_, expected)) = expected {
                let [expected, printed] = [expected, &printed].map(without_bytes);
                assert_eq!(expected, printed, "{page}: {commands}");
            }
        }
    }
    // The rim of a cluttered image, as docs/commands.md shows it.
    let rim = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/rim.jpg");
    assert!(fs::read(rim).unwrap() == fs::read(folder.join("rim.jpg")).unwrap());
    let shown = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/sensing");
    let drawn = folder.join("steps");
    assert_eq!(file_names(&shown), file_names(&drawn));
    for name in file_names(&shown) {
        let same = fs::read(shown.join(&name)).unwrap() == fs::read(drawn.join(&name)).unwrap();
        assert!(same, "docs/sensing/{} is not what is drawn", name.display());
    }
}

/// A text without places in a log: a log names the revision of its program, and not every build has one.
fn without_bytes(text: &str) -> String {
    let mut parts = text.split("at byte ");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| {
        text + "at byte N"
            + part.trim_start_matches(|digit: char| digit.is_ascii_digit() || digit == ',')
    })
}

/// The fenced blocks of a page: kind and content.
fn blocks(page: &str) -> Vec<(&str, &str)> {
    page.split("```").skip(1).step_by(2).map(|block| block.split_once('\n').unwrap()).collect()
}

/// What a command of the documents prints, with this program as `toposlam`.
fn run(command: &str, folder: &Path) -> String {
    let command = command.replace("cargo run --release --", "toposlam");
    let program = Path::new(env!("CARGO_BIN_EXE_toposlam")).parent().unwrap().to_owned();
    let others = env::var_os("PATH").unwrap();
    let path = env::join_paths([program].into_iter().chain(env::split_paths(&others))).unwrap();
    let mut bash = Command::new("bash");
    bash.args(["-euo", "pipefail", "-c", &command]).current_dir(folder).env("PATH", path);
    let output = bash.output().unwrap();
    assert!(output.status.success(), "{command}: {output:?}");
    String::from_utf8(output.stdout).unwrap()
}

fn file_names(folder: &Path) -> Vec<OsString> {
    let mut names: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    names
}

/// Draw them again with the commands of docs/commands.md, look at them, and commit them.
#[test]
fn the_pictures_are_what_the_program_draws() {
    for name in ["figure-1a", "figure-1b"] {
        let world: NamedWorld =
            world_file::read(read(&format!("worlds/{name}.toml")).as_bytes()).unwrap();
        assert!(svg(&WorldPicture::from(&world)) == read(&format!("docs/{name}.svg")), "{name}");
    }
    let way = Path::new(env!("CARGO_TARGET_TMPDIR")).join("shape-8-run.svg");
    toposlam(&["simulate", "worlds/shape-8.toml", "--svg", way.to_str().unwrap()]);
    assert!(fs::read_to_string(&way).unwrap() == read("docs/shape-8-run.svg"));
    let map = Path::new(env!("CARGO_TARGET_TMPDIR")).join("shape-8-map.svg");
    toposlam(&["explore", "worlds/shape-8.toml", "--svg", map.to_str().unwrap()]);
    assert!(fs::read_to_string(&map).unwrap() == read("docs/shape-8-map.svg"));
}

/// The logs are not part of the repository. Draw the pictures again with `conform LOG --picture FILE`, with the
/// options below, look at them, and commit them.
#[test]
fn the_pictures_of_real_logs_are_what_the_program_draws() {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/carmen");
    let logs = env::var_os("TOPOSLAM_CARMEN_LOGS").map_or(beside, PathBuf::from);
    for name in ["aces", "seattle", "freiburg-079"] {
        let log = logs.join(name).with_extension("log.gz");
        if !log.is_file() {
            eprintln!("skipped: there is no {}", log.display());
            continue;
        }
        let drawn = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.svg"));
        let options = ["--driver", "anyone", "--marker", "none", "--picture"];
        let paths = [&log, &drawn].map(|path| path.to_str().unwrap());
        let output = output_of(&[&["conform", paths[0]], &options[..], &[paths[1]]].concat());
        // On an office floor a visit is undecided.
        let expected = if name == "freiburg-079" { 3 } else { 0 };
        assert_eq!(output.status.code(), Some(expected), "{output:?}");
        let shown = read(&format!("docs/real-logs/{name}.svg"));
        assert!(fs::read_to_string(&drawn).unwrap() == shown, "{name}");
    }
}

/// The times in that table are measured. Its moves are those of the specification.
#[test]
fn the_moves_in_the_table_of_worlds_are_those_of_the_specification() {
    let text = read("worlds/README.md");
    let (_, table) = text.split_once("## What mapping costs a robot").unwrap();
    let (table, _) = table.split_once("\n## ").unwrap();
    let rows: Vec<Vec<&str>> = table
        .lines()
        .filter(|line| line.starts_with("| "))
        .skip(2)
        .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
        .collect();
    assert_eq!(rows.len(), 11);
    for row in rows {
        let [name, start, moves, edges] = [row[0], row[1], row[2], row[3]];
        let folders = ["worlds/shapes", "worlds"];
        let files = folders.map(|folder| format!("{folder}/{name}.toml"));
        let file = files.iter().find(|file| Path::new(file).exists()).unwrap();
        let result = toposlam(&["explore", file, "--start", start, "--json"]);
        let result: serde_json::Value = serde_json::from_str(&result).unwrap();
        let expected = [&result["moves"], &result["edges"]].map(ToString::to_string);
        assert_eq!(expected, [moves, edges], "{name}");
    }
}

#[test]
fn every_test_file_belongs_to_a_test_program() {
    for package in ["logs", "model", "proofs", "simulator", "vision", "."] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(package).join("tests");
        let manifest = fs::read_to_string(folder.join("../Cargo.toml")).unwrap();
        let modules = fs::read_to_string(folder.join("main.rs")).unwrap();
        for entry in fs::read_dir(folder).unwrap() {
            let file = entry.unwrap().path();
            let name = file.file_stem().unwrap().to_str().unwrap();
            let is_test = file.extension().is_some_and(|kind| kind == "rs")
                || file.join("mod.rs").exists()
                || file.join("main.rs").exists();
            let listed = modules.contains(&format!("mod {name};\n"))
                || manifest.contains(&format!("name = \"{name}\"\n"));
            assert!(!is_test || name == "main" || listed, "{}", file.display());
        }
    }
}
