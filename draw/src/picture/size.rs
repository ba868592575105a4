//! The sizes of everything, in picture units (pixels of an SVG at its natural size), and the places of
//! the names of the vertices: all inside their discs, or all beside them.

use std::f64::consts::TAU;

use toposlam_model::embedded_graph::EmbeddedGraph;

use super::{layout, text};

/// The place of the names of the vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Names {
    /// In their discs, each in one line.
    Inside,
    /// In their discs, each in two lines if it can be broken.
    Broken,
    /// Next to their discs.
    Beside,
    /// No names: there is no room.
    Nowhere,
}

#[derive(Clone, Debug)]
pub(super) struct DrawingSize {
    /// The radius of a usual disc; other lengths are measured by it.
    pub(super) base: f64,
    /// The radius of each vertex's disc: larger if many doors need room.
    pub(super) discs: Vec<f64>,
    /// The radius of a door's knob; 0 if the graph is too large for knobs.
    pub(super) knob: f64,
    /// The font size of the names of vertices.
    pub(super) name: f64,
    pub(super) names: Names,
}

/// The least and the greatest radius of a usual disc.
const DISC: [f64; 2] = [25.0, 44.0];
/// The greatest radius of a disc for names in one line; longer names are broken.
const ONE_LINE: f64 = 35.0;
/// The radius of a disc without a name in it.
const EMPTY: f64 = 19.0;
/// Font sizes of a name in its disc: the largest, the usual one, and the smallest.
const NAME: [f64; 3] = [15.0, 12.0, 9.5];
/// The font size of names beside discs.
const BESIDE: f64 = 12.0;
/// The radius of a knob.
const KNOB: f64 = 6.5;
/// The room between a name and the knobs to its left and right.
const CLEAR: f64 = 2.0;

impl DrawingSize {
    pub(super) fn new(graph: &EmbeddedGraph, names: &[String]) -> Self {
        if graph.vertex_count() > layout::POLISHED || graph.edge_count() > 2 * layout::POLISHED {
            return Self::plain(graph, names);
        }
        let widest = |lines: &dyn Fn(&str) -> Vec<String>| {
            let lines = names.iter().flat_map(|name| lines(name));
            lines.map(|line| text::width(&line, 1.0)).fold(0.5, f64::max)
        };
        let whole = widest(&|name: &str| vec![name.to_owned()]);
        let broken = widest(&text::in_two);
        let radius = |width: f64| width * NAME[1] / 2.0 + KNOB + CLEAR;
        let (base, name, names) = if radius(whole) <= ONE_LINE {
            let base = radius(whole).max(DISC[0]);
            (base, room(base) / whole, Names::Inside)
        } else {
            let base = radius(broken).clamp(DISC[0], DISC[1]);
            (base, room(base) / broken, Names::Broken)
        };
        let (base, name, names) = if name < NAME[2] {
            (EMPTY, BESIDE, Names::Beside)
        } else {
            (base, name.min(NAME[0]), names)
        };
        let discs = graph
            .vertices()
            .map(|vertex| base.max(f64::from(graph.degree(vertex)) * 2.35 * KNOB / TAU))
            .collect();
        Self { base, discs, knob: KNOB, name, names }
    }

    /// The sizes of a graph that is too large for knobs: small discs, and names only where all fit.
    fn plain(graph: &EmbeddedGraph, names: &[String]) -> Self {
        const RADIUS: f64 = 9.0;
        const NAME: [f64; 2] = [6.5, 4.5];
        let widest = names.iter().map(|name| text::width(name, 1.0)).fold(0.5, f64::max);
        let name = (2.0 * (RADIUS - 1.0) / widest).min(NAME[0]);
        let discs = graph
            .vertices()
            .map(|vertex| RADIUS.max(f64::from(graph.degree(vertex)) * 3.0 / TAU))
            .collect();
        let names = if name < NAME[1] { Names::Nowhere } else { Names::Inside };
        Self { base: RADIUS, discs, knob: 0.0, name, names }
    }

    /// The name in the lines in which it is drawn.
    pub(super) fn lines(&self, name: &str) -> Vec<String> {
        match self.names {
            Names::Broken => text::in_two(name),
            _ => vec![name.to_owned()],
        }
    }

    /// The least angle between two doors of the vertex.
    pub(super) fn doors_apart(&self, vertex: usize) -> f64 {
        let chord = (self.knob * 2.0 - 0.8).max(2.5);
        2.0 * (chord / 2.0 / self.discs[vertex]).min(1.0).asin()
    }
}

/// The room for a name between the knobs to its left and right.
fn room(disc: f64) -> f64 {
    2.0 * (disc - KNOB - CLEAR)
}

#[cfg(test)]
mod tests {
    use super::{super::gallery::worlds::simple, *};

    /// The sizes of a chain of vertices with these names.
    fn size(names: [&str; 3]) -> DrawingSize {
        let [a, b, c] = names;
        let world = simple("chain", &format!("{a}: {b}, {b}: {a} {c}, {c}: {b}"));
        DrawingSize::new(&world.graph, &world.vertex_names)
    }

    #[test]
    fn all_names_stand_inside_or_all_beside() {
        let short = size(["a", "v-1", "corner"]);
        assert_eq!((short.names, short.lines("v-1").len()), (Names::Inside, 1));
        let long = size(["a", "offices-west", "lift"]);
        assert_eq!(long.names, Names::Broken);
        assert_eq!(long.lines("offices-west"), ["offices-", "west"]);
        assert_eq!(long.lines("lift"), ["lift"]);
        assert_eq!(size(["a", "b", "aNameWithoutAnyBreak"]).names, Names::Beside);
    }
}
