//! A kind of marker of your own: a beacon that is received at its vertex and at the neighbouring vertices.
//! It distinguishes no more worlds than an undirected marker, because a robot can go and look. Run it
//! with `cargo run --release -p toposlam-model --example own_marker`.

use std::error::Error;

use toposlam_model::{
    ambiguity::AmbiguitySearch,
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Class,
    marker::{Marker, MarkerLook, MarkerPart, named},
    percept::Sighting,
};

/// A beacon at the start vertex: loud there, faint at its neighbours.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Beacon;

impl Marker for Beacon {
    fn name(&self) -> &'static str {
        "beacon"
    }

    fn about(&self) -> &'static str {
        "one undirected marker at the start vertex: is it here, next door or farther away?"
    }

    fn sighting(&self, graph: &EmbeddedGraph, facing: Dart, pose: Dart) -> Sighting {
        let (beacon, robot) = (graph.vertex(facing), graph.vertex(pose));
        let is_next = |dart| graph.vertex(graph.opposite(dart)) == beacon;
        if robot == beacon {
            Sighting::Lying(2)
        } else if graph.darts_of(robot).any(is_next) {
            Sighting::Lying(1)
        } else {
            Sighting::Nothing
        }
    }

    /// All darts of a vertex place the beacon alike.
    fn first_alike(&self, graph: &EmbeddedGraph, facing: Dart) -> Dart {
        graph.darts_of(graph.vertex(facing)).next().unwrap_or(facing)
    }

    fn starts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<Dart> {
        graph.darts_of(graph.vertex(facing)).collect()
    }

    fn parts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<MarkerPart> {
        vec![MarkerPart::At { vertex: graph.vertex(facing), look: MarkerLook::One }]
    }
}

#[allow(dead_code, reason = "a test has the marker without the program")]
fn main() -> Result<(), Box<dyn Error>> {
    let undirected = named("undirected")?;
    for marker in [&undirected as &dyn Marker, &Beacon] {
        let findings = AmbiguitySearch::new(Class::Simple, 7, marker)?.run(&())?;
        for size in &findings.sizes {
            println!(
                "{}, {} edges: {} of {} placed worlds are ambiguous",
                marker.name(),
                size.edges,
                size.ambiguous,
                size.placed_worlds,
            );
        }
    }
    Ok(())
}
