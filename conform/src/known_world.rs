//! The known world of a log: where the robot and its marker may be, which cases can be covered in it, and the fault
//! class of a percept that does not fit it.

use toposlam_model::{
    aid::{Aid, AidKind, Places, State},
    driving::visit::JunctionShape,
    embedded_graph::{Dart, EmbeddedGraph},
    format::named_world::NamedWorld,
    isomorphism::code,
    mapping::{FACING, MapWalk, MappingAlgorithm, MappingEvent, Observer},
    percept::Percept,
    trace::{
        self, AlgorithmCase, AlgorithmCoverage, Misfit, MisfitReason, Trace, TraceEvent,
        TraceEventKind, anywhere, poses,
    },
    world::GraphWorld,
};

use super::divergence::FaultClass;

/// The known world of a log.
#[derive(Clone, Debug)]
pub struct Known {
    /// The world, without the corners that the events do not have.
    pub world: NamedWorld,
    pub start: Option<Dart>,
    /// Whether the log was recorded in this world; `None` if the log does not say it.
    pub is_recorded: Option<bool>,
    /// How often each case is reachable, over all starts.
    reachable: AlgorithmCoverage,
    /// A complete run, if the start is known.
    expected: Option<ExpectedRun>,
}

/// Where a marker lay when the run began, as far as it is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MarkerStart {
    /// At the robot's start, along its entry door.
    Robot,
    Anywhere,
}

/// The most states that are followed.
const MOST_STATES: usize = 1 << 20;

impl Known {
    /// A world, the robot's start in it, and the world as a run with its marker is compared with it. `None` if there
    /// are too many possible states at the start.
    pub(super) fn new(
        world: NamedWorld,
        start: Option<Dart>,
        (aid, lies): (AidKind, MarkerStart),
        algorithm: MappingAlgorithm,
    ) -> Option<(Self, KnownWorld)> {
        let graph = &world.graph;
        let states = match (lies, start) {
            (MarkerStart::Robot, None) => anywhere(graph, &aid),
            (MarkerStart::Robot, Some(facing)) => {
                vec![GraphWorld::with_aid(graph, aid, facing).state()]
            }
            (MarkerStart::Anywhere, start) => {
                let places = graph.darts().filter(|&dart| aid.first_alike(graph, dart) == dart);
                let places: Vec<Places> = places.map(|dart| aid.placed(graph, dart)).collect();
                let poses: Vec<Dart> =
                    start.map_or_else(|| graph.darts().collect(), |start| vec![start]);
                if poses.len().saturating_mul(places.len()) > MOST_STATES {
                    return None;
                }
                let with = |placed: Places| {
                    poses.iter().map(move |&pose| State { pose, placed: placed.clone() })
                };
                places.into_iter().flat_map(with).collect()
            }
        };
        let reachable = trace::reachable(graph);
        let expected = start.map(|start| ExpectedRun::new(algorithm, graph, start));
        let compared = KnownWorld { graph: graph.clone(), states };
        Some((Self { world, start, is_recorded: None, reachable, expected }, compared))
    }

    /// Whether some run of Algorithm 1 has a case.
    pub(super) fn reaches(&self, case: AlgorithmCase) -> bool {
        self.reachable.count(case) > 0
    }

    /// Whether a complete run of the algorithm from the start has a case of Algorithm 1.
    pub(super) fn expects(&self, case: AlgorithmCase) -> bool {
        self.expected.as_ref().is_some_and(|expected| expected.coverage.count(case) > 0)
    }

    /// Whether a junction has a shape from some entry; `None` if the world has no floor plan.
    pub(super) fn has_shape(&self, shape: JunctionShape) -> Option<bool> {
        let plan = self.world.plan.as_ref()?;
        Some(plan.graph().darts().any(|entry| plan.shape(entry) == shape))
    }

    /// Whether the robot enters a junction of a shape in a complete run of the algorithm.
    pub(super) fn expects_shape(&self, shape: JunctionShape) -> bool {
        let (Some(expected), Some(plan)) = (&self.expected, &self.world.plan) else { return false };
        expected.poses.iter().any(|&pose| plan.shape(pose) == shape)
    }
}

/// The cases and the poses of a complete run: an algorithm with its default choices.
#[derive(Clone, Debug, Default)]
struct ExpectedRun {
    coverage: AlgorithmCoverage,
    poses: Vec<Dart>,
}

impl ExpectedRun {
    fn new(algorithm: MappingAlgorithm, graph: &EmbeddedGraph, start: Dart) -> Self {
        let mut expected = Self::default();
        let mut world = GraphWorld::with_aid(graph, algorithm.aid(), start);
        // In a world of this size the run ends.
        let _ = algorithm.map_world(&mut world, 2 * graph.dart_count(), &mut expected);
        expected
    }
}

impl<A: Aid> Observer<GraphWorld<'_, A>> for ExpectedRun {
    fn event(&mut self, world: &mut GraphWorld<'_, A>, journey: &MapWalk, event: MappingEvent) {
        self.coverage.event(world, journey, event);
        self.poses.push(world.state().pose);
    }
}

/// A known world, and the possible states of the robot and the marker at the start.
#[derive(Clone, Debug)]
pub struct KnownWorld {
    pub graph: EmbeddedGraph,
    pub states: Vec<State<Places>>,
}

impl KnownWorld {
    /// The fault class of a misfit. It is motion if the following events fit better from another pose than
    /// after one wrong percept.
    pub(super) fn fault(&self, trace: &Trace, misfit: &Misfit<Places>, aid: AidKind) -> FaultClass {
        let TraceEventKind::Percept(perceived) = misfit.event.kind else {
            return FaultClass::Algorithm;
        };
        let perceived_wrongly = misfit.candidates.iter().filter_map(|(state, why)| {
            let MisfitReason::Percept { expected } = *why else { return None };
            Some(self.fitting(
                &ahead(trace, misfit.event, expected),
                std::slice::from_ref(state),
                aid,
            ))
        });
        let perceived_wrongly = perceived_wrongly.max().unwrap_or(0);
        let placed = misfit.candidates.iter().map(|(state, _)| &state.placed);
        let elsewhere = |placed: &Places| {
            let placed = placed.clone();
            self.graph.darts().map(move |pose| State { pose, placed: placed.clone() })
        };
        let elsewhere: Vec<_> = placed.take(1).flat_map(elsewhere).collect();
        let came_elsewhere = self.fitting(&ahead(trace, misfit.event, perceived), &elsewhere, aid);
        if came_elsewhere > perceived_wrongly { FaultClass::Motion } else { FaultClass::Perception }
    }

    /// The number of events that fit.
    fn fitting(&self, trace: &Trace, states: &[State<Places>], aid: AidKind) -> usize {
        poses(&self.graph, &aid, states, trace).left.len()
    }

    /// Whether a map of a robot with this aid is this world from one of its starts.
    pub(super) fn has(&self, map: &EmbeddedGraph, aid: AidKind) -> bool {
        let of_map = code(map, FACING);
        let facing = |state: &State<Places>| {
            if aid.moves() { Some(state.pose) } else { fixed_place(&state.placed) }
        };
        let mut facing = self.states.iter().filter_map(facing);
        facing.any(|dart| code(&self.graph, dart) == of_map)
    }

    /// The states of a robot with a fixed marker.
    pub(super) fn with_fixed_marker(&self) -> Vec<State> {
        self.states.iter().filter_map(state_of_fixed).collect()
    }
}

/// Where a fixed marker is.
fn fixed_place(placed: &Places) -> Option<Dart> {
    placed.first().copied().flatten()
}

/// The same state of a robot with a fixed marker.
pub(super) fn state_of_fixed(state: &State<Places>) -> Option<State> {
    Some(State { pose: state.pose, placed: fixed_place(&state.placed)? })
}

/// The number of following events that decide the fault class of a misfit.
const AHEAD: usize = 12;

/// The trace from a percept that does not fit, with another one in its place.
fn ahead(trace: &Trace, misfit: TraceEvent, first: Percept) -> Trace {
    let first = TraceEventKind::Percept(first);
    let rest = trace.events().skip_while(|&(_, event)| event.id != misfit.id);
    let rest = rest.skip(1).take(AHEAD).map(|(_, event)| event.kind);
    // They take turns as before, whatever the first percept is.
    Trace::new(std::iter::once(first).chain(rest)).unwrap_or_else(|_| trace.clone())
}
