//! The documents show what the program prints and draws.

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::Command,
};

use serde_json::Value;

use crate::{
    output::{self, names_in},
    printed, program, read, repository,
};

/// A `text` block shows what the last command of the `sh` block before it prints. The other blocks that
/// run here write what these read. The last of them draws each step of sensing as docs/sensing.md shows
/// it: look at the pictures that changed, and commit them.
#[test]
#[ignore = "it takes long: `.ci/run`"]
fn the_documents_show_what_the_commands_print() {
    let folder = output::folder("docs");
    fs::create_dir_all(folder.join("worlds/laser")).unwrap();
    for world in [
        "shape-6",
        "shape-8",
        "theta-plane",
        "building-12",
        "laser/long-8",
        "figure-1a",
        "figure-1b",
    ] {
        let world = format!("worlds/{world}.toml");
        fs::write(folder.join(&world), read(&world)).unwrap();
    }
    for page in ["README.md", "docs/commands.md", "docs/folding.md"] {
        let page_text = read(page);
        let mut blocks = blocks(&page_text).into_iter().peekable();
        while let Some((kind, commands)) = blocks.next() {
            let expected = blocks.next_if(|(kind, _)| *kind == "text");
            let writes =
                ["--log shape-6.mcap", "--log laser.mcap", "--out colours.toml", "--stages steps"]
                    .iter()
                    .any(|o| commands.contains(o));
            if kind == "sh" && (expected.is_some() || writes) {
                let shown: Vec<_> = commands.lines().map(|command| run(command, &folder)).collect();
                let shown = shown.last().unwrap();
                if let Some((_, expected)) = expected {
                    assert_eq!(without_bytes(expected), without_bytes(shown), "{page}: {commands}");
                }
            }
        }
    }
    // Draw these again with the commands of the pages, look at them, and commit them.
    for command in [
        "draw worlds/figure-1a.toml --out figure-1a.svg",
        "draw worlds/figure-1b.toml --out figure-1b.svg",
        "simulate worlds/shape-8.toml --svg shape-8-run.svg",
        "explore worlds/shape-8.toml --map shape-8-map.svg",
    ] {
        run(&format!("toposlam {command}"), &folder);
    }
    let steps = names_in(&folder.join("steps"));
    assert_eq!(steps, names_in(&repository("docs/sensing")));
    let steps =
        steps.into_iter().map(|name| (format!("docs/sensing/{name}"), format!("steps/{name}")));
    // The rim of a cluttered image, as docs/commands.md shows it.
    let pictures =
        ["rim.jpg", "figure-1a.svg", "figure-1b.svg", "shape-8-run.svg", "shape-8-map.svg"];
    let pictures = pictures.map(|name| (format!("docs/{name}"), name.to_owned()));
    for (shown, drawn) in steps.chain(pictures) {
        let same = fs::read(repository(&shown)).unwrap() == fs::read(folder.join(drawn)).unwrap();
        assert!(same, "{shown} is not what is drawn");
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
    printed(bash.args(["-euo", "pipefail", "-c", &command]).current_dir(folder).env("PATH", path))
}

/// The logs are not part of the repository. Draw the pictures again with `conform LOG --picture FILE`, with the
/// options below, look at them, and commit them.
#[test]
#[ignore = "it takes long: `.ci/run`"]
fn the_pictures_of_real_logs_are_what_the_program_draws() {
    let beside = repository("../shared/data/carmen");
    let logs = env::var_os("TOPOSLAM_CARMEN_LOGS").map_or(beside, PathBuf::from);
    let drawn = output::folder("real-logs").join("drawn.svg");
    // On an office floor a visit is undecided.
    for (name, code) in [("aces", 0), ("seattle", 0), ("freiburg-079", 3)] {
        let log = logs.join(name).with_extension("log.gz");
        if !log.is_file() {
            eprintln!("skipped: there is no {}", log.display());
            continue;
        }
        let mut conform = program();
        conform.arg("conform").arg(&log).args(["--driver", "anyone", "--marker", "none"]);
        let output = conform.arg("--picture").arg(&drawn).output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{output:?}");
        let shown = read(&format!("docs/real-logs/{name}.svg"));
        assert!(fs::read_to_string(&drawn).unwrap() == shown, "{name}");
    }
}

/// The times in that table are measured. Its moves are those of the specification.
#[test]
fn the_moves_in_the_table_of_worlds_are_those_of_the_specification() {
    let text = read("worlds/README.md");
    let (_, table) = text.split_once("## What mapping costs a robot").unwrap();
    let table = table.split("\n## ").next().unwrap();
    let rows: Vec<_> = table.lines().filter(|line| line.starts_with("| ")).skip(2).collect();
    assert_eq!(rows.len(), 11);
    for row in rows {
        let cells: Vec<_> = row.trim_matches('|').split('|').map(str::trim).collect();
        let [name, start, moves, edges] = [cells[0], cells[1], cells[2], cells[3]];
        let files = ["shapes/", ""].map(|folder| format!("worlds/{folder}{name}.toml"));
        let file = files.iter().find(|file| repository(file).exists()).unwrap();
        let result = printed(program().args(["explore", file, "--start", start, "--json"]));
        let result: Value = serde_json::from_str(&result).unwrap();
        let found = [&result["moves"], &result["edges"]].map(ToString::to_string);
        assert_eq!(found, [moves, edges], "{name}");
    }
}
