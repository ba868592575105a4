//! JSON as a document: its values, with the place of each.

use std::{collections::HashSet, fmt};

use serde::de::{Deserialize, Deserializer, Error as _, MapAccess, SeqAccess, Visitor};

use super::{Content, DocumentError, DocumentErrorKind, Key, Node, TextPosition};

pub(super) fn parse(text: &str) -> Result<Node<'_>, DocumentError> {
    let bytes = text.as_bytes();
    let mut root: Node = serde_json::from_str(text).map_err(|error| {
        let (line, column) = (error.line(), error.column());
        // serde_json appends the place to its message; here it comes first.
        let whole = error.to_string();
        let message = whole.strip_suffix(&format!(" at line {line} column {column}"));
        let message = message.unwrap_or(&whole).to_owned();
        // Its columns count bytes, from 1.
        let before: usize =
            text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum();
        let byte = before + column.saturating_sub(1);
        DocumentErrorKind::Syntax(message).at(TextPosition::at_byte(bytes, byte))
    })?;
    JsonPlaces { text: bytes, at: 0 }.place(&mut root);
    root.at = None;
    Ok(root)
}

/// Finds where the values of a JSON text begin. The text was parsed, so it is well-formed.
struct JsonPlaces<'t> {
    text: &'t [u8],
    at: usize,
}

impl JsonPlaces<'_> {
    /// Sets the places of a value and of what is in it, and goes to its end.
    fn place(&mut self, node: &mut Node<'_>) {
        node.at = Some(self.skip_separators());
        match &mut node.content {
            Content::Table(entries) => {
                self.at += 1;
                for (key, child) in entries.iter_mut() {
                    key.at = Some(self.skip_separators());
                    self.skip_text();
                    self.place(child);
                    if matches!(child.content, Content::Table(_)) {
                        child.at = key.at;
                    }
                }
                self.skip_separators();
                self.at += 1;
            }
            Content::List(items) => {
                self.at += 1;
                for item in items.iter_mut() {
                    self.place(item);
                }
                self.skip_separators();
                self.at += 1;
            }
            Content::Text(_) => self.skip_text(),
            _ => {
                self.skip_while(|byte| !b",]}".contains(&byte) && !byte.is_ascii_whitespace());
            }
        }
    }

    /// Goes to the next byte that is neither space nor a comma or a colon, and returns its place.
    fn skip_separators(&mut self) -> usize {
        self.skip_while(|byte| byte.is_ascii_whitespace() || b",:".contains(&byte));
        self.at
    }

    fn skip_text(&mut self) {
        self.at += 1;
        loop {
            self.skip_while(|byte| byte != b'"' && byte != b'\\');
            if self.text.get(self.at) != Some(&b'\\') {
                break;
            }
            // The escaped character may be a quote.
            self.at += 2;
        }
        self.at += 1;
    }

    fn skip_while(&mut self, skipped: impl Fn(u8) -> bool) {
        while self.text.get(self.at).is_some_and(|&byte| skipped(byte)) {
            self.at += 1;
        }
    }
}

impl<'de> Deserialize<'de> for Node<'static> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let content = deserializer.deserialize_any(JsonVisitor)?;
        Ok(Self { at: None, content })
    }
}

struct JsonVisitor;

impl<'de> Visitor<'de> for JsonVisitor {
    type Value = Content<'static>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a table, a list, a text or a number")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut entries = Vec::new();
        let mut seen = HashSet::new();
        while let Some(name) = map.next_key::<String>()? {
            if !seen.insert(name.clone()) {
                let name = name.escape_debug();
                return Err(A::Error::custom(format!("duplicate key `{name}`")));
            }
            entries.push((Key { at: None, name: name.into() }, map.next_value()?));
        }
        Ok(Content::Table(entries))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Self::Value, A::Error> {
        let mut items = Vec::new();
        while let Some(item) = seq.next_element()? {
            items.push(item);
        }
        Ok(Content::List(items))
    }

    fn visit_str<E>(self, text: &str) -> Result<Self::Value, E> {
        Ok(Content::Text(text.to_owned().into()))
    }

    fn visit_i64<E>(self, number: i64) -> Result<Self::Value, E> {
        Ok(Content::Whole(number))
    }

    #[expect(clippy::cast_precision_loss, reason = "no key takes a whole number as large")]
    fn visit_u64<E>(self, number: u64) -> Result<Self::Value, E> {
        Ok(i64::try_from(number).map_or(Content::Number(number as f64), Content::Whole))
    }

    fn visit_f64<E>(self, number: f64) -> Result<Self::Value, E> {
        Ok(Content::Number(number))
    }

    fn visit_bool<E>(self, truth: bool) -> Result<Self::Value, E> {
        Ok(Content::Truth(truth))
    }

    fn visit_unit<E>(self) -> Result<Self::Value, E> {
        Ok(Content::Null)
    }
}
