//! Judges a finished run. Section 2.1 (the map is isomorphic to the world), Section 2.3.

use std::{borrow::Cow, fmt};

use super::{Algorithm, Flaw, RunState};
use crate::{
    counts::counted,
    embedded_graph::{Dart, EmbeddedGraph},
    isomorphism::{Bijection, Candidate},
    mapping::{FACING, Journey, MappingEvent, PartialMap},
    world::GraphWorld,
};

/// What an explorer returns: a map, and the robot's pose in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExploredMap<'a> {
    /// The map.
    pub graph: Cow<'a, EmbeddedGraph>,
    /// The dart of the map that is the facing dart.
    pub facing: Dart,
    /// The dart of the map by which the robot has come in.
    pub pose: Dart,
}

impl ExploredMap<'_> {
    /// A map from its two permutations of the darts `0 .. 2m`: the other end of each dart's edge, and
    /// the next dart clockwise around its vertex. `facing` and `pose` are darts in that numbering.
    ///
    /// # Errors
    /// Returns an error if they are not the permutations of a connected graph, or a dart is missing.
    pub fn from_permutations(
        opposite: &[u32],
        clockwise: &[u32],
        facing: u32,
        pose: u32,
    ) -> Result<Self, Flaw> {
        let (graph, number) = EmbeddedGraph::from_permutations(opposite, clockwise)?;
        let dart = |dart: u32| number.get(dart as usize).copied().ok_or(Flaw::NoSuchDart { dart });
        let (facing, pose) = (dart(facing)?, dart(pose)?);
        Ok(Self { graph: Cow::Owned(graph), facing, pose })
    }

    /// A map from what is at the other end of each dart: for each vertex, and for each of its darts clockwise, a
    /// vertex and the index of a dart there. The facing dart is the first one of the first vertex. `pose` is the dart
    /// by which the robot has come in.
    ///
    /// # Errors
    /// Returns an error if an end is not known, if they are not those of a connected graph, or if there is no dart
    /// `pose`.
    pub fn from_far_ends(
        far: &[Vec<Option<(usize, u32)>>],
        pose: (usize, u32),
    ) -> Result<Self, Flaw> {
        let unexplored = far.iter().flatten().filter(|end| end.is_none()).count() as u32;
        if unexplored > 0 {
            return Err(Flaw::Unfinished { unexplored });
        }
        let mut first = Vec::with_capacity(far.len());
        let (mut dart_count, mut clockwise) = (0, Vec::new());
        for ends in far {
            let degree = ends.len() as u32;
            first.push(dart_count);
            clockwise.extend((0..degree).map(|index| dart_count + (index + 1) % degree));
            dart_count += degree;
        }
        // The number of a dart; no dart has the largest number.
        let number = |(vertex, index): (usize, u32)| match (first.get(vertex), far.get(vertex)) {
            (Some(first), Some(ends)) if (index as usize) < ends.len() => first + index,
            _ => u32::MAX,
        };
        let opposite: Vec<_> = far.iter().flatten().flatten().map(|&end| number(end)).collect();
        Self::from_permutations(&opposite, &clockwise, 0, number(pose))
    }
}

/// The map of a finished run.
pub(super) fn explored(state: &impl RunState) -> Result<ExploredMap<'_>, Flaw> {
    let journey = state.journey();
    let unexplored = journey.map().unexplored_count();
    let graph = journey.map().complete().ok_or(Flaw::Unfinished { unexplored })?;
    Ok(ExploredMap { graph: Cow::Borrowed(graph), facing: FACING, pose: journey.robot() })
}

/// Judges a finished run: the map is isomorphic to the world as a start, by a bijection that is
/// verified and returned; the robot's pose is what it believes; the moves are within the bound.
///
/// # Errors
/// Returns the first [`Flaw`].
// paper: alg1.isomorphic
pub fn judge<'c, A: Algorithm>(
    algorithm: &A,
    state: &A::State,
    facing: Dart,
    world: &GraphWorld<A::Marker>,
    candidate: &'c mut Candidate,
) -> Result<&'c Bijection, Flaw> {
    let graph = world.graph();
    let bijection = judge_map(&explored(state)?, (graph, facing), world.pose(), candidate)?;
    let bound = algorithm.move_bound(graph.edge_count(), graph.vertex_count());
    let moves = state.journey().moves();
    if moves > bound {
        return Err(Flaw::TooManyMoves { moves, bound });
    }
    Ok(bijection)
}

/// Judges a map: it is isomorphic to the world as a start, by a bijection that is verified and
/// returned, and the robot's pose in the world, `truly`, is what it believes.
///
/// # Errors
/// Returns what is wrong.
pub fn judge_map<'c>(
    map: &ExploredMap,
    (graph, facing): (&EmbeddedGraph, Dart),
    truly: Dart,
    candidate: &'c mut Candidate,
) -> Result<&'c Bijection, Flaw> {
    let dart_count = map.graph.dart_count();
    if let Some(dart) = [map.facing, map.pose].into_iter().find(|dart| dart.at() >= dart_count) {
        return Err(Flaw::NoSuchDart { dart: dart.0 });
    }
    let bijection = candidate.of_starts((&map.graph, map.facing), (graph, facing));
    if !bijection.verify(&map.graph, graph) {
        return Err(Flaw::WrongMap);
    }
    let image = bijection.images()[map.pose.at()];
    if image != truly {
        return Err(Flaw::WrongPose { believed: map.pose, image, truly });
    }
    Ok(bijection)
}

/// The first addition to the map that is not true of the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FalseStep {
    /// The moves made by then.
    pub moves: u64,
    /// What was added.
    pub added: MappingEvent,
}

impl fmt::Display for FalseStep {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let Self { moves, added } = self;
        write!(out, "after {} ", counted(*moves as usize, "move"))?;
        match added {
            MappingEvent::LoopClosed { edge, other } => {
                write!(out, "the map's darts {} and {} are wrongly made one edge", edge.0, other.0)
            }
            MappingEvent::VertexAdded { edge, vertex } => write!(
                out,
                "vertex v{} is wrongly added behind the map's dart {}",
                vertex.0, edge.0
            ),
            _ => write!(out, "the map is wrong"),
        }
    }
}

/// Runs an algorithm on a start, and returns the first step after which the map does not embed in the
/// world; `None` if it always does.
pub fn first_false_step<A: Algorithm>(
    algorithm: &A,
    graph: &EmbeddedGraph,
    facing: Dart,
    state: &mut A::State,
) -> Option<FalseStep> {
    let mut first = None;
    let mut watch = |_: &mut GraphWorld<A::Marker>, journey: &Journey, added: MappingEvent| {
        let adds =
            matches!(added, MappingEvent::LoopClosed { .. } | MappingEvent::VertexAdded { .. });
        if adds && first.is_none() && !embeds(journey.map(), graph, facing) {
            first = Some(FalseStep { moves: journey.moves(), added });
        }
    };
    // An error at its end does not matter here.
    let mut world = GraphWorld::with_marker(graph, A::Marker::default(), facing);
    let _ = algorithm.run(&mut world, state, &mut watch);
    first
}

/// Whether the known map embeds in the world, start to start: dart for dart, orders kept, no two
/// darts at the same place.
#[must_use]
fn embeds(map: &PartialMap, graph: &EmbeddedGraph, facing: Dart) -> bool {
    let mut image = vec![None; map.dart_count()];
    let mut taken = vec![false; graph.dart_count()];
    for vertex in map.vertices() {
        // A vertex was first entered by its first dart, from a vertex discovered before.
        let mut darts = map.darts_of(vertex);
        let Some(entry) = darts.next() else {
            return false;
        };
        let mut at = if entry == FACING {
            facing
        } else if let Some(dart) = map.opposite(entry).and_then(|dart| image[dart.at()]) {
            graph.opposite(dart)
        } else {
            return false;
        };
        if map.degree(vertex) != graph.degree(graph.vertex(at)) {
            return false;
        }
        for dart in std::iter::once(entry).chain(darts) {
            image[dart.at()] = Some(at);
            if std::mem::replace(&mut taken[at.at()], true) {
                return false;
            }
            at = graph.clockwise(at);
        }
    }
    map.vertices().flat_map(|vertex| map.darts_of(vertex)).all(|dart| match map.opposite(dart) {
        None => true,
        Some(other) => image[other.at()] == image[dart.at()].map(|image| graph.opposite(image)),
    })
}
