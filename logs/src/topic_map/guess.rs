//! The topics that could carry each role, by the types of their messages.

use super::Role;
use crate::topic::Topic;

/// The topics that could carry something.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RoleGuess {
    /// The role.
    pub role: Role,
    /// Which topics of the log; at least one, and none is better than the others.
    pub topics: Vec<usize>,
}

/// For everything that could be carried, all topics with messages that could: those of the project's own
/// types, also where they have come by way of ROS 1; and those of the types that are usual for it.
///
/// Topics of annotated images (`annotated` is a part of the name) are not a camera's. Odometry comes from
/// transforms, or from the lines of a scanner, if there is no other; `/tf_static` does not move. Whether a tag
/// or a pose is the marker only a mapping file knows.
#[must_use]
pub fn guess(topics: &[Topic]) -> Vec<RoleGuess> {
    let could = |role: Role, topic: &Topic| {
        let annotated = topic.name.split('/').any(|part| part == "annotated");
        role != Role::Marker
            && topic.messages > 0
            && topic.definition.is_ok()
            && role.usual(&topic.short_type()).is_some()
            && !(role == Role::Image && annotated)
            && !(role == Role::Odometry && topic.name.ends_with("tf_static"))
    };
    let guesses = Role::ALL.map(|role| {
        let could = || topics.iter().enumerate().filter(|(_, topic)| could(role, topic));
        let rank = |topic: &Topic| role.rank(&topic.short_type());
        let best = could().map(|(_, topic)| rank(topic)).min();
        let topics = could().filter(|(_, topic)| Some(rank(topic)) == best);
        RoleGuess { role, topics: topics.map(|(index, _)| index).collect() }
    });
    guesses.into_iter().filter(|guess| !guess.topics.is_empty()).collect()
}
