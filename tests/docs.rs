//! What the README shows is what the program prints and draws.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::{fs, path::Path, process::Command};

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
fn the_readme_shows_what_check_and_counterexample_print() {
    let readme = read("README.md");
    let blocks = readme.split("```text\n").skip(1).map(|block| block.split_once("```").unwrap().0);
    assert_eq!(blocks.collect::<Vec<_>>(), [toposlam(&["check"]), toposlam(&["counterexample"])]);
}

/// Draw them again with the commands of the README, look at them, and commit them.
#[test]
fn the_pictures_are_what_the_program_draws() {
    for name in ["figure-1a", "figure-1b"] {
        let world: NamedWorld =
            world_file::read(read(&format!("worlds/{name}.toml")).as_bytes()).unwrap();
        assert!(svg(&Picture::from(&world)) == read(&format!("docs/{name}.svg")), "{name}");
    }
    let map = Path::new(env!("CARGO_TARGET_TMPDIR")).join("shape-8-map.svg");
    toposlam(&["explore", "worlds/shape-8.toml", "--svg", map.to_str().unwrap()]);
    assert!(fs::read_to_string(&map).unwrap() == read("docs/shape-8-map.svg"));
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
