//! The certificate of a start: a shortest walk that determines the world.

use std::io::{self, Write};

use serde::Serialize;
use toposlam_model::{
    embedded_graph::Dart, folding, format::named_world::NamedWorld, percept::Door,
};

use crate::cli::text::{counted, print_hanging, print_paragraph};

/// The certificate of a start, and what `--json` prints of it.
#[derive(Serialize)]
pub(super) struct CertificateOfStart {
    moves: usize,
    doors: Vec<u32>,
    /// The moves of the run for each of these; `None` if the run did not complete the map.
    ratio: Option<f64>,
}

impl CertificateOfStart {
    /// The certificate of a world's start, compared with the moves of a run that completed the map.
    pub(super) fn new(world: &NamedWorld, facing: Dart, run: Option<u64>) -> Self {
        let doors = folding::certificate(&world.graph, facing);
        let ratio = run.map(|moves| moves as f64 / doors.len() as f64);
        let doors: Vec<u32> = doors.into_iter().map(|Door(door)| door).collect();
        Self { moves: doors.len(), doors, ratio }
    }

    pub(super) fn print(&self, out: &mut dyn Write) -> io::Result<()> {
        let moves = counted(self.moves, "move");
        let ratio = self
            .ratio
            .map_or(String::new(), |ratio| format!(" This run took {ratio:.2} times as many."));
        let text = format!(
            "Certificate: the shortest walk that proves the map of this world takes {moves}. No \
             robot can map the world in fewer.{ratio}"
        );
        writeln!(out)?;
        print_paragraph(out, &text)?;
        let doors: Vec<String> = self.doors.iter().map(ToString::to_string).collect();
        print_hanging(out, "  doors ", &doors.join(" "))
    }
}
