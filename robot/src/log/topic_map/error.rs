//! What can be wrong with a mapping file, and where.

use thiserror::Error;
use toposlam_model::format::document::{DocumentError, DocumentErrorKind, TextPosition};

use super::{Part, Role};

/// Why a mapping cannot be read, or does not fit its log.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{position}{cause}")]
pub struct TopicMapError {
    /// Where.
    pub position: TextPosition,
    /// What is wrong there.
    #[source]
    pub cause: Cause,
}

/// What is wrong at a place of a mapping.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Cause {
    /// A key or a value of the file is not as it should be.
    #[error(transparent)]
    Document(DocumentErrorKind),
    /// The file maps no topic.
    #[error("no topic is mapped")]
    Empty,
    /// Two ways to tell the same.
    #[error("either `heading` or `quaternion` tells where the robot looks, not both")]
    TwoHeadings,
    /// There is no such topic.
    #[error("the log has no topic {topic:?}; it has: {known}")]
    NoTopic {
        /// The topic.
        topic: String,
        /// Some of those that there are.
        known: String,
    },
    /// Several topics have the name.
    #[error("the log has messages of several types on {0:?}")]
    TwoTopics(String),
    /// The messages of the topic cannot be decoded.
    #[error("on {topic:?}: {why}")]
    Undecodable {
        /// The topic.
        topic: String,
        /// Why.
        why: String,
    },
    /// Messages of a type that does not carry this.
    #[error("messages of type {type_name:?} do not carry {}", .role.name())]
    WrongType {
        /// What they should carry.
        role: Role,
        /// The type.
        type_name: String,
    },
    /// Messages of a type of which it is not known where a part stands.
    #[error("for messages of type {type_name:?} the key `{}` must tell a path", .part.name())]
    NoPath {
        /// The part.
        part: Part,
        /// The type.
        type_name: String,
    },
    /// A path that leads nowhere, or not to what it should.
    #[error("{path:?} does not lead to {expected} in a {type_name}")]
    WrongPath {
        /// The path.
        path: String,
        /// What it should lead to.
        expected: &'static str,
        /// The type of the messages.
        type_name: String,
    },
    /// Several topics could carry something.
    #[error(
        "{} topics could carry {}: {}; a mapping file tells which does",
        .topics.len(), .role.name(), .topics.join(", ")
    )]
    Several {
        /// What they could carry.
        role: Role,
        /// The topics.
        topics: Vec<String>,
    },
}

impl Cause {
    pub(super) fn in_file(self) -> TopicMapError {
        self.at(TextPosition::default())
    }

    pub(super) fn at(self, position: TextPosition) -> TopicMapError {
        TopicMapError { position, cause: self }
    }
}

impl From<DocumentError> for TopicMapError {
    fn from(DocumentError { position, kind }: DocumentError) -> Self {
        Cause::Document(kind).at(position)
    }
}
