//! Measurements of hallways by odometry, compared where the visits of a log are identified: by the folded trail,
//! and in a known world by the robot's pose.

use serde::Serialize;
use toposlam_model::{
    aid::Places,
    embedded_graph::{Dart, EmbeddedGraph},
    folding::{FoldedTrail, fold},
    measurement::{
        ContradictoryMeasurement, MeasuredVisit, MeasurementCheck, MeasurementContradiction,
    },
    percept::{Door, Percept, WalkEvent},
    trace::{Poses, Trace},
};

use super::{
    divergence::DivergenceCause,
    events::{CheckedEvent, CheckedKind, RunEvents},
    impossible::{first_percept, folded_before},
};

/// How many hallways of a run were measured by odometry, and compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct MeasuredHallways {
    pub moves: usize,
    pub measured: usize,
    /// The number of those whose hallway was measured before.
    pub compared: usize,
}

impl MeasuredHallways {
    /// Compares the measurements of a run. Returns the counts, and the first contradiction: the index of the first
    /// event up to which the walk shows it, and the divergence.
    pub(super) fn compare(
        events: &RunEvents,
        trace: &Trace,
        trail: Option<&FoldedTrail>,
        known: Option<(&EmbeddedGraph, &Poses<Places>)>,
    ) -> (Self, Option<(usize, DivergenceCause)>) {
        let unplaced = unplaced_visits(events, trace);
        let check =
            |visits: &[MeasuredVisit]| MeasurementCheck::new(visits, &events.measurement_noise);
        let in_trail = |trail: &FoldedTrail| check(&by_trail(&unplaced, trace, trail));
        let by_trail = trail.map_or_else(|| check(&unplaced), in_trail);
        let by_poses = known
            .map(|(graph, poses)| check(&by_poses(&unplaced, graph, poses)))
            .unwrap_or_default();
        let hallways = Self {
            moves: trace.percepts().len() - 1,
            measured: by_trail.measured,
            compared: by_trail.compared.max(by_poses.compared),
        };
        let by_trail = by_trail.contradictions.first().map(|&found| {
            // Later percepts may be wrong, and identify other visits.
            let moves = trail.map_or(0, FoldedTrail::moves);
            let event =
                first_percept(trace, moves, |trail| !in_trail(trail).contradictions.is_empty());
            let first =
                folded_before(trace, event + 1).map(|trail| in_trail(&trail).contradictions);
            match first.as_deref() {
                Some(&[first, ..]) => (trace.event(event).id, first),
                _ => (event_of(trace, found.visit), found),
            }
        });
        let by_poses = by_poses.contradictions.first();
        let by_poses = by_poses.map(|&found| (event_of(trace, found.visit), found));
        let first = by_trail.into_iter().chain(by_poses).min_by_key(|(event, _)| *event);
        (hallways, first.map(|(event, found)| (event, divergence(trace, &found))))
    }
}

impl RunEvents {
    /// The visits of a run with the directional marker, with their measurements, identified by the folded trail;
    /// `None` if no world explains the run.
    pub fn measured_visits(&self) -> Option<Vec<MeasuredVisit>> {
        let trace = self.trace().ok()?;
        let trail = fold(trace.percepts(), trace.doors()).ok()?;
        Some(by_trail(&unplaced_visits(self, &trace), &trace, &trail))
    }

    /// Leaves out the measurement of a divergence.
    pub(super) fn forget_measurement(&mut self, cause: &DivergenceCause) {
        let DivergenceCause::Measurement { between: [_, at], measurement, .. } = cause else {
            return;
        };
        if let Some(CheckedEvent { kind: CheckedKind::Arrival { arrival, hallway, .. }, .. }) =
            self.events.get_mut(*at)
        {
            match measurement {
                ContradictoryMeasurement::Shape => arrival.shape = None,
                _ => *hallway = None,
            }
        }
    }
}

/// The visits of a trace, each of a vertex that is not known.
fn unplaced_visits(events: &RunEvents, trace: &Trace) -> Vec<MeasuredVisit> {
    let visit = |number: usize| {
        let event = events.events.get(event_of(trace, number)).map(|event| &event.kind);
        let Some(CheckedKind::Arrival { arrival, hallway, .. }) = event else {
            return MeasuredVisit::default();
        };
        // A robot that got lost has not come through one hallway.
        let is_lost = |number: usize| trace.is_relocation(number);
        MeasuredVisit {
            darts: Vec::new(),
            shape: arrival.shape,
            arrived: hallway.filter(|_| !is_lost(number)),
            left_by: trace.doors().get(number).copied().filter(|_| !is_lost(number + 1)),
        }
    };
    (0..trace.percepts().len()).map(visit).collect()
}

/// The visits with the vertices of the folded trail, as far as it goes.
fn by_trail(visits: &[MeasuredVisit], trace: &Trace, trail: &FoldedTrail) -> Vec<MeasuredVisit> {
    let mut pose = Some(trail.start());
    let percepts = trace.percepts().iter().take(trail.moves() + 1);
    let mut placed = visits.to_vec();
    for (visit, &Percept { degree, .. }) in placed.iter_mut().zip(percepts) {
        let Some(here) = pose else { break };
        visit.darts = (0..degree).map(|door| trail.behind(here, Door(door))).collect();
        pose = visit.left_by.and_then(|door| trail.opposite(trail.behind(here, door)));
    }
    placed
}

/// The visits with the vertices of a known world, where only one pose is possible.
fn by_poses(
    visits: &[MeasuredVisit],
    graph: &EmbeddedGraph,
    poses: &Poses<Places>,
) -> Vec<MeasuredVisit> {
    let mut placed = visits.to_vec();
    for (moves, visit) in placed.iter_mut().enumerate() {
        if let Some(&Some(pose)) = poses.alone.get(WalkEvent::Percept(moves).index()) {
            let doors = 0..graph.degree_around(pose);
            let darts = doors.map(|door| graph.behind(pose, Door(door)));
            visit.darts = darts.collect::<Vec<Dart>>();
        }
    }
    placed
}

/// The event of a visit.
fn event_of(trace: &Trace, visit: usize) -> usize {
    trace.percept_event(visit).id
}

/// The divergence of a measurement that contradicts others.
fn divergence(trace: &Trace, found: &MeasurementContradiction) -> DivergenceCause {
    let MeasurementContradiction { visit, earlier, measurement } = *found;
    let move_to = |visit: usize| [visit.saturating_sub(1), visit];
    let [between, earlier] = match measurement {
        ContradictoryMeasurement::Length { .. } | ContradictoryMeasurement::Turn { .. } => {
            [move_to(visit), move_to(earlier)]
        }
        ContradictoryMeasurement::Shape
        | ContradictoryMeasurement::ClosedTurns { .. }
        | ContradictoryMeasurement::ClosedWalk { .. } => [[earlier, visit]; 2],
    }
    .map(|visits| visits.map(|visit| event_of(trace, visit)));
    DivergenceCause::Measurement { between, earlier, measurement }
}
