//! Judges a recorded run: its consistency, a known world or the smallest one, and its algorithm.
//! Sections 2.1 and 2.3.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;
use thiserror::Error;
use toposlam_model::{
    driving::visit::JunctionShape,
    enumerate::Watch,
    folding::{FoldedTrail, MarkedTrails, SearchLimit, SmallestWorld, smallest_world},
    mapping::MappingAlgorithm,
    marker::{Directional, Marker, Undirected},
    trace::{AlgorithmCoverage, AlgorithmMatch, MatchEnd, Poses, Trace, TraceOrderError, poses},
};

use super::{
    config::ConformConfig,
    divergence::{Divergence, DivergenceCause, FaultClass},
    events::{CheckedEvent, CheckedKind, OutOfOrder, RunEvents, SightingError},
    impossible::{FoldedTrace, Impossibility, first_percept, folded_before},
    measured_hallways::MeasuredHallways,
    quirks::Quirks,
    tolerance::Tolerance,
};

/// The result of checking a run.
#[derive(Clone, Debug)]
pub struct Judgement {
    /// The events; a tolerated event is replaced by the expected one.
    pub events: RunEvents,
    /// Its arrivals and doors, up to the first that is out of turn. The ids are indices of `events`.
    pub trace: Trace,
    /// The first divergence.
    pub divergence: Option<Divergence>,
    /// The index of the first arrival after the robot got lost. Without a known world, the events from there on are
    /// compared with no world.
    pub lost: Option<usize>,
    /// The index of the first visit of a junction that was not recognised. The events from there on are not
    /// checked.
    pub unrecognised: Option<usize>,
    /// The folded trail of the events before the divergence, or of all; `None` if there is none, or if it is
    /// too large.
    pub trail: Option<FoldedTrail>,
    /// The candidate poses in the known world.
    pub poses: Option<Poses>,
    /// The smallest world that explains the log, if none is known and one of any size may.
    pub smallest: Option<SmallestWorld>,
    /// Whether the events before the divergence, or all, determine their world; `None` if this is not known.
    determined: Option<bool>,
    /// The number of ways in which the visits of an undirected marker can be visits of one junction, as far as
    /// it was counted; 1 with other markers.
    pub ways: usize,
    /// How many hallways were measured by odometry, and compared.
    pub measured: MeasuredHallways,
    /// How far the algorithm follows the log.
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ConformVerdict {
    /// Everything fits.
    Conforms,
    /// An event does not fit.
    Diverged,
    /// Everything fits, but the run or the search is not complete.
    #[default]
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
    /// An event is earlier than the one before it.
    #[error("event {event}: {order}")]
    OutOfOrder {
        /// Its number, counted from 1.
        event: usize,
        /// The times.
        order: OutOfOrder,
    },
    /// The percepts do not record the marker.
    #[error(transparent)]
    Marker(#[from] SightingError),
    /// The algorithm does not run with this marker.
    #[error("{} needs the directional marker, not `{marker}`", algorithm.in_words())]
    Algorithm {
        /// The algorithm.
        algorithm: MappingAlgorithm,
        /// The name of the marker.
        marker: &'static str,
    },
}

/// A limit that was reached before everything was checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReachedLimit {
    /// A world explains the log. The search for smaller ones ended early.
    SmallerWorld(SearchLimit),
    /// The search ended before a world of the class was found.
    World(SearchLimit),
    /// The algorithm would know more darts than a bound allows.
    Darts {
        /// The algorithm.
        algorithm: MappingAlgorithm,
        /// The index of the event.
        event: usize,
        /// The bound.
        bound: usize,
    },
}

/// Checks a run against the specification. A tolerated event is replaced by the expected one.
///
/// # Errors
/// Returns an error if there is no event, if they are out of order, if they do not record the marker, or if
/// the algorithm does not run with the marker.
pub fn judge(
    mut events: RunEvents,
    question: &ConformConfig,
    quirks: &Quirks,
    watch: &dyn Watch,
) -> Result<Judgement, JudgeError> {
    check_order(&events)?;
    events.complete_sightings(question.marker)?;
    let marker = question.marker.name();
    if let Some(algorithm) = question.driver.algorithm()
        && marker != Directional.name()
    {
        return Err(JudgeError::Algorithm { algorithm, marker });
    }
    let mut tolerance = Tolerance::new(events, quirks, question);
    loop {
        let judgement = Judgement::new(tolerance.events(), question, tolerance.noted(), watch)?;
        if !tolerance.grows(judgement.divergence.as_ref()) {
            let judgement = match judgement.divergence {
                Some(Divergence { event, cause: DivergenceCause::Undecided(_), .. }) => {
                    judgement.up_to(event, question, tolerance.noted(), watch)?
                }
                _ => judgement,
            };
            return Ok(Judgement { tolerated: tolerance.finish(), ..judgement });
        }
    }
}

fn check_order(events: &RunEvents) -> Result<(), JudgeError> {
    for (index, two) in events.events.windows(2).enumerate() {
        OutOfOrder::check(two[0].source.time, two[1].source.time)
            .map_err(|order| JudgeError::OutOfOrder { event: index + 2, order })?;
    }
    Ok(())
}

/// What a walk shows of its world if all sightings of an undirected marker are of one vertex.
struct MarkedTrail {
    /// The folded trail, if the sightings are of one vertex in one way only.
    trail: Option<FoldedTrail>,
    /// Whether the walk determines its world; `None` if that is not known.
    determined: Option<bool>,
    /// In how many ways they are of one vertex.
    ways: usize,
    /// Where they cannot be.
    impossible: Option<(usize, Impossibility)>,
}

impl MarkedTrail {
    fn new(before: &FoldedTrail, trace: &Trace, watch: &dyn Watch) -> Self {
        let MarkedTrails { trails, may_be_more } = before.with_one_marked_vertex(watch);
        let is_impossible = |trail: &FoldedTrail| {
            let found = trail.with_one_marked_vertex(watch);
            found.trails.is_empty() && !found.may_be_more
        };
        let impossible = (trails.is_empty() && !may_be_more).then(|| {
            (first_percept(trace, before.moves(), is_impossible), Impossibility::OnePlace)
        });
        let determined = match &trails[..] {
            [one] if !may_be_more => Some(one.open_count() == 0),
            [] | [_] => None,
            _ => Some(false),
        };
        let ways = trails.len();
        let trail = trails.into_iter().next().filter(|_| ways == 1 && !may_be_more);
        Self { trail, determined, ways, impossible }
    }
}

impl Judgement {
    fn new(
        events: &RunEvents,
        question: &ConformConfig,
        tolerated: &BTreeSet<(usize, &'static str)>,
        watch: &dyn Watch,
    ) -> Result<Self, JudgeError> {
        #[cfg(test)]
        JUDGED.set(JUDGED.get() + 1);
        let mut found = Found { tolerated, first: None };
        let trace = trace_in_turn(events, &mut found)?;
        let in_turn = found.first.is_none();
        for (place, cause) in events.own_faults() {
            found.note(place, cause);
        }
        let mut judgement = Self {
            events: events.clone(),
            divergence: None,
            lost: trace.lost().first().map(|&percept| trace.percept_event(percept).id),
            unrecognised: None,
            trail: None,
            poses: None,
            smallest: None,
            determined: None,
            ways: 1,
            measured: MeasuredHallways::default(),
            algorithm: None,
            coverage: RunCoverage { junctions: junctions(events), ..RunCoverage::default() },
            tolerated: Vec::new(),
            trace,
        };
        judgement.compare_world(question, &mut found);
        judgement.follow_algorithm(question, in_turn, &mut found);
        if in_turn && let Some(cause) = events.false_moves(&judgement.trace) {
            found.note(events.events.len(), cause);
        }
        let impossible = judgement.fold(question, watch);
        judgement.compare_lengths(question, &mut found);
        if question.world.is_none() {
            judgement.explain(impossible, question, watch, &mut found);
        }
        if let Some(first) = &found.first {
            let before = judgement.trace.index_of(first.event);
            judgement.trail = judgement.trail.and_then(|_| folded_before(&judgement.trace, before));
        }
        judgement.divergence = found.first;
        Ok(judgement)
    }

    /// Compares the events with the known world.
    fn compare_world(&mut self, question: &ConformConfig, found: &mut Found) {
        let Some(known) = &question.world else { return };
        let poses = poses(known.graph, &question.marker, &known.states, &self.trace);
        if let Some(misfit) = &poses.misfit {
            let fault = known.fault(&self.trace, misfit, question.marker);
            found.note_as(misfit.event.id, DivergenceCause::World(misfit.clone()), fault);
        }
        self.poses = Some(poses);
    }

    /// Folds the walk. Returns where no world explains it.
    fn fold(
        &mut self,
        question: &ConformConfig,
        watch: &dyn Watch,
    ) -> Option<(usize, Impossibility)> {
        let FoldedTrace { mut trail, mut impossible } =
            FoldedTrace::new(&self.trace, question.marker, question.search.class);
        if question.marker.name() == Undirected.name()
            && let Some(before) = &trail
        {
            let marked = MarkedTrail::new(before, &self.trace, watch);
            self.ways = marked.ways;
            self.determined = marked.determined;
            let first = [impossible, marked.impossible].into_iter().flatten();
            impossible = first.min_by_key(|(event, _)| *event);
            trail = marked.trail.or(trail);
        } else {
            self.determined = trail.as_ref().map(|trail| trail.open_count() == 0);
        }
        if self.lost.is_some() {
            // What follows may determine the world, too.
            self.determined = self.determined.filter(|&is_determined| is_determined);
        }
        self.trail = trail;
        impossible
    }

    /// Compares the lengths of hallways, their turns, and the shapes of junctions.
    fn compare_lengths(&mut self, question: &ConformConfig, found: &mut Found) {
        let graph = question.world.as_ref().map(|known| known.graph);
        let (measured, moved) = MeasuredHallways::compare(
            &self.events,
            &self.trace,
            self.trail.as_ref(),
            graph.zip(self.poses.as_ref()),
        );
        self.measured = measured;
        if let Some((event, cause)) = moved {
            found.note(event, cause);
        }
    }

    /// Searches for the smallest world that explains the walk, unless none does.
    fn explain(
        &mut self,
        mut impossible: Option<(usize, Impossibility)>,
        question: &ConformConfig,
        watch: &dyn Watch,
        found: &mut Found,
    ) {
        if impossible.is_none() {
            let search = |trail: &FoldedTrail| smallest_world(trail, question.search, watch);
            let too_large = SmallestWorld::NotFound { limit: SearchLimit::Decisions };
            let smallest = self.trail.as_ref().map_or(too_large, search);
            if smallest == SmallestWorld::NoWorld {
                let moves = self.trail.as_ref().map_or(0, FoldedTrail::moves);
                let is_impossible = |trail: &FoldedTrail| search(trail) == SmallestWorld::NoWorld;
                let event = first_percept(&self.trace, moves, is_impossible);
                impossible = Some((event, Impossibility::Class { class: question.search.class }));
            } else {
                self.smallest = Some(smallest);
            }
        }
        if let Some((event, why)) = impossible {
            let event = self.trace.event(event);
            found.note(event.id, DivergenceCause::NoWorld { event, why });
        }
    }

    /// Compares the doors with the algorithm, and what it knows with the recorded end.
    fn follow_algorithm(&mut self, question: &ConformConfig, in_turn: bool, found: &mut Found) {
        let Some(followed) = question.follow(&self.trace, &self.events) else { return };
        match &followed.reached {
            MatchEnd::Departure(departure) => {
                found.note(departure.event.id, DivergenceCause::Algorithm(departure.clone()));
            }
            MatchEnd::Mapped | MatchEnd::EndOfTrace | MatchEnd::Bound { .. } => {}
        }
        if in_turn {
            for cause in self.events.false_ending(&followed, question.world.as_ref()) {
                found.note(self.events.events.len(), cause);
            }
        }
        self.coverage.algorithm = followed.coverage.clone();
        self.algorithm = Some(followed);
    }

    /// The judgement of the events before one at which it is not known what the robot perceived. That is no
    /// fault of the run.
    fn up_to(
        self,
        event: usize,
        question: &ConformConfig,
        tolerated: &BTreeSet<(usize, &'static str)>,
        watch: &dyn Watch,
    ) -> Result<Self, JudgeError> {
        let before = match event.checked_sub(1) {
            Some(last) => Self::new(&self.events.up_to(last), question, tolerated, watch)?,
            None => Self {
                // Its trail ends before its first event: there is none.
                divergence: None,
                poses: None,
                smallest: None,
                determined: None,
                algorithm: None,
                coverage: RunCoverage::default(),
                ..self.clone()
            },
        };
        Ok(Self { events: self.events, unrecognised: Some(event), ..before })
    }

    /// The verdict.
    #[must_use]
    pub fn verdict(&self) -> ConformVerdict {
        if self.divergence.is_some() {
            ConformVerdict::Diverged
        } else if self.unrecognised.is_none()
            && (self.lost.is_none() || self.poses.is_some())
            && self.is_decided()
            && self.events.is_whole(self.algorithm.is_some())
        {
            ConformVerdict::Conforms
        } else {
            ConformVerdict::Incomplete
        }
    }

    /// Whether no limit leaves the verdict open.
    #[must_use]
    pub fn is_decided(&self) -> bool {
        self.limits().iter().all(|limit| matches!(limit, ReachedLimit::SmallerWorld(_)))
    }

    /// The limits that were reached.
    #[must_use]
    pub fn limits(&self) -> Vec<ReachedLimit> {
        let mut limits = Vec::new();
        match self.smallest {
            Some(SmallestWorld::World { limit: Some(limit), .. }) => {
                limits.push(ReachedLimit::SmallerWorld(limit));
            }
            Some(SmallestWorld::NotFound { limit }) => limits.push(ReachedLimit::World(limit)),
            _ => {}
        }
        if let Some(AlgorithmMatch {
            algorithm, reached: MatchEnd::Bound { event, bound }, ..
        }) = &self.algorithm
        {
            let (algorithm, event, bound) = (*algorithm, event.id, *bound);
            limits.push(ReachedLimit::Darts { algorithm, event, bound });
        }
        limits
    }

    /// Whether the log determines its world: no other world explains it, whatever its size. `None` if the log
    /// diverges, or if this is not known.
    #[must_use]
    pub fn determines_world(&self) -> Option<bool> {
        self.determined.filter(|_| self.divergence.is_none())
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

/// The trace of the events up to the first that is out of turn, which is noted.
fn trace_in_turn(events: &RunEvents, found: &mut Found) -> Result<Trace, JudgeError> {
    match events.trace() {
        Ok(all) => Ok(all),
        Err(TraceOrderError::Empty) => Err(JudgeError::Empty),
        Err(not @ (TraceOrderError::NoDoor { event } | TraceOrderError::NoPercept { event })) => {
            found.note(event, DivergenceCause::NotInTurn(not));
            match event.checked_sub(1).map(|last| events.up_to(last).trace()) {
                Some(Ok(before)) => Ok(before),
                _ => Err(JudgeError::Empty),
            }
        }
    }
}

/// The first divergence that is not tolerated.
struct Found<'t> {
    /// The events and causes that are.
    tolerated: &'t BTreeSet<(usize, &'static str)>,
    first: Option<Divergence>,
}

impl Found<'_> {
    fn note(&mut self, event: usize, cause: DivergenceCause) {
        let fault = cause.fault();
        self.note_as(event, cause, fault);
    }

    /// Of two at the same event, the first to be noted counts.
    fn note_as(&mut self, event: usize, cause: DivergenceCause, fault: FaultClass) {
        let earlier = self.first.as_ref().is_none_or(|first| event < first.event);
        if earlier && !self.tolerated.contains(&(event, cause.name())) {
            self.first = Some(Divergence { event, cause, fault });
        }
    }
}

#[cfg(test)]
thread_local! {
    /// The number of times that this thread has judged a whole run.
    pub(super) static JUDGED: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
}

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
