//! The messages of ROS 1 that a SuperScout's nodes exchange, and their encoding.

use roslibrust_serde_rosmsg::{from_slice_known_length, to_vec_skip_length};
use serde::{Serialize, de::DeserializeOwned};
use toposlam_logs::standard::{CompressedImage, LaserScanMessage, OdometryMessage, PoseStamped};
use toposlam_model::driving::scene::MarkerView;
use toposlam_vision::laser::scan::Scan;

use crate::{
    live::messages::{
        MarkerReading, Nanoseconds, RawBytes, Reckoning, ScanReading, SentImage, Stamped,
        image_file, marker_message, marker_reading, odometry_message, reckoning, scan_reading,
        time, twist_of, wheel_speeds,
    },
    superscout::WheelSpeeds,
};

/// A message that begins with a header. In ROS 1 a header begins with a sequence number.
type Numbered<M> = (u32, M);

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
pub(super) fn read_twist(bytes: &[u8]) -> Option<WheelSpeeds> {
    read(bytes).map(wheel_speeds)
}

/// The body of odometry.
pub(super) fn odometry(number: u32, reckoning: &Reckoning) -> Vec<u8> {
    write(&(number, odometry_message(reckoning)))
}

/// The odometry; `None` if it is no such message, or a number in it is not finite.
pub(super) fn read_odometry(bytes: &[u8]) -> Option<Reckoning> {
    let (_, message) = read::<Numbered<OdometryMessage<RawBytes>>>(bytes)?;
    reckoning(message)
}

/// The body of the transform from the frame of odometry to the robot.
pub(super) fn frames(number: u32, reckoning: &Reckoning) -> Vec<u8> {
    write(&vec![(number, odometry_message(reckoning).transform())])
}

/// The body of an image.
pub(super) fn image(number: u32, stamp: Nanoseconds, file: &[u8]) -> Vec<u8> {
    write(&(number, CompressedImage::new(time(stamp), file)))
}

/// An image; `None` if it is no such message.
pub(super) fn read_image(bytes: &[u8]) -> Option<Stamped<SentImage>> {
    let (_, message) = read::<Numbered<CompressedImage<RawBytes, RawBytes>>>(bytes)?;
    Some(image_file(message))
}

/// The body of a scan.
pub(super) fn scan(number: u32, stamp: Nanoseconds, scan: &Scan) -> Vec<u8> {
    write(&(number, LaserScanMessage::new(time(stamp), scan)))
}

/// The readings of a scan; `None` if it is no such message.
pub(super) fn read_scan(bytes: &[u8]) -> Option<Stamped<ScanReading>> {
    let (_, message) = read::<Numbered<LaserScanMessage<Vec<f32>, RawBytes>>>(bytes)?;
    Some(scan_reading(message))
}

/// The body of the marker's pose in the robot's frame.
pub(super) fn marker(number: u32, stamp: Nanoseconds, marker: &MarkerView) -> Vec<u8> {
    write(&(number, marker_message(stamp, marker)))
}

/// The marker; `None` if it is no such message, or a number in it is not finite.
pub(super) fn read_marker(bytes: &[u8]) -> Option<Stamped<MarkerReading>> {
    let (_, message) = read::<Numbered<PoseStamped<RawBytes>>>(bytes)?;
    marker_reading(&message)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use toposlam_logs::{
        Mount,
        standard::{BASE, ODOM},
    };
    use toposlam_model::driving::odometry;
    use toposlam_vision::laser::scan::ScanGeometry;

    use super::{odometry as odometry_body, *};
    use crate::live::SECOND;

    fn reckoning() -> Reckoning {
        let at = odometry::Odometry { position: [1.5, -0.25], heading: 2.5 };
        Reckoning { stamp: 3 * SECOND + 7, at, wheels: WheelSpeeds::from_motion(0.1, 0.2) }
    }

    #[test]
    fn what_is_written_is_read() {
        let read = read_odometry(&odometry_body(9, &reckoning())).unwrap();
        assert_eq!((read.stamp, read.at.position), (3 * SECOND + 7, [1.5, -0.25]));
        assert!((read.at.heading - 2.5).abs() < 1e-12, "{read:?}");
        let wheels = read_twist(&twist(reckoning().wheels)).unwrap();
        assert!((wheels.speed() - 0.1).abs() < 1e-12 && (wheels.turn_rate() - 0.2).abs() < 1e-12);
        let file = vec![0xff, 0xd8, 1];
        let taken = Stamped { stamp: 5, content: SentImage::File(file.clone()) };
        assert_eq!(read_image(&image(1, 5, &file)), Some(taken));
        let content = SentImage::File(Vec::new());
        let late = Stamped { stamp: u64::from(u32::MAX) * SECOND + 1, content };
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
        let Stamped { stamp, content } = read_scan(&scan(1, 7, &sweep.content)).unwrap();
        assert_eq!((stamp, content.scan(&Mount::centre())), (sweep.stamp, Ok(sweep.content)));
        let found = MarkerView { position: [0.5, -0.25], axis: 1.0, door: None };
        let read = read_marker(&marker(1, 9, &found)).unwrap();
        assert_eq!((read.stamp, read.content.marker.position), (9, found.position));
        assert!((read.content.marker.axis - 1.0).abs() < 1e-12, "{read:?}");
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
            let mut body = odometry_body(1, &reckoning());
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
        assert_eq!(read_odometry(&odometry_body(1, &Reckoning { at, ..reckoning() })), None);
    }

    proptest! {
        #[test]
        fn no_bytes_are_too_strange(bytes in proptest::collection::vec(any::<u8>(), 0..1000)) {
            let _ = (read_twist(&bytes), read_odometry(&bytes), read_image(&bytes));
        }

        #[test]
        fn what_is_cut_off_is_none(left in 0..700_usize) {
            let body = odometry_body(9, &reckoning());
            prop_assert!(left >= body.len() || read_odometry(&body[..left]).is_none());
        }
    }
}
