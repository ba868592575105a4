//! Images and scans as ROS publishes them: `CompressedImage`, `Image` and `LaserScan` of `sensor_msgs`.

use image::RgbImage;
use toposlam_vision::laser::scan::{Scan, ScanGeometry};

use super::{scan_convention::ScanRepairs, transforms::Mount, value::Value};
use crate::record::CameraImage;

pub(super) fn image_of(message: &Value<'_>) -> Result<CameraImage, String> {
    let data = message.at("data").and_then(|data| data.bytes());
    let data = data.ok_or("it has no bytes `data`")?;
    let Some(encoding) = message.at("encoding").and_then(|encoding| encoding.text()) else {
        return Ok(CameraImage::encoded(data));
    };
    let number = |name| {
        let found = message.at(name).and_then(|value| u32::try_from(value.u64()?).ok());
        found.ok_or_else(|| format!("it has no number `{name}`"))
    };
    let [width, height, step] = [number("width")?, number("height")?, number("step")?];
    let (bytes, order): (u32, [usize; 3]) = match &*encoding {
        "rgb8" => (3, [0, 1, 2]),
        "bgr8" => (3, [2, 1, 0]),
        "mono8" => (1, [0, 0, 0]),
        other => {
            let other: String = other.chars().take(40).collect();
            return Err(format!(
                "pixels in {other:?} cannot be read; known are rgb8, bgr8 and mono8"
            ));
        }
    };
    let row = u64::from(width) * u64::from(bytes);
    // Checked before anything is allocated.
    if row == 0
        || height == 0
        || u64::from(step) < row
        || data.len() as u64 / u64::from(step) < height.into()
    {
        return Err(format!(
            "{} bytes are not {height} rows of {step} bytes with {width} pixels each",
            data.len()
        ));
    }
    let rows = data.chunks_exact(step as usize).take(height as usize);
    let pixels = rows
        .flat_map(|line| line.get(..row as usize).unwrap_or_default().chunks_exact(bytes as usize));
    let colours =
        pixels.flat_map(|pixel| order.map(|at| pixel.get(at).copied().unwrap_or_default()));
    let mut all = Vec::with_capacity((row / u64::from(bytes) * 3 * u64::from(height)) as usize);
    all.extend(colours);
    let made = RgbImage::from_raw(width, height, all);
    Ok(CameraImage::raw(made.ok_or("its size does not go with its pixels")?))
}

/// No angle of a scan is larger, in radians.
const LARGEST_ANGLE: f64 = 100.0;

pub(super) fn scan_of(
    message: &Value<'_>,
    mount: &Mount,
    repairs: &mut ScanRepairs,
) -> Result<Scan, String> {
    let ranges = match message.at("ranges") {
        Some(Value::Numbers(ranges)) => ranges.iter().map(|range| range.f64()).collect(),
        _ => None,
    };
    let ranges: Vec<f64> = ranges.ok_or("it has no list of numbers `ranges`")?;
    let [first, increment] =
        [message.number_at("angle_min")?, message.number_at("angle_increment")?];
    let last = message.number_at("angle_max").unwrap_or(f64::NAN);
    for (name, angle) in [("angle_min", first), ("angle_increment", increment)] {
        if angle.abs() > LARGEST_ANGLE {
            return Err(format!("its {name} is {angle}"));
        }
    }
    let increment = repairs.increment([first, last, increment], ranges.len())?;
    let geometry = mount.seen_from_above(ScanGeometry {
        angle_min: first,
        angle_increment: increment,
        range_min: message.number_at("range_min")?,
        range_max: repairs.range_max(message.number_at("range_max")?),
    });
    let ranges = ranges.into_iter().map(|range| repairs.range(range)).collect();
    Scan::new(geometry, ranges, mount.robot_from_scanner).map_err(|error| error.to_string())
}
