//! The result of a live run.

use std::io::Write;

use serde::Serialize;
use toposlam_model::{
    format::named_world::NamedWorld,
    mapping::{FACING, MappingError, MappingRun},
};
use toposlam_robot::explorer::ExplorerError;

use super::{CliError, Outcome};
use crate::cli::{
    json::print_line,
    text::{print_paragraph, sentence},
};

/// The result of a run.
pub(super) struct DriveResult<'a> {
    /// The name of the world, or an empty string.
    pub(super) world: &'a str,
    pub(super) mapping: &'a MappingRun,
    pub(super) error: Option<&'a MappingError<ExplorerError>>,
    /// The duration by the robot's clock, in seconds.
    pub(super) seconds: f64,
    pub(super) pictures: u64,
    /// What they are called.
    pub(super) frames: &'static str,
}

/// What `--json` prints.
#[derive(Serialize)]
struct Line<'a> {
    world: &'a str,
    ending: &'a str,
    error: Option<String>,
    moves: u64,
    vertices: usize,
    edges: usize,
    seconds: f64,
    frames: u64,
}

impl DriveResult<'_> {
    pub(super) fn outcome(&self) -> Outcome {
        match self.error {
            None => Outcome::Holds,
            Some(
                MappingError::Bound { .. } | MappingError::World(ExplorerError::Stopped { .. }),
            ) => Outcome::Incomplete,
            Some(_) => Outcome::Violated,
        }
    }

    /// The map as a world, if it is complete.
    pub(super) fn map(&self) -> Option<NamedWorld> {
        let graph = self.mapping.map().complete()?;
        let moves = self.mapping.moves();
        let (name, of) = match self.world {
            "" => ("map".to_owned(), "an unknown world"),
            world => (format!("{world}-map"), world),
        };
        let about = format!("The map of {of}, made by a live robot in {moves} moves");
        Some(NamedWorld::numbered(&name, &about, graph.clone(), Some(FACING)))
    }

    /// The number of edges whose both ends are known.
    fn edges(&self) -> usize {
        let map = self.mapping.map();
        (map.dart_count() - map.unexplored_count() as usize) / 2
    }

    pub(super) fn print(&self, out: &mut dyn Write) -> Result<(), CliError> {
        let (moves, vertices) = (self.mapping.moves(), self.mapping.map().vertex_count());
        let ended = match self.error {
            None => format!("the map is complete, after {moves} moves"),
            Some(error) => format!("the robot gave up: {error}"),
        };
        writeln!(out)?;
        print_paragraph(out, &sentence(&ended))?;
        writeln!(out, "  map               {vertices} vertices, {} edges", self.edges())?;
        let minutes = self.seconds / 60.0;
        writeln!(out, "  {:<17} {}", self.frames, self.pictures)?;
        writeln!(out, "  robot time        {minutes:.1} minutes")?;
        Ok(())
    }

    pub(super) fn print_json(&self, out: &mut dyn Write) -> Result<(), CliError> {
        let ending = match (self.outcome(), self.error) {
            (Outcome::Holds, _) => "mapped",
            (_, Some(MappingError::World(ExplorerError::Stopped { .. }))) => "stopped",
            _ => "gave-up",
        };
        let line = Line {
            world: self.world,
            ending,
            error: self.error.map(ToString::to_string),
            moves: self.mapping.moves(),
            vertices: self.mapping.map().vertex_count(),
            edges: self.edges(),
            seconds: (self.seconds * 1e3).round() / 1e3,
            frames: self.pictures,
        };
        print_line(out, "run", &line)
    }
}
