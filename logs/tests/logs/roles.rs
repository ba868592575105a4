//! Runs in logs, read through topic maps: topics of the project and of others.

use std::{collections::BTreeMap, io::Cursor};

use mcap::{WriteOptions, records::MessageHeader};
use toposlam_logs::{
    entries::{Content, Entry},
    messages::Stamp,
    reader::Log,
    record::{Arrival, CameraImage, EventKind},
    topic_map::{Role, RoleGuess, TopicMap, guess},
};
use toposlam_model::{
    driving::visit::JunctionShape,
    percept::{Door, Sighting},
};

/// A topic: its name, the type, definition and bodies of its messages, one a second.
pub(crate) type Topic = (&'static str, &'static str, &'static str, Vec<Vec<u8>>);

/// A log in the serialization of ROS 1, which needs no padding. It is compressed, because
/// definitions are long.
pub(crate) fn log_of(topics: &[Topic]) -> Vec<u8> {
    let options = WriteOptions::new()
        .emit_statistics(false)
        .emit_summary_offsets(false)
        .emit_message_indexes(false)
        .emit_chunk_indexes(false)
        .repeat_channels(false)
        .repeat_schemas(false);
    let mut writer = options.create(Cursor::new(Vec::new())).unwrap();
    for (name, type_name, definition, messages) in topics {
        let schema = writer.add_schema(type_name, "ros1msg", definition.as_bytes()).unwrap();
        let channel_id = writer.add_channel(schema, name, "ros1", &BTreeMap::new()).unwrap();
        for (nth, message) in messages.iter().enumerate() {
            let log_time = 1_000_000_000 * (nth as u64 + 1);
            let header =
                MessageHeader { channel_id, sequence: 0, log_time, publish_time: log_time };
            writer.write_to_known_channel(&header, message).unwrap();
        }
    }
    writer.finish().unwrap();
    writer.into_inner().into_inner()
}

pub(crate) fn text(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes(), text.as_bytes()].concat()
}

pub(crate) fn numbers<const MANY: usize>(numbers: [f64; MANY]) -> Vec<u8> {
    numbers.map(f64::to_le_bytes).concat()
}

fn header(sec: u32) -> Vec<u8> {
    header_in(sec, "f")
}

pub(crate) fn header_in(sec: u32, frame: &str) -> Vec<u8> {
    [[0, sec, 5].map(u32::to_le_bytes).concat(), text(frame)].concat()
}

fn image() -> Topic {
    const DEFINITION: &str = "Header header\nstring format\nuint8[] data\n\
        ===\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n";
    let message = [header(7), text("jpeg"), text("JPEG")].concat();
    ("/camera/image/compressed", "sensor_msgs/CompressedImage", DEFINITION, vec![message])
}

fn odometry() -> Topic {
    const DEFINITION: &str = "Header header\nPose pose\n===\nMSG: std_msgs/Header\nuint32 seq\n\
        time stamp\nstring frame_id\n===\nMSG: geometry_msgs/Pose\nPoint position\n\
        Quaternion orientation\n===\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n\
        ===\nMSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n";
    let half = 0.5_f64.sqrt();
    let message = [header(8), numbers([1.0, 2.0, 0.0, 0.0, 0.0, half, half])].concat();
    ("/odom", "geometry_msgs/PoseStamped", DEFINITION, vec![message])
}

fn twist() -> Topic {
    const DEFINITION: &str = "Vector3 linear\nVector3 angular\n===\nMSG: geometry_msgs/Vector3\n\
        float64 x\nfloat64 y\nfloat64 z\n";
    let message = numbers([0.25, 0.0, 0.0, 0.0, 0.0, -1.0]);
    ("/cmd_vel", "geometry_msgs/Twist", DEFINITION, vec![message])
}

/// The project's topics, as a tool writes them that converts ROS 2 to ROS 1.
fn percept() -> Topic {
    const DEFINITION: &str =
        "time stamp\nuint32 move\nuint32 degree\nint32 marker\nbool[4] form\nfloat64 entry\n";
    let message = [
        [9, 1, 3, 2].map(u32::to_le_bytes).concat(),
        (-1_i32).to_le_bytes().to_vec(),
        vec![1, 0, 1, 0],
        numbers([0.5]),
    ];
    ("/toposlam/percept", "toposlam_msgs/Percept", DEFINITION, vec![message.concat()])
}

fn junction() -> Topic {
    const DEFINITION: &str = "uint8 exits\nint8[] arrow\n";
    let messages = vec![vec![4, 1, 0, 0, 0, 2], vec![3, 1, 0, 0, 0, 255]];
    ("/junction", "lab_msgs/Junction", DEFINITION, messages)
}

fn place() -> Topic {
    const DEFINITION: &str = "float32 x\nfloat32 y\nfloat32 theta\n";
    let message = [10.0_f32, -20.0, 270.0].map(f32::to_le_bytes).concat();
    ("/place", "lab_msgs/Place", DEFINITION, vec![message])
}

pub(crate) fn all() -> Vec<u8> {
    log_of(&[image(), odometry(), twist(), percept(), junction(), place()])
}

fn entries(log: &Log, mapping: &TopicMap) -> Vec<Entry> {
    log.entries(&mapping.bind(log).unwrap()).map(Result::unwrap).collect()
}

#[test]
fn the_usual_topics_need_no_topic_map_file() {
    let log = Log::of_bytes(all()).unwrap();
    let mapping = TopicMap::from_log(&log).unwrap();
    let roles: Vec<_> = mapping.carriers().map(|(role, carrier)| (role, &*carrier.topic)).collect();
    assert_eq!(
        roles,
        [
            (Role::Image, "/camera/image/compressed"),
            (Role::Odometry, "/odom"),
            (Role::Motion, "/cmd_vel"),
            (Role::Percept, "/toposlam/percept"),
        ]
    );
    let [image, odometry, motion, percept] = &entries(&log, &mapping)[..] else { panic!() };
    let Content::Event(EventKind::Frame(frame)) = &image.content else { panic!() };
    assert_eq!(frame.image, Some(CameraImage::encoded(*b"JPEG")));
    assert_eq!((image.time, image.stamp), (1_000_000_000, Stamp { sec: 7, nanosec: 5 }));
    let Content::Event(EventKind::Odometry(at)) = &odometry.content else { panic!() };
    assert_eq!(at.position, [1.0, 2.0]);
    assert!((at.heading - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    let forward = EventKind::Motion { forward: 0.25, turn: -1.0 };
    assert_eq!(motion.content, Content::Event(forward));
    // A twist has no time stamp.
    assert_eq!(motion.stamp, Stamp { sec: 1, nanosec: 0 });
    let arrival = Arrival {
        number: Some(3),
        degree: 2,
        sighting: Some(Sighting::Nothing),
        form: Some(JunctionShape([true, false, true, false])),
        entry: Some(0.5),
    };
    assert_eq!(percept.content, Content::Event(EventKind::Arrival(arrival)));
    assert_eq!(percept.stamp, Stamp { sec: 9, nanosec: 1 });
}

#[test]
fn topics_of_others_are_read_through_paths_and_units() {
    let log = Log::of_bytes(all()).unwrap();
    let mapping = "[odometry]\ntopic = \"/place\"\nx = \"x\"\ny = \"y\"\nheading = \"theta\"\n\
        length = \"inches\"\nangle = \"degrees\"\n\
        [percept]\ntopic = \"/junction\"\ndegree = \"exits\"\nmarker = \"arrow[0]\"\n\
        [door]\ntopic = \"/junction\"\ndoor = \"exits\"\n";
    let entries = entries(&log, &TopicMap::read(mapping.as_bytes()).unwrap());
    let [percept, door, odometry, lost, _] = &entries[..] else { panic!("{entries:?}") };
    let arrival = Arrival {
        number: None,
        degree: 4,
        sighting: Some(Sighting::Pointing(Door(2))),
        form: None,
        entry: None,
    };
    assert_eq!(percept.content, Content::Event(EventKind::Arrival(arrival)));
    let leaves = EventKind::Door { number: None, door: Door(4) };
    assert_eq!(door.content, Content::Event(leaves));
    assert_eq!(door.stamp, Stamp { sec: 1, nanosec: 0 });
    let Content::Event(EventKind::Odometry(at)) = &odometry.content else { panic!() };
    assert!((at.position[0] - 0.254).abs() < 1e-12 && (at.position[1] + 0.508).abs() < 1e-12);
    assert!((at.heading + std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    let Content::Event(EventKind::Arrival(lost)) = &lost.content else { panic!() };
    assert_eq!(lost.sighting, Some(Sighting::Nothing));
    // A mapping without the marker leaves open whether it was seen.
    let unmarked = mapping.replace("marker = \"arrow[0]\"\n", "");
    let entries = self::entries(&log, &TopicMap::read(unmarked.as_bytes()).unwrap());
    let Content::Event(EventKind::Arrival(arrival)) = &entries[0].content else { panic!() };
    assert_eq!((arrival.degree, arrival.sighting, arrival.percept()), (4, None, None));
}

#[test]
fn ambiguous_topics_are_not_chosen() {
    let mut other = odometry();
    other.0 = "/goal";
    let mut annotated = image();
    annotated.0 = "/camera/annotated/compressed";
    let log = Log::of_bytes(log_of(&[odometry(), other, image(), annotated])).unwrap();
    assert_eq!(
        guess(log.topics()),
        [
            RoleGuess { role: Role::Image, topics: vec![2] },
            RoleGuess { role: Role::Odometry, topics: vec![0, 1] }
        ]
    );
    assert_eq!(
        TopicMap::from_log(&log).unwrap_err().to_string(),
        "2 topics could carry odometry: /odom, /goal; a mapping file must choose one"
    );
    assert_eq!(
        TopicMap::unambiguous(&log).to_toml(),
        "[image]\ntopic = \"/camera/image/compressed\"\n"
    );
}

/// A mapping file that does not fit the log of all topics, and how its error begins.
const MISFITS: &str = r#"
[run]\ntopic = "/r" | line 2, column 9: run.topic: the log has no topic "/r"; it has: /camera/image/compressed, /odom,
[run]\ntopic = "/odom" | line 2, column 9: run.topic: messages of type "geometry_msgs/PoseStamped" do not carry run
[door]\ntopic = "/junction" | line 2, column 9: door.topic: for messages of type "lab_msgs/Junction" the key `door` must give a path
[door]\ntopic = "/junction"\ndoor = "arrow" | line 3, column 8: door.door: "arrow" does not lead to a number in a lab_msgs/Junction
[odometry]\ntopic = "/odom"\nquaternion = "pose.position" | line 3, column 14: odometry.quaternion: "pose.position" does not lead to a quaternion in a geometry_msgs/PoseStamped"#;

#[test]
fn a_topic_map_that_does_not_fit_is_reported_with_its_place() {
    let log = Log::of_bytes(all()).unwrap();
    for row in MISFITS.lines().skip(1) {
        let (mapping, message) = row.split_once(" | ").unwrap();
        let mapping = mapping.replace(r"\n", "\n");
        let mapping = TopicMap::read(mapping.as_bytes()).unwrap();
        let found = mapping.bind(&log).unwrap_err().to_string();
        assert!(found.starts_with(message), "{found}");
    }
}

#[test]
fn invalid_messages_are_reported_with_their_numbers() {
    let wrong = |topic: Topic, mapping: &str| {
        let log = Log::of_bytes(log_of(&[topic])).unwrap();
        let mapping = TopicMap::read(mapping.as_bytes()).unwrap();
        let mut entries = log.entries(&mapping.bind(&log).unwrap());
        let error = entries.find_map(Result::err).unwrap().to_string();
        assert!(entries.next().is_none());
        error.split_once(": ").unwrap().1.to_owned()
    };
    let mut short = twist();
    short.3.push(vec![0; 47]);
    assert_eq!(
        wrong(short, "[motion]\ntopic = \"/cmd_vel\""),
        "message 2, on /cmd_vel: byte 40 of the message, `angular`: 8 more bytes are needed, and 7 are left"
    );
    let mut nowhere = twist();
    nowhere.3[0][..8].copy_from_slice(&f64::NAN.to_le_bytes());
    assert_eq!(
        wrong(nowhere, "[motion]\ntopic = \"/cmd_vel\""),
        "message 1, on /cmd_vel: its `linear.x` is NaN"
    );
    let mut junction = junction();
    junction.3[0] = vec![4, 0, 0, 0, 0];
    assert_eq!(
        wrong(
            junction,
            "[percept]\ntopic = \"/junction\"\ndegree = \"exits\"\nmarker = \"arrow[0]\""
        ),
        "message 1, on /junction: it has no `arrow[0]`"
    );
    let raw = |encoding: &str, size: [u32; 2], step: u32, data: &[u8]| -> Topic {
        let definition = "Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\n\
            uint32 step\nuint8[] data\n===\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n";
        let message = [
            header(1),
            [size[1], size[0]].map(u32::to_le_bytes).concat(),
            text(encoding),
            vec![0],
            step.to_le_bytes().to_vec(),
            (data.len() as u32).to_le_bytes().to_vec(),
            data.to_vec(),
        ];
        ("/image", "sensor_msgs/Image", definition, vec![message.concat()])
    };
    let mapping = "[image]\ntopic = \"/image\"";
    assert_eq!(
        wrong(raw("rgb8", [50_000, 50_000], 150_000, &[0; 12]), mapping),
        "message 1, on /image: 12 bytes are not 50000 rows of 150000 bytes with 50000 pixels each"
    );
    assert!(wrong(raw("bayer", [2, 1], 6, &[0; 6]), mapping).contains("\"bayer\" cannot be read"));
    let log = Log::of_bytes(log_of(&[raw("bgr8", [2, 1], 8, &[1, 2, 3, 4, 5, 6, 0, 0])])).unwrap();
    let entries = entries(&log, &TopicMap::read(mapping.as_bytes()).unwrap());
    let Content::Event(EventKind::Frame(frame)) = &entries[0].content else { panic!() };
    let pixels = frame.image.as_ref().unwrap().pixels().unwrap();
    assert_eq!((pixels.dimensions(), &pixels.as_raw()[..]), ((2, 1), &[3, 2, 1, 6, 5, 4][..]));
}
