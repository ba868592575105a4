//! The folding explorer with every way to break its ties.

use super::{Algorithm, ChoicesLimit, CostOrder, Costs, EveryWay, Flaw, Folding, judge};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Watch,
    isomorphism::Candidate,
    mapping::{FoldingExploration, MappingError, Observer},
    marker::Directional,
    world::{GraphWorld, Refused},
};

/// The folding explorer, and then its runs in which ties are broken in another way.
#[derive(Clone, Copy, Debug)]
pub struct AllTies {
    /// The number of states of one start that may be explored.
    pub budget: u64,
}

impl Algorithm for AllTies {
    type Marker = Directional;
    type State = FoldingExploration;

    fn name(&self) -> &'static str {
        Folding.name()
    }

    fn order(&self) -> CostOrder {
        Folding.order()
    }

    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        Folding.move_bound(edges, vertices)
    }

    fn run<'g>(
        &self,
        world: &mut GraphWorld<'g>,
        exploration: &mut FoldingExploration,
        observer: &mut impl Observer<GraphWorld<'g>>,
    ) -> Result<(), MappingError<Refused>> {
        Folding.run(world, exploration, observer)
    }

    fn other_runs(
        &self,
        graph: &EmbeddedGraph,
        facing: Dart,
        watch: &dyn Watch,
    ) -> Result<Option<EveryWay>, Flaw> {
        every_tie(graph, facing, self.budget, watch).map(Some)
    }
}

/// Runs the folding explorer on a start with every way to break its ties, and judges the end of every
/// run. States are not compared: two runs that come to the same state are both followed.
///
/// # Errors
/// Returns the first [`Flaw`].
pub fn every_tie(
    graph: &EmbeddedGraph,
    facing: Dart,
    budget: u64,
    watch: &dyn Watch,
) -> Result<EveryWay, Flaw> {
    let mut world = GraphWorld::new(graph, facing);
    let mut exploration = FoldingExploration::new(graph.dart_count());
    exploration.begin(&mut world, &mut ())?;
    let mut found =
        EveryWay { states: 0, within_rounds: 0, runs: 0, costs: Costs::default(), limit: None };
    let mut candidate = Candidate::default();
    // The stack is explicit: it is as deep as the run has steps.
    let mut stack = vec![(world, exploration)];
    while let Some((world, mut exploration)) = stack.pop() {
        found.limit = if watch.stop() {
            Some(ChoicesLimit::Interrupted)
        } else {
            (found.states >= budget).then_some(ChoicesLimit::States(budget))
        };
        if found.limit.is_some() {
            break;
        }
        found.states += 1;
        let steps = exploration.open_steps();
        if steps.is_empty() {
            judge(&Folding, &exploration, facing, &world, &mut candidate)?;
            found.runs += 1;
            found.costs.include(&Costs::nothing(), exploration.moves());
        }
        for &step in steps.iter().rev() {
            let (mut world, mut exploration) = (world.clone(), exploration.clone());
            exploration.make_step(step, &mut world, &mut ())?;
            stack.push((world, exploration));
        }
    }
    Ok(found)
}
