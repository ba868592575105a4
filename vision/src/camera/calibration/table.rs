//! The keys of a table, each with its kind and its range.

use toml::Value;

use super::error::{CalibrationError, Cause};

/// A table of which only known keys are taken.
pub(super) struct Table<'a> {
    name: &'static str,
    values: &'a toml::Table,
}

/// What a number says, and between which numbers it lies.
#[derive(Clone, Copy)]
pub(super) struct Range {
    pub(super) what: &'static str,
    pub(super) low: f64,
    pub(super) high: f64,
}

impl<'a> Table<'a> {
    pub(super) fn new(
        name: &'static str,
        values: &'a toml::Table,
        known: &[&str],
    ) -> Result<Self, CalibrationError> {
        let table = Self::unchecked(name, values);
        match values.keys().find(|key| !known.contains(&key.as_str())) {
            Some(key) => {
                let key = key.escape_debug().to_string();
                Err(Cause::UnknownKey { known: known.join(", ") }.at(table.path(&key)))
            }
            None => Ok(table),
        }
    }

    /// A table of which it is not yet known which keys can stand in it.
    pub(super) fn unchecked(name: &'static str, values: &'a toml::Table) -> Self {
        Self { name, values }
    }

    fn path(&self, key: &str) -> String {
        if self.name.is_empty() { key.to_owned() } else { format!("{}.{key}", self.name) }
    }

    fn need(&self, key: &'static str) -> Result<&'a Value, CalibrationError> {
        self.values.get(key).ok_or_else(|| {
            let cause = Cause::MissingKey { key };
            if self.name.is_empty() { cause.in_file() } else { cause.at(self.name) }
        })
    }

    pub(super) fn has(&self, key: &str) -> bool {
        self.values.contains_key(key)
    }

    fn wrong_kind(&self, key: &str, expected: &str, value: &Value) -> CalibrationError {
        let found = match value {
            Value::String(_) => "a text",
            Value::Integer(_) | Value::Float(_) => "a number",
            Value::Boolean(_) => "true or false",
            Value::Datetime(_) => "a date",
            Value::Array(_) => "a list",
            Value::Table(_) => "a table",
        };
        Cause::WrongKind { expected: expected.to_owned(), found }.at(self.path(key))
    }

    pub(super) fn table(&self, key: &'static str) -> Result<&'a toml::Table, CalibrationError> {
        let value = self.need(key)?;
        value.as_table().ok_or_else(|| self.wrong_kind(key, "a table", value))
    }

    pub(super) fn text(&self, key: &'static str) -> Result<&'a str, CalibrationError> {
        let value = self.need(key)?;
        value.as_str().ok_or_else(|| self.wrong_kind(key, "a text", value))
    }

    /// One of several words.
    pub(super) fn word(
        &self,
        key: &'static str,
        words: &[&'static str],
    ) -> Result<&'static str, CalibrationError> {
        let value = self.need(key)?;
        let found = value.as_str();
        words.iter().find(|&&word| found == Some(word)).copied().ok_or_else(|| {
            let quoted: Vec<_> = words.iter().map(|word| format!("{word:?}")).collect();
            let expected = quoted.join(" or ");
            match value {
                Value::String(_) => {
                    Cause::WrongKind { expected, found: "another text" }.at(self.path(key))
                }
                _ => self.wrong_kind(key, &expected, value),
            }
        })
    }

    pub(super) fn number(&self, key: &'static str, range: Range) -> Result<f64, CalibrationError> {
        let value = self.need(key)?;
        self.in_range(key, "a number", value, range)
    }

    /// Two numbers.
    pub(super) fn pair(
        &self,
        key: &'static str,
        ranges: [Range; 2],
    ) -> Result<[f64; 2], CalibrationError> {
        let value = self.need(key)?;
        let Some([one, other]) = value.as_array().map(Vec::as_slice) else {
            return Err(self.wrong_kind(key, "a list of two numbers", value));
        };
        let number = |value, range| self.in_range(key, "a list of two numbers", value, range);
        Ok([number(one, ranges[0])?, number(other, ranges[1])?])
    }

    /// Two whole numbers.
    pub(super) fn whole_pair(
        &self,
        key: &'static str,
        range: Range,
    ) -> Result<[u32; 2], CalibrationError> {
        let pair = self.pair(key, [range; 2])?;
        let whole = self
            .need(key)?
            .as_array()
            .is_some_and(|list| list.iter().all(|value| matches!(value, Value::Integer(_))));
        if !whole {
            let expected = "a list of two whole numbers".to_owned();
            return Err(Cause::WrongKind { expected, found: "fractions" }.at(self.path(key)));
        }
        #[expect(clippy::cast_sign_loss, reason = "the range is that of u32 at most")]
        Ok(pair.map(|number| number as u32))
    }

    fn in_range(
        &self,
        key: &str,
        expected: &str,
        value: &Value,
        Range { what, low, high }: Range,
    ) -> Result<f64, CalibrationError> {
        let number = match *value {
            Value::Integer(whole) => whole as f64,
            Value::Float(number) => number,
            _ => return Err(self.wrong_kind(key, expected, value)),
        };
        if number >= low && number <= high {
            Ok(number)
        } else {
            Err(Cause::OutOfRange { value: number, what, low, high }.at(self.path(key)))
        }
    }

    /// The error that something is wrong at a key.
    pub(super) fn error(&self, key: &str, cause: Cause) -> CalibrationError {
        cause.at(self.path(key))
    }
}
