//! What the README shows is what the program prints and draws.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::{env, fs, path::Path, process::Command};

use toposlam::{
    model::format::{named_world::NamedWorld, world_file},
    picture::{Picture, svg},
};

fn read(path: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
}

fn toposlam(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_toposlam"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(arguments)
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn the_readme_shows_what_check_counterexample_train_and_conform_print() {
    let readme = read("README.md");
    let shown = blocks(&readme, "text");
    let [check, counterexample] = ["check", "counterexample"].map(|verb| toposlam(&[verb]));
    assert_eq!(shown, [check, counterexample, trained(&readme), conform(&readme)]);
}

fn blocks<'t>(text: &'t str, kind: &str) -> Vec<&'t str> {
    let begin = format!("```{kind}\n");
    text.split(&begin).skip(1).map(|block| block.split_once("```").unwrap().0).collect()
}

/// What the README's chain of sensing prints where it trains. Its last line draws each step of sensing
/// as docs/sensing.md shows it: look at those that changed, and commit them.
fn trained(readme: &str) -> String {
    let chain = blocks(readme, "sh").into_iter().find(|block| block.contains("toposlam train"));
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("docs");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(folder.join("worlds")).unwrap();
    fs::write(folder.join("worlds/shape-8.toml"), read("worlds/shape-8.toml")).unwrap();
    let program = Path::new(env!("CARGO_BIN_EXE_toposlam")).parent().unwrap().to_owned();
    let others = env::var_os("PATH").unwrap();
    let path = env::join_paths([program].into_iter().chain(env::split_paths(&others))).unwrap();
    let mut trained = None;
    for command in chain.unwrap().lines() {
        let mut bash = Command::new("bash");
        bash.args(["-euo", "pipefail", "-c", command]).current_dir(&folder).env("PATH", &path);
        let output = bash.output().unwrap();
        assert!(output.status.success(), "{command}: {output:?}");
        if command.starts_with("toposlam train") {
            trained = Some(String::from_utf8(output.stdout).unwrap());
        }
    }
    let shown = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/sensing");
    let names = |folder: &Path| {
        let mut names: Vec<_> =
            fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        names
    };
    let drawn = folder.join("steps");
    assert_eq!(names(&shown), names(&drawn));
    for name in names(&shown) {
        let same = fs::read(shown.join(&name)).unwrap() == fs::read(drawn.join(&name)).unwrap();
        assert!(same, "docs/sensing/{} is not what is drawn", name.display());
    }
    trained.unwrap()
}

/// What the README's third line of `conform` prints.
fn conform(readme: &str) -> String {
    let lines: Vec<_> = blocks(readme, "sh").into_iter().flat_map(str::lines).collect();
    let line = |begin: &str| lines.iter().find(|line| line.contains(begin)).unwrap();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("docs-conform");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(folder.join("worlds")).unwrap();
    for world in ["worlds/shape-6.toml", "worlds/shape-8.toml"] {
        fs::write(folder.join(world), read(world)).unwrap();
    }
    let commands = [
        line("simulate worlds/shape-6.toml --log"),
        line("conform shape-6.mcap --world worlds/shape-8"),
    ];
    let printed = commands.map(|command| {
        let words = command.split(" || ").next().unwrap().split(' ').skip(1);
        let mut toposlam = Command::new(env!("CARGO_BIN_EXE_toposlam"));
        String::from_utf8(toposlam.args(words).current_dir(&folder).output().unwrap().stdout)
            .unwrap()
    });
    printed[1].clone()
}

/// Draw them again with the commands of the README, look at them, and commit them.
#[test]
fn the_pictures_are_what_the_program_draws() {
    for name in ["figure-1a", "figure-1b"] {
        let world: NamedWorld =
            world_file::read(read(&format!("worlds/{name}.toml")).as_bytes()).unwrap();
        assert!(svg(&Picture::from(&world)) == read(&format!("docs/{name}.svg")), "{name}");
    }
    let way = Path::new(env!("CARGO_TARGET_TMPDIR")).join("shape-8-run.svg");
    toposlam(&["simulate", "worlds/shape-8.toml", "--svg", way.to_str().unwrap()]);
    assert!(fs::read_to_string(&way).unwrap() == read("docs/shape-8-run.svg"));
    let map = Path::new(env!("CARGO_TARGET_TMPDIR")).join("shape-8-map.svg");
    toposlam(&["explore", "worlds/shape-8.toml", "--svg", map.to_str().unwrap()]);
    assert!(fs::read_to_string(&map).unwrap() == read("docs/shape-8-map.svg"));
}

/// The times in that table are measured; its moves are those of the specification.
#[test]
fn what_mapping_costs_a_robot_is_what_the_specification_says() {
    let text = read("worlds/README.md");
    let (_, table) = text.split_once("## What mapping costs a robot").unwrap();
    let (table, _) = table.split_once("\n## ").unwrap();
    let rows: Vec<Vec<&str>> = table
        .lines()
        .filter(|line| line.contains(" : ") && line.starts_with("| "))
        .skip(1)
        .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
        .collect();
    assert_eq!(rows.len(), 11);
    for row in rows {
        let [name, start, cost] = [row[0], row[1], row[2]];
        let folders = ["worlds/shapes", "worlds"];
        let files = folders.map(|folder| format!("{folder}/{name}.toml"));
        let file = files.iter().find(|file| Path::new(file).exists()).unwrap();
        let told = toposlam(&["explore", file, "--start", start, "--json"]);
        let told: serde_json::Value = serde_json::from_str(&told).unwrap();
        assert_eq!(format!("{} : {}", told["moves"], told["edges"]), cost, "{name}");
    }
}

#[test]
fn every_test_of_the_model_is_in_its_fast_tier() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("model/tests");
    let tier = fs::read_to_string(folder.join("fast_tier.rs")).unwrap();
    for entry in fs::read_dir(folder).unwrap() {
        let file = entry.unwrap().path();
        let name = file.file_stem().unwrap().to_str().unwrap();
        assert!(name == "fast_tier" || tier.contains(&format!("mod {name};\n")), "{name}");
    }
}
