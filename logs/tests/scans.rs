//! Scans of ROS, and where their scanners are on the robot.

use std::{
    f64::consts::{FRAC_PI_2, PI},
    sync::Arc,
};

use nalgebra::{Isometry2, Point2, Vector2};
use toposlam_logs::{
    ReadingRemark,
    entries::{Content, Entry},
    messages,
    reader::Log,
    record::{Event, EventId, EventKind, Frame, RunObserver},
    recorder::Recorder,
    topic_map::{Role, TopicMap},
};
use toposlam_model::driving::odometry::Odometry;
use toposlam_vision::laser::scan::{Reading, Scan, ScanGeometry};

use super::{
    entries, entries_of,
    ros1::{
        HEADER, LEFT, LEVEL, Topic, Transform, header, log_of, odometry, pose, text, transforms,
        whole,
    },
};

/// First angle, increment, least and largest range, ranges.
fn scan(numbers: [f32; 4], ranges: &[f32]) -> Topic {
    let definition = "Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n\
        float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\n\
        float32[] ranges\nfloat32[] intensities\n";
    let [first, increment, least, most] = numbers;
    let body = [first, 0.0, increment, 0.0, 0.0, least, most].map(f32::to_le_bytes).concat();
    let list: Vec<u8> = ranges.iter().flat_map(|range| range.to_le_bytes()).collect();
    let message =
        [header(7, "laser"), body, whole([ranges.len() as u32]), list, vec![0; 4]].concat();
    ("/scan", "sensor_msgs/LaserScan", [definition, HEADER].concat(), vec![message])
}

fn read(topics: &[Topic]) -> Result<Frame, String> {
    let log = Log::of_bytes(log_of(topics)).unwrap();
    let entries = entries_of(&log, &TopicMap::from_log(&log).unwrap().only(&[Role::Scan]))?;
    match &entries[0].content {
        Content::Event(EventKind::Frame(frame)) => Ok(frame.clone()),
        other => panic!("{other:?}"),
    }
}

fn readings(topics: &[Topic]) -> Vec<(f64, Reading)> {
    read(topics).unwrap().scan.unwrap().readings().collect()
}

const USUAL: [f32; 4] = [-1.0, 1.0, 0.1, 10.0];

#[test]
fn a_scanner_is_where_the_transforms_of_its_frame_place_it() {
    let scan = || scan(USUAL, &[1.0, f32::INFINITY, f32::NAN]);
    // Without transforms, the scanner is the robot.
    let alone = read(&[scan()]).unwrap().scan.unwrap();
    assert_eq!((alone.scanner(), alone.heading()), (Point2::origin(), 0.0));
    let turned = ("/base_link", "laser", [0.5, 0.25, 1.0], [0.0, 0.0, 1.0, 0.0]);
    let moving = ("odom", "base_link", [7.0, 7.0, 0.0], LEVEL);
    for name in ["/tf", "/tf_static"] {
        let scan = read(&[scan(), transforms(name, &[moving, turned])]).unwrap().scan.unwrap();
        assert_eq!(scan.scanner(), Point2::new(0.5, 0.25), "{name}");
        assert!((scan.heading() - PI).abs() < 1e-12, "{name}");
    }
    // Half a metre ahead a plate is turned to the left, and on it the scanner again.
    let plate = ("base_link", "plate", [0.5, 0.0, 0.2], LEFT);
    let on_plate = ("plate", "laser", [0.1, 0.0, 0.1], LEFT);
    let found = read(&[scan(), transforms("/tf_static", &[moving, plate, on_plate])]).unwrap();
    let found = found.scan.unwrap();
    assert!((found.scanner() - Point2::new(0.5, 0.1)).norm() < 1e-12, "{found:?}");
    assert!((found.heading().abs() - PI).abs() < 1e-12, "{found:?}");
    // Upside down, what is left of the scanner is on its right.
    let over = ("base_footprint", "laser", [0.0; 3], [1.0, 0.0, 0.0, 0.0]);
    let found = readings(&[scan(), transforms("/tf_static", &[over])]);
    assert_eq!(found[2], (1.0, Reading::Hit(1.0)));
    assert_eq!((found[1].1, found[0].1), (Reading::NoReturn, Reading::Invalid));
}

#[test]
fn a_scanner_that_is_not_connected_or_not_level_is_an_error() {
    let [_, _, half, _] = LEFT;
    let apart = "its frame \"laser\" is not connected to the robot: no transform leads from it to base_link, \
        base_footprint, base";
    // The frames `plate` and `laser` may stand in a circle.
    for (parent, turn, message) in [
        ("map", LEVEL, apart),
        ("plate", LEVEL, apart),
        ("base_link", [half, 0.0, 0.0, half], "its frame \"laser\" is not level"),
    ] {
        let circle = ("laser", "plate", [0.0; 3], LEVEL);
        let transforms = transforms("/tf", &[(parent, "laser", [0.0; 3], turn), circle]);
        let error = read(&[scan(USUAL, &[1.0]), transforms]).unwrap_err();
        assert!(error.contains(&format!(": message 1, on /scan: {message}")), "{error}");
        assert_eq!(error.contains("[scanner] mount = [x, y, yaw]"), message == apart, "{error}");
    }
}

/// Odometry of a frame at (1, 2) that looks along y.
fn odometry_of(child: &str) -> Topic {
    let (name, type_name, definition, _) = odometry();
    let fields = "Header header\nstring child_frame_id\n";
    let message = [header(8, "odom"), text(child), pose([1.0, 2.0, 0.0], LEFT)].concat();
    (name, type_name, definition.replacen("Header header\n", fields, 1), vec![message])
}

/// Where the scanner is, by the frame of a log's odometry, its transforms, and a topics file.
fn scanner_pose(child: &str, edges: &[Transform], topics: &str) -> [f64; 3] {
    let odometry = odometry_of(child);
    let log = log_of(&[scan(USUAL, &[1.0]), odometry, transforms("/tf_static", edges)]);
    let log = Log::of_bytes(log).unwrap();
    let map = match topics {
        "" => TopicMap::from_log(&log).unwrap(),
        _ => TopicMap::read(topics.as_bytes()).unwrap().completed(&log),
    };
    let pose = entries_of(&log, &map).unwrap().into_iter().find_map(|entry| match entry.content {
        Content::Event(EventKind::Frame(frame)) => frame.scan,
        _ => None,
    });
    let pose = pose.unwrap().robot_from_scanner();
    [pose.translation.x, pose.translation.y, pose.rotation.angle()]
}

#[test]
fn frames_are_connected_in_any_direction_and_the_robot_has_any_name() {
    let near = |found: [f64; 3], expected: [f64; 3]| {
        let off = found.iter().zip(expected).map(|(one, other)| (one - other).abs());
        assert!(off.into_iter().all(|off| off < 1e-6), "{found:?} {expected:?}");
    };
    let ahead = |parent, child| (parent, child, [0.5, 0.25, 0.0], LEVEL);
    let turned = |parent, child| (parent, child, [0.5, 0.25, 0.0], LEFT);
    // Siblings, and a reversed tree.
    let siblings = [("chassis", "base_link", [0.1, 0.0, 0.0], LEVEL), ahead("chassis", "laser")];
    near(scanner_pose("base_link", &siblings, ""), [0.4, 0.25, 0.0]);
    near(scanner_pose("base_link", &[turned("laser", "base_link")], ""), [-0.25, 0.5, -FRAC_PI_2]);
    // A robot of another name.
    near(scanner_pose("/r1/hull", &[turned("r1/hull", "laser")], ""), [0.5, 0.25, FRAC_PI_2]);
    let hull = "[scanner]\nbase_frame = \"hull\"\n";
    let two = [ahead("hull", "base_link"), ahead("base_link", "laser")];
    near(scanner_pose("base_link", &two, hull), [1.0, 0.5, 0.0]);
    // What a topics file states.
    let mount = "[scanner]\nmount = [-0.25, 0, 3.0]\n";
    near(scanner_pose("base_link", &[ahead("map", "laser")], mount), [-0.25, 0.0, 3.0]);
}

#[test]
fn odometry_of_another_frame_is_that_of_the_robot() {
    // A camera 0.5 m ahead that looks to the left.
    let camera = ("base_link", "cam", [0.5, 0.0, 0.0], LEFT);
    let log = log_of(&[odometry_of("cam"), transforms("/tf_static", &[camera])]);
    let log = Log::of_bytes(log).unwrap();
    let map = TopicMap::from_log(&log).unwrap().bind(&log).unwrap();
    let mut read = log.entries(&map);
    let entries: Vec<_> = read.by_ref().map(Result::unwrap).collect();
    let [Entry { content: Content::Event(EventKind::Odometry(at)), .. }] = &entries[..] else {
        panic!("{entries:?}")
    };
    // The camera is at 1, 2 and looks along y: the robot looks along x, and is half a metre behind.
    assert!((at.position[0] - 0.5).abs() < 1e-9 && (at.position[1] - 2.0).abs() < 1e-9, "{at:?}");
    assert!(at.heading.abs() < 1e-9, "{at:?}");
    assert_eq!(read.remarks(), [ReadingRemark::TrackedFrame { frame: "cam".to_owned() }]);
}

#[test]
fn what_a_range_of_0_means_is_known_whatever_range_the_driver_states() {
    for most in [0.5, 10.0, 1000.0, 1e30, f32::INFINITY] {
        let ranges = [&[0.25][..], &[0.0; 10]].concat();
        let found = readings(&[scan([-1.0, 0.125, 0.1, most], &ranges)]);
        let found: Vec<Reading> = found.into_iter().map(|(_, reading)| reading).collect();
        let expected = [&[Reading::Hit(0.25)][..], &[Reading::NoReturn; 10]].concat();
        assert_eq!(found, expected, "{most}");
    }
}

#[test]
fn impossible_angles_and_limits_are_errors_and_a_clockwise_scan_is_reversed() {
    for (numbers, ranges, message) in [
        ([-1.0, 0.0, 0.1, 10.0], &[1.0][..], "the angle increment of the scan is 0"),
        ([-1.0, f32::NAN, 0.1, 10.0], &[1.0], "the angle increment of the scan is NaN"),
        ([-1.0, 1.0, 10.0, 0.5], &[1.0], "the ranges of the scan go from 10 m to 0.5 m"),
        (USUAL, &[], "the scan has no readings"),
    ] {
        let error = read(&[scan(numbers, ranges)]).unwrap_err();
        assert!(error.ends_with(&format!(": message 1, on /scan: {message}")), "{error}");
    }
    let found = readings(&[scan([1.0, -1.0, 0.1, 10.0], &[3.0, 2.0])]);
    assert_eq!(found, [(0.0, Reading::Hit(2.0)), (1.0, Reading::Hit(3.0))]);
}

#[test]
fn odometry_is_preferred_to_transforms() {
    let place = ("odom", "base_footprint", [3.0, 4.0, 0.0], LEFT);
    let wheel = ("base_footprint", "wheel", [9.0; 3], LEVEL);
    let tf = || transforms("/tf", &[wheel, place]);
    for (topics, carrier, position, second) in
        [(vec![odometry(), tf()], "/odom", [1.0, 2.0], 8), (vec![tf()], "/tf", [3.0, 4.0], 9)]
    {
        let log = Log::of_bytes(log_of(&topics)).unwrap();
        let mapping = TopicMap::from_log(&log).unwrap();
        assert_eq!(mapping.carrier(Role::Odometry).unwrap().topic, carrier);
        let entries = entries(&log);
        let [entry] = &entries[..] else { panic!("{entries:?}") };
        let Content::Event(EventKind::Odometry(at)) = &entry.content else { panic!() };
        assert_eq!((at.position, entry.stamp.sec), (position, second));
        assert!((at.heading - FRAC_PI_2).abs() < 1e-12);
    }
    // Transforms between other frames are no odometry.
    let log = Log::of_bytes(log_of(&[transforms("/tf", &[wheel])])).unwrap();
    assert_eq!(entries(&log), []);
}

/// Otherwise the visits of the log would be derived from scans that are shifted or turned.
#[test]
fn the_log_of_a_run_says_where_its_scanner_is() {
    let geometry =
        ScanGeometry { angle_min: -0.5, angle_increment: 0.5, range_min: 0.1, range_max: 30.0 };
    for mount in [Isometry2::identity(), Isometry2::new(Vector2::new(-0.25, 0.125), 3.0)] {
        let scan = Arc::new(Scan::new(geometry, vec![1.0, 2.0, 3.0], mount).unwrap());
        let mut log = Vec::new();
        let mut recorder = Recorder::new(&mut log, &messages::Run::default(), None).unwrap();
        for id in 1..=3 {
            let frame = Frame { id, scan: Some(scan.clone()), ..Frame::default() };
            for kind in [EventKind::Odometry(Odometry::default()), EventKind::Frame(frame)] {
                recorder.event(&Event { id: EventId(id), time: id, truth: None, kind });
            }
        }
        recorder.finish().unwrap();
        let read = entries(&Log::of_bytes(log).unwrap()).into_iter();
        let scans: Vec<_> = read
            .filter_map(|entry| match entry.content {
                Content::Event(EventKind::Frame(frame)) => frame.scan,
                _ => None,
            })
            .collect();
        assert_eq!(scans.len(), 3);
        for read in scans {
            let off = read.robot_from_scanner().inverse() * mount;
            assert!(off.translation.vector.norm() < 1e-9 && off.rotation.angle().abs() < 1e-9);
            assert_eq!(read.ranges(), scan.ranges());
        }
    }
}
