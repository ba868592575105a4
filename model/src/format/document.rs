//! TOML and JSON documents in which every value has a place.
//!
//! World files, camera calibrations, colour files and topic maps are read through this module. Whatever
//! is wrong with a value, the error names its line, its column and its key.

#![expect(
    clippy::missing_errors_doc,
    reason = "each function returns an error if the value is not of its kind"
)]

mod json;

use std::{borrow::Cow, fmt, ops::RangeInclusive};

use thiserror::Error;
use toml::de::{DeTable, DeValue};

/// A place in a document.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TextPosition {
    /// Line and column, both from 1, the column in characters. `None` for the document as a whole.
    pub line_column: Option<(usize, usize)>,
    /// The path of a key, such as `clockwise.a` or `hallways[0].from`. It may be empty.
    pub key: Box<str>,
}

impl TextPosition {
    /// The place of a byte. A run of bytes that are not UTF-8 counts as one character.
    #[must_use]
    pub fn at_byte(text: &[u8], byte: usize) -> Self {
        let before = String::from_utf8_lossy(&text[..byte.min(text.len())]);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = before.matches('\n').count() + 1;
        let column = before[line_start..].chars().count() + 1;
        Self { line_column: Some((line, column)), key: Box::default() }
    }
}

impl fmt::Display for TextPosition {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((line, column)) = self.line_column {
            write!(formatter, "line {line}, column {column}: ")?;
        }
        if self.key.is_empty() { Ok(()) } else { write!(formatter, "{}: ", self.key) }
    }
}

/// What is wrong with a document, and where.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{position}{kind}")]
pub struct DocumentError {
    /// Where.
    pub position: TextPosition,
    /// What is wrong there.
    #[source]
    pub kind: DocumentErrorKind,
}

/// What can be wrong in any document.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum DocumentErrorKind {
    /// There is nothing but space.
    #[error("the file is empty")]
    Empty,
    /// The bytes are not UTF-8.
    #[error("this is not UTF-8 text")]
    NotText,
    /// The text is neither TOML nor JSON.
    #[error("{0}")]
    Syntax(String),
    /// A key that is not expected here.
    #[error("unknown key; expected one of: {known}")]
    UnknownKey {
        /// The expected keys.
        known: String,
    },
    /// A key is missing.
    #[error("the key `{key}` is missing")]
    MissingKey {
        /// The key.
        key: &'static str,
    },
    /// A value of another kind than the expected one.
    #[error("expected {expected}, found {found}")]
    WrongKind {
        /// What is expected.
        expected: Cow<'static, str>,
        /// What was found.
        found: &'static str,
    },
    /// A number out of its range.
    #[error("{found} is out of range; {what} lies between {low} and {high}")]
    OutOfRange {
        /// The meaning of the number, with its unit.
        what: &'static str,
        /// The number.
        found: f64,
        /// Its least value.
        low: f64,
        /// Its greatest value.
        high: f64,
    },
}

impl DocumentErrorKind {
    fn at(self, position: TextPosition) -> DocumentError {
        DocumentError { position, kind: self }
    }
}

/// A document that was parsed.
#[derive(Debug)]
pub struct Document<'t> {
    text: &'t str,
    root: Node<'t>,
}

/// A value, and the byte at which it begins. A table under a key begins at the key.
#[derive(Debug)]
struct Node<'t> {
    at: Option<usize>,
    content: Content<'t>,
}

#[derive(Debug)]
enum Content<'t> {
    Table(Vec<(Key<'t>, Node<'t>)>),
    List(Vec<Node<'t>>),
    Text(Cow<'t, str>),
    Whole(i64),
    Number(f64),
    Truth,
    Date,
    Null,
}

#[derive(Debug)]
struct Key<'t> {
    at: Option<usize>,
    name: Cow<'t, str>,
}

impl<'t> Document<'t> {
    /// Parses TOML.
    pub fn parse_toml(bytes: &'t [u8]) -> Result<Self, DocumentError> {
        let text = text_of(bytes)?;
        let wrong =
            |at, message| DocumentErrorKind::Syntax(message).at(TextPosition::at_byte(bytes, at));
        let table = DeTable::parse(text).map_err(|error| {
            wrong(error.span().map_or(0, |span| span.start), error.message().replace('\n', ", "))
        })?;
        let content = table_content(table.into_inner())
            .map_err(|(at, message)| wrong(at, message.to_owned()))?;
        Ok(Self { text, root: Node { at: None, content } })
    }

    /// Parses JSON if the first character other than space is a brace, else TOML.
    pub fn parse(bytes: &'t [u8]) -> Result<Self, DocumentError> {
        let text = text_of(bytes)?;
        if !text.trim_start().starts_with('{') {
            return Self::parse_toml(bytes);
        }
        Ok(Self { text, root: json::parse(text)? })
    }

    /// The whole document, which is a table.
    #[must_use]
    pub fn root(&self) -> DocumentValue<'_> {
        DocumentValue { document: self, node: &self.root }
    }

    fn position(&self, node: &Node<'_>, at: Option<usize>) -> TextPosition {
        let mut key = String::new();
        find(&self.root, node, &mut key);
        let position = at.map(|at| TextPosition::at_byte(self.text.as_bytes(), at));
        TextPosition { key: key.into(), ..position.unwrap_or_default() }
    }
}

fn text_of(bytes: &[u8]) -> Result<&str, DocumentError> {
    match std::str::from_utf8(bytes) {
        Ok(text) if text.trim().is_empty() => {
            Err(DocumentErrorKind::Empty.at(TextPosition::default()))
        }
        Ok(text) => Ok(text),
        Err(error) => {
            let position = TextPosition::at_byte(bytes, error.valid_up_to());
            Err(DocumentErrorKind::NotText.at(position))
        }
    }
}

/// The keys of a table in the order of the document.
fn table_content(table: DeTable<'_>) -> Result<Content<'_>, (usize, &'static str)> {
    let mut entries = Vec::with_capacity(table.len());
    for (key, value) in table {
        let at = key.span().start;
        let mut node = node(value)?;
        if matches!(node.content, Content::Table(_)) {
            node.at = Some(at);
        }
        entries.push((Key { at: Some(at), name: key.into_inner() }, node));
    }
    entries.sort_by_key(|(key, _)| key.at);
    Ok(Content::Table(entries))
}

#[expect(clippy::cast_precision_loss, reason = "no key takes a whole number as large")]
fn node(value: toml::Spanned<DeValue<'_>>) -> Result<Node<'_>, (usize, &'static str)> {
    let at = value.span().start;
    let content = match value.into_inner() {
        DeValue::Table(table) => table_content(table)?,
        DeValue::Array(items) => {
            Content::List(items.into_iter().map(node).collect::<Result<_, _>>()?)
        }
        DeValue::String(text) => Content::Text(text),
        DeValue::Integer(digits) => {
            let (text, radix) = (digits.as_str(), digits.radix());
            let whole = i64::from_str_radix(text, radix).map(Content::Whole);
            let large = |_| u64::from_str_radix(text, radix).map(|it| Content::Number(it as f64));
            whole.or_else(large).map_err(|_| (at, "this number is too large"))?
        }
        DeValue::Float(digits) => match digits.as_str().parse::<f64>() {
            Ok(number) if number.is_finite() || digits.as_str().contains(['n', 'f']) => {
                Content::Number(number)
            }
            _ => return Err((at, "this number is too large")),
        },
        DeValue::Boolean(_) => Content::Truth,
        DeValue::Datetime(_) => Content::Date,
    };
    Ok(Node { at: Some(at), content })
}

/// Appends the path from a node to a node in it; whether it is there.
fn find(from: &Node<'_>, target: &Node<'_>, path: &mut String) -> bool {
    if std::ptr::eq(from, target) {
        return true;
    }
    let length = path.len();
    let mut try_child = |step: &dyn fmt::Display, child: &Node<'_>| {
        *path += &step.to_string();
        let found = find(child, target, path);
        if !found {
            path.truncate(length);
        }
        found
    };
    match &from.content {
        Content::Table(entries) => entries.iter().any(|(key, child)| {
            let dot = if length == 0 { "" } else { "." };
            try_child(&format_args!("{dot}{}", key.name.escape_debug()), child)
        }),
        Content::List(items) => items
            .iter()
            .enumerate()
            .any(|(index, child)| try_child(&format_args!("[{index}]"), child)),
        _ => false,
    }
}

/// A value of a document.
#[derive(Clone, Copy, Debug)]
pub struct DocumentValue<'d> {
    document: &'d Document<'d>,
    node: &'d Node<'d>,
}

impl<'d> DocumentValue<'d> {
    /// Where it is.
    #[must_use]
    pub fn position(self) -> TextPosition {
        self.document.position(self.node, self.node.at)
    }

    fn error(self, kind: DocumentErrorKind) -> DocumentError {
        kind.at(self.position())
    }

    /// The error that something else is expected here.
    #[must_use]
    pub fn expected(self, expected: impl Into<Cow<'static, str>>) -> DocumentError {
        let found = match &self.node.content {
            Content::Table(_) => "a table",
            Content::List(_) => "a list",
            Content::Text(text) if text.is_empty() => "an empty text",
            Content::Text(_) => "a text",
            Content::Whole(_) => "a whole number",
            Content::Number(_) => "a decimal number",
            Content::Truth => "true or false",
            Content::Date => "a date",
            Content::Null => "null",
        };
        self.error(DocumentErrorKind::WrongKind { expected: expected.into(), found })
    }

    /// A table with these keys and no others.
    pub fn table(self, known: &[&str]) -> Result<DocumentTable<'d>, DocumentError> {
        let table = self.any_table()?;
        match table.entries().find(|entry| !known.contains(&entry.key)) {
            Some(entry) => {
                let known = known.join(", ");
                Err(DocumentErrorKind::UnknownKey { known }.at(entry.position()))
            }
            None => Ok(table),
        }
    }

    /// A table with any keys.
    pub fn any_table(self) -> Result<DocumentTable<'d>, DocumentError> {
        match &self.node.content {
            Content::Table(entries) => Ok(DocumentTable { value: self, entries }),
            _ => Err(self.expected("a table")),
        }
    }

    /// The items of a list; `expected` describes the list in errors.
    pub fn list(
        self,
        expected: &'static str,
    ) -> Result<impl ExactSizeIterator<Item = Self> + use<'d>, DocumentError> {
        let document = self.document;
        match &self.node.content {
            Content::List(items) => Ok(items.iter().map(move |node| Self { document, node })),
            _ => Err(self.expected(expected)),
        }
    }

    /// The items of a list of a fixed length; `expected` describes the list in errors.
    pub fn array<const LENGTH: usize>(
        self,
        expected: &'static str,
    ) -> Result<[Self; LENGTH], DocumentError> {
        let mut items = self.list(expected)?;
        if items.len() != LENGTH {
            let found = "a list of another length";
            let expected = expected.into();
            return Err(self.error(DocumentErrorKind::WrongKind { expected, found }));
        }
        Ok(std::array::from_fn(|_| items.next().unwrap_or(self)))
    }

    /// A text.
    pub fn text(self) -> Result<&'d str, DocumentError> {
        match &self.node.content {
            Content::Text(text) => Ok(text),
            _ => Err(self.expected("a text")),
        }
    }

    /// What one of several words stands for.
    pub fn word<T: Copy>(self, words: &[(&str, T)]) -> Result<T, DocumentError> {
        let word = match &self.node.content {
            Content::Text(text) => words.iter().find(|(word, _)| word == text),
            _ => None,
        };
        word.map(|(_, meaning)| *meaning).ok_or_else(|| {
            let quoted: Vec<_> = words.iter().map(|(word, _)| format!("{word:?}")).collect();
            let expected = quoted.join(" or ");
            match self.node.content {
                Content::Text(_) => self.error(DocumentErrorKind::WrongKind {
                    expected: expected.into(),
                    found: "another text",
                }),
                _ => self.expected(expected),
            }
        })
    }

    /// A number.
    #[expect(clippy::cast_precision_loss, reason = "what is counted or measured is smaller")]
    pub fn number(self) -> Result<f64, DocumentError> {
        match self.node.content {
            Content::Whole(number) => Ok(number as f64),
            Content::Number(number) => Ok(number),
            _ => Err(self.expected("a number")),
        }
    }

    /// A number in a range; `what` is its meaning, with its unit.
    pub fn number_in(
        self,
        what: &'static str,
        range: RangeInclusive<f64>,
    ) -> Result<f64, DocumentError> {
        let found = self.number()?;
        if range.contains(&found) {
            return Ok(found);
        }
        let (&low, &high) = (range.start(), range.end());
        Err(self.error(DocumentErrorKind::OutOfRange { what, found, low, high }))
    }

    /// A whole number.
    pub fn whole(self) -> Result<i64, DocumentError> {
        match self.node.content {
            Content::Whole(number) => Ok(number),
            _ => Err(self.expected("a whole number")),
        }
    }

    /// A whole number in a range; `what` is its meaning.
    #[expect(clippy::cast_precision_loss, reason = "only for the message")]
    pub fn whole_in(
        self,
        what: &'static str,
        range: RangeInclusive<i64>,
    ) -> Result<i64, DocumentError> {
        let found = self.whole()?;
        if range.contains(&found) {
            return Ok(found);
        }
        let [found, low, high] = [found, *range.start(), *range.end()].map(|number| number as f64);
        Err(self.error(DocumentErrorKind::OutOfRange { what, found, low, high }))
    }
}

/// A table of a document.
#[derive(Clone, Copy, Debug)]
pub struct DocumentTable<'d> {
    value: DocumentValue<'d>,
    entries: &'d [(Key<'d>, Node<'d>)],
}

/// A key of a table, and its value.
#[derive(Clone, Copy, Debug)]
pub struct DocumentEntry<'d> {
    /// The key.
    pub key: &'d str,
    /// Its value.
    pub value: DocumentValue<'d>,
    at: Option<usize>,
}

impl<'d> DocumentTable<'d> {
    /// Where it is.
    #[must_use]
    pub fn position(&self) -> TextPosition {
        self.value.position()
    }

    /// Its entries in the order of the document.
    pub fn entries(&self) -> impl Iterator<Item = DocumentEntry<'d>> + use<'d> {
        let document = self.value.document;
        self.entries.iter().map(move |(key, node)| DocumentEntry {
            key: &key.name,
            value: DocumentValue { document, node },
            at: key.at,
        })
    }

    /// The value of a key, if it has one.
    #[must_use]
    pub fn get(&self, key: &str) -> Option<DocumentValue<'d>> {
        self.entries().find(|entry| entry.key == key).map(|entry| entry.value)
    }

    /// The value of a key.
    pub fn need(&self, key: &'static str) -> Result<DocumentValue<'d>, DocumentError> {
        self.get(key).ok_or_else(|| self.value.error(DocumentErrorKind::MissingKey { key }))
    }
}

impl DocumentEntry<'_> {
    /// Where its key is.
    #[must_use]
    pub fn position(&self) -> TextPosition {
        self.value.document.position(self.value.node, self.at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_columns_count_from_one_in_characters() {
        let at = |byte| TextPosition::at_byte("é = 1\nä = 2\n".as_bytes(), byte).to_string();
        assert_eq!(at(0), "line 1, column 1: ");
        assert_eq!(at(2), "line 1, column 2: ");
        assert_eq!(at(7), "line 2, column 1: ");
        assert_eq!(at(9), "line 2, column 2: ");
        assert_eq!(at(99), "line 3, column 1: ");
    }

    #[test]
    fn values_and_keys_have_line_column_and_path() {
        let text = "a = 1\n[b.'c d']\ne = [1, {f = true}]\n[[g]]\n[[g]]\nh = 2";
        let document = Document::parse_toml(text.as_bytes()).unwrap();
        let root = document.root().any_table().unwrap();
        let at = |value: DocumentValue<'_>| value.position().to_string();
        assert_eq!(at(root.need("a").unwrap()), "line 1, column 5: a: ");
        let inner = root.need("b").unwrap().any_table().unwrap().need("c d").unwrap();
        assert_eq!(at(inner), "line 2, column 4: b.c d: ");
        let [_, table] = inner.any_table().unwrap().need("e").unwrap().array("").unwrap();
        assert_eq!(at(table), "line 3, column 9: b.c d.e[1]: ");
        let entry = table.any_table().unwrap().entries().next().unwrap();
        assert_eq!(entry.position().to_string(), "line 3, column 10: b.c d.e[1].f: ");
        let [_, second] = root.need("g").unwrap().array("").unwrap();
        assert_eq!(second.position().to_string(), "line 5, column 1: g[1]: ");
    }

    #[test]
    fn values_and_keys_of_json_have_line_column_and_path() {
        let text = r#" {"\"\\": [], "n": {},
            "é": [ -1e3 ,true,null,[1,2], "x\"]", {"b" : {"c": 1 }}],
            "z":"é"}"#;
        let document = Document::parse(text.as_bytes()).unwrap();
        let root = document.root().any_table().unwrap();
        assert_eq!(root.position().to_string(), "");
        let at = |value: DocumentValue<'_>| value.position().to_string();
        let keys: Vec<_> = root.entries().map(|entry| entry.position().to_string()).collect();
        let expected = [
            "line 1, column 3: \\\"\\\\: ",
            "line 1, column 15: n: ",
            "line 2, column 13: é: ",
            "line 3, column 13: z: ",
        ];
        assert_eq!(keys, expected);
        let items: [_; 6] = root.need("é").unwrap().array("").unwrap();
        let places = items.map(at);
        let expected = [
            "line 2, column 20: é[0]: ",
            "line 2, column 26: é[1]: ",
            "line 2, column 31: é[2]: ",
            "line 2, column 36: é[3]: ",
            "line 2, column 43: é[4]: ",
            "line 2, column 51: é[5]: ",
        ];
        assert_eq!(places, expected);
        let inner = items[5].any_table().unwrap().need("b").unwrap();
        assert_eq!(at(inner), "line 2, column 52: é[5].b: ");
        assert_eq!(
            at(inner.any_table().unwrap().need("c").unwrap()),
            "line 2, column 64: é[5].b.c: "
        );
        assert_eq!(at(root.need("z").unwrap()), "line 3, column 17: z: ");
        let broken = Document::parse("{\"é\": 1,\n\"ü\": x}".as_bytes()).unwrap_err();
        assert_eq!(broken.to_string(), "line 2, column 6: expected value");
    }

    #[test]
    fn numbers_that_do_not_fit_are_errors() {
        let message = |text: &str| Document::parse_toml(text.as_bytes()).unwrap_err().to_string();
        assert_eq!(message("a = 1e999"), "line 1, column 5: this number is too large");
        assert_eq!(
            message("a = 99999999999999999999"),
            "line 1, column 5: this number is too large"
        );
        assert!(Document::parse_toml(b"a = [inf, -inf, nan, 0x7f, 1_000]").is_ok());
    }
}
