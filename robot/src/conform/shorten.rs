//! A log that diverges in the same way as another, and is shorter.

use std::mem::discriminant;

use toposlam_model::{
    enumerate::Watch,
    trace::{Trace, TraceEvent, TraceEventKind, shortened},
};

use super::{
    divergence::{Divergence, DivergenceCause},
    events::{CheckedEvent, CheckedKind, EventSource, RunEvents},
    extract::{Seen, derived},
    judgement::{ConformConfig, Judgement, RunDriver, judge},
    quirks::Quirks,
};
use crate::record::Arrival;

/// A log that diverges in the same way as a longer one.
#[derive(Clone, Debug, PartialEq)]
pub struct ShortenedRun {
    /// Its events.
    pub events: RunEvents,
    /// Whether it diverges by itself, in whatever world and whoever drives.
    pub by_itself: bool,
}

/// The events up to the first divergence, without those that it does not need; `None` where there is no
/// divergence, or nothing to cut.
///
/// Where percepts and doors diverge, stretches of moves are left out; where an event contradicts itself
/// or odometry, all but the last events are.
#[must_use]
pub fn shorten_run(
    judgement: &Judgement,
    question: &ConformConfig,
    watch: &impl Watch,
) -> Option<ShortenedRun> {
    let divergence = judgement.divergence.as_ref()?;
    let anyone = ConformConfig { world: None, driver: RunDriver::Anyone, ..question.clone() };
    let judged = |events: &RunEvents, question: &ConformConfig| {
        let judgement = judge(events.clone(), question, &Quirks::default(), watch).ok()?;
        judgement.divergence.filter(|found| alike(found, divergence))
    };
    match divergence.cause {
        DivergenceCause::World(_)
        | DivergenceCause::Algorithm(_)
        | DivergenceCause::NoWorld { .. } => {
            let last = trace_index(&judgement.trace, divergence.event)?;
            let shows = |trace: &Trace| {
                let events = of_trace(trace);
                let at = events.events.len() - 1;
                judged(&events, question).is_some_and(|found| found.event == at)
            };
            let cut = judgement.trace.up_to(last);
            let short = shortened(&cut, shows);
            let events = RunEvents { has_head: judgement.events.has_head, ..of_trace(&short) };
            judged(&events, question).map(|_| ShortenedRun { events, by_itself: false })
        }
        DivergenceCause::Unfinished { .. }
        | DivergenceCause::Map
        | DivergenceCause::WrongMap
        | DivergenceCause::Moves { .. } => None,
        _ => {
            // What odometry says of a door comes with the event after it.
            let last = (divergence.event + 1).min(judgement.events.events.len() - 1);
            (0..=divergence.event).rev().find_map(|first| {
                let events = judgement.events.from(first, last)?;
                let found = judged(&events, &anyone)?;
                let same = found.event == divergence.event - first;
                same.then_some(ShortenedRun { events, by_itself: true })
            })
        }
    }
}

/// The least that was seen of which the event at a place among those derived from all is derived; `None`
/// where it cannot be derived but with all, or is none that shows in what was seen alone.
#[must_use]
pub fn shorten_frames<'s>(seen: &'s [Seen], event: &CheckedEvent) -> Option<&'s [Seen]> {
    let alone = matches!(
        event.kind,
        CheckedKind::Aside { .. } | CheckedKind::TurnedBack | CheckedKind::Undecided
    );
    let end = seen.partition_point(|seen| seen.source <= event.source);
    let shows = |first: &usize| {
        let events = derived(&seen[*first..end], false);
        let is = |kind: &CheckedKind| discriminant(kind) == discriminant(&event.kind);
        let stands = |event: &CheckedEvent| matches!(event.kind, CheckedKind::Arrival { .. });
        events.last().is_some_and(|last| is(&last.kind)) && events.iter().any(stands)
    };
    let first = (0..end).rev().take(FAR).find(shows).filter(|_| alone)?;
    Some(&seen[first..end])
}

/// So many pictures back is far enough to look for what led to an event.
const FAR: usize = 400;

/// Whether two divergences are alike: the same cause, and where that is what was perceived the same
/// expectation.
fn alike(one: &Divergence, other: &Divergence) -> bool {
    match (&one.cause, &other.cause) {
        (DivergenceCause::World(one), DivergenceCause::World(other)) => {
            let mut why = one.candidates.iter().map(|(_, why)| why);
            why.all(|why| other.candidates.iter().any(|(_, other)| other == why))
        }
        (one, other) => one.name() == other.name(),
    }
}

/// Events of percepts and doors alone, a second apart.
fn of_trace(trace: &Trace) -> RunEvents {
    let event = |(index, event): (usize, TraceEvent)| {
        let moves = index as u32 / 2;
        let source = EventSource { time: index as u64 * 1_000_000_000, ..EventSource::default() };
        let kind = match event.kind {
            TraceEventKind::Percept(percept) => {
                let arrival = Arrival { percept, number: Some(moves), form: None, entry: None };
                CheckedKind::Arrival { arrival, entry_off: None }
            }
            TraceEventKind::Door(door) => {
                CheckedKind::Door { door, number: Some(moves + 1), off: None }
            }
        };
        CheckedEvent { source, kind }
    };
    RunEvents { events: trace.events().enumerate().map(event).collect(), ..RunEvents::default() }
}

/// The index in a trace of the event with this id.
fn trace_index(trace: &Trace, id: usize) -> Option<usize> {
    let index = trace.index_of(id);
    (trace.event(index).id == id).then_some(index)
}

impl RunEvents {
    /// The events from one to another, as if the run began there; `None` if it cannot begin there.
    fn from(&self, first: usize, last: usize) -> Option<Self> {
        let CheckedKind::Arrival { arrival, .. } = &self.events.get(first)?.kind else {
            return None;
        };
        let before = arrival.number.unwrap_or(0);
        let mut events = self.events[first..=last].to_vec();
        for event in &mut events {
            if let CheckedKind::Arrival { arrival: Arrival { number, .. }, .. }
            | CheckedKind::Door { number, .. } = &mut event.kind
            {
                *number = number.map(|number| number.wrapping_sub(before));
            }
        }
        Some(Self { events, has_head: self.has_head, ..Self::default() })
    }
}
