//! Which algorithm maps: there is one for each marker that suffices. Section 2.3.

use std::{path::Path, str::FromStr};

use toposlam_model::{
    check::{Algorithm1, AllChoices},
    embedded_graph::EmbeddedGraph,
    marker::{Directional, Marker, Movable},
};

use super::{Choice, Failure, movable};

/// The markers with which an algorithm maps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WithMarker {
    Directional,
    Movable,
}

impl FromStr for WithMarker {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        match name {
            "directional" => Ok(Self::Directional),
            "movable" => Ok(Self::Movable),
            _ => {
                Err(format!("`{name}` is no marker to map with; there are directional and movable"))
            }
        }
    }
}

/// An algorithm, with the choices that are wanted.
pub(super) enum Wanted {
    Algorithm1,
    AllChoices(AllChoices<Algorithm1>),
    MovableMarker,
}

impl WithMarker {
    /// The name of the marker.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Directional => Directional.name(),
            Self::Movable => Movable.name(),
        }
    }

    /// The algorithm that maps with the marker.
    pub(super) fn algorithm(self, choice: Choice) -> Result<Wanted, Failure> {
        match (self, choice) {
            (Self::Directional, Choice::Default) => Ok(Wanted::Algorithm1),
            (Self::Directional, Choice::All { budget }) => {
                Ok(Wanted::AllChoices(AllChoices { algorithm: Algorithm1, budget }))
            }
            (Self::Movable, Choice::Default) => Ok(Wanted::MovableMarker),
            (Self::Movable, Choice::All { .. }) => {
                let cause =
                    "all choices are those of Algorithm 1, which maps with the directional marker";
                Err(Failure::at("--choices", cause))
            }
        }
    }

    /// Refuses the worlds of a file if the marker does not suffice for one of them.
    pub(super) fn check_worlds(self, path: &Path, graphs: &[EmbeddedGraph]) -> Result<(), Failure> {
        match self {
            Self::Directional => Ok(()),
            Self::Movable => movable::check_worlds(path, graphs),
        }
    }
}
