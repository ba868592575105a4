//! Reads the project's messages by the names of their fields, from ROS 1 or ROS 2; fields may have other
//! widths, and there may be more of them.

use super::{stamp::Stamp, value::Value};

pub(super) trait FromField: Sized {
    fn from_field(value: &Value<'_>) -> Option<Self>;
}

macro_rules! fields {
    ($($type:ty: $value:ident => $read:expr;)*) => {$(
        impl FromField for $type {
            fn from_field($value: &Value<'_>) -> Option<Self> {
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
    i64: value => value.i64();
    i32: value => value.i64()?.try_into().ok();
}

impl<T: FromField> FromField for Vec<T> {
    fn from_field(value: &Value<'_>) -> Option<Self> {
        value.elements()?.iter().map(T::from_field).collect()
    }
}

impl<T: FromField, const MANY: usize> FromField for [T; MANY] {
    fn from_field(value: &Value<'_>) -> Option<Self> {
        Vec::from_field(value)?.try_into().ok()
    }
}

impl Value<'_> {
    /// The value at a path, if it is one of this type.
    pub(super) fn get<T: FromField>(&self, path: &str) -> Option<T> {
        T::from_field(&self.at(path)?)
    }
}

pub(super) trait FromValue: Sized {
    /// The message that a value is, or the field that it lacks.
    fn from_value(value: &Value<'_>) -> Result<Self, &'static str>;
}
