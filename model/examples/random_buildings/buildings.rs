//! Random buildings, and the moves of an algorithm in one. Each map is judged by a bijection.

use std::{
    borrow::Cow,
    time::{Duration, Instant},
};

use petgraph::unionfind::UnionFind;
use toposlam_model::{
    check::judge_map,
    embedded_graph::{Dart, EmbeddedGraph},
    isomorphism::Candidate,
    mapping::{DEFAULT_DART_BOUND, ExploredMap, FACING, MappingAlgorithm},
    world::GraphWorld,
};

/// The number of buildings of each size.
pub(crate) const BUILDINGS: usize = 10;
/// Hallways besides the tree, for 100 junctions.
pub(crate) const MORE_HALLWAYS: usize = 25;
/// The most hallways at a junction.
const DOORS: usize = 3;

/// A linear congruential generator, with Knuth's constants.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn below(&mut self, n: usize) -> usize {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % n
    }
}

/// A building, and the column and the row of each junction on the grid.
pub(crate) type Building = (EmbeddedGraph, Vec<[usize; 2]>);

/// A building with at most this number of junctions: those that the tree has reached from the first.
fn building(junctions: usize, more_hallways: usize, random: &mut Random) -> Building {
    let width = (1..=junctions).find(|width| width * width >= junctions).unwrap();
    let right = |at: usize| (at % width + 1 < width).then_some(at + 1);
    let below = |at: usize| Some(at + width);
    let neighbours = |at| [right(at), below(at)].into_iter().flatten().map(move |to| (at, to));
    let mut hallways: Vec<_> =
        (0..junctions).flat_map(neighbours).filter(|&(_, to)| to < junctions).collect();
    for last in (1..hallways.len()).rev() {
        hallways.swap(last, random.below(last + 1));
    }
    let mut parts = UnionFind::<usize>::new(junctions);
    let mut around = vec![Vec::new(); junctions];
    let mut more = Vec::new();
    for (from, to) in hallways {
        if [from, to].iter().all(|&at| around[at].len() < DOORS) && parts.union(from, to) {
            around[from].push(to);
            around[to].push(from);
        } else {
            more.push((from, to));
        }
    }
    let mut left = junctions * more_hallways / 100;
    for (from, to) in more {
        if left > 0 && [from, to].iter().all(|&at| around[at].len() < DOORS) {
            around[from].push(to);
            around[to].push(from);
            left -= 1;
        }
    }
    let reached = (0..junctions).filter(|&at| parts.equiv(at, 0));
    let places = reached.clone().map(|at| [at % width, at / width]).collect();
    let lists: Vec<(String, Vec<String>)> = reached
        .map(|at| {
            // Clockwise: up, right, down, left.
            let side = |to: usize| match to {
                to if to + width == at => 0,
                to if to == at + 1 => 1,
                to if to == at + width => 2,
                _ => 3,
            };
            let mut around = around[at].clone();
            around.sort_unstable_by_key(|&to| side(to));
            (at.to_string(), around.iter().map(ToString::to_string).collect())
        })
        .collect();
    (EmbeddedGraph::from_neighbour_lists(&lists).unwrap(), places)
}

/// The buildings of seed 7 with at most so many junctions.
pub(crate) fn buildings_on_grid(junctions: usize, more_hallways: usize) -> Vec<Building> {
    let mut random = Random(7);
    (0..BUILDINGS).map(|_| building(junctions, more_hallways, &mut random)).collect()
}

/// The embedded graphs of these buildings.
pub(crate) fn buildings(junctions: usize, more_hallways: usize) -> Vec<EmbeddedGraph> {
    buildings_on_grid(junctions, more_hallways).into_iter().map(|(graph, _)| graph).collect()
}

/// The moves of an algorithm whose map is right, and how long it computes.
pub(crate) fn moves(algorithm: MappingAlgorithm, graph: &EmbeddedGraph) -> (u64, Duration) {
    let begun = Instant::now();
    let mut world = GraphWorld::with_aid(graph, algorithm.aid(), Dart(0));
    let (run, mapped) = algorithm.map_world(&mut world, DEFAULT_DART_BOUND, &mut ());
    mapped.unwrap();
    let computed = begun.elapsed();
    let map = Cow::Borrowed(run.map().complete().unwrap());
    let map = ExploredMap { graph: map, facing: FACING, pose: run.robot() };
    judge_map(&map, (graph, Dart(0)), world.pose(), &mut Candidate::default()).unwrap();
    assert_eq!(run.moves(), world.moves());
    assert!(run.moves() <= algorithm.move_bound(graph.edge_count(), graph.vertex_count()));
    (run.moves(), computed)
}
