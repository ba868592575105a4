//! The number of picture units in a unit of the layout: as few as leave room for discs, doors and the
//! marker.

use toposlam_model::embedded_graph::EmbeddedGraph;

use super::{
    Placement,
    geometry::{Extent, Point},
    layout,
    size::{DrawingSize, Names},
};

/// The greatest longer side for given positions, in discs, even if two of them are near.
const LONGEST: f64 = 600.0;

/// Given positions are drawn larger than necessary up to this longer side, and at most by this factor.
const SMALL: [f64; 2] = [520.0, 1.4];

/// Units of the picture in a unit of the layout.
pub(super) fn scale(
    graph: &EmbeddedGraph,
    places: &[Point],
    size: &DrawingSize,
    placement: Placement,
) -> f64 {
    let lines: Vec<_> = graph
        .edges()
        .map(|(dart, other)| [graph.vertex(dart).at(), graph.vertex(other).at()])
        .filter(|[u, v]| u != v)
        .collect();
    match placement {
        Placement::Free => usual(graph, places, size, &lines),
        Placement::At(_) => given(places, size, &lines, 1.2 * size.base, &[]),
        // No disc lies on another hallway.
        Placement::FloorPlan { .. } => given(places, size, &lines, 24.0, &lines),
    }
}

/// The scale that the nearest of the given positions need. `between`: the room between the doors along an edge, for
/// the marker or for a bow. `clear`: the edges to which other vertices keep a distance.
fn given(
    places: &[Point],
    size: &DrawingSize,
    lines: &[[usize; 2]],
    between: f64,
    clear: &[[usize; 2]],
) -> f64 {
    let reach = |vertex: usize| size.discs[vertex] + size.knob;
    let mut scale = 0.0_f64;
    let mut demand = |units: f64, distance: f64| {
        if distance > 0.0 {
            scale = scale.max(units / distance);
        }
    };
    for (vertex, &place) in places.iter().enumerate() {
        for (other, &there) in places.iter().enumerate().take(vertex) {
            demand(reach(vertex) + reach(other) + 4.0, place.distance(there));
        }
        for &[u, v] in clear.iter().filter(|ends| !ends.contains(&vertex)) {
            let distance = place.distance_to_segment(places[u], places[v]);
            demand(reach(vertex) + 2.0, distance);
        }
    }
    for &[u, v] in lines {
        demand(reach(u) + reach(v) + between, places[u].distance(places[v]));
    }
    let sides = Extent::from_points(places.iter().copied()).size();
    let side = sides.x.max(sides.y);
    if scale == 0.0 || side == 0.0 {
        return 1.0;
    }
    let larger = (SMALL[0] / side).min(scale * SMALL[1]);
    scale.max(larger).min(LONGEST * size.base / side)
}

/// A good scale for edges of length 1, or a larger one if vertices are nearer than that.
fn usual(graph: &EmbeddedGraph, places: &[Point], size: &DrawingSize, lines: &[[usize; 2]]) -> f64 {
    // Curves that cross need more room than straight ones, names beside discs even more.
    let discs = match (size.names, graph.genus()) {
        (Names::Beside, _) => 8.5,
        (_, 0) => 5.4,
        _ => 6.4,
    };
    let usual = size.base * if places.len() > layout::POLISHED { 4.0 } else { discs };
    let mut tightest = 1.0_f64;
    for &[u, v] in lines {
        let length = places[u].distance(places[v]).max(1e-6);
        let discs = size.discs[u] + size.discs[v];
        tightest = tightest.max((discs + 2.0 * size.base) / (length * usual));
    }
    if places.len() <= layout::POLISHED {
        for (at, one) in places.iter().enumerate() {
            for other in &places[..at] {
                let distance = one.distance(*other).max(1e-6);
                tightest = tightest.max(3.4 * size.base / (distance * usual));
            }
        }
    }
    usual * tightest.min(2.5)
}

#[cfg(test)]
mod tests {
    use super::{super::gallery::worlds::simple, *};

    #[test]
    fn the_nearest_junctions_decide() {
        let world = simple("chain", "a: b, b: a c, c: b");
        let size = DrawingSize::new(&world.graph, &world.vertex_names);
        let metre = |far: f64| {
            let places = [0.0, 4.0, far].map(|x| Point::new(x, 0.0));
            let placement = Placement::FloorPlan { positions: &[], hallway_width: 1.6 };
            scale(&world.graph, &places, &size, placement)
        };
        assert_eq!(metre(40.0).to_bits(), metre(80.0).to_bits());
        assert!((4.0 * metre(40.0) - (2.0 * (size.discs[0] + size.knob) + 24.0)).abs() < 1e-9);
        assert!(metre(8.0) > metre(40.0));
        // However near two positions are, the picture stays finite.
        assert!(metre(4.000_000_1) < 1e5);
    }
}
