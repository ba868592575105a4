//! Shortens a log whose measurements contradict each other: closed walks that the contradiction does not need are
//! removed, so that each measurement is still that of its hallway.

use std::mem::discriminant;

use toposlam_model::{
    driving::scene::wrapped,
    embedded_graph::Dart,
    enumerate::Watch,
    folding::fold,
    measurement::ContradictoryMeasurement,
    percept::{Percept, Sighting, WalkEvent},
    trace::Trace,
};

use super::{
    config::ConformConfig,
    divergence::{Divergence, DivergenceCause},
    events::{CheckedEvent, CheckedKind, RunEvents},
    judgement::{Judgement, judge},
    quirks::Quirks,
};

/// The largest number of shorter walks that are judged.
const TRIALS: usize = 200;

/// The walk up to a measurement that contradicts others.
pub(super) struct MeasuredWalk<'j> {
    events: &'j RunEvents,
    divergence: &'j Divergence,
    trace: Trace,
    /// The pose at each visit, as the dart by which the robot came in, in the folded trail of the walk.
    poses: Vec<Dart>,
}

impl<'j> MeasuredWalk<'j> {
    /// The walk up to a divergence, at this event of the trace; `None` if its visits are not identified.
    pub(super) fn new(
        judgement: &'j Judgement,
        divergence: &'j Divergence,
        last: usize,
    ) -> Option<Self> {
        let trace = judgement.trace.up_to(last);
        if !trace.relocations().is_empty() || trace.percepts().len() == trace.doors().len() {
            return None;
        }
        let trail = fold(trace.percepts(), trace.doors()).ok()?;
        let mut poses = vec![trail.start()];
        for &door in trace.doors() {
            poses.push(trail.opposite(trail.behind(*poses.last()?, door))?);
        }
        Some(Self { events: &judgement.events, divergence, trace, poses })
    }

    /// The events of a shorter walk with the same contradiction, and the index of the one that diverges; `None` if the
    /// whole walk does not have it by itself.
    pub(super) fn shortened(
        &self,
        config: &ConformConfig,
        watch: &dyn Watch,
    ) -> Option<(RunEvents, usize)> {
        let shows = |visits: &[usize]| {
            let mut visits = visits.to_vec();
            loop {
                let events = self.events_of(&visits);
                let judged = judge(events.clone(), config, &Quirks::default(), watch).ok()?;
                let found = judged.divergence.filter(|found| self.is_shown_by(&visits, found))?;
                if found.event + 1 == events.events.len() {
                    return Some((visits, events));
                }
                // The events up to the first that shows it may show it sooner.
                visits.truncate(WalkEvent::at(found.event).moves() + 1);
            }
        };
        let all: Vec<usize> = (0..self.poses.len()).collect();
        let (mut visits, mut shortest) = shows(&all)?;
        let mut trials = 0;
        let mut length = visits.len() - 1;
        while length > 0 {
            let mut from = 0;
            while from + length < visits.len() && trials < TRIALS {
                let shorter = self.without(&visits, from, from + length).and_then(|shorter| {
                    trials += 1;
                    shows(&shorter)
                });
                match shorter {
                    Some(shorter) => (visits, shortest) = shorter,
                    None => from += 1,
                }
            }
            length -= 1;
        }
        let last = shortest.events.len() - 1;
        Some((shortest, last))
    }

    /// The visits without a closed walk from one to another; at the beginning, without all before one at the marker.
    fn without(&self, visits: &[usize], from: usize, to: usize) -> Option<Vec<usize>> {
        let marked = |visit: usize| {
            let Percept { sighting, .. } = self.trace.percepts()[visit];
            matches!(sighting, Sighting::Pointing(_))
        };
        if self.poses[visits[from]] == self.poses[visits[to]] {
            Some([&visits[..=from], &visits[to + 1..]].concat())
        } else if from == 0 && marked(visits[to]) {
            Some(visits[to..].to_vec())
        } else {
            None
        }
    }

    fn arrival(&self, visit: usize) -> usize {
        self.trace.percept_event(visit).id
    }

    /// The direction of the entry door of a visit, in the frame of odometry.
    fn entry(&self, visit: usize) -> Option<f64> {
        self.events.events.get(self.arrival(visit))?.arrival()?.entry
    }

    /// The events of some visits, and of the move to each from the visit before it.
    fn events_of(&self, visits: &[usize]) -> RunEvents {
        let mut events: Vec<CheckedEvent> = Vec::new();
        // Odometry has turned on the walks that were removed.
        let mut turned = 0.0;
        for (number, &visit) in visits.iter().enumerate() {
            let moves = u32::try_from(number).ok();
            if let Some(before) = number.checked_sub(1).map(|before| visits[before]) {
                if let Some((now, then)) = self.entry(before).zip(self.entry(visit - 1)) {
                    turned += now - then;
                }
                let door = self.trace.door_event(visit - 1).id;
                let mut door = self.events.events[door].clone();
                if let CheckedKind::Door { number, .. } = &mut door.kind {
                    *number = moves;
                }
                events.push(door);
            }
            let mut event = self.events.events[self.arrival(visit)].clone();
            if let CheckedKind::Arrival { arrival, entry_off, hallway } = &mut event.kind {
                arrival.number = moves;
                arrival.entry = arrival.entry.map(|entry| wrapped(entry + turned));
                if number == 0 {
                    (*entry_off, *hallway) = (None, None);
                }
            }
            events.push(event);
        }
        self.events.with_events(events)
    }

    /// Whether a divergence of the events of some visits is that of the whole walk: between the same events, with the
    /// same measurement.
    fn is_shown_by(&self, visits: &[usize], found: &Divergence) -> bool {
        // Arrivals and doors alternate.
        let whole = |event: usize| {
            visits.get(WalkEvent::at(event).moves()).map(|&visit| self.arrival(visit))
        };
        let measured = |divergence: &Divergence| match divergence.cause {
            DivergenceCause::Measurement { between, earlier, measurement } => {
                Some((between, earlier, measurement))
            }
            _ => None,
        };
        let both = measured(found).zip(measured(self.divergence));
        let Some(((between, earlier, now), (whole_between, whole_earlier, before))) = both else {
            return false;
        };
        // The length or the turn is that of the same move.
        let is_same = match (now, before) {
            (
                ContradictoryMeasurement::ClosedTurns { quarters },
                ContradictoryMeasurement::ClosedTurns { quarters: other },
            ) => quarters == other,
            (one, other) => discriminant(&one) == discriminant(&other),
        };
        // Moves may begin at another visit of the same place.
        let is_move = matches!(
            before,
            ContradictoryMeasurement::Length { .. } | ContradictoryMeasurement::Turn { .. }
        );
        whole(between[1]) == Some(whole_between[1])
            && whole(earlier[1]) == Some(whole_earlier[1])
            && (is_move || whole(between[0]) == Some(whole_between[0]))
            && is_same
            && found.fault == self.divergence.fault
    }
}
