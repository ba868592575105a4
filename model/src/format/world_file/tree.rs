//! The common shape of TOML and JSON: keys in the order of the file, each once.

use std::{collections::HashSet, fmt};

use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};

use super::error::{Cause, WorldFileError};
use crate::format::place::Place;

/// A value of a world file.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Tree {
    Table(Vec<(String, Tree)>),
    List(Vec<Tree>),
    Text(String),
    Number(f64),
    Truth,
    Date,
    Null,
}

impl Tree {
    /// Reads TOML, or JSON where the first character that is no space is a brace.
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, WorldFileError> {
        let text = std::str::from_utf8(bytes).map_err(|error| {
            let valid = &bytes[..error.valid_up_to()];
            Cause::NotText.at_byte(&String::from_utf8_lossy(valid), valid.len())
        })?;
        let trimmed = text.trim_start();
        if trimmed.is_empty() {
            Err(Cause::Empty.in_file())
        } else if trimmed.starts_with('{') {
            Self::parse_json(text)
        } else {
            Self::parse_toml(text)
        }
    }

    fn parse_json(text: &str) -> Result<Self, WorldFileError> {
        serde_json::from_str(text).map_err(|error| {
            let (line, column) = (error.line(), error.column());
            // serde_json writes its own place behind the message; ours stands before it.
            let whole = error.to_string();
            let own_place = format!(" at line {line} column {column}");
            let message = whole.strip_suffix(&own_place).unwrap_or(&whole);
            WorldFileError {
                place: Place::Text { line, column },
                cause: Cause::Syntax(message.to_owned()),
            }
        })
    }

    fn parse_toml(text: &str) -> Result<Self, WorldFileError> {
        toml::from_str(text).map_err(|error| {
            let message = error.message().replace('\n', ", ");
            let byte = error.span().map_or(0, |span| span.start);
            Cause::Syntax(message).at_byte(text, byte)
        })
    }

    /// What it is, for a message.
    pub(super) fn kind(&self) -> &'static str {
        match self {
            Self::Table(_) => "a table",
            Self::List(_) => "a list",
            Self::Text(_) => "a text",
            Self::Number(_) => "a number",
            Self::Truth => "true or false",
            Self::Date => "a date",
            Self::Null => "null",
        }
    }
}

impl<'de> Deserialize<'de> for Tree {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(TreeVisitor)
    }
}

/// The key under which toml hands over a date.
const DATE: &str = "$__toml_private_datetime";

struct TreeVisitor;

impl<'de> Visitor<'de> for TreeVisitor {
    type Value = Tree;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a table, a list, a text or a number")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Tree, A::Error> {
        let mut entries = Vec::new();
        let mut seen = HashSet::new();
        while let Some(key) = map.next_key::<String>()? {
            if !seen.insert(key.clone()) {
                let key = key.escape_debug();
                return Err(A::Error::custom(format!("duplicate key `{key}`")));
            }
            entries.push((key, map.next_value()?));
        }
        if seen.contains(DATE) {
            return Ok(Tree::Date);
        }
        Ok(Tree::Table(entries))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Tree, A::Error> {
        let mut items = Vec::new();
        while let Some(item) = seq.next_element()? {
            items.push(item);
        }
        Ok(Tree::List(items))
    }

    fn visit_str<E>(self, text: &str) -> Result<Tree, E> {
        Ok(Tree::Text(text.to_owned()))
    }

    #[expect(clippy::cast_precision_loss, reason = "a coordinate in metres")]
    fn visit_i64<E>(self, number: i64) -> Result<Tree, E> {
        Ok(Tree::Number(number as f64))
    }

    #[expect(clippy::cast_precision_loss, reason = "a coordinate in metres")]
    fn visit_u64<E>(self, number: u64) -> Result<Tree, E> {
        Ok(Tree::Number(number as f64))
    }

    fn visit_f64<E>(self, number: f64) -> Result<Tree, E> {
        Ok(Tree::Number(number))
    }

    fn visit_bool<E>(self, _: bool) -> Result<Tree, E> {
        Ok(Tree::Truth)
    }

    fn visit_unit<E>(self) -> Result<Tree, E> {
        Ok(Tree::Null)
    }
}
