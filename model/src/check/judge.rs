//! Judges a finished run. Section 2.1 (the map is isomorphic to the world), Section 2.3.

use std::fmt;

use crate::{
    aid::Aid,
    counts::counted,
    embedded_graph::{Dart, EmbeddedGraph},
    isomorphism::{Bijection, Candidate},
    mapping::{
        ExploredMap, Explorer, FACING, Flaw, MapWalk, MappingEvent, Observed, PartialMap, explore,
    },
    world::GraphWorld,
};

/// Judges a finished run: the map is isomorphic to the world as a start, by a bijection that is
/// verified and returned; the robot's pose is what it believes; the moves are within the bound.
///
/// # Errors
/// Returns the first [`Flaw`].
// paper: alg1.isomorphic
pub fn judge<'c, E: Explorer>(
    explorer: &E,
    facing: Dart,
    world: &GraphWorld<impl Aid>,
    candidate: &'c mut Candidate,
) -> Result<&'c Bijection, Flaw> {
    let (graph, moves) = (world.graph(), world.moves());
    let bijection = judge_map(&explorer.explored()?, (graph, facing), world.pose(), candidate)?;
    check_moves(moves, explorer.move_bound(graph.edge_count(), graph.vertex_count()))?;
    Ok(bijection)
}

pub(super) fn check_moves(moves: u64, bound: u64) -> Result<(), Flaw> {
    if moves > bound { Err(Flaw::TooManyMoves { moves, bound }) } else { Ok(()) }
}

/// Runs an explorer on a start with the default choices, and [judges](judge) it. Moves beyond its bound are refused,
/// and no map may have more darts than the world. Returns the moves made, and the flaw if there is one.
pub fn judge_start<E: Explorer>(
    explorer: &mut E,
    graph: &EmbeddedGraph,
    facing: Dart,
    candidate: &mut Candidate,
) -> (u64, Result<(), Flaw>) {
    let mut world = bounded_world(explorer, graph, facing);
    explorer.limit_darts(graph.dart_count());
    let ended = explore(explorer, &mut world).map_err(Flaw::from);
    let judged = ended.and_then(|()| judge(explorer, facing, &world, candidate).map(|_| ()));
    (world.moves(), judged)
}

/// The world of a start, in which an explorer can make as many moves as its bound allows.
fn bounded_world<'g, E: Explorer>(
    explorer: &E,
    graph: &'g EmbeddedGraph,
    facing: Dart,
) -> GraphWorld<'g, E::Aid> {
    let bound = explorer.move_bound(graph.edge_count(), graph.vertex_count());
    GraphWorld::with_aid(graph, explorer.aid(), facing).with_bound(bound)
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
    pub moves: u64,
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

/// Runs an explorer on a start, and returns the first step after which the map does not embed in the
/// world; `None` if it always does.
pub fn first_false_step<E: Explorer>(
    mut explorer: E,
    graph: &EmbeddedGraph,
    facing: Dart,
) -> Option<FalseStep> {
    let mut first = None;
    let mut watch = |_: &mut GraphWorld<E::Aid>, walk: &MapWalk, added: MappingEvent| {
        let adds =
            matches!(added, MappingEvent::LoopClosed { .. } | MappingEvent::VertexAdded { .. });
        if adds && first.is_none() && !embeds(walk.map(), graph, facing) {
            first = Some(FalseStep { moves: walk.moves(), added });
        }
    };
    let mut world = bounded_world(&explorer, graph, facing);
    // A wrong map can have more darts than the world.
    explorer.limit_darts(2 * graph.dart_count());
    // An error at its end does not matter here.
    let _ = explore(&mut explorer, &mut Observed::new(&mut world, &mut watch));
    first
}

/// Whether the known map embeds in the world, start to start: dart for dart, orders kept, no two
/// darts at the same place.
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
