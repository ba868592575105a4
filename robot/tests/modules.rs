//! The modules of the crate depend on each other in one direction.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

/// The modules that each module of the crate uses, without its tests.
fn dependencies() -> BTreeMap<String, BTreeSet<String>> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(source).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let mut used = BTreeSet::new();
        collect(&path, &mut used);
        used.remove(&name);
        found.insert(name, used);
    }
    found
}

fn collect(path: &Path, used: &mut BTreeSet<String>) {
    if path.is_dir() {
        for entry in fs::read_dir(path).unwrap() {
            collect(&entry.unwrap().path(), used);
        }
    } else if path.file_stem().is_some_and(|stem| stem != "tests") {
        let text = fs::read_to_string(path).unwrap();
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap();
        for after in code.split("crate::").skip(1) {
            used.extend(names(after));
        }
    }
}

/// The first names of a path, or of a list of paths in braces.
fn names(path: &str) -> Vec<String> {
    let first = |path: &str| {
        path.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
    };
    let Some(list) = path.strip_prefix('{') else { return vec![first(path)] };
    let (mut names, mut depth) = (vec![first(list)], 0);
    for (place, character) in list.char_indices() {
        match character {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => names.push(first(&list[place + 1..])),
            _ => {}
        }
    }
    names.retain(|name: &String| !name.is_empty());
    names
}

#[test]
fn the_names_of_a_list_of_paths_are_found() {
    assert_eq!(names("log::{entries, writer};"), ["log"]);
    assert_eq!(names("{\n    log::{entries, writer},\n    pose::Pose,\n};"), ["log", "pose"]);
}

#[test]
fn no_module_depends_on_itself_through_others() {
    let dependencies = dependencies();
    assert!(dependencies["log"].contains("record"), "{dependencies:?}");
    let mut left: Vec<_> = dependencies.keys().collect();
    while !left.is_empty() {
        let before = left.len();
        let stays =
            |module: &&String| left.iter().any(|other| dependencies[*module].contains(*other));
        let next: Vec<_> = left.iter().copied().filter(stays).collect();
        assert!(next.len() < before, "these modules depend on each other: {next:?}");
        left = next;
    }
}

#[test]
fn forbidden_dependencies_do_not_exist() {
    let dependencies = dependencies();
    for (module, forbidden) in [
        ("record", "log"),
        ("log", "simulator"),
        ("explorer", "simulator"),
        ("explorer", "log"),
        ("robot", "simulator"),
        ("conform", "evaluation"),
        ("conform", "simulator"),
        ("ground_truth_monitor", "evaluation"),
        ("ground_truth_monitor", "simulator"),
        ("replay", "simulator"),
        ("simulator", "evaluation"),
    ] {
        assert!(!dependencies[module].contains(forbidden), "{module} depends on {forbidden}");
    }
    let live = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/ros1/live.rs");
    let mut used = BTreeSet::new();
    collect(&live, &mut used);
    assert!(used.contains("record") && !used.contains("simulator"), "{used:?}");
}
