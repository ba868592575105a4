//! The parameters of a simulated laser scanner, and of what makes its scans harder to read.

use toposlam_vision::params;

params! {
    /// The parameters of a simulated laser scanner and of the building that it scans. A TOML file sets some of them
    /// ([`params::read`]); the others have their defaults.
    ScannerParams {
        /// The angle that a scan covers, symmetric about ahead, in degrees. 360 is that of a TurtleBot's
        /// scanner, 180 that of a SICK LMS.
        field_of_view: f64 = 360.0 => 90.0..=360.0,
        /// The angle from one reading to the next, in degrees.
        angular_step: f64 = 1.0 => 0.1..=2.0,
        /// Nearer surfaces give no reading, in metres.
        least_range: f64 = 0.1 => 0.0..=0.3,
        /// Farther surfaces give no return, in metres.
        range: f64 = 30.0 => 3.0..=100.0,
        /// Noise of a range, in metres; standard deviation. Of a SICK LMS it is 0.01.
        noise: f64 = 0.01 => 0.0..=0.2,
        /// The part of the readings that are invalid.
        dropouts: f64 = 0.005 => 0.0..=0.5,
        /// Stretches of glass in 10 m of a corridor's wall, each 1 to 3 m long. Glass reflects only a ray that
        /// meets it at a right angle.
        glass: f64 = 0.1 => 0.0..=5.0,
        /// Black stretches in 10 m of a corridor's wall, each 0.5 to 1.5 m long. They reflect only from nearby.
        black: f64 = 0.1 => 0.0..=5.0,
        /// Open doors of rooms in 10 m of a corridor: a gap of 0.9 m in the wall, and a furnished room behind it.
        doors: f64 = 0.5 => 0.0..=5.0,
        /// Pieces of furniture along the walls in 10 m of a corridor.
        furniture: f64 = 0.5 => 0.0..=10.0,
        /// People who walk back and forth, in 100 m of corridors.
        people: f64 = 1.0 => 0.0..=20.0,
    }
}

impl ScannerParams {
    /// A scanner without noise in an empty building.
    pub const PLAIN: Self = Self {
        noise: 0.0,
        dropouts: 0.0,
        glass: 0.0,
        black: 0.0,
        doors: 0.0,
        furniture: 0.0,
        people: 0.0,
        ..Self::DEFAULT
    };
}

#[cfg(test)]
mod tests {
    use toposlam_vision::params::read;

    use super::*;

    #[test]
    fn a_file_sets_some_of_the_parameters_and_what_cannot_be_used_is_named() {
        let params: ScannerParams = read("field_of_view = 180.0\nglass = 2.0\n").unwrap();
        let expected =
            ScannerParams { field_of_view: 180.0, glass: 2.0, ..ScannerParams::default() };
        assert_eq!(params, expected);
        for params in [ScannerParams::default(), ScannerParams::PLAIN] {
            assert_eq!(read(&toml::to_string(&params).unwrap()), Ok(params));
        }
        for (text, message) in [
            (
                "people = 2\nnoise = 3.0",
                "line 2, column 9: noise: 3 is out of range; this parameter lies between 0 and 0.2",
            ),
            (
                "dropouts = nan",
                "line 1, column 12: dropouts: NaN is out of range; this parameter lies between 0 and 0.5",
            ),
            (
                "glas = 1.0",
                "line 1, column 1: glas: unknown key; expected one of: field_of_view, angular_step, \
                 least_range, range, noise, dropouts, glass, black, doors, furniture, people",
            ),
            ("noise = \"much\"", "line 1, column 9: noise: expected a number, found a text"),
        ] {
            assert_eq!(read::<ScannerParams>(text).unwrap_err().to_string(), message);
        }
    }
}
