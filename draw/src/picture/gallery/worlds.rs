//! The worlds of the gallery.

use std::f64::consts::TAU;

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    format::{named_world::NamedWorld, world_file},
};

use super::super::example;

/// A simple world: `"x: a b d c, a: b x c"`.
pub(in super::super) fn simple(name: &str, text: &str) -> NamedWorld {
    let lists = lists(text);
    let graph = EmbeddedGraph::from_neighbour_lists(&lists).unwrap();
    NamedWorld { edge_names: None, ..of_lists(name, graph, lists) }
}

pub(in super::super) fn multigraph(name: &str, text: &str) -> NamedWorld {
    let lists = lists(text);
    of_lists(name, EmbeddedGraph::from_edge_lists(&lists).unwrap(), lists)
}

/// A world with the names of its lists.
fn of_lists(name: &str, graph: EmbeddedGraph, lists: Vec<(String, Vec<String>)>) -> NamedWorld {
    let (vertex_names, edges): (_, Vec<_>) = lists.into_iter().unzip();
    NamedWorld {
        vertex_names,
        edge_names: Some(edges.concat()),
        ..NamedWorld::numbered(name, "", graph, Some(Dart(0)))
    }
}

fn lists(text: &str) -> Vec<(String, Vec<String>)> {
    text.split(',')
        .map(|list| {
            let (name, rest) = list.split_once(':').unwrap();
            let rest = rest.split_whitespace().map(str::to_owned).collect();
            (name.trim().to_owned(), rest)
        })
        .collect()
}

fn plan(name: &str, junctions: &[(&str, f64, f64)], hallways: &[(&str, &str)]) -> NamedWorld {
    let places = junctions.iter().map(|(name, x, y)| format!("{name} = [{x}, {y}]\n"));
    let places: String = places.collect();
    let ways = hallways
        .iter()
        .map(|(from, to)| format!("[[hallways]]\nfrom = \"{from}\"\nto = \"{to}\"\n"));
    let ways: String = ways.collect();
    let text = format!("[floor]\nhallway_width = 1.6\n[junctions]\n{places}{ways}");
    let read = world_file::read(text.as_bytes()).unwrap();
    NamedWorld { name: name.to_owned(), start: Some(Dart(0)), ..read }
}

/// The same world with its vertices on a circle.
fn on_a_circle(name: &str, world: NamedWorld) -> NamedWorld {
    let count = world.graph.vertex_count();
    let at = |vertex| f64::sin_cos(TAU * vertex as f64 / count as f64);
    let positions = (0..count).map(|vertex| <[f64; 2]>::from(at(vertex))).collect();
    NamedWorld { name: name.to_owned(), positions: Some(positions), ..world }
}

pub(super) fn cycle(edges: usize) -> NamedWorld {
    let list = |at| format!("{at}: {} {}", (at + edges - 1) % edges, (at + 1) % edges);
    simple(&format!("cycle-{edges}"), &(0..edges).map(list).collect::<Vec<_>>().join(","))
}

/// Random numbers of a fixed seed.
struct Dice(u64);

impl Dice {
    fn below(&mut self, bound: usize) -> usize {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % bound
    }
}

/// A random connected world: a tree, and further edges at random places.
pub(super) fn random(seed: u64, vertices: usize, edges: usize) -> NamedWorld {
    let mut dice = Dice(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
    let mut lists: Vec<(String, Vec<String>)> =
        (0..vertices).map(|at| (format!("v{at}"), Vec::new())).collect();
    for edge in 0..edges {
        let (u, v) = if edge + 1 < vertices {
            (dice.below(edge + 1), edge + 1)
        } else {
            (dice.below(vertices), dice.below(vertices))
        };
        for end in [u, v] {
            let place = dice.below(lists[end].1.len() + 1);
            lists[end].1.insert(place, format!("e{edge}"));
        }
    }
    let graph = EmbeddedGraph::from_edge_lists(&lists).unwrap();
    let name = format!("random-{vertices}-{edges}-{seed} (genus {})", graph.genus());
    of_lists(&name, graph, lists)
}

fn tree(vertices: usize) -> NamedWorld {
    let mut found = random(5, vertices, vertices - 1);
    found.name = format!("tree-{vertices}");
    found.edge_names = None;
    found
}

/// Worlds of all kinds.
pub(super) fn gallery() -> Vec<NamedWorld> {
    let star: Vec<_> = (1..=5).map(|at| format!("{at}: c")).collect();
    let star = format!("c: 1 2 3 4 5, {}", star.join(", "));
    let names_beside = "theAssemblyHallOfTheHouse: kitchen archiveOfTheLibrary stairs, \
                        kitchen: theAssemblyHallOfTheHouse archiveOfTheLibrary, \
                        archiveOfTheLibrary: theAssemblyHallOfTheHouse kitchen, \
                        stairs: theAssemblyHallOfTheHouse";
    let long_names = "the-great-hall: kitchen archive stairs, kitchen: the-great-hall archive, \
                      archive: the-great-hall kitchen, stairs: the-great-hall";
    let mut worlds = vec![
        simple("figure-1a", "x: a b d c, a: b x c, b: d x a, d: b c x, c: a x d"),
        simple("figure-1b", "X: A B D C, A: C X B, B: A X D, D: X C B, C: D X A"),
        cycle(3),
        cycle(4),
        cycle(12),
        simple("one edge", "u: v, v: u"),
        simple("chain-5", "0: 1, 1: 0 2, 2: 1 3, 3: 2 4, 4: 3 5, 5: 4"),
        simple("star-5", &star),
        simple("k4-plane", "c: 1 2 3, 1: 2 c 3, 2: 3 c 1, 3: 1 c 2"),
        simple("k4-torus", "c: 1 2 3, 1: 3 c 2, 2: 3 c 1, 3: 1 c 2"),
        multigraph("theta-plane", "u: a b c, v: c b a"),
        multigraph("theta-torus", "u: a b c, v: a b c"),
        multigraph("one loop", "u: a a"),
        multigraph("two loops, side by side", "u: a a b b"),
        multigraph("two loops, one in the other", "u: a b b a"),
        multigraph("two loops, interleaved", "u: a b a b"),
        multigraph("dumbbell", "u: l b l, v: b r r"),
        multigraph("lollipop", "u: p q, v: p q r, w: r s t, x: s t"),
        simple(
            "petersen",
            "0: 1 5 4, 1: 2 6 0, 2: 3 7 1, 3: 4 8 2, 4: 0 9 3, \
             5: 0 7 8, 6: 1 8 9, 7: 2 9 5, 8: 3 5 6, 9: 4 6 7",
        ),
        simple(
            "cube",
            "0: 1 4 3, 1: 2 5 0, 2: 3 6 1, 3: 0 7 2, 4: 0 5 7, 5: 1 6 4, 6: 2 7 5, 7: 3 4 6",
        ),
        example::world("shape-6"),
        example::world("shape-8"),
        example::world("building-12"),
        example::world("building-25"),
        tree(14),
        tree(38),
        random(1, 4, 7),
        random(2, 6, 9),
        random(3, 8, 12),
        random(4, 3, 8),
        random(7, 12, 16),
        random(8, 20, 24),
        random(9, 1, 4),
        random(10, 40, 48),
        simple("names in two lines", long_names),
        simple("names beside", names_beside),
        plan(
            "plan with names beside",
            &[
                ("anIncrediblyLongName", 0.0, 0.0),
                ("anotherNameOfTheSame", 4.0, 0.0),
                ("theCrossingInTheMiddle", 4.0, 4.0),
                ("a-name-with-many-signs-in-it", 8.0, 4.0),
                ("theVeryLongestNameOfAll", 0.0, 4.0),
            ],
            &[
                ("anIncrediblyLongName", "anotherNameOfTheSame"),
                ("anotherNameOfTheSame", "theCrossingInTheMiddle"),
                ("theCrossingInTheMiddle", "a-name-with-many-signs-in-it"),
                ("theCrossingInTheMiddle", "theVeryLongestNameOfAll"),
                ("theVeryLongestNameOfAll", "anIncrediblyLongName"),
            ],
        ),
        on_a_circle("twelve on a circle", random(7, 12, 16)),
        on_a_circle("eight on a circle", random(3, 8, 12)),
    ];
    worlds[0].about = "mapped with the directional marker in 31 moves".to_owned();
    worlds
}
