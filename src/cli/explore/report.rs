//! The report of a run: its map, compared with the world.

use std::io::Write;

use serde::Serialize;
use serde_json::Value;
use toposlam_model::{
    aid::Action,
    aid::AidKind,
    check::{ChoicesLimit, EveryWay},
    embedded_graph::{Dart, EmbeddedGraph},
    folding::certificate_length,
    format::{named_world::NamedWorld, world_file},
    isomorphism::{Bijection, Candidate},
    mapping::{
        FACING, Flaw, MapWalk, MappedWorld, MappingAlgorithm, MappingError, MappingMethod, Observer,
    },
    world::GraphWorld,
};

use super::senses::SensingRun;
use crate::cli::{
    CliError, Outcome,
    certificate_cost::CertificateCost,
    json::print_line,
    mapping_marker::is_directional,
    text::{counted, grouped, print_hanging, print_paragraph, vertices},
};

/// A run in a world, and its judgement.
pub(super) struct ExploredWorld<'a> {
    world: &'a NamedWorld,
    facing: Dart,
    algorithm: MappingAlgorithm,
    /// The robot's journey without audits.
    journey: MapWalk,
    /// What the map took with its audits; `None` if the run ended early.
    mapped: Option<MappedWorld>,
    /// Whether the robot carries its marker.
    pub(super) carries: bool,
    /// The bijection from the map to the world, or what is wrong.
    result: Result<Bijection, Flaw>,
    /// With `--senses`.
    pub(super) with_senses: Option<SensingRun>,
    /// With `--certificate`.
    pub(super) certificate: Option<CertificateCost>,
    /// All runs, with `--choices all`.
    pub(super) ways: Option<Result<EveryWay, Flaw>>,
}

/// The object of `--json`.
#[derive(Serialize)]
struct RunLine<'a> {
    /// Doors, pick-ups and drops.
    doors: Vec<Action>,
    moves: u64,
    /// With --audit, if the audits agreed with the map.
    #[serde(skip_serializing_if = "Option::is_none")]
    audit_moves: Option<u64>,
    edges: Option<usize>,
    vertices: usize,
    isomorphic: bool,
    map: Option<Value>,
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
    certificate: Option<&'a CertificateCost>,
    #[serde(skip_serializing_if = "Option::is_none")]
    with_senses: Option<&'a SensingRun>,
    #[serde(flatten)]
    every_way: Option<EveryWayPart>,
}

/// With all choices.
#[derive(Serialize)]
struct EveryWayPart {
    states: u64,
    states_within_rounds: u64,
    runs: u128,
    costs: Vec<u64>,
    complete: bool,
    /// What stopped the search, if something did.
    #[serde(skip_serializing_if = "Option::is_none")]
    limit: Option<&'static str>,
}

impl<'a> ExploredWorld<'a> {
    /// A run. `bound` is the most darts of the map.
    pub(super) fn new(
        method: MappingMethod,
        bound: usize,
        (world, facing): (&'a NamedWorld, Dart),
        observer: &mut impl Observer<GraphWorld<'a, AidKind>>,
    ) -> Self {
        let (graph, algorithm) = (&world.graph, method.algorithm());
        let mut robot = GraphWorld::with_aid(graph, algorithm.aid(), facing);
        let (journey, mapped) = method.map_world(&mut robot, bound, &[], observer);
        let (mapped, result) = match mapped {
            Ok(mapped) => {
                let (run, mut candidate) = ((&journey, mapped.pose), Candidate::default());
                let judged = algorithm.judge(run, (graph, facing), robot.pose(), &mut candidate);
                let judged = judged.cloned();
                (Some(mapped), judged)
            }
            Err(error) => (None, Err(error.into())),
        };
        let carries = robot.held() > 0;
        Self {
            world,
            facing,
            algorithm,
            journey,
            mapped,
            carries,
            result,
            with_senses: None,
            certificate: None,
            ways: None,
        }
    }

    pub(super) fn outcome(&self) -> Outcome {
        let with_senses = self.with_senses.as_ref().map_or(Outcome::Holds, SensingRun::outcome);
        match (&self.result, &self.ways) {
            (Err(Flaw::Error(MappingError::Bound { .. })), _) => Outcome::Incomplete,
            (Err(_), _) | (_, Some(Err(_))) => Outcome::Violated,
            _ if with_senses != Outcome::Holds => with_senses,
            (Ok(_), Some(Ok(ways))) if ways.limit.is_some() => Outcome::Incomplete,
            (Ok(_), _) => Outcome::Holds,
        }
    }

    /// The moves until the map was complete, if it is right.
    pub(super) fn moves_of_right_map(&self) -> Option<u64> {
        self.result.is_ok().then(|| self.journey.moves())
    }

    /// The map as a world, if it is complete, and its moves.
    pub(super) fn map(&self) -> Option<(NamedWorld, u64)> {
        let (name, moves) = (&self.world.name, self.journey.moves());
        let about = format!("The map of {name}, made in {moves} moves");
        let graph = self.journey.map().complete()?.clone();
        let map = NamedWorld::numbered(&format!("{name}-map"), &about, graph, Some(FACING));
        Some((map, moves))
    }

    /// What audits took, if there were any and all agreed with the map.
    fn audited(&self) -> Option<&MappedWorld> {
        self.mapped.as_ref().filter(|mapped| !mapped.audited_percepts.is_empty())
    }

    fn moves(&self) -> u64 {
        self.journey.moves() + self.audited().map_or(0, |mapped| mapped.audit_moves)
    }

    pub(super) fn print_json(
        &self,
        doors: Vec<Action>,
        out: &mut dyn Write,
    ) -> Result<(), CliError> {
        let map = self.journey.map();
        let ways = self.ways.as_ref();
        let error = self.result.as_ref().err();
        let marker = self.algorithm.aid();
        let is_named = is_directional(marker) && self.algorithm != MappingAlgorithm::default();
        let line = RunLine {
            doors,
            moves: self.moves(),
            audit_moves: self.audited().map(|mapped| mapped.audit_moves),
            edges: map.complete().map(EmbeddedGraph::edge_count),
            vertices: map.vertex_count(),
            isomorphic: self.result.is_ok(),
            map: self.map().map(|(map, _)| world_file::to_json(&map)),
            start: self.world.start_text(self.facing),
            marker: (!is_directional(marker)).then(|| marker.name()),
            algorithm: is_named.then(|| self.algorithm.name()),
            error: error.or(ways.and_then(|ways| ways.as_ref().err())).map(ToString::to_string),
            certificate: self.certificate.as_ref(),
            with_senses: self.with_senses.as_ref(),
            every_way: ways.and_then(|ways| ways.as_ref().ok()).map(|ways| EveryWayPart {
                states: ways.states,
                states_within_rounds: ways.within_rounds,
                runs: ways.runs,
                costs: ways.costs.iter().collect(),
                complete: ways.limit.is_none(),
                limit: ways.limit.map(ChoicesLimit::name),
            }),
        };
        print_line(out, "run", &line)
    }

    /// Prints the result with the names of at most `listed` vertices.
    pub(super) fn print(&self, out: &mut dyn Write, listed: usize) -> Result<(), CliError> {
        writeln!(out)?;
        match &self.result {
            Err(flaw) => {
                let moves = counted(self.moves() as usize, "move");
                print_paragraph(out, &format!("After {moves}: {flaw}."))?;
                if matches!(flaw, Flaw::Error(MappingError::Bound { .. })) {
                    print_paragraph(out, "Use --max-darts N to raise the bound.")?;
                }
            }
            Ok(bijection) => self.print_map(bijection, listed, out)?,
        }
        if let Some(run) = &self.with_senses {
            run.print(out)?;
        }
        if let Some(CertificateCost { moves, doors, ratio }) = &self.certificate {
            let ratio = ratio
                .map_or(String::new(), |ratio| format!(" This run took {ratio:.2} times as many."));
            let text = format!(
                "Certificate: the shortest walk that proves the map of this world takes {}. No robot can \
                 map the world in fewer.{ratio}",
                counted(*moves, "move")
            );
            writeln!(out)?;
            print_paragraph(out, &text)?;
            let doors: Vec<_> = doors.iter().flatten().map(ToString::to_string).collect();
            print_hanging(out, "  doors ", &doors.join(" "))?;
        }
        match &self.ways {
            None => Ok(()),
            Some(Err(flaw)) => {
                writeln!(out)?;
                Ok(print_paragraph(out, &format!("With other choices: {flaw}."))?)
            }
            Some(Ok(ways)) => print_ways(ways, out),
        }
    }

    fn print_map(
        &self,
        bijection: &Bijection,
        listed: usize,
        out: &mut dyn Write,
    ) -> Result<(), CliError> {
        let Self { world, journey, algorithm, .. } = self;
        let (vertex_count, edges) = (world.graph.vertex_count(), world.graph.edge_count());
        let least = if is_directional(algorithm.aid()) {
            certificate_length(&world.graph, self.facing)
        } else {
            edges
        };
        let most = algorithm.move_bound(edges, vertex_count);
        let complete = format!(
            "The map is complete after {}: {}, {}. A run in this world takes at least {} and at most {} \
             moves.",
            counted(journey.moves() as usize, "move"),
            vertices(vertex_count),
            counted(edges, "edge"),
            grouped(least as u128),
            grouped(most.into()),
        );
        print_paragraph(out, &complete)?;
        let name = |vertex| {
            let first = journey.map().darts_of(vertex).next();
            let image = first.and_then(|dart| bijection.image(dart));
            image.map(|dart| world.at_text(dart)).unwrap_or_default()
        };
        let names = journey.map().vertices().take(listed);
        let mut names: Vec<_> = names.map(|v| format!("v{} = {}", v.0, name(v))).collect();
        let left = journey.map().vertex_count() - names.len();
        if left > 0 {
            names.push(format!("and {} more", grouped(left as u128)));
        }
        print_paragraph(out, "It is isomorphic to the world:")?;
        print_hanging(out, "  ", &names.join(", "))?;
        if let Some(MappedWorld { audit_moves, audited_percepts, .. }) = self.audited() {
            let audits = counted(audited_percepts.len(), "audit");
            let moves = counted(*audit_moves as usize, "more move");
            let text = format!("{audits} took {moves}. Each percept is as the map predicts.");
            print_paragraph(out, &text)?;
        }
        let robot = self.mapped.as_ref().map_or(journey.robot(), |mapped| mapped.pose);
        let (vertex, index) = (journey.map().vertex(robot).0, journey.map().index(robot));
        let pose = format!("at v{vertex}, entered by dart v{vertex}.{index}");
        print_paragraph(out, &format!("The robot is where it believes it is: {pose}."))?;
        if self.carries {
            let what = match algorithm.aid() {
                AidKind::Markers(markers) if markers.count() > 1 => "carries its markers",
                AidKind::String(_) => "holds the end of its string",
                _ => "carries its marker",
            };
            print_paragraph(out, &format!("It {what}."))?;
        }
        Ok(())
    }
}

/// What a run can cost with other choices.
fn print_ways(ways: &EveryWay, out: &mut dyn Write) -> Result<(), CliError> {
    let EveryWay { states, within_rounds, runs, costs, limit } = ways;
    let at_least = |exact: bool| if exact { "" } else { "at least " };
    let text = format!(
        "With all choices there are {}{} states and {}{} runs.",
        at_least(limit.is_none()),
        grouped((*states).into()),
        at_least(limit.is_none() && *runs < u128::MAX),
        grouped(*runs),
    );
    writeln!(out)?;
    print_paragraph(out, &text)?;
    let within = grouped((*within_rounds).into());
    let reached = match limit {
        None => String::new(),
        Some(ChoicesLimit::States(most)) if *within_rounds == 0 => {
            format!("The search stopped at --choices all={most}.")
        }
        Some(ChoicesLimit::States(most)) => format!(
            "The search stopped at --choices all={most}. That counts the states between rounds, at line \
             4, and the {within} states within rounds, at line 8."
        ),
        Some(ChoicesLimit::Memory) => {
            "The search stopped because its states need more than 1 GiB of memory.".to_owned()
        }
        Some(ChoicesLimit::Interrupted) => "The search was interrupted.".to_owned(),
    };
    if !reached.is_empty() {
        print_paragraph(out, &reached)?;
    }
    let costs: Vec<_> = costs.iter().map(|cost| grouped(cost.into())).collect();
    let text = match (limit, costs.join(" ")) {
        (_, costs) if costs.is_empty() => "No run was finished.".to_owned(),
        (None, costs) => format!("Moves that a run can take: {costs}."),
        (Some(_), costs) => format!("Moves of the runs that were finished: {costs}."),
    };
    Ok(print_paragraph(out, &text)?)
}
