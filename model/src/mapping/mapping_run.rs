//! The algorithms that map with a directional marker, to choose from at run time.

use std::{fmt, str::FromStr};

use super::{
    Exploration, FoldingExploration, Journey, MappingError, Nearest, Observer, PartialMap,
    map_by_folding, map_world,
};
use crate::{embedded_graph::Dart, world::World};

/// An algorithm that maps with a directional marker.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DirectionalAlgorithm {
    /// The paper's Algorithm 1, with the default choices. It is that of a log that names none.
    #[default]
    Algorithm1,
    /// The folding explorer.
    Folding,
}

impl DirectionalAlgorithm {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Algorithm1, Self::Folding];

    /// Its name in options and logs.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Algorithm1 => "algorithm1",
            Self::Folding => "folding",
        }
    }

    /// Its name in a sentence.
    #[must_use]
    pub fn in_words(self) -> &'static str {
        match self {
            Self::Algorithm1 => "Algorithm 1",
            Self::Folding => "the folding explorer",
        }
    }
}

impl fmt::Display for DirectionalAlgorithm {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        out.pad(self.name())
    }
}

impl FromStr for DirectionalAlgorithm {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|algorithm| algorithm.name() == name);
        found.ok_or_else(|| format!("`{name}` is not algorithm1 or folding"))
    }
}

/// The state of a run of one of the algorithms.
#[derive(Clone, Debug)]
pub enum MappingRun {
    /// Of Algorithm 1.
    Algorithm1(Box<Exploration>),
    /// Of the folding explorer.
    Folding(Box<FoldingExploration>),
}

impl MappingRun {
    /// A state ready for a run whose map may have at most `bound` darts.
    #[must_use]
    pub fn new(algorithm: DirectionalAlgorithm, bound: usize) -> Self {
        match algorithm {
            DirectionalAlgorithm::Algorithm1 => Self::Algorithm1(Box::new(Exploration::new(bound))),
            DirectionalAlgorithm::Folding => {
                Self::Folding(Box::new(FoldingExploration::new(bound)))
            }
        }
    }

    /// Maps a world. At its start the robot stands at the marked vertex, with its back to the facing
    /// door.
    ///
    /// # Errors
    /// Returns an error if the world does, if it contradicts itself, or at the bound. The state then
    /// holds what is known so far.
    pub fn map_world<W: World>(
        &mut self,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        match self {
            Self::Algorithm1(exploration) => map_world(world, &mut Nearest, exploration, observer),
            Self::Folding(exploration) => map_by_folding(world, exploration, observer),
        }
    }

    /// The robot's journey: its map, its pose in the map and its moves.
    #[must_use]
    pub fn journey(&self) -> &Journey {
        match self {
            Self::Algorithm1(exploration) => exploration.journey(),
            Self::Folding(exploration) => exploration.journey(),
        }
    }

    /// The map.
    #[must_use]
    pub fn map(&self) -> &PartialMap {
        self.journey().map()
    }

    /// The robot's pose in the map: the dart by which it came in. If its place is not known, the last
    /// known pose.
    #[must_use]
    pub fn robot(&self) -> Dart {
        self.journey().robot()
    }

    /// The moves made so far.
    #[must_use]
    pub fn moves(&self) -> u64 {
        self.journey().moves()
    }
}
