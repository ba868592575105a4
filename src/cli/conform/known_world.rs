//! The known world of a log.

use std::path::Path;

use toposlam_model::{
    driving::visit::JunctionShape,
    embedded_graph::Dart,
    format::named_world::NamedWorld,
    marker::Marker,
    trace::{self, anywhere},
    world::{GraphWorld, State},
};
use toposlam_robot::{
    conform::KnownWorld,
    log::{messages::Run, world_hash},
    pose::Pose,
    truth::{JunctionTruth, angle},
};

use super::{ConformArguments, Failure};
use crate::cli::input;

/// A known world.
pub(super) struct Known {
    pub(super) world: NamedWorld,
    pub(super) marker: &'static dyn Marker,
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

impl Known {
    pub(super) fn new(
        path: &Path,
        arguments: &ConformArguments,
        run: Option<&Run>,
    ) -> Result<Self, Failure> {
        let world = input::read_world(path)?;
        let marker = match (arguments.marker, run.map_or("", |run| &*run.marker)) {
            (Some(marker), _) => marker,
            (None, "") => &toposlam_model::marker::Directional,
            (None, name) => toposlam_model::marker::named(name)
                .map_err(|error| Failure::at("the log", error))?,
        };
        let start = match arguments.start.as_deref() {
            Some(ANY) => None,
            Some(_) => Some(input::start_of(&world, arguments.start.as_deref())?),
            None => run.and_then(|run| recorded_start(&world, run)).or(world.start),
        };
        let states = match start {
            None => anywhere(&world.graph, &marker),
            Some(facing) => vec![GraphWorld::with_marker(&world.graph, marker, facing).state()],
        };
        let reachable = trace::reachable(&world.graph);
        let forms = forms(&world);
        Ok(Self { world, marker, start, states, reachable, forms })
    }

    pub(super) fn question(&self) -> KnownWorld<'_> {
        let Self { world, marker, states, .. } = self;
        KnownWorld { graph: &world.graph, marker: *marker, states: states.clone() }
    }

    /// Prints a warning if the log was recorded in another world.
    pub(super) fn warn(&self, log: &Path, run: &Run) {
        let recorded = &run.world_hash;
        let other =
            self.world.graph.darts().all(|dart| world_hash(&self.world.graph, dart) != *recorded);
        if !recorded.is_empty() && other {
            eprintln!("{}: the log was recorded in another world, {}", log.display(), run.world);
        }
    }

    /// A pose in words.
    pub(super) fn pose(&self, pose: Dart) -> String {
        format!("at {}, having come from {}", self.world.at_text(pose), self.world.leads_to(pose))
    }
}

/// The start that a log records, if it was recorded in this world.
fn recorded_start(world: &NamedWorld, run: &Run) -> Option<Dart> {
    let start = world.start_from_text(&run.start).ok()?;
    (world_hash(&world.graph, start) == run.world_hash).then_some(start)
}

/// The shapes of the junctions of a floor plan, from each of their entries.
fn forms(world: &NamedWorld) -> Option<Vec<JunctionShape>> {
    let plan = world.plan.as_ref()?;
    let graph = plan.graph();
    let form = |dart| {
        let position = plan.junction(graph.vertex(dart)).position;
        let heading = angle(plan.direction(dart).reversed());
        JunctionTruth::of(plan, graph.vertex(dart), Pose { position, heading }).form
    };
    Some(graph.darts().filter_map(form).collect())
}
