//! `toposlam compare A B`: the same world, mirror images, or what differs; and can a robot with a
//! marker tell them apart?

mod joint_walk;
mod robot_comparison;

use std::{io::Write, path::PathBuf};

use serde_json::json;
use toposlam_model::{
    embedded_graph::Dart,
    format::named_world::NamedWorld,
    isomorphism::{Bijection, Difference, isomorphism, mirror_isomorphism},
    marker::{self, Marker},
};

use super::{
    Failure, Outcome, input, marker_kinds,
    text::{counted, vertices},
    walk_page,
};
use joint_walk::ActionList;
use robot_comparison::RobotComparison;

/// Compare two worlds: isomorphic, mirror images, or the first difference; and by which walk, if by
/// any, a robot with a marker tells them apart
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  toposlam compare worlds/figure-1a.toml worlds/figure-1b.toml --marker undirected
  toposlam compare worlds/figure-1a.toml worlds/figure-1b.toml --marker directional --walk 0,1,1
  toposlam compare worlds/cycle-3.toml worlds/cycle-4.toml --marker none --html cycles.html

Isomorphic means: a bijection of edge ends keeps edges and clockwise orders. A mirror image has
every order reversed. Both can be so at once. The starts do not matter for this.

The marker is placed once in each world, by its start. The robot in A begins there; the one in B
begins in every way that the marker cannot tell from its start, unless --start is given twice.
Where no walk tells the worlds apart, all pairs of states that the robots can be in are the proof:
v:2~w:0 is the robot in A at v, having come in by the dart 2 places clockwise from the first that
the file lists, and the one in B at w. With a movable marker, v:2@u is a marker that lies at u, and
v:2+marker one that is carried.")]
pub(super) struct CompareArguments {
    /// A world file
    a: PathBuf,
    /// Another world file
    b: PathBuf,

    /// Kind of marker [default: directional, where both worlds have a start]
    #[arg(long, value_name = "KIND", value_parser = marker_kinds())]
    marker: Option<&'static dyn Marker>,

    /// Where the robot starts in A, instead of the file's [start]; given twice, then in B too
    #[arg(long, value_name = "VERTEX:FACING")]
    start: Vec<String>,

    /// Walk in both worlds: door numbers, pick-up and drop, with commas between them
    #[arg(long, value_name = "ACTIONS")]
    walk: Option<ActionList>,

    /// Write a page on which a person walks both worlds at once
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,

    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Why robots cannot walk.
const NO_START: &str = "there is no start to walk from; give --start twice, or --marker none";

/// What holds of the two embedded graphs.
struct Graphs<'w> {
    worlds: [&'w NamedWorld; 2],
    same: Result<Bijection, Difference>,
    mirror: bool,
}

impl CompareArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, Failure> {
        let mut worlds = [input::read_world(&self.a)?, input::read_world(&self.b)?];
        if self.start.len() > 2 {
            return Err(Failure::at("--start", "there are two worlds; give it twice at most"));
        }
        for (world, start) in worlds.iter_mut().zip(&self.start) {
            world.start = Some(input::start_of(world, Some(start))?);
        }
        let worlds = [&worlds[0], &worlds[1]];
        if let Some(path) = &self.html {
            walk_page::check_place(path)?;
        }
        let robots = self.robots(worlds)?;
        let walk = match (&self.walk, &robots) {
            (None, _) => None,
            (Some(actions), Some(robots)) => Some(robots.walk(actions)?),
            (Some(_), None) => return Err(Failure::at("--walk", NO_START)),
        };
        if let Some(path) = &self.html {
            match &robots {
                Some(robots) => robots.write_page(path)?,
                None => return Err(Failure::at("--html", NO_START)),
            }
        }
        let graphs = Graphs {
            worlds,
            same: isomorphism(&worlds[0].graph, &worlds[1].graph),
            mirror: mirror_isomorphism(&worlds[0].graph, &worlds[1].graph).is_some(),
        };
        if self.json {
            let mut line = graphs.json();
            line.extend(
                robots.as_ref().map_or_else(robot_comparison::unknown, RobotComparison::json),
            );
            line.extend(walk.as_ref().map(|walk| ("walked".to_owned(), walk.json())));
            writeln!(out, "{}", serde_json::Value::Object(line))?;
        } else {
            graphs.tell(out)?;
            if let Some(robots) = &robots {
                robots.tell(out)?;
            }
            if let Some(walk) = &walk {
                walk.tell(out)?;
            }
        }
        Ok(Outcome::Holds)
    }

    /// The robots in the two worlds, where there is a marker, and starts that place it.
    fn robots<'w>(
        &self,
        worlds: [&'w NamedWorld; 2],
    ) -> Result<Option<RobotComparison<'w>>, Failure> {
        let named = [&self.a, &self.b].into_iter().zip(worlds);
        let startless = named.clone().find(|(_, world)| world.start.is_none());
        let marker = match (self.marker, startless) {
            (None, Some(_)) => return Ok(None),
            (None, None) => &marker::Directional,
            (Some(marker), Some((path, world)))
                if !marker.parts(&world.graph, Dart(0)).is_empty() =>
            {
                let cause = format!(
                    "there is no [start], by which the {} marker is placed; give --start twice, \
                     first for A and then for B",
                    marker.name()
                );
                return Err(Failure::in_file(path, cause));
            }
            (Some(marker), _) => marker,
        };
        let one_pose = self.start.len() == 2;
        RobotComparison::new(worlds, marker, one_pose).map(Some)
    }
}

impl Graphs<'_> {
    fn json(&self) -> serde_json::Map<String, serde_json::Value> {
        let line = json!({
            "schema": 1,
            "isomorphic": self.same.is_ok(),
            "mirror": self.mirror,
            "bijection": self.same.as_ref().ok().map(|bijection| self.pairs(bijection)),
            "difference": self.same.as_ref().err().map(ToString::to_string),
        });
        line.as_object().cloned().unwrap_or_default()
    }

    fn tell(&self, out: &mut dyn Write) -> Result<(), Failure> {
        for (letter, world) in ["A", "B"].into_iter().zip(self.worlds) {
            writeln!(
                out,
                "{letter} is {}: {}, {}, {}, genus {}",
                world.name,
                vertices(world.graph.vertex_count()),
                counted(world.graph.edge_count(), "edge"),
                counted(world.graph.face_count(), "face"),
                world.graph.genus(),
            )?;
        }
        match &self.same {
            Ok(bijection) => {
                writeln!(out, "isomorphic, by this bijection from A to B:")?;
                for [from, to] in self.pairs(bijection) {
                    writeln!(out, "  {from} -> {to}")?;
                }
            }
            Err(difference) => writeln!(out, "not isomorphic: {difference}")?,
        }
        let word = if self.mirror { "mirror images" } else { "not mirror images" };
        writeln!(out, "{word}")?;
        Ok(())
    }

    /// Each edge end of the one world and where it goes in the other.
    fn pairs(&self, bijection: &Bijection) -> Vec<[String; 2]> {
        let [a, b] = self.worlds;
        let images = a.graph.darts().zip(bijection.images());
        images.map(|(dart, &image): (Dart, _)| [a.start_text(dart), b.start_text(image)]).collect()
    }
}
