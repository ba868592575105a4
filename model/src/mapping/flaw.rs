//! What can be wrong with a run.

use thiserror::Error;

use super::{InvalidStep, MappingError};
use crate::{
    counts::grouped,
    embedded_graph::{Dart, GraphError},
    world::RefusedAction,
};

/// What is wrong with a run.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum Flaw {
    /// It ended with an error: a door that does not exist, a contradiction, the bound.
    #[error(transparent)]
    Error(#[from] MappingError<RefusedAction>),
    /// It ended with unexplored edges.
    #[error("it ended with {unexplored} edge ends unexplored")]
    Unfinished {
        /// Their number.
        unexplored: u32,
    },
    /// The map is not isomorphic to the world, start to start.
    #[error("the map is not isomorphic to the world")]
    WrongMap,
    /// The robot is not where it believes it is.
    #[error(
        "the robot believes it came in by the map's dart {}, which is dart {} of the world, but it \
         came in by dart {}",
        believed.0, image.0, truly.0
    )]
    WrongPose {
        /// The pose in the map.
        believed: Dart,
        /// The image of that dart in the world.
        image: Dart,
        /// The pose in the world.
        truly: Dart,
    },
    /// The explorer's map is not an embedded graph.
    #[error("the map is not an embedded graph: {0}")]
    NoGraph(#[from] GraphError),
    /// The facing dart or the robot's pose is not a dart of the map.
    #[error("the map has no dart {dart}")]
    NoSuchDart {
        /// The number of the dart.
        dart: u32,
    },
    /// More moves than the bound.
    #[error("it took {} moves; the bound is {}", grouped((*moves).into()), grouped((*bound).into()))]
    TooManyMoves {
        /// The moves.
        moves: u64,
        /// The bound.
        bound: u64,
    },
}

impl From<RefusedAction> for Flaw {
    fn from(refused: RefusedAction) -> Self {
        Self::Error(MappingError::World(refused))
    }
}

impl From<InvalidStep> for Flaw {
    fn from(step: InvalidStep) -> Self {
        Self::Error(step.into())
    }
}
