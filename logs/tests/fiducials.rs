//! Sightings of a marker that is a fiducial: tags, objects and poses, in the frame of a camera.

use std::f64::consts::{FRAC_PI_2, PI};

use toposlam_logs::{
    entries::{Content, Entry},
    fiducials::FiducialSighting,
    reader::Log,
    topic_map::{Role, TopicMap},
};

use super::{
    entries_of, map,
    ros1::{
        self, HEADER, LEFT, LEVEL, Topic, header, log_of, numbers, odometry, posed, text,
        transforms, whole,
    },
    rosbags,
};

/// A robot at (1, 2) that looks along y, with a camera half a metre ahead.
fn robot() -> Vec<Topic> {
    vec![odometry(), transforms("/tf_static", &[("base_link", "camera", [0.5, 0.0, 1.0], LEVEL)])]
}

fn tags(all: &[(&str, u32)]) -> Topic {
    let definition = "Header header\nAprilTagDetection[] detections\n===\n\
        MSG: apriltag_msgs/AprilTagDetection\nstring family\nint32 id\nint32 hamming\n\
        float32 goodness\nfloat32 decision_margin\nPoint centre\nPoint[4] corners\n\
        float64[9] homography\n===\nMSG: apriltag_msgs/Point\nfloat64 x\nfloat64 y\n";
    let mut message = [header(9, "camera"), whole([all.len() as u32])].concat();
    for (family, id) in all {
        message.extend([text(family), whole([*id, 0, 0, 0]), numbers([0.0; 19])].concat());
    }
    let definition = [definition, HEADER].concat();
    ("/detections", "apriltag_msgs/AprilTagDetectionArray", definition, vec![message])
}

/// Objects of these classes at (2, 1) of the camera, turned to the left; the second hypothesis is better.
fn objects(classes: &[[&str; 2]]) -> Topic {
    let definition = "Header header\nDetection3D[] detections\n===\nMSG: vision_msgs/Detection3D\n\
        Header header\nObjectHypothesisWithPose[] results\nstring id\n===\n\
        MSG: vision_msgs/ObjectHypothesisWithPose\nObjectHypothesis hypothesis\n\
        geometry_msgs/PoseWithCovariance pose\n===\nMSG: vision_msgs/ObjectHypothesis\n\
        string class_id\nfloat64 score\n===\nMSG: geometry_msgs/PoseWithCovariance\nPose pose\n\
        float64[36] covariance\n";
    let mut message = [header(9, "camera"), whole([classes.len() as u32])].concat();
    for hypotheses in classes {
        message.extend([header(9, ""), whole([2])].concat());
        for (class, score) in hypotheses.iter().zip([0.25, 0.75]) {
            let pose = [ros1::pose([2.0, 1.0, 0.0], LEFT), numbers([0.0; 36])].concat();
            message.extend([text(class), numbers([score]), pose].concat());
        }
        message.extend(text(""));
    }
    ("/objects", "vision_msgs/Detection3DArray", posed(definition), vec![message])
}

fn pose(frame: &str, position: [f64; 3], turn: [f64; 4]) -> Topic {
    let message = [header(9, frame), ros1::pose(position, turn)].concat();
    let definition = posed("Header header\nPose pose\n");
    ("/tag", "geometry_msgs/PoseStamped", definition, vec![message])
}

fn sightings(topics: &[Topic], mapping: &str) -> Result<Vec<FiducialSighting>, String> {
    sightings_in(&Log::of_bytes(log_of(topics)).unwrap(), mapping)
}

fn sightings_in(log: &Log, mapping: &str) -> Result<Vec<FiducialSighting>, String> {
    let mapping = map(mapping).completed(log).only(&[Role::Marker, Role::Odometry]);
    let sighting = |entry: Entry| match entry.content {
        Content::Fiducial(sighting) => Some(sighting),
        _ => None,
    };
    Ok(entries_of(log, &mapping)?.into_iter().filter_map(sighting).collect())
}

/// A marker 2 m ahead of the camera and 1 m to its left is 2.5 m along y of the robot and 1 m against x; it
/// points to the left of the robot, against x.
fn assert_there(found: &[FiducialSighting]) {
    let [FiducialSighting { position: [x, y], heading }] = found else { panic!("{found:?}") };
    assert!((x - 0.0).abs() < 1e-9 && (y - 4.5).abs() < 1e-9, "{found:?}");
    assert!((heading.abs() - PI).abs() < 1e-9, "{found:?}");
}

#[test]
fn a_tag_is_where_its_transform_with_the_stamp_of_the_detection_places_it() {
    let placed = |child| transforms("/tf", &[("camera", child, [2.0, 1.0, 0.0], LEFT)]);
    let with = |detected: Topic, placed: Topic| [robot(), vec![detected, placed]].concat();
    let found = [("tag36h11", 7), ("tag36h11", 3)];
    for mapping in [
        "[marker]\ntopic = \"/detections\"\n",
        "[marker]\ntopic = \"/detections\"\nid = 3\n",
        "[marker]\ntopic = \"/detections\"\nid = \"tag36h11:3\"\n",
    ] {
        // The transform may come before the detection.
        for first in [true, false] {
            let mut topics = with(tags(&found), placed("tag36h11:3"));
            if first {
                topics.swap(2, 3);
            }
            assert_there(&sightings(&topics, mapping).unwrap());
        }
    }
    let other = "[marker]\ntopic = \"/detections\"\nid = 7\n";
    assert_eq!(sightings(&with(tags(&found), placed("tag36h11:3")), other), Ok(Vec::new()));
    let named = "[marker]\ntopic = \"/detections\"\nid = 7\nframe = \"goal\"\n";
    assert_there(&sightings(&with(tags(&found), placed("goal")), named).unwrap());
    // What was not detected in this image was placed by someone else.
    assert_eq!(sightings(&with(tags(&[]), placed("goal")), named), Ok(Vec::new()));
}

#[test]
fn an_object_is_where_its_best_hypothesis_places_it() {
    let topics = [robot(), vec![objects(&[["chair", "arrow"], ["arrow", "chair"]])]].concat();
    let mapping = "[marker]\ntopic = \"/objects\"\nid = \"arrow\"\n";
    assert_there(&sightings(&topics, mapping).unwrap());
    let all = sightings(&topics, "[marker]\ntopic = \"/objects\"\n").unwrap();
    assert_eq!(all.len(), 2);
}

#[test]
fn a_pose_is_in_the_frame_of_odometry_or_of_the_robot() {
    let mapping = "[marker]\ntopic = \"/tag\"\n";
    let with = |pose: Topic| [robot(), vec![pose]].concat();
    assert_there(&sightings(&with(pose("camera", [2.0, 1.0, 0.0], LEFT)), mapping).unwrap());
    assert_there(&sightings(&with(pose("/base_link", [2.5, 1.0, 0.0], LEFT)), mapping).unwrap());
    let west = [0.0, 0.0, 1.0, 0.0];
    assert_there(&sightings(&with(pose("odom", [0.0, 4.5, 0.3], west)), mapping).unwrap());
    // A tag that hangs on a wall: its x axis is level.
    let (sine, cosine) = (FRAC_PI_2 / 2.0).sin_cos();
    let wall = [sine, 0.0, 0.0, cosine];
    let found = sightings(&with(pose("odom", [0.0, 4.5, 1.0], wall)), mapping).unwrap();
    assert!(found[0].heading.abs() < 1e-9);
    let apart = "its frame \"elsewhere\" is not connected to the robot: no transform leads";
    for (frame, turn, message) in [
        ("elsewhere", LEFT, apart),
        ("odom", [0.0, -sine, 0.0, cosine], "the x axis of the marker points up or down"),
        ("odom", [0.0; 4], "its `pose` is no pose"),
    ] {
        let error = sightings(&with(pose(frame, [0.0; 3], turn)), mapping).unwrap_err();
        assert!(error.contains(&format!("on /tag: {message}")), "{error}");
    }
}

#[test]
fn only_a_mapping_file_says_what_the_marker_is() {
    let log = Log::of_bytes(log_of(&[tags(&[]), pose("odom", [0.0; 3], LEVEL)])).unwrap();
    assert!(TopicMap::unambiguous(&log).carrier(Role::Marker).is_none());
    let mapping = "[marker]\ntopic = \"/detections\"\nid = 3\nframe = \"a\"\n";
    assert_eq!(map(mapping), map(&map(mapping).to_toml()));
    let read = map("[marker]\nat = [1, -2.5, 0.5]\n");
    let place = read.assumed_marker().unwrap();
    assert_eq!((place.position, place.heading), ([1.0, -2.5], Some(0.5)));
    assert_eq!(read.to_toml(), "[marker]\nat = [1.0, -2.5, 0.5]\n");
    for (text, message) in [
        ("[marker]\nat = [1]", "line 2, column 6: marker.at: expected a list of x, y and heading"),
        ("[marker]\nat = [1, inf]", "line 2, column 10: marker.at[1]: "),
        ("[marker]\nat = [1, 2]\ntopic = \"/tag\"", "line 3, column 1: marker.topic: unknown key"),
        ("[scan]\ntopic = \"a\"\nat = [1, 2]", "line 3, column 1: scan.at: unknown key"),
    ] {
        let error = TopicMap::read(text.as_bytes()).unwrap_err().to_string();
        assert!(error.starts_with(message), "{error}");
    }
}

/// The same tag, object and pose, written by PyPI's rosbags as ROS 2 and as ROS 1.
#[test]
fn the_same_fiducials_are_read_from_logs_of_another_writer() {
    let Some(folder) = rosbags::written_by("write_tags.py", "rosbags_tags") else { return };
    let mut names = vec!["mcap", "ros1.bag"];
    if cfg!(feature = "sqlite") {
        names.push("database");
    }
    for name in names {
        let log = Log::open(&folder.join(name)).unwrap();
        for mapping in [
            "[marker]\ntopic = \"/detections\"\nid = 3\n",
            "[marker]\ntopic = \"/objects\"\nid = \"arrow\"\n",
            "[marker]\ntopic = \"/tag\"\n",
        ] {
            let mapping = format!("[odometry]\ntopic = \"/odom\"\n{mapping}");
            let found = sightings_in(&log, &mapping).unwrap();
            assert_eq!(found.len(), 3, "{name}: {mapping}");
            for found in found {
                assert_there(&[found]);
            }
        }
    }
    std::fs::remove_dir_all(folder).unwrap();
}
