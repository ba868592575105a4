//! The visits of a log of scans or images, judged as sets of what these cannot exclude. Section 2.1.
//!
//! What is not certain may be wrong in one visit of many, so it may support that a log conforms, and accuses nobody. The visits
//! of a log of images are judged so only if some are not certain; up to the first of these the others accuse. If what scans
//! show fits no choice in the known world, it is compared once more by what was [driven](DrivenVisits) or is seen to end alone.
//! That accuses nobody either: a pass may lie beside the place that it is of, where odometry drifts.
//!
//! The doors of an algorithm are compared with the choices one by one, and accuse nobody: which percepts led to them is seen.
//!
//! Arms belong to places, which is not modelled: the visits of one place are chosen from one by one.

use serde::Serialize;
use toposlam_model::{
    aid::State,
    enumerate::Watch,
    folding::ClosedTrail,
    mapping::MappingMethod,
    marker::{Directional, MarkerKind, NoMarker},
    percept::{Door, Percept, Sighting},
    visits::{
        AlgorithmSearchBounds, Explanation, VisitAlternative, VisitSet, VisitWay,
        alternatives_left, explain, explain_by_algorithm, states_after,
    },
};
use toposlam_vision::visits::{VisitPercept, network_fit::NetworkFit};

use super::{
    config::{ConformConfig, RunDriver},
    events::{CheckedEvent, CheckedKind, RunEvents, UndecidedCause},
    known_world::KnownWorld,
    marked_visits::VisitedJunction,
    visit_events::DrivenVisits,
};

/// The visits of a log, and whether some choice of their percepts fits.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PossibleVisits {
    pub visits: usize,
    /// Those of which one percept is left.
    pub certain: usize,
    /// Those of which several percepts are left, and the known world leaves one, counted from 0.
    pub decided_by_world: Vec<usize>,
    pub fit: VisitFit,
    /// Whether the building is a network of corridors at all.
    pub network: NetworkFit,
    /// Whether the algorithm takes the doors of a choice that fits; `None` if none is followed.
    pub algorithm: Option<VisitFit>,
    /// The time of the visit up to which the known world fits no choice of what was driven or is seen to end, in nanoseconds.
    #[serde(skip)]
    pub(super) refuted: Option<u64>,
    /// Whether the log has no odometry: how far the robot drove along corridors is not known.
    #[serde(skip)]
    lacks_odometry: bool,
    /// Where the robot may be after the last visit in the known world.
    #[serde(skip)]
    pub(super) states: Vec<State>,
    /// The visits with what the scans cannot exclude.
    #[serde(skip)]
    pub(super) sets: Vec<VisitSet>,
    /// The search for a choice that some world explains, with this world, if none is known.
    #[serde(skip)]
    pub(super) searched: Option<(Explanation, Option<ClosedTrail>)>,
    /// Whether the log records the map of an algorithm. It is compared with that of certain percepts alone.
    #[serde(skip)]
    pub(super) records_map: bool,
    /// Whether the robot may have taken any doors: those of an algorithm depend on the percepts.
    #[serde(skip)]
    by_anyone: bool,
}

/// Whether some choice of percepts fits the known world, or some world if none is known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum VisitFit {
    Fits,
    /// None does.
    Contradiction,
    /// The robot drove where its scanner did not look. It may have passed any number of junctions there.
    UnseenWay,
    /// A world would explain any visits: there is no marker, and the robot never turned back.
    Anything,
    #[default]
    NotKnown,
}

/// The bound of the search for a choice that some world explains: a second, and a few hundred megabytes.
const MOST_DARTS: usize = 20_000_000;
/// The bound of the search for a choice whose doors an algorithm takes, in steps of its runs: a few seconds.
const MOST_STEPS: usize = 200_000;
/// More doors than this are not expected at a junction of which nothing is known.
const MOST_DOORS: u32 = 8;
/// A log conforms only if at least this part of its visits is certain: two thirds.
const CERTAIN_PART: [usize; 2] = [2, 3];

impl PossibleVisits {
    /// Judges visits with the events that were inferred from them.
    pub(super) fn judge(
        events: &RunEvents,
        junctions: &[VisitedJunction],
        driven: Option<&DrivenVisits>,
        config: &ConformConfig,
        watch: &dyn Watch,
    ) -> Self {
        let by_anyone = config.driver == RunDriver::Anyone;
        // Only events that are recorded show what the robot does with an aid that moves.
        let Some(marker) = config.aid.fixed() else { return Self { by_anyone, ..Self::default() } };
        let (at, sets): (Vec<_>, Vec<_>) =
            visit_sets(&events.events, junctions, marker).into_iter().unzip();
        let is_visit = |&set: &usize| events.events[at[set]].kind != CheckedKind::TurnedBack;
        let of_junctions: Vec<usize> = (0..sets.len()).filter(is_visit).collect();
        let certain = of_junctions.iter().filter(|&&set| sets[set].is_certain()).count();
        let (visits, records_map) = (of_junctions.len(), events.map.is_some() && !by_anyone);
        let mut judged = Self { visits, certain, records_map, by_anyone, ..Self::default() };
        if has_unseen_way(&events.events) {
            return Self { fit: VisitFit::UnseenWay, ..judged };
        }
        let is_marked = marker == Directional;
        if let Some(known) = &config.world {
            let (graph, states) = (&known.graph, known.with_fixed_marker());
            let mut after = states_after(graph, &marker, &states, &sets);
            judged.states = after.pop().unwrap_or_default();
            let fits = sets.is_empty() || !judged.states.is_empty();
            judged.fit = if fits { VisitFit::Fits } else { VisitFit::Contradiction };
            if !fits {
                judged.refuted = driven.and_then(|driven| refuted(driven, known, marker));
            }
            let left = alternatives_left(graph, &marker, &states, &sets);
            let is_decided = |set: usize| left[set].len() == 1 && !sets[set].is_certain();
            let numbered = of_junctions.iter().enumerate();
            judged.decided_by_world =
                numbered.filter(|&(_, &set)| is_decided(set)).map(|(number, _)| number).collect();
        } else if is_marked || marker == NoMarker {
            let may_contradict = is_marked || sets.iter().any(|set| set.way() == VisitWay::Back);
            let searched = explain(&sets, is_marked, MOST_DARTS, watch);
            judged.fit = match searched.0 {
                Explanation::Explained(_) if may_contradict => VisitFit::Fits,
                Explanation::Explained(_) => VisitFit::Anything,
                Explanation::Impossible { .. } => VisitFit::Contradiction,
                Explanation::NotKnown => VisitFit::NotKnown,
            };
            judged.searched = Some(searched);
        }
        judged.algorithm = judged.follow(&sets, config, watch);
        judged.sets = sets;
        judged
    }

    /// Whether the algorithm takes the doors of a choice that fits. Runs that recover, or with audits, are not followed.
    fn follow(
        &self,
        sets: &[VisitSet],
        config: &ConformConfig,
        watch: &dyn Watch,
    ) -> Option<VisitFit> {
        let RunDriver::Method(MappingMethod::By { algorithm, audits: 0 }) = config.driver else {
            return None;
        };
        if self.fit != VisitFit::Fits {
            return None;
        }
        let states = config.world.as_ref().map(KnownWorld::with_fixed_marker);
        let known = config.world.as_ref().zip(states.as_deref());
        let world = known.map(|(known, states)| (&known.graph, states));
        let bounds = AlgorithmSearchBounds { darts: config.dart_bound, steps: MOST_STEPS };
        Some(match explain_by_algorithm(algorithm, sets, world, bounds, watch) {
            Explanation::Explained(_) => VisitFit::Fits,
            Explanation::Impossible { .. } => VisitFit::Contradiction,
            Explanation::NotKnown => VisitFit::NotKnown,
        })
    }

    /// The visits of a building that is no network of corridors show nothing.
    pub(super) fn in_building(self, network: NetworkFit) -> Self {
        let refuted = self.refuted.filter(|_| network.fault.is_none());
        Self { network, refuted, ..self }
    }

    pub(super) fn without_odometry(self, lacks_odometry: bool) -> Self {
        Self { lacks_odometry, ..self }
    }

    /// Whether so many visits are certain that a choice that fits says something.
    pub fn is_certain_enough(&self) -> bool {
        let [least, of] = CERTAIN_PART;
        self.visits > 0 && of * self.certain >= least * self.visits
    }

    /// Whether no visit is what it seems: the building is no network of corridors, or the log has no odometry.
    pub(super) fn is_unreliable(&self) -> bool {
        self.network.fault.is_some() || self.lacks_odometry
    }

    /// Whether they decide nothing: they are not reliable, no choice fits, or any visits of such a robot
    /// would.
    pub(super) fn says_nothing(&self) -> bool {
        self.is_unreliable()
            || self.fit == VisitFit::Contradiction
            || self.by_anyone && self.fit == VisitFit::Anything
    }

    /// Whether the visits conform, as sets.
    pub(super) fn conform(&self) -> bool {
        (self.by_anyone || self.algorithm == Some(VisitFit::Fits))
            && !self.is_unreliable()
            && !self.records_map
            && self.fit == VisitFit::Fits
            && self.is_certain_enough()
    }
}

/// The robot drove where its scanner did not look.
fn has_unseen_way(events: &[CheckedEvent]) -> bool {
    let unseen_way = CheckedKind::Undecided(UndecidedCause::UnseenWay);
    events.iter().any(|event| event.kind == unseen_way)
}

/// The time of the visit up to which a world fits no choice of what was driven or is seen to end, in nanoseconds.
fn refuted(driven: &DrivenVisits, known: &KnownWorld, marker: MarkerKind) -> Option<u64> {
    let DrivenVisits { events, junctions } = driven;
    if has_unseen_way(events) {
        return None;
    }
    let (at, sets): (Vec<_>, Vec<_>) = visit_sets(events, junctions, marker).into_iter().unzip();
    let after = states_after(&known.graph, &marker, &known.with_fixed_marker(), &sets);
    let is_misfit = after.last().is_some_and(Vec::is_empty);
    is_misfit.then(|| events[at[after.len() - 1]].source.time)
}

/// The visits as sets, in order, with the places where the robot turned back between them; each with the index of its event.
fn visit_sets(
    events: &[CheckedEvent],
    junctions: &[VisitedJunction],
    marker: MarkerKind,
) -> Vec<(usize, VisitSet)> {
    let mut sets = Vec::new();
    let mut junctions = junctions.iter().peekable();
    for (index, event) in events.iter().enumerate() {
        match &event.kind {
            CheckedKind::TurnedBack => sets.push((index, VisitSet::turned_back())),
            CheckedKind::Arrival { .. } | CheckedKind::Undecided(_) => {
                let junction = junctions.next_if(|junction| junction.event == index);
                let sighting = event.arrival().and_then(|arrival| arrival.sighting);
                let set = junction.map(|junction| visit_set(junction, sighting, marker));
                sets.extend(set.map(|set| (index, set)));
            }
            CheckedKind::Door { .. }
            | CheckedKind::Action { .. }
            | CheckedKind::LeftBetweenDoors { .. } => {}
        }
    }
    sets
}

fn visit_set(
    junction: &VisitedJunction,
    sighting: Option<Sighting>,
    marker: MarkerKind,
) -> VisitSet {
    let VisitedJunction { alternatives, goes_back, .. } = junction;
    let way = if *goes_back { VisitWay::Back } else { VisitWay::Through };
    let anything = (1..=MOST_DOORS).flat_map(|degree| {
        let doors = if *goes_back { 0..1 } else { 1..degree };
        doors.map(move |door| Some(VisitPercept { degree, door: Some(door) }))
    });
    let anything = || anything.chain([None]).collect();
    let seen = if alternatives.is_empty() { anything() } else { alternatives.clone() };
    let with_sightings = seen.into_iter().flat_map(|seen| {
        let Some(VisitPercept { degree, door }) = seen else { return vec![None] };
        let door = door.map(Door);
        let sightings = match sighting {
            Some(sighting) => vec![sighting],
            None if marker == NoMarker => vec![Sighting::Nothing],
            None => {
                let pointing = (0..degree).map(|door| Sighting::Pointing(Door(door)));
                pointing.chain([Sighting::Nothing, Sighting::Lying(1)]).collect()
            }
        };
        let with = |sighting| Percept { degree, sighting };
        sightings
            .into_iter()
            .map(|sighting| Some(VisitAlternative { percept: with(sighting), door }))
            .collect()
    });
    VisitSet::new(with_sightings, way)
}
