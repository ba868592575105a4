//! The mapping algorithms that a sweep checks. Section 2.3.

use std::fmt;

use super::{EveryWay, Flaw};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Watch,
    mapping::{
        Exploration, FoldingExploration, Journey, MappingChoice, MappingError, MarkerSearch,
        Nearest, Observer, map_by_folding, map_with_movable_marker, map_world, step,
    },
    marker::{Directional, Marker, Movable},
    world::{GraphWorld, RefusedAction},
};

/// A mapping algorithm of this crate, or a variant of one. For any other algorithm implement
/// [`Explorer`](super::Explorer).
pub trait Algorithm: Sync {
    /// The marker with which it maps.
    type Marker: Marker + Clone + Default;

    /// The state of a run.
    type State: RunState;

    /// Its name in reports.
    fn name(&self) -> &'static str;

    /// The order of its cost.
    fn order(&self) -> CostOrder;

    /// The most moves that it may make in a world of this size.
    fn move_bound(&self, edges: usize, vertices: usize) -> u64;

    /// Maps a world, with the default choices. Afterwards the state holds the map, the pose and the
    /// moves.
    ///
    /// # Errors
    /// Returns the errors of the algorithm.
    fn run<'g>(
        &self,
        world: &mut GraphWorld<'g, Self::Marker>,
        state: &mut Self::State,
        observer: &mut impl Observer<GraphWorld<'g, Self::Marker>>,
    ) -> Result<(), MappingError<RefusedAction>>;

    /// Makes and judges the other runs of a start. There are some with [`AllChoices`](super::AllChoices)
    /// only.
    ///
    /// # Errors
    /// Returns the first [`Flaw`].
    fn other_runs(
        &self,
        _graph: &EmbeddedGraph,
        _facing: Dart,
        _watch: &dyn Watch,
    ) -> Result<Option<EveryWay>, Flaw> {
        Ok(None)
    }
}

/// The state of a run. Memory is reused from run to run.
pub trait RunState: Clone {
    /// A state ready for a run that may come to know at most `bound` darts.
    fn new(bound: usize) -> Self;

    /// Changes how many darts later runs may come to know.
    fn set_bound(&mut self, bound: usize);

    /// Forgets an earlier run.
    fn clear(&mut self);

    /// The robot's map, its pose in the map and its moves.
    fn journey(&self) -> &Journey;
}

macro_rules! run_state {
    ($state:ty) => {
        impl RunState for $state {
            fn new(bound: usize) -> Self {
                Self::new(bound)
            }

            fn set_bound(&mut self, bound: usize) {
                self.set_bound(bound);
            }

            fn clear(&mut self) {
                self.clear();
            }

            fn journey(&self) -> &Journey {
                self.journey()
            }
        }
    };
}
run_state!(Exploration);
run_state!(MarkerSearch);
run_state!(FoldingExploration);

/// The order of a cost in the numbers of edges, `m`, and vertices, `n`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CostOrder {
    /// `m n`.
    EdgesVertices,
    /// `m^2 n`.
    EdgesSquaredVertices,
}

impl CostOrder {
    /// Its value for a world of this size.
    #[must_use]
    pub fn of(self, edges: f64, vertices: f64) -> f64 {
        match self {
            Self::EdgesVertices => edges * vertices,
            Self::EdgesSquaredVertices => edges * edges * vertices,
        }
    }
}

impl fmt::Display for CostOrder {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        out.write_str(match self {
            Self::EdgesVertices => "m n",
            Self::EdgesSquaredVertices => "m^2 n",
        })
    }
}

/// Algorithm 1, or a variant of it, whose open choices can be enumerated.
pub trait OpenChoices: Algorithm<Marker = Directional, State = Exploration> {
    /// One step of it, from one choice to the next.
    ///
    /// # Errors
    /// Returns the errors of [`step`].
    fn step<'g>(
        &self,
        exploration: &mut Exploration,
        choice: MappingChoice,
        world: &mut GraphWorld<'g>,
        observer: &mut impl Observer<GraphWorld<'g>>,
    ) -> Result<(), MappingError<RefusedAction>> {
        step(exploration, choice, world, observer)
    }
}

/// Algorithm 1 with the default choices.
#[derive(Clone, Copy, Debug, Default)]
pub struct Algorithm1;

impl Algorithm for Algorithm1 {
    type Marker = Directional;
    type State = Exploration;

    fn name(&self) -> &'static str {
        "Algorithm 1"
    }

    fn order(&self) -> CostOrder {
        CostOrder::EdgesSquaredVertices
    }

    /// `m n + 2 m^2 (n - 1)`.
    // paper: cost.bound
    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        let (m, n) = (edges as u64, vertices as u64);
        let paths = m.saturating_mul(m).saturating_mul(n.saturating_sub(1).saturating_mul(2));
        m.saturating_mul(n).saturating_add(paths)
    }

    #[inline]
    fn run<'g>(
        &self,
        world: &mut GraphWorld<'g>,
        exploration: &mut Exploration,
        observer: &mut impl Observer<GraphWorld<'g>>,
    ) -> Result<(), MappingError<RefusedAction>> {
        map_world(world, &mut Nearest, exploration, observer)
    }
}

impl OpenChoices for Algorithm1 {}

/// The movable marker algorithm with the default choices, for worlds without loops and parallel
/// edges.
#[derive(Clone, Copy, Debug, Default)]
pub struct MovableMarker;

impl Algorithm for MovableMarker {
    type Marker = Movable;
    type State = MarkerSearch;

    fn name(&self) -> &'static str {
        "Place and back-link validation"
    }

    fn order(&self) -> CostOrder {
        CostOrder::EdgesVertices
    }

    /// `3 n (n - 1) / 2 + (m - n + 1) (6 n - 7)`, which is less than `6 m n`.
    ///
    /// Each of the m edges is explored once, and the world is simple. Let `k` vertices be known. The
    /// robot goes to the known end and over the edge: at most `k` moves. A search goes back over the
    /// edge, along no more than a closed depth-first walk of a tree of the `k` vertices, and so takes
    /// at most `1 + 2 (k - 1)` moves until the robot is at the known end again, whether the marker
    /// was found on the way or not.
    ///
    /// * The place is new: once more over the edge. That is at most `3 k` moves, and happens once for
    ///   each `k` from 1 to `n - 1`: `3 n (n - 1) / 2`.
    /// * It is known, `m - n + 1` times: the robot carries the marker to the known end, which ends
    ///   the closed walk, and returns to the place in at most `n - 1` moves. The place has at least
    ///   one explored dart, and is neither the known end nor joined to it by another edge; so the
    ///   darts to try lead to at most `n - 2` vertices, one of them the known end. The last costs a
    ///   move, each before it two: at most `2 (n - 2) - 1`. That is
    ///   `n + 1 + 2 (n - 1) + (n - 1) + 2 (n - 2) - 1 = 6 n - 7` together.
    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        let (m, n) = (edges as u64, vertices as u64);
        let new = n.saturating_mul(n.saturating_sub(1)).saturating_mul(3) / 2;
        let loops = (m + 1).saturating_sub(n);
        new.saturating_add(loops.saturating_mul(n.saturating_mul(6).saturating_sub(7)))
    }

    #[inline]
    fn run<'g>(
        &self,
        world: &mut GraphWorld<'g, Movable>,
        search: &mut MarkerSearch,
        observer: &mut impl Observer<GraphWorld<'g, Movable>>,
    ) -> Result<(), MappingError<RefusedAction>> {
        map_with_movable_marker(world, &mut Nearest, search, observer)
    }
}

/// The folding explorer.
#[derive(Clone, Copy, Debug, Default)]
pub struct Folding;

impl Algorithm for Folding {
    type Marker = Directional;
    type State = FoldingExploration;

    fn name(&self) -> &'static str {
        "Folding explorer"
    }

    fn order(&self) -> CostOrder {
        CostOrder::EdgesSquaredVertices
    }

    /// `4 n m^2 + 4 n m + 400`.
    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        let (m, n) = (edges as u64, vertices as u64);
        let nm = n.saturating_mul(m);
        nm.saturating_mul(m).saturating_add(nm).saturating_mul(4).saturating_add(400)
    }

    #[inline]
    fn run<'g>(
        &self,
        world: &mut GraphWorld<'g>,
        exploration: &mut FoldingExploration,
        observer: &mut impl Observer<GraphWorld<'g>>,
    ) -> Result<(), MappingError<RefusedAction>> {
        map_by_folding(world, exploration, observer)
    }
}
