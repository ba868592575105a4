//! `toposlam compare A B`: are two worlds isomorphic or mirror images, and can a robot with a marker
//! distinguish them?

mod joint_walk;
mod robot_comparison;

use std::{io::Write, path::PathBuf};

use serde_json::{Map, Value, json};
use toposlam_model::{
    aid::Action,
    aid::{Aid, AidKind},
    embedded_graph::Dart,
    format::named_world::NamedWorld,
    isomorphism::{Bijection, Difference, isomorphism, mirror_isomorphism},
    marker::{self},
    proof::{Claim, Proof},
};

use super::{
    CliError, Outcome, aid_kinds,
    exit_codes::help_end,
    input,
    json::print_line,
    mapping_marker::check_seen,
    output,
    progress::Progress,
    text::{counted, print_columns, print_paragraph, vertices},
    verdict_proof::ProofOption,
    walk_page,
};
use robot_comparison::RobotComparison;

/// Compare two worlds: are they isomorphic, and can a robot with a marker distinguish them?
///
/// Two worlds are isomorphic if a bijection of their darts (edge ends) preserves edges and clockwise
/// orders. A mirror image has every order reversed; two worlds can be both. The starts do not matter for
/// this.
///
/// The start in each file places the marker. The robot in A begins there. The robot in B begins at each
/// pose that the marker cannot distinguish from its start, unless --start is given twice.
#[derive(clap::Args)]
#[command(after_help = help_end(
    "\
Examples:
  toposlam compare worlds/figure-1a.toml worlds/figure-1b.toml
  toposlam compare worlds/figure-1a.toml worlds/figure-1b.toml --walk 0,1,1
  toposlam compare worlds/cycle-3.toml worlds/cycle-4.toml --marker none
  toposlam compare worlds/real/aces.toml worlds/real/aces-corners.toml \\
    --smooth-corners

If no walk distinguishes the worlds, the proof is the list of all pairs of states that the robots can \
be in. If there are more than 100,000 pairs, the proof is the classes of indistinguishable states. In v:2~w:0 the robot in A is at v, entered by the dart 2 places clockwise from the first one \
in the file, and the robot in B is at w. With a movable marker, v:2@u has the marker at u, and in \
v:2+marker the robot carries it.",
    &[
        (0, "the worlds were compared, whatever the result"),
        (2, "bad usage or input"),
        (3, "interrupted"),
    ],
))]
pub(super) struct CompareArguments {
    /// A world file
    a: PathBuf,
    /// Another world file
    b: PathBuf,

    /// Marking aid [default: directional, if both worlds have a start]
    #[arg(long, visible_alias = "aid", value_name = "KIND", value_parser = aid_kinds())]
    marker: Option<AidKind>,

    /// Where the robot starts in A; a second --start is for B [default: the starts in the files]
    #[arg(long, value_name = "VERTEX:FACING")]
    start: Vec<String>,

    /// Compare the worlds without their corners: vertices with two doors
    #[arg(long)]
    smooth_corners: bool,

    /// Print the percepts of a walk in both worlds: doors, pick-up and drop, separated by commas
    #[arg(
        long,
        value_name = "ACTIONS",
        num_args = 0..=1,
        value_delimiter = ',',
        value_parser = |action: &str| action.trim().parse::<Action>()
    )]
    walk: Option<Vec<Action>>,

    /// Write a page on which a person walks both worlds at once
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,

    #[command(flatten)]
    proof: ProofOption,

    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

const NO_START: &str = "a world has no start; give --start twice, or --marker none";

/// How the two embedded graphs compare.
struct GraphComparison<'w> {
    worlds: [&'w NamedWorld; 2],
    same: Result<Bijection, Difference>,
    mirror: bool,
}

impl CompareArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        let mut worlds = [input::read_world(&self.a)?, input::read_world(&self.b)?];
        if self.start.len() > 2 {
            return Err(CliError::at("--start", "there are two worlds; give it at most twice"));
        }
        if self.smooth_corners {
            worlds = worlds.map(|world| world.smoothed());
        }
        for (world, start) in worlds.iter_mut().zip(&self.start) {
            world.start = Some(input::start_of(world, Some(start))?);
        }
        let worlds = [&worlds[0], &worlds[1]];
        output::check_place(&self.html, &["html", "htm"])?;
        self.proof.check_place()?;
        let robots = self.robots(worlds)?;
        let walk = match (&self.walk, &robots) {
            (None, _) => None,
            (Some(actions), Some(robots)) => Some(robots.walk(actions)?),
            (Some(_), None) => return Err(CliError::at("--walk", NO_START)),
        };
        if let Some(path) = &self.html {
            match &robots {
                Some(robots) => robots.write_page(path)?,
                None => return Err(CliError::at("--html", NO_START)),
            }
        }
        let graphs = GraphComparison {
            worlds,
            same: isomorphism(&worlds[0].graph, &worlds[1].graph),
            mirror: mirror_isomorphism(&worlds[0].graph, &worlds[1].graph).is_some(),
        };
        self.proof.write(|| {
            let claim = Claim::isomorphism(&worlds[0].graph, &worlds[1].graph);
            match &robots {
                Some(robots) => robots.proof(claim),
                None => Ok(Proof::of_graphs(worlds.map(|world| &world.graph), claim)),
            }
            .map(|proof| vec![proof])
        })?;
        if self.json {
            let mut line = fields(graphs.json());
            line.extend(robots.iter().flat_map(|robots| fields(robots.json())));
            line.extend(walk.map(|walk| ("walked".to_owned(), json!(walk))));
            print_line(out, "comparison", &line)?;
        } else {
            graphs.print(out)?;
            if let Some(robots) = &robots {
                robots.print(out)?;
            }
            if let Some(walk) = &walk {
                walk.print(out)?;
            }
        }
        Ok(Outcome::Holds)
    }

    /// The robots in the two worlds. `None` if no marker is given and a world has no start.
    fn robots<'w>(
        &self,
        worlds: [&'w NamedWorld; 2],
    ) -> Result<Option<RobotComparison<'w>>, CliError> {
        let named = [&self.a, &self.b].into_iter().zip(worlds);
        let startless = named.clone().find(|(_, world)| world.start.is_none());
        let marker = match (self.marker, startless) {
            (None, Some(_)) => return Ok(None),
            (None, None) => marker::Directional.into(),
            (Some(marker), Some((path, world)))
                if !marker.parts(&world.graph, Dart(0)).is_empty() =>
            {
                let cause = "there is no [start] that places the marking aid; give --start twice, \
                             first for A and then for B";
                return Err(CliError::in_file(path, cause));
            }
            (Some(marker), _) => marker,
        };
        for (path, world) in [&self.a, &self.b].into_iter().zip(worlds) {
            check_seen(marker, path, [&world.graph])?;
        }
        let one_pose = self.start.len() == 2;
        let progress = Progress::endless("comparing", "starts")?;
        let robots = RobotComparison::new(worlds, marker, one_pose, &progress);
        progress.finish();
        robots.map(Some)
    }
}

fn fields(object: Value) -> Map<String, Value> {
    if let Value::Object(fields) = object { fields } else { Map::new() }
}

/// What differs first, and how much of it A and B have.
fn differing(difference: &Difference) -> Value {
    let (what, counts, degree) = match *difference {
        Difference::Edges(a, b) => ("edges", Some([a, b]), None),
        Difference::Vertices(a, b) => ("vertices", Some([a, b]), None),
        Difference::Degrees { degree, vertices: (a, b) } => {
            ("vertices-of-degree", Some([a, b]), Some(degree))
        }
        Difference::Genus(a, b) => ("genus", Some([a, b]), None),
        Difference::Orders => ("orders", None, None),
    };
    json!({ "what": what, "degree": degree, "counts": counts })
}

impl GraphComparison<'_> {
    /// The object without robots.
    fn json(&self) -> Value {
        let (same, difference) = (self.same.as_ref().ok(), self.same.as_ref().err());
        json!({
            "isomorphic": same.is_some(),
            "mirror": self.mirror,
            "bijection": same.map(|same| self.pairs(same).collect::<Vec<_>>()),
            "difference": difference.map(ToString::to_string),
            "differing": difference.map(differing),
            "marker": null,
            "distinguishable": null,
            "walk": null,
            "relation": null,
        })
    }

    fn print(&self, out: &mut dyn Write) -> Result<(), CliError> {
        for (letter, world) in ["A", "B"].into_iter().zip(self.worlds) {
            let text = format!(
                "{letter} is {}: {}, {}, {}, genus {}",
                world.name,
                vertices(world.graph.vertex_count()),
                counted(world.graph.edge_count(), "edge"),
                counted(world.graph.face_count(), "face"),
                world.graph.genus(),
            );
            print_paragraph(out, &text)?;
        }
        match &self.same {
            Ok(bijection) => {
                writeln!(out, "isomorphic, by this bijection from A to B:")?;
                let pairs = self.pairs(bijection).map(|[from, to]| format!("{from} -> {to}"));
                print_columns(out, &pairs.collect::<Vec<_>>())?;
            }
            Err(difference) => print_paragraph(out, &format!("not isomorphic: {difference}"))?,
        }
        let word = if self.mirror { "mirror images" } else { "not mirror images" };
        writeln!(out, "{word}")?;
        Ok(())
    }

    fn pairs(&self, bijection: &Bijection) -> impl Iterator<Item = [String; 2]> {
        let [a, b] = self.worlds;
        let images = a.graph.darts().zip(bijection.images());
        images.map(|(dart, &image): (Dart, _)| [a.start_text(dart), b.start_text(image)])
    }
}
