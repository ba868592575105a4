//! The kinds of markers: what they add to a percept, and whether a robot can move them. Sections 2.2
//! and 2.3.
//!
//! A marker is placed once, by the facing dart of a start. A kind of marker is one file here, and
//! one line in the list of [`MARKERS`].

use std::fmt;

use thiserror::Error;

use crate::{
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    percept::Sighting,
};

/// Makes a module and a type public for each kind of marker, and the list of all of them.
macro_rules! markers {
    ($($file:ident::$kind:ident,)*) => {
        $(
            mod $file;
            pub use $file::$kind;
        )*

        /// Every kind of marker.
        pub const MARKERS: [&dyn Marker; [$(stringify!($kind)),*].len()] = [$(&$kind),*];
    };
}

markers! {
    none::NoMarker,
    undirected::Undirected,
    directional::Directional,
    undirected_edge::UndirectedEdge,
    directed_edge::DirectedEdge,
    two_identical::TwoIdentical,
    two_distinct::TwoDistinct,
    movable::Movable,
}

/// A kind of marker.
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

    /// The parts of the marker, and where they lie.
    fn parts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<MarkerPart>;

    /// Whether the robot can pick it up where it notices it, carry it and drop it. A dropped marker is
    /// placed as if the robot's entry dart were the facing dart.
    fn is_movable(&self) -> bool {
        false
    }

    /// Whether what it adds depends on the vertices of the facing dart and of the pose, and on their
    /// indices there, and on nothing else. What is behind their doors may then be undecided.
    fn is_local(&self) -> bool {
        false
    }
}

/// A part of a marker, and where it lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MarkerPart {
    /// Lies at a vertex. Parts of different looks can be distinguished.
    At {
        /// The vertex.
        vertex: Vertex,
        /// The look.
        look: MarkerLook,
    },
    /// Lies at the dart's vertex and points along the dart.
    Pointing(Dart),
    /// Lies in the middle of the dart's edge.
    OnEdge(Dart),
    /// Lies in the middle of the dart's edge and points away from the dart's vertex.
    OnEdgeAlong(Dart),
}

/// How a part of a marker looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MarkerLook {
    /// The usual one.
    One,
    /// A different one.
    Other,
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

    fn is_movable(&self) -> bool {
        (**self).is_movable()
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

/// The error for a name that no marker has.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("`{0}` is not a marker; the markers are {names}", names = names())]
pub struct UnknownMarker(String);

fn names() -> String {
    MARKERS.map(Marker::name).join(", ")
}

/// The kind of marker with this name.
///
/// # Errors
/// Returns an error if there is none. The message lists the names of all markers.
pub fn named(name: &str) -> Result<&'static dyn Marker, UnknownMarker> {
    let marker = MARKERS.into_iter().find(|marker| marker.name() == name);
    marker.ok_or_else(|| UnknownMarker(name.to_owned()))
}
