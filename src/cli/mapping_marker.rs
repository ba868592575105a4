//! The markers that an algorithm maps with, and the worlds in which they suffice. Section 2.3.

use std::{fmt::Display, path::Path, str::FromStr};

use clap::ValueEnum;
use toposlam_model::{
    ambiguity::{AmbiguitySearch, PlacedWorld},
    embedded_graph::EmbeddedGraph,
    enumerate::Class,
    format::named_world::NamedWorld,
    mapping::MappingAlgorithm,
    marker::{Directional, Marker, Movable},
};

use super::{CliError, RunChoices};

/// A marker that an algorithm maps with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MappingMarker {
    Directional,
    Movable,
}

impl FromStr for MappingMarker {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        match name {
            "directional" => Ok(Self::Directional),
            "movable" => Ok(Self::Movable),
            _ => Err(format!("no algorithm maps with `{name}`; choose directional or movable")),
        }
    }
}

impl MappingMarker {
    /// The name of the marker.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Directional => Directional.name(),
            Self::Movable => Movable.name(),
        }
    }

    /// The algorithm that maps with the marker.
    pub(super) fn algorithm(self, choice: RunChoices) -> Result<MappingAlgorithm, CliError> {
        match (self, choice) {
            (Self::Directional, _) => Ok(MappingAlgorithm::Algorithm1),
            (Self::Movable, RunChoices::Default) => Ok(MappingAlgorithm::MovableMarker),
            (Self::Movable, RunChoices::All { .. }) => {
                let cause = "`all` needs --marker directional";
                Err(CliError::at("--choices", cause))
            }
        }
    }

    /// Checks that the marker suffices for every world of a file.
    ///
    /// # Errors
    /// Returns an error if the marker is movable and a world has loops or parallel edges.
    pub(super) fn check_worlds(
        self,
        path: &Path,
        graphs: &[EmbeddedGraph],
    ) -> Result<(), CliError> {
        match self {
            Self::Directional => Ok(()),
            Self::Movable => match graphs.iter().position(|graph| !graph.is_simple()) {
                None => Ok(()),
                Some(index) => {
                    let world = format!("world {}", index + 1);
                    Err(CliError::in_file(path, movable_not_sufficient(world)))
                }
            },
        }
    }
}

/// An algorithm that maps with the directional marker.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum AlgorithmOption {
    /// The paper's Algorithm 1
    Algorithm1,
    /// The folding explorer
    Folding,
}

impl AlgorithmOption {
    /// The algorithm of a run.
    pub(super) fn directional(self) -> MappingAlgorithm {
        match self {
            Self::Algorithm1 => MappingAlgorithm::Algorithm1,
            Self::Folding => MappingAlgorithm::Folding,
        }
    }

    /// The algorithm, for a marker and a choice of runs.
    pub(super) fn with(
        self,
        marker: MappingMarker,
        choice: RunChoices,
    ) -> Result<MappingAlgorithm, CliError> {
        match (self, marker, choice) {
            (Self::Algorithm1, ..) => marker.algorithm(choice),
            (Self::Folding, MappingMarker::Movable, _) => {
                let cause = "the folding explorer maps with --marker directional";
                Err(CliError::at("--algorithm", cause))
            }
            (Self::Folding, MappingMarker::Directional, _) => Ok(MappingAlgorithm::Folding),
        }
    }
}

/// The error for a world, or a class of worlds, that one movable marker cannot map.
pub(super) fn movable_not_sufficient(what: impl Display) -> String {
    format!(
        "{what} has loops or parallel edges, and one movable marker does not suffice for them: no \
         walk distinguishes {} (see toposlam counterexample --marker movable --class multigraph)",
        smallest_pair().unwrap_or_default()
    )
}

/// The smallest two worlds that a robot with one movable marker cannot distinguish, in words.
fn smallest_pair() -> Option<String> {
    // The pair has two edges. A search up to three takes no noticeable time.
    let findings = AmbiguitySearch::new(Class::Multigraph, 3, &Movable).ok()?.run(&()).ok()?;
    let [one, other] = findings.smallest()?.map(description);
    Some(format!("{one} and {other}"))
}

/// Each vertex with its edges in clockwise order.
fn description(world: &PlacedWorld) -> String {
    let world = NamedWorld::numbered("", "", world.graph.clone(), Some(PlacedWorld::FACING));
    let vertex = |vertex| {
        let edges: Vec<_> = world.graph.darts_of(vertex).map(|dart| world.leads_to(dart)).collect();
        format!("{} = {}", world.vertex_names[vertex.at()], edges.join(" "))
    };
    let vertices: Vec<_> = world.graph.vertices().map(vertex).collect();
    format!("[{}]", vertices.join(", "))
}
