//! One run of an explorer that is another program, from one start, and its judgement.

use toposlam_model::{
    aid::Action,
    aid::AidKind,
    ambiguity::Comparison,
    check::{determines_world, judge_map},
    embedded_graph::{Dart, EmbeddedGraph},
    isomorphism::Candidate,
    mapping::{ExploredMap, Flaw},
    percept::Door,
    world::GraphWorld,
};

use super::{
    ExplorerLimits,
    fault::ExplorerFault,
    process::ExplorerProcess,
    protocol::{ExplorerAnswer, ReportedMap, percept_line},
};

/// A start, with the length of its certificate if the marker is directional.
#[derive(Clone, Copy)]
pub(in crate::cli) struct ExplorerStart<'g> {
    pub(in crate::cli) graph: &'g EmbeddedGraph,
    pub(in crate::cli) facing: Dart,
    pub(in crate::cli) marker: AidKind,
    pub(in crate::cli) certificate: Option<u64>,
}

pub(in crate::cli) struct EndedRun {
    pub(in crate::cli) moves: u64,
    pub(in crate::cli) actions: Vec<Action>,
    /// The map that was returned, if it is an embedded graph.
    pub(in crate::cli) map: Option<ExploredMap<'static>>,
    /// Whether the map and the pose are right.
    pub(in crate::cli) result: Result<(), ExplorerFault>,
}

impl ExplorerStart<'_> {
    /// Runs the explorer and judges its answer. `None` if the check is to stop.
    pub(in crate::cli) fn run(
        &self,
        process: &mut ExplorerProcess,
        limits: ExplorerLimits,
        candidate: &mut Candidate,
    ) -> Option<EndedRun> {
        let mut world = GraphWorld::with_aid(self.graph, self.marker, self.facing);
        let mut actions = Vec::new();
        let mut map = None;
        let result = loop {
            let line = process.ask(percept_line(world.sensed()), limits.timeout)?;
            let action = match line.and_then(|line| ExplorerAnswer::from_line(&line)) {
                Ok(ExplorerAnswer::Act(action)) => action,
                Ok(ExplorerAnswer::Done(reported)) => match reported.explored() {
                    Ok(explored) => {
                        let map = map.insert(explored);
                        break self.judge((&reported, map), &world, &actions, candidate);
                    }
                    Err(fault) => break Err(fault),
                },
                Ok(ExplorerAnswer::GiveUp(reason)) => break Err(ExplorerFault::GaveUp { reason }),
                Err(fault) => break Err(fault),
            };
            if actions.len() as u64 == limits.moves {
                break Err(ExplorerFault::OutOfMoves { limit: limits.moves });
            }
            actions.push(action);
            if let Err(refused) = world.act(action) {
                break Err(ExplorerFault::RefusedAction { refused });
            }
        };
        Some(EndedRun { moves: world.moves(), actions, map, result })
    }

    /// Judges the map and the robot's pose in it, after these actions.
    fn judge(
        &self,
        (reported, map): (&ReportedMap, &ExploredMap),
        world: &GraphWorld<AidKind>,
        actions: &[Action],
        candidate: &mut Candidate,
    ) -> Result<(), ExplorerFault> {
        let Self { graph, facing, .. } = *self;
        match judge_map(map, (graph, facing), world.pose(), candidate) {
            Ok(_) => {}
            Err(Flaw::WrongPose { truly, .. }) => {
                let bijection = candidate.of_starts((&map.graph, map.facing), (graph, facing));
                let at = bijection.images().iter().position(|&image| image == truly);
                return Err(ExplorerFault::WrongPose {
                    believed: reported.pose_text(),
                    truly: reported.dart_name(Dart(at.unwrap_or_default() as u32)),
                });
            }
            Err(_) => {
                let difference = self.difference((&map.graph, map.facing));
                return Err(ExplorerFault::WrongMap { difference });
            }
        }
        match determines_world((graph, facing), self.marker, &doors_of(actions)) {
            Some(false) => Err(ExplorerFault::Guessed),
            Some(true) | None => Ok(()),
        }
    }

    /// A shortest walk with different percepts in a map and in the world, in words.
    fn difference(&self, (map, start): (&EmbeddedGraph, Dart)) -> String {
        const MOST_DARTS: usize = 2000;
        if map.dart_count().max(self.graph.dart_count()) > MOST_DARTS {
            return String::new();
        }
        let comparison = Comparison::new(self.marker, (map, start), (self.graph, self.facing));
        let Some(walk) = comparison.walk([start, self.facing]) else {
            return "; with this marker, no walk distinguishes them".to_owned();
        };
        let actions: Vec<_> = walk.actions.iter().map(ToString::to_string).collect();
        let [there, here] = walk.percepts;
        let after = match actions[..] {
            [] => "at the start".to_owned(),
            _ => format!("from the start by {}", actions.join(" ")),
        };
        format!("; {after}, the map has {there}, and the world {here}")
    }
}

/// The doors that were taken.
pub(super) fn doors_of(actions: &[Action]) -> Vec<Door> {
    actions.iter().filter_map(|action| action.door()).collect()
}
