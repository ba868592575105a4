//! What can be wrong with a mapping file, and where.

use thiserror::Error;
use toposlam_model::format::place::Place;

use super::{Part, Role};

/// Why a mapping cannot be read, or does not fit its log.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{place}{cause}")]
pub struct TopicMapError {
    /// Where.
    pub place: Place,
    /// What is wrong there.
    #[source]
    pub cause: Cause,
}

/// What is wrong at a place of a mapping.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum Cause {
    /// The bytes are not UTF-8.
    #[error("this is not UTF-8 text")]
    NotText,
    /// The text is not TOML.
    #[error("{0}")]
    Syntax(String),
    /// Nothing is mapped.
    #[error("no topic is told to carry anything")]
    Empty,
    /// A key that has no meaning here.
    #[error("unknown key {key:?}; here can stand: {known}")]
    UnknownKey {
        /// The key.
        key: String,
        /// The keys that have one.
        known: String,
    },
    /// A key that must be here is not.
    #[error("the key `{0}` is missing")]
    MissingKey(&'static str),
    /// A value of the wrong kind.
    #[error("here should be {0}")]
    WrongKind(&'static str),
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
        self.at(Place::File)
    }

    pub(super) fn at(self, place: Place) -> TopicMapError {
        TopicMapError { place, cause: self }
    }
}
