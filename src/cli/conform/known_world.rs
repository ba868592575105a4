//! The known world of a log.

use toposlam_conform::{KnownWorld, LogHead};
use toposlam_logs::messages::Run;
use toposlam_model::{
    driving::{pose::Pose, visit::JunctionShape},
    embedded_graph::{Dart, EmbeddedGraph},
    floor_plan::FloorPlan,
    format::named_world::NamedWorld,
    mapping::MappingAlgorithm,
    marker::Marker,
    trace::{self, anywhere},
    world::{GraphWorld, State},
};
use toposlam_simulator::truth::{JunctionTruth, angle};

use super::{CliError, expected_run::ExpectedRun, robot_marker::MarkerStart};
use crate::cli::input;

/// A known world.
pub(super) struct Known<'w> {
    pub(super) world: &'w NamedWorld,
    /// The robot's start, if it is known.
    pub(super) start: Option<Dart>,
    states: Vec<State>,
    /// The count of each case over all starts.
    pub(super) reachable: trace::AlgorithmCoverage,
    /// The shapes of the junctions from each of their entries, if the world is a floor plan.
    pub(super) forms: Option<Vec<JunctionShape>>,
    /// A complete run, if the start is known.
    expected: Option<ExpectedRun>,
}

/// The word for an unknown start.
const ANY: &str = "any";

/// Checks the text of `--start`.
pub(super) fn check_start(world: &NamedWorld, start: Option<&str>) -> Result<(), CliError> {
    match start {
        None | Some(ANY) => Ok(()),
        Some(_) => input::start_of(world, start).map(|_| ()),
    }
}

impl<'w> Known<'w> {
    /// The world of a log with a marker, and the start of `--start`, of the log or of the world file.
    pub(super) fn new(
        world: &'w NamedWorld,
        start: Option<&str>,
        (marker, lies): (&'static dyn Marker, MarkerStart),
        run: Option<&Run>,
        algorithm: MappingAlgorithm,
    ) -> Result<Self, CliError> {
        let start = match start {
            Some(ANY) => None,
            Some(_) => Some(input::start_of(world, start)?),
            None => LogHead(run).start(world).or(world.start),
        };
        let graph = &world.graph;
        let states = match (lies, start) {
            (MarkerStart::Robot, None) => anywhere(graph, &marker),
            (MarkerStart::Robot, Some(facing)) => {
                vec![GraphWorld::with_marker(graph, marker, facing).state()]
            }
            (MarkerStart::Anywhere, start) => wherever_it_lies(graph, marker, start)?,
        };
        let reachable = trace::reachable(&world.graph);
        let forms = forms(world);
        let expected = start.map(|start| ExpectedRun::of(algorithm, &world.graph, start));
        Ok(Self { world, start, states, reachable, forms, expected })
    }

    /// Whether a complete run of the algorithm has a case of Algorithm 1.
    pub(super) fn expects_case(&self, case: trace::AlgorithmCase) -> bool {
        self.expected.as_ref().is_some_and(|expected| expected.coverage.count(case) > 0)
    }

    /// Whether the robot enters a junction of a shape in a complete run of the algorithm.
    pub(super) fn expects_form(&self, form: JunctionShape) -> bool {
        let (Some(expected), Some(plan)) = (&self.expected, &self.world.plan) else { return false };
        expected.poses.iter().any(|&pose| form_of(plan, pose) == Some(form))
    }

    pub(super) fn question(&self) -> KnownWorld<'_> {
        KnownWorld { graph: &self.world.graph, states: self.states.clone() }
    }

    /// A pose in words.
    pub(super) fn pose(&self, pose: Dart) -> String {
        format!("at {}, having come from {}", self.world.at_text(pose), self.world.leads_to(pose))
    }
}

/// The most states that are followed.
const MOST_STATES: usize = 1 << 20;

/// The states of a robot whose marker may lie anywhere: from one pose, or from all.
fn wherever_it_lies(
    graph: &EmbeddedGraph,
    marker: &dyn Marker,
    start: Option<Dart>,
) -> Result<Vec<State>, CliError> {
    let placed = graph.darts().filter(|&dart| marker.first_alike(graph, dart) == dart);
    let places: Vec<Dart> = placed.collect();
    let poses: Vec<Dart> = start.map_or_else(|| graph.darts().collect(), |start| vec![start]);
    if poses.len().saturating_mul(places.len()) > MOST_STATES {
        let cause = "the world is too large for a marker that may lie anywhere";
        return Err(CliError::at("--world", format!("{cause}; give --start")));
    }
    let with = |placed| poses.iter().map(move |&pose| State { pose, placed: Some(placed) });
    Ok(places.into_iter().flat_map(with).collect())
}

/// The shapes of the junctions of a floor plan, from each of their entries.
fn forms(world: &NamedWorld) -> Option<Vec<JunctionShape>> {
    let plan = world.plan.as_ref()?;
    Some(plan.graph().darts().filter_map(|entry| form_of(plan, entry)).collect())
}

/// The shape of a junction from an entry.
fn form_of(plan: &FloorPlan, entry: Dart) -> Option<JunctionShape> {
    let vertex = plan.graph().vertex(entry);
    let position = plan.junction(vertex).position;
    let heading = angle(plan.direction(entry).reversed());
    JunctionTruth::of(plan, vertex, Pose { position, heading }).form
}
