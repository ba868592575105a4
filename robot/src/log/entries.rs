//! What a log tells of a run, read through a mapping, in the order of time.

use toposlam_model::driving::{odometry::Odometry, scene::wrapped};

use super::{
    decode::decode,
    error::{LogError, LogErrorKind},
    from_value::FromValue,
    image::image_of,
    merge::{RawMessage, RawMessages},
    messages::{Command, Door, End, Hypothesis, Map, Percept, Run, Scene, Stamp},
    reader::Log,
    standard::Quaternion,
    topic_map::{Bound, Carried, Part, Role},
    value::Value,
};
use crate::record::CameraImage;

/// Something that a log tells.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// When it was recorded, in nanoseconds.
    pub time: u64,
    /// Where it is in the file: see [`RawMessage::offset`].
    pub offset: u64,
    /// The how-manyeth message of the log it is; the first is 1.
    pub number: u64,
    /// Which topic of the log it is on.
    pub topic: usize,
    /// When it was so, as the message says itself, by its `stamp` or `header.stamp`; otherwise when it
    /// was recorded.
    pub stamp: Stamp,
    /// What it tells.
    pub content: Content,
}

/// Stands for a number of moves that a log does not tell.
pub const UNTOLD: u32 = u32::MAX;

/// What an entry tells.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// What runs, and in what setting.
    Run(Run),
    /// The last entry of a log that is whole.
    End(End),
    /// What the camera sees.
    Image(CameraImage),
    /// Where the robot is by its wheels.
    Odometry(Odometry),
    /// What it is told to do: metres, and radians counter-clockwise, each second.
    Motion {
        /// Straight ahead.
        forward: f64,
        /// Turning.
        turn: f64,
    },
    /// What sensing tells.
    Scene(Scene),
    /// What Algorithm 2 answers.
    Command(Command),
    /// What the robot perceives. Where the log has a message of its own for that: `move` and `marker` are
    /// [`UNTOLD`] and -1 where they are not mapped, `form` is all false, and `entry` not a number.
    Percept(Percept),
    /// The door that it takes. Where the log has a message of its own for that, `move` is [`UNTOLD`] where
    /// it is not mapped.
    Door(Door),
    /// A step of Algorithm 1.
    Hypothesis(Hypothesis),
    /// The map.
    Map(Map),
}

/// The entries of a log.
pub struct Entries<'l> {
    log: &'l Log,
    bound: Bound,
    messages: RawMessages<'l>,
    /// What the last message carries beyond its first.
    next: Vec<Entry>,
}

impl Log {
    /// What it tells through a mapping, in the order of time. Ends after the first error.
    #[must_use]
    pub fn entries(&self, mapping: &Bound) -> Entries<'_> {
        let messages = self.read(&mapping.topics());
        Entries { log: self, bound: mapping.clone(), messages, next: Vec::new() }
    }
}

impl Iterator for Entries<'_> {
    type Item = Result<Entry, LogError>;

    fn next(&mut self) -> Option<Self::Item> {
        if let Some(entry) = self.next.pop() {
            return Some(Ok(entry));
        }
        loop {
            let message = match self.messages.next()? {
                Ok(message) => message,
                Err(error) => return Some(Err(error)),
            };
            match entries(self.log, &self.bound, &message) {
                // The first one is taken from the end.
                Ok(mut entries) => {
                    entries.reverse();
                    let first = entries.pop();
                    self.next = entries;
                    if let Some(first) = first {
                        return Some(Ok(first));
                    }
                }
                Err(error) => {
                    self.messages.end();
                    return Some(Err(error));
                }
            }
        }
    }
}

/// What one message tells.
fn entries(log: &Log, bound: &Bound, message: &RawMessage) -> Result<Vec<Entry>, LogError> {
    let Some(topic) = log.topics().get(message.topic) else { return Ok(Vec::new()) };
    let Ok(definition) = &topic.definition else { return Ok(Vec::new()) };
    let name = || topic.name.clone();
    let value = decode(definition, &message.bytes).map_err(|error| {
        let (number, topic) = (message.number, name());
        LogErrorKind::Message { number, topic, error: Box::new(error) }.at(message.offset)
    })?;
    let stamp = stamp(&value, message.time);
    let carried = bound.carried.iter().filter(|carried| carried.topic == message.topic);
    let entries = carried.map(|carried| {
        let content = content(carried, &value, stamp).map_err(|what| {
            let (number, topic) = (message.number, name());
            LogErrorKind::Content { number, topic, what }.at(message.offset)
        })?;
        let RawMessage { time, offset, number, topic, .. } = *message;
        Ok(Entry { time, offset, number, topic, stamp, content })
    });
    entries.collect()
}

fn stamp(value: &Value<'_>, time: u64) -> Stamp {
    let told = ["stamp", "header.stamp"].into_iter().find_map(|path| value.at(path)?.stamp());
    told.unwrap_or(Stamp::of(time))
}

fn content(carried: &Carried, value: &Value<'_>, stamp: Stamp) -> Result<Content, String> {
    Ok(match carried.role {
        Role::Image => Content::Image(image_of(value)?),
        Role::Odometry => Content::Odometry(odometry(carried, value)?),
        Role::Motion => Content::Motion {
            forward: number(carried, value, Part::Forward)? * carried.length.in_metres(),
            turn: number(carried, value, Part::Turn)? * carried.angle.in_radians(),
        },
        Role::Percept if !carried.own => Content::Percept(Percept {
            stamp,
            r#move: whole(carried, value, Part::Move)?.unwrap_or(UNTOLD),
            degree: whole(carried, value, Part::Degree)?.unwrap_or_default(),
            marker: whole(carried, value, Part::Marker)?.unwrap_or(-1),
            form: [false; 4],
            entry: f64::NAN,
        }),
        Role::Door if !carried.own => Content::Door(Door {
            stamp,
            r#move: whole(carried, value, Part::Move)?.unwrap_or(UNTOLD),
            door: whole(carried, value, Part::Door)?.unwrap_or_default(),
        }),
        Role::Percept => Content::Percept(own(value)?),
        Role::Door => Content::Door(own(value)?),
        Role::Run => Content::Run(own(value)?),
        Role::Scene => Content::Scene(own(value)?),
        Role::Command => Content::Command(own(value)?),
        Role::Hypothesis => Content::Hypothesis(own(value)?),
        Role::Map => Content::Map(own(value)?),
        Role::End => Content::End(own(value)?),
    })
}

fn own<M: FromValue>(value: &Value<'_>) -> Result<M, String> {
    M::from_value(value)
        .map_err(|field| format!("its field `{field}` is missing, or is not what it should be"))
}

fn number(carried: &Carried, value: &Value<'_>, part: Part) -> Result<f64, String> {
    let path = carried.paths.get(&part).map_or("", String::as_str);
    number_at(value, path)
}

fn number_at(value: &Value<'_>, path: &str) -> Result<f64, String> {
    let found = value.at(path).and_then(|value| value.f64());
    match found {
        Some(number) if number.is_finite() => Ok(number),
        Some(number) => Err(format!("its `{path}` is {number}")),
        None => Err(format!("it has no `{path}`")),
    }
}

/// A whole number, where it is mapped.
fn whole<N: TryFrom<i64>>(
    carried: &Carried,
    value: &Value<'_>,
    part: Part,
) -> Result<Option<N>, String> {
    let Some(path) = carried.paths.get(&part) else { return Ok(None) };
    let found = value.at(path).ok_or_else(|| format!("it has no `{path}`"))?;
    let whole = found.i64().and_then(|number| N::try_from(number).ok());
    whole.map(Some).ok_or_else(|| format!("its `{path}` is no {}", part.name()))
}

fn odometry(carried: &Carried, value: &Value<'_>) -> Result<Odometry, String> {
    let [x, y] = [number(carried, value, Part::X)?, number(carried, value, Part::Y)?];
    let heading = match carried.paths.get(&Part::Quaternion) {
        None => number(carried, value, Part::Heading)? * carried.angle.in_radians(),
        Some(path) => {
            let part = |name| number_at(value, &format!("{path}.{name}"));
            Quaternion { x: part("x")?, y: part("y")?, z: part("z")?, w: part("w")? }
                .heading()
                .ok_or_else(|| format!("its `{path}` is no rotation"))?
        }
    };
    let length = carried.length.in_metres();
    Ok(Odometry { position: [x * length, y * length], heading: wrapped(heading) })
}
