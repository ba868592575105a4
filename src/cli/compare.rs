//! `toposlam compare A B`: the same world, mirror images, or what differs?

use std::{io::Write, path::PathBuf};

use serde_json::json;
use toposlam_model::{
    embedded_graph::Dart,
    format::named_world::NamedWorld,
    isomorphism::{Bijection, isomorphism, mirror_isomorphism},
};

use super::{Failure, Outcome, input};

/// Compare two worlds: isomorphic, mirror images, or the first difference
#[derive(clap::Args)]
#[command(after_help = "\
Example:
  toposlam compare worlds/figure-1a.toml worlds/figure-1b.toml

Isomorphic means: a bijection of edge ends keeps edges and clockwise orders. A mirror image has
every order reversed. Both can be so at once. The starts of the files do not matter here.")]
pub(super) struct Arguments {
    /// A world file
    a: PathBuf,
    /// Another world file
    b: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

impl Arguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, Failure> {
        let (a, b) = (input::read_world(&self.a)?, input::read_world(&self.b)?);
        let same = isomorphism(&a.graph, &b.graph);
        let mirror = mirror_isomorphism(&a.graph, &b.graph);
        if self.json {
            let pairs = same.as_ref().ok().map(|bijection| pairs(bijection, &a, &b));
            let line = json!({
                "schema": 1,
                "isomorphic": same.is_ok(),
                "mirror": mirror.is_some(),
                "bijection": pairs,
                "difference": same.as_ref().err().map(ToString::to_string),
            });
            writeln!(out, "{line}")?;
            return Ok(Outcome::Holds);
        }
        for (letter, world) in [("A", &a), ("B", &b)] {
            writeln!(
                out,
                "{letter} is {}: {} vertices, {} edges, {} faces, genus {}",
                world.name,
                world.graph.vertex_count(),
                world.graph.edge_count(),
                world.graph.face_count(),
                world.graph.genus(),
            )?;
        }
        match &same {
            Ok(bijection) => {
                writeln!(out, "isomorphic, by this bijection from A to B:")?;
                for [from, to] in pairs(bijection, &a, &b) {
                    writeln!(out, "  {from} -> {to}")?;
                }
            }
            Err(difference) => writeln!(out, "not isomorphic: {difference}")?,
        }
        let word = if mirror.is_some() { "mirror images" } else { "not mirror images" };
        writeln!(out, "{word}")?;
        Ok(Outcome::Holds)
    }
}

/// Each edge end of the one world and where it goes in the other.
fn pairs(bijection: &Bijection, a: &NamedWorld, b: &NamedWorld) -> Vec<[String; 2]> {
    let images = a.graph.darts().zip(bijection.images());
    images.map(|(dart, &image): (Dart, _)| [a.start_text(dart), b.start_text(image)]).collect()
}
