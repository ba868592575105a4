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

use super::{
    entries, entries_of,
    ros1::{HEADER, LEFT, LEVEL, Topic, header, log_of, odometry, transforms, whole},
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
