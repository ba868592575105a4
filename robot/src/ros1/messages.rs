//! The messages of ROS 1 that a SuperScout's nodes exchange, in the bytes in which they travel: each
//! field after the other, the lesser byte first, before a text or a list how long it is.
//!
//! Bytes from outside are read without trust: what is too short is none, and nothing is set aside for
//! what a length claims before it is there.

use toposlam_model::driving::odometry;

use crate::{
    log::standard::{BASE, CAMERA, ODOM},
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

/// What the wheels are told.
pub(super) const TWIST: MessageKind = MessageKind {
    name: "geometry_msgs/Twist",
    definition: concat!("Vector3 linear\nVector3 angular\n", vector!("geometry_msgs/Vector3")),
};

/// Where the robot is by its wheels.
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
pub(super) const PICTURE: MessageKind = MessageKind {
    name: "sensor_msgs/CompressedImage",
    definition: concat!("Header header\nstring format\nuint8[] data\n", header!()),
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

/// What is read of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Photograph {
    pub(super) stamp: Nanoseconds,
    pub(super) file: Vec<u8>,
}

/// The body of what the wheels are told.
pub(super) fn twist(wheels: WheelSpeeds) -> Vec<u8> {
    let mut out = Out::default();
    out.twist(wheels);
    out.0
}

/// What the wheels are told: how fast ahead, and to turn; `None` where it is no such message.
pub(super) fn read_twist(bytes: &[u8]) -> Option<WheelSpeeds> {
    let mut from = From(bytes);
    let wheels = from.twist()?;
    from.0.is_empty().then_some(wheels)
}

/// The body of odometry.
pub(super) fn odometry(number: u32, reckoning: &Reckoning) -> Vec<u8> {
    let mut out = Out::default();
    out.header(number, reckoning.stamp, ODOM);
    out.text(BASE);
    out.pose(&reckoning.at);
    out.numbers(&[0.0; 36]);
    out.twist(reckoning.wheels);
    out.numbers(&[0.0; 36]);
    out.0
}

/// What odometry tells; `None` where it is no such message, or tells no number.
pub(super) fn read_odometry(bytes: &[u8]) -> Option<Reckoning> {
    let mut from = From(bytes);
    let stamp = from.header()?;
    from.text()?;
    let [x, y, _, qx, qy, qz, qw] = from.numbers()?;
    from.numbers::<36>()?;
    let wheels = from.twist()?;
    from.numbers::<36>()?;
    let heading = f64::atan2(2.0 * (qw * qz + qx * qy), 1.0 - 2.0 * (qy * qy + qz * qz));
    let finite = [x, y, heading].iter().all(|number| number.is_finite());
    let at = odometry::Odometry { position: [x, y], heading };
    (finite && from.0.is_empty()).then_some(Reckoning { stamp, at, wheels })
}

/// The body of the robot's frame in that of odometry.
pub(super) fn frames(number: u32, reckoning: &Reckoning) -> Vec<u8> {
    let mut out = Out::default();
    out.length(1);
    out.header(number, reckoning.stamp, ODOM);
    out.text(BASE);
    out.pose(&reckoning.at);
    out.0
}

/// The body of a picture.
pub(super) fn picture(number: u32, stamp: Nanoseconds, file: &[u8]) -> Vec<u8> {
    let mut out = Out::default();
    out.header(number, stamp, CAMERA);
    out.text(if file.starts_with(b"\x89PNG") { "png" } else { "jpeg" });
    out.length(file.len());
    out.0.extend_from_slice(file);
    out.0
}

/// A picture; `None` where it is no such message.
pub(super) fn read_picture(bytes: &[u8]) -> Option<Photograph> {
    let mut from = From(bytes);
    let stamp = from.header()?;
    from.text()?;
    let file = from.text()?;
    from.0.is_empty().then(|| Photograph { stamp, file: file.to_vec() })
}

/// A body that is being written.
#[derive(Default)]
struct Out(Vec<u8>);

impl Out {
    fn length(&mut self, length: usize) {
        self.0.extend((length as u32).to_le_bytes());
    }

    fn text(&mut self, text: &str) {
        self.length(text.len());
        self.0.extend(text.as_bytes());
    }

    fn numbers(&mut self, numbers: &[f64]) {
        self.0.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    }

    fn header(&mut self, number: u32, stamp: Nanoseconds, frame: &str) {
        self.0.extend(number.to_le_bytes());
        self.0.extend(((stamp / SECOND) as u32).to_le_bytes());
        self.0.extend(((stamp % SECOND) as u32).to_le_bytes());
        self.text(frame);
    }

    fn twist(&mut self, wheels: WheelSpeeds) {
        self.numbers(&[wheels.speed(), 0.0, 0.0, 0.0, 0.0, wheels.turn_rate()]);
    }

    /// A place on the floor, and the turn about up.
    fn pose(&mut self, at: &odometry::Odometry) {
        let (sine, cosine) = (at.heading / 2.0).sin_cos();
        let [x, y] = at.position;
        self.numbers(&[x, y, 0.0, 0.0, 0.0, sine, cosine]);
    }
}

/// What is left of a body that is being read.
struct From<'b>(&'b [u8]);

impl<'b> From<'b> {
    fn take(&mut self, length: usize) -> Option<&'b [u8]> {
        let (taken, left) = self.0.split_at_checked(length)?;
        self.0 = left;
        Some(taken)
    }

    fn whole(&mut self) -> Option<u32> {
        let (bytes, left) = self.0.split_first_chunk()?;
        self.0 = left;
        Some(u32::from_le_bytes(*bytes))
    }

    fn text(&mut self) -> Option<&'b [u8]> {
        let length = self.whole()?;
        self.take(length as usize)
    }

    fn numbers<const COUNT: usize>(&mut self) -> Option<[f64; COUNT]> {
        let mut numbers = [0.0; COUNT];
        for number in &mut numbers {
            let (bytes, left) = self.0.split_first_chunk()?;
            self.0 = left;
            *number = f64::from_le_bytes(*bytes);
        }
        Some(numbers)
    }

    fn header(&mut self) -> Option<Nanoseconds> {
        let [_, seconds, nanoseconds] = [self.whole()?, self.whole()?, self.whole()?];
        self.text()?;
        Some(u64::from(seconds) * SECOND + u64::from(nanoseconds))
    }

    /// Within the limits of a SuperScout; what is no number is taken for a stop.
    fn twist(&mut self) -> Option<WheelSpeeds> {
        let [speed, _, _, _, _, turning] = self.numbers()?;
        let told = speed.is_finite() && turning.is_finite();
        Some(if told { WheelSpeeds::of(speed, turning) } else { WheelSpeeds::STOP })
    }
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

    /// By these sums nodes tell whether they speak of the same types; they are ROS's own.
    #[test]
    fn the_types_are_those_of_ros() {
        let kinds = [
            (TWIST, "9f195f881246fdfa2798d1d3eebca84a"),
            (ODOMETRY, "cd5e73d190d741a2f92e81eda573aca7"),
            (PICTURE, "8f7a12909da2c9d3332d540a0977563f"),
            (FRAMES, "94810edda583a504dfda3829e70d7eec"),
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
        assert_eq!(read_picture(&picture(1, 5, &photograph.file)), Some(photograph));
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

    #[test]
    fn odometry_that_tells_no_number_is_none() {
        let at = odometry::Odometry { position: [f64::NAN, 0.0], heading: 0.0 };
        assert_eq!(read_odometry(&odometry(1, &Reckoning { at, ..reckoning() })), None);
    }

    proptest! {
        #[test]
        fn no_bytes_are_too_strange(bytes in proptest::collection::vec(any::<u8>(), 0..1000)) {
            let _ = (read_twist(&bytes), read_odometry(&bytes), read_picture(&bytes));
        }

        #[test]
        fn what_is_cut_off_is_none(left in 0..700_usize) {
            let body = odometry(9, &reckoning());
            prop_assert!(left >= body.len() || read_odometry(&body[..left]).is_none());
        }
    }
}
