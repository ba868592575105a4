//! A log that diverges in the same way as another, and is shorter.

use std::mem::discriminant;

use toposlam_model::{
    enumerate::Watch,
    trace::{Trace, TraceEvent, shortened},
};

use super::{
    divergence::{Divergence, DivergenceCause},
    events::{Event, Events, Kind, Perceived, Source},
    extract::{Seen, derived},
    judgement::{ConformConfig, Judgement, RunDriver, judge},
    quirks::Quirks,
};

/// A log that diverges in the same way as a longer one.
#[derive(Clone, Debug, PartialEq)]
pub struct ShortenedRun {
    /// Its events.
    pub events: Events,
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
    let judged = |events: &Events, question: &ConformConfig| {
        let judgement = judge(events.clone(), question, &Quirks::default(), watch).ok()?;
        judgement.divergence.filter(|found| alike(found, divergence))
    };
    match divergence.cause {
        DivergenceCause::World(_)
        | DivergenceCause::Algorithm(_)
        | DivergenceCause::NoWorld { .. } => {
            let last = judgement.places.iter().position(|&place| place == divergence.event)?;
            let shows = |trace: &Trace| {
                let events = of_trace(trace);
                let at = events.events.len() - 1;
                judged(&events, question).is_some_and(|found| found.event == at)
            };
            let cut = judgement.trace.up_to(last);
            let short = shortened(&cut, shows);
            let events = Events { head: judgement.events.head.clone(), ..of_trace(&short) };
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
pub fn shorten_frames<'s>(seen: &'s [Seen], event: &Event) -> Option<&'s [Seen]> {
    let alone = matches!(event.kind, Kind::Aside { .. } | Kind::TurnedBack | Kind::Undecided);
    let end = seen.partition_point(|seen| seen.source <= event.source);
    let shows = |first: &usize| {
        let events = derived(&seen[*first..end], false);
        let is = |kind: &Kind| discriminant(kind) == discriminant(&event.kind);
        let stands = |event: &Event| matches!(event.kind, Kind::Perceived(_));
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
fn of_trace(trace: &Trace) -> Events {
    let event = |(place, event): (usize, TraceEvent)| {
        let moves = place as u32 / 2;
        let source = Source { time: place as u64 * 1_000_000_000, ..Source::default() };
        let kind = match event {
            TraceEvent::Perceived(percept) => Kind::Perceived(Perceived {
                percept,
                number: Some(moves),
                form: None,
                entry: None,
                entry_off: None,
            }),
            TraceEvent::Left(door) => Kind::Left { door, number: Some(moves + 1), off: None },
        };
        Event { source, kind }
    };
    Events { events: trace.events().enumerate().map(event).collect(), ..Events::default() }
}

impl Events {
    /// The events from one to another, as if the run began there; `None` where it cannot.
    fn from(&self, first: usize, last: usize) -> Option<Self> {
        let Kind::Perceived(Perceived { number, .. }) = &self.events.get(first)?.kind else {
            return None;
        };
        let before = number.unwrap_or(0);
        let mut events = self.events[first..=last].to_vec();
        for event in &mut events {
            if let Kind::Perceived(Perceived { number, .. }) | Kind::Left { number, .. } =
                &mut event.kind
            {
                *number = number.map(|number| number.wrapping_sub(before));
            }
        }
        Some(Self { events, head: self.head.clone(), ..Self::default() })
    }
}
