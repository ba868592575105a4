//! Errors in the definition of a message, with their lines.

use thiserror::Error;
use toposlam_model::counts::grouped;

use super::{MOST_BYTES, MOST_DEPTH, MOST_FIELDS};

/// Why a text is not the definition of a message.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("line {line} of the definition: {cause}")]
pub struct DefinitionError {
    /// The line, counted from 1.
    pub line: usize,
    /// The error.
    #[source]
    pub cause: DefinitionErrorKind,
}

/// The kind of an error in a definition. Quotations are short.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum DefinitionErrorKind {
    /// It is neither a field nor a constant.
    #[error("`{0}` is neither a field nor a constant")]
    Malformed(String),
    /// An invalid name.
    #[error("`{0}` is not a name")]
    NotAName(String),
    /// Two fields with one name.
    #[error("there are two fields `{0}`")]
    TwoFields(String),
    /// A constant that is a list or a message.
    #[error("the type `{0}` cannot be used for a constant")]
    ConstantType(String),
    /// A type that the text does not define.
    #[error("the type `{0}` is not defined")]
    UnknownType(String),
    /// A type that two packages define, and no package is named.
    #[error("the type `{0}` is defined more than once")]
    TwoTypes(String),
    /// A message that is a part of itself.
    #[error("`{0}` is a part of itself")]
    PartOfItself(String),
    /// A list of messages that have no fields, which takes no bytes however long it is.
    #[error("a list of `{0}`, which has no fields")]
    ListOfNothing(String),
    /// Messages in messages in messages.
    #[error("messages are nested more than {MOST_DEPTH} levels deep")]
    TooDeep,
    /// More fields than any message has.
    #[error("there are more than {} fields", grouped(MOST_FIELDS as u128))]
    TooManyFields,
    /// A longer text than any definition.
    #[error("the definition is longer than {} bytes", grouped(MOST_BYTES as u128))]
    TooLong,
}

impl DefinitionErrorKind {
    pub(super) fn at(self, line: usize) -> DefinitionError {
        DefinitionError { line, cause: self }
    }
}

/// The beginning of a text, for a message of one line.
pub(super) fn quoted(text: &str) -> String {
    const MOST: usize = 60;
    let mut quoted: String = text.chars().take(MOST).flat_map(char::escape_debug).collect();
    if text.chars().nth(MOST).is_some() {
        quoted.push_str("...");
    }
    quoted
}
