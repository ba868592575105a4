//! Robots with a laser scanner: `toposlam simulate --sensor`.

use mcap::Message;
use serde_json::{Value, json};

use super::{Scratch, containers::rewritten, has, objects, stdout};

const PLAN: &str = "worlds/laser/long-8.toml";
const LASER: &str = "--events laser --driver anyone --marker none";

/// A time in nanoseconds that is far from all others: the year 2106.
const FAR: u64 = 4_294_967_000_000_000_000;

/// The log of a run in the plan, as `run.mcap`.
fn logged(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    scratch.out(&format!("simulate {PLAN} --sensor laser --noise 0.1 --log run.mcap"), 0);
    scratch
}

/// What `conform` prints of a log, whatever the verdict.
fn conform(scratch: &Scratch, log: &str) -> Value {
    let output = scratch.run(&format!("conform {log} {LASER} --json"));
    objects(&stdout(&output)).pop().unwrap_or_else(|| panic!("{output:?}"))
}

#[test]
fn a_robot_that_has_only_a_laser_scanner_maps_a_plan_and_its_log_conforms() {
    let scratch = logged("simulate_laser");
    scratch.out(&format!("conform run.mcap --world {PLAN}"), 0);
    let topics = scratch.out("info run.mcap", 0);
    assert!(topics.contains("/scan") && !topics.contains("/camera"), "{topics}");
    // To a laser scanner corners are no junctions: shape 8 is two vertices joined by three edges.
    let by_scans = format!("conform run.mcap {LASER} --start any --world");
    let text = scratch.out(&format!("{by_scans} worlds/theta-plane.toml"), 0);
    // This scanner looks all around.
    assert!(!text.contains("hardly"), "{text}");
    // A cross is another world.
    let output = scratch.run(&format!("{by_scans} worlds/figure-1a.toml"));
    assert_ne!(output.status.code(), Some(2), "{output:?}");
}

/// A robot leaves a junction by an arm that its scans show coarsely. That is no fault of the robot.
#[test]
fn a_log_of_scans_does_not_accuse_a_robot_that_mapped_its_plan() {
    let scratch = Scratch::new("laser_not_accused");
    for seed in [0, 1] {
        scratch.out(&format!("simulate {PLAN} --sensor laser --seed {seed} --log run.mcap"), 0);
        scratch.out(&format!("conform run.mcap {LASER}"), 0);
    }
}

/// The recorder of an MCAP file, a database of rosbag2 or a ROS 1 bag has a clock.
#[test]
fn messages_off_the_clock_are_skipped_and_counted() {
    let scratch = logged("laser_containers");
    let log = scratch.path("run.mcap");
    for (file, format) in [("changed.mcap", "mcap"), ("run.db3", "db3"), ("run.bag", "bag")] {
        if format == "db3" && !cfg!(feature = "sqlite") {
            continue;
        }
        let changed = scratch.path(file);
        // Seconds since 1970, as on a real robot.
        let begun = 1_700_000_000_000_000_000;
        rewritten(&log, &changed, |_, message| {
            message.log_time += begun;
            true
        });
        scratch.facts(&[(&format!("info {file}"), 0, json!({ "format": format }))]);
        let before = conform(&scratch, file);
        let none = json!({"off_clock": 0, "scans_without_odometry": 0});
        has(&before, &json!({ "skipped_messages": none, "events": 10 }), file);
        // Two scans and an odometry far ahead, and a scan at the very beginning of time.
        let (mut scans, mut odometry) = (0, 0);
        rewritten(&log, &changed, |_, message| {
            message.log_time += begun;
            match &*message.channel.topic {
                "/scan" => scans += 1,
                "/odom" => odometry += 1,
                _ => return true,
            }
            match (&*message.channel.topic, scans, odometry) {
                ("/scan", 100 | 200, _) | ("/odom", _, 500) => message.log_time = FAR,
                ("/scan", 300, _) => message.log_time = 0,
                _ => {}
            }
            true
        });
        let remark = "skipped messages: 4 whose time is far from that of all others";
        has(
            &conform(&scratch, file),
            &json!({
                "skipped_messages": {"off_clock": 4, "scans_without_odometry": 0},
                "scans": before["scans"].as_u64().unwrap() - 3, "remarks.0": remark,
                "verdict": before["verdict"], "events": before["events"], "event": before["event"],
                "cause": before["cause"], "lengths": before["lengths"],
            }),
            file,
        );
    }
    // The odometry begins late, or never. Of the scans before it, the last 50 wait for it.
    let changed = scratch.path("changed.mcap");
    let is_odometry = |message: &Message| message.channel.topic == "/odom";
    let mut seen = 0;
    rewritten(&log, &changed, |_, message| {
        seen += usize::from(message.channel.topic == "/scan");
        seen > 60 || !is_odometry(message)
    });
    let late = conform(&scratch, "changed.mcap");
    let without = late["skipped_messages"]["scans_without_odometry"].as_u64().unwrap();
    assert!((9..=11).contains(&without), "{late}");
    let remark = format!("skipped messages: {without} scans without odometry");
    has(&late, &json!({ "skipped_messages.off_clock": 0, "remarks.0": remark }), "late odometry");
    // Topics that have no message carry no odometry.
    rewritten(&log, &changed, |_, message| !is_odometry(message) && message.channel.topic != "/tf");
    let message = scratch.error(&format!("conform changed.mcap {LASER}"));
    assert!(message.contains("the log does not have what this needs"), "{message}");
}

#[test]
fn a_robot_with_both_sensors_drives_by_its_camera_and_records_scans() {
    let scratch = Scratch::new("simulate_both");
    scratch.write("scanner.toml", "field_of_view = 180.0\nnoise = 0.0\n");
    let both = "--by-scene --sensor both --scanner scanner.toml --log both.mcap";
    let text = scratch.out(&format!("simulate worlds/shape-6.toml {both}"), 0);
    assert!(text.contains("\n  scenes            "), "{text}");
    let object = scratch.last("info both.mcap", 0);
    let count = |name: &str| {
        let topics = object["topics"].as_array().unwrap();
        let topic = topics.iter().find(|topic| topic["name"] == name);
        topic.unwrap_or_else(|| panic!("{object}"))["messages"].clone()
    };
    assert_eq!(count("/scan"), count("/toposlam/scene"));
}
