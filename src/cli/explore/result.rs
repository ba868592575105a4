//! The result of a run: its map, compared with the world.

use std::io::{self, Write};

use serde::Serialize;
use toposlam_model::{
    check::{ChoicesLimit, EveryWay},
    embedded_graph::{Dart, EmbeddedGraph},
    folding::certificate_length,
    format::{named_world::NamedWorld, world_file},
    isomorphism::Bijection,
    mapping::{FACING, Flaw, MappedWorld, MappingError},
};

use super::{
    AlgorithmOption, CliError, MappingMarker, Outcome, certificate::CertificateOfStart,
    explored_world::ExploredWorld,
};
use crate::cli::text::{self, counted, grouped, print_hanging, print_paragraph};

/// What `--json` prints after the doors.
#[derive(Serialize)]
struct Rest<'a> {
    moves: u64,
    /// With --audit, if the audits agreed with the map.
    #[serde(skip_serializing_if = "Option::is_none")]
    audit_moves: Option<u64>,
    edges: Option<usize>,
    vertices: usize,
    isomorphic: bool,
    map: Option<serde_json::Value>,
    start: String,
    /// The marker, unless it is the directional one.
    #[serde(skip_serializing_if = "Option::is_none")]
    marker: Option<&'static str>,
    /// The algorithm that maps with the directional marker, unless it is Algorithm 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    algorithm: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    certificate: Option<&'a CertificateOfStart>,
    #[serde(flatten)]
    every_way: Option<EveryWayRest>,
}

/// With all choices.
#[derive(Serialize)]
struct EveryWayRest {
    states: u64,
    states_within_rounds: u64,
    runs: u128,
    costs: Vec<u64>,
    complete: bool,
    /// What stopped the search, if something did.
    #[serde(skip_serializing_if = "Option::is_none")]
    limit: Option<&'static str>,
}

/// The result of a run.
pub(super) struct ExploreResult<'a> {
    pub(super) world: &'a NamedWorld,
    pub(super) facing: Dart,
    pub(super) marker: MappingMarker,
    pub(super) algorithm: AlgorithmOption,
    pub(super) explored: ExploredWorld,
    /// With `--certificate`.
    pub(super) certificate: Option<CertificateOfStart>,
    /// All runs, with `--choices all`.
    pub(super) ways: Option<Result<EveryWay, Flaw>>,
}

impl ExploreResult<'_> {
    pub(super) fn outcome(&self) -> Outcome {
        match (&self.explored.result, &self.ways) {
            (Err(Flaw::Error(MappingError::Bound { .. })), _) => Outcome::Incomplete,
            (Err(_), _) | (_, Some(Err(_))) => Outcome::Violated,
            (Ok(_), Some(Ok(ways))) if ways.limit.is_some() => Outcome::Incomplete,
            (Ok(_), _) => Outcome::Holds,
        }
    }

    /// The map as a world, if it is complete.
    pub(super) fn map(&self) -> Option<NamedWorld> {
        let (name, moves) = (&self.world.name, self.explored.moves_without_audits());
        let about = format!("The map of {name}, made in {moves} moves");
        let graph = self.explored.journey.map().complete()?;
        Some(NamedWorld::numbered(&format!("{name}-map"), &about, graph.clone(), Some(FACING)))
    }

    /// The first thing that is wrong.
    fn error(&self) -> Option<&Flaw> {
        let of_ways = self.ways.as_ref().and_then(|ways| ways.as_ref().err());
        self.explored.result.as_ref().err().or(of_ways)
    }

    fn ways(&self) -> Option<&EveryWay> {
        self.ways.as_ref().and_then(|ways| ways.as_ref().ok())
    }

    /// Prints the rest of the object that the run began with its doors.
    pub(super) fn print_json(&self, out: &mut dyn Write) -> Result<(), CliError> {
        let map = self.explored.journey.map();
        let rest = Rest {
            moves: self.explored.moves(),
            audit_moves: self.explored.audited().map(|mapped| mapped.audit_moves),
            edges: map.complete().map(EmbeddedGraph::edge_count),
            vertices: map.vertex_count(),
            isomorphic: self.explored.result.is_ok(),
            map: self.map().as_ref().map(world_file::to_json),
            start: self.world.start_text(self.facing),
            marker: (self.marker != MappingMarker::Directional).then(|| self.marker.name()),
            algorithm: (self.algorithm != AlgorithmOption::Algorithm1)
                .then(|| self.algorithm.directional().name()),
            error: self.error().map(ToString::to_string),
            certificate: self.certificate.as_ref(),
            every_way: self.ways().map(|ways| EveryWayRest {
                states: ways.states,
                states_within_rounds: ways.within_rounds,
                runs: ways.runs,
                costs: ways.costs.iter().collect(),
                complete: ways.limit.is_none(),
                limit: ways.limit.map(ChoicesLimit::name),
            }),
        };
        let rest = serde_json::to_string(&rest).map_err(io::Error::from)?;
        writeln!(out, "{}", rest.strip_prefix('{').unwrap_or(&rest))?;
        Ok(())
    }

    /// Prints the result with the names of at most `listed` vertices.
    pub(super) fn print(&self, out: &mut dyn Write, listed: usize) -> Result<(), CliError> {
        writeln!(out)?;
        match &self.explored.result {
            Err(flaw) => {
                let moves = counted(self.explored.moves() as usize, "move");
                print_paragraph(out, &format!("After {moves}: {flaw}."))?;
                if matches!(flaw, Flaw::Error(MappingError::Bound { .. })) {
                    print_paragraph(out, "Use --max-darts N to raise the bound.")?;
                }
            }
            Ok(bijection) => self.print_map(bijection, listed, out)?,
        }
        if let Some(certificate) = &self.certificate {
            certificate.print(out)?;
        }
        match &self.ways {
            None => Ok(()),
            Some(Err(flaw)) => {
                writeln!(out)?;
                Ok(print_paragraph(out, &format!("With other choices: {flaw}."))?)
            }
            Some(Ok(ways)) => Ok(print_ways(ways, out)?),
        }
    }

    fn print_map(
        &self,
        bijection: &Bijection,
        listed: usize,
        out: &mut dyn Write,
    ) -> io::Result<()> {
        let Self { world, explored, .. } = self;
        let journey = &explored.journey;
        let (vertices, edges) = (world.graph.vertex_count(), world.graph.edge_count());
        let size = format!("{}, {}", text::vertices(vertices), counted(edges, "edge"));
        let moves = counted(journey.moves() as usize, "move");
        let least = match self.marker {
            MappingMarker::Directional => certificate_length(&world.graph, self.facing),
            MappingMarker::Movable => edges,
        };
        let [least, most] = [least as u128, explored.move_bound.into()].map(grouped);
        let complete = format!(
            "The map is complete after {moves}: {size}. A run in this world takes at least {least} \
             and at most {most} moves."
        );
        print_paragraph(out, &complete)?;
        let name = |vertex| {
            let first = journey.map().darts_of(vertex).next();
            let image = first.and_then(|dart| bijection.image(dart));
            image.map(|dart| world.at_text(dart)).unwrap_or_default()
        };
        let vertices = journey.map().vertices();
        let names = vertices.take(listed).map(|v| format!("v{} = {}", v.0, name(v)));
        let mut names: Vec<_> = names.collect();
        let left = journey.map().vertex_count() - names.len();
        if left > 0 {
            names.push(format!("and {} more", grouped(left as u128)));
        }
        print_paragraph(out, "It is isomorphic to the world:")?;
        print_hanging(out, "  ", &names.join(", "))?;
        if let Some(MappedWorld { audit_moves, audited_percepts, .. }) = explored.audited() {
            let audits = counted(audited_percepts.len(), "audit");
            let moves = counted(*audit_moves as usize, "more move");
            let text = format!("{audits} took {moves}. Each percept is as the map predicts.");
            print_paragraph(out, &text)?;
        }
        let robot = explored.robot();
        let (vertex, index) = (journey.map().vertex(robot).0, journey.map().index(robot));
        let pose = format!("at v{vertex}, entered by dart v{vertex}.{index}");
        print_paragraph(out, &format!("The robot is where it believes it is: {pose}."))?;
        if explored.carries {
            print_paragraph(out, "It carries its marker.")?;
        }
        Ok(())
    }
}

/// What a run can cost with other choices.
fn print_ways(ways: &EveryWay, out: &mut dyn Write) -> io::Result<()> {
    let EveryWay { states, within_rounds, runs, costs, limit } = ways;
    let complete = limit.is_none();
    let at_least = |exact: bool| if exact { "" } else { "at least " };
    let text = format!(
        "With all choices there are {}{} states and {}{} runs.",
        at_least(complete),
        grouped((*states).into()),
        at_least(complete && *runs < u128::MAX),
        grouped(*runs),
    );
    writeln!(out)?;
    print_paragraph(out, &text)?;
    let reached = match limit {
        None => None,
        Some(ChoicesLimit::States(most)) if *within_rounds == 0 => {
            Some(format!("The search stopped at --max-states {most}."))
        }
        Some(ChoicesLimit::States(most)) => Some(format!(
            "The search stopped at --max-states {most}. That counts the states between rounds, at line \
             4, and the {} states within rounds, at line 8.",
            grouped((*within_rounds).into()),
        )),
        Some(ChoicesLimit::Memory) => {
            Some("The search stopped because its states need more than 1 GiB of memory.".to_owned())
        }
        Some(ChoicesLimit::Interrupted) => Some("The search was interrupted.".to_owned()),
    };
    if let Some(text) = reached {
        print_paragraph(out, &text)?;
    }
    let costs: Vec<_> = costs.iter().map(|cost| grouped(cost.into())).collect();
    let text = match (complete, costs.join(" ")) {
        (_, costs) if costs.is_empty() => "No run was finished.".to_owned(),
        (true, costs) => format!("Moves that a run can take: {costs}."),
        (false, costs) => format!("Moves of the runs that were finished: {costs}."),
    };
    print_paragraph(out, &text)
}
