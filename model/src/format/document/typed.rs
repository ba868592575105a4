//! Documents read as types that implement `Deserialize`. The errors name the place, as all errors of documents do.

use std::fmt;

use serde::{
    Deserialize,
    de::{
        DeserializeSeed, Deserializer, Error as _, IntoDeserializer, MapAccess, Visitor,
        value::{SeqDeserializer, StrDeserializer},
    },
    forward_to_deserialize_any,
};

use super::{
    Content, DocumentEntry, DocumentError, DocumentErrorKind, DocumentValue, TextPosition,
};

impl<'d> DocumentValue<'d> {
    pub fn read<T: Deserialize<'d>>(self) -> Result<T, DocumentError> {
        T::deserialize(self)
    }

    /// The result with this place, if it is an error without one.
    fn located<T>(self, result: Result<T, DocumentError>) -> Result<T, DocumentError> {
        result.map_err(|error| error.located(|| self.position()))
    }

    fn count(self) -> Result<u64, DocumentError> {
        let whole = self.whole()?;
        u64::try_from(whole).map_err(|_| {
            let (expected, found) = ("a whole number from 0".into(), "a negative number");
            self.error(DocumentErrorKind::WrongKind { expected, found })
        })
    }
}

impl DocumentError {
    fn located(self, position: impl FnOnce() -> TextPosition) -> Self {
        if self.position == TextPosition::default() { self.kind.at(position()) } else { self }
    }
}

impl serde::de::Error for DocumentError {
    fn custom<T: fmt::Display>(message: T) -> Self {
        DocumentErrorKind::Invalid(message.to_string()).at(TextPosition::default())
    }

    fn unknown_field(_: &str, expected: &'static [&'static str]) -> Self {
        let known = expected.join(", ");
        DocumentErrorKind::UnknownKey { known }.at(TextPosition::default())
    }

    fn unknown_variant(_: &str, expected: &'static [&'static str]) -> Self {
        let words: Vec<_> = expected.iter().map(|word| format!("{word:?}")).collect();
        let (expected, found) = (words.join(" or ").into(), "another text");
        DocumentErrorKind::WrongKind { expected, found }.at(TextPosition::default())
    }

    fn missing_field(key: &'static str) -> Self {
        DocumentErrorKind::MissingKey { key }.at(TextPosition::default())
    }
}

/// Methods that read a value as a number, a text, or true or false, and visit it.
macro_rules! deserialize_scalars {
    ($($method:ident: $visit:ident($read:ident),)*) => {$(
        fn $method<V: Visitor<'d>>(self, visitor: V) -> Result<V::Value, DocumentError> {
            self.located(visitor.$visit(self.$read()?))
        }
    )*};
}

impl<'d> Deserializer<'d> for DocumentValue<'d> {
    type Error = DocumentError;

    fn deserialize_any<V: Visitor<'d>>(self, visitor: V) -> Result<V::Value, DocumentError> {
        self.located(match &self.node.content {
            Content::Table(_) => self.deserialize_map(visitor),
            Content::List(_) => self.deserialize_seq(visitor),
            Content::Text(text) => visitor.visit_borrowed_str(text),
            Content::Whole(number) => visitor.visit_i64(*number),
            Content::Number(number) => visitor.visit_f64(*number),
            Content::Truth(truth) => visitor.visit_bool(*truth),
            Content::Date => Err(DocumentError::custom("a date is not expected here")),
            Content::Null => visitor.visit_unit(),
        })
    }

    deserialize_scalars! {
        deserialize_bool: visit_bool(truth),
        deserialize_f32: visit_f64(number),
        deserialize_f64: visit_f64(number),
        deserialize_i64: visit_i64(whole),
        deserialize_u32: visit_u64(count),
        deserialize_u64: visit_u64(count),
        deserialize_str: visit_borrowed_str(text),
        deserialize_string: visit_borrowed_str(text),
    }

    fn deserialize_option<V: Visitor<'d>>(self, visitor: V) -> Result<V::Value, DocumentError> {
        match self.node.content {
            Content::Null => self.located(visitor.visit_none()),
            _ => visitor.visit_some(self),
        }
    }

    fn deserialize_seq<V: Visitor<'d>>(self, visitor: V) -> Result<V::Value, DocumentError> {
        self.located(visitor.visit_seq(SeqDeserializer::new(self.list("a list")?)))
    }

    fn deserialize_map<V: Visitor<'d>>(self, visitor: V) -> Result<V::Value, DocumentError> {
        let left = self.any_table()?.entries();
        self.located(visitor.visit_map(Entries { left, read: None }))
    }

    fn deserialize_struct<V: Visitor<'d>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, DocumentError> {
        self.deserialize_map(visitor)
    }

    fn deserialize_enum<V: Visitor<'d>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, DocumentError> {
        self.located(visitor.visit_enum(StrDeserializer::new(self.text()?)))
    }

    forward_to_deserialize_any! {
        <V: Visitor<'d>>
        i8 i16 i32 i128 u8 u16 u128 char bytes byte_buf unit unit_struct newtype_struct tuple tuple_struct
        identifier ignored_any
    }
}

/// The entries of a table that have not been read, and the one whose key was read last.
struct Entries<'d, I> {
    left: I,
    read: Option<DocumentEntry<'d>>,
}

impl<'d, I: Iterator<Item = DocumentEntry<'d>>> MapAccess<'d> for Entries<'d, I> {
    type Error = DocumentError;

    fn next_key_seed<K: DeserializeSeed<'d>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, DocumentError> {
        self.read = self.left.next();
        let Some(entry) = self.read else { return Ok(None) };
        let key = seed.deserialize(StrDeserializer::<DocumentError>::new(entry.key));
        key.map(Some).map_err(|error| error.located(|| entry.position()))
    }

    fn next_value_seed<V: DeserializeSeed<'d>>(
        &mut self,
        seed: V,
    ) -> Result<V::Value, DocumentError> {
        let Some(entry) = self.read else {
            return Err(DocumentError::custom("a value is read before its key"));
        };
        seed.deserialize(entry.value)
    }
}

impl<'d> IntoDeserializer<'d, DocumentError> for DocumentValue<'d> {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::document::Document;

    #[derive(Debug, PartialEq, Deserialize)]
    #[serde(rename_all = "lowercase")]
    enum Size {
        Small,
        Large,
    }

    #[derive(Debug, Default, PartialEq, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    struct Settings {
        speed: f64,
        views: Option<usize>,
        corners: bool,
        size: Option<Size>,
        quirk: Vec<Named>,
    }

    #[derive(Debug, PartialEq, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Named {
        name: String,
    }

    fn settings(text: &str) -> Result<Settings, DocumentError> {
        Document::parse_settings(text.as_bytes())?.root().read()
    }

    #[test]
    fn a_document_is_read_as_a_type() {
        let text =
            "speed = 2\nviews = 3\ncorners = true\nsize = \"large\"\n[[quirk]]\nname = \"a\"";
        let expected = Settings {
            speed: 2.0,
            views: Some(3),
            corners: true,
            size: Some(Size::Large),
            quirk: vec![Named { name: "a".to_owned() }],
        };
        assert_eq!(settings(text), Ok(expected));
        assert_eq!(settings(""), Ok(Settings::default()));
        let json = Document::parse(br#"{"corners": true, "views": null}"#).unwrap();
        let expected = Settings { corners: true, ..Settings::default() };
        assert_eq!(json.root().read(), Ok(expected));
    }

    #[test]
    fn what_does_not_fit_a_type_has_line_column_and_key() {
        let message = |text| settings(text).unwrap_err().to_string();
        for (text, expected) in [
            (
                "speed = 2\nspede = 3",
                "line 2, column 1: spede: unknown key; expected one of: speed, views, corners, size, quirk",
            ),
            ("\n speed = \"much\"", "line 2, column 10: speed: expected a number, found a text"),
            (
                "views = 0.5",
                "line 1, column 9: views: expected a whole number, found a decimal number",
            ),
            (
                "views = -1",
                "line 1, column 9: views: expected a whole number from 0, found a negative number",
            ),
            (
                "corners = 1",
                "line 1, column 11: corners: expected true or false, found a whole number",
            ),
            (
                "size = \"medium\"",
                "line 1, column 8: size: expected \"small\" or \"large\", found another text",
            ),
            ("quirk = 1", "line 1, column 9: quirk: expected a list, found a whole number"),
            (
                "[[quirk]]\nname = \"a\"\n[[quirk]]",
                "line 3, column 1: quirk[1]: the key `name` is missing",
            ),
            (
                "quirk = [{name = [1]}]",
                "line 1, column 18: quirk[0].name: expected a text, found a list",
            ),
        ] {
            assert_eq!(message(text), expected);
        }
        let syntax = message("speed = ");
        assert!(syntax.starts_with("line 1, column 9: "), "{syntax}");
        assert!(!syntax.contains('\n'), "{syntax}");
    }
}
