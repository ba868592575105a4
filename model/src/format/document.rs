//! TOML and JSON documents in which every value has a place.
//!
//! World files, camera calibrations, colour files, topic maps, quirks and parameters are read through this
//! module. Whatever is wrong with a value, the error names its line, its column and its key.

#![expect(
    clippy::missing_errors_doc,
    reason = "each function returns an error if the value is not of its kind"
)]

mod json;
mod toml_text;
mod typed;
mod value;

use std::{borrow::Cow, fmt};

use thiserror::Error;

pub use value::{DocumentEntry, DocumentTable, DocumentValue};

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TextPosition {
    /// Line and column, both from 1, the column in characters. `None` for the document as a whole.
    pub line_column: Option<(usize, usize)>,
    /// The path of a key, such as `clockwise.a` or `hallways[0].from`. It may be empty.
    pub key: Box<str>,
}

impl TextPosition {
    /// The place of a byte. A run of bytes that are not UTF-8 counts as one character.
    pub fn at_byte(text: &[u8], byte: usize) -> Self {
        let before = String::from_utf8_lossy(&text[..byte.min(text.len())]);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = before.matches('\n').count() + 1;
        let column = before[line_start..].chars().count() + 1;
        Self { line_column: Some((line, column)), key: Box::default() }
    }

    /// The error of this kind here.
    pub fn error<K>(self, kind: K) -> FileError<K> {
        FileError { position: self, kind }
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

/// What is wrong with a file of a kind, and where.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{position}{kind}")]
pub struct FileError<K> {
    pub position: TextPosition,
    #[source]
    pub kind: K,
}

impl<K: From<DocumentErrorKind>> From<DocumentError> for FileError<K> {
    fn from(DocumentError { position, kind }: DocumentError) -> Self {
        position.error(kind.into())
    }
}

#[derive(Clone, Debug, PartialEq, Error)]
#[error("{position}{kind}")]
pub struct DocumentError {
    pub position: TextPosition,
    #[source]
    pub kind: DocumentErrorKind,
}

#[derive(Clone, Debug, PartialEq, Error)]
pub enum DocumentErrorKind {
    #[error("the file is empty")]
    Empty,
    #[error("this is not UTF-8 text")]
    NotText,
    #[error("{0}")]
    Syntax(String),
    #[error("{0}")]
    Invalid(String),
    #[error("unknown key; expected one of: {known}")]
    UnknownKey { known: String },
    #[error("the key `{key}` is missing")]
    MissingKey { key: &'static str },
    #[error("expected {expected}, found {found}")]
    WrongKind { expected: Cow<'static, str>, found: &'static str },
    #[error("{found} is out of range; {what} lies between {low} and {high}")]
    OutOfRange { what: &'static str, found: f64, low: f64, high: f64 },
}

impl DocumentErrorKind {
    fn at(self, position: TextPosition) -> DocumentError {
        DocumentError { position, kind: self }
    }
}

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
    Truth(bool),
    Date,
    Null,
}

#[derive(Debug)]
struct Key<'t> {
    at: Option<usize>,
    name: Cow<'t, str>,
}

impl<'t> Document<'t> {
    pub fn parse_toml(bytes: &'t [u8]) -> Result<Self, DocumentError> {
        let text = text_of(bytes)?;
        Ok(Self { text, root: toml_text::parse(text)? })
    }

    /// Parses TOML that may be empty, because every key may be missing.
    pub fn parse_settings(bytes: &'t [u8]) -> Result<Self, DocumentError> {
        let text = utf8(bytes)?;
        Ok(Self { text, root: toml_text::parse(text)? })
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
    pub fn root(&self) -> DocumentValue<'_> {
        DocumentValue::root(self)
    }

    fn position(&self, node: &Node<'_>, at: Option<usize>) -> TextPosition {
        let mut key = String::new();
        find(&self.root, node, &mut key);
        let position = at.map(|at| TextPosition::at_byte(self.text.as_bytes(), at));
        TextPosition { key: key.into(), ..position.unwrap_or_default() }
    }
}

fn text_of(bytes: &[u8]) -> Result<&str, DocumentError> {
    let text = utf8(bytes)?;
    if text.trim().is_empty() {
        return Err(DocumentErrorKind::Empty.at(TextPosition::default()));
    }
    Ok(text)
}

fn utf8(bytes: &[u8]) -> Result<&str, DocumentError> {
    std::str::from_utf8(bytes).map_err(|error| {
        DocumentErrorKind::NotText.at(TextPosition::at_byte(bytes, error.valid_up_to()))
    })
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
