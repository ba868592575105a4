//! Shortens a log that diverges, so that it still diverges in the same way.

use std::mem::discriminant;

use toposlam_model::{
    aid::Action,
    enumerate::Watch,
    folding::WorldSearch,
    percept::WalkEvent,
    trace::{MisfitReason, Trace, TraceEvent, TraceEventKind, shortened},
};

use super::{
    config::{ConformConfig, RunDriver},
    divergence::{Divergence, DivergenceCause},
    events::{CheckedEvent, CheckedKind, EventSource, RunEvents},
    extract::infer_events,
    judgement::{Judgement, judge},
    placed_scenes::SensedScene,
    quirks::Quirks,
    shorten_measured::MeasuredWalk,
};

/// A shorter log with the same divergence.
#[derive(Clone, Debug, PartialEq)]
pub struct ShortenedRun {
    pub events: RunEvents,
    /// The index of the event that diverges.
    pub event: usize,
    /// Whether it diverges in any world and with any driver.
    pub by_itself: bool,
}

/// The events up to the first divergence, without those that it does not need; `None` if there is no
/// divergence, or nothing to remove.
///
/// If percepts and doors diverge, sequences of moves are removed; if measurements do, closed walks are; if an event
/// contradicts itself or the odometry, only the last events are kept.
pub fn shorten_run(
    judgement: &Judgement,
    config: &ConformConfig,
    watch: &dyn Watch,
) -> Option<ShortenedRun> {
    let divergence = judgement.divergence.as_ref()?;
    // A world that explains a shorter log is not a divergence.
    let search = WorldSearch { steps: 0, ..config.search };
    let config = &ConformConfig { search, ..config.clone() };
    let anyone = config.clone().by_itself();
    let diverges_at = |events: &RunEvents, event: usize, config: &ConformConfig| {
        let judgement = judge(events.clone(), config, &Quirks::default(), watch);
        let found = judgement.ok().and_then(|judgement| judgement.divergence);
        found.is_some_and(|found| found.is_like(divergence) && found.event == event)
    };
    match divergence.cause {
        DivergenceCause::World(_)
        | DivergenceCause::Algorithm(_)
        | DivergenceCause::NoWorld { .. } => {
            let last = trace_index(&judgement.trace, divergence.event)?;
            let shown = |trace: &Trace| {
                let events = events_of_trace(trace, &judgement.events);
                let event = events.events.len() - 1;
                let is_shown = diverges_at(&events, event, config);
                is_shown.then_some(ShortenedRun { events, event, by_itself: false })
            };
            let cut = judgement.trace.up_to(last);
            shown(&shortened(&cut, |trace| shown(trace).is_some()))
        }
        DivergenceCause::Unfinished { .. }
        | DivergenceCause::Map { .. }
        | DivergenceCause::WrongMap
        | DivergenceCause::Moves { .. } => None,
        DivergenceCause::Measurement { .. } => {
            let last = trace_index(&judgement.trace, divergence.event)?;
            let walk = MeasuredWalk::new(judgement, divergence, last)?;
            let (events, event) = walk.shortened(&anyone, watch)?;
            Some(ShortenedRun { events, event, by_itself: true })
        }
        _ => {
            // The odometry after a door belongs to the next event.
            let last = (divergence.event + 1).min(judgement.events.events.len() - 1);
            (0..=divergence.event).rev().find_map(|first| {
                let events = judgement.events.from(first, last)?;
                let event = divergence.event - first;
                let is_shown = diverges_at(&events, event, &anyone);
                is_shown.then_some(ShortenedRun { events, event, by_itself: true })
            })
        }
    }
}

/// The shortest sequence of scenes from which an event is inferred; `None` if there is no short one, or
/// the event cannot diverge by itself.
pub fn shorten_frames<'s>(
    seen: &'s [SensedScene],
    event: &CheckedEvent,
) -> Option<&'s [SensedScene]> {
    let alone = matches!(
        event.kind,
        CheckedKind::LeftBetweenDoors { .. } | CheckedKind::TurnedBack | CheckedKind::Undecided(_)
    );
    let end = seen.partition_point(|seen| seen.source <= event.source);
    let shows = |first: &usize| {
        let events = infer_events(&seen[*first..end], false);
        let is = |kind: &CheckedKind| discriminant(kind) == discriminant(&event.kind);
        let stands = events.iter().any(|event| event.arrival().is_some());
        stands && events.last().is_some_and(|last| is(&last.kind))
    };
    let first = (0..end).rev().take(FAR).find(shows).filter(|_| alone)?;
    Some(&seen[first..end])
}

/// The largest number of scenes that are kept.
const FAR: usize = 400;

impl Divergence {
    /// Whether two divergences have the same cause and class, and for percepts the same expectation.
    pub fn is_like(&self, other: &Self) -> bool {
        let same = match (&self.cause, &other.cause) {
            (DivergenceCause::World(one), DivergenceCause::World(other)) => {
                let expected = |(_, why): &(_, MisfitReason)| *why;
                let other: Vec<_> = other.candidates.iter().map(expected).collect();
                one.candidates.iter().map(expected).all(|why| other.contains(&why))
            }
            (
                DivergenceCause::NoWorld { why: one, .. },
                DivergenceCause::NoWorld { why: other, .. },
            ) => one.without_visits() == other.without_visits(),
            (one, other) => one.name() == other.name(),
        };
        same && self.fault == other.fault
    }
}

impl ConformConfig {
    /// The same without what is outside of the log: in any world, with any driver.
    #[must_use]
    pub fn by_itself(self) -> Self {
        Self { world: None, driver: RunDriver::Anyone, ..self }
    }
}

/// Events of percepts and doors alone, a second apart, in a log like that of a whole run.
fn events_of_trace(trace: &Trace, whole: &RunEvents) -> RunEvents {
    // Of all robots together.
    let mut moves = 0;
    let event = |(index, (at, event)): (usize, (Option<WalkEvent>, TraceEvent))| {
        let source = EventSource { time: index as u64 * 1_000_000_000, ..EventSource::default() };
        let mut kind = match event.kind {
            TraceEventKind::Percept(percept) => CheckedKind::from(percept),
            TraceEventKind::Door(door) => CheckedKind::from(door),
            TraceEventKind::Action(action) => CheckedKind::Action { number: Some(moves), action },
        };
        moves += match event.kind {
            TraceEventKind::Percept(_) => 0,
            TraceEventKind::Door(_) => 1,
            TraceEventKind::Action(action) => Action::Do(action).moves() as u32,
        };
        let is_relocation =
            matches!(at, Some(WalkEvent::Percept(number)) if trace.is_relocation(number));
        match &mut kind {
            CheckedKind::Arrival { arrival, .. } if !is_relocation => {
                arrival.number = Some(moves);
            }
            CheckedKind::Door { number, .. } => *number = Some(moves),
            _ => {}
        }
        CheckedEvent { source, kind }
    };
    whole.with_events(trace.events().enumerate().map(event).collect())
}

/// The index in a trace of the event with this id.
fn trace_index(trace: &Trace, id: usize) -> Option<usize> {
    let index = trace.index_of(id);
    (trace.event(index).id == id).then_some(index)
}

impl RunEvents {
    /// The events from one to another, as if the run began there; `None` if it cannot begin there.
    fn from(&self, first: usize, last: usize) -> Option<Self> {
        let before = self.events.get(first)?.arrival()?.number.unwrap_or(0);
        let mut events = self.events[first..=last].to_vec();
        for event in &mut events {
            if let Some(number) = event.number_mut() {
                *number = number.wrapping_sub(before);
            }
            if let CheckedKind::Arrival { hallway, .. } = &mut event.kind {
                *hallway = None;
            }
        }
        Some(self.with_events(events))
    }
}

#[cfg(test)]
mod tests {
    use toposlam_model::percept::{Door, Percept, Sighting};

    use super::*;

    #[test]
    fn the_events_of_a_trace_are_those_of_a_robot_that_got_lost_where_it_did() {
        let arrival = |number| {
            let mut kind = CheckedKind::from(Percept { degree: 3, sighting: Sighting::Nothing });
            if let CheckedKind::Arrival { arrival, .. } = &mut kind {
                arrival.number = number;
            }
            kind
        };
        let door = || CheckedKind::from(Door(1));
        let kinds = [arrival(Some(0)), door(), arrival(None), door(), arrival(Some(2))];
        let event = |kind| CheckedEvent { source: EventSource::default(), kind };
        let events = kinds.map(event).to_vec();
        let events = RunEvents { events, has_head: true, ..RunEvents::default() };
        let again = events_of_trace(&events.trace().unwrap(), &events);
        let relocations = |events: &RunEvents| events.relocations().collect::<Vec<_>>();
        assert_eq!((relocations(&events), relocations(&again)), (vec![2], vec![2]));
    }
}
