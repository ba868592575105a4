//! The fields of a line, by the definition of its message.

use crate::{
    decode::{DecodeError, DecodeErrorKind, DecodeFailure, in_field},
    definition::{Count, Definition, Field, FieldType},
    value::Value,
};

/// The value of a line, which begins with its keyword; an error if the line does not have the fields of the
/// definition, and no others. No bytes make it panic.
///
/// Takes at most 256 bytes of memory for each byte of the line and for each field of the definition.
pub(crate) fn decode<'a>(
    definition: &'a Definition,
    line: &'a [u8],
) -> Result<Value<'a>, DecodeError> {
    let mut words = Words { line, next: 0 };
    words.next();
    let root = definition.root();
    let mut values = Vec::with_capacity(root.fields.len());
    for (index, field) in root.fields.iter().enumerate() {
        let is_last = index + 1 == root.fields.len();
        let value = match (field.kind, field.count) {
            (FieldType::Text, _) if is_last => Ok(Value::Text(words.rest())),
            (_, Count::One) => words.value(field),
            _ => words.list(field),
        };
        values.push(value.map_err(in_field(&field.name))?);
    }
    let offset = words.next;
    let left = std::iter::from_fn(|| words.next()).count();
    if left > 0 {
        return Err(in_field("")((offset, DecodeErrorKind::WordsLeft(left))));
    }
    Ok(Value::Struct(root, values))
}

struct Words<'a> {
    line: &'a [u8],
    next: usize,
}

impl<'a> Words<'a> {
    fn next(&mut self) -> Option<(usize, &'a [u8])> {
        let rest = self.line.get(self.next..)?;
        let start = self.next + rest.iter().position(|byte| !byte.is_ascii_whitespace())?;
        let rest = self.line.get(start..)?;
        let length = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        self.next = start + length;
        Some((start, rest.get(..length)?))
    }

    /// What is left, without the spaces around it.
    fn rest(&mut self) -> &'a [u8] {
        let rest = self.line.get(self.next..).unwrap_or_default().trim_ascii();
        self.next = self.line.len();
        rest
    }

    fn value(&mut self, field: &Field) -> Result<Value<'a>, DecodeFailure> {
        let (start, word) = self.next().ok_or((self.line.len(), DecodeErrorKind::NoWord))?;
        if field.kind == FieldType::Text {
            return Ok(Value::Text(word));
        }
        let text = std::str::from_utf8(word).ok();
        let number = text.and_then(|text| match field.kind {
            FieldType::Int(_) => text.parse().ok().map(Value::Int),
            FieldType::Unsigned(_) => text.parse().ok().map(Value::Unsigned),
            _ => text.parse().ok().map(Value::Float),
        });
        number.ok_or_else(|| {
            let beginning = word.get(..word.len().min(20)).unwrap_or_default();
            let shown = String::from_utf8_lossy(beginning).escape_debug().to_string();
            (start, DecodeErrorKind::NotANumber(shown))
        })
    }

    fn list(&mut self, field: &Field) -> Result<Value<'a>, DecodeFailure> {
        let count = Field { name: String::new(), kind: FieldType::Unsigned(4), count: Count::One };
        let many = self.value(&count)?;
        let mut values = Vec::new();
        for _ in 0..many.u64().unwrap_or_default() {
            values.push(self.value(field)?);
        }
        Ok(Value::List(values))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::definition::Dialect;

    fn decoded(line: &str) -> Result<String, String> {
        let text = "string name\nfloat32[] ranges\nint32 more\nstring rest\n";
        let definition = Definition::read(Dialect::Ros1, "a/A", text).unwrap();
        let value = decode(&definition, line.as_bytes()).map_err(|error| error.to_string())?;
        Ok(["name", "ranges", "more", "rest"]
            .map(|at| format!("{:?}", value.at(at).unwrap()))
            .join(" "))
    }

    #[test]
    fn a_list_stands_behind_its_length_and_the_last_text_takes_the_rest() {
        let expected = "Text([97]) List([Float(1.5), Float(inf)]) Int(-7) Text([98, 32, 99])";
        assert_eq!(decoded("KEY  a 2 1.5 inf -7\t b c \r").as_deref(), Ok(expected));
        assert_eq!(decoded("KEY a 0 3").as_deref(), Ok("Text([97]) List([]) Int(3) Text([])"));
    }

    #[test]
    fn a_wrong_line_is_an_error_with_its_field() {
        for (line, error) in [
            ("KEY", "byte 3 of the message, `name`: the line ends before it"),
            ("KEY a 3 1 2", "byte 11 of the message, `ranges`: the line ends before it"),
            ("KEY a -1", "byte 6 of the message, `ranges`: \"-1\" is not a number of its kind"),
            ("KEY a 1 x 2", "byte 8 of the message, `ranges`: \"x\" is not a number of its kind"),
            ("KEY a 0 1.5", "byte 8 of the message, `more`: \"1.5\" is not a number of its kind"),
        ] {
            assert_eq!(decoded(line), Err(error.to_owned()), "{line}");
        }
        let definition = Definition::read(Dialect::Ros1, "a/A", "float64 x\n").unwrap();
        let error = decode(&definition, b"KEY 1 2 3").unwrap_err();
        assert_eq!(error.to_string(), "byte 5 of the message: 2 words are left over");
    }
}
