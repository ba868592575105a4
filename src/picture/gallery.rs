//! Pictures of many worlds, held against their graphs. To look at them, name a directory:
//! `PICTURES=some/directory cargo test --release gallery`.

use std::{collections::BTreeMap, f64::consts::TAU, time::Instant};

use resvg::usvg::roxmltree::{Document, Node};

use super::{Picture, png, svg};
use crate::model::{
    embedded_graph::{Dart, EmbeddedGraph},
    format::named_world::NamedWorld,
};

fn world(name: &str, graph: EmbeddedGraph, vertex_names: Vec<String>) -> NamedWorld {
    NamedWorld {
        name: name.to_owned(),
        about: String::new(),
        graph,
        start: Some(Dart(0)),
        vertex_names,
        edge_names: None,
        positions: None,
        plan: None,
    }
}

/// A simple world: `"x: a b d c, a: b x c"`.
fn simple(name: &str, text: &str) -> NamedWorld {
    let lists = lists(text);
    let names = lists.iter().map(|(name, _)| name.clone()).collect();
    world(name, EmbeddedGraph::from_neighbour_lists(&lists).unwrap(), names)
}

/// A world whose edges have names.
fn multigraph(name: &str, text: &str) -> NamedWorld {
    let lists = lists(text);
    let names = lists.iter().map(|(name, _)| name.clone()).collect();
    let edges = lists.iter().flat_map(|(_, edges)| edges.clone()).collect();
    NamedWorld {
        edge_names: Some(edges),
        ..world(name, EmbeddedGraph::from_edge_lists(&lists).unwrap(), names)
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

/// A floor plan: the neighbours of each junction are sorted clockwise by where they are.
fn plan(name: &str, junctions: &[(&str, f64, f64)], hallways: &[(&str, &str)]) -> NamedWorld {
    let place: BTreeMap<_, _> = junctions.iter().map(|&(n, x, y)| (n, (x, y))).collect();
    let lists: Vec<_> = junctions
        .iter()
        .map(|&(name, x, y)| {
            let mut near: Vec<&str> = hallways
                .iter()
                .filter_map(|&(a, b)| match name {
                    _ if a == name => Some(b),
                    _ if b == name => Some(a),
                    _ => None,
                })
                .collect();
            near.sort_by(|a, b| {
                let bearing = |n: &str| (place[n].0 - x).atan2(place[n].1 - y).rem_euclid(TAU);
                bearing(a).total_cmp(&bearing(b))
            });
            (name, near)
        })
        .collect();
    NamedWorld {
        positions: Some(junctions.iter().map(|&(_, x, y)| [x, y]).collect()),
        ..world(
            name,
            EmbeddedGraph::from_neighbour_lists(&lists).unwrap(),
            junctions.iter().map(|&(name, ..)| name.to_owned()).collect(),
        )
    }
}

/// A grid of junctions 4 m apart, without the hallways whose number is in `closed`.
fn grid(name: &str, columns: usize, rows: usize, closed: &[usize]) -> NamedWorld {
    let names: Vec<_> = (0..columns * rows).map(|at| format!("j{at}")).collect();
    let junctions: Vec<_> = (0..columns * rows)
        .map(|at| {
            let (column, row) = (at % columns, at / columns);
            (names[at].as_str(), 4.0 * column as f64, 4.0 * row as f64)
        })
        .collect();
    let mut hallways = Vec::new();
    for at in 0..columns * rows {
        if at % columns + 1 < columns {
            hallways.push((names[at].as_str(), names[at + 1].as_str()));
        }
        if at / columns + 1 < rows {
            hallways.push((names[at].as_str(), names[at + columns].as_str()));
        }
    }
    let mut number = 0;
    hallways.retain(|_| {
        number += 1;
        !closed.contains(&(number - 1))
    });
    plan(name, &junctions, &hallways)
}

fn cycle(edges: usize) -> NamedWorld {
    let lists: Vec<_> = (0..edges)
        .map(|at| {
            let near = [(at + edges - 1) % edges, (at + 1) % edges];
            (at.to_string(), near.map(|n| n.to_string()).to_vec())
        })
        .collect();
    let names = (0..edges).map(|at| at.to_string()).collect();
    let graph = EmbeddedGraph::from_neighbour_lists(&lists).unwrap();
    world(&format!("cycle-{edges}"), graph, names)
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

/// A random connected world: a tree, and further edges put in at random places.
fn random(seed: u64, vertices: usize, edges: usize) -> NamedWorld {
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
    let names = lists.iter().map(|(name, _)| name.clone()).collect();
    let graph = EmbeddedGraph::from_edge_lists(&lists).unwrap();
    let name = format!("random-{vertices}-{edges}-{seed} (genus {})", graph.genus());
    NamedWorld {
        edge_names: Some(lists.into_iter().flat_map(|(_, edges)| edges).collect()),
        ..world(&name, graph, names)
    }
}

fn tree(vertices: usize) -> NamedWorld {
    let mut found = random(5, vertices, vertices - 1);
    found.name = format!("tree-{vertices}");
    found.edge_names = None;
    found
}

fn gallery() -> Vec<NamedWorld> {
    let star: Vec<_> = (1..=5).map(|at| format!("{at}: c")).collect();
    let star = format!("c: 1 2 3 4 5, {}", star.join(", "));
    let long_names = "the-hall: kitchen archive stairs, kitchen: the-hall archive, \
                      archive: the-hall kitchen, stairs: the-hall";
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
        plan(
            "shape-6",
            &[
                ("end", 4.0, 8.0),
                ("corner", 0.0, 8.0),
                ("tee", 0.0, 4.0),
                ("sw", 0.0, 0.0),
                ("se", 4.0, 0.0),
                ("ne", 4.0, 4.0),
            ],
            &[
                ("end", "corner"),
                ("corner", "tee"),
                ("tee", "sw"),
                ("sw", "se"),
                ("se", "ne"),
                ("ne", "tee"),
            ],
        ),
        plan(
            "shape-8",
            &[
                ("nw", 0.0, 8.0),
                ("ne", 4.0, 8.0),
                ("e", 4.0, 4.0),
                ("se", 4.0, 0.0),
                ("sw", 0.0, 0.0),
                ("w", 0.0, 4.0),
            ],
            &[
                ("nw", "ne"),
                ("ne", "e"),
                ("e", "se"),
                ("se", "sw"),
                ("sw", "w"),
                ("w", "nw"),
                ("w", "e"),
            ],
        ),
        grid("floor plan of 12 junctions", 4, 3, &[3, 8, 11]),
        grid("floor plan of 25 junctions", 5, 5, &[2, 6, 9, 13, 14, 22, 27, 30, 35]),
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
        simple("long names", long_names),
    ];
    worlds[0].about = "mapped with the directional marker in 31 moves".to_owned();
    worlds
}

fn attribute(node: Node, name: &str) -> f64 {
    node.attribute(name).unwrap().parse().unwrap()
}

/// The numbers in path data.
fn numbers(path: &str) -> Vec<f64> {
    path.split(|letter: char| letter.is_alphabetic() || letter == ' ')
        .filter(|number| !number.is_empty())
        .map(|number| number.parse().unwrap())
        .collect()
}

/// Reads the order off the SVG and holds it against the graph.
fn assert_doors_in_order(world: &NamedWorld, svg: &str) {
    let document = Document::parse(svg).unwrap();
    let of_class = |class: &'static str| {
        document.descendants().filter(move |node| node.attribute("class") == Some(class))
    };
    let centres: Vec<[f64; 3]> = of_class("vertex")
        .map(|node| ["cx", "cy", "r"].map(|name| attribute(node, name)))
        .collect();
    let graph = &world.graph;
    assert_eq!(centres.len(), graph.vertex_count());
    let mut angles = vec![None; graph.dart_count()];
    let mut paths = 0;
    for node in of_class("edge") {
        paths += 1;
        let darts = numbers(node.attribute("data-darts").unwrap());
        let path = numbers(node.attribute("d").unwrap());
        let at = |place: usize| [path[2 * place], path[2 * place + 1]];
        let last = path.len() / 2 - 1;
        for (dart, end, control) in [(darts[0], at(0), at(1)), (darts[1], at(last), at(last - 1))] {
            let dart = graph.darts().find(|known| (f64::from(known.0) - dart).abs() < 0.5).unwrap();
            let [x, y, r] = centres[graph.vertex(dart).at()];
            let angle = (end[1] - y).atan2(end[0] - x);
            // On the border, and straight out.
            assert!(((end[1] - y).hypot(end[0] - x) - r).abs() < 0.2, "{}", world.name);
            let out = (control[1] - end[1]).atan2(control[0] - end[0]);
            assert!((out - angle).cos() > 0.99, "{}: {dart:?}", world.name);
            assert_eq!(angles[dart.at()].replace(angle), None);
        }
    }
    assert_eq!(paths, graph.edge_count());
    for vertex in graph.vertices() {
        let degree = f64::from(graph.degree(vertex));
        let mut whole = 0.0;
        for dart in graph.darts_of(vertex) {
            let next = graph.clockwise(dart);
            if next == dart {
                continue;
            }
            // y points down: a growing angle is a clockwise turn.
            let (here, there) = (angles[dart.at()].unwrap(), angles[next.at()].unwrap());
            let gap = f64::rem_euclid(there - here, TAU);
            let least = (0.8 * TAU / degree).min(0.25);
            assert!(gap > least, "{}: {dart:?} to {next:?}: {gap}", world.name);
            whole += gap;
        }
        assert!(degree < 2.0 || (whole - TAU).abs() < 1e-6, "{}", world.name);
    }
}

#[test]
fn doors_stand_in_clockwise_order_in_every_picture() {
    let directory = std::env::var_os("PICTURES");
    for world in gallery() {
        let begun = Instant::now();
        let drawn = svg(&Picture::from(&world));
        let spent = begun.elapsed();
        assert_doors_in_order(&world, &drawn);
        assert_eq!(drawn, svg(&Picture::from(&world)));
        if let Some(directory) = &directory {
            let path = std::path::Path::new(directory);
            let name = world.name.replace([' ', ',', '(', ')'], "-");
            std::fs::write(path.join(format!("{name}.svg")), &drawn).unwrap();
            std::fs::write(path.join(format!("{name}.png")), png(&drawn).unwrap()).unwrap();
            println!("{name}: {spent:?}");
        }
    }
}

#[test]
fn doors_stand_in_clockwise_order_whatever_the_world() {
    for seed in 0..150 {
        let vertices = 1 + (seed as usize * 7) % 9;
        let world = random(100 + seed, vertices, vertices + (seed as usize) % 5);
        assert_doors_in_order(&world, &svg(&Picture::from(&world)));
    }
}

/// How often the curves of the picture cross.
fn crossings(world: &NamedWorld) -> usize {
    let drawing = super::drawing::Drawing::of(&Picture::from(world));
    let mut count = 0;
    for (at, (.., one)) in drawing.edges.iter().enumerate() {
        for (.., other) in &drawing.edges[..at] {
            count += super::routes::crossings(one, other).len();
        }
    }
    count
}

#[test]
fn a_world_in_the_plane_is_drawn_without_crossings() {
    let mut planar = 0;
    let many = (0..250_u64).map(|seed| {
        let vertices = 1 + (seed as usize * 5) % 11;
        random(1000 + seed, vertices, vertices + (seed as usize) % 3)
    });
    for world in gallery().into_iter().chain(many) {
        if world.graph.genus() == 0 {
            planar += 1;
            assert_eq!(crossings(&world), 0, "{}", world.name);
        }
    }
    assert!(planar > 100, "{planar}");
}

#[test]
fn a_world_of_two_thousand_vertices_is_drawn_in_seconds() {
    for world in [random(1, 2000, 1999), random(2, 2000, 3000), cycle(2000)] {
        let begun = Instant::now();
        let drawn = svg(&Picture::from(&world));
        assert_doors_in_order(&world, &drawn);
        assert!(begun.elapsed().as_secs() < 20, "{}", world.name);
        println!("{}: {:?}", world.name, begun.elapsed());
        if let Some(directory) = std::env::var_os("PICTURES") {
            let path = std::path::Path::new(&directory).join(format!("{}.png", world.name));
            std::fs::write(path, png(&drawn).unwrap()).unwrap();
        }
    }
}
