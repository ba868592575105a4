//! The messages of ROS that logs hold and that live robots exchange: images, laser scans, commands to the
//! wheels, odometry and the frames that it relates. Their fields have the order of their definitions, which are
//! in `robot/msgs`. The texts of a message that is written are `&'static str`; another type reads any bytes.
//!
//! x ahead, y to the left, metres, radians counter-clockwise (REP 103); the robot, `base_link`, moves in
//! the frame `odom` (REP 105).

use serde::{Deserialize, Serialize, Serializer};
use toposlam_model::driving::odometry;
use toposlam_vision::laser::scan::{Scan, ScanGeometry};

use super::{
    message::{Message, TIME, TypeDefinition, definition},
    messages::Stamp,
};

/// The frame of odometry.
pub const ODOM: &str = "odom";
/// The frame of the robot.
pub const BASE: &str = "base_link";
/// The frame of the camera.
pub const CAMERA: &str = "camera";

const HEADER: TypeDefinition = definition!("std_msgs", "Header");
const VECTOR: TypeDefinition = definition!("geometry_msgs", "Vector3");
const POINT: TypeDefinition = definition!("geometry_msgs", "Point");
const QUATERNION: TypeDefinition = definition!("geometry_msgs", "Quaternion");
const TWIST: TypeDefinition = definition!("geometry_msgs", "Twist");

/// When, and in which frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Header<T = &'static str> {
    /// When it was so.
    pub stamp: Stamp,
    /// The frame in which it is so.
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

/// The file of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CompressedImage<D, T = &'static str> {
    /// When it was taken, and by which camera.
    pub header: Header<T>,
    /// `jpeg` or `png`.
    pub format: T,
    /// The file.
    pub data: D,
}

impl Message for CompressedImage<FileBytes<'_>> {
    const TYPE: &'static str = "sensor_msgs/msg/CompressedImage";
    const DEFINITION: &'static str = definition!("sensor_msgs", "CompressedImage").text;
    const USES: &'static [TypeDefinition] = &[HEADER, TIME];
}

impl<'a> CompressedImage<FileBytes<'a>> {
    /// An image; its first bytes determine its format, which is empty if it is not known.
    #[must_use]
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

/// A sweep of a laser scanner in the robot's centre.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LaserScanMessage<L, T = &'static str> {
    /// When it was taken, and by which scanner.
    pub header: Header<T>,
    /// The angle of the first range, in radians counter-clockwise from ahead.
    pub angle_min: f32,
    /// That of the last one.
    pub angle_max: f32,
    /// From one to the next.
    pub angle_increment: f32,
    /// The time from one to the next, in seconds.
    pub time_increment: f32,
    /// The time from one sweep to the next, in seconds.
    pub scan_time: f32,
    /// Shorter ranges are invalid, in metres.
    pub range_min: f32,
    /// Longer ranges are invalid, in metres.
    pub range_max: f32,
    /// In metres; infinite without a return.
    pub ranges: L,
    /// None.
    pub intensities: L,
}

impl Message for LaserScanMessage<&[f32]> {
    const TYPE: &'static str = "sensor_msgs/msg/LaserScan";
    const DEFINITION: &'static str = definition!("sensor_msgs", "LaserScan").text;
    const USES: &'static [TypeDefinition] = &[HEADER, TIME];
}

impl<'a> LaserScanMessage<&'a [f32]> {
    /// A scan.
    #[must_use]
    pub fn new(taken: Stamp, scan: &'a Scan) -> Self {
        let ScanGeometry { angle_min, angle_increment, range_min, range_max } = scan.geometry();
        let ranges = scan.ranges();
        let angle_max = angle_min + angle_increment * ranges.len().saturating_sub(1) as f64;
        Self {
            header: Header { stamp: taken, frame_id: BASE },
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

/// A vector, or a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Vector3 {
    /// Ahead.
    pub x: f64,
    /// To the left.
    pub y: f64,
    /// Up.
    pub z: f64,
}

/// A rotation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quaternion {
    /// About ahead.
    pub x: f64,
    /// About left.
    pub y: f64,
    /// About up.
    pub z: f64,
    /// The real part.
    pub w: f64,
}

impl Quaternion {
    /// A turn on the spot, counter-clockwise.
    #[must_use]
    pub fn turn(angle: f64) -> Self {
        let (sine, cosine) = (angle / 2.0).sin_cos();
        Self { x: 0.0, y: 0.0, z: sine, w: cosine }
    }

    /// The turn about the vertical axis, counter-clockwise, of a body with x ahead and y to its left
    /// (REP 103). The length does not matter, since some writers do not keep it at 1; `None` if it is 0 or
    /// not finite.
    #[must_use]
    pub fn heading(self) -> Option<f64> {
        let Self { x, y, z, w } = self;
        let norm = x * x + y * y + z * z + w * w;
        (norm.is_finite() && norm > 1e-6)
            .then(|| (2.0 * (w * z + x * y)).atan2(w * w + x * x - y * y - z * z))
    }
}

/// How fast something moves and turns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Twist {
    /// Metres a second.
    pub linear: Vector3,
    /// Radians a second.
    pub angular: Vector3,
}

impl Message for Twist {
    const TYPE: &'static str = "geometry_msgs/msg/Twist";
    const DEFINITION: &'static str = TWIST.text;
    const USES: &'static [TypeDefinition] = &[VECTOR];
}

impl Twist {
    /// So fast ahead, and turning so fast.
    #[must_use]
    pub fn new(speed: f64, turning: f64) -> Self {
        let linear = Vector3 { x: speed, ..Vector3::default() };
        Self { linear, angular: Vector3 { z: turning, ..Vector3::default() } }
    }
}

/// The covariance of six numbers; zeros: unknown.
pub type Covariance = [[f64; 6]; 6];

/// A position and orientation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PoseMessage {
    /// Its place.
    pub position: Vector3,
    /// Its orientation.
    pub orientation: Quaternion,
}

impl PoseMessage {
    /// A pose on the floor.
    #[must_use]
    pub fn on_floor(at: &odometry::Odometry) -> Self {
        let [x, y] = at.position;
        Self { position: Vector3 { x, y, z: 0.0 }, orientation: Quaternion::turn(at.heading) }
    }

    /// The pose on the floor. `None` if a number is not finite or there is no orientation.
    #[must_use]
    pub fn to_floor(self) -> Option<odometry::Odometry> {
        let Vector3 { x, y, .. } = self.position;
        let heading = self.orientation.heading()?;
        let is_finite = x.is_finite() && y.is_finite();
        is_finite.then_some(odometry::Odometry { position: [x, y], heading })
    }
}

/// A pose in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PoseStamped<T = &'static str> {
    /// When, in which frame.
    pub header: Header<T>,
    /// The pose.
    pub pose: PoseMessage,
}

impl Message for PoseStamped {
    const TYPE: &'static str = "geometry_msgs/msg/PoseStamped";
    const DEFINITION: &'static str = definition!("geometry_msgs", "PoseStamped").text;
    const USES: &'static [TypeDefinition] =
        &[HEADER, TIME, definition!("geometry_msgs", "Pose"), POINT, QUATERNION];
}

/// A pose with its covariance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PoseWithCovariance {
    /// The pose.
    pub pose: PoseMessage,
    /// Its covariance.
    pub covariance: Covariance,
}

/// A velocity with its covariance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TwistWithCovariance {
    /// How fast.
    pub twist: Twist,
    /// Its covariance.
    pub covariance: Covariance,
}

/// The robot's odometry.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OdometryMessage<T = &'static str> {
    /// When, in which frame.
    pub header: Header<T>,
    /// The frame that is there, and in which the twist is.
    pub child_frame_id: T,
    /// Where it is.
    pub pose: PoseWithCovariance,
    /// How fast it moves.
    pub twist: TwistWithCovariance,
}

impl Message for OdometryMessage {
    const TYPE: &'static str = "nav_msgs/msg/Odometry";
    const DEFINITION: &'static str = definition!("nav_msgs", "Odometry").text;
    const USES: &'static [TypeDefinition] = &[
        HEADER,
        TIME,
        definition!("geometry_msgs", "PoseWithCovariance"),
        definition!("geometry_msgs", "Pose"),
        POINT,
        QUATERNION,
        definition!("geometry_msgs", "TwistWithCovariance"),
        TWIST,
        VECTOR,
    ];
}

impl OdometryMessage {
    /// Odometry with a velocity.
    #[must_use]
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
    #[must_use]
    pub fn transform(&self) -> TransformStamped {
        let PoseMessage { position, orientation } = self.pose.pose;
        TransformStamped {
            header: self.header,
            child_frame_id: self.child_frame_id,
            transform: Transform { translation: position, rotation: orientation },
        }
    }
}

/// The transform between two frames.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Transform {
    /// Where its origin is.
    pub translation: Vector3,
    /// How it is turned.
    pub rotation: Quaternion,
}

/// Where one frame is in another, and when.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TransformStamped {
    /// When, in which frame.
    pub header: Header,
    /// Which frame.
    pub child_frame_id: &'static str,
    /// Where it is.
    pub transform: Transform,
}

/// Transforms between frames.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TFMessage<'a> {
    /// Each of them.
    pub transforms: &'a [TransformStamped],
}

impl Message for TFMessage<'_> {
    const TYPE: &'static str = "tf2_msgs/msg/TFMessage";
    const DEFINITION: &'static str = definition!("tf2_msgs", "TFMessage").text;
    const USES: &'static [TypeDefinition] = &[
        definition!("geometry_msgs", "TransformStamped"),
        HEADER,
        TIME,
        definition!("geometry_msgs", "Transform"),
        VECTOR,
        QUATERNION,
    ];
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;
    use crate::message::schema;

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

    #[test]
    fn a_half_turn_is_all_about_up() {
        let Quaternion { x, y, z, w } = Quaternion::turn(PI);
        assert_eq!((x, y), (0.0, 0.0));
        assert!((z - 1.0).abs() < 1e-12 && w.abs() < 1e-12, "{z} {w}");
    }

    /// A type that is neither a number nor a word is defined in the same schema.
    fn closed<M: Message>() {
        let text = schema::<M>();
        let defined: Vec<_> = text.lines().filter_map(|line| line.strip_prefix("MSG: ")).collect();
        let mut used = Vec::new();
        for line in text.lines().filter(|line| !line.starts_with(['#', '=', 'M'])) {
            let kind = line.split([' ', '[']).next().unwrap_or_default();
            if kind.contains('/') && !used.contains(&kind) {
                used.push(kind);
            }
        }
        used.sort_unstable();
        let mut sorted = defined.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, used, "{text}");
    }

    #[test]
    fn every_definition_comes_with_those_that_it_uses_and_no_others() {
        closed::<CompressedImage<FileBytes>>();
        closed::<LaserScanMessage<&[f32]>>();
        closed::<PoseStamped>();
        closed::<Twist>();
        closed::<OdometryMessage>();
        closed::<TFMessage>();
        closed::<crate::messages::Percept>();
    }
}
