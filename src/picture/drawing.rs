//! The drawing: where discs, doors, curves and labels are, before it is written as SVG.

use crate::model::embedded_graph::{Dart, EmbeddedGraph};

use super::{
    Picture,
    curves::Curve,
    doors::door_directions,
    geometry::{Extent, Point},
    labels::{self, Label},
    layout::{self, Layout},
    routes::{self, Crossings, Errand},
    size::Size,
};

/// Everything at its place.
#[derive(Clone, Debug)]
pub(super) struct Drawing {
    pub(super) size: Size,
    /// The centre of each vertex's disc.
    pub(super) centres: Vec<Point>,
    /// The direction of each dart's door.
    pub(super) doors: Vec<f64>,
    /// The darts and the curve of each edge, from its first dart.
    pub(super) edges: Vec<(Dart, Dart, Curve)>,
    /// The ink of each edge: 0, or one that no edge that it crosses has.
    pub(super) inks: Vec<usize>,
    pub(super) labels: Vec<Label>,
    /// Units of the picture in a metre, for floor plans.
    pub(super) metre: Option<f64>,
}

/// The inks there are for edges that cross others.
pub(super) const INKS: usize = 7;

/// The longest hallway that is drawn, in discs: a larger plan is drawn smaller.
const LONGEST: f64 = 40.0;

impl Drawing {
    pub(super) fn of(picture: &Picture) -> Self {
        let graph = picture.graph;
        let size = Size::of(graph, picture.vertex_names);
        let positions =
            picture.positions.filter(|positions| positions.len() == graph.vertex_count());
        let mut layout = match positions {
            Some(positions) => layout::floor_plan(graph, positions),
            None => layout::lay_out(graph),
        };
        let unit = scale(graph, &layout, &size, positions.is_some());
        for point in layout.vertices.iter_mut().chain(layout.bends.iter_mut().flatten()) {
            *point = *point * unit;
        }
        let doors = doors(graph, &layout, &size);
        let errands: Vec<_> = graph
            .edges()
            .zip(&layout.bends)
            .map(|((dart, other), bends)| Errand {
                vertices: [graph.vertex(dart).at(), graph.vertex(other).at()],
                directions: [doors[dart.at()], doors[other.at()]],
                bends: bends.clone(),
            })
            .collect();
        let crossings = if graph.genus() == 0 && positions.is_none() {
            Crossings::Needless
        } else {
            Crossings::Needed
        };
        let curves = routes::routes(&errands, &layout.vertices, &size, crossings);
        let mut drawing = Self {
            inks: inks(&curves),
            edges: graph
                .edges()
                .zip(curves)
                .map(|((dart, other), curve)| (dart, other, curve))
                .collect(),
            centres: layout.vertices,
            doors,
            labels: Vec::new(),
            metre: positions.map(|_| unit),
            size,
        };
        drawing.labels = labels::labels(&drawing, picture);
        drawing
    }

    /// The box around all that is drawn.
    pub(super) fn extent(&self) -> Extent {
        let mut extent = Extent::EMPTY;
        for (centre, disc) in self.centres.iter().zip(&self.size.discs) {
            let radius = disc + self.size.knob + 1.0;
            extent.join(Extent::around(*centre, radius, radius));
        }
        for (_, _, curve) in &self.edges {
            let half = curve.extent.size() * 0.5 + Point::new(3.0, 3.0);
            extent.join(Extent::around(curve.extent.centre(), half.x, half.y));
        }
        for label in &self.labels {
            extent.join(label.extent());
        }
        extent
    }
}

/// Units of the picture in a unit of the layout.
fn scale(graph: &EmbeddedGraph, layout: &Layout, size: &Size, plan: bool) -> f64 {
    let mut largest = 0.0_f64;
    let mut tightest = 1.0_f64;
    // Curves that cross want more room than straight ones.
    let usual = size.base * if !plan && graph.genus() > 0 { 6.4 } else { 5.4 };
    for (dart, other) in graph.edges() {
        let (u, v) = (graph.vertex(dart).at(), graph.vertex(other).at());
        if u != v {
            let length = layout.vertices[u].distance(layout.vertices[v]).max(1e-6);
            let discs = size.discs[u] + size.discs[v];
            tightest = tightest.max((discs + 2.0 * size.base) / (length * usual));
            largest = largest.max(length);
        }
    }
    if plan {
        // All hallways to one scale: the shortest decides, as long as the longest stays in sight.
        let shortest = tightest * usual;
        let lengths = graph.edges().map(|(dart, other)| {
            let ends = [dart, other].map(|end| layout.vertices[graph.vertex(end).at()]);
            ends[0].distance(ends[1])
        });
        let least = lengths.fold(f64::INFINITY, f64::min).max(1e-6);
        let wish = (usual / least).max(shortest.min(usual / least));
        return wish.min(LONGEST * size.base / largest.max(1e-6));
    }
    if layout.vertices.len() <= layout::POLISHED {
        for (at, one) in layout.vertices.iter().enumerate() {
            for other in &layout.vertices[..at] {
                let distance = one.distance(*other).max(1e-6);
                tightest = tightest.max(3.4 * size.base / (distance * usual));
            }
        }
    }
    usual * tightest.min(2.5)
}

/// The direction of each dart's door: as its edge would leave, where the clockwise order allows.
fn doors(graph: &EmbeddedGraph, layout: &Layout, size: &Size) -> Vec<f64> {
    let mut towards = vec![None; graph.dart_count()];
    for ((dart, other), bends) in graph.edges().zip(&layout.bends) {
        let ends = [dart, other].map(|end| graph.vertex(end).at());
        let [from, to] = ends.map(|vertex| layout.vertices[vertex]);
        if ends[0] != ends[1] || !bends.is_empty() {
            let first = bends.first().copied().unwrap_or(to);
            let last = bends.last().copied().unwrap_or(from);
            towards[dart.at()] = Some((first - from).angle());
            towards[other.at()] = Some((last - to).angle());
        }
    }
    graph
        .vertices()
        .flat_map(|vertex| {
            let wanted: Vec<_> = graph.darts_of(vertex).map(|dart| towards[dart.at()]).collect();
            door_directions(&wanted, size.doors_apart(vertex.at()))
        })
        .collect()
}

/// Inks by which curves that cross can be told apart.
fn inks(curves: &[Curve]) -> Vec<usize> {
    let mut inks = vec![0; curves.len()];
    if curves.len() > 2 * layout::POLISHED {
        return inks;
    }
    for edge in 0..curves.len() {
        let crossed: Vec<_> = (0..curves.len())
            .filter(|&other| {
                other != edge && !routes::crossings(&curves[edge], &curves[other]).is_empty()
            })
            .collect();
        if !crossed.is_empty() {
            let free = (1..=INKS)
                .find(|ink| crossed.iter().all(|&other| other > edge || inks[other] != *ink));
            inks[edge] = free.unwrap_or(1 + edge % INKS);
        }
    }
    inks
}
