//! World files, in TOML and in JSON of the same shape. The embedded graph is given by neighbours
//! (`[clockwise]`), by edges (`[doors]`), or by a floor plan (`[floor]`, `[junctions]`,
//! `[[hallways]]`), and the robot's start by `[start]`. Sections 2.1 and 2.4.

mod read;
mod write;

use thiserror::Error;

pub use read::{is_name, read};
pub use write::{to_json, to_json_text, to_toml};

use super::{
    document::{DocumentErrorKind, FileError},
    named_world::StartError,
};
use crate::{embedded_graph::ListError, floor_plan::FloorPlanError};

pub type WorldFileError = FileError<WorldFileErrorKind>;

#[derive(Clone, Debug, PartialEq, Error)]
pub enum WorldFileErrorKind {
    #[error(transparent)]
    Document(#[from] DocumentErrorKind),
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

#[cfg(test)]
mod tests;
