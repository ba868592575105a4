//! How many moves lengths and a compass save: those of the folding explorer with a directional marker that also has these
//! senses, in the buildings of the example `random_buildings`.
//!
//! `cargo run --release -p toposlam-model --example senses`
//!
//! The moves are means, with the most in parentheses. Each map is judged by a bijection. Lengths are drawn in two ways: for each
//! hallway, or for each distance between two neighbouring lines of the grid.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "an example may panic, and prints")]

#[path = "random_buildings/buildings.rs"]
mod buildings;
#[path = "random_buildings/sensed.rs"]
mod sensed;

use buildings::{BUILDINGS, MORE_HALLWAYS, buildings, moves};
use sensed::{LengthError, Lengths, Senses, measured_buildings, moves_with};
use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    folding::certificate_length,
    mapping::MappingAlgorithm,
};

const SIZES: [usize; 4] = [25, 50, 100, 200];

fn main() {
    print!("{:<36}", "junctions, at most");
    for junctions in SIZES {
        print!("{junctions:>18}");
    }
    println!();
    let graphs = SIZES.map(|junctions| buildings(junctions, MORE_HALLWAYS));
    let certificate = |graph: &EmbeddedGraph| certificate_length(graph, Dart(0)) as u64;
    line("certificate", &graphs, certificate);
    line("folding", &graphs, |graph| moves(MappingAlgorithm::Folding, graph).0);
    let exact = LengthError::EachTime(0);
    let within_one_percent = LengthError::EachTime(10);
    let within_ten_percent = LengthError::EachTime(100);
    let always_the_same = LengthError::EachHallway(100);
    for (title, lengths) in
        [("lengths of hallways", Lengths::OfHallways), ("lengths of the grid", Lengths::OfGrid)]
    {
        println!("{title}");
        let buildings =
            SIZES.map(|junctions| measured_buildings(junctions, MORE_HALLWAYS, lengths));
        for (name, lengths, compass) in [
            ("  exact", Some(exact), false),
            ("  within 1 %", Some(within_one_percent), false),
            ("  within 10 %", Some(within_ten_percent), false),
            ("  within 10 %, always the same", Some(always_the_same), false),
            ("  exact, and a compass", Some(exact), true),
            ("  within 10 %, and a compass", Some(within_ten_percent), true),
            ("  not measured, and a compass", None, true),
        ] {
            let senses = Senses { lengths, compass };
            line(name, &buildings, |building| moves_with(senses, building));
        }
    }
}

/// Prints the mean and the most of a count over the buildings of each size.
fn line<B>(name: &str, buildings: &[Vec<B>], count: impl Fn(&B) -> u64) {
    print!("{name:<36}");
    for buildings in buildings {
        let counts: Vec<_> = buildings.iter().map(&count).collect();
        let mean = counts.iter().sum::<u64>() as f64 / BUILDINGS as f64;
        print!("{:>18}", format!("{mean:.1} ({})", counts.iter().max().unwrap()));
    }
    println!();
}
