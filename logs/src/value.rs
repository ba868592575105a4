//! The values of a message by the names of its fields. Texts and lists of numbers stay where they are in
//! the message.

use std::borrow::Cow;

use super::{
    definition::{FieldType, Struct},
    stamp::Stamp,
    standard::Quaternion,
};

#[derive(Clone, Debug, PartialEq)]
pub enum Value<'a> {
    Bool(bool),
    Int(i64),
    /// A whole number of a type without a sign.
    Unsigned(u64),
    Float(f64),
    Text(&'a [u8]),
    /// A time or a duration of ROS 1: seconds and nanoseconds.
    Time(i64, i64),
    Numbers(Numbers<'a>),
    List(Vec<Value<'a>>),
    /// A message: its fields in their order.
    Struct(&'a Struct, Vec<Value<'a>>),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Numbers<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) kind: FieldType,
    pub(super) order: ByteOrder,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ByteOrder {
    Little,
    Big,
}

impl<'a> Numbers<'a> {
    pub fn len(&self) -> usize {
        self.bytes.len() / self.size()
    }

    pub fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    pub fn iter(&self) -> impl Iterator<Item = Value<'a>> + use<'a> {
        let (kind, order) = (self.kind, self.order);
        self.bytes.chunks_exact(self.size()).map(move |bytes| number(kind, order, bytes))
    }

    pub fn get(&self, index: usize) -> Option<Value<'a>> {
        self.bytes
            .chunks_exact(self.size())
            .nth(index)
            .map(|bytes| number(self.kind, self.order, bytes))
    }

    fn size(&self) -> usize {
        match self.kind {
            FieldType::Int(bytes) | FieldType::Unsigned(bytes) | FieldType::Float(bytes) => {
                bytes.max(1).into()
            }
            _ => 1,
        }
    }
}

pub(super) fn number<'a>(kind: FieldType, order: ByteOrder, bytes: &[u8]) -> Value<'a> {
    let mut all = [0; 8];
    let used = bytes.iter().take(8);
    match order {
        ByteOrder::Little => all.iter_mut().zip(used).for_each(|(to, from)| *to = *from),
        ByteOrder::Big => all.iter_mut().zip(used.rev()).for_each(|(to, from)| *to = *from),
    }
    let unsigned = u64::from_le_bytes(all);
    match kind {
        FieldType::Bool => Value::Bool(unsigned != 0),
        FieldType::Int(bytes) => {
            // The sign goes up to the last bit.
            let unused = 64_u32.saturating_sub(8 * u32::from(bytes)).min(63);
            Value::Int(unsigned.wrapping_shl(unused).cast_signed() >> unused)
        }
        FieldType::Float(4) => Value::Float(f32::from_bits(unsigned as u32).into()),
        FieldType::Float(_) => Value::Float(f64::from_bits(unsigned)),
        _ => Value::Unsigned(unsigned),
    }
}

impl<'a> Value<'a> {
    /// The value at a path such as `pose.pose.position.x` or `doors[0]`; the empty path is the
    /// message itself. Of a time `sec` and `nanosec` are parts (`secs` and `nsecs`, too).
    pub fn at(&self, path: &str) -> Option<Value<'a>> {
        if path.is_empty() { Some(self.clone()) } else { self.field_at(path) }
    }

    fn field_at(&self, path: &str) -> Option<Value<'a>> {
        let end = path.find(['.', '[']).unwrap_or(path.len());
        let (name, rest) = path.split_at(end);
        match (self, name) {
            (Self::Time(sec, _), "sec" | "secs") => Self::Int(*sec).rest_at(rest),
            (Self::Time(_, nanosec), "nanosec" | "nsecs") => Self::Int(*nanosec).rest_at(rest),
            (Self::Struct(made, values), _) => values.get(made.field(name)?.0)?.rest_at(rest),
            _ => None,
        }
    }

    /// The value at the rest of a path: nothing, a field behind a point, or an element in brackets.
    fn rest_at(&self, rest: &str) -> Option<Value<'a>> {
        if let Some(path) = rest.strip_prefix('.') {
            return self.field_at(path);
        }
        let Some(rest) = rest.strip_prefix('[') else {
            return rest.is_empty().then(|| self.clone());
        };
        let (index, rest) = rest.split_once(']')?;
        let index = index.parse().ok()?;
        match self {
            Self::Numbers(numbers) => numbers.get(index)?.rest_at(rest),
            Self::List(list) => list.get(index)?.rest_at(rest),
            _ => None,
        }
    }

    pub fn f64(&self) -> Option<f64> {
        match *self {
            Self::Int(number) => Some(number as f64),
            Self::Unsigned(number) => Some(number as f64),
            Self::Float(number) => Some(number),
            _ => None,
        }
    }

    /// A whole number, also where the type has fractions.
    pub fn i64(&self) -> Option<i64> {
        match *self {
            Self::Int(number) => Some(number),
            Self::Unsigned(number) => number.try_into().ok(),
            // Whole numbers of doubles beyond this are not exact.
            Self::Float(number) if number.fract() == 0.0 && number.abs() <= 9e15 => {
                Some(number as i64)
            }
            _ => None,
        }
    }

    /// A whole number that is not negative, also where the type has fractions.
    pub fn u64(&self) -> Option<u64> {
        match *self {
            Self::Unsigned(number) => Some(number),
            _ => self.i64()?.try_into().ok(),
        }
    }

    pub fn bool(&self) -> Option<bool> {
        match *self {
            Self::Bool(truth) => Some(truth),
            _ => None,
        }
    }

    /// A text. What is not UTF-8 in it is replaced by `U+FFFD`.
    pub fn text(&self) -> Option<Cow<'a, str>> {
        match *self {
            Self::Text(bytes) => Some(String::from_utf8_lossy(bytes)),
            _ => None,
        }
    }

    /// A list of bytes (`uint8[]`, `char[]`, `int8[]`).
    pub fn bytes(&self) -> Option<&'a [u8]> {
        match *self {
            Self::Numbers(Numbers {
                bytes,
                kind: FieldType::Unsigned(1) | FieldType::Int(1),
                ..
            }) => Some(bytes),
            _ => None,
        }
    }

    pub fn stamp(&self) -> Option<Stamp> {
        let [sec, nanosec] =
            ["sec", "nanosec"].map(|name| self.at(name).and_then(|part| part.i64()));
        // A time of ROS 1 goes beyond 2038.
        Some(Stamp { sec: sec? as i32, nanosec: nanosec?.try_into().ok()? })
    }

    pub(super) fn list_at(&self, path: &str) -> Vec<Value<'a>> {
        self.at(path).and_then(|list| list.elements()).unwrap_or_default()
    }

    pub(super) fn number_at(&self, path: &str) -> Result<f64, String> {
        self.get(path).ok_or_else(|| format!("it has no number `{path}`"))
    }

    pub(super) fn finite_at(&self, path: &str) -> Result<f64, String> {
        match self.get::<f64>(path) {
            Some(number) if number.is_finite() => Ok(number),
            Some(number) => Err(format!("its `{path}` is {number}")),
            None => Err(format!("it has no `{path}`")),
        }
    }

    /// The parts x, y, z and w of a rotation, each read in a way.
    pub(super) fn quaternion_at<E>(
        &self,
        path: &str,
        number: impl Fn(&Self, &str) -> Result<f64, E>,
    ) -> Result<Quaternion, E> {
        let part = |name| number(self, &format!("{path}.{name}"));
        Ok(Quaternion { x: part("x")?, y: part("y")?, z: part("z")?, w: part("w")? })
    }

    pub fn elements(&self) -> Option<Vec<Value<'a>>> {
        match self {
            Self::Numbers(numbers) => Some(numbers.iter().collect()),
            Self::List(list) => Some(list.clone()),
            _ => None,
        }
    }
}
