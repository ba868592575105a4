//! How a run ended: its map, held against the world.

use std::io::{self, Write};

use serde::Serialize;
use toposlam_model::{
    check::{EveryWay, Flaw},
    embedded_graph::{Dart, EmbeddedGraph},
    format::{named_world::NamedWorld, world_file},
    isomorphism::Bijection,
    mapping::{FACING, Journey, MappingError},
};

use super::{Failure, MappingMarker, Outcome};
use crate::cli::text;

/// What `--json` prints after the doors.
#[derive(Serialize)]
struct Rest {
    moves: u64,
    edges: Option<usize>,
    vertices: usize,
    isomorphic: bool,
    map: Option<serde_json::Value>,
    start: String,
    /// The marker, but the directional one.
    #[serde(skip_serializing_if = "Option::is_none")]
    marker: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
    #[serde(flatten)]
    every_way: Option<EveryWayRest>,
}

/// With all choices.
#[derive(Serialize)]
struct EveryWayRest {
    states: u64,
    runs: u128,
    costs: Vec<u64>,
    complete: bool,
}

/// How the run ended.
pub(super) struct ExploreResult<'a> {
    pub(super) world: &'a NamedWorld,
    pub(super) facing: Dart,
    pub(super) marker: MappingMarker,
    pub(super) journey: &'a Journey,
    /// The most moves that the algorithm may make in this world.
    pub(super) move_bound: u64,
    /// Whether the robot has its marker in hand.
    pub(super) carries: bool,
    /// The bijection from the map to the world, or what is wrong.
    pub(super) result: Result<&'a Bijection, Flaw>,
    /// All runs, where they were wanted.
    pub(super) ways: Option<Result<EveryWay, Flaw>>,
}

impl ExploreResult<'_> {
    pub(super) fn outcome(&self) -> Outcome {
        match (&self.result, &self.ways) {
            (Err(Flaw::Error(MappingError::Bound { .. })), _) => Outcome::Incomplete,
            (Err(_), _) | (_, Some(Err(_))) => Outcome::Violated,
            (Ok(_), Some(Ok(ways))) if !ways.complete => Outcome::Incomplete,
            (Ok(_), _) => Outcome::Holds,
        }
    }

    /// The map as a world, where it is complete.
    pub(super) fn map(&self) -> Option<NamedWorld> {
        let (name, moves) = (&self.world.name, self.journey.moves());
        let about = format!("The map of {name}, made in {moves} moves");
        let graph = self.journey.map().complete()?;
        Some(NamedWorld::numbered(&format!("{name}-map"), &about, graph.clone(), Some(FACING)))
    }

    /// The first thing that is wrong.
    fn error(&self) -> Option<&Flaw> {
        let of_ways = self.ways.as_ref().and_then(|ways| ways.as_ref().err());
        self.result.as_ref().err().or(of_ways)
    }

    fn ways(&self) -> Option<&EveryWay> {
        self.ways.as_ref().and_then(|ways| ways.as_ref().ok())
    }

    /// The object whose beginning, with the doors, has been written during the run.
    pub(super) fn tell_json(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let map = self.journey.map();
        let rest = Rest {
            moves: self.journey.moves(),
            edges: map.complete().map(EmbeddedGraph::edge_count),
            vertices: map.vertex_count(),
            isomorphic: self.result.is_ok(),
            map: self.map().as_ref().map(world_file::to_json),
            start: self.world.start_text(self.facing),
            marker: (self.marker != MappingMarker::Directional).then(|| self.marker.name()),
            error: self.error().map(ToString::to_string),
            every_way: self.ways().map(|ways| EveryWayRest {
                states: ways.states,
                runs: ways.runs,
                costs: ways.costs.iter().collect(),
                complete: ways.complete,
            }),
        };
        let rest = serde_json::to_string(&rest).map_err(io::Error::from)?;
        writeln!(out, "{}", rest.strip_prefix('{').unwrap_or(&rest))?;
        Ok(())
    }

    pub(super) fn tell(&self, out: &mut dyn Write) -> Result<(), Failure> {
        match &self.result {
            Err(flaw) => {
                let moves = text::counted(self.journey.moves() as usize, "move");
                writeln!(out, "\nAfter {moves}: {flaw}")?;
                if matches!(flaw, Flaw::Error(MappingError::Bound { .. })) {
                    writeln!(out, "With --max-darts N the robot may go on.")?;
                }
            }
            Ok(bijection) => self.tell_map(bijection, out)?,
        }
        match &self.ways {
            None => {}
            Some(Err(flaw)) => writeln!(out, "\nWith other choices: {flaw}")?,
            Some(Ok(EveryWay { states, runs, costs, complete })) => {
                let least = |exact: bool| if exact { "" } else { "at least " };
                writeln!(
                    out,
                    "\nWith all choices there are {}{states} states and {}{runs} runs.",
                    least(*complete),
                    least(*complete && *runs < u128::MAX),
                )?;
                let costs: Vec<_> = costs.iter().map(|cost| cost.to_string()).collect();
                match (complete, costs.join(" ")) {
                    (_, costs) if costs.is_empty() => writeln!(out, "None of them was finished.")?,
                    (true, costs) => writeln!(out, "They take this many moves: {costs}.")?,
                    (false, costs) => writeln!(out, "Those finished took as many moves: {costs}.")?,
                }
            }
        }
        Ok(())
    }

    fn tell_map(&self, bijection: &Bijection, out: &mut dyn Write) -> Result<(), Failure> {
        let Self { world, journey, move_bound, .. } = self;
        let (edges, vertices) = (world.graph.edge_count(), world.graph.vertex_count());
        writeln!(
            out,
            "\nThe map has {} and {}, and took {} moves (at least {edges}, at most {move_bound}).",
            text::vertices(vertices),
            text::counted(edges, "edge"),
            journey.moves(),
        )?;
        writeln!(out, "It is isomorphic to the world:")?;
        let name = |vertex| {
            let first = journey.map().darts_of(vertex).next();
            let image = first.and_then(|dart| bijection.image(dart));
            image.map(|dart| world.at_text(dart)).unwrap_or_default()
        };
        let names: Vec<_> = journey
            .map()
            .vertices()
            .map(|vertex| format!("v{} = {}", vertex.0, name(vertex)))
            .collect();
        for line in names.chunks(6) {
            writeln!(out, "  {}", line.join(", "))?;
        }
        let robot = journey.robot();
        writeln!(
            out,
            "The robot knows where it is: at v{}, having come in by its dart {}.",
            journey.map().vertex(robot).0,
            journey.map().index(robot),
        )?;
        if self.carries {
            writeln!(out, "It carries its marker.")?;
        }
        Ok(())
    }
}
