//! Laser scanners by the data sheets of their makers.

use super::params::ScannerParams;

/// A laser scanner that is sold or was used on many robots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NamedScanner {
    /// Its name on the command line.
    pub name: &'static str,
    pub about: &'static str,
    /// Its field of view, step, limits and noise. The building is the usual one.
    pub params: ScannerParams,
}

/// Data sheets state the spread of a range in different ways. "Repeated accuracy" is a standard deviation. A "precision"
/// or an "accuracy" of plus or minus some length or part of the range is taken for two of them.
pub const SCANNERS: [NamedScanner; 9] = [
    NamedScanner {
        name: "lds-01",
        about: "TurtleBot3 LDS-01: 360 degrees, 3.5 m",
        // 10 mm below 0.5 m, 3.5 % beyond.
        params: scanner([360.0, 1.0], [0.12, 3.5], [0.005, 0.0175]),
    },
    NamedScanner {
        name: "lds-02",
        about: "TurtleBot3 LDS-02: 360 degrees, 8 m",
        // 10 mm below 0.3 m, 3 % up to 6 m, 5 % beyond.
        params: scanner([360.0, 1.0], [0.16, 8.0], [0.005, 0.015]),
    },
    NamedScanner {
        name: "rplidar-a1",
        about: "Slamtec RPLIDAR A1: 360 degrees, 12 m",
        // 1 % of the range.
        params: scanner([360.0, 1.0], [0.15, 12.0], [0.0025, 0.005]),
    },
    NamedScanner {
        name: "rplidar-c1",
        about: "Slamtec RPLIDAR C1: 360 degrees, 12 m",
        // 30 mm.
        params: scanner([360.0, 0.72], [0.05, 12.0], [0.015, 0.0]),
    },
    NamedScanner {
        name: "ust-10lx",
        about: "Hokuyo UST-10LX: 270 degrees, 10 m",
        // The standard deviation is less than 30 mm.
        params: scanner([270.0, 0.25], [0.06, 10.0], [0.03, 0.0]),
    },
    NamedScanner {
        name: "utm-30lx",
        about: "Hokuyo UTM-30LX: 270 degrees, 30 m",
        // The standard deviation is less than 10 mm up to 10 m, and less than 30 mm up to 30 m.
        params: scanner([270.0, 0.25], [0.1, 30.0], [0.01, 0.001]),
    },
    NamedScanner {
        name: "lms-200",
        about: "SICK LMS 200, a step of 1 degree: 180 degrees, 30 m",
        // A standard deviation of 5 mm.
        params: scanner([180.0, 1.0], [0.0, 30.0], [0.005, 0.0]),
    },
    NamedScanner {
        name: "lms-291",
        about: "SICK LMS 291, a step of 0.5 degrees: 180 degrees, 30 m",
        // A standard deviation of 10 mm.
        params: scanner([180.0, 0.5], [0.0, 30.0], [0.01, 0.0]),
    },
    NamedScanner {
        name: "urg-04lx",
        about: "Hokuyo URG-04LX: 240 degrees, 4 m",
        // 10 mm up to 1 m, 1 % beyond; 1,024 steps a turn.
        params: scanner([240.0, 360.0 / 1024.0], [0.06, 4.0], [0.005, 0.005]),
    },
];

/// A scanner with this field of view and step in degrees, limits of its range in metres, and noise: a length, and a part
/// of the range.
const fn scanner(
    [field_of_view, angular_step]: [f64; 2],
    [least_range, range]: [f64; 2],
    [noise, range_noise]: [f64; 2],
) -> ScannerParams {
    ScannerParams {
        field_of_view,
        angular_step,
        least_range,
        range,
        noise,
        range_noise,
        ..ScannerParams::DEFAULT
    }
}

impl ScannerParams {
    /// The scanner with this name in [`SCANNERS`], in the usual building.
    pub fn named(name: &str) -> Option<Self> {
        let scanner = SCANNERS.iter().find(|scanner| scanner.name.eq_ignore_ascii_case(name));
        scanner.map(|scanner| scanner.params)
    }
}
