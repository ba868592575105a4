//! Topic maps: the topics of a log that carry each role, for logs of any program. `docs/logs.md` describes the file.
//!
//! ```toml
//! [odometry]
//! topic = "/place"
//! x = "at.x"           # the usual types need no paths; a path leads through the fields of a message, `a.b[0].c`
//! y = "at.y"
//! quaternion = "at.orientation"
//! length = "inches"
//! ```

mod bound;
mod read;
mod role;

pub use bound::BoundTopicMap;
pub(super) use bound::Carried;
pub(super) use role::{APRIL_TAGS, DETECTIONS};
pub use role::{AngleUnit, LengthUnit, MessagePart, Role};

pub use crate::transforms::ScannerFrames;

use std::{
    collections::BTreeMap,
    fmt::{self, Write},
};

use toposlam_model::format::document::{DocumentError, DocumentErrorKind, TextPosition};

use super::{reader::Log, topic::Topic};

#[derive(Clone, Debug, Default, PartialEq)]
pub struct TopicMap {
    carriers: BTreeMap<Role, Carrier>,
    assumed: Option<MarkerPlace>,
    scanner: ScannerFrames,
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Carrier {
    pub topic: String,
    /// Where in its messages each part stands; what is usual for its type is left out.
    pub paths: BTreeMap<MessagePart, String>,
    pub length: LengthUnit,
    pub angle: AngleUnit,
    pub id: Option<String>,
    pub frame: Option<String>,
    place: TextPosition,
    places: BTreeMap<MessagePart, TextPosition>,
}

impl Carrier {
    pub fn usual(topic: &str) -> Self {
        Self { topic: topic.to_owned(), ..Self::default() }
    }
}

/// Where a marker lies in the frame of odometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarkerPlace {
    /// In metres.
    pub position: [f64; 2],
    /// The direction in which it points, in radians counter-clockwise from x; `None` if it has none.
    pub heading: Option<f64>,
}

impl fmt::Display for MarkerPlace {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let [x, y] = self.position;
        match self.heading {
            Some(heading) => write!(out, "[{x:?}, {y:?}, {heading:?}]"),
            None => write!(out, "[{x:?}, {y:?}]"),
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
    pub fn read(bytes: &[u8]) -> Result<Self, DocumentError> {
        read::read(bytes)
    }

    /// The roles of a log's topics by their types.
    ///
    /// # Errors
    /// If several topics could carry the same: which.
    pub fn from_log(log: &Log) -> Result<Self, DocumentError> {
        let guesses = guess(log.topics());
        if let Some(RoleGuess { role, topics }) =
            guesses.iter().find(|guess| guess.topics.len() > 1)
        {
            let names = topics.iter().filter_map(|topic| log.topics().get(*topic));
            let names: Vec<_> = names.map(|topic| &*topic.name).collect();
            let (count, role, names) = (names.len(), role.name(), names.join(", "));
            let why = format!(
                "{count} topics could carry {role}: {names}; a mapping file must choose one"
            );
            return Err(invalid(&TextPosition::default(), why));
        }
        Ok(Self::unambiguous(log))
    }

    /// The roles of a log's topics by their types, without ambiguous roles.
    pub fn unambiguous(log: &Log) -> Self {
        let mut carriers = BTreeMap::new();
        for RoleGuess { role, topics } in guess(log.topics()) {
            if let [topic] = topics[..]
                && let Some(topic) = log.topics().get(topic)
            {
                carriers.insert(role, Carrier::usual(&topic.name));
            }
        }
        Self { carriers, ..Self::default() }
    }

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
        Self { assumed: self.assumed, scanner: self.scanner, ..whole }
    }

    pub fn carrier(&self, role: Role) -> Option<&Carrier> {
        self.carriers.get(&role)
    }

    pub fn carriers(&self) -> impl Iterator<Item = (Role, &Carrier)> {
        self.carriers.iter().map(|(role, carrier)| (*role, carrier))
    }

    pub fn with_topic(role: Role, topic: &str) -> Self {
        Self { carriers: BTreeMap::from([(role, Carrier::usual(topic))]), ..Self::default() }
    }

    #[must_use]
    pub fn only<'r>(&self, roles: impl IntoIterator<Item = &'r Role>) -> Self {
        let carrier = |role: &Role| Some((*role, self.carriers.get(role)?.clone()));
        let carriers = roles.into_iter().filter_map(carrier).collect();
        Self { carriers, assumed: None, scanner: self.scanner.clone() }
    }

    pub fn is_empty(&self) -> bool {
        self.carriers.is_empty()
    }

    /// Checks that it fits a log: every topic exists once, and every path leads to the right type.
    ///
    /// # Errors
    /// The first thing that is wrong, with its place in the mapping file.
    pub fn bind(&self, log: &Log) -> Result<BoundTopicMap, DocumentError> {
        bound::bind(self, log.topics())
    }

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
        let ScannerFrames { mount, base_frame } = &self.scanner;
        if self.scanner != ScannerFrames::default() {
            text.push_str(if text.is_empty() { "[scanner]\n" } else { "\n[scanner]\n" });
        }
        if let Some([x, y, yaw]) = mount {
            let _ = writeln!(text, "mount = [{x:?}, {y:?}, {yaw:?}]");
        }
        if let Some(frame) = base_frame {
            let _ = writeln!(text, "base_frame = {}", toml::Value::from(frame.as_str()));
        }
        text
    }
}

fn invalid(position: &TextPosition, why: String) -> DocumentError {
    DocumentError { position: position.clone(), kind: DocumentErrorKind::Invalid(why) }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RoleGuess {
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

#[cfg(test)]
mod tests;
