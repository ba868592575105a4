//! The drawing: the places of discs, doors and curves, before labels are added and it is written as SVG.

use toposlam_model::embedded_graph::{Dart, EmbeddedGraph};

use super::{
    Placement, WorldPicture,
    curves::Curve,
    doors::door_directions,
    geometry::{Extent, Point},
    layout::{self, Layout},
    routes::{self, Crossings},
    scale::scale,
    size::DrawingSize,
    ways::UnroutedEdge,
};

/// The places of everything.
#[derive(Clone, Debug)]
pub(super) struct Drawing {
    pub(super) size: DrawingSize,
    pub(super) centres: Vec<Point>,
    pub(super) doors: Vec<f64>,
    /// The darts and the curve of each edge, from its first dart.
    pub(super) edges: Vec<(Dart, Dart, Curve)>,
    /// The vertices at the ends of each edge.
    pub(super) ends: Vec<[usize; 2]>,
    /// The ink of each edge: 0, or one that no edge that it crosses has.
    pub(super) inks: Vec<usize>,
    /// For floor plans.
    pub(super) floor: Option<FloorScale>,
    /// The number of known vertices; the others stand for unknown ends of edges.
    pub(super) known: usize,
    /// A box that stays free, so that pictures of a series are equally large.
    pub(super) room: Extent,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct FloorScale {
    /// Units of the picture in a metre.
    pub(super) metre: f64,
    /// Units of the picture in the width of a hallway.
    pub(super) width: f64,
}

/// The number of inks for edges that cross others.
pub(super) const INKS: usize = 7;

impl Drawing {
    pub(super) fn new(picture: &WorldPicture) -> Self {
        Self::sized(picture, DrawingSize::new(picture.graph, picture.vertex_names))
    }

    /// The drawing with discs and names of these sizes.
    pub(super) fn sized(picture: &WorldPicture, size: DrawingSize) -> Self {
        let graph = picture.graph;
        let place = picture.placement.of_all(graph.vertex_count());
        let mut layout = match place.positions() {
            Some(positions) => layout::given(graph, positions),
            None => layout::lay_out(graph),
        };
        let unit = scale(graph, &layout.vertices, &size, place);
        for point in layout.vertices.iter_mut().chain(layout.bends.iter_mut().flatten()) {
            *point = *point * unit;
        }
        let doors = doors(graph, &layout, &size);
        let edge_routes: Vec<_> = graph
            .edges()
            .zip(&layout.bends)
            .map(|((dart, other), bends)| UnroutedEdge {
                vertices: [graph.vertex(dart).at(), graph.vertex(other).at()],
                directions: [doors[dart.at()], doors[other.at()]],
                bends: bends.clone(),
            })
            .collect();
        let crossings = if graph.genus() == 0 && place == Placement::Free {
            Crossings::Needless
        } else {
            Crossings::Needed
        };
        let curves = routes::routes(&edge_routes, &layout.vertices, &size, crossings);
        Self {
            inks: inks(&curves),
            ends: edge_routes.iter().map(|route| route.vertices).collect(),
            edges: graph
                .edges()
                .zip(curves)
                .map(|((dart, other), curve)| (dart, other, curve))
                .collect(),
            centres: layout.vertices,
            doors,
            floor: match place {
                Placement::FloorPlan { hallway_width, .. } => {
                    Some(FloorScale { metre: unit, width: unit * hallway_width })
                }
                Placement::Free | Placement::At(_) => None,
            },
            known: graph.vertex_count(),
            room: Extent::EMPTY,
            size,
        }
    }

    /// The floor of each hallway of a floor plan.
    pub(super) fn hallways(&self) -> impl Iterator<Item = Extent> + '_ {
        self.floor.into_iter().flat_map(move |floor| {
            self.ends.iter().map(move |ends| {
                let middle = Extent::from_points(ends.map(|vertex| self.centres[vertex]));
                middle.widened(floor.width / 2.0)
            })
        })
    }

    /// The box around the drawing without labels.
    pub(super) fn extent(&self) -> Extent {
        let discs = self.centres.iter().zip(&self.size.discs).map(|(&centre, disc)| {
            let radius = disc + self.size.knob + 1.0;
            Extent::around(centre, radius, radius)
        });
        let curves = self.edges.iter().map(|(_, _, curve)| curve.extent.widened(3.0));
        self.room.joined(discs.chain(self.hallways()).chain(curves))
    }
}

/// The direction of each dart's door: that of its edge, if the clockwise order allows.
fn doors(graph: &EmbeddedGraph, layout: &Layout, size: &DrawingSize) -> Vec<f64> {
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

/// Inks that distinguish curves that cross.
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
