//! `toposlam play`: a page on which a person is the robot.

use std::{
    io::Write,
    ops::ControlFlow,
    path::{Path, PathBuf},
};

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_model::{
    embedded_graph::Dart,
    enumerate::{Class, Each, Enumeration},
    format::named_world::NamedWorld,
};

use super::{
    CliError, Outcome,
    exit_codes::help_end,
    input, output,
    progress::{Progress, must_stop},
    text::{counted, vertices},
};
use crate::page::play_page;

/// Write a page on which you are the robot: map a world from its percepts
///
/// The page shows how many doors a place has, which one you came in by, and the marker. You choose doors, and
/// claim that a place is one you know. At the end your map is judged, and your moves are compared with those
/// of Algorithm 1, of the folding explorer, and of the certificate: no robot needs fewer. The page is one file
/// and needs no network.
#[derive(clap::Args)]
#[command(
    arg_required_else_help = true,
    after_help = help_end(
        "\
Examples:
  toposlam play worlds/shape-6.toml --out play.html
  toposlam play --edges 5 --seed 7 --out play.html",
        &[(0, "the page is written"), (2, "bad usage or input"), (3, "interrupted")],
    )
)]
pub(super) struct PlayArguments {
    /// The world file [default: a start at random, each of a class and a number of edges equally likely]
    world: Option<PathBuf>,
    /// Number of edges of a random world, from 1 to 8
    #[arg(
        long,
        default_value_t = 6,
        value_name = "N",
        value_parser = clap::value_parser!(u8).range(1..=8),
        conflicts_with = "world"
    )]
    edges: u8,
    /// Class of a random world: multigraph, simple, corridor or planar
    #[arg(long, default_value = "corridor", conflicts_with = "world")]
    class: Class,
    /// Random seed
    #[arg(long, default_value_t = 1, value_name = "N", conflicts_with = "world")]
    seed: u64,
    /// Where the robot starts, and which door is behind it [default: the start in the file]
    #[arg(long, value_name = "VERTEX:FACING", requires = "world")]
    start: Option<String>,
    /// The page to write: .html [default: standard output]
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// The most vertices of a world on a page.
const MOST_VERTICES: usize = 100;

impl PlayArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        output::check_place(&self.out, &["html", "htm"])?;
        let (world, facing) = match &self.world {
            Some(path) => self.read(path)?,
            None => (self.draw_world()?, Dart(0)),
        };
        let page = play_page(&world, facing);
        match &self.out {
            Some(path) => output::write_whole(path, page.as_bytes())?,
            None => out.write_all(page.as_bytes())?,
        }
        Ok(Outcome::Holds)
    }

    /// The world of the file, and the start.
    fn read(&self, path: &Path) -> Result<(NamedWorld, Dart), CliError> {
        let world = input::read_world(path)?;
        let count = world.graph.vertex_count();
        if count > MOST_VERTICES {
            let cause =
                format!("it has {}; a page can have {}", vertices(count), vertices(MOST_VERTICES));
            return Err(CliError::in_file(path, cause));
        }
        let facing = input::start_of(&world, self.start.as_deref())?;
        Ok((world, facing))
    }

    /// A world at random. Its start is dart 0.
    fn draw_world(&self) -> Result<NamedWorld, CliError> {
        let edges = usize::from(self.edges);
        let starts = Enumeration::new(Each::Start, self.class, edges)
            .map_err(|error| CliError::at("--edges", error))?;
        let progress = Progress::endless("random world", "starts")?;
        // It takes seconds to visit many starts.
        let stops = |visited: u64| visited.is_multiple_of(1 << 16) && must_stop();
        let mut count = 0;
        let counted_all = starts.for_each(&mut |_| {
            count += 1;
            if stops(count) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        if counted_all.is_break() {
            return Err(CliError::Interrupted);
        }
        if count == 0 {
            let cause =
                format!("class {} has no world with {}", self.class, counted(edges, "edge"));
            return Err(CliError::at("--edges", cause));
        }
        let mut left = Xoshiro256PlusPlus::seed_from_u64(self.seed).random_range(0..count);
        let mut chosen = None;
        let _ = starts.for_each(&mut |found| {
            if left == 0 {
                chosen = Some(found.graph.clone());
            }
            if left == 0 || stops(left) {
                return ControlFlow::Break(());
            }
            left -= 1;
            ControlFlow::Continue(())
        });
        progress.finish();
        let graph = chosen.ok_or(CliError::Interrupted)?;
        let name = format!("{}-{}-{}", self.class, self.edges, self.seed);
        Ok(NamedWorld::numbered(&name, "", graph, Some(Dart(0))))
    }
}
