//! The summary of a run: its rounds and hypotheses, counted.

use std::io::{self, Write};

use toposlam_model::mapping::{FoldingEvent, MappingEvent, MovableEvent, SafeguardEvent};

use crate::cli::text::grouped;

/// Counts the events of a run.
#[derive(Default)]
pub(super) struct Summary {
    rounds: u64,
    vertices: u64,
    loops: u64,
    /// Candidates that the percept on arrival ruled out.
    ruled_out: u64,
    rejected: u64,
    confirmed: u64,
    /// Of the folding explorer: how often the trail was folded.
    folded: u64,
    audit_moves: u64,
}

impl Summary {
    pub(super) fn print(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out)?;
        let Self { rounds, vertices, loops, ruled_out, rejected, confirmed, folded, audit_moves } =
            *self;
        for (name, count) in [
            ("rounds", rounds),
            ("that found a new vertex", vertices),
            ("that closed a loop", loops),
            ("candidates ruled out by the percept", ruled_out),
            ("candidates rejected by their path", rejected),
            ("candidates confirmed", confirmed),
            ("times that the trail was folded", folded),
            ("moves of audits", audit_moves),
        ] {
            // Only the folding explorer has a trail.
            if (name.contains("trail") || name.contains("audits")) && count == 0 {
                continue;
            }
            let indent = if name.starts_with("that") { "    " } else { "  " };
            let name = format!("{indent}{name}");
            writeln!(out, "{name:<40}{:>12}", grouped(count.into()))?;
        }
        writeln!(out, "\nUse --story for each round.")
    }

    pub(super) fn count(&mut self, event: MappingEvent) {
        match event {
            MappingEvent::Arrived { contradicted, .. } => {
                self.rounds += 1;
                self.ruled_out += contradicted as u64;
            }
            MappingEvent::Movable(MovableEvent::Arrived { .. })
            | MappingEvent::Folding(FoldingEvent::Explored { .. } | FoldingEvent::Testing { .. }) =>
            {
                self.rounds += 1;
            }
            MappingEvent::Folding(FoldingEvent::Folded { .. }) => self.folded += 1,
            MappingEvent::Safeguard(SafeguardEvent::AuditPassed { moves }) => {
                self.audit_moves += moves;
            }
            MappingEvent::Rejected { .. }
            | MappingEvent::Folding(FoldingEvent::Refuted { .. })
            | MappingEvent::Movable(MovableEvent::NotAt { .. } | MovableEvent::NotBehind { .. }) => {
                self.rejected += 1;
            }
            MappingEvent::Confirmed { .. }
            | MappingEvent::Folding(FoldingEvent::Confirmed { .. })
            | MappingEvent::Movable(MovableEvent::Behind { .. }) => {
                self.confirmed += 1;
            }
            MappingEvent::LoopClosed { .. } => self.loops += 1,
            MappingEvent::VertexAdded { .. } => self.vertices += 1,
            _ => {}
        }
    }
}
