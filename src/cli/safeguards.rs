//! What audits and recoveries did in a run, in words and in JSON.

use std::io::{self, Write};

use serde::Serialize;
use toposlam_model::{
    embedded_graph::Dart,
    mapping::{MappedWorld, MappingMethod, PartialMap},
};

use super::text::{counted, grouped, print_hanging};

/// What `--json` prints of it.
#[derive(Serialize)]
pub(super) struct SafeguardFields {
    /// `null` if the run ended early.
    audit_moves: Option<u64>,
    recoveries: Option<u32>,
    /// The doors of the map whose hallways are blocked, as `v2.1`.
    blocked: Vec<String>,
}

impl SafeguardFields {
    pub(super) fn new(mapped: Option<&MappedWorld>, map: &PartialMap) -> Self {
        Self {
            audit_moves: mapped.map(|mapped| mapped.audit_moves),
            recoveries: mapped.map(|mapped| mapped.recoveries),
            blocked: mapped.map_or_else(Vec::new, |mapped| doors(map, &mapped.blocked)),
        }
    }
}

/// `1 blocked door`.
pub(super) fn blocked_in_words(count: usize) -> String {
    counted(count, "blocked door")
}

/// The names of doors of a map.
fn doors(map: &PartialMap, darts: &[Dart]) -> Vec<String> {
    darts.iter().map(|&dart| format!("v{}.{}", map.vertex(dart).0, map.index(dart))).collect()
}

/// Prints the lines of a run with safeguards.
pub(super) fn print_safeguards(
    out: &mut dyn Write,
    method: MappingMethod,
    mapped: &MappedWorld,
    map: &PartialMap,
) -> io::Result<()> {
    let MappedWorld { audit_moves, recoveries, blocked, .. } = mapped;
    if method.audits() > 0 {
        let moves = grouped((*audit_moves).into());
        writeln!(out, "  of them audits    {moves}, and each percept is as the map predicts")?;
    }
    if method.recovers() {
        writeln!(out, "  recoveries        {recoveries}")?;
    }
    if !blocked.is_empty() {
        print_hanging(out, "  blocked doors     ", &doors(map, blocked).join(", "))?;
    }
    Ok(())
}
