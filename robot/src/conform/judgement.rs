//! Judges a recorded run: its consistency, a known world or the smallest one, and Algorithm 1.
//! Sections 2.1 and 2.3.

use std::collections::BTreeMap;

use thiserror::Error;
use toposlam_model::{
    driving::visit::JunctionShape,
    enumerate::Watch,
    mapping::{Contradiction, FACING},
    percept::Percept,
    trace::{
        AlgorithmCoverage, AlgorithmMatch, Departure, MatchEnd, Misfit, MisfitReason, Poses,
        SmallestWorld, StepPurpose, Trace, TraceClaim, TraceOrderError, WorldSearch,
        match_algorithm, poses, smallest,
    },
};

use super::{
    divergence::{Divergence, DivergenceCause, FaultClass},
    events::{CheckedEvent, CheckedKind, OutOfOrder, RunEvents},
    known_world::KnownWorld,
    quirks::Quirks,
};

/// What a run is checked against.
#[derive(Clone, Debug)]
pub struct ConformConfig<'w> {
    /// The world, if it is known.
    pub world: Option<KnownWorld<'w>>,
    /// What chose the doors.
    pub driver: RunDriver,
    /// The worlds to search if none is known.
    pub search: WorldSearch,
    /// The largest number of darts that Algorithm 1 may know.
    pub dart_bound: usize,
}

/// What chooses the doors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunDriver {
    /// Algorithm 1, with any choices.
    Algorithm1,
    /// Anything, in any way.
    Anyone,
}

/// The result of checking a run.
#[derive(Clone, Debug)]
pub struct Judgement {
    /// The events; a tolerated event is replaced by the expected one.
    pub events: RunEvents,
    /// Its arrivals and doors, up to the first that is out of turn. The ids are indices of `events`.
    pub trace: Trace,
    /// The first divergence.
    pub divergence: Option<Divergence>,
    /// The candidate poses in the known world.
    pub poses: Option<Poses>,
    /// The smallest world that explains the log, if none is known.
    pub smallest: Option<SmallestWorld>,
    /// How far Algorithm 1 follows the log.
    pub algorithm: Option<AlgorithmMatch>,
    /// The cases that the run covers.
    pub coverage: RunCoverage,
    /// The tolerated divergences in order, each with the index of its quirk.
    pub tolerated: Vec<(Divergence, usize)>,
}

/// The cases that a run covers.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RunCoverage {
    /// Of Algorithm 1.
    pub algorithm: AlgorithmCoverage,
    /// Of perception: the junction shapes, seen from the entry door.
    pub junctions: BTreeMap<JunctionShape, u64>,
}

impl RunCoverage {
    /// Adds the cases of another run.
    pub fn include(&mut self, other: &Self) {
        self.algorithm.include(&other.algorithm);
        for (&form, count) in &other.junctions {
            *self.junctions.entry(form).or_default() += count;
        }
    }
}

/// The verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConformVerdict {
    /// Everything fits.
    Conforms,
    /// An event does not fit.
    Diverged,
    /// Everything fits, but the run or the search is not complete.
    Incomplete,
}

impl ConformVerdict {
    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Conforms => "conforms",
            Self::Diverged => "diverged",
            Self::Incomplete => "incomplete",
        }
    }
}

/// Why a run cannot be judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum JudgeError {
    /// There is no event.
    #[error("it has neither a percept nor a visit to a junction")]
    Empty,
    /// The events are out of order.
    #[error(transparent)]
    OutOfOrder(#[from] OutOfOrder),
}

/// Checks a run against the specification. A tolerated event is replaced by the expected one.
///
/// # Errors
/// Returns an error if there is no event, or if they are out of order.
pub fn judge(
    mut events: RunEvents,
    question: &ConformConfig,
    quirks: &Quirks,
    watch: &dyn Watch,
) -> Result<Judgement, JudgeError> {
    events.check_order()?;
    let mut tolerated: Vec<(Divergence, usize)> = Vec::new();
    loop {
        let mut judgement = Judgement::new(&events, question, &tolerated, watch)?;
        let found = judgement.divergence.clone().and_then(|divergence| {
            let quirk = quirks.tolerating(&divergence)?;
            amend(&mut events, &divergence).then_some((divergence, quirk))
        });
        let Some(found) = found else {
            judgement.tolerated = tolerated;
            return Ok(judgement);
        };
        tolerated.push(found);
    }
}

/// Replaces an event by the expected one; `false` if that is not known.
fn amend(events: &mut RunEvents, divergence: &Divergence) -> bool {
    let expected = match &divergence.cause {
        DivergenceCause::World(misfit) => expected_by(misfit),
        DivergenceCause::Algorithm(departure) => expected_after(departure),
        DivergenceCause::NotInTurn(_) | DivergenceCause::NoWorld { .. } => return false,
        // It is skipped.
        _ => return true,
    };
    let Some(expected) = expected else { return false };
    match events.events.get_mut(divergence.event).map(|event| &mut event.kind) {
        Some(CheckedKind::Arrival { arrival, .. }) => {
            arrival.percept = expected;
            // Its shape belongs to the tolerated percept.
            arrival.form = None;
            true
        }
        _ => false,
    }
}

/// The percept that all candidate poses expect.
fn expected_by(misfit: &Misfit) -> Option<Percept> {
    let mut expected = misfit.candidates.iter().map(|(_, why)| match why {
        MisfitReason::Percept { expected } => Some(*expected),
        MisfitReason::NoSuchDoor { .. } => None,
    });
    let first = expected.next()??;
    expected.all(|other| other == Some(first)).then_some(first)
}

/// The percept that Algorithm 1 expects.
fn expected_after(departure: &Departure) -> Option<Percept> {
    departure.allowed.iter().find_map(|allowed| match allowed.purpose {
        StepPurpose::Contradicted(
            Contradiction::KnownPlace { expected, .. } | Contradiction::WayBack { expected, .. },
        ) => Some(expected),
        _ => None,
    })
}

impl Judgement {
    fn new(
        events: &RunEvents,
        question: &ConformConfig,
        tolerated: &[(Divergence, usize)],
        watch: &dyn Watch,
    ) -> Result<Self, JudgeError> {
        let mut found = Found { tolerated, first: None };
        let trace = match events.trace() {
            Ok(all) => all,
            Err(TraceOrderError::Empty) => return Err(JudgeError::Empty),
            Err(
                not @ (TraceOrderError::NoDoor { event } | TraceOrderError::NoPercept { event }),
            ) => {
                found.note(event, DivergenceCause::NotInTurn(not));
                match event.checked_sub(1).map(|last| events.up_to(last).trace()) {
                    Some(Ok(before)) => before,
                    _ => return Err(JudgeError::Empty),
                }
            }
        };
        let in_turn = found.first.is_none();
        for (place, cause) in events.own_faults() {
            found.note(place, cause);
        }
        let len = events.events.len();
        let mut judgement = Self {
            events: events.clone(),
            divergence: None,
            poses: None,
            smallest: None,
            algorithm: None,
            coverage: RunCoverage { junctions: junctions(events), ..RunCoverage::default() },
            tolerated: Vec::new(),
            trace,
        };
        let trace = &judgement.trace;
        if let Some(known) = &question.world {
            let poses = poses(known.graph, &known.marker, &known.states, trace);
            if let Some(misfit) = &poses.misfit {
                let fault = known.fault(trace, misfit);
                found.note_as(misfit.event.id, DivergenceCause::World(misfit.clone()), fault);
            }
            judgement.poses = Some(poses);
        }
        let mut explored = None;
        if question.driver == RunDriver::Algorithm1 {
            let claim = if events.is_said_whole() { TraceClaim::Whole } else { TraceClaim::Part };
            let followed = match_algorithm(trace, claim, question.dart_bound);
            match &followed.reached {
                MatchEnd::Departure(departure) => {
                    found.note(departure.event.id, DivergenceCause::Algorithm(departure.clone()));
                }
                MatchEnd::Mapped => explored = followed.exploration.map().complete().cloned(),
                MatchEnd::EndOfTrace => {}
            }
            if in_turn {
                for cause in events.false_ending(&followed, question.world.as_ref()) {
                    found.note(len, cause);
                }
            }
            judgement.coverage.algorithm = followed.coverage.clone();
            judgement.algorithm = Some(followed);
        }
        if in_turn && let Some(cause) = events.false_moves(trace) {
            found.note(len, cause);
        }
        if question.world.is_none() {
            let darts = judgement
                .algorithm
                .as_ref()
                .map_or(0, |followed| followed.exploration.map().dart_count());
            // The bound must exceed what is already known.
            let edges = question.search.edges.max(darts.div_ceil(2) + BEYOND);
            let search = WorldSearch { edges, ..question.search };
            // A complete map is the only world that explains the run; an incomplete one is part of it.
            let smallest = if let Some(graph) = explored {
                SmallestWorld::World { graph, marker: Some(FACING) }
            } else {
                let followed = judgement.algorithm.as_ref();
                let known = followed.map(|followed| followed.exploration.map());
                smallest(trace, known, search, watch)
            };
            if let SmallestWorld::None { event } = smallest {
                // Everything before this event is explained.
                found.note(trace.event(event).id, DivergenceCause::NoWorld { edges });
            }
            judgement.smallest = Some(smallest);
        }
        judgement.divergence = found.first;
        Ok(judgement)
    }

    /// The verdict.
    #[must_use]
    pub fn verdict(&self) -> ConformVerdict {
        if self.divergence.is_some() {
            return ConformVerdict::Diverged;
        }
        let searched = !matches!(self.smallest, Some(SmallestWorld::Unfinished { .. }));
        if searched && self.events.is_whole(self.algorithm.is_some()) {
            ConformVerdict::Conforms
        } else {
            ConformVerdict::Incomplete
        }
    }

    /// The number of candidate poses after the last event that fits; 1 if the world was not known and one
    /// was found.
    #[must_use]
    pub fn candidates(&self) -> usize {
        match (&self.poses, &self.smallest) {
            (Some(poses), _) => poses.states.len(),
            (None, Some(SmallestWorld::World { .. })) => 1,
            _ => 0,
        }
    }
}

/// The first divergence that is not tolerated.
struct Found<'t> {
    tolerated: &'t [(Divergence, usize)],
    first: Option<Divergence>,
}

impl Found<'_> {
    fn note(&mut self, event: usize, cause: DivergenceCause) {
        let fault = cause.fault();
        self.note_as(event, cause, fault);
    }

    /// Of two at the same event, the first to be noted counts.
    fn note_as(&mut self, event: usize, cause: DivergenceCause, fault: FaultClass) {
        let same = |other: &Divergence| other.event == event && other.cause.name() == cause.name();
        let tolerated = self.tolerated.iter().any(|(tolerated, _)| same(tolerated));
        let earlier = self.first.as_ref().is_none_or(|first| event < first.event);
        if earlier && !tolerated {
            self.first = Some(Divergence { event, cause, fault });
        }
    }
}

/// Worlds with at least this many more edges than Algorithm 1 knows are tried.
const BEYOND: usize = 4;

/// The number of arrivals at each junction shape, seen from the entry door.
fn junctions(events: &RunEvents) -> BTreeMap<JunctionShape, u64> {
    let mut counts = BTreeMap::new();
    for CheckedEvent { kind, .. } in &events.events {
        if let CheckedKind::Arrival { arrival, .. } = kind
            && let Some(form) = arrival.form
        {
            *counts.entry(form).or_default() += 1;
        }
    }
    counts
}
