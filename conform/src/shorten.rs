//! Shortens a log that diverges, so that it still diverges in the same way.

use std::mem::discriminant;

use toposlam_logs::record::Arrival;
use toposlam_model::{
    enumerate::Watch,
    folding::WorldSearch,
    percept::{Percept, WalkEvent},
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
    /// Its events.
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
#[must_use]
pub fn shorten_run(
    judgement: &Judgement,
    question: &ConformConfig,
    watch: &dyn Watch,
) -> Option<ShortenedRun> {
    let divergence = judgement.divergence.as_ref()?;
    // A world that explains a shorter log is not a divergence.
    let search = WorldSearch { steps: 0, ..question.search };
    let question = &ConformConfig { search, ..question.clone() };
    let anyone = question.clone().by_itself();
    let judged = |events: &RunEvents, question: &ConformConfig| {
        let judgement = judge(events.clone(), question, &Quirks::default(), watch).ok()?;
        judgement.divergence.filter(|found| found.is_like(divergence))
    };
    match divergence.cause {
        DivergenceCause::World(_)
        | DivergenceCause::Algorithm(_)
        | DivergenceCause::NoWorld { .. } => {
            let last = trace_index(&judgement.trace, divergence.event)?;
            let shows = |trace: &Trace| {
                let events = of_trace(trace, &judgement.events);
                let at = events.events.len() - 1;
                judged(&events, question).is_some_and(|found| found.event == at)
            };
            let cut = judgement.trace.up_to(last);
            let short = shortened(&cut, shows);
            let events = of_trace(&short, &judgement.events);
            let event = events.events.len() - 1;
            let found = judged(&events, question)?;
            (found.event == event).then_some(ShortenedRun { events, event, by_itself: false })
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
                let found = judged(&events, &anyone)?;
                let event = divergence.event - first;
                (found.event == event).then_some(ShortenedRun { events, event, by_itself: true })
            })
        }
    }
}

/// The shortest sequence of scenes from which an event is inferred; `None` if there is no short one, or
/// the event cannot diverge by itself.
#[must_use]
pub fn shorten_frames<'s>(
    seen: &'s [SensedScene],
    event: &CheckedEvent,
) -> Option<&'s [SensedScene]> {
    let alone = matches!(
        event.kind,
        CheckedKind::Aside { .. } | CheckedKind::TurnedBack | CheckedKind::Undecided(_)
    );
    let end = seen.partition_point(|seen| seen.source <= event.source);
    let shows = |first: &usize| {
        let events = infer_events(&seen[*first..end], false);
        let is = |kind: &CheckedKind| discriminant(kind) == discriminant(&event.kind);
        let stands = |event: &CheckedEvent| matches!(event.kind, CheckedKind::Arrival { .. });
        events.last().is_some_and(|last| is(&last.kind)) && events.iter().any(stands)
    };
    let first = (0..end).rev().take(FAR).find(shows).filter(|_| alone)?;
    Some(&seen[first..end])
}

/// The largest number of scenes that are kept.
const FAR: usize = 400;

impl Divergence {
    /// Whether two divergences have the same cause and class, and for percepts the same expectation.
    #[must_use]
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
            ) => one.is_like(other),
            (one, other) => one.name() == other.name(),
        };
        same && self.fault == other.fault
    }
}

impl ConformConfig<'_> {
    /// The same without what is outside of the log: in any world, with any driver.
    #[must_use]
    pub fn by_itself(self) -> Self {
        Self { world: None, driver: RunDriver::Anyone, ..self }
    }
}

/// Events of percepts and doors alone, a second apart, in a log like that of a whole run.
fn of_trace(trace: &Trace, whole: &RunEvents) -> RunEvents {
    let event = |(index, event): (usize, TraceEvent)| {
        let moves = WalkEvent::at(index).moves();
        let source = EventSource { time: index as u64 * 1_000_000_000, ..EventSource::default() };
        let kind = match event.kind {
            TraceEventKind::Percept(percept) => {
                let Percept { degree, sighting } = percept;
                let number = Some(moves as u32).filter(|_| !trace.is_relocation(moves));
                let sighting = Some(sighting);
                let arrival = Arrival { number, degree, sighting, form: None, entry: None };
                CheckedKind::Arrival { arrival, entry_off: None, hallway: None }
            }
            TraceEventKind::Door(door) => {
                CheckedKind::Door { door, number: Some(moves as u32 + 1), off: None }
            }
        };
        CheckedEvent { source, kind }
    };
    let events = trace.events().enumerate().map(event).collect();
    RunEvents { events, has_head: whole.has_head, ..RunEvents::default() }
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
            if let CheckedKind::Arrival { hallway, .. } = &mut event.kind {
                *hallway = None;
            }
        }
        let Self { has_head, may_turn_back, measurement_noise, .. } = *self;
        Some(Self { events, has_head, may_turn_back, measurement_noise, ..Self::default() })
    }
}
