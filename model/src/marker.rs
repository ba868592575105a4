//! The kinds of fixed markers, and what they add to a percept. Sections 2.2 and 2.3.
//!
//! A marker is placed once, by the facing dart of a start. [Aids](crate::aid) that move have a state.

use std::fmt;

use thiserror::Error;

use crate::{
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    percept::{Door, MarkerSet, Sighting},
};

/// A kind of fixed marker.
///
/// Different facing darts may place it alike: an undirected marker lies at a vertex, and all darts of
/// the vertex place it there.
pub trait Marker: Sync {
    /// Its name on the command line.
    fn name(&self) -> &'static str;

    /// A sentence about what it is and when it is noticed.
    fn about(&self) -> &'static str;

    /// What it adds to the percept of a robot that came in by the dart `pose`. The facing dart placed
    /// it.
    fn sighting(&self, graph: &EmbeddedGraph, facing: Dart, pose: Dart) -> Sighting;

    /// The first of the facing darts that place it as this one does.
    fn first_alike(&self, graph: &EmbeddedGraph, facing: Dart) -> Dart;

    /// The poses in which the robot may begin, given the marker: all poses at which it is noticed as
    /// at the start, in the order of their numbers.
    fn starts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<Dart>;

    fn parts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<MarkerPart>;

    /// Whether what it adds depends on the vertices of the facing dart and of the pose, and on their
    /// indices there, and on nothing else. What is behind their doors may then be undecided.
    fn is_local(&self) -> bool {
        false
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MarkerPart {
    /// Lies at a vertex. Parts of different looks can be distinguished.
    At { vertex: Vertex, look: MarkerLook },
    /// Lies at the dart's vertex and points along the dart.
    Pointing(Dart),
    /// Lies in the middle of the dart's edge.
    OnEdge(Dart),
    /// Lies in the middle of the dart's edge and points away from the dart's vertex.
    OnEdgeAlong(Dart),
    /// The fixed end of a string, at a vertex.
    StringEnd(Vertex),
    /// Another robot, with its back to this dart.
    Robot { pose: Dart, shows_heading: bool },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MarkerLook {
    One,
    Other,
    Third,
    Fourth,
}

impl MarkerLook {
    pub const ALL: [Self; 4] = [Self::One, Self::Other, Self::Third, Self::Fourth];
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MarkerKind {
    /// No marker: the robot senses degrees and nothing else, and may have begun anywhere. Section 2.2.
    // paper: marker.none-insufficient, marker.none-cycles
    NoMarker,
    /// Lies at the start vertex and stays there. Section 2.2.
    // paper: marker.undirected-insufficient, marker.undirected-cycles
    Undirected,
    /// The marker of Algorithm 1: lies at the start vertex and points along the facing dart. Section 2.3.
    // paper: marker.directional-sufficient
    Directional,
    /// A mark in the middle of the edge faced at the start, which the robot notices exactly when it
    /// traverses that edge. At the start it counts as having just done so.
    UndirectedEdge,
    /// An arrow in the middle of the edge faced at the start, away from the start vertex. The robot
    /// notices it as [`UndirectedEdge`], and then in which sense it traversed the edge.
    DirectedEdge,
    /// Two undirected markers that look alike, at the ends of the edge faced at the start. With a loop
    /// faced, both lie at the start vertex.
    TwoIdentical,
    /// The same, but they look different: the first is the one at the start vertex.
    TwoDistinct,
}

pub use MarkerKind::{
    DirectedEdge, Directional, NoMarker, TwoDistinct, TwoIdentical, Undirected, UndirectedEdge,
};

pub const MARKERS: [MarkerKind; 7] =
    [NoMarker, Undirected, Directional, UndirectedEdge, DirectedEdge, TwoIdentical, TwoDistinct];

/// The ends of the edge of a dart: its own, and the other.
fn ends(graph: &EmbeddedGraph, dart: Dart) -> [Dart; 2] {
    [dart, graph.opposite(dart)]
}

impl MarkerKind {
    pub const fn name(self) -> &'static str {
        self.texts().0
    }

    pub const fn about(self) -> &'static str {
        self.texts().1
    }

    const fn texts(self) -> (&'static str, &'static str) {
        match self {
            NoMarker => {
                ("none", "no marker at all: the robot senses the number of doors and nothing else")
            }
            Undirected => ("undirected", "one undirected marker at the start vertex: is it here?"),
            Directional => (
                "directional",
                "one directional marker at the start vertex: is it here, and which door does it point \
                 along?",
            ),
            UndirectedEdge => (
                "undirected-edge",
                "a mark in the middle of the edge faced at the start: was it on the edge just traversed?",
            ),
            DirectedEdge => (
                "directed-edge",
                "an arrow in the middle of the edge faced at the start: was it on the edge just \
                 traversed, and which way did it point?",
            ),
            TwoIdentical => (
                "two-identical",
                "two undirected markers that look alike, at the start vertex and at the other end of \
                 the edge faced: how many are here?",
            ),
            TwoDistinct => (
                "two-distinct",
                "two undirected markers that look different, at the start vertex and at the other end \
                 of the edge faced: which of them are here?",
            ),
        }
    }
}

impl Marker for MarkerKind {
    fn name(&self) -> &'static str {
        self.texts().0
    }

    fn about(&self) -> &'static str {
        self.texts().1
    }

    fn sighting(&self, graph: &EmbeddedGraph, facing: Dart, pose: Dart) -> Sighting {
        let is_here = |dart| graph.vertex(dart) == graph.vertex(pose);
        match self {
            Undirected if is_here(facing) => Sighting::Lying(1),
            Directional => DirectionalMarker.sighting(graph, facing, pose),
            UndirectedEdge if ends(graph, facing).contains(&pose) => Sighting::Passed,
            DirectedEdge if pose == facing => Sighting::PassedAgainst,
            DirectedEdge if pose == graph.opposite(facing) => Sighting::PassedAlong,
            TwoIdentical | TwoDistinct => match (self, ends(graph, facing).map(is_here)) {
                (_, [false, false]) => Sighting::Nothing,
                (TwoDistinct, here) => {
                    let here = (0..).zip(here).filter(|(_, is_here)| *is_here).map(|(at, _)| at);
                    MarkerSet::from_numbers(here).map_or(Sighting::Nothing, Sighting::These)
                }
                (_, [one, other]) => Sighting::Lying(u32::from(one) + u32::from(other)),
            },
            _ => Sighting::Nothing,
        }
    }

    fn first_alike(&self, graph: &EmbeddedGraph, facing: Dart) -> Dart {
        // The first dart of the vertex with the same vertex at its other end.
        let first_parallel = |dart| {
            let far = |dart| graph.vertex(graph.opposite(dart));
            let parallel = |other: &Dart| far(*other) == far(dart);
            graph.darts_of(graph.vertex(dart)).find(parallel).unwrap_or(dart)
        };
        match self {
            NoMarker => Dart(0),
            Undirected => graph.first_dart(graph.vertex(facing)),
            Directional | DirectedEdge => facing,
            UndirectedEdge => facing.min(graph.opposite(facing)),
            TwoDistinct => first_parallel(facing),
            TwoIdentical => first_parallel(facing).min(first_parallel(graph.opposite(facing))),
        }
    }

    fn starts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<Dart> {
        let mut ends = ends(graph, facing);
        ends.sort_unstable();
        match self {
            NoMarker => graph.darts().collect(),
            Undirected | TwoDistinct => graph.darts_of(graph.vertex(facing)).collect(),
            Directional => vec![facing],
            UndirectedEdge | DirectedEdge => ends.to_vec(),
            TwoIdentical => {
                let mut vertices = ends.map(|end| graph.vertex(end)).to_vec();
                vertices.dedup();
                vertices.into_iter().flat_map(|vertex| graph.darts_of(vertex)).collect()
            }
        }
    }

    fn parts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<MarkerPart> {
        let [here, there] = ends(graph, facing).map(|end| graph.vertex(end));
        let at = |vertex, look| MarkerPart::At { vertex, look };
        match self {
            NoMarker => vec![],
            Undirected => vec![at(here, MarkerLook::One)],
            Directional => vec![MarkerPart::Pointing(facing)],
            UndirectedEdge => vec![MarkerPart::OnEdge(facing)],
            DirectedEdge => vec![MarkerPart::OnEdgeAlong(facing)],
            TwoIdentical => vec![at(here, MarkerLook::One), at(there, MarkerLook::One)],
            TwoDistinct => vec![at(here, MarkerLook::One), at(there, MarkerLook::Other)],
        }
    }

    fn is_local(&self) -> bool {
        matches!(self, NoMarker | Undirected | Directional)
    }
}

/// [`Directional`] as a type of its own, so that a check does not look up the kind of the marker in each of billions of
/// moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DirectionalMarker;

impl Marker for DirectionalMarker {
    fn name(&self) -> &'static str {
        Directional.name()
    }

    fn about(&self) -> &'static str {
        Directional.about()
    }

    #[inline]
    fn sighting(&self, graph: &EmbeddedGraph, facing: Dart, pose: Dart) -> Sighting {
        if graph.vertex(facing) != graph.vertex(pose) {
            return Sighting::Nothing;
        }
        let (from, to) = (graph.index(pose), graph.index(facing));
        Sighting::Pointing(Door::between(from, to, graph.degree_around(pose)))
    }

    fn first_alike(&self, graph: &EmbeddedGraph, facing: Dart) -> Dart {
        Directional.first_alike(graph, facing)
    }

    fn starts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<Dart> {
        Directional.starts(graph, facing)
    }

    fn parts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<MarkerPart> {
        Directional.parts(graph, facing)
    }

    fn is_local(&self) -> bool {
        Directional.is_local()
    }
}

impl<M: Marker + ?Sized> Marker for &M {
    fn name(&self) -> &'static str {
        (**self).name()
    }

    fn about(&self) -> &'static str {
        (**self).about()
    }

    fn sighting(&self, graph: &EmbeddedGraph, facing: Dart, pose: Dart) -> Sighting {
        (**self).sighting(graph, facing, pose)
    }

    fn first_alike(&self, graph: &EmbeddedGraph, facing: Dart) -> Dart {
        (**self).first_alike(graph, facing)
    }

    fn starts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<Dart> {
        (**self).starts(graph, facing)
    }

    fn parts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<MarkerPart> {
        (**self).parts(graph, facing)
    }

    fn is_local(&self) -> bool {
        (**self).is_local()
    }
}

impl fmt::Debug for dyn Marker + '_ {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        out.write_str(self.name())
    }
}

impl PartialEq for dyn Marker + '_ {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

impl Eq for dyn Marker + '_ {}

#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("`{0}` is not a marker; the markers are {names}", names = MARKERS.map(MarkerKind::name).join(", "))]
pub struct UnknownMarker(String);

/// The kind of marker with this name.
///
/// # Errors
/// Returns an error if there is none. The message lists the names of all markers.
pub fn named(name: &str) -> Result<MarkerKind, UnknownMarker> {
    let marker = MARKERS.into_iter().find(|marker| marker.name() == name);
    marker.ok_or_else(|| UnknownMarker(name.to_owned()))
}
