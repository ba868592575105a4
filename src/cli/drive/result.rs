//! The result of a live run.

use std::io::Write;

use serde::Serialize;
use toposlam_model::{
    format::named_world::NamedWorld,
    mapping::{FACING, MapWalk, MappedWorld, MappingError, MappingMethod},
};
use toposlam_robot::{explorer::ExplorerError, false_percepts::FalsePercepts};

use super::{CliError, Outcome};
use crate::cli::{
    certificate_cost::CertificateCost,
    json::print_line,
    safeguards::{SafeguardFields, blocked_in_words, print_safeguards},
    text::{counted, grouped, print_paragraph, sentence, tenths, vertices},
};

/// The result of a run.
pub(super) struct DriveResult<'a> {
    /// The name of the world, or an empty string.
    pub(super) world: &'a str,
    pub(super) method: MappingMethod,
    pub(super) mapping: &'a MapWalk,
    pub(super) mapped: Result<&'a MappedWorld, &'a MappingError<ExplorerError>>,
    /// The moves, with those of recoveries and audits.
    pub(super) moves: u64,
    /// Whether the map may lack what is behind blocked doors.
    pub(super) allows_blocked: bool,
    /// How often a percept is false.
    pub(super) percepts: FalsePercepts,
    /// The duration by the robot's clock, in seconds.
    pub(super) seconds: f64,
    pub(super) frames: u64,
    /// What the frames are called.
    pub(super) frame_kind: &'static str,
}

/// What `--json` prints.
#[derive(Serialize)]
struct DriveLine<'a> {
    world: &'a str,
    ending: &'a str,
    error: Option<String>,
    moves: u64,
    certificate: Option<CertificateCost>,
    #[serde(flatten)]
    safeguards: SafeguardFields,
    vertices: usize,
    edges: usize,
    seconds: f64,
    frames: u64,
}

impl DriveResult<'_> {
    pub(super) fn outcome(&self) -> Outcome {
        match self.mapped {
            Ok(mapped) if mapped.blocked.is_empty() || self.allows_blocked => Outcome::Holds,
            Ok(_)
            | Err(
                MappingError::Bound { .. }
                | MappingError::World(ExplorerError::Stopped { .. } | ExplorerError::Budget { .. }),
            ) => Outcome::Incomplete,
            Err(_) => Outcome::Violated,
        }
    }

    /// The map as a world, if it is complete and the run did not end before its last check.
    pub(super) fn map(&self) -> Option<NamedWorld> {
        self.mapped.ok()?;
        let graph = self.mapping.map().complete()?;
        let moves = counted(self.moves as usize, "move");
        let (name, of) = match self.world {
            "" => ("map".to_owned(), "an unknown world"),
            world => (format!("{world}-map"), world),
        };
        let about = format!("The map of {of}, made by a live robot in {moves}");
        Some(NamedWorld::numbered(&name, &about, graph.clone(), Some(FACING)))
    }

    /// The certificate of the complete map.
    fn certificate(&self) -> Option<CertificateCost> {
        let mapped = self.mapped.ok().filter(|mapped| mapped.blocked.is_empty())?;
        let graph = self.mapping.map().complete()?;
        Some(CertificateCost::new(graph, FACING, Some(mapped.moves - mapped.audit_moves)))
    }

    /// The number of edges whose both ends are known.
    fn edges(&self) -> usize {
        let map = self.mapping.map();
        (map.dart_count() - map.unexplored_count() as usize) / 2
    }

    pub(super) fn print(&self, out: &mut dyn Write) -> Result<(), CliError> {
        let moves = counted(self.moves as usize, "move");
        let ended = match self.mapped {
            Ok(mapped) if !mapped.blocked.is_empty() => {
                let doors = blocked_in_words(mapped.blocked.len());
                format!("the map is complete but for {doors}, after {moves}")
            }
            Ok(_) => format!("the map is complete, after {moves}"),
            Err(MappingError::World(error @ ExplorerError::Budget { .. })) => error.to_string(),
            Err(error) => format!("the robot gave up: {error}"),
        };
        writeln!(out)?;
        print_paragraph(out, &sentence(&ended))?;
        let (vertices, edges) =
            (vertices(self.mapping.map().vertex_count()), counted(self.edges(), "edge"));
        writeln!(out, "  map               {vertices}, {edges}")?;
        if let Some(certificate) = self.certificate() {
            certificate.print("  certificate       ", out)?;
        }
        if let Ok(mapped) = self.mapped {
            print_safeguards(out, self.method, mapped, self.mapping.map(), self.percepts)?;
        }
        writeln!(out, "  {:<17} {}", self.frame_kind, grouped(self.frames.into()))?;
        writeln!(out, "  robot time        {} minutes", tenths(self.seconds / 60.0))?;
        Ok(())
    }

    pub(super) fn print_json(&self, out: &mut dyn Write) -> Result<(), CliError> {
        let ending = match self.mapped {
            Ok(_) => "mapped",
            Err(MappingError::World(ExplorerError::Stopped { .. })) => "stopped",
            Err(MappingError::World(ExplorerError::Budget { .. })) => "out-of-budget",
            Err(_) => "gave-up",
        };
        let line = DriveLine {
            world: self.world,
            ending,
            error: self.mapped.err().map(ToString::to_string),
            moves: self.moves,
            certificate: self.certificate(),
            safeguards: SafeguardFields::new(self.mapped.ok(), self.mapping.map(), self.percepts),
            vertices: self.mapping.map().vertex_count(),
            edges: self.edges(),
            seconds: (self.seconds * 1e3).round() / 1e3,
            frames: self.frames,
        };
        print_line(out, "run", &line)
    }
}
