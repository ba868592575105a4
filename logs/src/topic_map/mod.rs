//! Topic maps: the topics of a log that carry each role, for logs of any program.
//!
//! ```toml
//! [image]                        # sensor_msgs CompressedImage, or Image in rgb8, bgr8 or mono8
//! topic = "/camera/image/compressed"
//!
//! [odometry]
//! topic = "/odom"
//! x = "pose.pose.position.x"     # the usual types need no paths
//! y = "pose.pose.position.y"
//! quaternion = "pose.pose.orientation"   # or heading = "theta"
//! length = "metres"              # or "inches"
//! angle = "radians"              # or "degrees"; of a heading
//!
//! [motion]
//! topic = "/cmd_vel"
//! forward = "linear.x"
//! turn = "angular.z"
//!
//! [percept]
//! topic = "/junction"
//! degree = "exits"
//! marker = "marker_door"
//!
//! [door]
//! topic = "/decision"
//! door = "exit"
//!
//! [marker]                       # AprilTagDetectionArray, Detection3DArray or PoseStamped
//! topic = "/detections"
//! id = 3                         # of several tags
//! frame = "tag36h11:3"           # of its transforms; this is the usual one
//! ```
//!
//! or, for a marker that was not there,
//!
//! ```toml
//! [marker]
//! at = [12.0, 3.5, 1.57]         # x, y and heading in the frame of odometry
//! ```
//!
//! And `[run]`, `[end]`, `[scene]`, `[command]`, `[hypothesis]` and `[map]`, with a topic, for the
//! project's own messages. A path leads through the fields of a message, `a.b[0].c`.

mod bound;
mod error;
mod guess;
mod marker_place;
mod read;
mod role;

pub use bound::BoundTopicMap;
pub(super) use bound::Carried;
pub use error::{TopicMapError, TopicMapErrorKind};
pub use guess::{RoleGuess, guess};
pub use marker_place::MarkerPlace;
pub(super) use role::{APRIL_TAGS, DETECTIONS};
pub use role::{AngleUnit, LengthUnit, MessagePart, Role};

use std::{collections::BTreeMap, fmt::Write};

use toposlam_model::format::document::TextPosition;

use super::reader::Log;

/// The topics that carry each role.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TopicMap {
    carriers: BTreeMap<Role, Carrier>,
    /// The place of a marker that is assumed.
    assumed: Option<MarkerPlace>,
}

/// A topic that carries something.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Carrier {
    /// Its name.
    pub topic: String,
    /// Where in its messages each part stands; what is usual for its type is left out.
    pub paths: BTreeMap<MessagePart, String>,
    /// The unit of lengths.
    pub length: LengthUnit,
    /// The unit of angles.
    pub angle: AngleUnit,
    /// The name or the number of the marker, among several.
    pub id: Option<String>,
    /// The frame of the marker, if it is not the usual one.
    pub frame: Option<String>,
    /// Where the mapping file says so.
    place: TextPosition,
    /// Where it says each path.
    places: BTreeMap<MessagePart, TextPosition>,
}

impl Carrier {
    /// A topic of a usual type.
    #[must_use]
    pub fn usual(topic: &str) -> Self {
        Self {
            topic: topic.to_owned(),
            paths: BTreeMap::new(),
            length: LengthUnit::Metres,
            angle: AngleUnit::Radians,
            id: None,
            frame: None,
            place: TextPosition::default(),
            places: BTreeMap::new(),
        }
    }
}

impl TopicMap {
    /// Reads a mapping file.
    ///
    /// Takes at most 512 bytes of memory for each byte of it, and 4096 besides.
    ///
    /// # Errors
    /// The first thing that is wrong, with its place. No bytes make it panic.
    pub fn read(bytes: &[u8]) -> Result<Self, TopicMapError> {
        read::read(bytes)
    }

    /// The roles of a log's topics by their types.
    ///
    /// # Errors
    /// If several topics could carry the same: which.
    pub fn from_log(log: &Log) -> Result<Self, TopicMapError> {
        let guesses = guess(log.topics());
        if let Some(RoleGuess { role, topics }) =
            guesses.iter().find(|guess| guess.topics.len() > 1)
        {
            let names = topics.iter().filter_map(|topic| log.topics().get(*topic));
            let topics = names.map(|topic| topic.name.clone()).collect();
            return Err(TopicMapErrorKind::Several { role: *role, topics }.in_file());
        }
        Ok(Self::unambiguous(log))
    }

    /// The roles of a log's topics by their types, without ambiguous roles.
    #[must_use]
    pub fn unambiguous(log: &Log) -> Self {
        let mut carriers = BTreeMap::new();
        for RoleGuess { role, topics } in guess(log.topics()) {
            if let [topic] = topics[..]
                && let Some(topic) = log.topics().get(topic)
            {
                carriers.insert(role, Carrier::usual(&topic.name));
            }
        }
        Self { carriers, assumed: None }
    }

    /// The place of a marker that is assumed to have lain there.
    #[must_use]
    pub fn assumed_marker(&self) -> Option<MarkerPlace> {
        self.assumed
    }

    /// The same map. If it has at most the marker, it has the unambiguous roles of a log, too.
    #[must_use]
    pub fn completed(self, log: &Log) -> Self {
        if self.carriers.keys().any(|role| *role != Role::Marker) {
            return self;
        }
        let mut whole = Self::unambiguous(log);
        whole.carriers.extend(self.carriers);
        Self { assumed: self.assumed, ..whole }
    }

    /// The carrier of a role, if there is one.
    #[must_use]
    pub fn carrier(&self, role: Role) -> Option<&Carrier> {
        self.carriers.get(&role)
    }

    /// Everything that is carried.
    pub fn carriers(&self) -> impl Iterator<Item = (Role, &Carrier)> {
        self.carriers.iter().map(|(role, carrier)| (*role, carrier))
    }

    /// One thing, carried by a topic of a usual type.
    #[must_use]
    pub fn of(role: Role, topic: &str) -> Self {
        Self { carriers: BTreeMap::from([(role, Carrier::usual(topic))]), assumed: None }
    }

    /// The map of some of the roles.
    #[must_use]
    pub fn only<'r>(&self, roles: impl IntoIterator<Item = &'r Role>) -> Self {
        let carrier = |role: &Role| Some((*role, self.carriers.get(role)?.clone()));
        let carriers = roles.into_iter().filter_map(carrier).collect();
        Self { carriers, assumed: None }
    }

    /// Whether nothing is carried.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.carriers.is_empty()
    }

    /// Checks that it fits a log: every topic exists once, and every path leads to the right type.
    ///
    /// # Errors
    /// The first thing that is wrong, with its place in the mapping file.
    pub fn bind(&self, log: &Log) -> Result<BoundTopicMap, TopicMapError> {
        bound::bind(self, log.topics())
    }

    /// The mapping file that reads as this.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let mut text = String::new();
        for (role, carrier) in &self.carriers {
            if !text.is_empty() {
                text.push('\n');
            }
            let quoted = |text: &str| toml::Value::from(text).to_string();
            let _ = writeln!(text, "[{}]\ntopic = {}", role.name(), quoted(&carrier.topic));
            for (part, path) in &carrier.paths {
                let _ = writeln!(text, "{} = {}", part.name(), quoted(path));
            }
            if carrier.length != LengthUnit::Metres {
                let _ = writeln!(text, "length = {}", quoted(carrier.length.name()));
            }
            if carrier.angle != AngleUnit::Radians {
                let _ = writeln!(text, "angle = {}", quoted(carrier.angle.name()));
            }
            for (key, value) in [("id", &carrier.id), ("frame", &carrier.frame)] {
                if let Some(value) = value {
                    let _ = writeln!(text, "{key} = {}", quoted(value));
                }
            }
        }
        if let Some(place) = self.assumed {
            if !text.is_empty() {
                text.push('\n');
            }
            let _ = writeln!(text, "[marker]\nat = {place}");
        }
        text
    }
}

#[cfg(test)]
mod tests;
