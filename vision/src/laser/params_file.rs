//! Files with parameters of sensing with a laser scanner: TOML, one table for each struct of
//! [`params`](super::params). What is not in the file has its default.

use thiserror::Error;
use toml::{Table, Value};

use super::params::LaserParams;

/// A file that does not have usable parameters.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum LaserParamsError {
    /// It is not TOML, or has other keys or types.
    #[error("{0}")]
    Form(String),
    /// A number is out of its range.
    #[error("{key} = {value}: expected a number from {least} to {most}")]
    Number {
        /// The tables and the key, with dots between them.
        key: String,
        /// The number.
        value: String,
        /// The least one that is allowed.
        least: String,
        /// The greatest one.
        most: String,
    },
}

/// Least and greatest values; a local map of more cells would need too much memory.
const CELL: [f64; 2] = [0.02, 1.0];
const REACH: [f64; 2] = [2.0, 40.0];
const ROUNDS: [f64; 2] = [0.0, 100.0];
const COUNT: [f64; 2] = [1.0, 1000.0];
const ANY: [f64; 2] = [0.0, 1000.0];

impl LaserParams {
    /// Reads parameters from TOML.
    ///
    /// # Errors
    /// Returns an error if a key is not known, or a number is not one that the parameter can have.
    pub fn read(text: &str) -> Result<Self, LaserParamsError> {
        let form = |error: toml::de::Error| LaserParamsError::Form(error.to_string());
        let table: Table = toml::from_str(text).map_err(form)?;
        check(&table, "")?;
        toml::from_str(text).map_err(form)
    }

    /// The parameters as TOML, with all tables and keys.
    #[must_use]
    pub fn to_toml(&self) -> String {
        // Structs of numbers are always TOML.
        toml::to_string(self).unwrap_or_default()
    }
}

/// Checks the numbers of a table.
fn check(table: &Table, path: &str) -> Result<(), LaserParamsError> {
    for (name, value) in table {
        let key = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
        let (number, range) = match value {
            Value::Table(table) => {
                check(table, &key)?;
                continue;
            }
            Value::Float(number) => (*number, ANY),
            Value::Integer(number) => (*number as f64, COUNT),
            _ => continue,
        };
        let [least, most] = match &*key {
            "map.cell" => CELL,
            "map.reach" => REACH,
            "matching.rounds" => ROUNDS,
            _ => range,
        };
        if !(least..=most).contains(&number) {
            let [value, least, most] = [number, least, most].map(|number| number.to_string());
            return Err(LaserParamsError::Number { key, value, least, most });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_changes_what_is_in_it_and_nothing_else() {
        let params = LaserParams::read("[arm]\nmin_arm = 6.5\n[corner]\ncorners = true").unwrap();
        let mut expected = LaserParams::default();
        expected.arm.min_arm = 6.5;
        expected.corner.corners = true;
        assert_eq!(params, expected);
        assert_eq!(LaserParams::read(""), Ok(LaserParams::default()));
    }

    #[test]
    fn the_defaults_are_read_as_they_are_written() {
        let text = LaserParams::default().to_toml();
        assert!(text.contains("min_arm = 10.0"), "{text}");
        assert_eq!(LaserParams::read(&text), Ok(LaserParams::default()));
    }

    #[test]
    fn unknown_keys_and_impossible_numbers_are_errors() {
        for text in ["[arm]\nmin = 2.0", "min_arm = 2.0", "[arm]\nmin_arm = \"far\"", "[arm"] {
            assert!(matches!(LaserParams::read(text), Err(LaserParamsError::Form(_))), "{text}");
        }
        for text in [
            "[arm]\nmin_arm = -1.0",
            "[arm]\nmin_arm = nan",
            "[map]\ncell = 0.0001",
            "[map]\nreach = inf",
            "[visit]\nviews = 0",
        ] {
            let error = LaserParams::read(text);
            assert!(matches!(error, Err(LaserParamsError::Number { .. })), "{text}: {error:?}");
        }
    }
}
