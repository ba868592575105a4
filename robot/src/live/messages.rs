//! What is read of the messages of a live robot. Their encodings are those of ROS 1 and ROS 2.
//!
//! RawBytes from outside are not trusted: a body that is too short or too long is rejected, and no memory is allocated for a
//! length that the body does not have.

use std::fmt;

use serde::{Deserialize, Deserializer, de::Visitor};
use toposlam_logs::{
    Mount,
    messages::Stamp,
    standard::{
        BASE, CompressedImage, Header, LaserScanMessage, OdometryMessage, PoseMessage, PoseStamped,
        Twist,
    },
};
use toposlam_model::driving::{
    odometry,
    scene::{MarkerView, undirected},
};
use toposlam_vision::laser::scan::{Scan, ScanGeometry};

use crate::superscout::WheelSpeeds;

/// Nanoseconds since the beginning of 1970, or since a robot was switched on.
pub type Nanoseconds = u64;

pub const SECOND: Nanoseconds = 1_000_000_000;

/// What is read of odometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reckoning {
    /// When it was measured.
    pub stamp: Nanoseconds,
    /// The robot's pose by odometry.
    pub at: odometry::Odometry,
    /// How fast the robot goes by it, and turns.
    pub wheels: WheelSpeeds,
}

/// What is read of another message, and its stamp.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stamped<T> {
    pub(crate) stamp: Nanoseconds,
    pub(crate) content: T,
}

/// The readings of a scanner in a frame.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ScanReading {
    pub(crate) frame: String,
    geometry: ScanGeometry,
    ranges: Vec<f32>,
}

/// RawBytes or a text, after their length; a text need not be UTF-8.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct RawBytes(pub(crate) Vec<u8>);

impl RawBytes {
    /// The text, without the zero byte that may end it.
    pub(crate) fn text(&self) -> String {
        String::from_utf8_lossy(self.0.strip_suffix(&[0]).unwrap_or(&self.0)).into_owned()
    }
}

impl<'d> Deserialize<'d> for RawBytes {
    fn deserialize<D: Deserializer<'d>>(from: D) -> Result<Self, D::Error> {
        struct Whole;
        impl Visitor<'_> for Whole {
            type Value = RawBytes;

            fn expecting(&self, out: &mut fmt::Formatter) -> fmt::Result {
                out.write_str("bytes")
            }

            fn visit_byte_buf<E>(self, bytes: Vec<u8>) -> Result<RawBytes, E> {
                Ok(RawBytes(bytes))
            }
        }
        from.deserialize_byte_buf(Whole)
    }
}

/// The odometry of a message; `None` if a number in it is not finite.
pub(crate) fn reckoning(message: OdometryMessage<RawBytes>) -> Option<Reckoning> {
    let OdometryMessage { header, pose, twist, .. } = message;
    let (at, wheels) = (pose.pose.to_floor()?, wheel_speeds(twist.twist));
    Some(Reckoning { stamp: nanoseconds(header.stamp), at, wheels })
}

/// The message of odometry.
pub(crate) fn odometry_message(Reckoning { stamp, at, wheels }: &Reckoning) -> OdometryMessage {
    OdometryMessage::new(time(*stamp), at, twist_of(*wheels))
}

/// The file of an image.
pub(crate) fn image_file(message: CompressedImage<RawBytes, RawBytes>) -> Stamped<Vec<u8>> {
    Stamped { stamp: nanoseconds(message.header.stamp), content: message.data.0 }
}

pub(crate) fn scan_reading(message: LaserScanMessage<Vec<f32>, RawBytes>) -> Stamped<ScanReading> {
    let geometry = ScanGeometry {
        angle_min: message.angle_min.into(),
        angle_increment: message.angle_increment.into(),
        range_min: message.range_min.into(),
        range_max: message.range_max.into(),
    };
    let frame = message.header.frame_id.text();
    let content = ScanReading { frame, geometry, ranges: message.ranges };
    Stamped { stamp: nanoseconds(message.header.stamp), content }
}

impl ScanReading {
    /// The scan of a scanner with this mount; `None` if it is no scan.
    pub(crate) fn scan(self, mount: &Mount) -> Option<Scan> {
        Scan::new(mount.seen_from_above(self.geometry), self.ranges, mount.robot_from_scanner).ok()
    }
}

/// The message of a marker in the robot's frame.
pub(crate) fn marker_message(stamp: Nanoseconds, marker: &MarkerView) -> PoseStamped {
    let at = odometry::Odometry { position: marker.position, heading: marker.axis };
    let header = Header { stamp: time(stamp), frame_id: BASE };
    PoseStamped { header, pose: PoseMessage::on_floor(&at) }
}

/// The marker of a message; `None` if a number in it is not finite.
pub(crate) fn marker_view(message: &PoseStamped<RawBytes>) -> Option<Stamped<MarkerView>> {
    let odometry::Odometry { position, heading } = message.pose.to_floor()?;
    let marker = MarkerView { position, axis: undirected(heading), door: None };
    Some(Stamped { stamp: nanoseconds(message.header.stamp), content: marker })
}

/// A time. In ROS 1 the seconds have no sign.
pub(crate) fn time(stamp: Nanoseconds) -> Stamp {
    Stamp { sec: ((stamp / SECOND) as u32).cast_signed(), nanosec: (stamp % SECOND) as u32 }
}

pub(crate) fn nanoseconds(Stamp { sec, nanosec }: Stamp) -> Nanoseconds {
    u64::from(sec.cast_unsigned()) * SECOND + u64::from(nanosec)
}

pub(crate) fn twist_of(wheels: WheelSpeeds) -> Twist {
    Twist::new(wheels.speed(), wheels.turn_rate())
}

/// Within the limits of a SuperScout; a stop if a number is not finite.
pub(crate) fn wheel_speeds(twist: Twist) -> WheelSpeeds {
    let (speed, turning) = (twist.linear.x, twist.angular.z);
    if speed.is_finite() && turning.is_finite() {
        WheelSpeeds::from_motion(speed, turning)
    } else {
        WheelSpeeds::STOP
    }
}
