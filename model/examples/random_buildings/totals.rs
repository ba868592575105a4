//! The moves of both algorithms with a directional marker, in the random buildings of one size.

use std::time::Duration;

use toposlam_model::{
    embedded_graph::Dart, folding::certificate_length, mapping::MappingAlgorithm,
};

use super::buildings::{buildings, moves};

/// The totals of some buildings of one size.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Totals {
    pub(crate) edges: usize,
    pub(crate) certificate: usize,
    pub(crate) folding: u64,
    pub(crate) algorithm1: u64,
    /// How long the folding explorer computes.
    pub(crate) computed: Duration,
}

impl Totals {
    /// Those of [`BUILDINGS`](super::buildings::BUILDINGS) buildings of seed 7.
    pub(crate) fn with_size(junctions: usize, more_hallways: usize) -> Self {
        let mut totals = Self::default();
        for graph in buildings(junctions, more_hallways) {
            totals.edges += graph.edge_count();
            totals.certificate += certificate_length(&graph, Dart(0));
            let (moved, computed) = moves(MappingAlgorithm::Folding, &graph);
            totals.folding += moved;
            totals.computed += computed;
            totals.algorithm1 += moves(MappingAlgorithm::Algorithm1, &graph).0;
        }
        totals
    }
}
