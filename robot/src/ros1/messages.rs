//! The messages of ROS 1 that a SuperScout's nodes exchange, and their encoding.
//!
//! Bytes from outside are not trusted: a body that is too short or too long is rejected, and no memory
//! is allocated for a length that the body does not have.

use std::fmt;

use roslibrust_serde_rosmsg::{from_slice_known_length, to_vec_skip_length};
use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{DeserializeOwned, Visitor},
};
use toposlam_model::driving::{
    odometry,
    scene::{MarkerView, undirected},
};
use toposlam_vision::laser::scan::{Scan, ScanGeometry, ScannerPose};

use crate::{
    log::{
        messages::Stamp,
        standard::{BASE, CAMERA, LaserScanMessage, ODOM, Quaternion},
    },
    superscout::WheelSpeeds,
};

/// Nanoseconds since the beginning of 1970, or since a robot was switched on.
pub(super) type Nanoseconds = u64;

/// A second.
pub(super) const SECOND: Nanoseconds = 1_000_000_000;

/// A type of message: its name, and its definition with those that it uses.
#[derive(Clone, Copy, Debug)]
pub(super) struct MessageKind {
    pub(super) name: &'static str,
    pub(super) definition: &'static str,
}

/// What one definition uses follows it, each after a line.
macro_rules! used {
    ($name:literal, $($field:literal)*) => {
        concat!(
            "================================================================================\n",
            "MSG: ", $name, "\n", $($field, "\n",)*
        )
    };
}

macro_rules! header {
    () => {
        used!("std_msgs/Header", "uint32 seq" "time stamp" "string frame_id")
    };
}

macro_rules! vector {
    ($name:literal) => {
        used!($name, "float64 x" "float64 y" "float64 z")
    };
}

macro_rules! quaternion {
    () => {
        used!("geometry_msgs/Quaternion", "float64 x" "float64 y" "float64 z" "float64 w")
    };
}

/// The command to the wheels.
pub(super) const TWIST: MessageKind = MessageKind {
    name: "geometry_msgs/Twist",
    definition: concat!("Vector3 linear\nVector3 angular\n", vector!("geometry_msgs/Vector3")),
};

/// The robot's pose by its wheels.
pub(super) const ODOMETRY: MessageKind = MessageKind {
    name: "nav_msgs/Odometry",
    definition: concat!(
        "Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n",
        "geometry_msgs/TwistWithCovariance twist\n",
        header!(),
        used!("geometry_msgs/PoseWithCovariance", "Pose pose" "float64[36] covariance"),
        used!("geometry_msgs/Pose", "Point position" "Quaternion orientation"),
        vector!("geometry_msgs/Point"),
        quaternion!(),
        used!("geometry_msgs/TwistWithCovariance", "Twist twist" "float64[36] covariance"),
        used!("geometry_msgs/Twist", "Vector3 linear" "Vector3 angular"),
        vector!("geometry_msgs/Vector3"),
    ),
};

/// The file of a photograph.
pub(super) const IMAGE: MessageKind = MessageKind {
    name: "sensor_msgs/CompressedImage",
    definition: concat!("Header header\nstring format\nuint8[] data\n", header!()),
};

/// A sweep of a laser scanner.
pub(super) const SCAN: MessageKind = MessageKind {
    name: "sensor_msgs/LaserScan",
    definition: concat!(
        "Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n",
        "float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\n",
        "float32[] ranges\nfloat32[] intensities\n",
        header!(),
    ),
};

/// Where the marker is.
pub(super) const MARKER_POSE: MessageKind = MessageKind {
    name: "geometry_msgs/PoseStamped",
    definition: concat!(
        "Header header\nPose pose\n",
        header!(),
        used!("geometry_msgs/Pose", "Point position" "Quaternion orientation"),
        vector!("geometry_msgs/Point"),
        quaternion!(),
    ),
};

/// Where frames are in each other.
pub(super) const FRAMES: MessageKind = MessageKind {
    name: "tf2_msgs/TFMessage",
    definition: concat!(
        "geometry_msgs/TransformStamped[] transforms\n",
        used!(
            "geometry_msgs/TransformStamped",
            "Header header" "string child_frame_id" "Transform transform"
        ),
        header!(),
        used!("geometry_msgs/Transform", "Vector3 translation" "Quaternion rotation"),
        vector!("geometry_msgs/Vector3"),
        quaternion!(),
    ),
};

/// What is read of odometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reckoning {
    pub(super) stamp: Nanoseconds,
    pub(super) at: odometry::Odometry,
    /// How fast the robot goes by it, and turns.
    pub(super) wheels: WheelSpeeds,
}

/// What is read of an image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Photograph {
    pub(super) stamp: Nanoseconds,
    pub(super) file: Vec<u8>,
}

/// What is read of a scan.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LiveScan {
    pub(super) stamp: Nanoseconds,
    pub(super) scan: Scan,
}

/// What is read of the marker's pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LiveMarker {
    pub(super) stamp: Nanoseconds,
    pub(super) marker: MarkerView,
}

/// The fields of `sensor_msgs/LaserScan` in order.
type ScanFields<T> = (Header<T>, [f32; 7], Vec<f32>, Vec<f32>);
/// A header: number, seconds, nanoseconds and frame. `T` is a text.
type Header<T> = (u32, u32, u32, T);
/// A position and the quaternion of an orientation.
type PoseNumbers = [f64; 7];
/// A linear and an angular velocity.
type TwistNumbers = [f64; 6];
/// Zeros: not known.
type Covariance = [[f64; 6]; 6];
/// The fields of `nav_msgs/Odometry` in order.
type OdometryFields<T> = (Header<T>, T, PoseNumbers, Covariance, TwistNumbers, Covariance);

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

impl Serialize for Bytes {
    fn serialize<S: Serializer>(&self, into: S) -> Result<S::Ok, S::Error> {
        into.serialize_bytes(&self.0)
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
    write(&twist_numbers(wheels))
}

/// The command to the wheels; `None` if it is no such message.
pub(super) fn read_twist(bytes: &[u8]) -> Option<WheelSpeeds> {
    read(bytes).map(wheel_speeds)
}

/// The body of odometry.
pub(super) fn odometry(number: u32, reckoning: &Reckoning) -> Vec<u8> {
    let Reckoning { stamp, at, wheels } = reckoning;
    let unknown = Covariance::default();
    let message: OdometryFields<_> =
        (header(number, *stamp, ODOM), BASE, pose(at), unknown, twist_numbers(*wheels), unknown);
    write(&message)
}

/// The odometry; `None` if it is no such message, or a number in it is not finite.
pub(super) fn read_odometry(bytes: &[u8]) -> Option<Reckoning> {
    let ((_, seconds, nanoseconds, _), _, pose, _, twist, _) =
        read::<OdometryFields<Bytes>>(bytes)?;
    let [x, y, _, qx, qy, qz, qw] = pose;
    let heading = Quaternion { x: qx, y: qy, z: qz, w: qw }.heading()?;
    let at = odometry::Odometry { position: [x, y], heading };
    let (stamp, wheels) = (time(seconds, nanoseconds), wheel_speeds(twist));
    (x.is_finite() && y.is_finite()).then_some(Reckoning { stamp, at, wheels })
}

/// The body of the transform from the frame of odometry to the robot.
pub(super) fn frames(number: u32, reckoning: &Reckoning) -> Vec<u8> {
    write(&vec![(header(number, reckoning.stamp, ODOM), BASE, pose(&reckoning.at))])
}

/// The body of an image.
pub(super) fn image(number: u32, stamp: Nanoseconds, file: &[u8]) -> Vec<u8> {
    let format = if file.starts_with(b"\x89PNG") { "png" } else { "jpeg" };
    write(&(header(number, stamp, CAMERA), format, Bytes(file.to_vec())))
}

/// An image; `None` if it is no such message.
pub(super) fn read_image(bytes: &[u8]) -> Option<Photograph> {
    let ((_, seconds, nanoseconds, _), _, Bytes(file)) =
        read::<(Header<Bytes>, Bytes, Bytes)>(bytes)?;
    Some(Photograph { stamp: time(seconds, nanoseconds), file })
}

/// The body of a scan.
pub(super) fn scan(number: u32, stamp: Nanoseconds, scan: &Scan) -> Vec<u8> {
    let LaserScanMessage {
        angle_min,
        angle_max,
        angle_increment,
        time_increment,
        scan_time,
        range_min,
        range_max,
        ranges,
        ..
    } = LaserScanMessage::new(Stamp::default(), scan);
    let numbers =
        [angle_min, angle_max, angle_increment, time_increment, scan_time, range_min, range_max];
    let message: ScanFields<_> =
        (header(number, stamp, BASE), numbers, ranges.to_vec(), Vec::new());
    write(&message)
}

/// A scan; `None` if it is no such message, or no scan.
pub(super) fn read_scan(bytes: &[u8]) -> Option<LiveScan> {
    let ((_, seconds, nanoseconds, _), numbers, ranges, _) = read::<ScanFields<Bytes>>(bytes)?;
    let [angle_min, _, angle_increment, _, _, range_min, range_max] = numbers.map(f64::from);
    let geometry = ScanGeometry { angle_min, angle_increment, range_min, range_max };
    let scan = Scan::new(geometry, ranges, ScannerPose::default()).ok()?;
    Some(LiveScan { stamp: time(seconds, nanoseconds), scan })
}

/// The body of the marker's pose in the robot's frame.
pub(super) fn marker(number: u32, stamp: Nanoseconds, marker: &MarkerView) -> Vec<u8> {
    let at = odometry::Odometry { position: marker.position, heading: marker.axis };
    write(&(header(number, stamp, BASE), pose(&at)))
}

/// The marker; `None` if it is no such message, or a number in it is not finite.
pub(super) fn read_marker(bytes: &[u8]) -> Option<LiveMarker> {
    let ((_, seconds, nanoseconds, _), pose) = read::<(Header<Bytes>, PoseNumbers)>(bytes)?;
    let [x, y, _, qx, qy, qz, qw] = pose;
    let axis = undirected(Quaternion { x: qx, y: qy, z: qz, w: qw }.heading()?);
    let marker = MarkerView { position: [x, y], axis, door: None };
    let is_finite = x.is_finite() && y.is_finite();
    is_finite.then_some(LiveMarker { stamp: time(seconds, nanoseconds), marker })
}

fn header(number: u32, stamp: Nanoseconds, frame: &str) -> Header<&str> {
    (number, (stamp / SECOND) as u32, (stamp % SECOND) as u32, frame)
}

fn time(seconds: u32, nanoseconds: u32) -> Nanoseconds {
    u64::from(seconds) * SECOND + u64::from(nanoseconds)
}

fn twist_numbers(wheels: WheelSpeeds) -> TwistNumbers {
    [wheels.speed(), 0.0, 0.0, 0.0, 0.0, wheels.turn_rate()]
}

/// Within the limits of a SuperScout; a stop if a number is not finite.
fn wheel_speeds([speed, _, _, _, _, turning]: TwistNumbers) -> WheelSpeeds {
    if speed.is_finite() && turning.is_finite() {
        WheelSpeeds::of(speed, turning)
    } else {
        WheelSpeeds::STOP
    }
}

/// A pose on the floor.
fn pose(at: &odometry::Odometry) -> PoseNumbers {
    let [x, y] = at.position;
    let Quaternion { x: qx, y: qy, z: qz, w: qw } = Quaternion::turn(at.heading);
    [x, y, 0.0, qx, qy, qz, qw]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use roslibrust::md5sum::from_message_definition;

    use super::*;

    fn reckoning() -> Reckoning {
        let at = odometry::Odometry { position: [1.5, -0.25], heading: 2.5 };
        Reckoning { stamp: 3 * SECOND + 7, at, wheels: WheelSpeeds::of(0.1, 0.2) }
    }

    /// Nodes compare these checksums to check that their types agree. ROS computes the same values.
    #[test]
    fn the_types_are_those_of_ros() {
        let kinds = [
            (TWIST, "9f195f881246fdfa2798d1d3eebca84a"),
            (ODOMETRY, "cd5e73d190d741a2f92e81eda573aca7"),
            (IMAGE, "8f7a12909da2c9d3332d540a0977563f"),
            (FRAMES, "94810edda583a504dfda3829e70d7eec"),
            (SCAN, "90c7ef2dc6895d81024acba2ac42f369"),
            (MARKER_POSE, "d3812c3cbc69362b77dc0b19b345f8f5"),
        ];
        for (kind, sum) in kinds {
            let found = from_message_definition(kind.name, kind.definition).unwrap();
            assert_eq!(found, sum, "{}", kind.name);
        }
    }

    #[test]
    fn what_is_written_is_read() {
        let read = read_odometry(&odometry(9, &reckoning())).unwrap();
        assert_eq!((read.stamp, read.at.position), (3 * SECOND + 7, [1.5, -0.25]));
        assert!((read.at.heading - 2.5).abs() < 1e-12, "{read:?}");
        let wheels = read_twist(&twist(reckoning().wheels)).unwrap();
        assert!((wheels.speed() - 0.1).abs() < 1e-12 && (wheels.turn_rate() - 0.2).abs() < 1e-12);
        let photograph = Photograph { stamp: 5, file: vec![0xff, 0xd8, 1] };
        assert_eq!(read_image(&image(1, 5, &photograph.file)), Some(photograph));
        let geometry = ScanGeometry {
            angle_min: -0.5,
            angle_increment: 0.25,
            range_min: 0.125,
            range_max: 30.0,
        };
        let sweep = Scan::new(geometry, vec![1.0, f32::INFINITY, 2.5], ScannerPose::default());
        let sweep = LiveScan { stamp: 7, scan: sweep.unwrap() };
        assert_eq!(read_scan(&scan(1, 7, &sweep.scan)), Some(sweep));
        let found = MarkerView { position: [0.5, -0.25], axis: 1.0, door: None };
        let read = read_marker(&marker(1, 9, &found)).unwrap();
        assert_eq!((read.stamp, read.marker.position), (9, found.position));
        assert!((read.marker.axis - 1.0).abs() < 1e-12, "{read:?}");
    }

    #[test]
    fn a_twist_beyond_the_limits_is_cut_and_one_of_no_numbers_is_a_stop() {
        let body = |numbers: &[f64]| numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
        let read = |numbers: &[f64]| read_twist(&Vec::<u8>::clone(&body(numbers)));
        assert_eq!(read(&[9.0, 0.0, 0.0, 0.0, 0.0, 0.0]), Some(WheelSpeeds::of(0.2, 0.0)));
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
