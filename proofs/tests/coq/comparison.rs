//! The proved algorithm, extracted, against the running one: on every small start both take the same
//! doors, have the same map, dart for dart, and know the robot in the same pose. Section 2.3.

use std::{
    fs::{self, File},
    iter,
    ops::ControlFlow,
    path::Path,
    process::Command,
};

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Class, Each, Enumeration},
    format::{named_world::NamedWorld, world_file},
    mapping::{Event, Exploration, Journey, Nearest, map_world},
    world::GraphWorld,
};

use crate::{OCAMLOPT, compiled, printed, source};

/// Every start with up to so many edges; its facing dart is dart 0.
fn starts(class: Class, most: usize) -> Vec<EmbeddedGraph> {
    let mut starts = Vec::new();
    for edges in 1..=most {
        let _ = Enumeration::new(Each::Start, class, edges).unwrap().for_each(&mut |found| {
            starts.push(found.graph.clone());
            ControlFlow::Continue(())
        });
    }
    starts
}

fn listed(name: &str, numbers: impl Iterator<Item = u32>) -> String {
    iter::once(name.to_owned()).chain(numbers.map(|n| n.to_string())).collect::<Vec<_>>().join(" ")
}

/// A start, as `compare/main.ml` reads it.
fn line(start: &EmbeddedGraph) -> String {
    let opposite = listed("opposite", start.darts().map(|dart| start.opposite(dart).0));
    let clockwise = listed("clockwise", start.darts().map(|dart| start.clockwise(dart).0));
    [opposite, clockwise].join("; ")
}

/// What Algorithm 1 does in a start, as `compare/main.ml` tells it.
fn told(start: &EmbeddedGraph) -> String {
    let mut doors = Vec::new();
    let mut listen = |_: &Journey, event| {
        if let Event::Moved { door, .. } = event {
            doors.push(door.0);
        }
    };
    let mut world = GraphWorld::new(start, Dart(0));
    let mut exploration = Exploration::new(start.dart_count());
    map_world(&mut world, &mut Nearest, &mut exploration, &mut listen).unwrap();
    let map = exploration.map().complete().unwrap();
    let first = |dart| map.darts_of(map.vertex(dart)).next().unwrap().0;
    let told = [
        listed("doors", doors.into_iter()),
        listed("first", map.darts().map(first)),
        listed("degree", map.darts().map(|dart| map.degree_around(dart))),
        listed("other", map.darts().map(|dart| map.opposite(dart).0)),
        listed("robot", iter::once(exploration.robot().0)),
    ];
    told.join("; ")
}

/// Extracts the program in a folder where the development is compiled, builds it, and runs it in these
/// starts: a line for each.
fn extracted(folder: &Path, starts: &[EmbeddedGraph]) -> String {
    printed(Command::new("make").arg("Extraction.vo").current_dir(folder));
    let program = folder.join("compare");
    let mut ocamlopt = Command::new(OCAMLOPT);
    ocamlopt.current_dir(folder).arg("-o").arg(&program).args(["algorithm1.mli", "algorithm1.ml"]);
    fs::copy(source("compare/main.ml"), folder.join("main.ml")).unwrap();
    printed(ocamlopt.arg("main.ml"));
    let lines = folder.join("starts");
    fs::write(&lines, starts.iter().map(|start| line(start) + "\n").collect::<String>()).unwrap();
    printed(Command::new(program).stdin(File::open(lines).unwrap()))
}

/// The first start of which something else is told, with the difference.
fn difference(starts: &[EmbeddedGraph], proved: &str) -> Option<String> {
    let lines = proved.lines().map(Some).chain(iter::repeat(None));
    let (start, proved) =
        starts.iter().zip(lines).find(|(start, line)| *line != Some(told(start).as_str()))?;
    let proved = proved.unwrap_or("nothing");
    let running = told(start);
    let world = NamedWorld::numbered("start", "", start.clone(), Some(Dart(0)));
    let world = world_file::to_toml(&world);
    Some(format!("the proved algorithm\n  {proved}\nthe running one\n  {running}\nin\n\n{world}"))
}

/// The numbers of starts: A000698 with up to 5 edges; and those with up to 7 that are simple, of which
/// `model/tests/counts.rs` tells how they are held against a filter.
#[test]
fn the_proved_algorithm_and_the_running_one_do_the_same_in_every_small_start() {
    let Some(compiled) = compiled() else { return };
    let multigraphs = starts(Class::Multigraph, 5);
    let simple = starts(Class::Simple, 7);
    assert_eq!((multigraphs.len(), simple.len()), (8954, 4526));
    let starts = [multigraphs, simple].concat();
    let proved = extracted(&compiled.copy("same"), &starts);
    assert_eq!(proved.lines().count(), starts.len());
    if let Some(difference) = difference(&starts, &proved) {
        panic!("{difference}");
    }
}

/// Algorithm 1 with another choice at lines 5 and 9, or another way back, is another algorithm.
#[test]
fn another_algorithm_is_told_apart() {
    let Some(compiled) = compiled() else { return };
    let starts = starts(Class::Multigraph, 3);
    for (change, file, from, to) in [
        ("ties", "Algorithm1.v", "then d else best", "then best else d"),
        ("way back", "Spec.v", "then 0 :: rev [", "then rev ["),
    ] {
        let folder = compiled.copy(&format!("another/{change}"));
        let text = fs::read_to_string(source(file)).unwrap();
        assert_eq!(text.matches(from).count(), 1, "{file}");
        fs::write(folder.join(file), text.replace(from, to)).unwrap();
        let difference = difference(&starts, &extracted(&folder, &starts)).unwrap();
        assert!(difference.contains("[start]\n"), "{difference}");
    }
}
