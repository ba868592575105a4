//! The scan and the odometry in a line of a laser scanner.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Isometry2, Vector2};
use toposlam_model::driving::{odometry::Odometry, scene::wrapped};
use toposlam_vision::{
    geometry::from_robot,
    laser::scan::{Scan, ScanGeometry},
};

use super::Parameters;
use crate::value::Value;

/// At this range the SICK scanners of these robots see nothing; 81.9 m is their sign of an error.
const OLD_RANGE: f64 = 50.0;

pub(crate) struct RecordedScan {
    pub(crate) scan: Scan,
    pub(crate) odometry: Odometry,
}

/// The scan in a line of one of the types `carmen/FLASER`, `carmen/RLASER` and `carmen/ROBOTLASER1`.
pub(crate) fn reading(
    type_name: &str,
    line: &Value<'_>,
    parameters: &Parameters,
) -> Result<RecordedScan, String> {
    let ranges = line.at("ranges").and_then(|ranges| ranges.elements());
    let ranges = ranges.ok_or("it has no list `ranges`")?;
    let ranges: Vec<_> =
        ranges.iter().map(|range| range.f64().unwrap_or(f64::NAN) as f32).collect();
    let odometry = pose(line, ["odom_x", "odom_y", "odom_theta"])?;
    let (geometry, robot_from_scanner) = if type_name == "carmen/ROBOTLASER1" {
        let scanner = pose(line, ["laser_x", "laser_y", "laser_theta"])?;
        (geometry(line)?, from_robot(&odometry).inverse() * from_robot(&scanner))
    } else {
        let (ahead, heading) = match type_name {
            "carmen/RLASER" => (parameters.rear_offset, PI),
            _ => (parameters.front_offset, 0.0),
        };
        (old_geometry(ranges.len()), Isometry2::new(Vector2::new(ahead, 0.0), heading))
    };
    let scan =
        Scan::new(geometry, ranges, robot_from_scanner).map_err(|error| error.to_string())?;
    Ok(RecordedScan { scan, odometry })
}

/// The angles of a line that does not record them, by the number of its readings, as CARMEN guesses them.
/// The scanners of that time see half a circle.
fn old_geometry(readings: usize) -> ScanGeometry {
    let (first, increment) = match readings {
        180 | 181 => (-FRAC_PI_2, 1_f64.to_radians()),
        360 | 361 => (-FRAC_PI_2, 0.5_f64.to_radians()),
        // 100 degrees.
        201 => (-50_f64.to_radians(), 0.5_f64.to_radians()),
        401 => (-50_f64.to_radians(), 0.25_f64.to_radians()),
        other => (-FRAC_PI_2, PI / (other.max(2) - 1) as f64),
    };
    ScanGeometry {
        angle_min: first,
        angle_increment: increment,
        range_min: 0.0,
        range_max: OLD_RANGE,
    }
}

fn geometry(line: &Value<'_>) -> Result<ScanGeometry, String> {
    let most = line.finite_at("maximum_range")?;
    Ok(ScanGeometry {
        angle_min: line.finite_at("start_angle")?,
        angle_increment: line.finite_at("angular_resolution")?,
        range_min: 0.0,
        range_max: if most > 0.0 { most } else { OLD_RANGE },
    })
}

fn pose(line: &Value<'_>, names: [&str; 3]) -> Result<Odometry, String> {
    let [x, y, heading] = names.map(|name| line.finite_at(name));
    Ok(Odometry { position: [x?, y?], heading: wrapped(heading?) })
}
