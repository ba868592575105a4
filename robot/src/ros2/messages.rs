//! The messages of ROS 2, and their encoding: plain CDR (OMG DDSI-RTPS 10; XCDR version 1).

use byteorder::{BigEndian, LittleEndian};
use rustdds::{RepresentationIdentifier, cdr_encoding};
use serde::{Serialize, de::DeserializeOwned};
use toposlam_logs::{
    FrameTree,
    decode::decode,
    definition::{Definition, Dialect},
    message::{Message, schema},
    standard::{
        BASE, ClockMessage, CompressedImage, Header, LaserScanMessage, OdometryMessage,
        PoseStamped, RawImage, TFMessage, Twist, TwistStamped,
    },
};
use toposlam_model::driving::scene::MarkerView;
use toposlam_vision::laser::scan::Scan;

use crate::{
    live::messages::{
        MarkerReading, Nanoseconds, RawBytes, Reckoning, ScanReading, SentImage, Stamped,
        image_file, image_pixels, marker_message, marker_reading, nanoseconds, odometry_message,
        reckoning, scan_reading, time, twist_of, wheel_speeds,
    },
    superscout::WheelSpeeds,
};

/// A message as it is sent, without the four bytes before it that name its encoding.
#[derive(Clone, Debug)]
pub(super) struct EncodedBody {
    pub(super) encoding: RepresentationIdentifier,
    pub(super) bytes: Vec<u8>,
}

/// A message is followed by less than this, so that its length is a multiple of four bytes.
const PADDING: usize = 4;

/// The message of a body; `None` if it is too short or too long. A message of another type is either, or its numbers make no
/// sense. No memory is allocated for a length that the body does not have.
pub(super) fn read<T: DeserializeOwned>(body: &EncodedBody) -> Option<T> {
    let bytes = body.bytes.as_slice();
    let (message, read) = if body.encoding == RepresentationIdentifier::CDR_BE {
        cdr_encoding::from_bytes::<T, BigEndian>(bytes)
    } else {
        cdr_encoding::from_bytes::<T, LittleEndian>(bytes)
    }
    .ok()?;
    (bytes.len().checked_sub(read)? < PADDING).then_some(message)
}

/// The body of a message, with the lesser byte of a number first.
pub(super) fn write(message: &impl Serialize) -> Vec<u8> {
    // Numbers, texts and lists of known length can always be written to memory.
    cdr_encoding::to_vec::<_, LittleEndian>(message).unwrap_or_default()
}

/// The types of a command to the wheels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WheelsType {
    Twist,
    TwistStamped,
}

impl WheelsType {
    pub(super) const ALL: [Self; 2] = [Self::Twist, Self::TwistStamped];

    pub(super) fn type_name(self) -> &'static str {
        match self {
            Self::Twist => Twist::TYPE,
            Self::TwistStamped => <TwistStamped as Message>::TYPE,
        }
    }

    pub(super) fn body(self, stamp: Nanoseconds, wheels: WheelSpeeds) -> Vec<u8> {
        let twist = twist_of(wheels);
        match self {
            Self::Twist => write(&twist),
            Self::TwistStamped => write(&TwistStamped {
                header: Header { stamp: time(stamp), frame_id: BASE },
                twist,
            }),
        }
    }

    /// The command to the wheels; `None` if it is no such message.
    pub(super) fn read(self, body: &EncodedBody) -> Option<WheelSpeeds> {
        let twist = match self {
            Self::Twist => read(body)?,
            Self::TwistStamped => read::<TwistStamped<RawBytes>>(body)?.twist,
        };
        Some(wheel_speeds(twist))
    }
}

pub(super) fn odometry(reckoning: &Reckoning) -> Vec<u8> {
    write(&odometry_message(reckoning))
}

/// The odometry; `None` if it is no such message, or a number in it is not finite.
pub(super) fn read_odometry(body: &EncodedBody) -> Option<Reckoning> {
    reckoning(read::<OdometryMessage<RawBytes>>(body)?)
}

/// The transform from the frame of odometry to the robot.
pub(super) fn frames(reckoning: &Reckoning) -> Vec<u8> {
    write(&TFMessage { transforms: &[odometry_message(reckoning).transform()] })
}

pub(super) fn image(stamp: Nanoseconds, file: &[u8]) -> Vec<u8> {
    write(&CompressedImage::new(time(stamp), file))
}

/// An image; `None` if it is no such message.
pub(super) fn read_image(body: &EncodedBody) -> Option<Stamped<SentImage>> {
    read::<CompressedImage<RawBytes, RawBytes>>(body).map(image_file)
}

/// An image as pixels; `None` if it is no such message, or has another encoding.
pub(super) fn read_raw_image(body: &EncodedBody) -> Option<Stamped<SentImage>> {
    image_pixels(&read::<RawImage<RawBytes, RawBytes>>(body)?)
}

pub(super) fn scan(stamp: Nanoseconds, scan: &Scan) -> Vec<u8> {
    write(&LaserScanMessage::new(time(stamp), scan))
}

/// The readings of a scan; `None` if it is no such message.
pub(super) fn read_scan(body: &EncodedBody) -> Option<Stamped<ScanReading>> {
    read::<LaserScanMessage<Vec<f32>, RawBytes>>(body).map(scan_reading)
}

/// The marker's pose in the robot's frame.
pub(super) fn marker(stamp: Nanoseconds, marker: &MarkerView) -> Vec<u8> {
    write(&marker_message(stamp, marker))
}

/// The marker; `None` if it is no such message, or a number in it is not finite.
pub(super) fn read_marker(body: &EncodedBody) -> Option<Stamped<MarkerReading>> {
    marker_reading(&read::<PoseStamped<RawBytes>>(body)?)
}

/// The topic of the time of a simulation.
pub(super) const CLOCK: &str = "/clock";

/// The time; `None` if it is no such message.
pub(super) fn read_clock(body: &EncodedBody) -> Option<Nanoseconds> {
    read::<ClockMessage>(body).map(|message| nanoseconds(message.clock))
}

pub(super) fn clock(stamp: Nanoseconds) -> Vec<u8> {
    write(&ClockMessage { clock: time(stamp) })
}

/// Reads transforms.
pub(super) struct FrameReader {
    definition: Option<Definition>,
}

impl FrameReader {
    pub(super) fn new() -> Self {
        let name = <TFMessage as Message>::TYPE.replacen("/msg/", "/", 1);
        let text = schema(<TFMessage as Message>::DEFINITION);
        Self { definition: Definition::read(Dialect::Ros2, &name, &text).ok() }
    }

    /// Adds the transforms of a message; `None` if it is no such message.
    pub(super) fn add(&self, body: &EncodedBody, frames: &mut FrameTree) -> Option<()> {
        let is_big = body.encoding == RepresentationIdentifier::CDR_BE;
        let encoded = [&[0, u8::from(!is_big), 0, 0], body.bytes.as_slice()].concat();
        let message = decode(self.definition.as_ref()?, &encoded).ok()?;
        frames.add_message(&message);
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use toposlam_logs::standard::FileBytes;
    use toposlam_model::driving::odometry::Odometry;
    use toposlam_vision::laser::scan::ScanGeometry;

    use super::*;
    use crate::live::SECOND;

    fn body(bytes: Vec<u8>) -> EncodedBody {
        EncodedBody { encoding: RepresentationIdentifier::CDR_LE, bytes }
    }

    fn reckoning() -> Reckoning {
        let at = Odometry { position: [1.5, -0.25], heading: 2.5 };
        Reckoning { stamp: 3 * SECOND + 7, at, wheels: WheelSpeeds::from_motion(0.1, 0.2) }
    }

    #[test]
    fn what_is_written_is_read() {
        let found = read_odometry(&body(odometry(&reckoning()))).unwrap();
        assert_eq!((found.stamp, found.at.position), (3 * SECOND + 7, [1.5, -0.25]));
        assert!((found.at.heading - 2.5).abs() < 1e-12, "{found:?}");
        for kind in WheelsType::ALL {
            let wheels = kind.read(&body(kind.body(9, reckoning().wheels))).unwrap();
            assert!((wheels.speed() - 0.1).abs() < 1e-12, "{wheels:?}");
            assert!((wheels.turn_rate() - 0.2).abs() < 1e-12, "{wheels:?}");
        }
        let file = vec![0xff, 0xd8, 1];
        let taken = Stamped { stamp: 5, content: SentImage::File(file.clone()) };
        assert_eq!(read_image(&body(image(5, &file))), Some(taken));
        let geometry = ScanGeometry {
            angle_min: -0.5,
            angle_increment: 0.25,
            range_min: 0.125,
            range_max: 30.0,
        };
        let mount = toposlam_logs::Mount::centre();
        let sweep = Scan::new(geometry, vec![1.0, 2.5, 30.0], mount.robot_from_scanner).unwrap();
        let Stamped { stamp, content } = read_scan(&body(scan(7, &sweep))).unwrap();
        assert_eq!((stamp, content.frame.as_str()), (7, BASE));
        assert_eq!(content.scan(&mount), Ok(sweep));
        let seen = MarkerView { position: [1.0, -0.5], axis: 0.75, door: None };
        let found = read_marker(&body(marker(8, &seen))).unwrap();
        assert!((found.content.marker.axis - 0.75).abs() < 1e-12 && found.stamp == 8, "{found:?}");
    }

    /// Two rows of one pixel, with a byte after each row.
    #[test]
    fn pixels_are_read_in_any_order_of_colours_and_with_any_step() {
        let raw = |encoding, step, data: &'static [u8]| {
            let header = Header { stamp: time(4), frame_id: "camera" };
            let data = FileBytes(data);
            let (height, width, is_bigendian) = (2, 1, 0);
            read_raw_image(&body(write(&RawImage {
                header,
                height,
                width,
                encoding,
                is_bigendian,
                step,
                data,
            })))
        };
        let expected = image::RgbImage::from_raw(1, 2, vec![1, 2, 3, 5, 6, 7]).unwrap();
        let expected = Some(Stamped { stamp: 4, content: SentImage::Pixels(expected) });
        assert_eq!(raw("rgb8", 4, &[1, 2, 3, 0, 5, 6, 7, 0]), expected);
        assert_eq!(raw("bgr8", 4, &[3, 2, 1, 0, 7, 6, 5, 0]), expected);
        assert_eq!(raw("rgb8", 3, &[1, 2, 3, 5, 6, 7]), expected);
        let grey = image::RgbImage::from_raw(1, 2, vec![9, 9, 9, 8, 8, 8]).unwrap();
        let grey = Some(Stamped { stamp: 4, content: SentImage::Pixels(grey) });
        assert_eq!(raw("mono8", 2, &[9, 0, 8, 0]), grey);
        let file = grey.and_then(|grey| grey.content.file()).unwrap();
        assert_eq!(file.pixels().unwrap().get_pixel(0, 1).0, [8; 3]);
        // Too few bytes, a row that is longer than its step, and an unknown encoding.
        assert_eq!(raw("rgb8", 3, &[1, 2, 3, 5, 6]), None);
        assert_eq!(raw("rgb8", 2, &[1, 2, 3, 5, 6, 7]), None);
        assert_eq!(raw("rgb8", 0, &[]), None);
        assert_eq!(raw("16UC1", 2, &[1, 2, 3, 4]), None);
    }

    /// Commands of the two types must not be taken for each other: the numbers of one would be garbage.
    #[test]
    fn a_command_of_the_other_type_is_not_read() {
        for [one, other] in [WheelsType::ALL, [WheelsType::TwistStamped, WheelsType::Twist]] {
            for speed in [0.0, 0.05, 0.2] {
                let sent = one.body(5 * SECOND, WheelSpeeds::from_motion(speed, -0.1));
                assert_eq!(other.read(&body(sent)), None, "{one:?} {speed}");
            }
        }
    }

    /// The frame of a scanner that is mounted on a plate, backwards and upside down.
    #[test]
    fn transforms_of_several_messages_lead_from_a_scanner_to_the_robot() {
        let link = |parent: &str, child: &str, [x, y]: [f64; 2], [qx, qy, qz, qw]: [f64; 4]| {
            let stamp = toposlam_logs::messages::Stamp::default();
            let header = (stamp, parent.to_owned());
            body(write(&vec![(header, child.to_owned(), ([x, y, 0.1], [qx, qy, qz, qw]))]))
        };
        let mut frames = FrameTree::default();
        let reader = FrameReader::new();
        let half = std::f64::consts::FRAC_1_SQRT_2;
        reader.add(&link("plate", "laser", [0.1, 0.0], [1.0, 0.0, 0.0, 0.0]), &mut frames).unwrap();
        assert_eq!(frames.scanner_mount("laser"), Ok(None));
        reader
            .add(&link("base_link", "plate", [0.0, 0.2], [0.0, 0.0, half, half]), &mut frames)
            .unwrap();
        let mount = frames.scanner_mount("laser").unwrap().unwrap();
        let [x, y] = mount.robot_from_scanner.translation.vector.into();
        assert!(mount.is_upside_down && x.abs() < 1e-12 && (y - 0.3).abs() < 1e-12, "{mount:?}");
        assert_eq!(reader.add(&body(vec![1, 0, 0, 0, 9]), &mut frames), None);
    }

    proptest! {
        #[test]
        fn no_bytes_are_too_strange(bytes in proptest::collection::vec(any::<u8>(), 0..1000), big: bool) {
            let encoding =
                if big { RepresentationIdentifier::CDR_BE } else { RepresentationIdentifier::CDR_LE };
            let body = EncodedBody { encoding, bytes };
            let _ = (read_raw_image(&body), read_clock(&body));
            let _ = (read_odometry(&body), read_image(&body), read_scan(&body), read_marker(&body));
            let _ = WheelsType::ALL.map(|kind| kind.read(&body));
            let _ = FrameReader::new().add(&body, &mut FrameTree::default());
        }

        #[test]
        fn what_is_cut_off_is_none(left in 0..700_usize) {
            let whole = odometry(&reckoning());
            prop_assert!(left >= whole.len() || read_odometry(&body(whole[..left].to_vec())).is_none());
        }
    }
}
