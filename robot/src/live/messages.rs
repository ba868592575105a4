//! What is read of the messages of a live robot. Their encodings are those of ROS 1 and ROS 2.
//!
//! Messages are not trusted: a body that is too short or too long is rejected, and no memory is allocated for a length that
//! the body does not have.

use std::{fmt, io::Cursor};

use image::{ImageFormat, RgbImage};
use serde::{Deserialize, Deserializer, de::Visitor};
#[cfg(feature = "ros2")]
use toposlam_logs::standard::RawImage;
use toposlam_logs::{
    Mount,
    messages::Stamp,
    record::CameraImage,
    standard::{
        BASE, CompressedImage, Header, LaserScanMessage, OdometryMessage, PoseMessage, PoseStamped,
        Twist,
    },
};
use toposlam_model::driving::{
    odometry,
    scene::{MarkerView, undirected},
};
use toposlam_vision::laser::scan::{Scan, ScanError, ScanGeometry};

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

/// A marker in a frame.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MarkerReading {
    pub(crate) frame: String,
    pub(crate) marker: MarkerView,
}

/// The readings of a scanner in a frame.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ScanReading {
    pub(crate) frame: String,
    pub(super) geometry: ScanGeometry,
    pub(super) ranges: Vec<f32>,
}

/// Bytes or a text, after their length; a text need not be UTF-8.
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

/// An image as a camera's driver sends it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum SentImage {
    File(Vec<u8>),
    #[cfg_attr(not(feature = "ros2"), expect(dead_code, reason = "in ROS 1, only files are read"))]
    Pixels(RgbImage),
}

impl SentImage {
    /// The image as a file, which is what a log holds. Pixels become one without loss; `None` if that fails.
    pub(crate) fn file(self) -> Option<CameraImage> {
        match self {
            Self::File(file) => Some(CameraImage::encoded(file)),
            Self::Pixels(pixels) => {
                let mut file = Cursor::new(Vec::new());
                pixels.write_to(&mut file, ImageFormat::Png).ok()?;
                Some(CameraImage::encoded(file.into_inner()))
            }
        }
    }
}

/// The file of an image.
pub(crate) fn image_file(message: CompressedImage<RawBytes, RawBytes>) -> Stamped<SentImage> {
    let content = SentImage::File(message.data.0);
    Stamped { stamp: nanoseconds(message.header.stamp), content }
}

/// The pixels of an image; `None` if it has too few, or another encoding than `rgb8`, `bgr8` and `mono8`.
#[cfg(feature = "ros2")]
pub(crate) fn image_pixels(message: &RawImage<RawBytes, RawBytes>) -> Option<Stamped<SentImage>> {
    let encoding = message.encoding.text();
    let channels = match encoding.as_str() {
        "rgb8" | "bgr8" => 3,
        "mono8" => 1,
        _ => return None,
    };
    let [width, height, step] =
        [message.width, message.height, message.step].map(|number| number as usize);
    let row = width.checked_mul(channels).filter(|&row| 0 < row && row <= step)?;
    // No memory is allocated before it is known that the pixels are there.
    let rows = message.data.0.chunks(step).take(height);
    if rows.len() != height || rows.clone().any(|bytes| bytes.len() < row) {
        return None;
    }
    let mut rgb = Vec::with_capacity(3 * width * height);
    for pixel in rows.flat_map(|bytes| bytes[..row].chunks(channels)) {
        match *pixel {
            [red, green, blue] if encoding == "rgb8" => rgb.extend([red, green, blue]),
            [blue, green, red] => rgb.extend([red, green, blue]),
            _ => rgb.extend([pixel[0]; 3]),
        }
    }
    let pixels = RgbImage::from_raw(message.width, message.height, rgb)?;
    let content = SentImage::Pixels(pixels);
    Some(Stamped { stamp: nanoseconds(message.header.stamp), content })
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
    /// The scan of a scanner with this mount.
    ///
    /// # Errors
    /// Returns an error if it is no scan.
    pub(crate) fn scan(self, mount: &Mount) -> Result<Scan, ScanError> {
        Scan::new(mount.seen_from_above(self.geometry), self.ranges, mount.robot_from_scanner)
    }
}

/// The message of a marker in the robot's frame.
pub(crate) fn marker_message(stamp: Nanoseconds, marker: &MarkerView) -> PoseStamped {
    let at = odometry::Odometry { position: marker.position, heading: marker.axis };
    let header = Header { stamp: time(stamp), frame_id: BASE };
    PoseStamped { header, pose: PoseMessage::on_floor(&at) }
}

/// The marker of a message; `None` if a number in it is not finite.
pub(crate) fn marker_reading(message: &PoseStamped<RawBytes>) -> Option<Stamped<MarkerReading>> {
    let odometry::Odometry { position, heading } = message.pose.to_floor()?;
    let marker = MarkerView { position, axis: undirected(heading), door: None };
    let content = MarkerReading { frame: message.header.frame_id.text(), marker };
    Some(Stamped { stamp: nanoseconds(message.header.stamp), content })
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
