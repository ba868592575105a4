//! Parameters that a TOML file can set: a struct with a default and a range for each number; and the sizes of the robot
//! and its marker.

use std::ops::RangeInclusive;

use serde::{Serialize, de::DeserializeOwned};
use toml::{Table, Value};
use toposlam_model::format::document::{Document, DocumentError, DocumentValue};

/// What a TOML file can set: a number in a range, a switch, or a table of parameters.
pub trait Parameter {
    /// The range of a number for which none is declared; `None` for anything else.
    const RANGE: Option<RangeInclusive<f64>> = None;

    /// Checks the range of a value that has the right type.
    ///
    /// # Errors
    /// Returns an error if a number is out of its range.
    fn check(
        value: DocumentValue<'_>,
        declared: Option<RangeInclusive<f64>>,
    ) -> Result<(), DocumentError> {
        match declared.or(Self::RANGE) {
            Some(range) => value.number_in("this parameter", range).map(|_| ()),
            None => Ok(()),
        }
    }
}

impl Parameter for f64 {
    const RANGE: Option<RangeInclusive<f64>> = Some(0.0..=1000.0);
}

impl Parameter for usize {
    const RANGE: Option<RangeInclusive<f64>> = Some(1.0..=1000.0);
}

impl Parameter for bool {}

/// Reads parameters from TOML. What is not in the file has its default.
///
/// # Errors
/// Returns an error if a key is not known, or a number is not one that the parameter can have.
pub fn read<P: Parameter + DeserializeOwned>(text: &str) -> Result<P, DocumentError> {
    let document = Document::parse_settings(text.as_bytes())?;
    let params = document.root().read()?;
    P::check(document.root(), None)?;
    Ok(params)
}

/// The same over other parameters than the default: what is not in the file stays.
///
/// # Errors
/// Returns an error if a key is not known, or a number is not one that the parameter can have.
pub fn read_over<P>(base: &P, text: &str) -> Result<P, DocumentError>
where
    P: Parameter + DeserializeOwned + Serialize,
{
    // Errors have their place in the file. What is read is a table of numbers, as the base is.
    read::<P>(text)?;
    let mut whole = Table::try_from(base).unwrap_or_default();
    overlay(&mut whole, text.parse().unwrap_or_default());
    read(&whole.to_string())
}

/// Puts the values of one table into another.
fn overlay(whole: &mut Table, given: Table) {
    for (key, value) in given {
        match (whole.get_mut(&key), value) {
            (Some(Value::Table(inner)), Value::Table(given)) => overlay(inner, given),
            // A whole number is as good as any other.
            (Some(Value::Float(old)), Value::Integer(new)) => *old = new as f64,
            (_, value) => drop(whole.insert(key, value)),
        }
    }
}

/// Structs of parameters, each with its default, and a number with its range if that is not the usual one of its type.
/// The docs of each field show its default. [`read`](crate::params::read) reads them.
#[macro_export]
macro_rules! params {
    ($($(#[$meta:meta])* $name:ident {
        $($(#[$doc:meta])* $field:ident: $type:ty = $default:expr $(=> $range:expr)?,)*
    })*) => {$(
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
        #[serde(default, deny_unknown_fields)]
        pub struct $name {
            $(
                $(#[$doc])*
                #[doc = concat!("\n\nDefault: `", stringify!($default), "`.")]
                pub $field: $type,
            )*
        }

        impl $name {
            pub const DEFAULT: Self = Self { $($field: $default,)* };
        }

        impl Default for $name {
            fn default() -> Self {
                Self::DEFAULT
            }
        }

        impl $crate::params::Parameter for $name {
            fn check(
                value: toposlam_model::format::document::DocumentValue<'_>,
                _: Option<std::ops::RangeInclusive<f64>>,
            ) -> Result<(), toposlam_model::format::document::DocumentError> {
                let table = value.any_table()?;
                $(if let Some(value) = table.get(stringify!($field)) {
                    let range = None::<std::ops::RangeInclusive<f64>>$(.or(Some($range)))?;
                    <$type as $crate::params::Parameter>::check(value, range)?;
                })*
                Ok(())
            }
        }
    )*};
}

// paper: marker-sense.shape
/// The length of the marker of Section 5.1, in metres.
pub const MARKER_LENGTH: f64 = 0.60;
/// Its width, in metres.
pub const MARKER_WIDTH: f64 = 0.18;

/// The radius of the SuperScout's body, in metres.
pub const ROBOT_RADIUS: f64 = 0.205;
