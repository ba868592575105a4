//! Moves in random buildings: of the folding explorer, of Algorithm 1, and of the shortest certificate.
//!
//! `cargo run --release -p toposlam-model --example random_buildings`
//!
//! A building has its junctions on a square grid. Its hallways join neighbours on the grid, at most three
//! at a junction: a random tree, and a quarter as many more as there are junctions. With seed 7 these are
//! the buildings of the table in `worlds/README.md`. An argument is another number of hallways besides the
//! tree, for 100 junctions.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "an example may panic, and prints")]

mod buildings;
mod totals;

use std::env;

use buildings::{BUILDINGS, MORE_HALLWAYS};
use totals::Totals;

fn main() {
    let more_hallways = env::args().nth(1).map_or(MORE_HALLWAYS, |more| more.parse().unwrap());
    println!(
        "junctions  edges  certificate  folding  ratio  Algorithm 1  ratio  to folding  computation"
    );
    for junctions in [25, 50, 100, 200] {
        let Totals { edges, certificate, folding, algorithm1, computed } =
            Totals::with_size(junctions, more_hallways);
        let mean = |sum: f64| sum / BUILDINGS as f64;
        println!(
            "{junctions:>9} {:>6.1} {:>12.1} {:>8.1} {:>6.2} {:>12.1} {:>6.2} {:>11.2} {:>9.1} ms",
            mean(edges as f64),
            mean(certificate as f64),
            mean(folding as f64),
            folding as f64 / certificate as f64,
            mean(algorithm1 as f64),
            algorithm1 as f64 / certificate as f64,
            algorithm1 as f64 / folding as f64,
            mean(computed.as_secs_f64() * 1e3),
        );
    }
}
