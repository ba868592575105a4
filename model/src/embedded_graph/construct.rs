//! The constructors of embedded graphs. Each validates its input. Section 2.1.

use std::collections::HashMap;

use petgraph::visit::{Dfs, VisitMap};

use super::{
    Dart, EmbeddedGraph, GraphError, ListError, NO_DART, Vertex, VisitedVertices, clockwise_fault,
    opposite_fault, size_fault,
};
use crate::similar::similar_name;

const SHOWN: usize = 8;

impl EmbeddedGraph {
    /// An embedded graph from its two permutations of the darts `0 .. 2m`, and the number that each
    /// of them gets: vertices in the order of their least dart, the darts of a vertex clockwise
    /// from it.
    ///
    /// # Errors
    /// Returns an error if they are not `opposite` and `clockwise` of a connected graph with at least
    /// one edge.
    pub fn from_permutations(
        opposite: &[u32],
        clockwise: &[u32],
    ) -> Result<(Self, Vec<Dart>), GraphError> {
        if opposite.len() != clockwise.len() {
            return Err(GraphError::LengthsDiffer {
                opposite: opposite.len(),
                clockwise: clockwise.len(),
            });
        }
        let fault = size_fault(opposite.len())
            .or_else(|| opposite_fault(opposite))
            .or_else(|| clockwise_fault(clockwise, &mut vec![false; clockwise.len()]));
        if let Some(fault) = fault {
            return Err(fault);
        }
        let mut number = vec![NO_DART; opposite.len()];
        let mut inverse = Vec::with_capacity(opposite.len());
        let mut degrees = Vec::with_capacity(opposite.len());
        for least in 0..opposite.len() {
            let before = inverse.len();
            let mut dart = least;
            while number[dart] == NO_DART {
                number[dart] = Dart(inverse.len() as u32);
                inverse.push(dart);
                dart = clockwise[dart] as usize;
            }
            if inverse.len() > before {
                degrees.push((inverse.len() - before) as u32);
            }
        }
        let renumbered = inverse.iter().map(|&dart| number[opposite[dart] as usize]).collect();
        let graph = Self::from_degrees(&degrees, renumbered);
        match graph.unreached_vertex() {
            Some(vertex) => {
                let missed = graph.darts_of(vertex).map(|dart| inverse[dart.at()]).min();
                Err(GraphError::NotConnected { dart: missed.unwrap_or_default() as u32 })
            }
            None => Ok((graph, number)),
        }
    }

    /// A simple embedded graph from the clockwise neighbours of each vertex. Vertices are numbered
    /// in the order of the lists, darts in the order in which the lists name their far ends.
    ///
    /// # Errors
    /// Returns an error that names the first invalid vertex and neighbour.
    pub fn from_neighbour_lists<N: AsRef<str>>(lists: &[(N, Vec<N>)]) -> Result<Self, ListError> {
        let number = number_vertices(lists)?;
        let name_of = |vertex: usize| lists[vertex].0.as_ref().to_owned();
        let mut end_at: HashMap<(usize, usize), Dart> = HashMap::new();
        let mut ends = Vec::new();
        for (at, (name, neighbours)) in lists.iter().enumerate() {
            for neighbour in neighbours {
                let (vertex, neighbour) = (name_of(at), neighbour.as_ref().to_owned());
                let Some(&other) = number.get(neighbour.as_str()) else {
                    // A vertex cannot be its own neighbour, so it is not offered.
                    let others = lists.iter().map(|(other, _)| other.as_ref());
                    let others = others.filter(|other| *other != name.as_ref());
                    let similar = similar_name(&neighbour, others);
                    return Err(ListError::UnknownNeighbour { vertex, neighbour, similar });
                };
                if other == at {
                    return Err(ListError::OwnNeighbour { vertex });
                }
                if end_at.insert((at, other), Dart(ends.len() as u32)).is_some() {
                    return Err(ListError::RepeatedNeighbour { vertex, neighbour });
                }
                ends.push((at, other));
            }
        }
        let opposite = ends.iter().map(|&(vertex, other)| {
            end_at.get(&(other, vertex)).copied().ok_or_else(|| ListError::OneSided {
                vertex: name_of(vertex),
                neighbour: name_of(other),
            })
        });
        let opposite = opposite.collect::<Result<Vec<_>, _>>()?;
        Self::from_lists(lists, opposite)
    }

    /// An embedded graph from the clockwise edge names of each vertex, each edge named exactly
    /// twice. Vertices are numbered in the order of the lists, darts in the order in which the
    /// lists name their edges.
    ///
    /// # Errors
    /// Returns an error that names the first invalid vertex or edge.
    pub fn from_edge_lists<N: AsRef<str>>(lists: &[(N, Vec<N>)]) -> Result<Self, ListError> {
        number_vertices(lists)?;
        let mut ends: HashMap<&str, Vec<(usize, Dart)>> = HashMap::new();
        let mut names = Vec::new();
        for (vertex, (_, edges)) in lists.iter().enumerate() {
            for edge in edges {
                let dart = Dart(names.len() as u32);
                ends.entry(edge.as_ref()).or_default().push((vertex, dart));
                names.push(edge.as_ref());
            }
        }
        let mut opposite = Vec::with_capacity(names.len());
        for (dart, name) in names.iter().enumerate() {
            match ends[name].as_slice() {
                &[(_, one), (_, other)] => {
                    opposite.push(if one.at() == dart { other } else { one });
                }
                wrong => {
                    let places = wrong.iter().map(|&(vertex, _)| lists[vertex].0.as_ref());
                    let more = (wrong.len() > SHOWN).then_some("...");
                    return Err(ListError::NotTwoEnds {
                        edge: (*name).to_owned(),
                        times: wrong.len(),
                        places: places.take(SHOWN).chain(more).collect::<Vec<_>>().join(", "),
                    });
                }
            }
        }
        Self::from_lists(lists, opposite)
    }

    /// A chain of this number of edges, at least one. Dart 0 is at one of its ends.
    pub fn chain(edges: usize) -> Self {
        let edges = edges.max(1);
        let degrees: Vec<u32> = (0..=edges).map(|at| 1 + u32::from(at % edges > 0)).collect();
        Self::from_degrees(&degrees, (0..2 * edges as u32).map(|dart| Dart(dart ^ 1)).collect())
    }

    /// A cycle of this number of edges, at least one.
    pub fn cycle(edges: usize) -> Self {
        let edges = edges.max(1);
        let darts = 2 * edges as u32;
        let by = |dart: u32| if dart % 2 == 1 { 1 } else { darts - 1 };
        let opposite = (0..darts).map(|dart| Dart((dart + by(dart)) % darts));
        Self::from_degrees(&vec![2; edges], opposite.collect())
    }

    /// The graph with the lists' lengths as degrees. Its size and connection are checked.
    fn from_lists<N: AsRef<str>>(
        lists: &[(N, Vec<N>)],
        opposite: Vec<Dart>,
    ) -> Result<Self, ListError> {
        if let Some(fault) = size_fault(opposite.len()) {
            return Err(fault.into());
        }
        let degrees: Vec<u32> = lists.iter().map(|(_, list)| list.len() as u32).collect();
        let graph = Self::from_degrees(&degrees, opposite);
        match graph.unreached_vertex() {
            Some(vertex) => Err(ListError::NotConnected {
                vertex: lists[vertex.at()].0.as_ref().to_owned(),
                from: lists[0].0.as_ref().to_owned(),
            }),
            None => Ok(graph),
        }
    }

    /// The graph with these degrees and this `opposite`, which the caller has checked.
    pub(super) fn from_degrees(degrees: &[u32], opposite: Vec<Dart>) -> Self {
        let mut graph = Self::unfinished();
        graph.reserve(degrees.len(), opposite.len());
        for &degree in degrees {
            graph.add_vertex(degree);
        }
        for (place, opposite) in graph.darts.iter_mut().zip(opposite) {
            place.opposite = opposite;
        }
        graph
    }

    fn unreached_vertex(&self) -> Option<Vertex> {
        let reached = self.reached(Vertex(0));
        self.vertices().find(|vertex| !reached.is_visited(vertex))
    }

    /// The vertices that can be reached from one.
    pub(super) fn reached(&self, from: Vertex) -> VisitedVertices {
        let mut search = Dfs::new(self, from);
        while search.next(self).is_some() {}
        search.discovered
    }
}

fn number_vertices<N: AsRef<str>>(
    lists: &[(N, Vec<N>)],
) -> Result<HashMap<&str, usize>, ListError> {
    let mut number = HashMap::new();
    for (vertex, (name, _)) in lists.iter().enumerate() {
        if number.insert(name.as_ref(), vertex).is_some() {
            return Err(ListError::VertexTwice { vertex: name.as_ref().to_owned() });
        }
    }
    Ok(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chain_has_two_ends_and_a_cycle_has_none() {
        for edges in 1..6 {
            let (chain, cycle) = (EmbeddedGraph::chain(edges), EmbeddedGraph::cycle(edges));
            assert_eq!((chain.vertex_count(), chain.edge_count()), (edges + 1, edges));
            assert_eq!((cycle.vertex_count(), cycle.edge_count()), (edges, edges));
            assert_eq!((chain.degree_around(Dart(0)), chain.face_count()), (1, 1));
            assert!(cycle.vertices().all(|vertex| cycle.degree(vertex) == 2));
            assert_eq!((cycle.face_count(), cycle.unreached_vertex()), (2, None));
            assert_eq!(chain.unreached_vertex(), None);
        }
    }

    #[test]
    fn permutations_are_renumbered_vertex_by_vertex() {
        // A path u - v - w; the darts of v are 1 and 3.
        let (graph, number) =
            EmbeddedGraph::from_permutations(&[1, 0, 3, 2], &[0, 3, 2, 1]).unwrap();
        assert_eq!(graph.vertex_count(), 3);
        assert_eq!(number, [Dart(0), Dart(1), Dart(3), Dart(2)]);
        assert_eq!(graph.opposite(Dart(2)), Dart(3));
    }

    #[test]
    fn each_fault_of_permutations_is_named() {
        let cases: [(&[u32], &[u32], _); 8] = [
            (&[], &[], GraphError::NoEdge),
            (&[1, 0], &[0], GraphError::LengthsDiffer { opposite: 2, clockwise: 1 }),
            (&[5, 0], &[0, 1], GraphError::OppositeOutOfRange { dart: 0, opposite: 5 }),
            (&[0, 1], &[0, 1], GraphError::OppositeFixed { dart: 0 }),
            (&[1, 2, 3, 0], &[0, 1, 2, 3], GraphError::OppositeNotMutual { dart: 0, opposite: 1 }),
            (&[1, 0], &[2, 0], GraphError::ClockwiseOutOfRange { dart: 0, clockwise: 2 }),
            (&[1, 0], &[1, 1], GraphError::ClockwiseRepeated { dart: 1, clockwise: 1 }),
            (&[1, 0, 3, 2], &[0, 1, 2, 3], GraphError::NotConnected { dart: 2 }),
        ];
        for (opposite, clockwise, fault) in cases {
            assert_eq!(EmbeddedGraph::from_permutations(opposite, clockwise), Err(fault));
        }
    }

    /// The other faults are those of world files.
    #[test]
    fn each_fault_of_edge_lists_is_named() {
        let cases: [(&[_], _); 5] = [
            (&[("a", vec!["e"; 1])], "edge `e` occurs 1 time (a); an edge has two ends"),
            (
                &[("a", vec!["e"; 8])],
                "edge `e` occurs 8 times (a, a, a, a, a, a, a, a); an edge has two ends",
            ),
            (
                &[("a", vec!["e"; 9])],
                "edge `e` occurs 9 times (a, a, a, a, a, a, a, a, ...); an edge has two ends",
            ),
            (&[("a", vec![]), ("a", vec![])], "vertex `a` has two lists"),
            (&[("a", vec![])], "there is no edge; a world has at least one"),
        ];
        for (lists, message) in cases {
            assert_eq!(EmbeddedGraph::from_edge_lists(lists).unwrap_err().to_string(), message);
        }
    }
}
