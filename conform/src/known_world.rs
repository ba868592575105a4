//! A known world, and the fault class of a percept that does not fit it.

use toposlam_model::{
    embedded_graph::EmbeddedGraph,
    isomorphism::code,
    mapping::FACING,
    marker::Marker,
    percept::{Percept, WalkEvent},
    trace::{Misfit, MisfitReason, Trace, TraceEventKind, poses},
    world::State,
};

use super::divergence::FaultClass;

/// A known world, and the possible states at the start.
#[derive(Clone, Debug)]
pub struct KnownWorld<'w> {
    /// The embedded graph.
    pub graph: &'w EmbeddedGraph,
    /// The possible states of the robot and the marker at the start.
    pub states: Vec<State>,
}

impl KnownWorld<'_> {
    /// The fault class of a misfit. It is motion if the following events fit better from another pose than
    /// after one wrong percept.
    pub(super) fn fault(
        &self,
        trace: &Trace,
        misfit: &Misfit,
        marker: &'static dyn Marker,
    ) -> FaultClass {
        let TraceEventKind::Percept(perceived) = misfit.event.kind else {
            return FaultClass::Algorithm;
        };
        let moves = misfit.moves;
        let perceived_wrongly = misfit.candidates.iter().filter_map(|&(state, why)| {
            let MisfitReason::Percept { expected } = why else { return None };
            Some(self.fitting(&ahead(trace, moves, expected), &[state], marker))
        });
        let perceived_wrongly = perceived_wrongly.max().unwrap_or(0);
        let placed = misfit.candidates.iter().map(|(state, _)| state.placed);
        let elsewhere = |placed| self.graph.darts().map(move |pose| State { pose, placed });
        let elsewhere: Vec<_> = placed.take(1).flat_map(elsewhere).collect();
        let came_elsewhere = self.fitting(&ahead(trace, moves, perceived), &elsewhere, marker);
        if came_elsewhere > perceived_wrongly { FaultClass::Motion } else { FaultClass::Perception }
    }

    /// The number of events that fit.
    fn fitting(&self, trace: &Trace, states: &[State], marker: &'static dyn Marker) -> usize {
        poses(self.graph, &marker, states, trace).left.len()
    }

    /// Whether a map is this world from one of its starts.
    pub(super) fn has(&self, map: &EmbeddedGraph) -> bool {
        let of_map = code(map, FACING);
        let is = |state: &State| state.placed.is_some_and(|dart| code(self.graph, dart) == of_map);
        self.states.iter().any(is)
    }
}

/// The number of following events that decide the fault class of a misfit.
const AHEAD: usize = 12;

/// The trace after some moves, with another first percept.
fn ahead(trace: &Trace, moves: usize, first: Percept) -> Trace {
    let first = TraceEventKind::Percept(first);
    let rest = trace.events().skip(WalkEvent::Door(moves).index());
    let rest = rest.take(AHEAD).map(|event| event.kind);
    // They take turns as before, whatever the first percept is.
    Trace::new(std::iter::once(first).chain(rest)).unwrap_or_else(|_| trace.clone())
}
