//! What a marking aid buys: the moves of each explorer in random buildings, those of the example `random_buildings`.
//!
//! `cargo run --release -p toposlam-model --example marking_aids`
//!
//! The moves are means, with the most in parentheses. Each map is judged by a bijection. A team's moves are those of all
//! robots; its rounds, in each of which every robot makes at most one, are in a line of their own. For the string, the
//! edges that it was long at most are. For one marker that is carried, there are the moves of two robots without radio, of
//! which the second one is the marker.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "an example may panic, and prints")]

#[path = "random_buildings/buildings.rs"]
mod buildings;
#[path = "random_buildings/together.rs"]
mod together;

use buildings::{BUILDINGS, MORE_HALLWAYS, buildings, moves};
use together::moves_together;
use toposlam_model::{
    aid::{AidKind, markers::MOVABLE, pointer::MovablePointer},
    embedded_graph::{Dart, EmbeddedGraph},
    folding::certificate_length,
    mapping::{Explorer, MappingAlgorithm, TeamRun, ThreadRun, explore},
    world::GraphWorld,
};

fn main() {
    let sizes = [25, 50, 100, 200];
    let hallways = sizes.map(|junctions| buildings(junctions, MORE_HALLWAYS));
    let line = |name: &str, count: &dyn Fn(&EmbeddedGraph) -> u64| {
        print!("{name:<34}");
        for graphs in &hallways {
            let counts: Vec<_> = graphs.iter().map(count).collect();
            let mean = counts.iter().sum::<u64>() as f64 / BUILDINGS as f64;
            print!("{:>18}", format!("{mean:.1} ({})", counts.iter().max().unwrap()));
        }
        println!();
    };
    print!("{:<34}", "junctions, at most");
    for junctions in sizes {
        print!("{junctions:>18}");
    }
    println!();
    line("edges", &|graph| graph.edge_count() as u64);
    line("certificate", &|graph| certificate_length(graph, Dart(0)) as u64);
    for algorithm in MappingAlgorithm::all() {
        let aid = algorithm.aid().name();
        let name = if algorithm.aid().moves() {
            aid.to_owned()
        } else {
            format!("{aid}, {}", algorithm.name())
        };
        line(&name, &|graph| moves(algorithm, graph).0);
        if [AidKind::from(MOVABLE), AidKind::Pointer(MovablePointer)].contains(&algorithm.aid()) {
            line("  two robots without radio", &|graph| moves_together(algorithm, graph));
        }
        if let AidKind::Team(team) = algorithm.aid() {
            line("  rounds", &|graph| explored(TeamRun::with(team), graph).rounds());
        }
        if algorithm.aid() == ThreadRun::default().aid() {
            let longest = |graph: &_| explored(ThreadRun::default(), graph).longest_way() as u64;
            line("  string, in edges", &longest);
        }
    }
}

fn explored<E: Explorer>(mut explorer: E, graph: &EmbeddedGraph) -> E {
    let mut world = GraphWorld::with_aid(graph, explorer.aid(), Dart(0));
    explore(&mut explorer, &mut world).unwrap();
    explorer
}
