//! Runs in logs, read through topic maps: topics of the project and of others.

use toposlam_logs::{
    entries::Content,
    messages::Stamp,
    reader::Log,
    record::{Arrival, CameraImage, EventKind},
    topic_map::{Role, RoleGuess, TopicMap, guess},
};
use toposlam_model::{
    driving::visit::JunctionShape,
    percept::{Door, Sighting},
};

use super::{
    entries, entries_of, map,
    ros1::{HEADER, LEFT, Topic, VECTOR3, header, log_of, numbers, pose, posed, text, whole},
};

fn image() -> Topic {
    let definition = ["Header header\nstring format\nuint8[] data\n", HEADER].concat();
    let message = [header(7, "f"), text("jpeg"), text("JPEG")].concat();
    ("/camera/image/compressed", "sensor_msgs/CompressedImage", definition, vec![message])
}

fn odometry() -> Topic {
    let message = [header(8, "f"), pose([1.0, 2.0, 0.0], LEFT)].concat();
    let definition = posed("Header header\nPose pose\n");
    ("/odom", "geometry_msgs/PoseStamped", definition, vec![message])
}

fn twist() -> Topic {
    let definition = ["Vector3 linear\nVector3 angular\n", VECTOR3].concat();
    let message = numbers([0.25, 0.0, 0.0, 0.0, 0.0, -1.0]);
    ("/cmd_vel", "geometry_msgs/Twist", definition, vec![message])
}

/// The project's topics, as a tool writes them that converts ROS 2 to ROS 1.
fn percept() -> Topic {
    let definition =
        "time stamp\nuint32 move\nuint32 degree\nint32 marker\nbool[4] form\nfloat64 entry\n";
    let message = [whole([9, 1, 3, 2, u32::MAX]), vec![1, 0, 1, 0], numbers([0.5])].concat();
    ("/toposlam/percept", "toposlam_msgs/Percept", definition.to_owned(), vec![message])
}

fn junction() -> Topic {
    let messages = vec![vec![4, 1, 0, 0, 0, 2], vec![3, 1, 0, 0, 0, 255]];
    ("/junction", "lab_msgs/Junction", "uint8 exits\nint8[] arrow\n".to_owned(), messages)
}

fn place() -> Topic {
    let message = [10.0_f32, -20.0, 270.0].map(f32::to_le_bytes).concat();
    let definition = "float32 x\nfloat32 y\nfloat32 theta\n".to_owned();
    ("/place", "lab_msgs/Place", definition, vec![message])
}

fn all() -> Log {
    Log::of_bytes(log_of(&[image(), odometry(), twist(), percept(), junction(), place()])).unwrap()
}

#[test]
fn the_usual_topics_need_no_topic_map_file() {
    let log = all();
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
    let [image, odometry, motion, percept] = &entries(&log)[..] else { panic!() };
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
        shape: Some(JunctionShape([true, false, true, false])),
        entry: Some(0.5),
    };
    assert_eq!(percept.content, Content::Event(EventKind::Arrival(arrival)));
    assert_eq!(percept.stamp, Stamp { sec: 9, nanosec: 1 });
}

#[test]
fn topics_of_others_are_read_through_paths_and_units() {
    let log = all();
    let mapping = "[odometry]\ntopic = \"/place\"\nx = \"x\"\ny = \"y\"\nheading = \"theta\"\n\
        length = \"inches\"\nangle = \"degrees\"\n\
        [percept]\ntopic = \"/junction\"\ndegree = \"exits\"\nmarker = \"arrow[0]\"\n\
        [door]\ntopic = \"/junction\"\ndoor = \"exits\"\n";
    let entries = entries_of(&log, &map(mapping)).unwrap();
    let [percept, door, odometry, lost, _] = &entries[..] else { panic!("{entries:?}") };
    let arrival = Arrival {
        number: None,
        degree: 4,
        sighting: Some(Sighting::Pointing(Door(2))),
        shape: None,
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
    let entries = entries_of(&log, &map(&unmarked)).unwrap();
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
    let log = all();
    for row in MISFITS.lines().skip(1) {
        let (text, message) = row.split_once(" | ").unwrap();
        let found = map(&text.replace(r"\n", "\n")).bind(&log).unwrap_err().to_string();
        assert!(found.starts_with(message), "{found}");
    }
}

fn raw_image(encoding: &str, [width, height]: [u32; 2], step: u32, data: &[u8]) -> Topic {
    let definition = "Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\n\
        uint32 step\nuint8[] data\n";
    let size = [header(1, "f"), whole([height, width]), text(encoding), vec![0]].concat();
    let message = [size, whole([step, data.len() as u32]), data.to_vec()].concat();
    ("/image", "sensor_msgs/Image", [definition, HEADER].concat(), vec![message])
}

#[test]
fn invalid_messages_are_reported_with_their_numbers() {
    let mut short = twist();
    short.3 = vec![vec![0; 47]];
    let mut nowhere = twist();
    nowhere.3[0][..8].copy_from_slice(&f64::NAN.to_le_bytes());
    let mut unmarked = junction();
    unmarked.3[0] = vec![4, 0, 0, 0, 0];
    let motion = "[motion]\ntopic = \"/cmd_vel\"";
    let percept = "[percept]\ntopic = \"/junction\"\ndegree = \"exits\"\nmarker = \"arrow[0]\"";
    let image = "[image]\ntopic = \"/image\"";
    for (topic, mapping, message) in [
        (
            short,
            motion,
            "message 1, on /cmd_vel: byte 40 of the message, `angular`: 8 more bytes are needed, and 7 are left",
        ),
        (nowhere, motion, "message 1, on /cmd_vel: its `linear.x` is NaN"),
        (unmarked, percept, "message 1, on /junction: it has no `arrow[0]`"),
        (
            raw_image("rgb8", [50_000, 50_000], 150_000, &[0; 12]),
            image,
            "message 1, on /image: 12 bytes are not 50000 rows of 150000 bytes with 50000 pixels each",
        ),
        (
            raw_image("bayer", [2, 1], 6, &[0; 6]),
            image,
            "message 1, on /image: pixels in \"bayer\" cannot be read; known are rgb8, bgr8 and mono8",
        ),
    ] {
        let log = Log::of_bytes(log_of(&[topic])).unwrap();
        let mut entries = log.entries(&map(mapping).bind(&log).unwrap());
        let error = entries.find_map(Result::err).unwrap().to_string();
        assert!(entries.next().is_none());
        assert_eq!(error.split_once(": ").unwrap().1, message);
    }
    let image_of_two = raw_image("bgr8", [2, 1], 8, &[1, 2, 3, 4, 5, 6, 0, 0]);
    let log = Log::of_bytes(log_of(&[image_of_two])).unwrap();
    let entries = entries_of(&log, &map(image)).unwrap();
    let Content::Event(EventKind::Frame(frame)) = &entries[0].content else { panic!() };
    let pixels = frame.image.as_ref().unwrap().pixels().unwrap();
    assert_eq!((pixels.dimensions(), &pixels.as_raw()[..]), ((2, 1), &[3, 2, 1, 6, 5, 4][..]));
}
