//! A log that diverges in the same way as another, and is shorter.

use toposlam_model::{
    enumerate::Watch,
    trace::{self, Trace, shortened},
};

use super::{
    cause::{Cause, Divergence},
    events::{Event, Events, Kind, Perceived, Source},
    judgement::{Judgement, Question, judge},
    quirks::Quirks,
};

/// The events up to the first divergence, without those that it does not need; `None` where there is no
/// divergence, or nothing to cut.
///
/// Where percepts and doors diverge, stretches of moves are left out; where an event contradicts itself
/// or odometry, all but the last events are.
#[must_use]
pub fn shorter(judgement: &Judgement, question: &Question, watch: &impl Watch) -> Option<Events> {
    let divergence = judgement.divergence.as_ref()?;
    let judged = |events: &Events| {
        let judgement = judge(events.clone(), question, &Quirks::default(), watch).ok()?;
        judgement.divergence.filter(|found| alike(found, divergence))
    };
    match divergence.cause {
        Cause::World(_) | Cause::Algorithm(_) | Cause::NoWorld { .. } => {
            let last = judgement.places.iter().position(|&place| place == divergence.event)?;
            let shows = |trace: &Trace| {
                let events = of_trace(trace);
                let at = events.events.len() - 1;
                judged(&events).is_some_and(|found| found.event == at)
            };
            let cut = judgement.trace.up_to(last);
            let short = shortened(&cut, shows);
            let events = Events { head: judgement.events.head.clone(), ..of_trace(&short) };
            judged(&events).map(|_| events)
        }
        Cause::Unfinished { .. } | Cause::Map | Cause::WrongMap | Cause::Moves { .. } => None,
        _ => {
            // What odometry says of a door comes with the event after it.
            let last = (divergence.event + 1).min(judgement.events.events.len() - 1);
            (0..=divergence.event).rev().find_map(|first| {
                let events = judgement.events.from(first, last)?;
                let found = judged(&events)?;
                (found.event == divergence.event - first).then_some(events)
            })
        }
    }
}

/// Whether two divergences are alike: the same cause, and where that is what was perceived the same
/// expectation.
fn alike(one: &Divergence, other: &Divergence) -> bool {
    match (&one.cause, &other.cause) {
        (Cause::World(one), Cause::World(other)) => {
            let mut why = one.candidates.iter().map(|(_, why)| why);
            why.all(|why| other.candidates.iter().any(|(_, other)| other == why))
        }
        (one, other) => one.name() == other.name(),
    }
}

/// Events of percepts and doors alone, a second apart.
fn of_trace(trace: &Trace) -> Events {
    let event = |(place, event): (usize, trace::Event)| {
        let moves = place as u32 / 2;
        let source = Source { time: place as u64 * 1_000_000_000, ..Source::default() };
        let kind = match event {
            trace::Event::Perceived(percept) => Kind::Perceived(Perceived {
                percept,
                number: Some(moves),
                form: None,
                entry: None,
                entry_off: None,
            }),
            trace::Event::Left(door) => Kind::Left { door, number: Some(moves + 1), off: None },
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
