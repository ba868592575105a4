//! Judges any explorer: an algorithm that walks through a world and returns a map of it.

use super::{
    Algorithm, ExploredMap, Flaw, RunState,
    judge::{explored, judge_map},
};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    isomorphism::Candidate,
    marker::{Directional, Marker},
    percept::{Door, Percept},
    world::{GraphWorld, MovableMarkerWorld, RefusedAction, World},
};

/// An explorer: an algorithm that walks through a world and returns a map of it.
///
/// It is judged by [`judge_start`] on one start and by [`Sweep::run_explorers`](super::Sweep::run_explorers)
/// on every start of every world of a size. An explorer may keep memory from run to run.
pub trait Explorer {
    /// The kind of marker with which it explores.
    type Marker: Marker;

    /// The marker with which it explores.
    fn marker(&self) -> Self::Marker;

    /// Explores a world. At its start the robot stands where the marker is placed, with its back to
    /// the facing door.
    ///
    /// # Errors
    /// Returns the explorer's own failure, as [`Flaw::GaveUp`], or the world's refusal of a move.
    fn explore(&mut self, world: &mut ExplorerWorld<Self::Marker>)
    -> Result<ExploredMap<'_>, Flaw>;

    /// The most moves that it may make in a world of this size. Further moves are refused.
    fn move_bound(&self, _edges: usize, _vertices: usize) -> u64 {
        DEFAULT_MOVE_BOUND
    }
}

/// How many moves an explorer may make if it states no bound.
pub const DEFAULT_MOVE_BOUND: u64 = 1_000_000;

/// The world that an explorer gets: it can be sensed and moved in, and nothing else. It counts the
/// moves.
#[derive(Debug)]
pub struct ExplorerWorld<'g, M = Directional> {
    world: GraphWorld<'g, M>,
    bound: u64,
}

impl<'g, M: Marker> ExplorerWorld<'g, M> {
    /// The world of a start, in which `bound` moves are possible.
    fn new(graph: &'g EmbeddedGraph, marker: M, facing: Dart, bound: u64) -> Self {
        Self { world: GraphWorld::with_marker(graph, marker, facing), bound }
    }

    /// The moves made so far.
    #[must_use]
    pub fn moves(&self) -> u64 {
        self.world.moves()
    }

    /// The number of darts of the world. It is a bound for an explorer's memory, and nothing that the
    /// explorer may know.
    pub(super) fn dart_count(&self) -> usize {
        self.world.graph().dart_count()
    }
}

impl<M: Marker> World for ExplorerWorld<'_, M> {
    type Error = RefusedAction;

    fn percept(&mut self) -> Result<Percept, RefusedAction> {
        self.world.percept()
    }

    fn traverse(&mut self, door: Door) -> Result<(), RefusedAction> {
        if self.world.moves() >= self.bound {
            return Err(RefusedAction::OutOfMoves { bound: self.bound });
        }
        self.world.traverse(door)
    }
}

impl<M: Marker> MovableMarkerWorld for ExplorerWorld<'_, M> {
    fn pick_up(&mut self) -> Result<(), RefusedAction> {
        self.world.pick_up()
    }

    fn drop(&mut self) -> Result<(), RefusedAction> {
        MovableMarkerWorld::drop(&mut self.world)
    }
}

/// Runs an explorer on a start and judges it: the map is isomorphic to the world as a start, the
/// robot's pose is what the explorer believes, and the moves are within its bound. Returns the moves
/// made, and the flaw if there is one.
pub fn judge_start<E: Explorer + ?Sized>(
    explorer: &mut E,
    graph: &EmbeddedGraph,
    facing: Dart,
    candidate: &mut Candidate,
) -> (u64, Result<(), Flaw>) {
    let bound = explorer.move_bound(graph.edge_count(), graph.vertex_count());
    let mut world = ExplorerWorld::new(graph, explorer.marker(), facing, bound);
    let explored = explorer.explore(&mut world);
    let (moves, truly) = (world.moves(), world.world.pose());
    let judged = explored.and_then(|map| {
        judge_map(&map, (graph, facing), truly, candidate)?;
        if moves > bound { Err(Flaw::TooManyMoves { moves, bound }) } else { Ok(()) }
    });
    (moves, judged)
}

/// An [`Algorithm`] as an explorer, with the memory of its runs.
#[derive(Debug)]
pub struct AlgorithmExplorer<'a, A: Algorithm> {
    algorithm: &'a A,
    pub(super) state: A::State,
}

impl<'a, A: Algorithm> AlgorithmExplorer<'a, A> {
    /// The algorithm, ready to explore.
    #[must_use]
    pub fn new(algorithm: &'a A) -> Self {
        Self { algorithm, state: RunState::new(0) }
    }
}

impl<A: Algorithm> Explorer for AlgorithmExplorer<'_, A> {
    type Marker = A::Marker;

    fn marker(&self) -> A::Marker {
        A::Marker::default()
    }

    #[inline]
    fn explore(&mut self, world: &mut ExplorerWorld<A::Marker>) -> Result<ExploredMap<'_>, Flaw> {
        // No true map has more darts than the world.
        self.state.set_bound(world.world.graph().dart_count());
        self.state.clear();
        self.algorithm.run(&mut world.world, &mut self.state, &mut ())?;
        explored(&self.state)
    }

    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        self.algorithm.move_bound(edges, vertices)
    }
}
