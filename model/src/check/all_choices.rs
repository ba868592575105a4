//! An algorithm with the default choices, and then with every other choice that it leaves open.
//! Section 2.3.

use super::{Algorithm, CostOrder, EveryWay, Flaw, Folding, OpenChoices, every_tie, every_way};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Watch,
    mapping::{MappingError, Observer},
    world::{GraphWorld, RefusedAction},
};

/// The default number of states of one start that may be explored.
pub const DEFAULT_STATE_BUDGET: u64 = 1_000_000;

/// An algorithm whose runs with other than the default choices can be enumerated.
pub trait EveryRun: Algorithm {
    /// Makes and judges every run of a start, but explores at most `budget` states.
    ///
    /// # Errors
    /// Returns the first [`Flaw`].
    fn every_run(
        &self,
        graph: &EmbeddedGraph,
        facing: Dart,
        budget: u64,
        watch: &dyn Watch,
    ) -> Result<EveryWay, Flaw>;
}

impl<A: OpenChoices> EveryRun for A {
    fn every_run(
        &self,
        graph: &EmbeddedGraph,
        facing: Dart,
        budget: u64,
        watch: &dyn Watch,
    ) -> Result<EveryWay, Flaw> {
        every_way(self, graph, facing, budget, watch)
    }
}

impl EveryRun for Folding {
    fn every_run(
        &self,
        graph: &EmbeddedGraph,
        facing: Dart,
        budget: u64,
        watch: &dyn Watch,
    ) -> Result<EveryWay, Flaw> {
        every_tie(graph, facing, budget, watch)
    }
}

/// An algorithm with the default choices, and then with all choices.
#[derive(Clone, Copy, Debug)]
pub struct AllChoices<A> {
    /// The algorithm.
    pub algorithm: A,
    /// The number of states of one start that may be explored.
    pub budget: u64,
}

impl<A: EveryRun> Algorithm for AllChoices<A> {
    type Marker = A::Marker;
    type State = A::State;

    fn name(&self) -> &'static str {
        self.algorithm.name()
    }

    fn order(&self) -> CostOrder {
        self.algorithm.order()
    }

    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        self.algorithm.move_bound(edges, vertices)
    }

    fn run<'g>(
        &self,
        world: &mut GraphWorld<'g, A::Marker>,
        state: &mut A::State,
        observer: &mut impl Observer<GraphWorld<'g, A::Marker>>,
    ) -> Result<(), MappingError<RefusedAction>> {
        self.algorithm.run(world, state, observer)
    }

    fn other_runs(
        &self,
        graph: &EmbeddedGraph,
        facing: Dart,
        watch: &dyn Watch,
    ) -> Result<Option<EveryWay>, Flaw> {
        self.algorithm.every_run(graph, facing, self.budget, watch).map(Some)
    }
}
