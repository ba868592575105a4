//! Reads the project's messages by the names of their fields, from ROS 1 or ROS 2; fields may have other
//! widths, and there may be more of them.

use super::{stamp::Stamp, value::Value};

pub(super) trait FieldValue: Sized {
    fn of(value: &Value<'_>) -> Option<Self>;
}

macro_rules! fields {
    ($($type:ty: $value:ident => $read:expr;)*) => {$(
        impl FieldValue for $type {
            fn of($value: &Value<'_>) -> Option<Self> {
                $read
            }
        }
    )*};
}

fields! {
    Stamp: value => value.stamp();
    String: value => value.text().map(std::borrow::Cow::into_owned);
    bool: value => value.bool();
    f64: value => value.f64();
    u64: value => value.u64();
    u32: value => value.u64()?.try_into().ok();
    i32: value => value.i64()?.try_into().ok();
}

impl<T: FieldValue> FieldValue for Vec<T> {
    fn of(value: &Value<'_>) -> Option<Self> {
        match value {
            Value::Numbers(numbers) => numbers.iter().map(|value| T::of(&value)).collect(),
            Value::List(list) => list.iter().map(T::of).collect(),
            _ => None,
        }
    }
}

impl<T: FieldValue, const MANY: usize> FieldValue for [T; MANY] {
    fn of(value: &Value<'_>) -> Option<Self> {
        Vec::of(value)?.try_into().ok()
    }
}

impl Value<'_> {
    /// The field of a message with this name.
    pub(super) fn field<T: FieldValue>(&self, name: &str) -> Option<T> {
        let Value::Struct(made, values) = self else { return None };
        let (index, _) = made.field(name)?;
        T::of(values.get(index)?)
    }
}

pub(super) trait FromValue: Sized {
    /// The message that a value is, or the field that it lacks.
    fn from_value(value: &Value<'_>) -> Result<Self, &'static str>;
}
