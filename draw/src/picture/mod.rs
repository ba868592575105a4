//! Pictures of worlds, as SVG and PNG.
//!
//! A vertex is a disc; its doors are knobs on the border of the disc, in their clockwise order; an
//! edge is a curve that leaves straight through its two doors. So the order can be read off the
//! picture, even if edges have to cross. Bottom up: `geometry`, `text`, `doors` and `size`; the `layout` of
//! the vertices and its `scale`; the `curves`, the `ways` that an edge may take and the chosen `routes`;
//! `labels`; the `drawing` combines them, `signs` adds the marker, and `svg` and `png` write it. `growth`
//! draws a map while it is built, which is an `open_graph`, `run` a robot's way through a floor plan, `laser_run` one
//! in a building that it has scanned, `stage` the legend of a picture of
//! sensing.

#![expect(
    clippy::cast_precision_loss,
    reason = "numbers of vertices and places along a curve are far below 2^52"
)]

mod curves;
mod doors;
mod drawing;
mod geometry;
mod growth;
mod labels;
mod laser_run;
mod layout;
mod open_graph;
#[cfg(feature = "png")]
mod outlines;
#[cfg(feature = "png")]
mod png;
mod routes;
mod run;
mod scale;
mod side_by_side;
mod signs;
mod size;
#[cfg(feature = "png")]
mod stage;
mod svg;
mod text;
mod ways;

#[cfg(test)]
mod gallery;
#[cfg(test)]
mod reading;

use toposlam_model::{
    aid::{Aid, AidKind},
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    format::named_world::NamedWorld,
    marker::{Directional, MarkerLook, MarkerPart},
};

pub(crate) use geometry::Point;
pub use growth::open_svg;
pub(crate) use growth::{growth, open_layout};
pub use laser_run::{DrawnVisit, LaserRunPicture, ScanHits, laser_run_svg};
pub use open_graph::OpenGraph;
#[cfg(feature = "png")]
pub use png::{PictureError, png};
#[cfg(test)]
pub(crate) use run::example;
pub use run::run_svg;
pub(crate) use run::{BODY, Drawn, run_drawing};
pub use side_by_side::side_by_side;
#[cfg(feature = "png")]
pub use stage::with_legend;
pub(crate) use text::escaped;

/// A picture of a world, to be drawn.
#[derive(Clone, Copy, Debug)]
pub struct WorldPicture<'a> {
    pub graph: &'a EmbeddedGraph,
    pub vertex_names: &'a [String],
    /// The name of each dart's edge, if edges have names.
    pub edge_names: Option<&'a [String]>,
    /// The facing dart, by which the marker is placed; without one, no marker is drawn.
    pub start: Option<Dart>,
    pub marker: AidKind,
    pub placement: Placement<'a>,
    /// The text above the picture; may be empty.
    pub title: &'a str,
    /// The text below the picture, for example the cost of the exploration; may be empty.
    pub caption: &'a str,
}

impl WorldPicture<'_> {
    fn parts(&self) -> Vec<MarkerPart> {
        self.start.map_or_else(Vec::new, |facing| self.marker.parts(self.graph, facing))
    }

    /// The place of the marker, in words; `None` if there is no marker.
    pub(crate) fn marker_place(&self) -> Option<String> {
        let graph = self.graph;
        let name = |vertex: Vertex| {
            let known = self.vertex_names.get(vertex.at());
            known.cloned().unwrap_or_else(|| vertex.at().to_string())
        };
        let edge = |dart: Dart| {
            let [from, to] = [dart, graph.opposite(dart)].map(|end| name(graph.vertex(end)));
            let known = self.edge_names.and_then(|names| names.get(dart.at()));
            known.map_or(format!("the edge from {from} to {to}"), |edge| format!("edge {edge}"))
        };
        Some(match self.parts().as_slice() {
            [] => return None,
            [MarkerPart::Pointing(dart)] => format!(
                "the marker lies at {} and points along door {}",
                name(graph.vertex(*dart)),
                graph.index(*dart)
            ),
            [MarkerPart::OnEdge(dart)] => format!("{} is marked", edge(*dart)),
            [MarkerPart::OnEdgeAlong(dart)] => format!("{} is marked with an arrow", edge(*dart)),
            [MarkerPart::At { vertex, .. }] => format!("the marker lies at {}", name(*vertex)),
            [MarkerPart::StringEnd(vertex)] => format!("the string is fixed at {}", name(*vertex)),
            [MarkerPart::Robot { pose, .. }, ..] => {
                format!("the whole team stands at {}", name(graph.vertex(*pose)))
            }
            [MarkerPart::At { vertex: one, .. }, others @ ..]
                if others.iter().all(
                    |other| matches!(other, MarkerPart::At { vertex, .. } if vertex == one),
                ) =>
            {
                let all = if others.len() == 1 { "both" } else { "all" };
                format!("{all} markers lie at {}", name(*one))
            }
            parts => {
                let at = |part: &MarkerPart| match part {
                    MarkerPart::At { vertex, look: MarkerLook::Other } => {
                        format!("{} (dashed)", name(*vertex))
                    }
                    MarkerPart::At { vertex, .. } | MarkerPart::StringEnd(vertex) => name(*vertex),
                    MarkerPart::Pointing(dart)
                    | MarkerPart::OnEdge(dart)
                    | MarkerPart::OnEdgeAlong(dart)
                    | MarkerPart::Robot { pose: dart, .. } => name(graph.vertex(*dart)),
                };
                let places: Vec<_> = parts.iter().map(at).collect();
                format!("markers lie at {}", places.join(" and "))
            }
        })
    }
}

/// The positions of the vertices of a picture.
///
/// If a position is not finite, or is missing, the placement counts as [`Placement::Free`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Placement<'a> {
    /// The program chooses the positions.
    #[default]
    Free,
    /// The given positions, in any unit; x to the right, y up.
    At(&'a [[f64; 2]]),
    /// A floor plan: the picture shows the hallways at their width, and a scale.
    FloorPlan {
        /// Metres, x to the east, y to the north.
        positions: &'a [[f64; 2]],
        /// Metres.
        hallway_width: f64,
    },
}

impl<'a> Placement<'a> {
    /// The positions, if they are given.
    pub fn positions(self) -> Option<&'a [[f64; 2]]> {
        match self {
            Self::Free => None,
            Self::At(positions) | Self::FloorPlan { positions, .. } => Some(positions),
        }
    }

    /// The same placement if it has a finite position for each of `count` vertices, otherwise `Free`.
    fn of_all(self, count: usize) -> Self {
        let complete = self.positions().is_some_and(|positions| {
            positions.len() == count && positions.iter().flatten().all(|at| at.is_finite())
        });
        if complete { self } else { Self::Free }
    }
}

impl<'a> From<&'a NamedWorld> for Placement<'a> {
    fn from(world: &'a NamedWorld) -> Self {
        match (&world.positions, &world.plan) {
            (None, _) => Self::Free,
            (Some(positions), None) => Self::At(positions),
            (Some(positions), Some(plan)) => {
                Self::FloorPlan { positions, hallway_width: plan.hallway_width() }
            }
        }
    }
}

impl<'a> From<&'a NamedWorld> for WorldPicture<'a> {
    /// The picture of a world with its own names, its marker at its start, by default a directional one,
    /// and its name as the title.
    fn from(world: &'a NamedWorld) -> Self {
        Self {
            graph: &world.graph,
            vertex_names: &world.vertex_names,
            edge_names: world.edge_names.as_deref(),
            start: world.start,
            marker: world.marker.unwrap_or(Directional.into()),
            placement: Placement::from(world),
            title: &world.name,
            caption: &world.about,
        }
    }
}

/// The picture as an SVG document. The same picture gives the same bytes.
pub fn svg(picture: &WorldPicture) -> String {
    svg::document(picture, &drawing::Drawing::new(picture), svg::Legend::Below)
}
