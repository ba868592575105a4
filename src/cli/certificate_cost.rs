//! The moves of a run, compared with the certificate of its world: a shortest walk that determines it.

use std::io::{self, Write};

use serde::Serialize;
use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    folding::{certificate, certificate_length},
};

use super::text::{counted, print_hanging};

/// The certificate of a world, and how many times as many moves a run took.
#[derive(Clone, Debug, Serialize)]
pub(super) struct CertificateCost {
    pub(super) moves: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) doors: Option<Vec<u32>>,
    /// The moves of the run, audits apart, for each of these; `None` if the run did not complete the map.
    pub(super) ratio: Option<f64>,
}

impl CertificateCost {
    /// That of a start, and of a run that completed its map in so many moves.
    pub(super) fn new(graph: &EmbeddedGraph, facing: Dart, run: Option<u64>) -> Self {
        let moves = certificate_length(graph, facing);
        Self { moves, doors: None, ratio: run.map(|run| run as f64 / moves as f64) }
    }

    /// The same with the doors of the certificate.
    pub(super) fn with_doors(graph: &EmbeddedGraph, facing: Dart, run: Option<u64>) -> Self {
        let doors = certificate(graph, facing).into_iter().map(|door| door.0).collect();
        Self { doors: Some(doors), ..Self::new(graph, facing, run) }
    }

    /// Prints it as a row, after this label.
    pub(super) fn print(&self, label: &str, out: &mut dyn Write) -> io::Result<()> {
        let ratio = self
            .ratio
            .map_or(String::new(), |ratio| format!("; the run took {ratio:.2} times as many"));
        print_hanging(out, label, &format!("{}{ratio}", counted(self.moves, "move")))
    }
}
