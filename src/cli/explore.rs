//! `toposlam explore WORLD`: one algorithm in one world, as a story.

mod own;
mod report;
mod senses;
mod summary;

use std::{
    io::{self, Write},
    path::PathBuf,
};

use clap::ValueEnum;
use toposlam_model::{
    aid::Action,
    aid::AidKind,
    embedded_graph::Dart,
    format::named_world::NamedWorld,
    mapping::{
        DEFAULT_DART_BOUND, FACING, MappingAlgorithm, MappingEvent, MappingMethod, Observer,
    },
    proof::{Proof, WalkRecorder},
};

use super::{
    CliError, Outcome, RunChoices,
    certificate_cost::CertificateCost,
    exit_codes::help_end,
    explorer::ExplorerOptions,
    input,
    mapping_marker::{algorithm_for, check_seen, check_worlds, is_directional, marker_kind},
    method_options::{AuditOption, algorithms},
    output,
    progress::StopSignal,
    run_choices,
    text::print_paragraph,
    verdict_proof::ProofOption,
    write_world_or_picture,
};
use crate::{
    picture::WorldPicture,
    story::{PrintedStory, Story, head},
};
use report::ExploredWorld;
use senses::{ExtraSense, SensingRun, check_senses};
use summary::Summary;

/// Map one world and print the story: each door, percept and hypothesis, and the map
///
/// The run in a world with more than 25 vertices is summarised on one screen; --story prints it all.
///
/// The robot gets only percepts from the world. At the end a bijection proves that the map is
/// isomorphic to the world.
///
/// Algorithm 1 runs, or with --algorithm folding the folding explorer, which needs fewer moves. With --audit the robot
/// then walks the certificate of its map, and compares each percept with the map.
///
/// With --aid KIND, the explorer of another marking aid runs instead: of markers that the robot carries, a string, or
/// other robots. Undirected markers, and robots without a front, need a world without loops and parallel edges.
///
/// With --senses, in a floor plan, a second robot that also measures lengths or has a compass maps it, too, and its moves
/// are printed.
///
/// With --explorer, a program of yours runs instead, and each of its steps is printed.
#[derive(clap::Args)]
#[command(after_help = help_end(
    "\
Examples:
  toposlam explore worlds/shape-6.toml
  toposlam explore worlds/figure-1b.toml --start X:B --map map.svg
  toposlam explore worlds/shape-8.toml --choices all
  toposlam explore worlds/shape-8.toml --algorithm folding
  toposlam explore worlds/shape-8.toml --aid movable
  toposlam explore worlds/building-25.toml --aid string
  toposlam explore worlds/building-25.toml --story=summary
  toposlam explore worlds/shape-6.toml --certificate
  toposlam explore worlds/shape-6.toml --algorithm folding --audit
  toposlam explore worlds/building-25.toml --algorithm folding --senses lengths,compass
  toposlam explore worlds/shape-6.toml --explorer ./mine

In the story, v2.1 is dart 1 of the map's vertex v2. Darts are counted clockwise from the dart by \
which the vertex was first entered. When the robot has followed an unexplored dart, each other \
unexplored dart may be the other end of the same edge. A candidate is one that the percept does not \
rule out. To test it, the robot follows the path that would lead from there to the marker.",
    &[
        (0, "the map is right"),
        (1, "the map is wrong, or the explorer failed"),
        (2, "bad usage or input"),
        (3, "not known: ended by Ctrl-C, or --max-darts, the states of --choices, 1 GiB of memory for the states or a \
             --limit was reached"),
    ],
))]
#[command(mut_arg("explorer", |explorer| explorer.conflicts_with_all(NOT_FOR_EXPLORERS)))]
pub(super) struct ExploreArguments {
    /// A world file, or a plantri file with one world
    world: PathBuf,

    /// Where the robot starts, and which door is behind it [default: the start in the file]
    #[arg(long, value_name = "VERTEX:FACING")]
    start: Option<String>,

    /// The algorithm that maps with the directional marker: algorithm1 or folding
    #[arg(long, default_value = "algorithm1", hide_possible_values = true, value_parser = algorithms())]
    algorithm: MappingAlgorithm,

    /// The robot's marking aid: directional, or one that moves, as movable, string or team-2; any kind with
    /// --explorer
    #[arg(long, visible_alias = "aid", default_value = "directional", value_name = "KIND", value_parser = marker_kind)]
    marker: AidKind,

    /// Runs: default, or all to also try every choice that the algorithm leaves open; with all=N, stop at more
    /// than N states, between rounds (line 4) and within (line 8), instead of 1000000
    #[arg(long, default_value = "default", value_parser = run_choices)]
    choices: RunChoices,

    /// Stop when more darts (edge ends) are known
    #[arg(long, value_name = "N", default_value_t = DEFAULT_DART_BOUND)]
    max_darts: usize,

    /// Print the story of each round, or with --story=summary counts of rounds and candidates in its place
    /// [default: full in worlds with up to 25 vertices, summary in larger ones]
    #[arg(long, value_name = "HOW", num_args = 0..=1, default_missing_value = "full", require_equals = true,
        hide_possible_values = true, conflicts_with = "json")]
    story: Option<StoryLength>,

    #[command(flatten)]
    audit: AuditOption,

    /// Also map the floor plan with these senses: lengths of hallways, which are exact, a compass, or both
    #[arg(long, value_name = "SENSE", value_delimiter = ',')]
    senses: Vec<ExtraSense>,

    /// Print a shortest walk that proves the map of the world, and compare the run with it
    #[arg(long)]
    certificate: bool,

    /// Write the map: .toml, .json, .dot, plantri's .ec or .pc, or a picture with the number of moves, .svg or
    /// .png (repeatable)
    #[arg(long, value_name = "FILE")]
    map: Vec<PathBuf>,

    #[command(flatten)]
    proof: ProofOption,

    /// Print one JSON object, with the doors taken and each pick-up and drop
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    explorer: ExplorerOptions,
}

/// Options of runs that explorers do not have.
const NOT_FOR_EXPLORERS: [&str; 6] =
    ["algorithm", "choices", "max_darts", "story", "audit", "senses"];

/// How much of a run is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum StoryLength {
    Full,
    Summary,
}

/// The most vertices of a world whose run is printed round by round unless --story is given.
const STORY_VERTICES: usize = 25;

/// What is printed of a run.
enum RunPrinter<'o, W: Write> {
    /// For JSON.
    Doors(Vec<Action>),
    /// Counts, at the end.
    Summary(Summary),
    Story(Box<PrintedStory<&'o mut W>>),
}

impl ExploreArguments {
    fn summarises(&self, world: &NamedWorld) -> bool {
        let is_large = world.graph.vertex_count() > STORY_VERTICES;
        self.story.map_or(is_large, |story| story == StoryLength::Summary)
    }

    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        let world = input::read_world(&self.world)?;
        if let Some(command) = &self.explorer.explorer {
            self.explorer.check_one_run()?;
            check_seen(self.marker, &self.world, [&world.graph])?;
            let facing = input::start_of(&world, self.start.as_deref())?;
            self.check_outputs(&world)?;
            return self.explore_by(command, &world, facing, out);
        }
        check_worlds(self.marker, &self.world, std::slice::from_ref(&world.graph))?;
        let facing = input::start_of(&world, self.start.as_deref())?;
        self.check_outputs(&world)?;
        let algorithm = algorithm_for(self.algorithm, self.marker)?;
        check_senses(&self.senses, &world, algorithm)?;
        self.explore(algorithm, &world, facing, out)
    }

    /// Checks what is to be written and printed before the run.
    fn check_outputs(&self, world: &NamedWorld) -> Result<(), CliError> {
        for path in &self.map {
            output::check_map_place(path, world.graph.is_simple())?;
        }
        self.proof.check_place()?;
        let of_directional = [
            ("--certificate", self.certificate),
            ("--audit", self.audit.audits().is_some()),
            ("--proof", self.proof.path().is_some()),
        ];
        let other = of_directional.into_iter().find(|(_, is_given)| *is_given);
        match other.filter(|_| !is_directional(self.marker)) {
            Some((option, _)) => Err(CliError::at(option, "needs --marker directional")),
            None => Ok(()),
        }
    }

    fn explore(
        &self,
        algorithm: MappingAlgorithm,
        world: &NamedWorld,
        facing: Dart,
        out: &mut dyn Write,
    ) -> Result<Outcome, CliError> {
        let mut out = io::BufWriter::new(out);
        let mut printer = if self.json {
            RunPrinter::Doors(Vec::new())
        } else if self.summarises(world) {
            print_paragraph(&mut out, &head(world, facing))?;
            RunPrinter::Summary(Summary::default())
        } else {
            let story = Story::new(world, facing);
            RunPrinter::Story(Box::new(PrintedStory::new(story, Some(&mut out))))
        };
        let method = MappingMethod::By { algorithm, audits: self.audit.audits().unwrap_or(0) };
        let mut walk = WalkRecorder::default();
        let mut run = ExploredWorld::new(
            method,
            self.max_darts,
            (world, facing),
            &mut |world: &mut _, journey: &_, event: MappingEvent| {
                walk.event(event);
                match &mut printer {
                    RunPrinter::Doors(doors) => doors.extend(event.action()),
                    RunPrinter::Summary(summary) => summary.count(event),
                    RunPrinter::Story(story) => story.event(world, journey, event),
                }
            },
        );
        let mut doors = None;
        match printer {
            RunPrinter::Doors(taken) => doors = Some(taken),
            RunPrinter::Summary(summary) => summary.print(&mut out)?,
            RunPrinter::Story(story) => {
                story.finish()?;
            }
        }
        // All choices can take long.
        out.flush()?;
        let moves = run.moves_of_right_map();
        let certificate = || CertificateCost::with_doors(&world.graph, facing, moves);
        run.certificate = self.certificate.then(certificate);
        run.with_senses = SensingRun::new(&self.senses, algorithm, self.max_darts, (world, facing));
        run.ways =
            algorithm.other_runs(self.choices, (&world.graph, facing), &StopSignal).transpose();
        if let Some(doors) = doors {
            run.print_json(doors, &mut out)?;
        } else {
            let all = !self.summarises(world);
            run.print(&mut out, if all { usize::MAX } else { STORY_VERTICES })?;
        }
        out.flush()?;
        if let Some((map, moves)) = run.map() {
            self.write_map(&map, moves, run.carries)?;
            self.proof.write(|| Ok(vec![Proof::of_map(&map.graph, FACING, walk.walk()?)?]))?;
        } else {
            if !self.map.is_empty() {
                remark!("the map is not written: it is not complete");
            }
            self.proof.remark(&"the map is not complete");
        }
        Ok(run.outcome())
    }

    fn write_map(&self, map: &NamedWorld, moves: u64, carries: bool) -> Result<(), CliError> {
        // A marker that the robot carries has no place in the picture.
        let (start, hand) =
            if carries { (None, "; the robot carries its marker") } else { (map.start, "") };
        let caption = format!("mapped in {moves} moves{hand}");
        let picture = WorldPicture { caption: &caption, start, ..WorldPicture::from(map) };
        self.map.iter().try_for_each(|path| write_world_or_picture(path, map, &picture))
    }
}
