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
    pub position: TextPosition,
    #[source]
    pub kind: WorldFileErrorKind,
}

/// What is wrong at a place of a world file.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum WorldFileErrorKind {
    #[error(transparent)]
    Document(DocumentErrorKind),
    #[error(
        "`{name}` is not a name; a name is printable, without quotes, / and \\, and without a space at its \
             ends"
    )]
    NotAName { name: String },
    #[error("there is no world; the file needs one of [clockwise], [doors] and [floor]")]
    NoWorld,
    #[error("there are both [{one}] and [{other}]; a world needs only one of them")]
    TwoWorlds { one: &'static str, other: &'static str },
    #[error("the vertex `{vertex}` has no position")]
    NoPosition { vertex: String },
    #[error("there is no vertex `{vertex}`")]
    NoVertex { vertex: String },
    #[error("a floor plan has its positions in [junctions]")]
    PositionsOfPlan,
    #[error(transparent)]
    Lists(#[from] ListError),
    #[error(transparent)]
    Plan(#[from] Box<FloorPlanError>),
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
