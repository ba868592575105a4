//! A graph whose loops and parallel edges get bends, which are further nodes, so that it is simple.

use std::collections::{BTreeMap, BTreeSet};

use toposlam_model::embedded_graph::EmbeddedGraph;

/// An embedded graph with bends as further nodes. Darts and nodes of the graph keep their numbers.
#[derive(Clone, Debug)]
pub(super) struct Subdivision {
    /// The number of nodes: vertices, then bends.
    pub(super) nodes: usize,
    pub(super) vertices: usize,
    /// The node of each dart.
    pub(super) node: Vec<usize>,
    /// The other end of each dart's segment.
    pub(super) opposite: Vec<usize>,
    /// The next dart clockwise around the same node.
    pub(super) clockwise: Vec<usize>,
    /// The best length of each dart's segment.
    pub(super) wish: Vec<f64>,
    /// The bends of each edge, from its first dart on.
    pub(super) bends: Vec<Vec<usize>>,
}

impl Subdivision {
    /// The graph with two bends in each loop and one in each parallel edge.
    pub(super) fn new(graph: &EmbeddedGraph) -> Self {
        let ends = |dart| (graph.vertex(dart), graph.vertex(graph.opposite(dart)));
        let mut parallel = BTreeMap::new();
        for (dart, other) in graph.edges() {
            let (u, v) = ends(dart.min(other));
            *parallel.entry((u.min(v), u.max(v))).or_insert(0_u32) += 1;
        }
        Self::with_bends(graph, |dart| {
            let (u, v) = ends(dart);
            if u == v {
                2
            } else {
                // A lone edge gets a bend too, so that its face has the four sides of a polygon.
                usize::from(parallel[&(u.min(v), u.max(v))] > 1 || graph.edge_count() == 1)
            }
        })
    }

    /// The graph as it is.
    pub(super) fn without_bends(graph: &EmbeddedGraph) -> Self {
        Self::with_bends(graph, |_| 0)
    }

    fn with_bends(
        graph: &EmbeddedGraph,
        count: impl Fn(toposlam_model::embedded_graph::Dart) -> usize,
    ) -> Self {
        let mut web = Self {
            nodes: graph.vertex_count(),
            vertices: graph.vertex_count(),
            node: graph.darts().map(|dart| graph.vertex(dart).at()).collect(),
            opposite: graph.darts().map(|dart| graph.opposite(dart).at()).collect(),
            clockwise: graph.darts().map(|dart| graph.clockwise(dart).at()).collect(),
            wish: vec![1.0; graph.dart_count()],
            bends: Vec::with_capacity(graph.edge_count()),
        };
        for (dart, other) in graph.edges() {
            let wish = [1.0, 0.6, 0.62][count(dart).min(2)];
            let mut bends = Vec::new();
            let mut last = dart.at();
            for _ in 0..count(dart) {
                let back = web.node.len();
                web.node.extend([web.nodes, web.nodes]);
                web.clockwise.extend([back + 1, back]);
                web.opposite.extend([last, other.at()]);
                web.wish.extend([wish, wish]);
                web.opposite[last] = back;
                bends.push(web.nodes);
                web.nodes += 1;
                last = back + 1;
            }
            web.opposite[last] = other.at();
            web.opposite[other.at()] = last;
            web.wish[dart.at()] = wish;
            web.wish[other.at()] = wish;
            web.bends.push(bends);
        }
        web
    }

    /// The darts of each node in clockwise order.
    pub(super) fn darts_of_nodes(&self) -> Vec<Vec<usize>> {
        let mut darts = vec![Vec::new(); self.nodes];
        for first in 0..self.node.len() {
            let at = self.node[first];
            if darts[at].is_empty() {
                let next = |&dart: &usize| Some(self.clockwise[dart]).filter(|&next| next != first);
                darts[at].extend(std::iter::successors(Some(first), next));
            }
        }
        darts
    }

    /// The node at the far end of the dart's segment.
    pub(super) fn far(&self, dart: usize) -> usize {
        self.node[self.opposite[dart]]
    }

    /// The number of different nodes on a face.
    pub(super) fn different_nodes(&self, face: &[usize]) -> usize {
        face.iter().map(|&dart| self.node[dart]).collect::<BTreeSet<_>>().len()
    }

    /// The faces, each as its darts, walked with the face on the left.
    pub(super) fn faces(&self) -> Vec<Vec<usize>> {
        let mut seen = vec![false; self.node.len()];
        let mut faces = Vec::new();
        for first in 0..self.node.len() {
            let mut face = Vec::new();
            let mut dart = first;
            while !std::mem::replace(&mut seen[dart], true) {
                face.push(dart);
                dart = self.clockwise[self.opposite[dart]];
            }
            if !face.is_empty() {
                faces.push(face);
            }
        }
        faces
    }
}

#[cfg(test)]
mod tests {
    use super::{super::super::gallery::worlds::multigraph, *};

    #[test]
    fn a_loop_becomes_a_triangle_and_keeps_its_faces() {
        let web = Subdivision::new(&multigraph("loops", "u: a a b b").graph);
        assert_eq!(web.nodes, 5);
        let mut sizes: Vec<_> = web.faces().iter().map(Vec::len).collect();
        sizes.sort_unstable();
        assert_eq!(sizes, [3, 3, 6]);
        assert_eq!(web.darts_of_nodes()[0], [0, 1, 2, 3]);
        for dart in 0..web.node.len() {
            assert_eq!(web.opposite[web.opposite[dart]], dart);
        }
    }
}
