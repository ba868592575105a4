//! A mapping that fits its log: each topic that carries something, and the paths in its messages.

use std::collections::BTreeMap;

use toposlam_model::format::document::DocumentError;

use super::{
    AngleUnit, Carrier, LengthUnit, MessagePart, Role, ScannerFrames, TopicMap, invalid,
    role::APRIL_TAGS,
};
use crate::{
    definition::{Count, Definition, FieldType},
    topic::Topic,
    transforms::is_transforms,
};

#[derive(Clone, Debug)]
pub struct BoundTopicMap {
    pub(crate) carried: Vec<Carried>,
    pub(crate) scanner: ScannerFrames,
}

/// A role that a topic carries, and the paths in its messages. A topic may carry several roles.
#[derive(Clone, Debug)]
pub(crate) struct Carried {
    pub(crate) role: Role,
    pub(crate) topic: usize,
    pub(crate) paths: BTreeMap<MessagePart, String>,
    pub(crate) own: bool,
    /// Whether its paths and units are those that are usual for its type.
    pub(crate) is_usual: bool,
    pub(crate) type_name: String,
    pub(crate) length: LengthUnit,
    pub(crate) angle: AngleUnit,
    pub(crate) id: Option<String>,
    /// The frame of the marker, if it is not the usual one.
    pub(crate) frame: Option<String>,
}

impl BoundTopicMap {
    pub(crate) fn carries(&self, role: Role) -> bool {
        self.carried.iter().any(|carried| carried.role == role)
    }

    pub fn topics(&self) -> Vec<usize> {
        self.carried.iter().map(|carried| carried.topic).collect()
    }
}

pub(super) fn bind(mapping: &TopicMap, topics: &[Topic]) -> Result<BoundTopicMap, DocumentError> {
    let carried = mapping.carriers().map(|(role, carrier)| carried(role, carrier, topics));
    let mut carried = carried.collect::<Result<Vec<_>, _>>()?;
    // The poses of these tags are transforms.
    if let Some(tags) = carried.iter().find(|carried| carried.type_name == APRIL_TAGS).cloned() {
        let is_transforms = |topic: &Topic| is_transforms(&topic.short_type());
        let transforms = topics.iter().enumerate().filter(|(_, topic)| is_transforms(topic));
        carried.extend(transforms.map(|(topic, named)| Carried {
            topic,
            type_name: named.short_type(),
            ..tags.clone()
        }));
    }
    Ok(BoundTopicMap { carried, scanner: mapping.scanner.clone() })
}

fn carried(role: Role, carrier: &Carrier, topics: &[Topic]) -> Result<Carried, DocumentError> {
    let wrong = |why: String| invalid(&carrier.place, why);
    let (index, topic) = named(&carrier.topic, topics).map_err(wrong)?;
    let definition = topic.definition.as_ref();
    let definition = definition.map_err(|why| wrong(format!("on {:?}: {why}", carrier.topic)))?;
    let type_name = topic.short_type();
    let usual = role.usual(&type_name);
    let own = usual.is_some_and(<[_]>::is_empty) && carrier.paths.is_empty();
    if usual.is_none() && role.parts().is_empty() {
        let why = format!("messages of type {type_name:?} do not carry {}", role.name());
        return Err(wrong(why));
    }
    let mut paths = carrier.paths.clone();
    if !own {
        let heading_mapped = [MessagePart::Heading, MessagePart::Quaternion]
            .iter()
            .any(|part| paths.contains_key(part));
        for (part, path) in usual.unwrap_or_default() {
            let is_heading = matches!(part, MessagePart::Heading | MessagePart::Quaternion);
            if !(is_heading && heading_mapped) {
                paths.entry(*part).or_insert_with(|| (*path).to_owned());
            }
        }
        for part in needed(role, &paths) {
            if !paths.contains_key(&part) {
                let key = part.name();
                return Err(wrong(format!(
                    "for messages of type {type_name:?} the key `{key}` must give a path"
                )));
            }
        }
    }
    for (part, path) in &paths {
        let place = carrier.places.get(part).unwrap_or(&carrier.place);
        let expected = if *part == MessagePart::Quaternion { "a quaternion" } else { "a number" };
        if !leads(definition, path, *part) {
            let why = format!("{path:?} does not lead to {expected} in a {type_name}");
            return Err(invalid(place, why));
        }
    }
    let Carrier { length, angle, ref id, ref frame, .. } = *carrier;
    let (id, frame) = (id.clone(), frame.clone());
    let is_usual =
        carrier.paths.is_empty() && (length, angle) == (LengthUnit::Metres, AngleUnit::Radians);
    Ok(Carried { role, topic: index, paths, own, is_usual, type_name, length, angle, id, frame })
}

/// The parts without which there is nothing.
fn needed(role: Role, paths: &BTreeMap<MessagePart, String>) -> Vec<MessagePart> {
    match role {
        Role::Odometry if paths.contains_key(&MessagePart::Quaternion) => {
            vec![MessagePart::X, MessagePart::Y]
        }
        Role::Odometry => vec![MessagePart::X, MessagePart::Y, MessagePart::Heading],
        Role::Motion => vec![MessagePart::Forward, MessagePart::Turn],
        Role::Percept => vec![MessagePart::Degree],
        Role::Door => vec![MessagePart::Door],
        _ => Vec::new(),
    }
}

fn named<'t>(name: &str, topics: &'t [Topic]) -> Result<(usize, &'t Topic), String> {
    let mut found = topics.iter().enumerate().filter(|(_, topic)| topic.name == name);
    let Some(first) = found.next() else {
        const SHOWN: usize = 12;
        let names = topics.iter().take(SHOWN).map(|topic| topic.name.escape_debug().to_string());
        let more = (topics.len() > SHOWN).then(|| "...".to_owned());
        let known: Vec<_> = names.chain(more).collect();
        return Err(format!("the log has no topic {name:?}; it has: {}", known.join(", ")));
    };
    match found.next() {
        None => Ok(first),
        Some(_) => Err(format!("the log has messages of several types on {name:?}")),
    }
}

fn leads(definition: &Definition, path: &str, part: MessagePart) -> bool {
    let found = definition.at(path);
    if part != MessagePart::Quaternion {
        // A marker that points nowhere is seen or not; of other marking aids, what is seen is in words.
        let is_marker = part == MessagePart::Marker;
        let number = |kind| match kind {
            FieldType::Int(_) | FieldType::Unsigned(_) | FieldType::Float(_) => true,
            kind => is_marker && [FieldType::Bool, FieldType::Text].contains(&kind),
        };
        return found.is_some_and(|(kind, count)| number(kind) && count == Count::One);
    }
    ["x", "y", "z", "w"].iter().all(|name| {
        let part = definition.at(&format!("{path}.{name}"));
        part.is_some_and(|(kind, count)| matches!(kind, FieldType::Float(_)) && count == Count::One)
    })
}
