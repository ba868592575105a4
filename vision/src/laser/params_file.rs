//! Files with parameters of sensing with a laser scanner: TOML, one table for each struct of
//! [`params`](super::params). What is not in the file has its default.

use toposlam_model::format::document::{Document, DocumentError, DocumentTable};

use super::params::LaserParams;

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
    pub fn read(text: &str) -> Result<Self, DocumentError> {
        let document = Document::parse_settings(text.as_bytes())?;
        let params = document.root().read()?;
        check(&document.root().any_table()?, "")?;
        Ok(params)
    }

    /// The parameters as TOML, with all tables and keys.
    #[must_use]
    pub fn to_toml(&self) -> String {
        // Structs of numbers are always TOML.
        toml::to_string(self).unwrap_or_default()
    }
}

/// Checks the numbers of a table.
fn check(table: &DocumentTable, path: &str) -> Result<(), DocumentError> {
    for entry in table.entries() {
        let (key, value) = (entry.key, entry.value);
        if let Ok(table) = value.any_table() {
            check(&table, key)?;
        }
        if value.number().is_err() {
            continue;
        }
        let [least, most] = match (path, key) {
            ("map", "cell") => CELL,
            ("map", "reach") => REACH,
            ("matching", "rounds") => ROUNDS,
            _ if value.whole().is_ok() => COUNT,
            _ => ANY,
        };
        value.number_in("this parameter", least..=most)?;
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
        let message = |text: &str| LaserParams::read(text).unwrap_err().to_string();
        let unknown = message("[corner]\n[arm]\nmin = 2.0");
        assert!(
            unknown
                .starts_with("line 3, column 1: arm.min: unknown key; expected one of: min_arm, "),
            "{unknown}"
        );
        assert_eq!(
            message("min_arm = 2.0"),
            "line 1, column 1: min_arm: unknown key; expected one of: matching, map, arm, corner, visit"
        );
        assert_eq!(
            message("[arm]\nmin_arm = \"far\""),
            "line 2, column 11: arm.min_arm: expected a number, found a text"
        );
        for (text, place, range) in [
            ("[arm]\nmin_arm = -1.0", "line 2, column 11: arm.min_arm: -1 ", "0 and 1000"),
            ("[arm]\nmin_arm = nan", "line 2, column 11: arm.min_arm: NaN ", "0 and 1000"),
            ("[map]\ncell = 0.0001", "line 2, column 8: map.cell: 0.0001 ", "0.02 and 1"),
            ("[map]\nreach = inf", "line 2, column 9: map.reach: inf ", "2 and 40"),
            ("[visit]\nviews = 0", "line 2, column 9: visit.views: 0 ", "1 and 1000"),
        ] {
            let range = format!("{place}is out of range; this parameter lies between {range}");
            assert_eq!(message(text), range);
        }
        for text in ["[arm", "[corner]\ncorners = yes"] {
            let message = message(text);
            assert!(message.starts_with("line ") && !message.contains('\n'), "{message}");
        }
    }
}
