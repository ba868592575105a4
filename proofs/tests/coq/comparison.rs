//! The proved algorithms, extracted, against the running ones: in every small start both do the same in
//! the same order, have the same map, dart for dart, and know the robot in the same pose. Section 2.3.

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
    mapping::{
        Exploration, Journey, MappingEvent, MarkerSearch, Nearest, Observer, PartialMap,
        map_with_movable_marker, map_world,
    },
    marker::Movable,
    world::GraphWorld,
};

use super::{OCAMLOPT, compiled, printed, source};

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

/// A mapping algorithm, by its marker.
#[derive(Clone, Copy)]
enum Mapping {
    Directional,
    Movable,
}

impl Mapping {
    /// A start, as `compare/main.ml` reads it.
    fn line(self, start: &EmbeddedGraph) -> String {
        let marker = match self {
            Self::Directional => "directional",
            Self::Movable => "movable",
        };
        let opposite = listed("opposite", start.darts().map(|dart| start.opposite(dart).0));
        let clockwise = listed("clockwise", start.darts().map(|dart| start.clockwise(dart).0));
        [marker, &opposite, &clockwise].join("; ")
    }

    /// The run of the running algorithm from a start, in the format of `compare/main.ml`.
    fn run_line(self, start: &EmbeddedGraph) -> String {
        let mut did = Actions(vec!["did".to_owned()]);
        let bound = start.dart_count();
        let known = match self {
            Self::Directional => {
                let mut world = GraphWorld::new(start, Dart(0));
                let mut exploration = Exploration::new(bound);
                map_world(&mut world, &mut Nearest, &mut exploration, &mut did).unwrap();
                known(exploration.map(), exploration.robot())
            }
            Self::Movable => {
                let mut world = GraphWorld::with_marker(start, Movable, Dart(0));
                let mut search = MarkerSearch::new(bound);
                map_with_movable_marker(&mut world, &mut Nearest, &mut search, &mut did).unwrap();
                known(search.map(), search.robot())
            }
        };
        [did.0.join(" "), known].join("; ")
    }
}

/// What the robot did, as text.
struct Actions(Vec<String>);

impl<W: ?Sized> Observer<W> for Actions {
    fn event(&mut self, _: &mut W, _: &Journey, event: MappingEvent) {
        self.0.extend(event.action().map(|action| action.to_string()));
    }
}

/// The map and the robot's pose in it.
fn known(map: &PartialMap, robot: Dart) -> String {
    let map = map.complete().unwrap();
    let first = |dart| map.darts_of(map.vertex(dart)).next().unwrap().0;
    let known = [
        listed("first", map.darts().map(first)),
        listed("degree", map.darts().map(|dart| map.degree_around(dart))),
        listed("other", map.darts().map(|dart| map.opposite(dart).0)),
        listed("robot", iter::once(robot.0)),
    ];
    known.join("; ")
}

/// Extracts the program in a folder where the development is compiled, builds it, and runs an algorithm in
/// these starts: a line for each.
fn extracted(folder: &Path, mapping: Mapping, starts: &[EmbeddedGraph]) -> String {
    printed(Command::new("make").arg("Extraction.vo").current_dir(folder));
    let program = folder.join("compare");
    let mut ocamlopt = Command::new(OCAMLOPT);
    ocamlopt.current_dir(folder).arg("-o").arg(&program).args(["mappings.mli", "mappings.ml"]);
    fs::copy(source("compare/main.ml"), folder.join("main.ml")).unwrap();
    printed(ocamlopt.arg("main.ml"));
    let lines = folder.join("starts");
    fs::write(&lines, starts.iter().map(|start| mapping.line(start) + "\n").collect::<String>())
        .unwrap();
    printed(Command::new(program).stdin(File::open(lines).unwrap()))
}

/// The first start with different runs, and the difference.
fn difference(mapping: Mapping, starts: &[EmbeddedGraph], proved: &str) -> Option<String> {
    let lines = proved.lines().map(Some).chain(iter::repeat(None));
    let (start, proved) = starts
        .iter()
        .zip(lines)
        .find(|(start, line)| *line != Some(mapping.run_line(start).as_str()))?;
    let proved = proved.unwrap_or("nothing");
    let running = mapping.run_line(start);
    let world = NamedWorld::numbered("start", "", start.clone(), Some(Dart(0)));
    let world = world_file::to_toml(&world);
    Some(format!("the proved algorithm\n  {proved}\nthe running one\n  {running}\nin\n\n{world}"))
}

/// In all these starts the proved algorithm and the running one do the same.
fn assert_same(mapping: Mapping, folder: &Path, starts: &[EmbeddedGraph]) {
    let proved = extracted(folder, mapping, starts);
    assert_eq!(proved.lines().count(), starts.len());
    if let Some(difference) = difference(mapping, starts, &proved) {
        panic!("{difference}");
    }
}

/// The numbers of starts: A000698 with up to 5 edges; and those with up to 7 that are simple, of which
/// `model/tests/counts.rs` compares them with a filter.
#[test]
fn the_proved_algorithm_1_and_the_running_one_do_the_same_in_every_small_start() {
    let Some(compiled) = compiled() else { return };
    let multigraphs = starts(Class::Multigraph, 5);
    let simple = starts(Class::Simple, 7);
    assert_eq!((multigraphs.len(), simple.len()), (8954, 4526));
    let starts = [multigraphs, simple].concat();
    assert_same(Mapping::Directional, &compiled.copy("directional"), &starts);
}

#[test]
fn with_a_movable_marker_both_do_the_same_in_every_small_simple_start() {
    let Some(compiled) = compiled() else { return };
    let simple = starts(Class::Simple, 7);
    assert_eq!(simple.len(), 4526);
    assert_same(Mapping::Movable, &compiled.copy("movable"), &simple);
}

/// Algorithm 1 with another choice at lines 5 and 9, or another way back, is another algorithm; so is that
/// of the movable marker where it looks for it in another order.
#[test]
fn another_algorithm_is_told_apart() {
    let Some(compiled) = compiled() else { return };
    let multigraphs = starts(Class::Multigraph, 3);
    let simple = starts(Class::Simple, 7);
    for (change, mapping, starts, file, from, to) in [
        (
            "ties",
            Mapping::Directional,
            &multigraphs,
            "Algorithm1.v",
            "then d else best",
            "then best else d",
        ),
        ("way back", Mapping::Directional, &multigraphs, "Spec.v", "then 0 :: rev [", "then rev ["),
        ("search", Mapping::Movable, &simple, "MovableMarker.v", "(d < d') ||", "(d > d') ||"),
    ] {
        let folder = compiled.copy(&format!("another/{change}"));
        let text = fs::read_to_string(source(file)).unwrap();
        assert_eq!(text.matches(from).count(), 1, "{file}");
        fs::write(folder.join(file), text.replace(from, to)).unwrap();
        let proved = extracted(&folder, mapping, starts);
        let difference = difference(mapping, starts, &proved).unwrap();
        assert!(difference.contains("[start]\n"), "{difference}");
    }
}
