//! The worlds that a marker does not distinguish from a given one, and that have as many edges. Section 2.2,
//! Figure 1.
//!
//! Two placed worlds are indistinguishable exactly if they have the same [quotient](super::quotient). A twin joins the
//! darts in other pairs, each dart with one of the class that crossing leads to. The search makes all such pairs, in the
//! order of discovery from the first dart, so that each world appears about once.

use std::collections::BTreeSet;

use super::{
    Comparison,
    quotient::{Quotient, placed_code},
};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Watch,
    isomorphism::StartCode,
    marker::Marker,
    world::GraphWorld,
};

/// A placed world that a marker does not distinguish from another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Twin {
    pub graph: EmbeddedGraph,
    pub facing: Dart,
    /// For the pose at the start of the first world, the indistinguishable pose here.
    pub pose: Dart,
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Twins {
    /// Those that were found: simple ones before others, then by genus.
    pub worlds: Vec<Twin>,
    /// Whether there may be more: the search reached its limit.
    pub may_be_more: bool,
}

/// The limits of a search for twins, about a second's work.
const STEPS: u64 = 200_000;
const MOST: usize = 64;
/// The most darts of a world whose twins are searched.
const MOST_DARTS: usize = 4096;

/// The worlds with as many edges that are not isomorphic to a placed world, and that no walk distinguishes from
/// it. The marker is placed by the facing dart, and the robot begins in the pose; each result is verified by a
/// relation.
pub fn twins(
    graph: &EmbeddedGraph,
    marker: &dyn Marker,
    facing: Dart,
    pose: Dart,
    watch: &dyn Watch,
) -> Twins {
    if graph.dart_count() > MOST_DARTS {
        return Twins { worlds: Vec::new(), may_be_more: true };
    }
    let (quotient, _) = Quotient::new(&GraphWorld::with_aid(graph, marker.into(), facing));
    if quotient.is_discrete() {
        return Twins::default();
    }
    let classes = Classes::new(graph, &quotient);
    let mut search = Search {
        graph,
        marker,
        facing,
        pose,
        classes: &classes,
        watch,
        steps: STEPS,
        opposite: vec![None; graph.dart_count()],
        order: Vec::new(),
        touched: vec![false; graph.vertex_count()],
        known: BTreeSet::from([code_placed_by(graph, marker, facing)]),
        found: Vec::new(),
        stopped: false,
    };
    search.touch(graph.first_dart(graph.vertex(facing)));
    search.extend(0);
    let Search { mut found, stopped, .. } = search;
    found.sort_by_key(|twin| (!twin.graph.is_simple(), twin.graph.genus()));
    Twins { worlds: found, may_be_more: stopped }
}

fn code_placed_by(graph: &EmbeddedGraph, marker: &dyn Marker, facing: Dart) -> StartCode {
    let placing = marker.first_alike(graph, facing);
    placed_code(graph, graph.darts().filter(|&dart| marker.first_alike(graph, dart) == placing))
}

struct Classes {
    of: Vec<u32>,
    /// The class to which crossing leads from each class.
    across: Vec<u32>,
}

impl Classes {
    /// The marker does not move, so a state is a dart.
    fn new(graph: &EmbeddedGraph, quotient: &Quotient) -> Self {
        let of = quotient.classes().to_vec();
        let mut across = vec![0; of.iter().max().map_or(0, |&last| last as usize + 1)];
        for dart in graph.darts() {
            across[of[dart.at()] as usize] = of[graph.opposite(dart).at()];
        }
        Self { of, across }
    }
}

struct Search<'s> {
    graph: &'s EmbeddedGraph,
    marker: &'s dyn Marker,
    facing: Dart,
    pose: Dart,
    classes: &'s Classes,
    watch: &'s dyn Watch,
    steps: u64,
    /// The pairs so far. The vertices are those of the first world.
    opposite: Vec<Option<Dart>>,
    order: Vec<Dart>,
    touched: Vec<bool>,
    known: BTreeSet<StartCode>,
    found: Vec<Twin>,
    stopped: bool,
}

impl Search<'_> {
    /// Adds the darts of a vertex, clockwise from one.
    fn touch(&mut self, first: Dart) {
        self.touched[self.graph.vertex(first).at()] = true;
        let around = std::iter::successors(Some(first), |&dart| Some(self.graph.clockwise(dart)));
        self.order.extend(around.take(self.graph.degree_around(first) as usize));
    }

    /// Joins the first dart that has no opposite, in every way. The darts before `from` have one.
    fn extend(&mut self, mut from: usize) {
        while self.order.get(from).is_some_and(|dart| self.opposite[dart.at()].is_some()) {
            from += 1;
        }
        let Some(&dart) = self.order.get(from) else {
            self.complete();
            return;
        };
        let class = self.classes.across[self.classes.of[dart.at()] as usize];
        // Vertices that were not met are alike if they have darts of one class; the first stands for all.
        let mut was_new = false;
        for other in self.graph.darts() {
            let is_open = self.opposite[other.at()].is_none();
            if other == dart || !is_open || self.classes.of[other.at()] != class {
                continue;
            }
            let vertex = self.graph.vertex(other);
            let is_new = !self.touched[vertex.at()];
            if is_new && std::mem::replace(&mut was_new, true) {
                continue;
            }
            if self.is_over() {
                return;
            }
            let before = self.order.len();
            if is_new {
                self.touch(other);
            }
            self.opposite[dart.at()] = Some(other);
            self.opposite[other.at()] = Some(dart);
            self.extend(from + 1);
            self.opposite[dart.at()] = None;
            self.opposite[other.at()] = None;
            if is_new {
                self.touched[vertex.at()] = false;
                self.order.truncate(before);
            }
        }
    }

    /// A world in which all darts are joined becomes a twin, unless it is not connected or known.
    fn complete(&mut self) {
        let graph = self.graph;
        if self.order.len() < graph.dart_count() {
            return;
        }
        let numbers: Vec<u32> = self.opposite.iter().flatten().map(|dart| dart.0).collect();
        let clockwise: Vec<u32> = graph.darts().map(|dart| graph.clockwise(dart).0).collect();
        // The darts keep their numbers: those of a vertex stand side by side.
        let Ok((other, _)) = EmbeddedGraph::from_permutations(&numbers, &clockwise) else { return };
        if !self.known.insert(code_placed_by(&other, self.marker, self.facing)) {
            return;
        }
        let comparison = Comparison::new(self.marker, (graph, self.facing), (&other, self.facing));
        let alike = |pose: &Dart| {
            let Some(relation) = comparison.relation([self.pose, *pose]) else { return false };
            let [here, there] = comparison.starts([self.pose, *pose]);
            relation.verify(&here, &there)
        };
        let class = self.classes.of[self.pose.at()];
        let mut poses = other.darts().filter(|dart| self.classes.of[dart.at()] == class);
        if let Some(pose) = poses.find(alike) {
            self.found.push(Twin { graph: other.clone(), facing: self.facing, pose });
        }
    }

    /// Takes a step; `true` if the search is over.
    fn is_over(&mut self) -> bool {
        self.stopped |= self.steps == 0 || self.found.len() >= MOST || self.watch.stop();
        self.steps = self.steps.saturating_sub(1);
        self.stopped
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::{
        ambiguity::quotient::QuotientCode,
        any_graph::{Class, starts, world},
        isomorphism::isomorphism,
        marker::{Directional, NoMarker, Undirected},
    };

    /// The paper's example: the wheel in the plane, and the wheel on the torus.
    #[test]
    fn figure_1b_is_a_twin_of_figure_1a() {
        let [plane, torus] = ["figure-1a", "figure-1b"].map(world);
        let hub = plane.start.unwrap();
        let found = twins(&plane.graph, &Undirected, hub, hub, &());
        assert!(!found.may_be_more);
        let is_torus = |twin: &Twin| isomorphism(&twin.graph, &torus.graph).is_ok();
        assert!(found.worlds.iter().any(is_torus), "{found:?}");
        let first = &found.worlds[0];
        assert_eq!((first.graph.genus(), first.graph.is_simple()), (1, true));
        // A directional marker distinguishes all worlds.
        assert_eq!(twins(&plane.graph, &Directional, hub, hub, &()), Twins::default());
        let back =
            twins(&torus.graph, &Undirected, torus.start.unwrap(), torus.start.unwrap(), &());
        let is_plane = |twin: &Twin| isomorphism(&twin.graph, &plane.graph).is_ok();
        assert!(back.worlds.iter().any(is_plane));
    }

    /// All worlds with equal quotients are found, and no others: the quotients of all worlds are compared.
    #[test]
    fn the_twins_are_all_worlds_of_their_size_with_the_same_quotient() {
        let mut compared = 0;
        for marker in [&Undirected as &dyn Marker, &NoMarker, &Directional] {
            for edges in 1..=4 {
                let mut placed: BTreeMap<StartCode, (EmbeddedGraph, Dart, QuotientCode)> =
                    BTreeMap::new();
                // The starts of a world are its darts.
                for graph in starts(Class::Multigraph, edges) {
                    let facing = Dart(0);
                    let (quotient, _) =
                        Quotient::new(&GraphWorld::with_aid(&graph, marker.into(), facing));
                    let starts = marker.starts(&graph, facing).into_iter();
                    let least = starts.map(|start| quotient.code(start.0)).min().unwrap();
                    let code = code_placed_by(&graph, marker, facing);
                    placed.insert(code, (graph, facing, least));
                }
                for (graph, facing, code) in placed.values() {
                    let alike = placed.values().filter(|(.., other)| other == code).count();
                    let found = twins(graph, marker, *facing, *facing, &());
                    assert!(!found.may_be_more);
                    assert_eq!(found.worlds.len(), alike - 1, "{} {graph:?}", marker.name());
                    compared += found.worlds.len();
                }
            }
        }
        assert!(compared > 0);
    }
}
