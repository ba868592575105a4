//! A planar part of a graph, with its orders: a spanning tree, and each further edge that does not need a
//! handle of the surface.

use toposlam_model::embedded_graph::{Dart, EmbeddedGraph, Vertex};

/// The graph without the edges that make it non-planar; its vertices stay.
pub(super) fn planar_part(graph: &EmbeddedGraph) -> Option<EmbeddedGraph> {
    let mut kept = spanning_tree(graph);
    let mut part = with_edges(graph, &kept)?;
    for (dart, other) in graph.edges() {
        if !kept[dart.at()] {
            let mut more = kept.clone();
            (more[dart.at()], more[other.at()]) = (true, true);
            if let Some(planar) = with_edges(graph, &more).filter(|more| more.genus() == 0) {
                (part, kept) = (planar, more);
            }
        }
    }
    Some(part)
}

/// The darts of a breadth-first tree.
fn spanning_tree(graph: &EmbeddedGraph) -> Vec<bool> {
    let mut kept = vec![false; graph.dart_count()];
    let mut reached = vec![false; graph.vertex_count()];
    reached[0] = true;
    let mut queue = vec![Vertex(0)];
    let mut next = 0;
    while next < queue.len() {
        for dart in graph.darts_of(queue[next]) {
            let other = graph.opposite(dart);
            let far = graph.vertex(other);
            if !std::mem::replace(&mut reached[far.at()], true) {
                kept[dart.at()] = true;
                kept[other.at()] = true;
                queue.push(far);
            }
        }
        next += 1;
    }
    kept
}

/// The graph with only these darts; none if that is not an embedded graph.
fn with_edges(graph: &EmbeddedGraph, kept: &[bool]) -> Option<EmbeddedGraph> {
    let name = |dart: Dart| dart.min(graph.opposite(dart)).0.to_string();
    let lists: Vec<_> = graph
        .vertices()
        .map(|vertex| {
            let darts = graph.darts_of(vertex).filter(|dart| kept[dart.at()]);
            (vertex.0.to_string(), darts.map(name).collect())
        })
        .collect();
    EmbeddedGraph::from_edge_lists(&lists).ok()
}

#[cfg(test)]
mod tests {
    use super::{super::super::gallery::worlds::multigraph, *};

    #[test]
    fn the_torus_loses_one_edge_of_three() {
        let theta = multigraph("theta", "u: a b c, v: a b c").graph;
        let part = planar_part(&theta).unwrap();
        assert_eq!((part.edge_count(), part.genus()), (2, 0));
    }
}
