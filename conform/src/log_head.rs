//! What the head of a log records about its run, as a check of the log needs it: the marking aid, the settings, the
//! start and the world.

use thiserror::Error;
use toposlam_logs::{messages::Run, world_hash};
use toposlam_model::{
    aid::{self, AidKind, UnknownAid},
    embedded_graph::{Dart, EmbeddedGraph},
    format::named_world::NamedWorld,
    mapping::MappingAlgorithm,
    marker::Directional,
};
use toposlam_robot::run_settings::RecordedSettings;

use super::events::RunEvents;

/// The head of a log. A log that has none records nothing of this.
#[derive(Clone, Copy)]
pub struct LogHead<'r>(pub Option<&'r Run>);

/// The robot of a log is only assumed to have a marker, and no percept shows one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("no percept in it shows a marker, which {} needs", .algorithm.in_words())]
pub struct MarkerNotShown {
    pub algorithm: MappingAlgorithm,
}

impl<'r> LogHead<'r> {
    fn marker_name(self) -> Option<&'r str> {
        self.0.map(|run| run.marker.as_str()).filter(|name| !name.is_empty())
    }

    /// The marking aid of the robot: without a record, a directional marker.
    ///
    /// # Errors
    /// Returns an error if the recorded name is no aid's.
    pub fn aid(self) -> Result<AidKind, UnknownAid> {
        self.marker_name().map_or(Ok(Directional.into()), aid::named)
    }

    /// How the robot mapped, and within which limits, by this algorithm if one is given; without either by
    /// Algorithm 1.
    ///
    /// # Errors
    /// Returns the recorded text if it is not understood, and no algorithm is given.
    pub fn settings(
        &self,
        algorithm: Option<MappingAlgorithm>,
    ) -> Result<RecordedSettings, String> {
        let recorded = match self.0.map_or("", |run| &run.algorithm) {
            "" => Ok(RecordedSettings::default()),
            head => RecordedSettings::from_head(head).map_err(|_| head.to_owned()),
        };
        match algorithm {
            Some(algorithm) => Ok(recorded.unwrap_or_default().with_algorithm(algorithm)),
            None => recorded,
        }
    }

    /// The start, if the log was recorded in this world.
    pub(crate) fn start(self, world: &NamedWorld) -> Option<Dart> {
        let run = self.0?;
        let start = world.start_from_text(&run.start).ok()?;
        (world_hash(&world.graph, start) == run.world_hash).then_some(start)
    }

    /// Whether the log was recorded in this world; `None` if it does not say where.
    pub(crate) fn is_recorded_in(self, graph: &EmbeddedGraph) -> Option<bool> {
        let recorded = &self.0?.world_hash;
        let is_here = || graph.darts().any(|dart| world_hash(graph, dart) == *recorded);
        (!recorded.is_empty()).then(is_here)
    }

    /// Whether doors can be compared with an algorithm, which needs a marker: it is recorded, or a percept shows
    /// it, or may.
    pub(crate) fn check_marker(
        self,
        events: &RunEvents,
        algorithm: MappingAlgorithm,
    ) -> Result<(), MarkerNotShown> {
        if self.marker_name().is_some() || events.may_show_marker() {
            return Ok(());
        }
        Err(MarkerNotShown { algorithm })
    }
}

/// The remark on a log whose robot went on from an earlier run.
pub const RESUMED_REMARK: &str = "its robot went on from an earlier run, which is not in this log; its doors are \
                           compared with no algorithm";
