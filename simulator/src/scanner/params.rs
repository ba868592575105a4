//! The parameters of a simulated laser scanner, and of what makes its scans harder to read.

use serde::Deserialize;
use toposlam_model::format::document::{Document, DocumentError};

macro_rules! scanner_params {
    ($($(#[$doc:meta])* $field:ident = $default:literal, $least:literal ..= $greatest:literal;)*) => {
        /// The parameters of a simulated laser scanner and of the building that it scans. A TOML file sets
        /// some of them; the others have their defaults.
        #[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
        #[serde(default, deny_unknown_fields)]
        pub struct ScannerParams {
            $($(#[$doc])* #[doc = concat!("\n\nDefault: `", stringify!($default), "`.")] pub $field: f64,)*
        }

        impl Default for ScannerParams {
            fn default() -> Self {
                Self { $($field: $default,)* }
            }
        }

        impl ScannerParams {
            /// Name, value, and the least and the greatest value of each.
            fn all(&self) -> Vec<(&'static str, f64, [f64; 2])> {
                vec![$((stringify!($field), self.$field, [$least, $greatest]),)*]
            }
        }
    };
}

scanner_params! {
    /// The angle that a scan covers, symmetric about ahead, in degrees. 360 is that of a TurtleBot's
    /// scanner, 180 that of a SICK LMS.
    field_of_view = 360.0, 90.0..=360.0;
    /// The angle from one reading to the next, in degrees.
    angular_step = 1.0, 0.1..=2.0;
    /// Nearer surfaces give no reading, in metres.
    least_range = 0.1, 0.0..=0.3;
    /// Farther surfaces give no return, in metres.
    range = 30.0, 3.0..=100.0;
    /// Noise of a range, in metres; standard deviation. Of a SICK LMS it is 0.01.
    noise = 0.01, 0.0..=0.2;
    /// The part of the readings that are invalid.
    dropouts = 0.005, 0.0..=0.5;
    /// Stretches of glass in 10 m of a corridor's wall, each 1 to 3 m long. Glass reflects only a ray that
    /// meets it at a right angle.
    glass = 0.1, 0.0..=5.0;
    /// Black stretches in 10 m of a corridor's wall, each 0.5 to 1.5 m long. They reflect only from nearby.
    black = 0.1, 0.0..=5.0;
    /// Open doors of rooms in 10 m of a corridor: a gap of 0.9 m in the wall, and a furnished room behind it.
    doors = 0.5, 0.0..=5.0;
    /// Pieces of furniture along the walls in 10 m of a corridor.
    furniture = 0.5, 0.0..=10.0;
    /// People who walk back and forth, in 100 m of corridors.
    people = 1.0, 0.0..=20.0;
}

impl ScannerParams {
    /// A scanner without noise in an empty building.
    pub const PLAIN: Self = Self {
        field_of_view: 360.0,
        angular_step: 1.0,
        least_range: 0.1,
        range: 30.0,
        noise: 0.0,
        dropouts: 0.0,
        glass: 0.0,
        black: 0.0,
        doors: 0.0,
        furniture: 0.0,
        people: 0.0,
    };

    /// Reads the parameters in a TOML file.
    ///
    /// # Errors
    /// Returns an error if the text is not TOML, if a key is unknown, or if a value is out of its range.
    pub fn from_toml(text: &str) -> Result<Self, DocumentError> {
        let document = Document::parse_settings(text.as_bytes())?;
        let params: Self = document.root().read()?;
        let table = document.root().any_table()?;
        for (name, _, [least, greatest]) in params.all() {
            if let Some(value) = table.get(name) {
                value.number_in("this parameter", least..=greatest)?;
            }
        }
        Ok(params)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_sets_some_of_the_parameters() {
        let params = ScannerParams::from_toml("field_of_view = 180.0\nglass = 2.0\n").unwrap();
        let expected =
            ScannerParams { field_of_view: 180.0, glass: 2.0, ..ScannerParams::default() };
        assert_eq!(params, expected);
        assert_eq!(ScannerParams::from_toml("").unwrap(), ScannerParams::default());
    }

    #[test]
    fn the_defaults_and_the_plain_scanner_are_within_their_ranges() {
        for params in [ScannerParams::default(), ScannerParams::PLAIN] {
            for (name, value, [least, greatest]) in params.all() {
                assert!((least..=greatest).contains(&value), "{name}");
            }
        }
    }

    #[test]
    fn what_cannot_be_used_is_named() {
        let message = |text: &str| ScannerParams::from_toml(text).unwrap_err().to_string();
        assert_eq!(
            message("people = 2\nnoise = 3.0"),
            "line 2, column 9: noise: 3 is out of range; this parameter lies between 0 and 0.2"
        );
        assert_eq!(
            message("dropouts = nan"),
            "line 1, column 12: dropouts: NaN is out of range; this parameter lies between 0 and 0.5"
        );
        assert_eq!(
            message("glas = 1.0"),
            "line 1, column 1: glas: unknown key; expected one of: field_of_view, angular_step, \
             least_range, range, noise, dropouts, glass, black, doors, furniture, people"
        );
        assert_eq!(
            message("noise = \"much\""),
            "line 1, column 9: noise: expected a number, found a text"
        );
    }
}
