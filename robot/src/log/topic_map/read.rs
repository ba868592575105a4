//! Reading a mapping file: bytes in, a [`TopicMap`] out, or the one thing that is wrong.

use std::{borrow::Cow, collections::BTreeMap};

use toml::{
    Spanned,
    de::{DeTable, DeValue},
};
use toposlam_model::format::place::Place;

use super::{Angle, Carrier, Cause, Length, Part, Role, TopicMap, TopicMapError};

pub(super) fn read(bytes: &[u8]) -> Result<TopicMap, TopicMapError> {
    let text = std::str::from_utf8(bytes)
        .map_err(|error| Cause::NotText.at(Place::at_byte(bytes, error.valid_up_to())))?;
    let file = File { text };
    let table = DeTable::parse(text).map_err(|error| {
        let at = error.span().map_or(Place::File, |span| file.place(span.start));
        Cause::Syntax(error.message().replace('\n', ", ")).at(at)
    })?;
    let mut carriers = BTreeMap::new();
    for (key, value) in table.get_ref() {
        let role = Role::ALL.into_iter().find(|role| role.name() == key.get_ref().as_ref());
        let known = || Role::ALL.map(Role::name).join(", ");
        let role = role.ok_or_else(|| file.unknown(key, known()))?;
        let DeValue::Table(table) = value.get_ref() else {
            return Err(Cause::WrongKind("a table").at(file.place(value.span().start)));
        };
        carriers.insert(role, file.carrier(role, key.span().start, table)?);
    }
    if carriers.is_empty() {
        return Err(Cause::Empty.in_file());
    }
    Ok(TopicMap { carriers })
}

struct File<'t> {
    text: &'t str,
}

impl File<'_> {
    fn place(&self, byte: usize) -> Place {
        Place::at_byte(self.text.as_bytes(), byte)
    }

    fn unknown(&self, key: &Spanned<Cow<'_, str>>, known: String) -> TopicMapError {
        let name = key.get_ref().chars().take(60).collect();
        Cause::UnknownKey { key: name, known }.at(self.place(key.span().start))
    }

    fn carrier(
        &self,
        role: Role,
        start: usize,
        table: &DeTable<'_>,
    ) -> Result<Carrier, TopicMapError> {
        let mut topic = None;
        let mut carrier = Carrier::usual("");
        let units = [
            ("length", matches!(role, Role::Odometry | Role::Motion)),
            ("angle", matches!(role, Role::Odometry | Role::Motion)),
        ];
        for (key, value) in table {
            let name = key.get_ref().as_ref();
            let place = self.place(value.span().start);
            let wrong = |expected| Cause::WrongKind(expected).at(place.clone());
            let text = value.get_ref().as_str().filter(|text| !text.is_empty());
            let part = role.parts().iter().find(|part| part.name() == name);
            match (name, part) {
                ("topic", _) => {
                    topic = Some(text.ok_or_else(|| wrong("the name of a topic"))?);
                    carrier.place = place;
                }
                (_, Some(part)) => {
                    let path = text.ok_or_else(|| wrong("the path of a field"))?;
                    carrier.paths.insert(*part, path.to_owned());
                    carrier.places.insert(*part, place);
                }
                ("length", None) if units[0].1 => {
                    let found = [Length::Metres, Length::Inches];
                    let found = found.into_iter().find(|unit| text == Some(unit.name()));
                    carrier.length = found.ok_or_else(|| wrong("\"metres\" or \"inches\""))?;
                }
                ("angle", None) if units[1].1 => {
                    let found = [Angle::Radians, Angle::Degrees];
                    let found = found.into_iter().find(|unit| text == Some(unit.name()));
                    carrier.angle = found.ok_or_else(|| wrong("\"radians\" or \"degrees\""))?;
                }
                _ => {
                    let parts = role.parts().iter().map(|part| part.name());
                    let units = units.into_iter().filter(|unit| unit.1).map(|unit| unit.0);
                    let known: Vec<_> = ["topic"].into_iter().chain(parts).chain(units).collect();
                    return Err(self.unknown(key, known.join(", ")));
                }
            }
        }
        let topic = topic.ok_or_else(|| Cause::MissingKey("topic").at(self.place(start)))?;
        topic.clone_into(&mut carrier.topic);
        if let (Some(_), Some(place)) =
            (carrier.paths.get(&Part::Heading), carrier.places.get(&Part::Quaternion))
        {
            return Err(Cause::TwoHeadings.at(place.clone()));
        }
        Ok(carrier)
    }
}
