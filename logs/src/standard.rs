//! The messages of ROS that logs hold and that live robots exchange. Their fields have the order of their definitions,
//! in `logs/msgs`. The texts of a message that is written are `&'static str`; another type reads any bytes.
//!
//! x ahead, y to the left, metres, radians counter-clockwise (REP 103); `base_link` moves in `odom` (REP 105).

use nalgebra::Isometry2;
use serde::{Deserialize, Serialize, Serializer};
use toposlam_model::driving::odometry;
use toposlam_vision::laser::scan::{Scan, ScanGeometry};

use super::{message::Message, stamp::Stamp};

pub const ODOM: &str = "odom";
pub const BASE: &str = "base_link";
pub const CAMERA: &str = "camera";
/// The frame of a scanner that is not in the robot's centre.
const SCANNER: &str = "laser";

macro_rules! messages {
    ($($type:ty: $package:literal $name:literal;)*) => {$(
        impl Message for $type {
            const TYPE: &'static str = concat!($package, "/msg/", $name);
            const DEFINITION: &'static str =
                include_str!(concat!("../msgs/", $package, "/msg/", $name, ".msg"));
        }
    )*};
}

messages! {
    CompressedImage<FileBytes<'_>>: "sensor_msgs" "CompressedImage";
    RawImage<FileBytes<'_>>: "sensor_msgs" "Image";
    LaserScanMessage<&[f32]>: "sensor_msgs" "LaserScan";
    Twist: "geometry_msgs" "Twist";
    TwistStamped: "geometry_msgs" "TwistStamped";
    ClockMessage: "rosgraph_msgs" "Clock";
    PoseStamped: "geometry_msgs" "PoseStamped";
    OdometryMessage: "nav_msgs" "Odometry";
    TFMessage<'_>: "tf2_msgs" "TFMessage";
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Header<T = &'static str> {
    pub stamp: Stamp,
    pub frame_id: T,
}

/// The bytes of a file. They are written as one piece, not one by one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileBytes<'a>(pub &'a [u8]);

impl Serialize for FileBytes<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_bytes(self.0)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CompressedImage<D, T = &'static str> {
    pub header: Header<T>,
    pub format: T,
    pub data: D,
}

impl<'a> CompressedImage<FileBytes<'a>> {
    /// An image; its first bytes determine its format, which is empty if it is not known.
    pub fn new(taken: Stamp, data: &'a [u8]) -> Self {
        let format = match data {
            [0xff, 0xd8, 0xff, ..] => "jpeg",
            [0x89, b'P', b'N', b'G', ..] => "png",
            _ => "",
        };
        let header = Header { stamp: taken, frame_id: CAMERA };
        Self { header, format, data: FileBytes(data) }
    }
}

/// An image as pixels, row by row; a row takes `step` bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RawImage<D, T = &'static str> {
    pub header: Header<T>,
    pub height: u32,
    pub width: u32,
    pub encoding: T,
    pub is_bigendian: u8,
    pub step: u32,
    pub data: D,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LaserScanMessage<L, T = &'static str> {
    pub header: Header<T>,
    pub angle_min: f32,
    pub angle_max: f32,
    pub angle_increment: f32,
    pub time_increment: f32,
    pub scan_time: f32,
    pub range_min: f32,
    pub range_max: f32,
    pub ranges: L,
    pub intensities: L,
}

impl<'a> LaserScanMessage<&'a [f32]> {
    pub fn new(taken: Stamp, scan: &'a Scan) -> Self {
        let ScanGeometry { angle_min, angle_increment, range_min, range_max } = scan.geometry();
        let ranges = scan.ranges();
        let angle_max = angle_min + angle_increment * ranges.len().saturating_sub(1) as f64;
        let is_centred = scan.robot_from_scanner() == Isometry2::identity();
        Self {
            header: Header { stamp: taken, frame_id: if is_centred { BASE } else { SCANNER } },
            angle_min: angle_min as f32,
            angle_max: angle_max as f32,
            angle_increment: angle_increment as f32,
            time_increment: 0.0,
            scan_time: 0.0,
            range_min: range_min as f32,
            range_max: range_max as f32,
            ranges,
            intensities: &[],
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Vector3 {
    pub x: f64,
    pub y: f64,
    pub z: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quaternion {
    pub x: f64,
    pub y: f64,
    pub z: f64,
    pub w: f64,
}

impl Quaternion {
    /// A turn on the spot, counter-clockwise.
    pub fn turn(angle: f64) -> Self {
        let (sine, cosine) = (angle / 2.0).sin_cos();
        Self { x: 0.0, y: 0.0, z: sine, w: cosine }
    }

    /// The turn about the vertical axis, counter-clockwise, of a body with x ahead and y to its left
    /// (REP 103). The length does not matter, since some writers do not keep it at 1; `None` if it is 0 or
    /// not finite.
    pub fn heading(self) -> Option<f64> {
        let Self { x, y, z, w } = self;
        let norm = x * x + y * y + z * z + w * w;
        (norm.is_finite() && norm > 1e-6)
            .then(|| (2.0 * (w * z + x * y)).atan2(w * w + x * x - y * y - z * z))
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Twist {
    pub linear: Vector3,
    pub angular: Vector3,
}

impl Twist {
    pub fn new(speed: f64, turning: f64) -> Self {
        let linear = Vector3 { x: speed, ..Vector3::default() };
        Self { linear, angular: Vector3 { z: turning, ..Vector3::default() } }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TwistStamped<T = &'static str> {
    pub header: Header<T>,
    pub twist: Twist,
}

/// The present time, where it is not that of the system.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ClockMessage {
    pub clock: Stamp,
}

/// The covariance of six numbers; zeros: unknown.
pub type Covariance = [[f64; 6]; 6];

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PoseMessage {
    pub position: Vector3,
    pub orientation: Quaternion,
}

impl PoseMessage {
    pub fn on_floor(at: &odometry::Odometry) -> Self {
        let [x, y] = at.position;
        Self { position: Vector3 { x, y, z: 0.0 }, orientation: Quaternion::turn(at.heading) }
    }

    /// The pose on the floor. `None` if a number is not finite or there is no orientation.
    pub fn to_floor(self) -> Option<odometry::Odometry> {
        let Vector3 { x, y, .. } = self.position;
        let heading = self.orientation.heading()?;
        let is_finite = x.is_finite() && y.is_finite();
        is_finite.then_some(odometry::Odometry { position: [x, y], heading })
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PoseStamped<T = &'static str> {
    pub header: Header<T>,
    pub pose: PoseMessage,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PoseWithCovariance {
    pub pose: PoseMessage,
    pub covariance: Covariance,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TwistWithCovariance {
    pub twist: Twist,
    pub covariance: Covariance,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OdometryMessage<T = &'static str> {
    pub header: Header<T>,
    pub child_frame_id: T,
    pub pose: PoseWithCovariance,
    pub twist: TwistWithCovariance,
}

impl OdometryMessage {
    pub fn new(stamp: Stamp, at: &odometry::Odometry, twist: Twist) -> Self {
        let pose = PoseMessage::on_floor(at);
        let covariance = Covariance::default();
        Self {
            header: Header { stamp, frame_id: ODOM },
            child_frame_id: BASE,
            pose: PoseWithCovariance { pose, covariance },
            twist: TwistWithCovariance { twist, covariance },
        }
    }

    /// The same, as the frame of the robot in that of odometry.
    pub fn transform(&self) -> TransformStamped {
        let PoseMessage { position, orientation } = self.pose.pose;
        TransformStamped {
            header: self.header,
            child_frame_id: self.child_frame_id,
            transform: Transform { translation: position, rotation: orientation },
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Transform {
    pub translation: Vector3,
    pub rotation: Quaternion,
}

/// Where one frame is in another, and when.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TransformStamped {
    pub header: Header,
    pub child_frame_id: &'static str,
    pub transform: Transform,
}

impl TransformStamped {
    /// Where the scanner of a scan is on the robot; `None` if it is in its centre, whose frame the scan has.
    pub fn of_scanner(stamp: Stamp, scan: &Scan) -> Option<Self> {
        let mount = scan.robot_from_scanner();
        let [x, y] = mount.translation.vector.into();
        let transform = Transform {
            translation: Vector3 { x, y, z: 0.0 },
            rotation: Quaternion::turn(mount.rotation.angle()),
        };
        let header = Header { stamp, frame_id: BASE };
        let is_mounted = mount != Isometry2::identity();
        is_mounted.then_some(Self { header, child_frame_id: SCANNER, transform })
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TFMessage<'a> {
    pub transforms: &'a [TransformStamped],
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;

    #[test]
    fn the_format_of_a_image_is_that_of_its_first_bytes() {
        let format = |bytes| CompressedImage::new(Stamp::default(), bytes).format;
        assert_eq!(format(&[0xff, 0xd8, 0xff, 0xe0]), "jpeg");
        assert_eq!(format(b"\x89PNG\r\n"), "png");
        assert_eq!((format(b""), format(b"GIF89a")), ("", ""));
    }

    #[test]
    fn the_heading_is_the_turn_about_the_vertical_axis() {
        for angle in [0.0, 1.0, FRAC_PI_2, 3.0, PI - 1e-9, -0.5, -3.0] {
            assert!((Quaternion::turn(angle).heading().unwrap() - angle).abs() < 1e-9, "{angle}");
        }
        let heading = |x, y, z, w| Quaternion { x, y, z, w }.heading();
        // The opposite quaternion is the same rotation, and so is one of another length.
        for length in [-3.0, 0.5] {
            assert!((heading(0.0, 0.0, length, length).unwrap() - FRAC_PI_2).abs() < 1e-12);
        }
        // On a slope the heading is the same.
        let (sine, cosine) = 0.1_f64.sin_cos();
        assert!(heading(sine, 0.0, 0.0, cosine).unwrap().abs() < 1e-12);
        assert_eq!(heading(0.0, 0.0, 0.0, 0.0), None);
        assert_eq!(heading(f64::MAX, 0.0, 0.0, 0.0), None);
    }
}
