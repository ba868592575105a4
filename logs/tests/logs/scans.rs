//! Scans of ROS, and where their scanners are on the robot.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Point2;
use toposlam_logs::{
    entries::Content,
    reader::Log,
    record::{EventKind, Frame},
    topic_map::{Role, TopicMap},
};
use toposlam_vision::laser::scan::Reading;

use super::roles::{Topic, header_in, log_of, numbers, text};

const SCAN: &str = "Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n\
    float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\n\
    float32[] ranges\nfloat32[] intensities\n===\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\n\
    string frame_id\n";
const TRANSFORMS: &str = "TransformStamped[] transforms\n===\nMSG: geometry_msgs/TransformStamped\n\
    Header header\nstring child_frame_id\nTransform transform\n===\nMSG: std_msgs/Header\nuint32 seq\n\
    time stamp\nstring frame_id\n===\nMSG: geometry_msgs/Transform\nVector3 translation\n\
    Quaternion rotation\n===\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n===\n\
    MSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n";
pub(super) const ODOMETRY: &str = "Header header\nPoseWithCovariance pose\n===\nMSG: std_msgs/Header\nuint32 seq\n\
    time stamp\nstring frame_id\n===\nMSG: geometry_msgs/PoseWithCovariance\nPose pose\n===\n\
    MSG: geometry_msgs/Pose\nPoint position\nQuaternion orientation\n===\nMSG: geometry_msgs/Point\n\
    float64 x\nfloat64 y\nfloat64 z\n===\nMSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\n\
    float64 z\nfloat64 w\n";

/// First angle, increment, least and largest range, ranges.
fn scan(numbers: [f32; 4], ranges: &[f32]) -> Topic {
    let [first, increment, least, most] = numbers;
    let body = [first, 0.0, increment, 0.0, 0.0, least, most].map(f32::to_le_bytes).concat();
    let list: Vec<u8> = ranges.iter().flat_map(|range| range.to_le_bytes()).collect();
    let length = (ranges.len() as u32).to_le_bytes().to_vec();
    let message = [header_in(7, "laser"), body, length, list, vec![0; 4]].concat();
    ("/scan", "sensor_msgs/LaserScan", SCAN, vec![message])
}

/// Parent, child, translation and quaternion of each.
pub(super) type Transform<'t> = (&'t str, &'t str, [f64; 3], [f64; 4]);

pub(super) fn transforms(name: &'static str, all: &[Transform]) -> Topic {
    let mut message = (all.len() as u32).to_le_bytes().to_vec();
    for (parent, child, translation, rotation) in all {
        message.extend(header_in(9, parent));
        message.extend([text(child), numbers(*translation), numbers(*rotation)].concat());
    }
    (name, "tf2_msgs/TFMessage", TRANSFORMS, vec![message])
}

pub(super) const LEVEL: [f64; 4] = [0.0, 0.0, 0.0, 1.0];

fn read(topics: &[Topic]) -> Result<Frame, String> {
    let log = Log::of_bytes(log_of(topics)).unwrap();
    let mapping = TopicMap::from_log(&log).unwrap().only(&[Role::Scan]);
    let entry = log.entries(&mapping.bind(&log).unwrap()).next().unwrap();
    match entry.map_err(|error| error.to_string())?.content {
        Content::Event(EventKind::Frame(frame)) => Ok(frame),
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
    // Upside down, what is left of the scanner is on its right.
    let over = ("base_footprint", "laser", [0.0; 3], [1.0, 0.0, 0.0, 0.0]);
    let found = readings(&[scan(), transforms("/tf_static", &[over])]);
    assert_eq!(found[2], (1.0, Reading::Hit(1.0)));
    assert_eq!((found[1].1, found[0].1), (Reading::NoReturn, Reading::Invalid));
}

#[test]
fn a_scanner_that_is_not_connected_or_not_level_is_an_error() {
    let half = 0.5_f64.sqrt();
    for (transform, message) in [
        (
            ("map", "laser", [0.0; 3], LEVEL),
            "its frame \"laser\" is not connected to the robot: no transform leads from it to base_link, base_footprint, base",
        ),
        (
            ("base_link", "laser", [0.0; 3], [half, 0.0, 0.0, half]),
            "its frame \"laser\" is not level",
        ),
    ] {
        let error = read(&[scan(USUAL, &[1.0]), transforms("/tf", &[transform])]).unwrap_err();
        assert!(error.ends_with(&format!(": message 1, on /scan: {message}")), "{error}");
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
    let half = 0.5_f64.sqrt();
    let pose = numbers([1.0, 2.0, 0.0, 0.0, 0.0, half, half]);
    let message = [header_in(8, "odom"), pose].concat();
    let odometry = ("/odom", "nav_msgs/Odometry", ODOMETRY, vec![message]);
    let place = ("odom", "base_footprint", [3.0, 4.0, 0.0], [0.0, 0.0, half, half]);
    let wheel = ("base_footprint", "wheel", [9.0; 3], LEVEL);
    let tf = || transforms("/tf", &[wheel, place]);
    for (topics, carrier, position, second) in
        [(vec![odometry, tf()], "/odom", [1.0, 2.0], 8), (vec![tf()], "/tf", [3.0, 4.0], 9)]
    {
        let log = Log::of_bytes(log_of(&topics)).unwrap();
        let mapping = TopicMap::from_log(&log).unwrap();
        assert_eq!(mapping.carrier(Role::Odometry).unwrap().topic, carrier);
        let entries: Vec<_> =
            log.entries(&mapping.bind(&log).unwrap()).map(Result::unwrap).collect();
        let [entry] = &entries[..] else { panic!("{entries:?}") };
        let Content::Event(EventKind::Odometry(at)) = &entry.content else { panic!() };
        assert_eq!((at.position, entry.stamp.sec), (position, second));
        assert!((at.heading - FRAC_PI_2).abs() < 1e-12);
    }
    // Transforms between other frames are no odometry.
    let log = Log::of_bytes(log_of(&[transforms("/tf", &[wheel])])).unwrap();
    let mapping = TopicMap::from_log(&log).unwrap();
    assert_eq!(log.entries(&mapping.bind(&log).unwrap()).count(), 0);
}
