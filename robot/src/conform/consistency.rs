//! What the events of a log contradict by themselves, and what is false in how it says that its run ended.

use toposlam_model::{
    driving::visit::JunctionShape,
    embedded_graph::Dart,
    mapping::PartialMap,
    trace::{Followed, Reached, Trace},
};

use super::{
    divergence::{DivergenceCause, OFF},
    events::{Ending, Events, Kind, Perceived},
    known_world::KnownWorld,
};

impl Events {
    /// What each event contradicts by itself, in order.
    pub(super) fn own_faults(&self) -> Vec<(usize, DivergenceCause)> {
        let mut faults = Vec::new();
        let mut moves = 0;
        for (place, event) in self.events.iter().enumerate() {
            let mut fault = |cause| faults.push((place, cause));
            match &event.kind {
                Kind::Perceived(perceived) => {
                    let Perceived { percept, number, form, entry_off, .. } = perceived;
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
                Kind::Left { number, off, .. } => {
                    moves += 1;
                    if let Some(told) = number.filter(|&told| told != moves) {
                        fault(DivergenceCause::Number { expected: moves, told });
                    }
                    // Where a robot went aside, an event of its own says so.
                    let own = self.events.get(place + 1).map(|event| &event.kind);
                    let told = matches!(own, Some(Kind::Aside { .. }));
                    if let Some(off) = off.filter(|&off| off > OFF && !told) {
                        fault(DivergenceCause::Aside { off });
                    }
                }
                Kind::Aside { off } => fault(DivergenceCause::Aside { off: *off }),
                Kind::TurnedBack => fault(DivergenceCause::TurnedBack),
                Kind::Undecided => fault(DivergenceCause::Undecided),
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
                if self.map.as_ref().is_some_and(|told| *told != in_numbers(map)) {
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
        self.ending.as_ref().is_some_and(Ending::is_mapped)
    }

    /// Whether the log says another number of moves than it has.
    pub(super) fn false_moves(&self, trace: &Trace) -> Option<DivergenceCause> {
        let made = trace.percepts().len() - 1;
        let told = self.ending.as_ref()?.moves;
        (made != told as usize).then_some(DivergenceCause::Moves { made, told })
    }

    /// Whether this is all of a run; of one that Algorithm 1 drives, to its end.
    pub(super) fn is_whole(&self, driven: bool) -> bool {
        let ended = match (&self.head, &self.ending) {
            (_, Some(ending)) => ending.is_mapped() || !driven,
            (Some(_), None) => false,
            // A log of somebody else's does not tell.
            (None, None) => true,
        };
        ended && !self.truncated
    }
}

impl Ending {
    fn is_mapped(&self) -> bool {
        self.ending == "mapped"
    }
}

/// A map as a log tells it.
fn in_numbers(map: &PartialMap) -> (Vec<u32>, Vec<i32>) {
    let degrees = map.vertices().map(|vertex| map.degree(vertex)).collect();
    let opposite = |dart: u32| {
        map.opposite(Dart(dart)).and_then(|other| i32::try_from(other.0).ok()).unwrap_or(-1)
    };
    (degrees, (0..map.dart_count() as u32).map(opposite).collect())
}
