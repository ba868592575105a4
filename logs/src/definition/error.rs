//! Errors in the definition of a message, with their lines.

use thiserror::Error;
use toposlam_model::counts::grouped;

use super::{MOST_BYTES, MOST_DEPTH, MOST_FIELDS};

#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("line {line} of the definition: {cause}")]
pub struct DefinitionError {
    pub line: usize,
    #[source]
    pub cause: DefinitionErrorKind,
}

/// The kind of an error in a definition. Quotations are short.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum DefinitionErrorKind {
    #[error("`{0}` is neither a field nor a constant")]
    Malformed(String),
    #[error("`{0}` is not a name")]
    NotAName(String),
    #[error("there are two fields `{0}`")]
    TwoFields(String),
    #[error("the type `{0}` cannot be used for a constant")]
    ConstantType(String),
    #[error("the type `{0}` is not defined")]
    UnknownType(String),
    #[error("the type `{0}` is defined more than once")]
    TwoTypes(String),
    #[error("`{0}` is a part of itself")]
    PartOfItself(String),
    #[error("a list of `{0}`, which has no fields")]
    ListOfNothing(String),
    #[error("messages are nested more than {MOST_DEPTH} levels deep")]
    TooDeep,
    #[error("there are more than {} fields", grouped(MOST_FIELDS as u128))]
    TooManyFields,
    #[error("the definition is longer than {} bytes", grouped(MOST_BYTES as u128))]
    TooLong,
}

impl DefinitionErrorKind {
    pub(super) fn at(self, line: usize) -> DefinitionError {
        DefinitionError { line, cause: self }
    }
}

pub(super) fn quoted(text: &str) -> String {
    const MOST: usize = 60;
    let mut quoted: String = text.chars().take(MOST).flat_map(char::escape_debug).collect();
    if text.chars().nth(MOST).is_some() {
        quoted.push_str("...");
    }
    quoted
}
