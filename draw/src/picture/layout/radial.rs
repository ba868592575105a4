//! A large tree around its middle: each depth on its own circle, the leaves evenly spread.

use std::f64::consts::TAU;

use toposlam_model::embedded_graph::{Dart, EmbeddedGraph, Vertex};

use super::{super::geometry::Point, stress::hops};

/// The least distance along a circle from one leaf to the next.
const APART: f64 = 0.7;

/// A point for each vertex of a tree; all orders are kept.
pub(super) fn tree(graph: &EmbeddedGraph) -> Vec<Point> {
    let root = middle(graph);
    let depths = hops(graph, root);
    let mut first = vec![usize::MAX; graph.vertex_count()];
    let mut last = vec![0; graph.vertex_count()];
    let mut leaves = 0;
    // The walk around the one face meets the leaves clockwise.
    let mut dart = graph.darts_of(root).next().unwrap_or(Dart(0));
    for _ in graph.darts() {
        let far = graph.opposite(dart);
        let vertex = graph.vertex(far).at();
        if graph.degree(graph.vertex(far)) == 1 {
            (first[vertex], last[vertex]) = (leaves, leaves);
            leaves += 1;
        }
        dart = graph.clockwise(far);
    }
    let mut deepest_first: Vec<_> = graph.vertices().collect();
    deepest_first.sort_by_key(|vertex| std::cmp::Reverse(depths[vertex.at()]));
    for vertex in deepest_first {
        for dart in graph.darts_of(vertex) {
            let child = graph.vertex(graph.opposite(dart)).at();
            if depths[child] > depths[vertex.at()] {
                first[vertex.at()] = first[vertex.at()].min(first[child]);
                last[vertex.at()] = last[vertex.at()].max(last[child]);
            }
        }
    }
    let deepest = depths.iter().copied().max().unwrap_or(1).max(1);
    let step = (leaves as f64 * APART / (TAU * f64::from(deepest))).max(1.0);
    (0..graph.vertex_count())
        .map(|vertex| {
            let share = (first[vertex] + last[vertex]) as f64 / 2.0 / leaves as f64;
            Point::polar(TAU * share, f64::from(depths[vertex]) * step)
        })
        .collect()
}

/// The vertex in the middle of a longest path.
fn middle(graph: &EmbeddedGraph) -> Vertex {
    let furthest = |hops: &[u32]| {
        let far = graph.vertices().max_by_key(|vertex| hops[vertex.at()]);
        far.unwrap_or(Vertex(0))
    };
    let one = furthest(&hops(graph, Vertex(0)));
    let from_one = hops(graph, one);
    let other = furthest(&from_one);
    let from_other = hops(graph, other);
    let whole = from_one[other.at()];
    let on_path = |vertex: &Vertex| {
        let here = from_one[vertex.at()];
        here == whole / 2 && here + from_other[vertex.at()] == whole
    };
    graph.vertices().find(on_path).unwrap_or(one)
}

#[cfg(test)]
mod tests {
    use super::{super::super::gallery::worlds::simple, *};

    #[test]
    fn a_chain_is_straight_and_its_middle_is_the_origin() {
        let points = tree(&simple("chain", "a: b, b: a c, c: b").graph);
        assert_eq!(points[1], Point::default());
        assert!((points[0] + points[2]).length() < 1e-9);
        assert!((points[0].length() - 1.0).abs() < 1e-9);
    }
}
