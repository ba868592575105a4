//! The map as it grows. Section 2.3, Algorithm 1.
//!
//! Every stage has the layout of the last one, so that the map grows in its place.
//! An unexplored or open dart is the beginning of an edge that ends in a small dashed circle.

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    marker::Directional,
};

use super::{
    OpenGraph, Placement, WorldPicture,
    curves::Curve,
    drawing::Drawing,
    geometry::{Extent, Point},
    size::DrawingSize,
    svg,
};

/// The radius of the circle in which an unexplored edge ends.
const OPEN: f64 = 5.0;
/// The greatest length that is drawn of an unexplored edge: in usual discs, and as a share of the edge.
const STUB: [f64; 2] = [1.3, 0.36];

/// A picture of each of these maps, which are stages of one map; none of an empty map.
pub(crate) fn growth(maps: &[OpenGraph]) -> Vec<String> {
    let last = maps.last().and_then(Whole::new);
    let stages: Vec<_> = maps.iter().map(|map| stage(map, last.as_ref())).collect();
    let drawings = stages.iter().flatten().map(|(_, drawing)| drawing.extent());
    let room = Extent::EMPTY.joined(drawings);
    let svg = |(stage, map): (Option<(EmbeddedGraph, Drawing)>, &OpenGraph)| {
        let (graph, drawing) = stage?;
        Some(document(map, &graph, &Drawing { room, ..drawing }))
    };
    stages.into_iter().zip(maps).map(|stage| svg(stage).unwrap_or_default()).collect()
}

/// A picture of a graph with its open darts; `None` of an empty one.
pub fn open_svg(map: &OpenGraph) -> Option<String> {
    let (graph, drawing) = stage(map, None)?;
    Some(document(map, &graph, &drawing))
}

fn document(map: &OpenGraph, graph: &EmbeddedGraph, drawing: &Drawing) -> String {
    let names = names(graph, drawing.known);
    svg::document(&picture(graph, &names, map.marker()), drawing, svg::Legend::Elsewhere)
}

/// Where the parts of a graph with open darts are drawn.
pub(crate) struct OpenLayout {
    /// Of each vertex: the centre of its disc, and the radius.
    pub(crate) discs: Vec<(Point, f64)>,
    /// Points along the edge of each dart, from the dart to its other end.
    pub(crate) curves: Vec<Vec<Point>>,
    /// The ends of each dart's edge as it is drawn if the dart is open.
    pub(crate) stubs: Vec<[Point; 2]>,
    /// The radius of the circle in which it ends.
    pub(crate) open: f64,
    pub(crate) extent: Extent,
}

/// The layout of a graph with open darts; `None` of an empty one.
pub(crate) fn open_layout(map: &OpenGraph) -> Option<OpenLayout> {
    let whole = Whole::new(map)?;
    let (_, drawing) = stage(map, Some(&whole))?;
    let extent = drawing.extent();
    let discs = drawing.centres.into_iter().zip(drawing.size.discs).take(map.vertex_count());
    let curves = (0..map.dart_count()).map(|dart| whole.curve(Dart(dart as u32)));
    let stub = |curve: &Curve| {
        let trace = whole.beginning(curve).trace;
        [trace.first(), trace.last()].map(|end| end.copied().unwrap_or_default())
    };
    let curves: Vec<Curve> = curves.collect();
    Some(OpenLayout {
        discs: discs.collect(),
        stubs: curves.iter().map(stub).collect(),
        curves: curves.into_iter().map(|curve| curve.trace).collect(),
        open: OPEN,
        extent,
    })
}

/// A graph with a vertex for each open dart, and its drawing.
struct Whole<'a> {
    map: &'a OpenGraph,
    drawing: Drawing,
    /// The place of each dart's edge in the drawing.
    edge: Vec<usize>,
}

impl<'a> Whole<'a> {
    fn new(map: &'a OpenGraph) -> Option<Self> {
        let graph = map.with_ends()?;
        let names = names(&graph, map.vertex_count());
        let mut size = DrawingSize::new(&graph, &names);
        size.discs[map.vertex_count()..].fill(OPEN);
        let drawing = Drawing::sized(&picture(&graph, &names, map.marker()), size);
        let mut edge = vec![0; graph.dart_count()];
        for (number, &(one, other, _)) in drawing.edges.iter().enumerate() {
            edge[one.at()] = number;
            edge[other.at()] = number;
        }
        Some(Self { map, drawing, edge })
    }

    /// The curve of a dart's edge, from that dart.
    fn curve(&self, dart: Dart) -> Curve {
        let (one, _, curve) = &self.drawing.edges[self.edge[dart.at()]];
        if *one == dart { curve.clone() } else { curve.reversed() }
    }

    /// What is drawn of the curve of an open dart.
    fn beginning(&self, curve: &Curve) -> Curve {
        curve.beginning((STUB[0] * self.drawing.size.base).min(STUB[1] * curve.length()))
    }
}

/// A map with its open ends, drawn as a stage of the last one, or alone if it is not one.
fn stage(map: &OpenGraph, last: Option<&Whole>) -> Option<(EmbeddedGraph, Drawing)> {
    let alone;
    let whole = if let Some(last) = last.filter(|last| map.grew_into(last.map)) {
        last
    } else {
        alone = Whole::new(map)?;
        &alone
    };
    let graph = map.with_ends()?;
    let known = map.vertex_count();
    let mut size = whole.drawing.size.clone();
    let mut centres = whole.drawing.centres[..known].to_vec();
    let mut doors = whole.drawing.doors[..map.dart_count()].to_vec();
    size.discs.truncate(known);
    let mut edges = Vec::new();
    for (dart, other) in graph.edges() {
        let mut curve = whole.curve(dart);
        if other.at() >= map.dart_count() {
            curve = whole.beginning(&curve);
            let end = |back: usize| curve.trace[curve.trace.len() - back];
            let onwards = (end(1) - end(2)).direction();
            centres.push(end(1) + onwards * OPEN);
            doors.push((onwards * -1.0).angle());
            size.discs.push(OPEN);
        }
        edges.push((dart, other, curve));
    }
    let ends = |&(dart, other, _): &_| [dart, other].map(|end| graph.vertex(end).at());
    let ink = |&(dart, ..): &(Dart, Dart, Curve)| whole.drawing.inks[whole.edge[dart.at()]];
    let drawing = Drawing {
        ends: edges.iter().map(ends).collect(),
        inks: edges.iter().map(ink).collect(),
        edges,
        size,
        centres,
        doors,
        floor: None,
        known,
        room: Extent::EMPTY,
    };
    Some((graph, drawing))
}

/// The names of the known vertices, and empty names for the others.
fn names(graph: &EmbeddedGraph, known: usize) -> Vec<String> {
    let name = |vertex| if vertex < known { format!("v{vertex}") } else { String::new() };
    (0..graph.vertex_count()).map(name).collect()
}

fn picture<'a>(
    graph: &'a EmbeddedGraph,
    vertex_names: &'a [String],
    marker: Option<Dart>,
) -> WorldPicture<'a> {
    WorldPicture {
        graph,
        vertex_names,
        edge_names: None,
        start: marker,
        marker: Directional.into(),
        placement: Placement::Free,
        title: "",
        caption: "",
    }
}

#[cfg(test)]
mod tests {
    use std::{collections::HashMap, f64::consts::TAU};

    use resvg::usvg::roxmltree::{Document, Node};
    use toposlam_model::mapping::PartialMap;

    use super::{
        super::{
            example,
            reading::{number, of_class},
        },
        *,
    };

    /// The stages of the map of a world of this repository.
    fn stages(world: &str) -> Vec<PartialMap> {
        let world = example::world(world);
        example::maps(&world.plan.unwrap(), world.start.unwrap())
    }

    fn attributes<const N: usize>(node: Node, names: [&str; N]) -> [f64; N] {
        names.map(|name| number(node, name))
    }

    fn open(maps: &[PartialMap]) -> Vec<OpenGraph> {
        maps.iter().map(OpenGraph::from).collect()
    }

    #[test]
    fn every_unexplored_dart_ends_in_an_open_circle() {
        for world in ["shape-6", "shape-8", "building-12"] {
            let maps = stages(world);
            assert!(maps.last().unwrap().complete().is_some());
            for (map, svg) in maps.iter().zip(growth(&open(&maps))) {
                let document = Document::parse(&svg).unwrap();
                let count = |class| of_class(&document, class).len();
                assert_eq!(count("unexplored"), map.unexplored_count() as usize);
                assert_eq!(count("vertex"), map.vertex_count());
                assert_eq!(count("door"), map.dart_count());
                assert_eq!(count("name"), map.vertex_count());
            }
        }
    }

    #[test]
    fn the_doors_of_every_stage_stand_in_clockwise_order() {
        let maps = stages("building-12");
        for (map, svg) in maps.iter().zip(growth(&open(&maps))) {
            let document = Document::parse(&svg).unwrap();
            let centres: Vec<_> = of_class(&document, "vertex")
                .into_iter()
                .map(|disc| attributes(disc, ["cx", "cy"]))
                .collect();
            let doors: HashMap<_, _> = of_class(&document, "door")
                .into_iter()
                .map(|door| (door.attribute("data-dart").unwrap(), attributes(door, ["cx", "cy"])))
                .collect();
            for vertex in map.vertices() {
                let [x, y] = centres[vertex.at()];
                let angle = |dart: Dart| {
                    let [door_x, door_y] = doors[dart.0.to_string().as_str()];
                    (door_y - y).atan2(door_x - x)
                };
                let angles: Vec<_> = map.darts_of(vertex).map(angle).collect();
                let next = angles.iter().cycle().skip(1);
                let whole: f64 =
                    angles.iter().zip(next).map(|(a, b)| (b - a).rem_euclid(TAU)).sum();
                assert!(angles.len() < 2 || (whole - TAU).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn what_is_known_stays_where_it_is() {
        let mut first = HashMap::new();
        let pictures = growth(&open(&stages("shape-8")));
        for svg in &pictures {
            let document = Document::parse(svg).unwrap();
            let box_of =
                |svg: &Document| svg.root_element().attribute("viewBox").map(str::to_owned);
            assert_eq!(box_of(&document), box_of(&Document::parse(&pictures[0]).unwrap()));
            for disc in of_class(&document, "vertex") {
                let [vertex, x, y] = attributes(disc, ["data-vertex", "cx", "cy"]);
                let place = (x.to_bits(), y.to_bits());
                assert_eq!(*first.entry(vertex.to_bits()).or_insert(place), place);
            }
        }
        assert_eq!(first.len(), 6);
    }

    #[test]
    fn a_map_that_did_not_grow_into_the_last_one_is_drawn_by_itself() {
        let (other, mut maps) = (stages("shape-8"), stages("shape-6"));
        maps.insert(0, other[3].clone());
        let alone =
            Document::parse(&growth(&open(&maps))[0]).map(|it| of_class(&it, "vertex").len());
        assert_eq!(alone, Ok(other[3].vertex_count()));
    }
}
