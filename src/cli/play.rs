//! `toposlam play`: a page on which a person is the robot.

use std::{
    io::Write,
    path::{Path, PathBuf},
};

use toposlam_model::{aid::AidKind, enumerate::Class, format::named_world::NamedWorld};

use super::{
    CliError, Outcome,
    exit_codes::help_end,
    input,
    mapping_marker::check_seen,
    marking_aids, output,
    progress::{Progress, StopSignal},
    text::vertices,
};
use crate::page::{MOST_VERTICES, NoGame, games_of, play_page, random_games};

/// Write a page on which you are the robot: map a world from its percepts
///
/// The page shows how many doors a place has, which one you came in by, and the marker, or what else the marking aid
/// shows. You choose doors, carry markers or a string, send other robots, and claim that a place is one you know. At the end your map is judged. If it is right but your walk does not prove
/// it, the page draws the smallest other world that explains your walk. Your moves are compared with those of the
/// algorithms that map with the marker, and, with a directional one, of the certificate: no robot needs fewer.
///
/// The page is one file and needs no network. It has further worlds to map: the world with other starts, or more
/// random ones.
#[derive(clap::Args)]
#[command(
    arg_required_else_help = true,
    after_help = help_end(
        "\
Examples:
  toposlam play worlds/shape-6.toml --out play.html
  toposlam play worlds/figure-1a.toml --marker undirected --out play.html
  toposlam play worlds/k4-torus.toml --aid team-2 --out play.html
  toposlam play --edges 5 --seed 7 --out play.html",
        &[(0, "the page is written"), (2, "bad usage or input"), (3, "interrupted")],
    )
)]
pub(super) struct PlayArguments {
    /// The world file [default: a start at random, each of a class and a number of edges equally likely]
    world: Option<PathBuf>,
    /// Marking aid
    #[arg(long, visible_alias = "aid", default_value = "directional", value_name = "KIND", value_parser = marking_aids())]
    marker: AidKind,
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

impl PlayArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        output::check_place(&self.out, &["html", "htm"])?;
        let games = match &self.world {
            Some(path) => self.read(path)?,
            None => self.random()?,
        };
        let page = play_page(&games, self.marker);
        match &self.out {
            Some(path) => output::write_whole(path, page.as_bytes())?,
            None => out.write_all(page.as_bytes())?,
        }
        Ok(Outcome::Holds)
    }

    /// The world of the file, from its start and from others.
    fn read(&self, path: &Path) -> Result<Vec<NamedWorld>, CliError> {
        let world = input::read_world(path)?;
        let count = world.graph.vertex_count();
        if count > MOST_VERTICES {
            let cause =
                format!("it has {}; a page can have {}", vertices(count), vertices(MOST_VERTICES));
            return Err(CliError::in_file(path, cause));
        }
        check_seen(self.marker, path, [&world.graph])?;
        let facing = input::start_of(&world, self.start.as_deref())?;
        Ok(games_of(&world, facing))
    }

    fn random(&self) -> Result<Vec<NamedWorld>, CliError> {
        let progress = Progress::endless("random worlds", "starts")?;
        let games = random_games(self.class, self.edges.into(), self.seed, &StopSignal);
        progress.finish();
        games.map_err(|none| match none {
            NoGame::Interrupted => CliError::Interrupted,
            none => CliError::at("--edges", none),
        })
    }
}
