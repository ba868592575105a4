//! Judges a recorded run: its consistency, a known world or the smallest one, and its algorithm.
//! Sections 2.1 and 2.3.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Serialize, Serializer};
use thiserror::Error;
use toposlam_logs::record::Arrival;
use toposlam_model::{
    aid::{Aid, AidAction, AidKind, Places, State},
    driving::visit::JunctionShape,
    embedded_graph::EmbeddedGraph,
    enumerate::Watch,
    folding::{FoldedTrail, MarkedTrails, SearchLimit, SmallestWorld, smallest_world},
    mapping::{FACING, MappingAlgorithm},
    marker::Undirected,
    percept::{Percept, Sighting},
    trace::{
        AlgorithmCoverage, AlgorithmMatch, MatchEnd, Poses, Trace, TraceEventKind, TraceOrderError,
        poses,
    },
};

use super::{
    config::ConformConfig,
    divergence::{Divergence, DivergenceCause, FaultClass},
    events::{CheckedEvent, CheckedKind, OutOfOrder, RunEvents, SightingError},
    impossible::{FoldedTrace, Impossibility, first_percept, folded_before},
    measured_hallways::MeasuredHallways,
    possible_visits::PossibleVisits,
    quirks::Quirks,
    tolerance::Tolerance,
};

#[derive(Clone, Debug)]
pub struct Judgement {
    /// The events; a tolerated event is replaced by the expected one.
    pub events: RunEvents,
    /// Its arrivals and doors, up to the first that is out of turn. The ids are indices of `events`.
    pub trace: Trace,
    pub divergence: Option<Divergence>,
    /// A divergence that accuses nobody, and why.
    pub contradiction: Option<(Divergence, Unproved)>,
    /// The visits as sets, which decide the verdict: of a log of scans, and of one of images if some are not certain.
    pub possible: Option<PossibleVisits>,
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
    pub poses: Option<Poses<Places>>,
    /// The smallest world that explains the log, if none is known and one of any size may.
    pub smallest: Option<SmallestWorld>,
    /// Whether the events before the divergence, or all, determine their world; `None` if this is not known.
    determined: Option<bool>,
    /// The number of ways in which the visits of an undirected marker can be visits of one junction, as far as
    /// it was counted; 1 with other markers.
    pub ways: usize,
    pub measured: MeasuredHallways,
    /// How far the algorithm follows the log.
    pub algorithm: Option<AlgorithmMatch>,
    pub coverage: RunCoverage,
    /// The tolerated divergences in order, each with the index of its quirk.
    pub tolerated: Vec<(Divergence, usize)>,
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RunCoverage {
    pub algorithm: AlgorithmCoverage,
    /// The junction shapes, seen from the entry door.
    pub junctions: BTreeMap<JunctionShape, u64>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ConformVerdict {
    /// Everything fits.
    Conforms,
    /// An event does not fit.
    Diverged,
    /// Everything fits, but the run or the search is not complete; or only what may be seen wrongly does not fit.
    #[default]
    NotKnown,
}

impl Serialize for ConformVerdict {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.name().serialize(serializer)
    }
}

impl ConformVerdict {
    pub fn name(self) -> &'static str {
        match self {
            Self::Conforms => "conforms",
            Self::Diverged => "diverged",
            Self::NotKnown => "not-known",
        }
    }

    pub fn in_words(self) -> &'static str {
        if self == Self::NotKnown { "not known" } else { self.name() }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum JudgeError {
    #[error("it has neither a percept nor a visit to a junction")]
    Empty,
    /// An event, counted from 1, is earlier than the one before it.
    #[error("event {event}: {order}")]
    OutOfOrder { event: usize, order: OutOfOrder },
    #[error(transparent)]
    Marker(#[from] SightingError),
    #[error("{} needs `{}`, not `{aid}`", algorithm.in_words(), algorithm.aid().name())]
    Algorithm { algorithm: MappingAlgorithm, aid: &'static str },
    /// An event, counted from 1.
    #[error("event {event}: a robot with `{aid}` cannot do `{action}`")]
    Action { event: usize, action: AidAction, aid: &'static str },
}

/// Why a divergence accuses nobody.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unproved {
    /// Scans may show an arm wrongly where the robot did not drive.
    Scans,
    /// By odometry that drifts, a pass lies beside the place that it is of.
    Poses,
    /// The robot got lost, which events that are inferred do not show.
    Lost,
    /// The robot turned back at an obstacle as from a dead end, which events that are inferred do not show.
    Obstacle,
}

impl Unproved {
    /// Why events that are inferred from the scenes of a run accuse nobody, by what its log records: a robot that recovers
    /// went on where its scenes show no junction.
    pub(super) fn after_recovery(recorded: &RunEvents) -> Option<Self> {
        let first = recorded.events.iter().position(|event| event.arrival().is_some());
        let mut arrivals = recorded.events.iter().filter_map(CheckedEvent::arrival);
        if recorded.relocations().any(|at| Some(at) != first) {
            Some(Self::Lost)
        } else if recorded.has_head && arrivals.any(Arrival::is_at_obstacle) {
            Some(Self::Obstacle)
        } else {
            None
        }
    }
}

/// A limit that was reached before everything was checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReachedLimit {
    /// A world explains the log. The search for smaller ones ended early.
    SmallerWorld(SearchLimit),
    /// The search ended before a world of the class was found.
    World(SearchLimit),
    /// From the event of this index on, the algorithm would know more darts than a bound allows.
    Darts { algorithm: MappingAlgorithm, event: usize, bound: usize },
}

/// Checks a run against the specification. A tolerated event is replaced by the expected one.
///
/// # Errors
/// Returns an error if there is no event, if they are out of order, if they do not record the marker, or if
/// the algorithm does not run with the marker.
pub fn judge(
    mut events: RunEvents,
    config: &ConformConfig,
    quirks: &Quirks,
    watch: &dyn Watch,
) -> Result<Judgement, JudgeError> {
    for (index, two) in events.events.windows(2).enumerate() {
        OutOfOrder::check(two[0].source.time, two[1].source.time)
            .map_err(|order| JudgeError::OutOfOrder { event: index + 2, order })?;
    }
    events.complete_sightings(config.aid)?;
    let aid = config.aid.name();
    if let Some(algorithm) = config.driver.algorithm().filter(|it| it.aid() != config.aid) {
        return Err(JudgeError::Algorithm { algorithm, aid });
    }
    if let Some((index, action)) = events.first_action().filter(|_| !config.aid.moves()) {
        return Err(JudgeError::Action { event: index + 1, action, aid });
    }
    if let Some(undecided) = Judgement::of_undecided(&events) {
        return Ok(undecided);
    }
    let mut tolerance = Tolerance::new(events, quirks, config);
    loop {
        let judgement = Judgement::new(&tolerance.amended, config, &tolerance.noted, watch)?;
        if !tolerance.grows(judgement.divergence.as_ref()) {
            let judgement = match judgement.divergence {
                Some(Divergence { event, cause: DivergenceCause::Undecided(_), .. }) => {
                    judgement.up_to(event, config, &tolerance.noted, watch)?
                }
                _ => judgement,
            };
            return Ok(Judgement { tolerated: tolerance.tolerated, ..judgement });
        }
    }
}

impl Judgement {
    fn new(
        events: &RunEvents,
        config: &ConformConfig,
        tolerated: &BTreeSet<(usize, &'static str)>,
        watch: &dyn Watch,
    ) -> Result<Self, JudgeError> {
        #[cfg(test)]
        JUDGED.set(JUDGED.get() + 1);
        let mut found = FirstDivergence { tolerated, first: None };
        let trace = trace_in_turn(events, &mut found)?;
        let in_turn = found.first.is_none();
        for (place, cause) in events.own_faults() {
            found.note(place, cause);
        }
        let mut junctions = BTreeMap::new();
        for shape in events.events.iter().filter_map(|event| event.arrival()?.shape) {
            *junctions.entry(shape).or_default() += 1;
        }
        let lost = trace.lost().first().map(|&percept| trace.percept_event(percept).id);
        let coverage = RunCoverage { junctions, ..RunCoverage::default() };
        let mut judgement = Self { lost, coverage, ..Self::uncompared(events, trace) };
        judgement.compare_world(config, &mut found);
        judgement.follow_algorithm(config, in_turn, &mut found);
        if in_turn && let Some(cause) = events.false_moves(&judgement.trace) {
            found.note(events.events.len(), cause);
        }
        let impossible = judgement.fold(config, watch);
        judgement.compare_lengths(config, &mut found);
        if config.world.is_none() {
            judgement.explain(impossible, config, watch, &mut found);
        }
        if let Some(first) = &found.first {
            let before = judgement.trace.index_of(first.event);
            judgement.trail = judgement.trail.and_then(|_| folded_before(&judgement.trace, before));
        }
        judgement.divergence = found.first;
        Ok(judgement)
    }

    /// The judgement of a run of which no visit is decided, if it is one: nothing is compared.
    fn of_undecided(events: &RunEvents) -> Option<Self> {
        let is_undecided = |event: &CheckedEvent| matches!(event.kind, CheckedKind::Undecided(_));
        let unrecognised = Some(events.events.iter().position(is_undecided)?);
        if events.trace() != Err(TraceOrderError::Empty) {
            return None;
        }
        // A trace is never empty. Nothing is compared with this one.
        let any = Percept { degree: 1, sighting: Sighting::Nothing };
        let trace = Trace::new([TraceEventKind::Percept(any)]).ok()?;
        Some(Self { unrecognised, ..Self::uncompared(events, trace) })
    }

    /// The judgement before anything is compared.
    fn uncompared(events: &RunEvents, trace: Trace) -> Self {
        Self {
            events: events.clone(),
            trace,
            divergence: None,
            contradiction: None,
            possible: None,
            lost: None,
            unrecognised: None,
            trail: None,
            poses: None,
            smallest: None,
            determined: None,
            ways: 1,
            measured: MeasuredHallways::default(),
            algorithm: None,
            coverage: RunCoverage::default(),
            tolerated: Vec::new(),
        }
    }

    fn compare_world(&mut self, config: &ConformConfig, found: &mut FirstDivergence) {
        let Some(known) = &config.world else { return };
        let poses = poses(&known.graph, &config.aid, &known.states, &self.trace);
        if let Some(misfit) = &poses.misfit {
            let fault = known.fault(&self.trace, misfit, config.aid);
            found.note_as(misfit.event.id, DivergenceCause::World(misfit.clone()), fault);
        }
        self.poses = Some(poses);
    }

    /// Folds the walk. Returns where no world explains it.
    fn fold(
        &mut self,
        config: &ConformConfig,
        watch: &dyn Watch,
    ) -> Option<(usize, Impossibility)> {
        let FoldedTrace { trail, mut impossible } =
            FoldedTrace::new(&self.trace, config.aid, config.search.class);
        self.determined = trail.as_ref().map(|trail| trail.open_count() == 0);
        self.trail = trail;
        if config.aid == AidKind::Fixed(Undirected) {
            let elsewhere = self.unite_marked(watch);
            impossible =
                [impossible, elsewhere].into_iter().flatten().min_by_key(|(event, _)| *event);
        }
        if self.lost.is_some() {
            // What follows may determine the world, too.
            self.determined = self.determined.filter(|&is_determined| is_determined);
        }
        impossible
    }

    /// All sightings of an undirected marker are of one vertex. Returns where they cannot be.
    fn unite_marked(&mut self, watch: &dyn Watch) -> Option<(usize, Impossibility)> {
        let before = self.trail.as_ref()?;
        let MarkedTrails { mut trails, may_be_more } = before.with_one_marked_vertex(watch);
        self.ways = trails.len();
        self.determined = match &trails[..] {
            [one] if !may_be_more => Some(one.open_count() == 0),
            [] | [_] => None,
            _ => Some(false),
        };
        let impossible = (trails.is_empty() && !may_be_more).then(|| {
            let is_impossible = |trail: &FoldedTrail| {
                let found = trail.with_one_marked_vertex(watch);
                found.trails.is_empty() && !found.may_be_more
            };
            let event = first_percept(&self.trace, before.moves(), is_impossible);
            (event, Impossibility::OnePlace)
        });
        if self.ways == 1 && !may_be_more {
            self.trail = trails.pop();
        }
        impossible
    }

    /// Compares the lengths of hallways, their turns, and the shapes of junctions.
    fn compare_lengths(&mut self, config: &ConformConfig, found: &mut FirstDivergence) {
        let graph = config.world.as_ref().map(|known| &known.graph);
        let known = graph.zip(self.poses.as_ref());
        let (measured, moved) =
            MeasuredHallways::compare(&self.events, &self.trace, self.trail.as_ref(), known);
        self.measured = measured;
        if let Some((event, cause)) = moved {
            found.note(event, cause);
        }
    }

    /// Searches for the smallest world that explains the walk, unless none does.
    fn explain(
        &mut self,
        mut impossible: Option<(usize, Impossibility)>,
        config: &ConformConfig,
        watch: &dyn Watch,
        found: &mut FirstDivergence,
    ) {
        if config.aid.moves() {
            self.smallest = Some(self.mapped_world(config.aid));
            return;
        }
        if impossible.is_none() {
            let search = |trail: &FoldedTrail| smallest_world(trail, config.search, watch);
            let too_large = SmallestWorld::NotFound { limit: SearchLimit::Decisions };
            let smallest = self.trail.as_ref().map_or(too_large, search);
            if smallest == SmallestWorld::NoWorld {
                let moves = self.trail.as_ref().map_or(0, FoldedTrail::moves);
                let is_impossible = |trail: &FoldedTrail| search(trail) == SmallestWorld::NoWorld;
                let event = first_percept(&self.trace, moves, is_impossible);
                impossible = Some((event, Impossibility::Class { class: config.search.class }));
            } else {
                self.smallest = Some(smallest);
            }
        }
        if let Some((event, why)) = impossible {
            let event = self.trace.event(event);
            found.note(event.id, DivergenceCause::NoWorld { event, why });
        }
    }

    /// The complete map of a robot whose aid moves, if a robot in it has these percepts. Other worlds are not searched.
    fn mapped_world(&self, aid: AidKind) -> SmallestWorld {
        let limit = SearchLimit::Aid;
        let map = self.algorithm.as_ref().and_then(|followed| followed.run.map().complete());
        let explains = |map: &&EmbeddedGraph| {
            let start = State { pose: FACING, placed: aid.placed(map, FACING) };
            poses(map, &aid, &[start], &self.trace).misfit.is_none()
        };
        match map.filter(explains) {
            Some(map) => SmallestWorld::World {
                graph: map.clone(),
                marker: Some(FACING),
                limit: Some(limit),
            },
            None => SmallestWorld::NotFound { limit },
        }
    }

    /// Compares the actions with the algorithm, and what it knows with the recorded end.
    fn follow_algorithm(
        &mut self,
        config: &ConformConfig,
        in_turn: bool,
        found: &mut FirstDivergence,
    ) {
        let Some(followed) = config.follow(&self.trace, &self.events) else { return };
        if let MatchEnd::Departure(departure) = &followed.reached {
            found.note(departure.event.id, DivergenceCause::Algorithm(departure.clone()));
        }
        if in_turn {
            for cause in self.events.false_ending(&followed, (config.world.as_ref(), config.aid)) {
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
        config: &ConformConfig,
        tolerated: &BTreeSet<(usize, &'static str)>,
        watch: &dyn Watch,
    ) -> Result<Self, JudgeError> {
        let before = match event.checked_sub(1) {
            Some(last) => Self::new(&self.events.up_to(last), config, tolerated, watch)?,
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

    /// Whether it ends at a visit that is not certain, and nothing diverged before.
    pub(super) fn is_open_at_visit(&self) -> bool {
        self.unrecognised.is_some() && self.divergence.is_none()
    }

    /// The judgement of visits that were inferred from scans or images. Where some are not certain, they are judged as sets.
    pub(super) fn with_possible(self, possible: PossibleVisits) -> Self {
        // Without the visits that are not certain, what the others show is no world.
        let is_certain = self.unrecognised.is_none() && !possible.is_unreliable();
        let refuted = possible.refuted.map(|time| {
            let events = &self.events.events;
            let event = events.iter().position(|event| event.source.time >= time);
            let cause = DivergenceCause::Driven;
            let event = event.unwrap_or(events.len());
            (Divergence { event, fault: cause.fault(), cause }, Unproved::Poses)
        });
        let judgement = self.accusing_nobody(Unproved::Scans);
        Self {
            contradiction: refuted.or(judgement.contradiction),
            possible: Some(possible),
            determined: judgement.determined.filter(|_| is_certain),
            smallest: judgement.smallest.filter(|_| is_certain),
            trail: judgement.trail.filter(|_| is_certain),
            ..judgement
        }
    }

    /// The same judgement where a divergence proves nothing.
    pub(super) fn accusing_nobody(self, why: Unproved) -> Self {
        let contradiction = self.divergence.map(|divergence| (divergence, why));
        let determined = self.determined.filter(|_| contradiction.is_none());
        Self { divergence: None, contradiction, determined, ..self }
    }

    pub fn verdict(&self) -> ConformVerdict {
        let is_decided = match &self.possible {
            _ if self.contradiction.is_some() => false,
            Some(possible) if possible.says_nothing() => false,
            Some(possible) if self.unrecognised.is_some() => possible.conform(),
            _ => self.unrecognised.is_none() && self.is_decided(),
        };
        if self.divergence.is_some() {
            ConformVerdict::Diverged
        } else if is_decided
            && (self.lost.is_none() || self.poses.is_some())
            && self.events.is_whole(self.algorithm.is_some())
        {
            ConformVerdict::Conforms
        } else {
            ConformVerdict::NotKnown
        }
    }

    /// Whether some visits are not certain, so that the sets of all take the place of the trace.
    pub(crate) fn are_sets_judged(&self) -> bool {
        self.possible.is_some() && self.unrecognised.is_some()
    }

    /// Whether no limit leaves the verdict open.
    pub(crate) fn is_decided(&self) -> bool {
        self.limits().iter().all(|limit| matches!(limit, ReachedLimit::SmallerWorld(_)))
    }

    pub(crate) fn limits(&self) -> Vec<ReachedLimit> {
        let searched = match self.smallest {
            Some(SmallestWorld::World { limit, .. }) => limit.map(ReachedLimit::SmallerWorld),
            Some(SmallestWorld::NotFound { limit }) => Some(ReachedLimit::World(limit)),
            _ => None,
        };
        let followed = self.algorithm.as_ref().and_then(|followed| match followed.reached {
            MatchEnd::Bound { event, bound } => {
                let algorithm = followed.algorithm;
                Some(ReachedLimit::Darts { algorithm, event: event.id, bound })
            }
            _ => None,
        });
        searched.into_iter().chain(followed).collect()
    }

    /// Whether the log determines its world: no other world explains it, whatever its size. `None` if the log
    /// diverges, or if this is not known.
    pub(crate) fn determines_world(&self) -> Option<bool> {
        self.determined.filter(|_| self.divergence.is_none())
    }

    /// The number of candidate poses after the last event that fits; 1 if the world was not known and one
    /// was found.
    pub(crate) fn candidates(&self) -> usize {
        match (&self.poses, &self.smallest) {
            _ if self.are_sets_judged() => self.possible.as_ref().map_or(0, |it| it.states.len()),
            (Some(poses), _) => poses.states.len(),
            (None, Some(SmallestWorld::World { .. })) => 1,
            _ => 0,
        }
    }
}

/// The trace of the events up to the first that is out of turn, which is noted.
fn trace_in_turn(events: &RunEvents, found: &mut FirstDivergence) -> Result<Trace, JudgeError> {
    match events.trace() {
        Ok(all) => Ok(all),
        Err(TraceOrderError::Empty) => Err(JudgeError::Empty),
        Err(
            not @ (TraceOrderError::NoDoor { event }
            | TraceOrderError::NoPercept { event }
            | TraceOrderError::ActionOnTheWay { event }),
        ) => {
            found.note(event, DivergenceCause::NotInTurn(not));
            let last = event.checked_sub(1).ok_or(JudgeError::Empty)?;
            events.up_to(last).trace().map_err(|_| JudgeError::Empty)
        }
    }
}

/// The first divergence that is not tolerated.
struct FirstDivergence<'t> {
    /// The events and causes that are.
    tolerated: &'t BTreeSet<(usize, &'static str)>,
    first: Option<Divergence>,
}

impl FirstDivergence<'_> {
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
