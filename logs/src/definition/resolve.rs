//! Resolves the types in the lines of a definition.

use std::collections::{BTreeMap, BTreeSet};

use super::{
    Count, Definition, DefinitionError, DefinitionErrorKind, Dialect, Field, FieldType, MOST_BYTES,
    MOST_DEPTH, MOST_FIELDS, Struct,
    error::quoted,
    least,
    line::{DefinitionLine, line},
    short_name,
};

struct Section<'t> {
    name: String,
    line: usize,
    lines: Vec<(usize, DefinitionLine<'t>)>,
}

const KNOWN: [(&str, &str); 2] = [
    ("builtin_interfaces/Time", "int32 sec\nuint32 nanosec"),
    ("builtin_interfaces/Duration", "int32 sec\nuint32 nanosec"),
];

pub(super) fn resolve(
    dialect: Dialect,
    type_name: &str,
    text: &str,
) -> Result<Definition, DefinitionError> {
    if text.len().saturating_add(type_name.len()) > MOST_BYTES {
        return Err(DefinitionErrorKind::TooLong.at(1));
    }
    let mut sections = sections(dialect, type_name, text)?;
    if dialect == Dialect::Ros2 {
        for (name, text) in KNOWN {
            if !sections.iter().any(|section| section.name == name) {
                let lines = text.lines().filter_map(|text| Some((0, line(dialect, text).ok()?)));
                sections.push(Section { name: name.to_owned(), line: 0, lines: lines.collect() });
            }
        }
    }
    let mut names = BTreeMap::new();
    let mut last_parts: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (index, section) in sections.iter().enumerate() {
        // A type may be defined several times in the same way.
        if names.insert(section.name.as_str(), index).is_none() {
            last_parts.entry(last_part(&section.name)).or_default().push(index);
        }
    }
    let resolver = Resolver { dialect, sections: &sections, names, last_parts };
    // Those that nothing uses stay empty.
    let mut structs: Vec<_> =
        sections.iter().map(|section| Struct::empty(section.name.clone())).collect();
    resolver.add(0, 1, &mut structs, &mut BTreeSet::new())?;
    Ok(Definition { dialect, structs })
}

fn last_part(name: &str) -> &str {
    name.rsplit('/').next().unwrap_or(name)
}

fn sections<'t>(
    dialect: Dialect,
    type_name: &str,
    text: &'t str,
) -> Result<Vec<Section<'t>>, DefinitionError> {
    let first = Section { name: short_name(type_name), line: 1, lines: Vec::new() };
    let mut sections = Vec::new();
    let mut section = first;
    let mut numbered = text.lines().enumerate().map(|(nth, text)| (nth + 1, text));
    while let Some((number, text)) = numbered.next() {
        match line(dialect, text).map_err(|cause| cause.at(number))? {
            DefinitionLine::Empty => {}
            DefinitionLine::Separator => {
                let next = numbered.find(|(_, text)| !text.trim().is_empty());
                let Some((number, text)) = next else { break };
                let name = text.trim().strip_prefix("MSG:").map(|name| short_name(name.trim()));
                let malformed = || DefinitionErrorKind::Malformed(quoted(text.trim())).at(number);
                let name = name.filter(|name| !name.is_empty()).ok_or_else(malformed)?;
                let next = Section { name, line: number, lines: Vec::new() };
                sections.push(std::mem::replace(&mut section, next));
            }
            parsed => section.lines.push((number, parsed)),
        }
    }
    sections.push(section);
    Ok(sections)
}

struct Resolver<'t> {
    dialect: Dialect,
    sections: &'t [Section<'t>],
    names: BTreeMap<&'t str, usize>,
    last_parts: BTreeMap<&'t str, Vec<usize>>,
}

impl Resolver<'_> {
    fn add(
        &self,
        index: usize,
        depth: usize,
        structs: &mut [Struct],
        within: &mut BTreeSet<usize>,
    ) -> Result<(), DefinitionError> {
        let Some(section) = self.sections.get(index) else { return Ok(()) };
        if depth > MOST_DEPTH {
            return Err(DefinitionErrorKind::TooDeep.at(section.line));
        }
        within.insert(index);
        let mut made = Struct { depth: 1, ..Struct::empty(section.name.clone()) };
        let mut names = BTreeSet::new();
        for (number, parsed) in &section.lines {
            let (type_name, count, name) = match *parsed {
                DefinitionLine::Constant { type_name } if self.primitive(type_name).is_none() => {
                    return Err(DefinitionErrorKind::ConstantType(quoted(type_name)).at(*number));
                }
                DefinitionLine::Field { type_name, count, name } => (type_name, count, name),
                _ => continue,
            };
            let kind = self.kind(type_name, &section.name).map_err(|cause| cause.at(*number))?;
            made.width += 1;
            if let FieldType::Struct(part) = kind {
                if within.contains(&part) {
                    return Err(DefinitionErrorKind::PartOfItself(quoted(type_name)).at(*number));
                }
                if structs.get(part).is_some_and(|part| part.depth == 0) {
                    self.add(part, depth + 1, structs, within)?;
                }
                if let Some(part) = structs.get(part) {
                    made.width += part.width;
                    made.depth = made.depth.max(part.depth + 1);
                }
            }
            if made.depth > MOST_DEPTH {
                return Err(DefinitionErrorKind::TooDeep.at(*number));
            }
            if made.width > MOST_FIELDS {
                return Err(DefinitionErrorKind::TooManyFields.at(*number));
            }
            if !names.insert(name) {
                return Err(DefinitionErrorKind::TwoFields(quoted(name)).at(*number));
            }
            let one = least(kind, structs);
            if one == 0 && count != Count::One {
                return Err(DefinitionErrorKind::ListOfNothing(quoted(type_name)).at(*number));
            }
            made.least = made.least.saturating_add(match count {
                Count::One => one,
                Count::Fixed(many) => one.saturating_mul(many as usize),
                Count::Any | Count::AtMost(_) => 4,
            });
            made.fields.push(Field { name: name.to_owned(), kind, count });
        }
        if made.fields.is_empty() && self.dialect == Dialect::Ros2 {
            // As rosidl does, for a struct of C has at least one member.
            let name = "structure_needs_at_least_one_member".to_owned();
            made.fields.push(Field { name, kind: FieldType::Unsigned(1), count: Count::One });
            made.least = 1;
        }
        within.remove(&index);
        if let Some(place) = structs.get_mut(index) {
            *place = made;
        }
        Ok(())
    }

    fn kind(&self, type_name: &str, user: &str) -> Result<FieldType, DefinitionErrorKind> {
        if let Some(kind) = self.primitive(type_name) {
            return Ok(kind);
        }
        let full = match type_name {
            "Header" => "std_msgs/Header".to_owned(),
            "time" => "builtin_interfaces/Time".to_owned(),
            "duration" => "builtin_interfaces/Duration".to_owned(),
            _ if type_name.contains('/') => short_name(type_name),
            _ => match user.rsplit_once('/') {
                Some((package, _)) => format!("{package}/{type_name}"),
                None => type_name.to_owned(),
            },
        };
        if let Some(&index) = self.names.get(full.as_str()) {
            return Ok(FieldType::Struct(index));
        }
        // Some writers leave the package out.
        let alike = self.last_parts.get(type_name).map(Vec::as_slice).unwrap_or_default();
        match alike {
            [index] => Ok(FieldType::Struct(*index)),
            [] => Err(DefinitionErrorKind::UnknownType(quoted(type_name))),
            _ => Err(DefinitionErrorKind::TwoTypes(quoted(type_name))),
        }
    }

    fn primitive(&self, type_name: &str) -> Option<FieldType> {
        Some(match (type_name, self.dialect) {
            ("bool", _) => FieldType::Bool,
            ("int8", _) | ("byte", Dialect::Ros1) => FieldType::Int(1),
            ("int16", _) => FieldType::Int(2),
            ("int32", _) => FieldType::Int(4),
            ("int64", _) => FieldType::Int(8),
            ("uint8" | "char", _) | ("byte", Dialect::Ros2) => FieldType::Unsigned(1),
            ("uint16", _) => FieldType::Unsigned(2),
            ("uint32", _) => FieldType::Unsigned(4),
            ("uint64", _) => FieldType::Unsigned(8),
            ("float32", _) => FieldType::Float(4),
            ("float64", _) => FieldType::Float(8),
            ("string", _) => FieldType::Text,
            ("wstring", Dialect::Ros2) => FieldType::WideText,
            ("time", Dialect::Ros1) => FieldType::Time,
            ("duration", Dialect::Ros1) => FieldType::Duration,
            _ => return None,
        })
    }
}
