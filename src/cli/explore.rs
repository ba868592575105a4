//! `toposlam explore WORLD`: Algorithm 1 on one world, told as a story.

mod doors;
mod story;

use std::{
    io::{self, Write},
    path::PathBuf,
};

use serde::Serialize;
use toposlam::picture::{self, Picture};
use toposlam_model::{
    check::{EveryWay, Flaw, every_way, judge, move_bound},
    embedded_graph::{Dart, EmbeddedGraph},
    format::{named_world::NamedWorld, world_file},
    isomorphism::{Bijection, Candidate},
    mapping::{DEFAULT_DART_BOUND, Exploration, FACING, MappingError, Nearest, map_world},
    world::GraphWorld,
};

use super::{Failure, Outcome, input, output};
use doors::Doors;
use story::{Detail, Story};

/// Run Algorithm 1 on one world: the map, the moves, the story of each hypothesis
///
/// The world is used only to answer what the robot perceives, and to prove the map right at the end.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  toposlam explore worlds/shape-6.toml
  toposlam explore worlds/figure-1b.toml --start X:B --svg map.svg
  toposlam explore worlds/shape-8.toml --choices all

In the story, v2.1 is dart 1 of the map's vertex v2: the one that stands one place clockwise from
the dart by which v2 was first entered.

Exit codes: 0 the map is right, 1 it is wrong, 2 bad usage or input, 3 given up at --max-darts.")]
pub(super) struct Arguments {
    /// A world file
    world: PathBuf,

    /// Where the robot starts, and which door is behind it [default: the world's own start]
    #[arg(long, value_name = "VERTEX:FACING")]
    start: Option<String>,

    /// Also try every resolution of what Algorithm 1 leaves open: default or all
    #[arg(long, default_value = "default", value_parser = ["default", "all"])]
    choices: String,

    /// Give up when more edge ends are known
    #[arg(long, value_name = "N", default_value_t = DEFAULT_DART_BOUND)]
    max_darts: usize,

    /// Tell every rejected hypothesis, not only the first few of each round
    #[arg(long, conflicts_with = "json")]
    full: bool,

    /// Tell the doors taken
    #[arg(long, conflicts_with = "json")]
    doors: bool,

    /// Write the map as a world file (JSON where the name ends in .json)
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,

    /// Write a picture of the map, with the cost
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,

    /// Print one JSON object, with the doors taken
    #[arg(long)]
    json: bool,
}

impl Arguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, Failure> {
        let world = input::read_world(&self.world)?;
        let facing = input::start_of(&world, self.start.as_deref())?;
        for file in self.map.iter().chain(&self.svg) {
            output::check_place(file)?;
        }
        let mut out = io::BufWriter::new(out);
        let mut exploration = Exploration::new(self.max_darts);
        let mut robot = GraphWorld::new(&world.graph, facing);
        let run = if self.json {
            let mut doors = Doors::new(&mut out);
            let run = map_world(&mut robot, &mut Nearest, &mut exploration, &mut doors);
            doors.finish()?;
            run
        } else {
            let detail = Detail { every_hypothesis: self.full, doors: self.doors };
            let mut story = Story::new(&mut out, &world, facing, detail);
            let run = map_world(&mut robot, &mut Nearest, &mut exploration, &mut story);
            story.finish()?;
            run
        };
        let mut candidate = Candidate::default();
        let result = run
            .map_err(Flaw::from)
            .and_then(|()| judge(&exploration, facing, &robot, &mut candidate));
        let ending = Ending { world: &world, facing, exploration: &exploration, result };
        let ways = match self.choices.as_str() {
            "all" => Some(every_way(&world.graph, facing)),
            _ => None,
        };
        let ways = ways.transpose().map_err(|flaw| Failure::at("--choices all", flaw))?;
        if self.json {
            ending.tell_json(&mut out, ways.as_ref())?;
        } else {
            ending.tell(&mut out, ways.as_ref())?;
        }
        out.flush()?;
        if let Some(map) = ending.map() {
            if let Some(path) = &self.map {
                output::write_world(path, &map)?;
            }
            if let Some(path) = &self.svg {
                let caption = format!("mapped in {} moves", exploration.moves());
                let drawn = Picture { caption: &caption, ..Picture::from(&map) };
                output::write_whole(path, picture::svg(&drawn).as_bytes())?;
            }
        }
        Ok(ending.outcome())
    }
}

/// What `--json` prints after the doors.
#[derive(Serialize)]
struct Rest {
    moves: u64,
    edges: Option<usize>,
    vertices: usize,
    isomorphic: bool,
    map: Option<serde_json::Value>,
    start: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    states: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    runs: Option<u128>,
    #[serde(skip_serializing_if = "Option::is_none")]
    costs: Option<Vec<u64>>,
}

/// How the run ended.
struct Ending<'a> {
    world: &'a NamedWorld,
    facing: Dart,
    exploration: &'a Exploration,
    result: Result<&'a Bijection, Flaw>,
}

impl Ending<'_> {
    fn outcome(&self) -> Outcome {
        match self.result {
            Ok(_) => Outcome::Holds,
            Err(Flaw::Error(MappingError::Bound { .. })) => Outcome::Incomplete,
            Err(_) => Outcome::Violated,
        }
    }

    /// The map as a world, where it is complete.
    fn map(&self) -> Option<NamedWorld> {
        let name = format!("{}-map", self.world.name);
        let about =
            format!("The map of {}, made in {} moves", self.world.name, self.exploration.moves());
        let graph = self.exploration.map().complete()?;
        Some(NamedWorld::numbered(&name, &about, graph.clone(), Some(FACING)))
    }

    /// The object whose beginning, with the doors, has been written during the run.
    fn tell_json(&self, out: &mut dyn Write, ways: Option<&EveryWay>) -> Result<(), Failure> {
        let map = self.exploration.map();
        let rest = Rest {
            moves: self.exploration.moves(),
            edges: map.complete().map(EmbeddedGraph::edge_count),
            vertices: map.vertex_count(),
            isomorphic: self.result.is_ok(),
            map: self.map().as_ref().map(world_file::to_json),
            start: self.world.start_text(self.facing),
            error: self.result.as_ref().err().map(ToString::to_string),
            states: ways.map(|ways| ways.states),
            runs: ways.map(|ways| ways.runs),
            costs: ways.map(|ways| ways.costs.iter().collect()),
        };
        let rest = serde_json::to_string(&rest).map_err(io::Error::from)?;
        writeln!(out, "{}", rest.strip_prefix('{').unwrap_or(&rest))?;
        Ok(())
    }

    fn tell(&self, out: &mut dyn Write, ways: Option<&EveryWay>) -> Result<(), Failure> {
        let Self { exploration, .. } = self;
        match &self.result {
            Err(flaw) => {
                let moves = story::counted(exploration.moves() as usize, "move");
                writeln!(out, "\nAfter {moves}: {flaw}")?;
            }
            Ok(bijection) => self.tell_map(bijection, out)?,
        }
        if let Some(EveryWay { states, runs, costs }) = ways {
            let costs: Vec<_> = costs.iter().map(|cost| cost.to_string()).collect();
            writeln!(out, "\nWith all choices there are {states} states and {runs} runs,")?;
            writeln!(out, "which take this many moves: {}.", costs.join(" "))?;
        }
        Ok(())
    }

    fn tell_map(&self, bijection: &Bijection, out: &mut dyn Write) -> Result<(), Failure> {
        let Self { world, exploration, .. } = self;
        let (edges, vertices) = (world.graph.edge_count(), world.graph.vertex_count());
        writeln!(
            out,
            "\nThe map: {vertices} vertices and {edges} edges, in {} moves (at least {edges}, at most {}).",
            exploration.moves(),
            move_bound(edges, vertices),
        )?;
        let image = |dart: Dart| bijection.image(dart).unwrap_or(self.facing);
        write!(out, "It is isomorphic to the world:")?;
        for (place, vertex) in exploration.map().vertices().enumerate() {
            let name =
                exploration.map().darts_of(vertex).next().map(|dart| world.at_text(image(dart)));
            let break_ = if place % 6 == 0 { "\n " } else { "" };
            write!(out, "{break_} v{} = {},", vertex.0, name.unwrap_or_default())?;
        }
        let robot = exploration.robot();
        writeln!(
            out,
            "\nand the robot knows where it is: at v{}, having come in by its dart {}.",
            exploration.map().vertex(robot).0,
            exploration.map().index(robot),
        )?;
        Ok(())
    }
}
