//! Contradictions within a log: in single events, and in its end.

use toposlam_logs::record::{Arrival, RunEnding};
use toposlam_model::{
    aid::{Action, AidKind},
    driving::visit::JunctionShape,
    embedded_graph::EmbeddedGraph,
    isomorphism::code,
    mapping::FACING,
    trace::{AlgorithmMatch, MatchEnd, Trace, TraceClaim},
};

use super::{
    divergence::{DivergenceCause, OFF},
    events::{CheckedEvent, CheckedKind, RunEvents},
    known_world::KnownWorld,
};

impl RunEvents {
    /// The contradictions of single events, in order.
    pub(super) fn own_faults(&self) -> Vec<(usize, DivergenceCause)> {
        let mut faults = Vec::new();
        let mut moves = 0;
        for (place, event) in self.events.iter().enumerate() {
            let mut fault = |cause| faults.push((place, cause));
            match &event.kind {
                CheckedKind::Arrival { arrival, entry_off, .. } => {
                    let Arrival { degree, number, shape, .. } = *arrival;
                    if let Some(recorded) = number.filter(|&number| number != moves) {
                        fault(DivergenceCause::Number { expected: moves, recorded });
                    }
                    let doors = shape.map_or(degree, JunctionShape::degree);
                    if doors != degree {
                        fault(DivergenceCause::Form { degree, doors });
                    }
                    if let Some(off) = entry_off.filter(|&off| off > OFF) {
                        fault(DivergenceCause::Entry { off });
                    }
                }
                CheckedKind::Door { number, off, .. } => {
                    moves += 1;
                    if let Some(recorded) = number.filter(|&number| number != moves) {
                        fault(DivergenceCause::Number { expected: moves, recorded });
                    }
                    // An event of its own follows if the robot took no door.
                    let next = self.events.get(place + 1).map(|event| &event.kind);
                    let reported = matches!(next, Some(CheckedKind::LeftBetweenDoors { .. }));
                    if let Some(off) = off.filter(|&off| off > OFF && !reported) {
                        fault(DivergenceCause::LeftBetweenDoors { off });
                    }
                }
                CheckedKind::Action { number, action } => {
                    if let Some(recorded) = number.filter(|&number| number != moves) {
                        fault(DivergenceCause::Number { expected: moves, recorded });
                    }
                    // A robot of a team makes the move.
                    moves += Action::Do(*action).moves() as u32;
                }
                CheckedKind::LeftBetweenDoors { off } => {
                    fault(DivergenceCause::LeftBetweenDoors { off: *off });
                }
                CheckedKind::TurnedBack if !self.may_turn_back => {
                    fault(DivergenceCause::TurnedBack);
                }
                CheckedKind::TurnedBack => {
                    self.false_return(place).into_iter().for_each(fault);
                }
                CheckedKind::Undecided(cause) => fault(DivergenceCause::Undecided(*cause)),
            }
        }
        faults
    }

    /// The contradiction between two percepts of a junction that the robot left, and entered again after it
    /// turned back at this event.
    fn false_return(&self, back: usize) -> Option<DivergenceCause> {
        let degree = |place: usize| Some(self.events.get(place)?.arrival()?.degree);
        let (before, now) = (degree(back.checked_sub(2)?)?, degree(back + 1)?);
        Some(DivergenceCause::Return { before, now })
    }

    /// The contradictions between the recorded end and the algorithm.
    pub(super) fn false_ending(
        &self,
        followed: &AlgorithmMatch,
        (known, aid): (Option<&KnownWorld>, AidKind),
    ) -> Vec<DivergenceCause> {
        let map = followed.run.map();
        let mut faults = Vec::new();
        match (&followed.reached, map.complete()) {
            (MatchEnd::EndOfTrace, _) if self.is_mapped() => {
                faults.push(DivergenceCause::Unfinished { unexplored: map.unexplored_count() });
            }
            (MatchEnd::Mapped, Some(graph)) => {
                let code_of = |graph: &EmbeddedGraph| code(graph, FACING);
                let recorded = self.map.as_ref().map(|map| map.graph().as_ref().map(code_of));
                if recorded.is_some_and(|recorded| recorded != Some(code_of(graph))) {
                    faults.push(DivergenceCause::Map { algorithm: followed.algorithm });
                }
                if known.is_some_and(|known| !known.has(graph, aid)) {
                    faults.push(DivergenceCause::WrongMap);
                }
            }
            _ => {}
        }
        faults
    }

    /// Whether the log records that the map is complete at its end.
    fn is_mapped(&self) -> bool {
        self.end.as_ref().is_some_and(|end| end.ending == RunEnding::Mapped)
    }

    pub(super) fn claim(&self) -> TraceClaim {
        if self.is_mapped() { TraceClaim::Whole } else { TraceClaim::Part }
    }

    /// The recorded number of moves, if it is wrong. The door by which a robot left before it got lost is no move.
    pub(super) fn false_moves(&self, trace: &Trace) -> Option<DivergenceCause> {
        let sent = trace.actions().iter().map(|it| Action::Do(it.action).moves()).sum::<u64>();
        let made = trace.percepts().len() - 1 - trace.lost().len() + sent as usize;
        let recorded = self.end.as_ref()?.moves;
        (made as u64 != recorded).then_some(DivergenceCause::Moves { made, recorded })
    }

    /// Whether the robot left a place in a direction that is none of its doors.
    pub(super) fn has_left_between_doors(&self) -> bool {
        let is_off =
            |event: &CheckedEvent| matches!(event.kind, CheckedKind::LeftBetweenDoors { .. });
        self.events.iter().any(is_off)
    }

    /// Whether the log has the whole run; if an algorithm drives, until its map is complete.
    pub(super) fn is_whole(&self, driven: bool) -> bool {
        let ended = match &self.end {
            Some(_) => self.is_mapped() || !driven,
            // Logs of other programs have neither a head nor an end.
            None => !self.has_head,
        };
        ended && !self.truncated
    }
}
