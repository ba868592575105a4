//! How fast the specification runs. `cargo bench -p toposlam-model` (one thread), or with
//! `--features rayon` (the checks on all processors).

#![allow(clippy::unwrap_used, reason = "a benchmark may panic")]

use std::ops::ControlFlow;

use divan::{Bencher, counter::ItemsCount};
use toposlam_model::{
    aid,
    ambiguity::{AmbiguitySearch, Comparison},
    check::{Check, DEFAULT_STATE_BUDGET, RunChoices, Shard, SharedPrefixCheck, judge},
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Class, Each, Enumeration},
    isomorphism::{Candidate, isomorphism},
    mapping::{Algorithm1Run, MovableMarkerRun, explore},
    marker::{MARKERS, MarkerKind},
    world::GraphWorld,
};

fn main() {
    divan::main();
}

/// Embedded graphs up to isomorphism, none looked at.
#[divan::bench(args = [
    ("multigraph", 8, 1_863_359),
    ("simple", 10, 99_642),
    ("corridor", 12, 40_592),
    ("planar", 12, 926_786),
], sample_count = 5)]
fn enumerate(bencher: Bencher, (class, edges, worlds): (&str, usize, u64)) {
    let class: Class = class.parse().unwrap();
    bencher.counter(ItemsCount::new(worlds)).bench(|| {
        let mut count = 0;
        let _ = Enumeration::new(Each::World, class, edges).unwrap().for_each(&mut |_| {
            count += 1;
            ControlFlow::Continue(())
        });
        assert_eq!(count, worlds);
    });
}

/// Algorithm 1 on every start, each map verified.
#[divan::bench(args = [(6, 110_410), (7, 1_708_394)], sample_count = 5)]
fn check(bencher: Bencher, (edges, starts): (usize, u64)) {
    let sweep = Check::new(Class::Multigraph, edges, Shard::WHOLE).unwrap();
    bencher.counter(ItemsCount::new(starts)).bench(|| {
        assert_eq!(sweep.run(Algorithm1Run::default, RunChoices::Default, &()).mapped, starts);
    });
}

/// The same with runs that share their beginnings.
#[divan::bench(args = [(6, 110_410), (7, 1_708_394)], sample_count = 5)]
fn check_lazily(bencher: Bencher, (edges, starts): (usize, u64)) {
    let sweep = SharedPrefixCheck::new(Class::Multigraph, edges, Shard::WHOLE).unwrap();
    bencher.counter(ItemsCount::new(starts)).bench(|| {
        assert_eq!(sweep.run(Algorithm1Run::default, &()).mapped, starts);
    });
}

/// Algorithm 1 with all choices on every start; the items are states.
#[divan::bench(args = [(4, 16_471), (5, 468_929)], sample_count = 3)]
fn every_way(bencher: Bencher, (edges, states): (usize, u64)) {
    let sweep = Check::new(Class::Multigraph, edges, Shard::WHOLE).unwrap();
    let all = RunChoices::All { budget: DEFAULT_STATE_BUDGET };
    bencher.counter(ItemsCount::new(states)).bench(|| {
        assert_eq!(sweep.run(Algorithm1Run::default, all, &()).states, states);
    });
}

/// With a movable marker, every start of every simple world with 8 edges.
#[divan::bench(sample_count = 5)]
fn check_movable(bencher: Bencher) {
    let sweep = Check::new(Class::Simple, 8, Shard::WHOLE).unwrap();
    bencher.counter(ItemsCount::new(27_339_u64)).bench(|| {
        assert_eq!(sweep.run(MovableMarkerRun::default, RunChoices::Default, &()).mapped, 27_339);
    });
}

/// The search with every fixed marker one after the other, or with one; the items are placed
/// worlds.
#[divan::bench(args = [
    ("simple", 8, "", 144_113),
    ("corridor", 11, "", 1_461_651),
    ("multigraph", 7, "undirected", 410_095),
], sample_count = 3)]
fn counterexample(bencher: Bencher, (class, edges, marker, placed): (&str, usize, &str, u64)) {
    let class: Class = class.parse().unwrap();
    let wanted = |kind: &MarkerKind| kind.name() == marker || marker.is_empty();
    let fixed = MARKERS.into_iter().filter(wanted);
    let searches: Vec<_> =
        fixed.map(|marker| AmbiguitySearch::new(class, edges, marker).unwrap()).collect();
    bencher.counter(ItemsCount::new(placed)).bench(|| {
        let findings = searches.iter().map(|search| search.run(&()));
        let sizes = findings.flat_map(|findings| findings.unwrap().sizes);
        assert_eq!(sizes.map(|size| size.placed_worlds).sum::<u64>(), placed);
    });
}

/// A cycle of 300 edges against one of 301, with each marker: the walk or the relation.
#[divan::bench(args = ["none", "undirected", "movable"], sample_count = 3)]
fn compare_long_cycles(bencher: Bencher, marker: &str) {
    let marker = aid::named(marker).unwrap();
    let (one, other) = (EmbeddedGraph::cycle(300), EmbeddedGraph::cycle(301));
    bencher.bench(|| {
        let comparison = Comparison::new(marker, (&one, Dart(0)), (&other, Dart(0)));
        let poses = [Dart(0), Dart(0)];
        assert!(comparison.walk(poses).is_some() || comparison.relation(poses).is_some());
    });
}

/// Algorithm 1 on a random world of 2,000 vertices and 3,000 edges; the items are moves.
#[divan::bench(sample_count = 5)]
fn map_large_world(bencher: Bencher) {
    let graph = random_cubic(2000, &mut Random(1));
    let run = || {
        let mut exploration = Algorithm1Run::new(graph.dart_count());
        let mut world = GraphWorld::new(&graph, Dart(0));
        explore(&mut exploration, &mut world).unwrap();
        judge(&exploration, Dart(0), &world, &mut Candidate::default()).unwrap();
        exploration.moves()
    };
    bencher.counter(ItemsCount::new(run())).bench(run);
}

/// Two random relabelled copies of a world: with random orders, with the most symmetry, and with
/// nearly as much.
#[divan::bench(args = ["random", "cycle", "chain"], sample_count = 5)]
fn recognise_10_000_edges(bencher: Bencher, world: &str) {
    let mut random = Random(2);
    let graph = match world {
        "random" => random_cubic(6_666, &mut random),
        "chain" => EmbeddedGraph::chain(10_000),
        _ => EmbeddedGraph::cycle(10_000),
    };
    let (one, other) = (relabelled(&graph, &mut random), relabelled(&graph, &mut random));
    bencher.bench(|| {
        assert!(isomorphism(&one, &other).unwrap().verify(&one, &other));
    });
}

/// Marsaglia's xorshift: the same worlds on every run.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        for shift in [13, -7, 17] {
            self.0 ^= if shift > 0 { self.0 << shift } else { self.0 >> -shift };
        }
        (self.0 % bound as u64) as usize
    }

    fn shuffle<T>(&mut self, items: &mut [T]) {
        for end in (1..items.len()).rev() {
            items.swap(end, self.below(end + 1));
        }
    }
}

/// A connected world of vertices with three darts each, joined at random.
fn random_cubic(vertices: u32, random: &mut Random) -> EmbeddedGraph {
    let clockwise: Vec<u32> = (0..3 * vertices).map(|d| d - d % 3 + (d + 1) % 3).collect();
    loop {
        let mut darts: Vec<u32> = (0..3 * vertices).collect();
        random.shuffle(&mut darts);
        let mut opposite = vec![0; darts.len()];
        for pair in darts.chunks(2) {
            opposite[pair[0] as usize] = pair[1];
            opposite[pair[1] as usize] = pair[0];
        }
        if let Ok((graph, _)) = EmbeddedGraph::from_permutations(&opposite, &clockwise) {
            return graph;
        }
    }
}

fn relabelled(graph: &EmbeddedGraph, random: &mut Random) -> EmbeddedGraph {
    let mut firsts: Vec<Dart> = graph
        .vertices()
        .filter_map(|vertex| graph.dart(vertex, random.below(graph.degree(vertex) as usize) as u32))
        .collect();
    random.shuffle(&mut firsts);
    graph.relabelled(&firsts).unwrap().0
}
