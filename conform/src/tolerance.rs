//! Tolerated divergences: each tolerated event is replaced by the expected one.
//!
//! A run is judged again after a divergence was tolerated. So that a run with many of them is not judged as
//! often, the divergences that can be found without a judgement are tolerated together: contradictions of
//! single events, percepts that do not fit the known world, and percepts that contradict the algorithm's map.

use std::collections::BTreeSet;

use toposlam_model::{
    aid::Places,
    mapping::{Contradiction, MappingMethod},
    percept::Percept,
    trace::{Departure, Misfit, MisfitReason, StepPurpose, match_amended, poses_amended},
};

use super::{
    config::{ConformConfig, RunDriver},
    divergence::{Divergence, DivergenceCause},
    events::{CheckedEvent, RunEvents},
    quirks::Quirks,
};

/// The divergences of a run that are tolerated so far.
pub(super) struct Tolerance<'q> {
    quirks: &'q Quirks,
    config: &'q ConformConfig,
    recorded: RunEvents,
    /// With the expected events in place of the tolerated ones.
    pub(super) amended: RunEvents,
    /// In the order of the events, each with the index of its quirk.
    pub(super) tolerated: Vec<(Divergence, usize)>,
    /// The events that are tolerated, and the names of their causes.
    pub(super) noted: BTreeSet<(usize, &'static str)>,
}

impl<'q> Tolerance<'q> {
    pub(super) fn new(recorded: RunEvents, quirks: &'q Quirks, config: &'q ConformConfig) -> Self {
        let amended = recorded.clone();
        Self { quirks, config, recorded, amended, tolerated: Vec::new(), noted: BTreeSet::new() }
    }

    /// Tolerates the first divergence of these events, and those after it that can be found without
    /// another judgement. `false` if the judgement stands.
    pub(super) fn grows(&mut self, first: Option<&Divergence>) -> bool {
        if self.tolerated.is_empty() && self.quirks.quirks.is_empty() {
            return false;
        }
        // What was tolerated ahead of a judgement and lies after its divergence is not tolerated.
        let last = first.map_or(usize::MAX, |first| first.event);
        let before = self.tolerated.len();
        self.tolerated.retain(|(divergence, _)| divergence.event <= last);
        let too_many = self.tolerated.len() < before;
        if too_many {
            self.amend();
        }
        let Some(divergence) = first else { return too_many };
        let Some(quirk) = self.quirk(divergence) else { return too_many };
        self.tolerated.push((divergence.clone(), quirk));
        self.amend();
        let limit = self.own_faults();
        self.misfits(limit);
        self.amend();
        self.contradictions(limit);
        self.tolerated.sort_by_key(|(divergence, _)| divergence.event);
        self.amend();
        true
    }

    /// The quirk that tolerates a divergence, if it is known how the run continues.
    fn quirk(&self, divergence: &Divergence) -> Option<usize> {
        let quirk = self.quirks.tolerating(divergence)?;
        match &divergence.cause {
            DivergenceCause::World(_) | DivergenceCause::Algorithm(_) => {
                self.amended.events.get(divergence.event)?.arrival()?;
                expected(&divergence.cause).map(|_| quirk)
            }
            // It is skipped. Quirk files have no causes after which it is not known how the run continues.
            _ => Some(quirk),
        }
    }

    /// A divergence with its quirk, if it is tolerated.
    fn tolerable(&self, event: usize, cause: DivergenceCause) -> Option<(Divergence, usize)> {
        let divergence = Divergence { event, fault: cause.fault(), cause };
        let quirk = self.quirk(&divergence)?;
        Some((divergence, quirk))
    }

    /// Replaces the tolerated events by the expected ones.
    fn amend(&mut self) {
        self.amended = self.recorded.clone();
        self.noted.clear();
        for (Divergence { event, cause, .. }, _) in &self.tolerated {
            self.noted.insert((*event, cause.name()));
            let found = self.amended.events.get_mut(*event).and_then(CheckedEvent::arrival_mut);
            if let (Some(Percept { degree, sighting }), Some(arrival)) = (expected(cause), found) {
                (arrival.degree, arrival.sighting) = (degree, Some(sighting));
                // Its shape belongs to the tolerated percept.
                arrival.shape = None;
            }
            self.amended.forget_measurement(cause);
        }
    }

    /// Tolerates the contradictions of single events, and returns the first event with one that is not
    /// tolerated.
    fn own_faults(&mut self) -> usize {
        for (event, cause) in self.amended.own_faults() {
            if self.noted.contains(&(event, cause.name())) {
                continue;
            }
            let Some(tolerated) = self.tolerable(event, cause) else { return event };
            self.tolerated.push(tolerated);
        }
        usize::MAX
    }

    /// Tolerates the percepts before an event that do not fit the known world.
    fn misfits(&mut self, limit: usize) {
        let Some(known) = &self.config.world else { return };
        let Ok(trace) = self.amended.trace() else { return };
        let mut tolerated = Vec::new();
        let amend = |misfit: &Misfit<Places>| {
            let event = Some(misfit.event.id).filter(|&event| event < limit)?;
            tolerated.push(self.tolerable(event, DivergenceCause::World(misfit.clone()))?);
            expected_by(misfit)
        };
        let _ = poses_amended(&known.graph, &self.config.aid, &known.states, &trace, amend);
        self.tolerated.extend(tolerated);
    }

    /// Tolerates the percepts before an event that contradict the algorithm's map.
    fn contradictions(&mut self, limit: usize) {
        let RunDriver::Method(MappingMethod::By { algorithm, audits: 0 }) = self.config.driver
        else {
            return;
        };
        let Ok(trace) = self.amended.trace() else { return };
        let mut tolerated = Vec::new();
        let mut amend = |departure: &Departure| {
            let event = Some(departure.event.id).filter(|&event| event < limit)?;
            tolerated.push(self.tolerable(event, DivergenceCause::Algorithm(departure.clone()))?);
            expected_after(departure)
        };
        let bound = self.config.dart_bound;
        let _ = match_amended(algorithm, &trace, self.amended.claim(), bound, Some(&mut amend));
        self.tolerated.extend(tolerated);
    }
}

/// The percept that is expected in place of one that diverges, if it is known.
fn expected(cause: &DivergenceCause) -> Option<Percept> {
    match cause {
        DivergenceCause::World(misfit) => expected_by(misfit),
        DivergenceCause::Algorithm(departure) => expected_after(departure),
        _ => None,
    }
}

/// The percept that all candidate poses expect.
fn expected_by(misfit: &Misfit<Places>) -> Option<Percept> {
    let mut expected = misfit.candidates.iter().map(|(_, why)| match why {
        MisfitReason::Percept { expected } => Some(*expected),
        MisfitReason::NoSuchDoor { .. } | MisfitReason::Refused(_) => None,
    });
    let first = expected.next()??;
    expected.all(|other| other == Some(first)).then_some(first)
}

/// The percept that the algorithm expects at a known place.
fn expected_after(departure: &Departure) -> Option<Percept> {
    departure.allowed.iter().find_map(|allowed| match allowed.purpose {
        StepPurpose::Contradicted(
            Contradiction::KnownPlace { expected, .. }
            | Contradiction::WayBack { expected, .. }
            | Contradiction::Trail { expected: Some(expected), .. },
        ) => Some(expected),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use toposlam_model::{
        aid::State,
        embedded_graph::Dart,
        percept::Sighting,
        trace::{TraceEvent, TraceEventKind},
    };

    use super::*;

    #[test]
    fn a_percept_is_expected_if_all_candidate_poses_expect_it() {
        let percept = |degree| Percept { degree, sighting: Sighting::Nothing };
        let at = |degree| MisfitReason::Percept { expected: percept(degree) };
        let no_door = MisfitReason::NoSuchDoor { degree: 3 };
        let state = State { pose: Dart(0), placed: Places::from_elem(Some(Dart(0)), 1) };
        let event = TraceEvent { id: 2, kind: TraceEventKind::Percept(percept(5)) };
        for (reasons, expected) in [
            (&[at(3)][..], Some(percept(3))),
            (&[at(3), at(3)], Some(percept(3))),
            (&[at(3), at(4)], None),
            (&[at(3), no_door], None),
            (&[], None),
        ] {
            let candidates = reasons.iter().map(|reason| (state.clone(), *reason)).collect();
            assert_eq!(expected_by(&Misfit { event, moves: 1, candidates }), expected);
        }
    }
}
