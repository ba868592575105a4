//! What audits and recoveries did in a run, in words and in JSON.

use std::io::{self, Write};

use serde::Serialize;
use toposlam_model::{
    embedded_graph::Dart,
    mapping::{MappedWorld, MappingMethod, PartialMap},
};
use toposlam_robot::false_percepts::FalsePercepts;

use super::text::{counted, grouped, print_hanging};

/// What `--json` prints of it.
#[derive(Serialize)]
pub(super) struct SafeguardFields {
    /// `null` if the run ended early.
    audit_moves: Option<u64>,
    /// The largest chance that a wrong map survives the audits; `null` without any.
    wrong_map_chance: Option<f64>,
    recoveries: Option<u32>,
    /// The doors of the map whose hallways are blocked, as `v2.1`; `null` if the run ended early.
    blocked: Option<Vec<String>>,
}

impl SafeguardFields {
    pub(super) fn new(
        mapped: Option<&MappedWorld>,
        map: &PartialMap,
        percepts: FalsePercepts,
    ) -> Self {
        let audited = mapped.filter(|mapped| !mapped.audited_percepts.is_empty());
        Self {
            audit_moves: mapped.map(|mapped| mapped.audit_moves),
            wrong_map_chance: audited.map(|mapped| percepts.survival(&mapped.audited_percepts)),
            recoveries: mapped.map(|mapped| mapped.recoveries),
            blocked: mapped.map(|mapped| doors(map, &mapped.blocked)),
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
    percepts: FalsePercepts,
) -> io::Result<()> {
    let MappedWorld { audit_moves, audited_percepts, recoveries, blocked, .. } = mapped;
    if method.audits() > 0 {
        let moves = grouped((*audit_moves).into());
        writeln!(out, "  of them audits    {moves}, and each percept is as the map predicts")?;
        let text = format!(
            "a wrong map survives with a chance of at most {}, if at most {} of percepts are false \
             ({}: {} of {})",
            percent(percepts.survival(audited_percepts)),
            percent(percepts.rate()),
            percepts.command,
            percepts.seen,
            grouped(percepts.of as u128),
        );
        print_hanging(out, "                    ", &text)?;
    }
    if method.recovers() {
        writeln!(out, "  recoveries        {recoveries}")?;
    }
    if !blocked.is_empty() {
        print_hanging(out, "  blocked doors     ", &doors(map, blocked).join(", "))?;
    }
    Ok(())
}

/// A share in percent, with two digits that count.
fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    let digits = if percent < 0.1 {
        3
    } else if percent < 1.0 {
        2
    } else {
        1
    };
    format!("{percent:.digits$} %")
}
