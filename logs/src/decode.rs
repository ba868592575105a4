//! Decodes the bytes of a message to values: the serialisation of ROS 1, and CDR, as ROS 2 writes it
//! (OMG DDSI-RTPS, 10; XCDR version 1, of either byte order).
//!
//! In ROS 1 all stands side by side, the lesser byte first. In CDR a number stands at a multiple of its
//! size, counted from behind the four bytes of the byte order.

use thiserror::Error;

use super::{
    definition::{Count, Definition, Dialect, Field, FieldType},
    value::{ByteOrder, Numbers, Value, number},
};

#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("byte {offset} of the message{}: {cause}", shown(.field))]
pub struct DecodeError {
    pub offset: usize,
    /// In which field of the message itself, if in one.
    pub field: String,
    #[source]
    pub cause: DecodeErrorKind,
}

fn shown(field: &str) -> String {
    if field.is_empty() { String::new() } else { format!(", `{field}`") }
}

#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum DecodeErrorKind {
    #[error("{needed} more bytes are needed, and {left} are left")]
    Short { needed: u64, left: usize },
    #[error("{0} bytes are left over")]
    LeftOver(usize),
    #[error("a list of {found}, which may have {most}")]
    TooMany { found: u32, most: u32 },
    #[error("the line ends before it")]
    NoWord,
    #[error("\"{0}\" is not a number of its kind")]
    NotANumber(String),
    #[error("{0} words are left over")]
    WordsLeft(usize),
    #[error("the encapsulation {0:#06x} is not known; known are 0x0000 and 0x0001, plain CDR")]
    Encapsulation(u16),
    #[error("wstring is not supported: writers encode it differently")]
    WideText,
}

/// Padding that writers of CDR leave behind a message, at most.
const PADDING: usize = 7;

/// The value of a message.
///
/// Takes at most 256 bytes of memory for each byte of the message and for each field of the definition,
/// and 4096 besides; a length is compared with the remaining bytes before anything is allocated.
///
/// # Errors
/// If the bytes are not a message of the definition. No bytes make it panic.
pub fn decode<'a>(definition: &'a Definition, bytes: &'a [u8]) -> Result<Value<'a>, DecodeError> {
    let mut at = Decoder { definition, bytes, next: 0, origin: 0, order: ByteOrder::Little };
    if definition.dialect() == Dialect::Ros2 {
        at.encapsulation().map_err(in_field(""))?;
    }
    let root = definition.root();
    let mut values = Vec::with_capacity(root.fields.len());
    for field in &root.fields {
        values.push(at.field(field).map_err(in_field(&field.name))?);
    }
    let left = bytes.len() - at.next;
    let most = if definition.dialect() == Dialect::Ros2 { PADDING } else { 0 };
    if left > most {
        return Err(in_field("")((at.next, DecodeErrorKind::LeftOver(left))));
    }
    Ok(Value::Struct(root, values))
}

/// An error and its offset.
pub(super) type DecodeFailure = (usize, DecodeErrorKind);

/// The error of a field of the message; of none if the name is empty.
pub(super) fn in_field(field: &str) -> impl Fn(DecodeFailure) -> DecodeError {
    move |(offset, cause)| DecodeError { offset, field: field.to_owned(), cause }
}

struct Decoder<'a> {
    definition: &'a Definition,
    bytes: &'a [u8],
    next: usize,
    origin: usize,
    order: ByteOrder,
}

impl<'a> Decoder<'a> {
    fn encapsulation(&mut self) -> Result<(), DecodeFailure> {
        let head = self.take(4)?;
        let kind = head.iter().take(2).fold(0, |kind, byte| kind << 8 | u16::from(*byte));
        self.order = match kind {
            0 => ByteOrder::Big,
            1 => ByteOrder::Little,
            _ => return Err((0, DecodeErrorKind::Encapsulation(kind))),
        };
        self.origin = self.next;
        Ok(())
    }

    fn left(&self) -> usize {
        self.bytes.len() - self.next
    }

    fn take(&mut self, bytes: usize) -> Result<&'a [u8], DecodeFailure> {
        self.need(bytes as u64)?;
        let taken = self.bytes.get(self.next..self.next + bytes).unwrap_or_default();
        self.next += bytes;
        Ok(taken)
    }

    fn need(&self, needed: u64) -> Result<(), DecodeFailure> {
        let left = self.left();
        if needed > left as u64 {
            Err((self.next, DecodeErrorKind::Short { needed, left }))
        } else {
            Ok(())
        }
    }

    fn align(&mut self, size: usize) -> Result<(), DecodeFailure> {
        if self.definition.dialect() == Dialect::Ros2 {
            let beyond = (self.next - self.origin) % size.max(1);
            if beyond > 0 {
                self.take(size - beyond)?;
            }
        }
        Ok(())
    }

    fn number(&mut self, kind: FieldType, size: usize) -> Result<Value<'a>, DecodeFailure> {
        self.align(size)?;
        Ok(number(kind, self.order, self.take(size)?))
    }

    fn length(&mut self) -> Result<u32, DecodeFailure> {
        match self.number(FieldType::Unsigned(4), 4)? {
            Value::Unsigned(length) => Ok(length as u32),
            _ => Ok(0),
        }
    }

    fn field(&mut self, field: &'a Field) -> Result<Value<'a>, DecodeFailure> {
        let start = self.next;
        match field.count {
            Count::One => self.one(field.kind),
            Count::Fixed(many) => self.list(field.kind, many),
            Count::Any => {
                let many = self.length()?;
                self.list(field.kind, many)
            }
            Count::AtMost(most) => {
                let found = self.length()?;
                if found > most {
                    return Err((start, DecodeErrorKind::TooMany { found, most }));
                }
                self.list(field.kind, found)
            }
        }
    }

    fn list(&mut self, kind: FieldType, many: u32) -> Result<Value<'a>, DecodeFailure> {
        let needed = u64::from(many).saturating_mul(self.definition.least(kind) as u64);
        self.need(needed)?;
        match kind {
            FieldType::Bool | FieldType::Int(_) | FieldType::Unsigned(_) | FieldType::Float(_) => {
                let size = self.definition.least(kind);
                if many > 0 {
                    self.align(size)?;
                }
                let bytes = self.take(size * many as usize)?;
                Ok(Value::Numbers(Numbers { bytes, kind, order: self.order }))
            }
            _ => {
                let mut list = Vec::with_capacity(many as usize);
                for _ in 0..many {
                    list.push(self.one(kind)?);
                }
                Ok(Value::List(list))
            }
        }
    }

    fn one(&mut self, kind: FieldType) -> Result<Value<'a>, DecodeFailure> {
        match kind {
            FieldType::Bool => self.number(kind, 1),
            FieldType::Int(size) | FieldType::Unsigned(size) | FieldType::Float(size) => {
                self.number(kind, size.into())
            }
            FieldType::Text => self.text(),
            FieldType::WideText => Err((self.next, DecodeErrorKind::WideText)),
            FieldType::Time | FieldType::Duration => {
                let part = if kind == FieldType::Time {
                    FieldType::Unsigned(4)
                } else {
                    FieldType::Int(4)
                };
                let [sec, nanosec] = [self.number(part, 4)?, self.number(part, 4)?];
                Ok(Value::Time(sec.i64().unwrap_or_default(), nanosec.i64().unwrap_or_default()))
            }
            FieldType::Struct(index) => {
                let Some(made) = self.definition.get(index) else {
                    return Ok(Value::List(Vec::new()));
                };
                let mut values = Vec::with_capacity(made.fields.len());
                for field in &made.fields {
                    values.push(self.field(field)?);
                }
                Ok(Value::Struct(made, values))
            }
        }
    }

    fn text(&mut self) -> Result<Value<'a>, DecodeFailure> {
        let length = self.length()?;
        let bytes = self.take(length as usize)?;
        // In CDR the length counts a zero byte at the end.
        Ok(Value::Text(match self.definition.dialect() {
            Dialect::Ros1 => bytes,
            Dialect::Ros2 => bytes.strip_suffix(&[0]).unwrap_or(bytes),
        }))
    }
}

#[cfg(test)]
mod tests;
