//! Reads the project's messages by the names of their fields, from ROS 1 or ROS 2; fields may have other
//! widths, and there may be more of them.

use super::{
    messages::{Command, Door, End, Hypothesis, Map, Percept, Run, Scene, Stamp},
    value::Value,
};

/// A field that a message of the project can have.
trait Field: Sized {
    fn of(value: &Value<'_>) -> Option<Self>;
}

macro_rules! fields {
    ($($type:ty: $value:ident => $read:expr;)*) => {$(
        impl Field for $type {
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

impl<T: Field> Field for Vec<T> {
    fn of(value: &Value<'_>) -> Option<Self> {
        match value {
            Value::Numbers(numbers) => numbers.iter().map(|value| T::of(&value)).collect(),
            Value::List(list) => list.iter().map(T::of).collect(),
            _ => None,
        }
    }
}

impl<T: Field, const MANY: usize> Field for [T; MANY] {
    fn of(value: &Value<'_>) -> Option<Self> {
        Vec::of(value)?.try_into().ok()
    }
}

/// A message of the project.
pub(super) trait FromValue: Sized {
    /// The message that a value is, or the field that it lacks.
    fn from_value(value: &Value<'_>) -> Result<Self, &'static str>;
}

macro_rules! read {
    ($($name:ident { $($field:ident)* $(/ $($new:ident)*)? })*) => {$(
        impl FromValue for $name {
            fn from_value(value: &Value<'_>) -> Result<Self, &'static str> {
                let Value::Struct(made, values) = value else { return Err("") };
                $(
                    let name = stringify!($field).trim_start_matches("r#");
                    let found = made.field(name).and_then(|(index, _)| values.get(index));
                    let $field = found.and_then(Field::of).ok_or(name)?;
                )*
                // Older logs do not have these.
                $($(
                    let found = made.field(stringify!($new));
                    let $new = found.and_then(|(index, _)| Field::of(values.get(index)?));
                    let $new = $new.unwrap_or_default();
                )*)?
                Ok(Self { $($field,)* $($($new,)*)? })
            }
        }
    )*};
}

read! {
    Run { stamp version world world_hash start marker seed calibration colours command / algorithm }
    Scene {
        stamp place status reason heading left right doors turning_point confidence marker
        marker_position marker_axis marker_door
    }
    Command { stamp state turn forward }
    Door { stamp r#move door }
    Percept { stamp r#move degree marker form entry }
    Hypothesis { stamp r#move step dart other contradicted hypotheses followed }
    Map { stamp r#move degrees opposite robot }
    End { stamp moves ending cause }
}
