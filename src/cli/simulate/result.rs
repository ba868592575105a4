//! The result of a simulated run, and its checks.

use std::io::Write;

use serde::Serialize;
use toposlam_model::{
    embedded_graph::Dart,
    format::named_world::NamedWorld,
    mapping::{FACING, MapWalk, MappingError},
};
use toposlam_robot::{explorer::ExplorerError, false_percepts::FalsePercepts};
use toposlam_simulator::{
    RobotFault,
    run::{Run, RunOutcome},
};

use super::{CliError, Outcome};
use crate::cli::{
    certificate_cost::CertificateCost,
    json::print_line,
    safeguards::{SafeguardFields, blocked_in_words, print_safeguards},
    text::{counted, grouped, print_paragraph, sentence, tenths, vertices},
};

/// The result of a run.
pub(super) struct SimulationResult<'a> {
    pub(super) world: &'a NamedWorld,
    pub(super) facing: Dart,
    pub(super) seed: u64,
    /// Whether the map may lack what is behind blocked doors.
    pub(super) allows_blocked: bool,
    /// How often a percept is false.
    pub(super) percepts: FalsePercepts,
    /// What its frames are called.
    pub(super) frame_kind: &'static str,
    pub(super) run: &'a Run<'a>,
    /// The faults that did not happen: the run ended before their images.
    pub(super) missed: Vec<&'a RobotFault>,
    /// The result of the off-line version on the same images, if it is complete.
    pub(super) replayed: Option<MapWalk>,
    /// How long the off-line version took, in seconds.
    pub(super) compute_seconds: f64,
    /// How long all of it took, in seconds.
    pub(super) wall_seconds: f64,
}

/// A shorter computation is not printed, in seconds.
const SHOWN: f64 = 0.01;

/// What `--json` prints.
#[derive(Serialize)]
struct SimulationLine {
    plan: String,
    start: String,
    seed: u64,
    algorithm: &'static str,
    moves: u64,
    edges: usize,
    explore_moves: u64,
    certificate: CertificateCost,
    #[serde(flatten)]
    safeguards: SafeguardFields,
    isomorphic: bool,
    pose_true: bool,
    conforms: bool,
    divergence: Option<String>,
    /// The number of moves before the divergence.
    divergence_move: Option<usize>,
    error: Option<String>,
    faults_missed: Vec<String>,
    simulated_seconds: f64,
    compute_seconds: f64,
    frames: u64,
}

impl SimulationResult<'_> {
    pub(super) fn outcome(&self) -> Outcome {
        let incomplete = matches!(
            self.run.error,
            Some(
                MappingError::Bound { .. }
                    | MappingError::World(
                        ExplorerError::Stopped { .. } | ExplorerError::Budget { .. }
                    )
            )
        );
        match self.run.outcome() {
            RunOutcome::Right => {
                let is_whole = self.run.blocked().is_empty() || self.allows_blocked;
                if is_whole && self.missed.is_empty() {
                    Outcome::Holds
                } else {
                    Outcome::Incomplete
                }
            }
            _ if incomplete => Outcome::Incomplete,
            RunOutcome::GaveUp(_) | RunOutcome::Wrong(_) => Outcome::Violated,
        }
    }

    /// The map as a world, if it is complete and the run did not end before its last check.
    // paper: exp.maps
    pub(super) fn map(&self) -> Option<NamedWorld> {
        self.run.mapped.as_ref()?;
        let (name, moves) = (&self.world.name, counted(self.run.moves as usize, "move"));
        let about = format!("The map of {name}, made by a simulated robot in {moves}");
        let graph = self.run.mapping.map().complete()?;
        Some(NamedWorld::numbered(&format!("{name}-map"), &about, graph.clone(), Some(FACING)))
    }

    /// The certificate of the plan, and the moves of the run if its map is right and complete.
    fn certificate(&self) -> CertificateCost {
        let run = self.run;
        let is_whole = run.outcome() == RunOutcome::Right && run.blocked().is_empty();
        let mapped = run.mapped.as_ref().filter(|_| is_whole);
        let moves = mapped.map(|mapped| mapped.moves - mapped.audit_moves);
        CertificateCost::new(&self.world.graph, self.facing, moves)
    }

    /// The result in words.
    pub(super) fn in_words(&self) -> String {
        let moves = counted(self.run.moves as usize, "move");
        match self.run.outcome() {
            RunOutcome::Right if !self.run.blocked().is_empty() => {
                let doors = blocked_in_words(self.run.blocked().len());
                format!("the map is right, and complete but for {doors}, after {moves}")
            }
            RunOutcome::Right if self.run.method.recovers() => {
                format!("the map is right, after {moves}")
            }
            RunOutcome::Right => {
                format!("the map is right, after {moves}, all as specified")
            }
            RunOutcome::GaveUp(MappingError::World(error @ ExplorerError::Budget { .. })) => {
                error.to_string()
            }
            ending => ending.to_string(),
        }
    }

    // paper: exp.multiplicative
    pub(super) fn print(&self, out: &mut dyn Write) -> Result<(), CliError> {
        let run = self.run;
        let edges = self.world.graph.edge_count();
        writeln!(out)?;
        print_paragraph(out, &sentence(&self.in_words()))?;
        if let (Some(divergence), Some(_)) = (run.divergence(), &run.error) {
            print_paragraph(out, &sentence(&divergence.to_string()))?;
        }
        for fault in &self.missed {
            let text = format!(
                "The fault {fault} did not happen: the run ended after {} {}.",
                grouped(run.frames.into()),
                self.frame_kind
            );
            print_paragraph(out, &text)?;
        }
        let map = run.mapping.map();
        let known = counted((map.dart_count() - map.unexplored_count() as usize) / 2, "edge");
        let known = format!("{}, {known}", vertices(map.vertex_count()));
        let [moves, expected] = [run.moves, run.explore_moves].map(|moves| grouped(moves.into()));
        writeln!(out, "  moves             {moves} ({expected} in the plan's embedded graph)")?;
        self.certificate().print("  certificate       ", out)?;
        if let Some(mapped) = &run.mapped {
            print_safeguards(out, run.method, mapped, map, self.percepts)?;
        }
        writeln!(out, "  edges             {}", grouped(edges as u128))?;
        writeln!(out, "  map               {known}")?;
        let (minutes, seconds) = (run.seconds / 60.0, self.compute_seconds);
        writeln!(out, "  {:<17} {}", self.frame_kind, grouped(run.frames.into()))?;
        writeln!(out, "  simulated time    {} minutes", tenths(minutes))?;
        // Without images there is almost nothing to compute.
        if self.replayed.is_some() && seconds >= SHOWN {
            let ratio = run.seconds / seconds.max(1e-9);
            writeln!(
                out,
                "  computation       {seconds:.2} s off-line, {} times real time",
                grouped(ratio.round() as u128)
            )?;
        }
        remark!("{:.1} s", self.wall_seconds);
        Ok(())
    }

    pub(super) fn print_json(&self, out: &mut dyn Write) -> Result<(), CliError> {
        let run = self.run;
        let divergence = run.divergence();
        let line = SimulationLine {
            plan: self.world.name.clone(),
            start: self.world.start_text(self.facing),
            seed: self.seed,
            algorithm: run.method.algorithm().name(),
            moves: run.moves,
            edges: self.world.graph.edge_count(),
            explore_moves: run.explore_moves,
            certificate: self.certificate(),
            safeguards: SafeguardFields::new(run.mapped.as_ref(), run.mapping.map(), self.percepts),
            isomorphic: run.isomorphic(),
            pose_true: run.pose_true(),
            conforms: divergence.is_none(),
            divergence: divergence.as_ref().map(ToString::to_string),
            divergence_move: divergence.as_ref().map(|divergence| divergence.moves),
            error: run.error.as_ref().map(ToString::to_string),
            faults_missed: self.missed.iter().map(ToString::to_string).collect(),
            // The control loop counts in quarters of a second, an image in tenths.
            simulated_seconds: (run.seconds * 1e3).round() / 1e3,
            compute_seconds: self.compute_seconds,
            frames: run.frames,
        };
        print_line(out, "run", &line)
    }
}
