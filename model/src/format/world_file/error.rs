//! What can be wrong with a world file, and where.

use thiserror::Error;

use crate::{
    embedded_graph::ListError,
    floor_plan::FloorPlanError,
    format::{named_world::StartError, place::Place},
};

/// Why bytes are not a world file: one message that names place and cause.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{place}{cause}")]
pub struct WorldFileError {
    /// Where in the file.
    pub place: Place,
    /// What is wrong there.
    #[source]
    pub cause: Cause,
}

/// What is wrong at a place of a world file.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Cause {
    /// There is nothing but space.
    #[error("the file is empty")]
    Empty,
    /// The bytes are not UTF-8.
    #[error("this is not UTF-8 text")]
    NotText,
    /// The text is neither TOML nor, from its first brace on, JSON.
    #[error("{0}")]
    Syntax(String),
    /// A key that has no meaning here.
    #[error("unknown key; here can stand: {known}")]
    UnknownKey {
        /// The keys that have one.
        known: String,
    },
    /// A key that must be here is not.
    #[error("the key `{key}` is missing")]
    MissingKey {
        /// The key.
        key: &'static str,
    },
    /// A value of the wrong kind.
    #[error("here should be {expected}, not {found}")]
    WrongKind {
        /// What should be here.
        expected: &'static str,
        /// What is here.
        found: &'static str,
    },
    /// A name with other characters than names have.
    #[error("`{name}` is no name; a name is made of A-Z, a-z, 0-9, _ and -")]
    NotAName {
        /// What was given.
        name: String,
    },
    /// Nothing tells the graph.
    #[error("there is no world: one of [clockwise], [doors] and [floor] must stand in the file")]
    NoWorld,
    /// The graph is told twice.
    #[error("there are both [{one}] and [{other}]; a world is told by one of them")]
    TwoWorlds {
        /// The first way in which it is told.
        one: &'static str,
        /// The second.
        other: &'static str,
    },
    /// The lists are not those of an embedded graph.
    #[error(transparent)]
    Lists(#[from] ListError),
    /// The hallways are not a floor plan.
    #[error(transparent)]
    Plan(#[from] Box<FloorPlanError>),
    /// The start is not there.
    #[error(transparent)]
    Start(#[from] StartError),
}

impl Cause {
    /// The error that has this cause at the path of a key.
    pub(super) fn at(self, path: impl Into<String>) -> WorldFileError {
        WorldFileError { place: Place::Key(path.into()), cause: self }
    }

    /// The error that has this cause in the file as a whole.
    pub(super) fn in_file(self) -> WorldFileError {
        WorldFileError { place: Place::File, cause: self }
    }

    /// The error that has this cause at a byte of the text.
    pub(super) fn at_byte(self, text: &str, byte: usize) -> WorldFileError {
        WorldFileError { place: Place::at_byte(text.as_bytes(), byte), cause: self }
    }
}
