//! Observers of runs.

use toposlam_model::{
    enumerate::Watch,
    mapping::{MapWalk, MappingEvent},
};

use super::Event;

pub trait RunObserver {
    fn event(&mut self, _event: &Event) {}

    /// The mapping algorithm made a step. The events [`Hypothesis`](super::EventKind::Hypothesis) and
    /// [`Map`](super::EventKind::Map) follow; a story needs the whole journey.
    fn mapping(&mut self, _journey: &MapWalk, _event: MappingEvent) {}

    fn stop(&self) -> bool {
        false
    }
}

impl RunObserver for () {}

impl<O: RunObserver> RunObserver for Option<O> {
    fn event(&mut self, event: &Event) {
        if let Some(observer) = self {
            observer.event(event);
        }
    }

    fn mapping(&mut self, journey: &MapWalk, event: MappingEvent) {
        if let Some(observer) = self {
            observer.mapping(journey, event);
        }
    }

    fn stop(&self) -> bool {
        self.as_ref().is_some_and(RunObserver::stop)
    }
}

impl<O: RunObserver + ?Sized> RunObserver for &mut O {
    fn event(&mut self, event: &Event) {
        (**self).event(event);
    }

    fn mapping(&mut self, journey: &MapWalk, event: MappingEvent) {
        (**self).mapping(journey, event);
    }

    fn stop(&self) -> bool {
        (**self).stop()
    }
}

#[derive(Clone, Copy)]
pub struct StoppedBy<'w>(pub &'w dyn Watch);

impl RunObserver for StoppedBy<'_> {
    fn stop(&self) -> bool {
        self.0.stop()
    }
}

impl<A: RunObserver, B: RunObserver> RunObserver for (A, B) {
    fn event(&mut self, event: &Event) {
        self.0.event(event);
        self.1.event(event);
    }

    fn mapping(&mut self, journey: &MapWalk, event: MappingEvent) {
        self.0.mapping(journey, event);
        self.1.mapping(journey, event);
    }

    fn stop(&self) -> bool {
        self.0.stop() || self.1.stop()
    }
}
