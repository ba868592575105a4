//! What several tests need: embedded graphs of every kind, a walk in one, and a watch that stops.

use std::sync::atomic::{AtomicU64, Ordering};

use proptest::{collection::vec, prelude::*};

use crate::{
    aid::Aid,
    embedded_graph::EmbeddedGraph,
    enumerate::{Each, Enumeration, Watch},
    format::{named_world::NamedWorld, world_file},
    percept::{Door, Percept},
    world::{GraphWorld, World},
};

pub(crate) use crate::enumerate::Class;

/// Any connected embedded graph of the class, multigraph or simple, with up to `most` edges and of
/// any genus.
pub(crate) fn any_graph(class: Class, most: usize) -> impl Strategy<Value = EmbeddedGraph> {
    // Each edge: a corner that it leaves, whether it leads to a new vertex, a corner where it ends.
    let edge = (any::<u16>(), any::<bool>(), any::<u16>());
    vec(edge, 1..=most).prop_map(move |edges| grown(class, &edges))
}

fn grown(class: Class, edges: &[(u16, bool, u16)]) -> EmbeddedGraph {
    let mut lists: Vec<Vec<(usize, usize)>> = vec![vec![]];
    for (edge, &(from, new, to)) in edges.iter().enumerate() {
        let u = usize::from(from) % lists.len();
        let mut v = usize::from(to) % lists.len();
        let joined = u == v || lists[u].iter().any(|&(_, neighbour)| neighbour == v);
        if new || (matches!(class, Class::Simple) && joined) {
            v = lists.len();
            lists.push(vec![]);
        }
        for (here, there, corner) in [(u, v, from), (v, u, to)] {
            let corner = usize::from(corner) / 7 % (lists[here].len() + 1);
            lists[here].insert(corner, (edge, there));
        }
    }
    let named: Vec<(String, Vec<String>)> = lists
        .iter()
        .enumerate()
        .map(|(vertex, list)| {
            let edges = list.iter().map(|(edge, _)| edge.to_string());
            (vertex.to_string(), edges.collect())
        })
        .collect();
    EmbeddedGraph::from_edge_lists(&named).unwrap()
}

/// The embedded graph of the clockwise neighbours of each vertex, as in `a: b | b: a c | c: b`.
pub(crate) fn by_neighbours(text: &str) -> EmbeddedGraph {
    EmbeddedGraph::from_neighbour_lists(&lists(text)).unwrap()
}

/// The embedded graph of the clockwise edges of each vertex, as in `u: loop loop way | v: way`.
pub(crate) fn by_edges(text: &str) -> EmbeddedGraph {
    EmbeddedGraph::from_edge_lists(&lists(text)).unwrap()
}

fn lists(text: &str) -> Vec<(&str, Vec<&str>)> {
    let vertices = text.split('|').map(|vertex| vertex.split_once(':').unwrap());
    vertices.map(|(name, list)| (name.trim(), list.split_whitespace().collect())).collect()
}

/// A world of `worlds/`.
pub(crate) fn world(name: &str) -> NamedWorld {
    let path = format!("{}/../worlds/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    world_file::read(&std::fs::read(path).unwrap()).unwrap()
}

/// Every start of a class with a number of edges. Its facing dart is dart 0.
pub(crate) fn starts(class: Class, edges: usize) -> Vec<EmbeddedGraph> {
    Enumeration::new(Each::Start, class, edges).unwrap().graphs().collect()
}

/// Stops what it watches at the question with this number, from 1.
pub(crate) struct StopAt {
    at: u64,
    asked: AtomicU64,
}

impl StopAt {
    pub(crate) fn new(at: u64) -> Self {
        Self { at, asked: AtomicU64::new(0) }
    }

    pub(crate) fn asked(&self) -> u64 {
        self.asked.load(Ordering::Relaxed)
    }
}

impl Watch for StopAt {
    fn stop(&self) -> bool {
        self.asked.fetch_add(1, Ordering::Relaxed) + 1 >= self.at
    }
}

/// A walk of a robot: what it perceives, and the doors that it takes. Doors are counted modulo the degree.
pub(crate) fn walk<A: Aid>(
    mut world: GraphWorld<'_, A>,
    turns: impl IntoIterator<Item = u32>,
) -> (Vec<Percept>, Vec<Door>) {
    let (mut percepts, mut doors) = (vec![world.sensed()], vec![]);
    for turn in turns {
        let door = Door(turn % world.sensed().degree);
        world.traverse(door).unwrap();
        doors.push(door);
        percepts.push(world.sensed());
    }
    (percepts, doors)
}
