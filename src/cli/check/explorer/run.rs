//! One run of an explorer that is another program, from one start, and its judgement.

use std::collections::VecDeque;

use toposlam_model::{
    ambiguity::Comparison,
    check::{determines_world, judge_map},
    embedded_graph::{Dart, EmbeddedGraph},
    isomorphism::Candidate,
    mapping::Flaw,
    marker::Marker,
    percept::Door,
    world::{Action, GraphWorld},
};

use super::{
    ExplorerLimits,
    fault::ExplorerFault,
    process::ExplorerProcess,
    protocol::{ExplorerAnswer, ReportedMap, percept_line},
};

/// The last actions that are kept for the report.
const LAST_ACTIONS: usize = 20;

/// A start, with the length of its certificate if the marker is directional.
#[derive(Clone, Copy)]
pub(super) struct ExplorerStart<'g> {
    pub(super) graph: &'g EmbeddedGraph,
    pub(super) facing: Dart,
    pub(super) marker: &'static dyn Marker,
    pub(super) certificate: Option<u64>,
}

pub(super) struct EndedRun {
    pub(super) moves: u64,
    pub(super) actions: Vec<Action>,
    /// Whether the map and the pose are right.
    pub(super) result: Result<(), ExplorerFault>,
}

impl ExplorerStart<'_> {
    /// Runs the explorer and judges its answer. `None` if the check is to stop.
    pub(super) fn run(
        &self,
        process: &mut ExplorerProcess,
        limits: ExplorerLimits,
        candidate: &mut Candidate,
    ) -> Option<EndedRun> {
        let mut world = GraphWorld::with_marker(self.graph, self.marker, self.facing);
        let mut last = VecDeque::with_capacity(LAST_ACTIONS + 1);
        let mut doors = Vec::new();
        let mut count = 0;
        let result = loop {
            let line = process.ask(percept_line(world.sensed()), limits.timeout)?;
            let action = match line.and_then(|line| ExplorerAnswer::from_line(&line)) {
                Ok(ExplorerAnswer::Act(action)) => action,
                Ok(ExplorerAnswer::Done(map)) => break self.judge(&map, &world, &doors, candidate),
                Ok(ExplorerAnswer::GiveUp(reason)) => break Err(ExplorerFault::GaveUp { reason }),
                Err(fault) => break Err(fault),
            };
            if count == limits.moves {
                break Err(ExplorerFault::OutOfMoves { limit: limits.moves });
            }
            count += 1;
            last.push_back(action);
            if last.len() > LAST_ACTIONS {
                last.pop_front();
            }
            if let Err(refused) = world.act(action) {
                break Err(ExplorerFault::RefusedAction { refused });
            }
            if let Action::Take(door) = action {
                doors.push(door);
            }
        };
        Some(EndedRun { moves: world.moves(), actions: last.into(), result })
    }

    /// Judges the map and the robot's pose in it, after a walk through `doors`.
    fn judge(
        &self,
        reported: &ReportedMap,
        world: &GraphWorld<&dyn Marker>,
        doors: &[Door],
        candidate: &mut Candidate,
    ) -> Result<(), ExplorerFault> {
        let map = reported.explored()?;
        let Self { graph, facing, .. } = *self;
        match judge_map(&map, (graph, facing), world.pose(), candidate) {
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
        match determines_world((graph, facing), self.marker, doors) {
            Some(false) => Err(ExplorerFault::Guessed { moves: world.moves() }),
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
