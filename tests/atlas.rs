//! The atlas in `worlds/atlas` contains what the search finds, up to sizes that take seconds. The command
//! in its README writes all of it.

use std::collections::BTreeSet;

use serde_json::Value;
use toposlam_model::{
    aid::{AIDS, AidKind, FEW_STATES},
    enumerate::Class,
    format::world_file,
};
use toposlam_proofs::marker_theorems::about;

use crate::{output::names_in, printed, program, read, repository};

/// A cell of the atlas's table, without its links.
fn cell(table: &str, marker: AidKind, class: Class) -> String {
    let start = format!("| {} |", marker.name());
    let row = table.lines().find(|line| line.starts_with(&start)).unwrap();
    let column = Class::ALL.iter().position(|&known| known == class).unwrap();
    let cell = row.split('|').nth(2 + column).unwrap();
    let parts = cell.split('[').map(|part| part.split_once(']').map_or(part, |(text, _)| text));
    parts.map(str::trim).collect::<Vec<_>>().join(" ").trim().to_owned()
}

#[test]
fn the_atlas_contains_what_the_search_finds() {
    let table = read("worlds/atlas/README.md");
    let mut files = BTreeSet::from(["README.md".to_owned()]);
    // Each class with the size that is searched here, and that of the whole atlas.
    for (class, edges, whole) in [
        (Class::Multigraph, 5, 7),
        (Class::Simple, 8, 10),
        (Class::Corridor, 9, 12),
        (Class::Planar, 8, 10),
    ] {
        assert!(table.contains(&format!("{class} {whole}")), "{class}");
        for &marker in FEW_STATES {
            let (name, class_name) = (marker.name(), class.name());
            let search = format!("counterexample --json --class {class_name} --marker {name}");
            let search = format!("{search} --max-edges {edges}");
            let lines = printed(program().args(search.split(' ')));
            let last: Value = serde_json::from_str(lines.lines().last().unwrap()).unwrap();
            // If a theorem decides, it agrees.
            let theorem = about(name, class);
            let found = match last["smallest"]["worlds"].as_array() {
                None => match &theorem {
                    Some(theorem) => format!("none: `{}`", theorem.theorem),
                    None => format!("none up to {whole} edges"),
                },
                Some(worlds) => {
                    let sizes = worlds.iter().map(|world| {
                        let world = world_file::read(world.to_string().as_bytes()).unwrap();
                        let [toml, svg] =
                            ["toml", "svg"].map(|end| format!("{}.{end}", world.name));
                        let file = format!("worlds/atlas/{toml}");
                        assert!(read(&file) == world_file::to_toml(&world), "{toml}");
                        assert_eq!(world.marker, Some(marker), "{toml}");
                        let drawn = printed(program().args(["draw", &file]));
                        assert!(read(&format!("worlds/atlas/{svg}")) == drawn, "{svg}");
                        for file in [toml, svg] {
                            assert!(table.contains(&format!("]({file})")), "{file}");
                            files.insert(file);
                        }
                        let edges = world.graph.edge_count();
                        format!("{edges} edge{}", if edges == 1 { "" } else { "s" })
                    });
                    sizes.collect::<Vec<_>>().join(" ")
                }
            };
            assert_eq!(cell(&table, marker, class), found, "{class} {marker:?}");
            if let Some(theorem) = theorem {
                assert_eq!(theorem.suffices, last["smallest"].is_null(), "{class} {marker:?}");
                assert!(table.contains(&format!(": `{}` |", theorem.theorem)), "{class} {name}");
            }
        }
    }
    assert_eq!(names_in(&repository("worlds/atlas")), files.into_iter().collect::<Vec<_>>());
    assert_eq!(names_in(&repository("worlds/atlas")).len(), 1 + 18 * 2 * 2);
}

/// The other aids that move: in each class either a theorem says that they suffice, or their smallest pair is in the
/// files of an aid with the same pair.
#[test]
fn aids_with_the_same_pairs_have_the_same_files() {
    let table = read("worlds/atlas/README.md");
    for aid in AIDS.into_iter().filter(|aid| aid.marks() && !FEW_STATES.contains(aid)) {
        for class in Class::ALL {
            let theorem = about(aid.name(), class).unwrap();
            if theorem.suffices {
                assert_eq!(cell(&table, aid, class), format!("none: `{}`", theorem.theorem));
                continue;
            }
            let search = "counterexample --json --max-edges 3 --class";
            let search = format!("{search} {} --marker {}", class.name(), aid.name());
            let lines = printed(program().args(search.split(' ')));
            let last: Value = serde_json::from_str(lines.lines().last().unwrap()).unwrap();
            for (number, world) in last["smallest"]["worlds"].as_array().unwrap().iter().enumerate()
            {
                let found = world_file::read(world.to_string().as_bytes()).unwrap();
                let file = format!("movable-{}-{}.toml", class.name(), number + 1);
                let filed = world_file::read(read(&format!("worlds/atlas/{file}")).as_bytes());
                let filed = filed.unwrap();
                assert_eq!((found.graph, found.start), (filed.graph, filed.start), "{aid:?}");
                let row =
                    table.lines().find(|line| line.starts_with(&format!("| {} |", aid.name())));
                assert!(row.unwrap().contains(&format!("]({file})")), "{aid:?}");
            }
            assert_eq!(cell(&table, aid, class), "2 edges 2 edges", "{aid:?} {class}");
            assert!(table.contains(&format!(": `{}` |", theorem.theorem)), "{class} {aid:?}");
        }
    }
}
