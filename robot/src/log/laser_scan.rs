//! Scans as ROS publishes them: `sensor_msgs/LaserScan`.

use toposlam_vision::laser::scan::{Scan, ScanGeometry, ScannerPose};

use super::value::Value;

/// The scan in a message, or why it has none.
pub(super) fn scan_of(message: &Value<'_>) -> Result<Scan, String> {
    let number = |name: &str| {
        let found = message.at(name).and_then(|value| value.f64());
        found.ok_or_else(|| format!("it has no number `{name}`"))
    };
    let geometry = ScanGeometry {
        angle_min: number("angle_min")?,
        angle_increment: number("angle_increment")?,
        range_min: number("range_min")?,
        range_max: number("range_max")?,
    };
    let ranges = match message.at("ranges") {
        Some(Value::Numbers(ranges)) => ranges.iter().map(|range| range.f64()).collect(),
        _ => None,
    };
    let ranges: Vec<f64> = ranges.ok_or("it has no list of numbers `ranges`")?;
    let ranges = ranges.into_iter().map(|range| range as f32).collect();
    Scan::new(geometry, ranges, ScannerPose::default()).map_err(|error| error.to_string())
}
