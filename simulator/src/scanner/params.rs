//! The parameters of a simulated laser scanner, and of what makes its scans harder to read.

use thiserror::Error;
use toposlam_vision::params;

params! {
    /// The parameters of a simulated laser scanner and of the building that it scans. A TOML file sets some of them
    /// ([`params::read`]); the others have their defaults. Scanners that are sold have a name ([`ScannerParams::named`]).
    ScannerParams {
        /// The angle that a scan covers, symmetric about ahead, in degrees. 360 is that of a TurtleBot's
        /// scanner, 180 that of a SICK LMS.
        field_of_view: f64 = 360.0 => 90.0..=360.0,
        /// The angle from one reading to the next, in degrees.
        angular_step: f64 = 1.0 => 0.1..=2.0,
        /// Nearer surfaces give no reading, in metres.
        least_range: f64 = 0.1 => 0.0..=0.3,
        /// Farther surfaces give no return, in metres.
        range: f64 = 30.0 => 1.0..=100.0,
        /// Noise of a range, in metres; standard deviation. Of a SICK LMS it is 0.01.
        noise: f64 = 0.01 => 0.0..=0.2,
        /// More noise of a range, as a part of it; standard deviation.
        range_noise: f64 = 0.0 => 0.0..=0.1,
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

/// A scanner does not see far enough for a building. Lengths are in metres.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error(
    "the scanner's range is {range} m; in corridors up to {width} m wide a robot needs {needed:.1} m"
)]
pub struct ShortRangeError {
    pub range: f64,
    pub width: f64,
    pub needed: f64,
}

impl ScannerParams {
    /// Checks that a robot in the middle of a corridor sees from one edge of an opening beside it to the other.
    pub fn check_range(&self, width: f64) -> Result<(), ShortRangeError> {
        let (range, needed) = (self.range, width.hypot(width / 2.0));
        if range < needed { Err(ShortRangeError { range, width, needed }) } else { Ok(()) }
    }

    /// A scanner without noise in an empty building.
    pub const PLAIN: Self = Self {
        noise: 0.0,
        range_noise: 0.0,
        dropouts: 0.0,
        glass: 0.0,
        black: 0.0,
        doors: 0.0,
        furniture: 0.0,
        people: 0.0,
        ..Self::DEFAULT
    };
}
