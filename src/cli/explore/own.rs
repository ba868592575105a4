//! One run of an explorer that is another program.

use std::io::Write;

use serde::Serialize;
use toposlam_model::{
    embedded_graph::Dart,
    folding::certificate_length,
    format::named_world::NamedWorld,
    isomorphism::Candidate,
    mapping::FACING,
    marker::Directional,
    proof::{PerceivedWalk, Proof},
};

use super::ExploreArguments;
use crate::cli::{
    CliError, Outcome,
    certificate_cost::CertificateCost,
    explorer::{ExplorerCommand, ExplorerFault, ExplorerStart, ReportedRun},
    json::print_line,
    mapping_marker::is_directional,
    text::{counted, print_paragraph},
};

/// The object of `--json`.
#[derive(Serialize)]
struct OwnRunLine<'a> {
    explorer: &'a str,
    marker: &'static str,
    start: String,
    /// The name of what is wrong; `None` if the map and the pose are right.
    cause: Option<&'static str>,
    moves: u64,
    #[serde(flatten)]
    run: &'a ReportedRun,
    #[serde(skip_serializing_if = "Option::is_none")]
    certificate: Option<&'a CertificateCost>,
    verdict: &'static str,
}

impl ExploreArguments {
    /// Runs the explorer from a start, and reports the run.
    pub(super) fn explore_by(
        &self,
        command: &ExplorerCommand,
        world: &NamedWorld,
        facing: Dart,
        out: &mut dyn Write,
    ) -> Result<Outcome, CliError> {
        let graph = &world.graph;
        let start = ExplorerStart { graph, facing, marker: self.marker, certificate: None };
        let mut process = command.start()?;
        let limits = self.explorer.limits();
        let Some(run) = start.run(&mut process, limits, &mut Candidate::default()) else {
            return Err(CliError::Interrupted);
        };
        let fault = run.result.as_ref().err();
        let (cause, moves) = (fault.map(ExplorerFault::name), run.moves);
        let outcome = match fault {
            None => Outcome::Holds,
            Some(fault) if fault.is_limit() => Outcome::Incomplete,
            Some(_) => Outcome::Violated,
        };
        let stderr = match fault {
            Some(fault) if fault.ends_process() => process.end(),
            _ => {
                process.finish();
                String::new()
            }
        };
        let doors: Vec<_> = run.actions.iter().filter_map(|action| action.door()).collect();
        let is_right = run.result.is_ok();
        let mut run = ReportedRun::new(run, stderr);
        if cause == Some(ExplorerFault::GUESSED) {
            run.find_other_world((graph, facing), self.marker);
        }
        let directional = is_directional(self.marker);
        let shortest = directional.then(|| certificate_length(graph, facing));
        if self.json {
            let right = cause.is_none().then_some(moves);
            let certificate =
                self.certificate.then(|| CertificateCost::with_doors(graph, facing, right));
            let line = OwnRunLine {
                explorer: &command.text,
                marker: self.marker.name(),
                start: world.start_text(facing),
                cause,
                moves,
                run: &run,
                certificate: certificate.as_ref(),
                verdict: outcome.verdict(),
            };
            print_line(out, "explorer-run", &line)?;
        } else {
            let head = format!(
                "Explorer {}, {} marker, world {} from {}:",
                command.text,
                self.marker.name(),
                world.name,
                world.start_text(facing)
            );
            print_paragraph(out, &head)?;
            writeln!(out)?;
            let at_start = NamedWorld { start: Some(facing), ..world.clone() };
            run.print(&at_start, self.marker, out)?;
            writeln!(out)?;
            print_paragraph(out, &verdict(outcome, &run, moves, shortest))?;
        }
        if let Some(map) = run.map() {
            self.write_map(&map, moves, false)?;
        } else if !self.map.is_empty() {
            remark!("the map is not written: there is none");
        }
        match run.map().filter(|_| is_right) {
            Some(map) => self.proof.write(|| {
                let walk = PerceivedWalk::in_world((graph, facing), Directional, facing, &doors);
                Proof::of_map(&map.graph, map.start.unwrap_or(FACING), walk)
                    .map(|proof| vec![proof])
            })?,
            None => self.proof.remark(&"the map is not right"),
        }
        Ok(outcome)
    }
}

/// The verdict, in a paragraph.
fn verdict(outcome: Outcome, run: &ReportedRun, moves: u64, shortest: Option<usize>) -> String {
    let moves_text = counted(moves as usize, "move");
    let Some(clause) = run.clause(moves) else {
        let ratio = shortest.map(|shortest| {
            let ratio = moves as f64 / shortest as f64;
            format!("; {ratio:.2} times the {shortest} of the certificate")
        });
        let ratio = ratio.unwrap_or_default();
        return format!("holds: the map and the pose are right, after {moves_text}{ratio}");
    };
    let word = match outcome {
        Outcome::Incomplete => "not known",
        _ => "violated",
    };
    format!("{word}: after {moves_text}, the explorer {clause}")
}
