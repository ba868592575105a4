//! The values of a document, read as what is expected.

use std::{borrow::Cow, ops::RangeInclusive};

use super::{Content, Document, DocumentError, DocumentErrorKind, Key, Node, TextPosition};

#[derive(Clone, Copy, Debug)]
pub struct DocumentValue<'d> {
    document: &'d Document<'d>,
    pub(super) node: &'d Node<'d>,
}

impl<'d> DocumentValue<'d> {
    pub(super) fn root(document: &'d Document<'d>) -> Self {
        Self { document, node: &document.root }
    }

    pub fn position(self) -> TextPosition {
        self.document.position(self.node, self.node.at)
    }

    pub(super) fn error(self, kind: DocumentErrorKind) -> DocumentError {
        kind.at(self.position())
    }

    pub fn expected(self, expected: impl Into<Cow<'static, str>>) -> DocumentError {
        let found = match &self.node.content {
            Content::Table(_) => "a table",
            Content::List(_) => "a list",
            Content::Text(text) if text.is_empty() => "an empty text",
            Content::Text(_) => "a text",
            Content::Whole(_) => "a whole number",
            Content::Number(_) => "a decimal number",
            Content::Truth(_) => "true or false",
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

    pub fn any_table(self) -> Result<DocumentTable<'d>, DocumentError> {
        match &self.node.content {
            Content::Table(entries) => Ok(DocumentTable { value: self, entries }),
            _ => Err(self.expected("a table")),
        }
    }

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

    pub fn text(self) -> Result<&'d str, DocumentError> {
        match &self.node.content {
            Content::Text(text) => Ok(text),
            _ => Err(self.expected("a text")),
        }
    }

    pub fn word<T: Copy>(self, words: &[(&str, T)]) -> Result<T, DocumentError> {
        let quoted: Vec<_> = words.iter().map(|(word, _)| format!("{word:?}")).collect();
        let expected = Cow::from(quoted.join(" or "));
        let Content::Text(text) = &self.node.content else { return Err(self.expected(expected)) };
        words.iter().find(|(word, _)| word == text).map(|(_, meaning)| *meaning).ok_or_else(|| {
            self.error(DocumentErrorKind::WrongKind { expected, found: "another text" })
        })
    }

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

    pub fn truth(self) -> Result<bool, DocumentError> {
        match self.node.content {
            Content::Truth(truth) => Ok(truth),
            _ => Err(self.expected("true or false")),
        }
    }

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

#[derive(Clone, Copy, Debug)]
pub struct DocumentTable<'d> {
    value: DocumentValue<'d>,
    entries: &'d [(Key<'d>, Node<'d>)],
}

#[derive(Clone, Copy, Debug)]
pub struct DocumentEntry<'d> {
    pub key: &'d str,
    pub value: DocumentValue<'d>,
    at: Option<usize>,
}

impl<'d> DocumentTable<'d> {
    pub fn position(&self) -> TextPosition {
        self.value.position()
    }

    pub fn entries(&self) -> impl Iterator<Item = DocumentEntry<'d>> + use<'d> {
        let document = self.value.document;
        self.entries.iter().map(move |(key, node)| DocumentEntry {
            key: &key.name,
            value: DocumentValue { document, node },
            at: key.at,
        })
    }

    pub fn get(&self, key: &str) -> Option<DocumentValue<'d>> {
        self.entries().find(|entry| entry.key == key).map(|entry| entry.value)
    }

    pub fn need(&self, key: &'static str) -> Result<DocumentValue<'d>, DocumentError> {
        self.get(key).ok_or_else(|| self.value.error(DocumentErrorKind::MissingKey { key }))
    }
}

impl DocumentEntry<'_> {
    pub fn position(&self) -> TextPosition {
        self.value.document.position(self.value.node, self.at)
    }
}
