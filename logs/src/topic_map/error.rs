//! What can be wrong with a topic map, and where.

use thiserror::Error;
use toposlam_model::format::document::{DocumentError, DocumentErrorKind, TextPosition};

use super::{MessagePart, Role};

/// Why a topic map cannot be read or does not fit its log.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{position}{kind}")]
pub struct TopicMapError {
    /// Where.
    pub position: TextPosition,
    /// What is wrong there.
    #[source]
    pub kind: TopicMapErrorKind,
}

/// What is wrong at a place of a topic map.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum TopicMapErrorKind {
    /// A key or a value of the file is not as it should be.
    #[error(transparent)]
    Document(DocumentErrorKind),
    /// The file maps no topic.
    #[error("no topic is mapped")]
    Empty,
    /// There are two paths to the heading.
    #[error("there are both `heading` and `quaternion`; the file needs only one of them")]
    TwoHeadings,
    /// There is no such topic.
    #[error("the log has no topic {topic:?}; it has: {known}")]
    NoTopic {
        /// The topic.
        topic: String,
        /// The first topics of the log.
        known: String,
    },
    /// Several topics have this name.
    #[error("the log has messages of several types on {0:?}")]
    TwoTopics(String),
    /// The messages of the topic cannot be decoded.
    #[error("on {topic:?}: {why}")]
    Undecodable {
        /// The topic.
        topic: String,
        /// The reason.
        why: String,
    },
    /// Messages of this type do not carry the role.
    #[error("messages of type {type_name:?} do not carry {}", .role.name())]
    WrongType {
        /// The role.
        role: Role,
        /// The type.
        type_name: String,
    },
    /// The path of a part is not known for messages of this type.
    #[error("for messages of type {type_name:?} the key `{}` must give a path", .part.name())]
    NoPath {
        /// The part.
        part: MessagePart,
        /// The type.
        type_name: String,
    },
    /// A path does not lead to a value of the right kind.
    #[error("{path:?} does not lead to {expected} in a {type_name}")]
    WrongPath {
        /// The path.
        path: String,
        /// The right kind.
        expected: &'static str,
        /// The type of the messages.
        type_name: String,
    },
    /// Several topics could carry a role.
    #[error(
        "{} topics could carry {}: {}; a mapping file must choose one",
        .topics.len(), .role.name(), .topics.join(", ")
    )]
    Several {
        /// The role.
        role: Role,
        /// The topics.
        topics: Vec<String>,
    },
}

impl TopicMapErrorKind {
    pub(super) fn in_file(self) -> TopicMapError {
        self.at(TextPosition::default())
    }

    pub(super) fn at(self, position: TextPosition) -> TopicMapError {
        TopicMapError { position, kind: self }
    }
}

impl From<DocumentError> for TopicMapError {
    fn from(DocumentError { position, kind }: DocumentError) -> Self {
        TopicMapErrorKind::Document(kind).at(position)
    }
}
