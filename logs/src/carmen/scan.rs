//! The scan and the odometry in a line of a laser scanner.

use std::f64::consts::{FRAC_PI_2, PI};

use toposlam_model::driving::{odometry::Odometry, scene::wrapped};
use toposlam_vision::{
    geometry::from_robot,
    laser::scan::{Scan, ScanGeometry},
};

use super::Parameters;
use crate::{scan_convention::ScanRepairs, value::Value};

/// At this range the SICK scanners of these robots see nothing; 81.9 m is their sign of an error.
const OLD_RANGE: f64 = 50.0;

pub(crate) struct RecordedScan {
    pub(crate) scan: Scan,
    /// `None` if only other lines have it.
    pub(crate) odometry: Option<Odometry>,
}

/// A scanner is within this distance of the centre of its robot, in metres.
const REACH: f64 = 2.0;

/// The scan in a line of one of the kinds that have one.
pub(crate) fn reading(
    type_name: &str,
    line: &Value<'_>,
    parameters: &Parameters,
    repairs: &mut ScanRepairs,
) -> Result<RecordedScan, String> {
    let ranges = line.at("ranges").and_then(|ranges| ranges.elements());
    let ranges = ranges.ok_or("it has no list `ranges`")?;
    let ranges: Vec<_> =
        ranges.iter().map(|range| repairs.range(range.f64().unwrap_or(f64::NAN))).collect();
    let is_rear = matches!(type_name, "carmen/RLASER" | "carmen/RAWLASER2" | "carmen/ROBOTLASER2");
    let mount = if is_rear { parameters.rear } else { parameters.front };
    let odometry = match line.at("odom_x") {
        Some(_) => Some(pose(line, ["odom_x", "odom_y", "odom_theta"])?),
        None => None,
    };
    let recorded = match (line.at("laser_x"), &odometry) {
        (Some(_), Some(odometry)) => {
            let scanner = pose(line, ["laser_x", "laser_y", "laser_theta"])?;
            // In a corrected log the pose of the scanner is the corrected one.
            let recorded = from_robot(odometry).inverse() * from_robot(&scanner);
            Some(recorded).filter(|mount| mount.translation.vector.norm() <= REACH)
        }
        _ => None,
    };
    let geometry = match line.at("start_angle") {
        Some(_) => geometry(line, repairs)?,
        None => old_geometry(ranges.len()),
    };
    let scan = Scan::new(geometry, ranges, recorded.unwrap_or(mount.on_robot()));
    Ok(RecordedScan { scan: scan.map_err(|error| error.to_string())?, odometry })
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

fn geometry(line: &Value<'_>, repairs: &ScanRepairs) -> Result<ScanGeometry, String> {
    let most = line.finite_at("maximum_range")?;
    Ok(ScanGeometry {
        angle_min: line.finite_at("start_angle")?,
        angle_increment: line.finite_at("angular_resolution")?,
        range_min: 0.0,
        range_max: repairs.range_max(if most > 0.0 { most } else { OLD_RANGE }),
    })
}

fn pose(line: &Value<'_>, names: [&str; 3]) -> Result<Odometry, String> {
    let [x, y, heading] = names.map(|name| line.finite_at(name));
    Ok(Odometry { position: [x?, y?], heading: wrapped(heading?) })
}
