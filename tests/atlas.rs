//! The atlas in `worlds/atlas` contains what the search finds, up to sizes that take seconds. The command
//! in its README writes all of it.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::{collections::BTreeSet, fs, path::Path, process::Command};

use serde_json::Value;
use toposlam_model::{
    enumerate::Class,
    format::world_file,
    marker::{MARKERS, Marker},
};
use toposlam_proofs::marker_theorems::about;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn toposlam(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_toposlam"))
        .current_dir(ROOT)
        .args(arguments)
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stdout).unwrap()
}

fn read(name: &str) -> String {
    fs::read_to_string(Path::new(ROOT).join("worlds/atlas").join(name)).unwrap()
}

/// A cell of the atlas's table, without its links.
fn cell(table: &str, marker: &dyn Marker, class: Class) -> String {
    let start = format!("| {} |", marker.name());
    let row = table.lines().find(|line| line.starts_with(&start)).unwrap();
    let column = Class::ALL.iter().position(|&known| known == class).unwrap();
    let cell = row.split('|').nth(2 + column).unwrap();
    let parts = cell.split('[').map(|part| match part.split_once(']') {
        None => part,
        Some((text, _)) => text,
    });
    parts.map(str::trim).collect::<Vec<_>>().join(" ").trim().to_owned()
}

#[test]
fn the_atlas_contains_what_the_search_finds() {
    let table = read("README.md");
    let mut files = BTreeSet::from(["README.md".to_owned()]);
    // Each class with the size that is searched here, and that of the whole atlas.
    for (class, edges, whole) in [
        (Class::Multigraph, 5, 7),
        (Class::Simple, 8, 10),
        (Class::Corridor, 9, 12),
        (Class::Planar, 8, 10),
    ] {
        assert!(table.contains(&format!("{class} {whole}")), "{class}");
        for marker in MARKERS {
            let (edges, class_name) = (edges.to_string(), class.name());
            let arguments =
                ["--class", class_name, "--max-edges", &edges, "--marker", marker.name()];
            let lines = toposlam(&[&["counterexample", "--json"], &arguments[..]].concat());
            let last: Value = serde_json::from_str(lines.lines().last().unwrap()).unwrap();
            let Some(worlds) = last["smallest"]["worlds"].as_array() else {
                let cell = cell(&table, marker, class);
                let none = match about(marker.name(), class) {
                    Some(theorem) => {
                        assert!(theorem.suffices, "{class} {marker:?}");
                        format!("none: `{}`", theorem.theorem)
                    }
                    None => format!("none up to {whole} edges"),
                };
                assert_eq!(cell, none, "{class} {marker:?}");
                continue;
            };
            // If a theorem decides, it agrees.
            if let Some(theorem) = about(marker.name(), class) {
                assert!(!theorem.suffices, "{class} {marker:?}");
                assert!(
                    table.contains(&format!(": `{}` |", theorem.theorem)),
                    "{class} {marker:?}"
                );
            }
            let mut sizes = Vec::new();
            for world in worlds {
                let world = world_file::read(world.to_string().as_bytes()).unwrap();
                let [toml, svg] = ["toml", "svg"].map(|end| format!("{}.{end}", world.name));
                assert!(read(&toml) == world_file::to_toml(&world), "{toml}");
                let file = format!("worlds/atlas/{toml}");
                assert_eq!(world.marker, Some(marker), "{toml}");
                let drawn = toposlam(&["draw", &file]);
                assert!(read(&svg) == drawn, "{svg}");
                assert!(table.contains(&format!("]({toml})")), "{toml}");
                assert!(table.contains(&format!("]({svg})")), "{svg}");
                files.extend([toml, svg]);
                let edges = world.graph.edge_count();
                sizes.push(format!("{edges} edge{}", if edges == 1 { "" } else { "s" }));
            }
            assert_eq!(cell(&table, marker, class), sizes.join(" "), "{class} {marker:?}");
        }
    }
    let kept = fs::read_dir(Path::new(ROOT).join("worlds/atlas")).unwrap();
    let kept: BTreeSet<_> =
        kept.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    assert_eq!(kept, files, "the atlas contains the pairs and nothing else");
    assert_eq!(files.len(), 1 + 18 * 2 * 2);
}
