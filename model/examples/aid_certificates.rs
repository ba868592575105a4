//! How far each explorer is from the fewest moves that are possible with its marking aid, in all simple worlds with few
//! edges.
//!
//! `cargo run --release -p toposlam-model --example aid_certificates`
//!
//! The sums of the moves of all starts: of the shortest certificates and of the explorer. A start
//! whose certificate was not found is left out of both sums, and counted.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "an example may panic, and prints")]

use toposlam_model::{
    aid::Action,
    ambiguity::shortest_certificate,
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Class, Each, Enumeration},
    mapping::MappingAlgorithm,
    world::GraphWorld,
};

/// States of knowledge in one search.
const MOST: usize = 200_000;

fn main() {
    let sizes = 3..=5;
    let all: Vec<Vec<EmbeddedGraph>> = sizes
        .clone()
        .map(|edges| {
            Enumeration::new(Each::Start, Class::Simple, edges).unwrap().graphs().collect()
        })
        .collect();
    print!("{:<26}", "edges");
    for (edges, graphs) in sizes.zip(&all) {
        print!("{:>26}", format!("{edges} ({} starts)", graphs.len()));
    }
    println!();
    for algorithm in MappingAlgorithm::all() {
        let aid = algorithm.aid();
        let name = if aid.moves() { aid.name() } else { algorithm.name() };
        print!("{name:<26}");
        for graphs in &all {
            let (mut least, mut explored, mut open) = (0, 0, 0);
            for graph in graphs {
                let Some(found) = shortest_certificate(aid, (graph, Dart(0)), MOST) else {
                    open += 1;
                    continue;
                };
                least += found.into_iter().map(Action::moves).sum::<u64>();
                let mut world = GraphWorld::with_aid(graph, aid, Dart(0));
                let (run, map) = algorithm.map_world(&mut world, 50, &mut ());
                map.unwrap();
                explored += run.moves();
            }
            let rest = if open == 0 { String::new() } else { format!(", {open} open") };
            print!("{:>26}", format!("{least} / {explored}{rest}"));
        }
        println!();
    }
}
