//! Runs with a marker that is picked up, carried and dropped.

use super::{NotProved, text};
use crate::{
    aid::{AidAction, AidKind, markers::MOVABLE},
    trace::{Trace, TraceEventKind},
};

/// What a robot with such a marker perceived and did, in order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PerceivedRun {
    aid: AidKind,
    events: Vec<TraceEventKind>,
}

impl PerceivedRun {
    /// # Errors
    /// Returns an error if the aid is another one, or if what was perceived or done is not what a robot with it perceives or
    /// does.
    pub fn new(aid: AidKind, trace: &Trace) -> Result<Self, NotProved> {
        if !matches!(aid, AidKind::Markers(MOVABLE) | AidKind::Pointer(_)) {
            return Err(NotProved::Aid(aid.name()));
        }
        let events: Vec<_> = trace.events().map(|(_, event)| event.kind).collect();
        for &event in &events {
            match event {
                TraceEventKind::Percept(percept) if text::word(percept.sighting).is_none() => {
                    return Err(NotProved::Sighting(percept.sighting));
                }
                TraceEventKind::Action(action) if !is_carrying(action) => {
                    return Err(NotProved::Action(action));
                }
                _ => {}
            }
        }
        Ok(Self { aid, events })
    }

    pub(super) fn aid(&self) -> AidKind {
        self.aid
    }

    pub(super) fn events(&self) -> &[TraceEventKind] {
        &self.events
    }
}

fn is_carrying(action: AidAction) -> bool {
    matches!(action, AidAction::PickUp | AidAction::Drop)
}
