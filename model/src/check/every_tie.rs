//! The folding explorer with every way to break its ties.

use super::{ChoicesLimit, Costs, EveryWay, Flaw, Folding, judge};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Watch,
    isomorphism::Candidate,
    mapping::FoldingExploration,
    world::GraphWorld,
};

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
