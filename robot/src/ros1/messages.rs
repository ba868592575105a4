//! The messages of ROS 1 that a SuperScout's nodes exchange, and their encoding.
//!
//! Bytes from outside are not trusted: a body that is too short or too long is rejected, and no memory
//! is allocated for a length that the body does not have.

use std::fmt;

use roslibrust_serde_rosmsg::{from_slice_known_length, to_vec_skip_length};
use serde::{
    Deserialize, Deserializer, Serialize,
    de::{DeserializeOwned, Visitor},
};
use toposlam_logs::{
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
pub(super) struct Stamped<T> {
    pub(super) stamp: Nanoseconds,
    pub(super) content: T,
}

/// A message that begins with a header. In ROS 1 a header begins with a sequence number.
type Numbered<M> = (u32, M);

/// Bytes or a text, after their length; a text need not be UTF-8.
struct Bytes(Vec<u8>);

impl<'d> Deserialize<'d> for Bytes {
    fn deserialize<D: Deserializer<'d>>(from: D) -> Result<Self, D::Error> {
        struct Whole;
        impl Visitor<'_> for Whole {
            type Value = Bytes;

            fn expecting(&self, out: &mut fmt::Formatter) -> fmt::Result {
                out.write_str("bytes")
            }

            fn visit_byte_buf<E>(self, bytes: Vec<u8>) -> Result<Bytes, E> {
                Ok(Bytes(bytes))
            }
        }
        from.deserialize_byte_buf(Whole)
    }
}

/// The message that a body is; `None` if it is too short or too long. A length beyond the end of the
/// body is an error before anything is allocated for it.
fn read<T: DeserializeOwned>(bytes: &[u8]) -> Option<T> {
    from_slice_known_length(bytes, u32::try_from(bytes.len()).ok()?).ok()
}

/// The body of a message.
fn write(message: &impl Serialize) -> Vec<u8> {
    // Numbers, texts and lists of known length can always be written to memory.
    to_vec_skip_length(message).unwrap_or_default()
}

/// The body of a command to the wheels.
pub(super) fn twist(wheels: WheelSpeeds) -> Vec<u8> {
    write(&twist_of(wheels))
}

/// The command to the wheels; `None` if it is no such message.
pub fn read_twist(bytes: &[u8]) -> Option<WheelSpeeds> {
    read(bytes).map(wheel_speeds)
}

/// The body of odometry.
pub fn odometry(number: u32, reckoning: &Reckoning) -> Vec<u8> {
    write(&(number, odometry_message(reckoning)))
}

fn odometry_message(Reckoning { stamp, at, wheels }: &Reckoning) -> OdometryMessage {
    OdometryMessage::new(time(*stamp), at, twist_of(*wheels))
}

/// The odometry; `None` if it is no such message, or a number in it is not finite.
pub(super) fn read_odometry(bytes: &[u8]) -> Option<Reckoning> {
    let (_, OdometryMessage { header, pose, twist, .. }) =
        read::<Numbered<OdometryMessage<Bytes>>>(bytes)?;
    let (at, wheels) = (pose.pose.to_floor()?, wheel_speeds(twist.twist));
    Some(Reckoning { stamp: nanoseconds(header.stamp), at, wheels })
}

/// The body of the transform from the frame of odometry to the robot.
pub fn frames(number: u32, reckoning: &Reckoning) -> Vec<u8> {
    write(&vec![(number, odometry_message(reckoning).transform())])
}

/// The body of an image.
pub fn image(number: u32, stamp: Nanoseconds, file: &[u8]) -> Vec<u8> {
    write(&(number, CompressedImage::new(time(stamp), file)))
}

/// An image; `None` if it is no such message.
pub(super) fn read_image(bytes: &[u8]) -> Option<Stamped<Vec<u8>>> {
    let (_, CompressedImage { header, data: Bytes(file), .. }) =
        read::<Numbered<CompressedImage<Bytes, Bytes>>>(bytes)?;
    Some(Stamped { stamp: nanoseconds(header.stamp), content: file })
}

/// The body of a scan.
pub fn scan(number: u32, stamp: Nanoseconds, scan: &Scan) -> Vec<u8> {
    write(&(number, LaserScanMessage::new(time(stamp), scan)))
}

/// A scan; `None` if it is no such message, or no scan.
pub(super) fn read_scan(bytes: &[u8]) -> Option<Stamped<Scan>> {
    let (_, message) = read::<Numbered<LaserScanMessage<Vec<f32>, Bytes>>>(bytes)?;
    let geometry = ScanGeometry {
        angle_min: message.angle_min.into(),
        angle_increment: message.angle_increment.into(),
        range_min: message.range_min.into(),
        range_max: message.range_max.into(),
    };
    let scan = Scan::new(geometry, message.ranges, nalgebra::Isometry2::identity()).ok()?;
    Some(Stamped { stamp: nanoseconds(message.header.stamp), content: scan })
}

/// The body of the marker's pose in the robot's frame.
pub fn marker(number: u32, stamp: Nanoseconds, marker: &MarkerView) -> Vec<u8> {
    let at = odometry::Odometry { position: marker.position, heading: marker.axis };
    let header = Header { stamp: time(stamp), frame_id: BASE };
    write(&(number, PoseStamped { header, pose: PoseMessage::on_floor(&at) }))
}

/// The marker; `None` if it is no such message, or a number in it is not finite.
pub(super) fn read_marker(bytes: &[u8]) -> Option<Stamped<MarkerView>> {
    let (_, PoseStamped { header, pose }) = read::<Numbered<PoseStamped<Bytes>>>(bytes)?;
    let odometry::Odometry { position, heading } = pose.to_floor()?;
    let marker = MarkerView { position, axis: undirected(heading), door: None };
    Some(Stamped { stamp: nanoseconds(header.stamp), content: marker })
}

/// A time. In ROS 1 the seconds have no sign.
fn time(stamp: Nanoseconds) -> Stamp {
    Stamp { sec: ((stamp / SECOND) as u32).cast_signed(), nanosec: (stamp % SECOND) as u32 }
}

fn nanoseconds(Stamp { sec, nanosec }: Stamp) -> Nanoseconds {
    u64::from(sec.cast_unsigned()) * SECOND + u64::from(nanosec)
}

fn twist_of(wheels: WheelSpeeds) -> Twist {
    Twist::new(wheels.speed(), wheels.turn_rate())
}

/// Within the limits of a SuperScout; a stop if a number is not finite.
fn wheel_speeds(twist: Twist) -> WheelSpeeds {
    let (speed, turning) = (twist.linear.x, twist.angular.z);
    if speed.is_finite() && turning.is_finite() {
        WheelSpeeds::from_motion(speed, turning)
    } else {
        WheelSpeeds::STOP
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use toposlam_logs::standard::ODOM;

    use super::*;

    fn reckoning() -> Reckoning {
        let at = odometry::Odometry { position: [1.5, -0.25], heading: 2.5 };
        Reckoning { stamp: 3 * SECOND + 7, at, wheels: WheelSpeeds::from_motion(0.1, 0.2) }
    }

    #[test]
    fn what_is_written_is_read() {
        let read = read_odometry(&odometry(9, &reckoning())).unwrap();
        assert_eq!((read.stamp, read.at.position), (3 * SECOND + 7, [1.5, -0.25]));
        assert!((read.at.heading - 2.5).abs() < 1e-12, "{read:?}");
        let wheels = read_twist(&twist(reckoning().wheels)).unwrap();
        assert!((wheels.speed() - 0.1).abs() < 1e-12 && (wheels.turn_rate() - 0.2).abs() < 1e-12);
        let taken = Stamped { stamp: 5, content: vec![0xff, 0xd8, 1] };
        assert_eq!(read_image(&image(1, 5, &taken.content)), Some(taken));
        let late = Stamped { stamp: u64::from(u32::MAX) * SECOND + 1, content: Vec::new() };
        assert_eq!(read_image(&image(1, late.stamp, &[])), Some(late));
        let geometry = ScanGeometry {
            angle_min: -0.5,
            angle_increment: 0.25,
            range_min: 0.125,
            range_max: 30.0,
        };
        let sweep =
            Scan::new(geometry, vec![1.0, f32::INFINITY, 2.5], nalgebra::Isometry2::identity());
        let sweep = Stamped { stamp: 7, content: sweep.unwrap() };
        assert_eq!(read_scan(&scan(1, 7, &sweep.content)), Some(sweep));
        let found = MarkerView { position: [0.5, -0.25], axis: 1.0, door: None };
        let read = read_marker(&marker(1, 9, &found)).unwrap();
        assert_eq!((read.stamp, read.content.position), (9, found.position));
        assert!((read.content.axis - 1.0).abs() < 1e-12, "{read:?}");
    }

    #[test]
    fn a_twist_beyond_the_limits_is_cut_and_one_of_no_numbers_is_a_stop() {
        let body = |numbers: &[f64]| numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
        let read = |numbers: &[f64]| read_twist(&Vec::<u8>::clone(&body(numbers)));
        assert_eq!(read(&[9.0, 0.0, 0.0, 0.0, 0.0, 0.0]), Some(WheelSpeeds::from_motion(0.2, 0.0)));
        assert_eq!(read(&[f64::NAN, 0.0, 0.0, 0.0, 0.0, 0.1]), Some(WheelSpeeds::STOP));
        assert_eq!(read(&[0.0; 5]), None);
        assert_eq!(read(&[0.0; 7]), None);
    }

    /// As in a log: the length of a quaternion does not matter, and one of length 0 is no rotation.
    #[test]
    fn a_quaternion_of_any_length_is_the_same_heading() {
        let read = |quaternion: [f64; 4]| {
            let mut body = odometry(1, &reckoning());
            // Behind the header (12 bytes and a text), the text `base_link`, and the position.
            let at = 12 + (4 + ODOM.len()) + (4 + BASE.len()) + 24;
            for (bytes, number) in body[at..].chunks_exact_mut(8).zip(quaternion) {
                bytes.copy_from_slice(&number.to_le_bytes());
            }
            read_odometry(&body).map(|reckoning| reckoning.at.heading)
        };
        let quarter = std::f64::consts::FRAC_PI_2;
        assert!((read([0.0, 0.0, 0.5, 0.5]).unwrap() - quarter).abs() < 1e-12);
        assert_eq!(read([0.0; 4]), None);
    }

    #[test]
    fn a_length_that_is_not_there_allocates_nothing() {
        let mut body = image(1, 5, b"file");
        let at = body.len() - 8;
        body[at..at + 4].copy_from_slice(&u32::MAX.to_le_bytes());
        assert_eq!(read_image(&body), None);
    }

    #[test]
    fn odometry_with_a_number_that_is_not_finite_is_rejected() {
        let at = odometry::Odometry { position: [f64::NAN, 0.0], heading: 0.0 };
        assert_eq!(read_odometry(&odometry(1, &Reckoning { at, ..reckoning() })), None);
    }

    proptest! {
        #[test]
        fn no_bytes_are_too_strange(bytes in proptest::collection::vec(any::<u8>(), 0..1000)) {
            let _ = (read_twist(&bytes), read_odometry(&bytes), read_image(&bytes));
        }

        #[test]
        fn what_is_cut_off_is_none(left in 0..700_usize) {
            let body = odometry(9, &reckoning());
            prop_assert!(left >= body.len() || read_odometry(&body[..left]).is_none());
        }
    }
}
