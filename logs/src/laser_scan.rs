//! Scans as ROS publishes them: `sensor_msgs/LaserScan`.

use toposlam_vision::laser::scan::{Scan, ScanGeometry};

use super::{transforms::Mount, value::Value};

/// The frame of the scanner in a message.
pub(super) fn frame(message: &Value<'_>) -> String {
    let frame = message.at("header.frame_id");
    frame.and_then(|frame| Some(frame.text()?.into_owned())).unwrap_or_default()
}

/// The scan in a message, or why it has none.
pub(super) fn scan_of(message: &Value<'_>, mount: &Mount) -> Result<Scan, String> {
    let number = |name: &str| {
        let found = message.at(name).and_then(|value| value.f64());
        found.ok_or_else(|| format!("it has no number `{name}`"))
    };
    let sense = if mount.is_upside_down { -1.0 } else { 1.0 };
    let geometry = ScanGeometry {
        angle_min: sense * number("angle_min")?,
        angle_increment: sense * number("angle_increment")?,
        range_min: number("range_min")?,
        range_max: number("range_max")?,
    };
    let ranges = match message.at("ranges") {
        Some(Value::Numbers(ranges)) => ranges.iter().map(|range| range.f64()).collect(),
        _ => None,
    };
    let ranges: Vec<f64> = ranges.ok_or("it has no list of numbers `ranges`")?;
    let ranges = ranges.into_iter().map(|range| range as f32).collect();
    Scan::new(geometry, ranges, mount.robot_from_scanner).map_err(|error| error.to_string())
}
