//! How large things are drawn, in picture units (pixels of an SVG at its natural size).

use std::f64::consts::TAU;

use crate::model::embedded_graph::EmbeddedGraph;

use super::{layout, text};

/// The sizes that fit one graph and its names.
#[derive(Clone, Debug)]
pub(super) struct Size {
    /// The radius of a usual disc; other lengths are measured by it.
    pub(super) base: f64,
    /// The radius of each vertex's disc: larger where many doors need room.
    pub(super) discs: Vec<f64>,
    /// The radius of a door's knob; 0 where the graph is too large for knobs.
    pub(super) knob: f64,
    /// The font size of names in discs.
    pub(super) name: f64,
}

/// Radii between which a usual disc may be.
const DISC: [f64; 2] = [23.0, 34.0];
/// Font sizes between which names may be.
const NAME: [f64; 2] = [9.5, 15.0];

impl Size {
    pub(super) fn of(graph: &EmbeddedGraph, names: &[String]) -> Self {
        if graph.vertex_count() > layout::POLISHED || graph.edge_count() > 2 * layout::POLISHED {
            return Self::plain(graph);
        }
        let knob = 6.0;
        let longest = names.iter().map(|name| text::width(name, 1.0)).fold(0.5, f64::max);
        // A name has to fit between the knobs to its left and right.
        let room = |base: f64| 2.0 * (base - knob - 3.0);
        let wish = (longest * 12.0 / 2.0 + knob + 3.0).clamp(DISC[0], DISC[1]);
        let name = (room(wish) / longest).clamp(NAME[0], NAME[1]);
        let discs = graph
            .vertices()
            .map(|vertex| wish.max(f64::from(graph.degree(vertex)) * 2.35 * knob / TAU))
            .collect();
        Self { base: wish, discs, knob, name }
    }

    fn plain(graph: &EmbeddedGraph) -> Self {
        let discs = graph
            .vertices()
            .map(|vertex| 9.0_f64.max(f64::from(graph.degree(vertex)) * 3.0 / TAU))
            .collect();
        Self { base: 9.0, discs, knob: 0.0, name: 6.5 }
    }

    /// Whether the name fits into the vertex's disc.
    pub(super) fn holds(&self, vertex: usize, name: &str) -> bool {
        let rim = if self.knob > 0.0 { self.knob } else { 1.0 };
        text::width(name, self.name) <= 2.0 * (self.discs[vertex] - rim)
    }

    /// The least angle between two doors of the vertex.
    pub(super) fn doors_apart(&self, vertex: usize) -> f64 {
        let chord = (self.knob * 2.0 - 0.8).max(2.5);
        2.0 * (chord / 2.0 / self.discs[vertex]).min(1.0).asin()
    }
}
