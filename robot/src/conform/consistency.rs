//! What the events of a log contradict by themselves, and what is false in how it says that its run ended.

use toposlam_model::{
    driving::visit::JunctionShape,
    trace::{Followed, Reached, Trace},
};

use super::{
    divergence::{DivergenceCause, OFF},
    events::{CheckedKind, RunEvents},
    known_world::KnownWorld,
};
use crate::record::{Arrival, MapRecord, RunEnding};

impl RunEvents {
    /// What each event contradicts by itself, in order.
    pub(super) fn own_faults(&self) -> Vec<(usize, DivergenceCause)> {
        let mut faults = Vec::new();
        let mut moves = 0;
        for (place, event) in self.events.iter().enumerate() {
            let mut fault = |cause| faults.push((place, cause));
            match &event.kind {
                CheckedKind::Arrival { arrival, entry_off } => {
                    let Arrival { percept, number, form, .. } = arrival;
                    if let Some(told) = number.filter(|&told| told != moves) {
                        fault(DivergenceCause::Number { expected: moves, told });
                    }
                    let doors = form.map_or(percept.degree, JunctionShape::degree);
                    if doors != percept.degree {
                        fault(DivergenceCause::Form { degree: percept.degree, doors });
                    }
                    if let Some(off) = entry_off.filter(|&off| off > OFF) {
                        fault(DivergenceCause::Entry { off });
                    }
                }
                CheckedKind::Door { number, off, .. } => {
                    moves += 1;
                    if let Some(told) = number.filter(|&told| told != moves) {
                        fault(DivergenceCause::Number { expected: moves, told });
                    }
                    // Where a robot went aside, an event of its own says so.
                    let own = self.events.get(place + 1).map(|event| &event.kind);
                    let told = matches!(own, Some(CheckedKind::Aside { .. }));
                    if let Some(off) = off.filter(|&off| off > OFF && !told) {
                        fault(DivergenceCause::Aside { off });
                    }
                }
                CheckedKind::Aside { off } => fault(DivergenceCause::Aside { off: *off }),
                CheckedKind::TurnedBack => fault(DivergenceCause::TurnedBack),
                CheckedKind::Undecided => fault(DivergenceCause::Undecided),
            }
        }
        faults
    }

    /// What is false in how the log says that the run ended, given what Algorithm 1 makes of it.
    pub(super) fn false_ending(
        &self,
        followed: &Followed,
        known: Option<&KnownWorld>,
    ) -> Vec<DivergenceCause> {
        let map = followed.exploration.map();
        let mapped = self.is_said_whole();
        let mut faults = Vec::new();
        match (&followed.reached, map.complete()) {
            (Reached::EndOfTrace, _) if mapped => {
                faults.push(DivergenceCause::Unfinished { unexplored: map.unexplored_count() });
            }
            (Reached::Mapped, Some(graph)) => {
                let found = MapRecord::of(followed.exploration.journey());
                if self.map.as_ref().is_some_and(|recorded| !recorded.same_map(&found)) {
                    faults.push(DivergenceCause::Map);
                }
                if known.is_some_and(|known| !known.has(graph)) {
                    faults.push(DivergenceCause::WrongMap);
                }
            }
            _ => {}
        }
        faults
    }

    /// Whether the log says that the map was complete at its end.
    pub(super) fn is_said_whole(&self) -> bool {
        self.end.as_ref().is_some_and(|end| end.ending == RunEnding::Mapped)
    }

    /// Whether the log says another number of moves than it has.
    pub(super) fn false_moves(&self, trace: &Trace) -> Option<DivergenceCause> {
        let made = trace.percepts().len() - 1;
        let told = self.end.as_ref()?.moves;
        (made as u64 != told).then_some(DivergenceCause::Moves { made, told })
    }

    /// Whether this is all of a run; of one that Algorithm 1 drives, to its end.
    pub(super) fn is_whole(&self, driven: bool) -> bool {
        let ended = match &self.end {
            Some(_) => self.is_said_whole() || !driven,
            // Logs of other programs have neither a head nor an end.
            None => !self.has_head,
        };
        ended && !self.truncated
    }
}
