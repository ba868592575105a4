//! `toposlam explore WORLD`: Algorithm 1 on one world, told as a story.

mod doors;
mod ending;
mod story;

use std::{
    io::{self, Write},
    path::PathBuf,
};

use toposlam::picture::{self, Picture};
use toposlam_model::{
    check::{Algorithm1, Flaw, every_way, judge},
    format::named_world::NamedWorld,
    isomorphism::Candidate,
    mapping::{DEFAULT_DART_BOUND, Exploration, Nearest, map_world},
    world::GraphWorld,
};

use super::{Choice, Choices, Failure, Outcome, input, output};
use doors::Doors;
use ending::Ending;
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

Exit codes: 0 the map is right, 1 it is wrong, 2 bad usage or input,
3 given up at --max-darts or --max-states.")]
pub(super) struct Arguments {
    /// A world file, or a file of plantri's with one world
    world: PathBuf,

    /// Where the robot starts, and which door is behind it [default: the world's own start]
    #[arg(long, value_name = "VERTEX:FACING")]
    start: Option<String>,

    /// Also try every resolution of what Algorithm 1 leaves open: default or all
    #[arg(long, default_value = "default", hide_possible_values = true)]
    choices: Choices,

    /// With --choices all: give up when there are more states
    /// [default: 1000000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    max_states: Option<u64>,

    /// Give up when more edge ends are known
    #[arg(long, value_name = "N", default_value_t = DEFAULT_DART_BOUND)]
    max_darts: usize,

    /// Tell every rejected hypothesis, not only the first few of each round
    #[arg(long, conflicts_with = "json")]
    full: bool,

    /// Tell the doors taken
    #[arg(long, conflicts_with = "json")]
    doors: bool,

    /// Write the map: .toml, .json, .dot, or plantri's .ec or .pc
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
        if let Some(map) = &self.map {
            output::check_world_place(map, world.graph.is_simple())?;
        }
        if let Some(svg) = &self.svg {
            output::check_place(svg, &["svg"])?;
        }
        let choice = self.choices.with_budget(self.max_states)?;
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
            .and_then(|()| judge(&Algorithm1, &exploration, facing, &robot, &mut candidate));
        let ways = match choice {
            Choice::Default => None,
            Choice::All { budget } => {
                Some(every_way(&Algorithm1, &world.graph, facing, budget, &()))
            }
        };
        let ending = Ending { world: &world, facing, exploration: &exploration, result, ways };
        if self.json {
            ending.tell_json(&mut out)?;
        } else {
            ending.tell(&mut out)?;
        }
        out.flush()?;
        match ending.map() {
            Some(map) => self.write_map(&map, exploration.moves())?,
            None if self.map.is_some() || self.svg.is_some() => {
                eprintln!("the map is not complete, and is not written");
            }
            None => {}
        }
        Ok(ending.outcome())
    }

    fn write_map(&self, map: &NamedWorld, moves: u64) -> Result<(), Failure> {
        if let Some(path) = &self.map {
            output::write_world(path, map)?;
        }
        if let Some(path) = &self.svg {
            let caption = format!("mapped in {moves} moves");
            let drawn = Picture { caption: &caption, ..Picture::from(map) };
            output::write_whole(path, picture::svg(&drawn).as_bytes())?;
        }
        Ok(())
    }
}
