//! What can be wrong with a world file, and where.

use thiserror::Error;

use crate::{
    embedded_graph::ListError,
    floor_plan::FloorPlanError,
    format::{
        document::{DocumentError, DocumentErrorKind, TextPosition},
        named_world::StartError,
    },
};

/// Why bytes are not a world file.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{position}{kind}")]
pub struct WorldFileError {
    /// Where in the file.
    pub position: TextPosition,
    /// What is wrong there.
    #[source]
    pub kind: WorldFileErrorKind,
}

/// What is wrong at a place of a world file.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum WorldFileErrorKind {
    /// A key or a value is not as it should be.
    #[error(transparent)]
    Document(DocumentErrorKind),
    /// This is not a name.
    #[error(
        "`{name}` is not a name; a name is printable, without quotes, / and \\, and without a space at its \
             ends"
    )]
    NotAName {
        /// The text.
        name: String,
    },
    /// There is no graph.
    #[error("there is no world; the file needs one of [clockwise], [doors] and [floor]")]
    NoWorld,
    /// There are two graphs.
    #[error("there are both [{one}] and [{other}]; a world needs only one of them")]
    TwoWorlds {
        /// The first key.
        one: &'static str,
        /// The second key.
        other: &'static str,
    },
    /// A vertex has no position.
    #[error("the vertex `{vertex}` has no position")]
    NoPosition {
        /// The vertex.
        vertex: String,
    },
    /// There is no such vertex.
    #[error("there is no vertex `{vertex}`")]
    NoVertex {
        /// The name.
        vertex: String,
    },
    /// The junctions of a floor plan have positions.
    #[error("a floor plan has its positions in [junctions]")]
    PositionsOfPlan,
    /// The lists are not those of an embedded graph.
    #[error(transparent)]
    Lists(#[from] ListError),
    /// The hallways are not a floor plan.
    #[error(transparent)]
    Plan(#[from] Box<FloorPlanError>),
    /// There is no such start.
    #[error(transparent)]
    Start(#[from] StartError),
}

impl WorldFileErrorKind {
    pub(super) fn at(self, position: TextPosition) -> WorldFileError {
        WorldFileError { position, kind: self }
    }
}

impl From<DocumentError> for WorldFileError {
    fn from(DocumentError { position, kind }: DocumentError) -> Self {
        WorldFileErrorKind::Document(kind).at(position)
    }
}
