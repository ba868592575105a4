//! What can be wrong with a topic map, and where.

use thiserror::Error;
use toposlam_model::format::document::{DocumentError, DocumentErrorKind, TextPosition};

use super::{MessagePart, Role};

#[derive(Clone, Debug, PartialEq, Error)]
#[error("{position}{kind}")]
pub struct TopicMapError {
    pub position: TextPosition,
    #[source]
    pub kind: TopicMapErrorKind,
}

#[derive(Clone, Debug, PartialEq, Error)]
pub enum TopicMapErrorKind {
    #[error(transparent)]
    Document(DocumentErrorKind),
    #[error("no topic is mapped")]
    Empty,
    #[error("there are both `heading` and `quaternion`; the file needs only one of them")]
    TwoHeadings,
    #[error("the log has no topic {topic:?}; it has: {known}")]
    NoTopic { topic: String, known: String },
    #[error("the log has messages of several types on {0:?}")]
    TwoTopics(String),
    #[error("on {topic:?}: {why}")]
    Undecodable { topic: String, why: String },
    #[error("messages of type {type_name:?} do not carry {}", .role.name())]
    WrongType { role: Role, type_name: String },
    #[error("for messages of type {type_name:?} the key `{}` must give a path", .part.name())]
    NoPath { part: MessagePart, type_name: String },
    #[error("{path:?} does not lead to {expected} in a {type_name}")]
    WrongPath { path: String, expected: &'static str, type_name: String },
    #[error(
        "{} topics could carry {}: {}; a mapping file must choose one",
        .topics.len(), .role.name(), .topics.join(", ")
    )]
    Several { role: Role, topics: Vec<String> },
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
