//! Pictures of worlds, as SVG and PNG.
//!
//! A vertex is a disc; its doors are knobs on the border of the disc, in their clockwise order; an
//! edge is a curve that leaves straight through its two doors. So the order can be read off the
//! picture, even where edges have to cross. From the ground up: `geometry`, `text`,
//! `doors` and `size`; then the `layout` of the vertices, `curves` and their `routes`,
//! `labels`; the `drawing` puts them together, and `svg` and `png` write
//! it.

#![expect(
    clippy::cast_precision_loss,
    reason = "numbers of vertices and places along a curve are far below 2^52"
)]

mod curves;
mod doors;
mod drawing;
mod geometry;
mod labels;
mod layout;
mod png;
mod routes;
mod size;
mod svg;
mod text;

#[cfg(test)]
mod gallery;

use crate::model::{
    embedded_graph::{Dart, EmbeddedGraph},
    format::named_world::NamedWorld,
};

pub use png::{PictureError, png};

/// What to draw.
#[derive(Clone, Copy, Debug)]
pub struct Picture<'a> {
    /// The world.
    pub graph: &'a EmbeddedGraph,
    /// The name of each vertex.
    pub vertex_names: &'a [String],
    /// The name of each dart's edge, where edges have names.
    pub edge_names: Option<&'a [String]>,
    /// The facing dart; the marker lies at its vertex and points along it.
    pub start: Option<Dart>,
    /// Where each vertex is, for a floor plan: metres, x to the east, y to the north.
    pub positions: Option<&'a [[f64; 2]]>,
    /// Stands above the picture; may be empty.
    pub title: &'a str,
    /// Stands below the picture, the cost of exploring it for example; may be empty.
    pub caption: &'a str,
}

impl<'a> From<&'a NamedWorld> for Picture<'a> {
    /// The picture of a world with its own names, its start, and its name as the title.
    fn from(world: &'a NamedWorld) -> Self {
        Self {
            graph: &world.graph,
            vertex_names: &world.vertex_names,
            edge_names: world.edge_names.as_deref(),
            start: world.start,
            positions: world.positions.as_deref(),
            title: &world.name,
            caption: &world.about,
        }
    }
}

/// The picture as an SVG document. The same picture gives the same bytes.
#[must_use]
pub fn svg(picture: &Picture) -> String {
    svg::document(picture, &drawing::Drawing::of(picture))
}
