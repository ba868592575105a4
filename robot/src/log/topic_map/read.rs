//! Reading a topic map: bytes in, a [`TopicMap`] or an error out.

use std::collections::BTreeMap;

use toposlam_model::format::document::{Document, DocumentError, DocumentValue};

use super::{
    AngleUnit, Carrier, LengthUnit, MessagePart, Role, TopicMap, TopicMapError, TopicMapErrorKind,
};

pub(super) fn read(bytes: &[u8]) -> Result<TopicMap, TopicMapError> {
    let document = Document::parse_toml(bytes)?;
    let file = document.root().table(&Role::ALL.map(Role::name))?;
    let mut carriers = BTreeMap::new();
    for role in Role::ALL {
        if let Some(value) = file.get(role.name()) {
            carriers.insert(role, carrier(role, value)?);
        }
    }
    if carriers.is_empty() {
        return Err(TopicMapErrorKind::Empty.at(file.position()));
    }
    Ok(TopicMap { carriers })
}

fn carrier(role: Role, value: DocumentValue<'_>) -> Result<Carrier, TopicMapError> {
    let parts = role.parts().iter().map(|part| part.name());
    let units: &[_] = match role {
        Role::Odometry | Role::Motion => &["length", "angle"],
        _ => &[],
    };
    let known: Vec<_> = ["topic"].into_iter().chain(parts).chain(units.iter().copied()).collect();
    let table = value.table(&known)?;
    let topic = table.need("topic")?;
    let mut carrier = Carrier::usual(text(topic, "the name of a topic")?);
    carrier.place = topic.position();
    for &part in role.parts() {
        if let Some(path) = table.get(part.name()) {
            carrier.paths.insert(part, text(path, "the path of a field")?.to_owned());
            carrier.places.insert(part, path.position());
        }
    }
    if let Some(unit) = table.get("length") {
        carrier.length =
            unit.word(&[LengthUnit::Metres, LengthUnit::Inches].map(|it| (it.name(), it)))?;
    }
    if let Some(unit) = table.get("angle") {
        carrier.angle =
            unit.word(&[AngleUnit::Radians, AngleUnit::Degrees].map(|it| (it.name(), it)))?;
    }
    match carrier.places.get(&MessagePart::Quaternion) {
        Some(place) if carrier.paths.contains_key(&MessagePart::Heading) => {
            Err(TopicMapErrorKind::TwoHeadings.at(place.clone()))
        }
        _ => Ok(carrier),
    }
}

/// A text that is not empty.
fn text<'d>(value: DocumentValue<'d>, expected: &'static str) -> Result<&'d str, DocumentError> {
    match value.text() {
        Ok(text) if !text.is_empty() => Ok(text),
        _ => Err(value.expected(expected)),
    }
}
