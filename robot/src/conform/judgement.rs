//! The judgement of a recorded run: against itself, a known world or some world, and Algorithm 1.
//! Sections 2.1 and 2.3.

use std::collections::BTreeMap;

use thiserror::Error;
use toposlam_model::{
    driving::visit::JunctionShape,
    enumerate::Watch,
    mapping::{Contradiction, FACING},
    percept::Percept,
    trace::{
        AlgorithmCoverage, Claim, Departure, Followed, Misfit, MisfitReason, Poses, Purpose,
        Reached, SmallestWorld, Trace, TraceOrderError, WorldSearch, follow, poses, smallest,
    },
};

use super::{
    divergence::{Divergence, DivergenceCause, FaultClass},
    events::{CheckedEvent, CheckedKind, OutOfOrder, RunEvents},
    known_world::KnownWorld,
    quirks::Quirks,
};

/// What a run is held against.
#[derive(Clone, Debug)]
pub struct ConformConfig<'w> {
    /// The world in which it was, where that is known.
    pub world: Option<KnownWorld<'w>>,
    /// Who took the doors.
    pub driver: RunDriver,
    /// Which worlds are searched for one that explains the log, where none is known.
    pub search: WorldSearch,
    /// How many darts Algorithm 1 may come to know.
    pub dart_bound: usize,
}

/// Who takes the doors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunDriver {
    /// Algorithm 1, with any choices.
    Algorithm1,
    /// Anyone, wherever they like.
    Anyone,
}

/// What the specification says of a run.
#[derive(Clone, Debug)]
pub struct Judgement {
    /// What was judged; where quirks were tolerated, as it should have been.
    pub events: RunEvents,
    /// Its arrivals and doors, up to the first that is out of turn. The ids are indices of `events`.
    pub trace: Trace,
    /// The first event that does not fit.
    pub divergence: Option<Divergence>,
    /// How the robot may stand in the known world.
    pub poses: Option<Poses>,
    /// The smallest world that explains the log, where none is known.
    pub smallest: Option<SmallestWorld>,
    /// How far Algorithm 1 goes along.
    pub followed: Option<Followed>,
    /// What the run went through.
    pub coverage: RunCoverage,
    /// Divergences that were tolerated, in order, with the quirk's place in its file.
    pub tolerated: Vec<(Divergence, usize)>,
}

/// The cases that a run went through.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RunCoverage {
    /// Of Algorithm 1.
    pub algorithm: AlgorithmCoverage,
    /// Of perception: each kind of junction, from each of its entries.
    pub junctions: BTreeMap<JunctionShape, u64>,
}

impl RunCoverage {
    /// Takes in what happened in another run.
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
    /// All of it fits.
    Conforms,
    /// An event does not fit.
    Diverged,
    /// All of it fits, but it is not all.
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

/// Nothing that could be judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum JudgeError {
    /// There is no event.
    #[error("there is neither a percept nor a visit to a junction in it")]
    Empty,
    /// The events are out of order.
    #[error(transparent)]
    OutOfOrder(#[from] OutOfOrder),
}

/// Holds a run against the specification. Quirks are tolerated, and judged as they should have been.
///
/// # Errors
/// Where there is no event, and where they are out of order.
pub fn judge(
    mut events: RunEvents,
    question: &ConformConfig,
    quirks: &Quirks,
    watch: &impl Watch,
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

/// Makes of an event what it should have been; `false` where that is not known.
fn amend(events: &mut RunEvents, divergence: &Divergence) -> bool {
    let expected = match &divergence.cause {
        DivergenceCause::World(misfit) => expected_by(misfit),
        DivergenceCause::Algorithm(departure) => expected_after(departure),
        DivergenceCause::NotInTurn(_) | DivergenceCause::NoWorld { .. } => return false,
        // It is passed over.
        _ => return true,
    };
    let Some(expected) = expected else { return false };
    match events.events.get_mut(divergence.event).map(|event| &mut event.kind) {
        Some(CheckedKind::Arrival { arrival, .. }) => {
            arrival.percept = expected;
            // What it looked like is what is tolerated.
            arrival.form = None;
            true
        }
        _ => false,
    }
}

/// What should be perceived at every pose that is left.
fn expected_by(misfit: &Misfit) -> Option<Percept> {
    let mut expected = misfit.candidates.iter().map(|(_, why)| match why {
        MisfitReason::Percept { expected } => Some(*expected),
        MisfitReason::NoSuchDoor { .. } => None,
    });
    let first = expected.next()??;
    expected.all(|other| other == Some(first)).then_some(first)
}

/// What Algorithm 1 expects to be perceived.
fn expected_after(departure: &Departure) -> Option<Percept> {
    departure.allowed.iter().find_map(|allowed| match allowed.purpose {
        Purpose::Contradicted(
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
        watch: &impl Watch,
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
            followed: None,
            coverage: RunCoverage { junctions: junctions(events), ..RunCoverage::default() },
            tolerated: Vec::new(),
            trace,
        };
        let trace = &judgement.trace;
        if let Some(known) = &question.world {
            let poses = poses(known.graph, &known.marker, &known.states, trace);
            if let Some(misfit) = &poses.misfit {
                let culprit = known.culprit(trace, misfit);
                found.note_as(misfit.event.id, DivergenceCause::World(misfit.clone()), culprit);
            }
            judgement.poses = Some(poses);
        }
        let mut explored = None;
        if question.driver == RunDriver::Algorithm1 {
            let claim = if events.is_said_whole() { Claim::Whole } else { Claim::Part };
            let followed = follow(trace, claim, question.dart_bound);
            match &followed.reached {
                Reached::Departure(departure) => {
                    found.note(departure.event.id, DivergenceCause::Algorithm(departure.clone()));
                }
                Reached::Mapped => explored = followed.exploration.map().complete().cloned(),
                Reached::EndOfTrace => {}
            }
            if in_turn {
                for cause in events.false_ending(&followed, question.world.as_ref()) {
                    found.note(len, cause);
                }
            }
            judgement.coverage.algorithm = followed.coverage.clone();
            judgement.followed = Some(followed);
        }
        if in_turn && let Some(cause) = events.false_moves(trace) {
            found.note(len, cause);
        }
        if question.world.is_none() {
            let darts = judgement
                .followed
                .as_ref()
                .map_or(0, |followed| followed.exploration.map().dart_count());
            // A bound below what is known already would be none.
            let edges = question.search.edges.max(darts.div_ceil(2) + BEYOND);
            let search = WorldSearch { edges, ..question.search };
            // Algorithm 1 has told its world from every other; one that it has not done with has all that
            // it knows.
            let smallest = if let Some(graph) = explored {
                SmallestWorld::World { graph, marker: Some(FACING) }
            } else {
                let followed = judgement.followed.as_ref();
                let known = followed.map(|followed| followed.exploration.map());
                smallest(trace, known, search, watch)
            };
            if let SmallestWorld::None { event } = smallest {
                // It is the fault of an event, if of any, before which all is explained.
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
        if searched && self.events.is_whole(self.followed.is_some()) {
            ConformVerdict::Conforms
        } else {
            ConformVerdict::Incomplete
        }
    }

    /// In how many ways the robot may stand after the last event that fits: in the known world, or, where
    /// none is known and one was found, 1.
    #[must_use]
    pub fn candidates(&self) -> usize {
        match (&self.poses, &self.smallest) {
            (Some(poses), _) => poses.states.len(),
            (None, Some(SmallestWorld::World { .. })) => 1,
            _ => 0,
        }
    }
}

/// The first divergence, of those that are not tolerated.
struct Found<'t> {
    tolerated: &'t [(Divergence, usize)],
    first: Option<Divergence>,
}

impl Found<'_> {
    fn note(&mut self, event: usize, cause: DivergenceCause) {
        let culprit = cause.culprit();
        self.note_as(event, cause, culprit);
    }

    /// Of two at one event the one noted first counts.
    fn note_as(&mut self, event: usize, cause: DivergenceCause, culprit: FaultClass) {
        let same = |other: &Divergence| other.event == event && other.cause.name() == cause.name();
        let tolerated = self.tolerated.iter().any(|(tolerated, _)| same(tolerated));
        let earlier = self.first.as_ref().is_none_or(|first| event < first.event);
        if earlier && !tolerated {
            self.first = Some(Divergence { event, cause, culprit });
        }
    }
}

/// Where Algorithm 1 knows a part of a world, worlds with so many more edges are tried at least.
const BEYOND: usize = 4;

/// How often each kind of junction was perceived, from each of its entries.
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
