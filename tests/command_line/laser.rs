//! Robots with a laser scanner: `toposlam simulate --sensor`.

use std::{fs, path::Path};

use mcap::Message;
use serde_json::{Value, json};

use super::{containers::rewritten, folder, objects, run, stderr, stdout, stdout_of};

const PLAN: &str = "worlds/laser/long-8.toml";

/// A time in nanoseconds that is far from all others: the year 2106.
const FAR: u64 = 4_294_967_000_000_000_000;

#[test]
fn a_robot_that_has_only_a_laser_scanner_maps_a_plan_and_its_log_conforms() {
    let folder = folder("simulate_laser");
    let log = folder.join("laser.mcap");
    let log = log.to_str().unwrap();
    let text = stdout_of(["simulate", PLAN, "--sensor", "laser", "--noise", "0.1", "--log", log]);
    assert!(text.contains("The map is right") && text.contains("\n  scans             "), "{text}");
    stdout_of(["conform", log, "--world", PLAN]);
    let topics = stdout_of(["info", log]);
    assert!(topics.contains("/scan") && !topics.contains("/camera"), "{topics}");
    // To a laser scanner corners are no junctions: shape 8 is two vertices joined by three edges.
    let world = "worlds/theta-plane.toml";
    let options = ["--events", "laser", "--driver", "anyone", "--marker", "none", "--start", "any"];
    let text = stdout_of([&["conform", log, "--world", world][..], &options].concat());
    assert!(text.contains("conforms"), "{text}");
    // This scanner looks all around.
    assert!(!text.contains("hardly"), "{text}");
    // A cross is another world.
    let other = "worlds/figure-1a.toml";
    let output = run([&["conform", log, "--world", other][..], &options].concat());
    assert_ne!(output.status.code(), Some(2), "{}", stderr(&output));
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn laser_scans_without_a_time_or_a_place_are_skipped_and_counted() {
    let folder = folder("laser_skipped");
    let [log, changed, page] =
        ["run.mcap", "changed.mcap", "page.html"].map(|name| folder.join(name));
    let log = log.to_str().unwrap();
    stdout_of(["simulate", PLAN, "--sensor", "laser", "--noise", "0.1", "--log", log]);
    let arguments = ["--events", "laser", "--driver", "anyone", "--marker", "none"];
    let report = |log: &str, more: &[&str]| {
        let output = run([&["conform", log][..], &arguments, more].concat());
        (output.status.code(), stdout(&output), stderr(&output))
    };
    let json_of = |log: &str| objects(&report(log, &["--json"]).1).pop().unwrap();
    let before = json_of(log);
    let none = json!({"off_clock": 0, "scans_without_odometry": 0});
    assert_eq!(before["skipped_messages"], none);
    let remarks = |remark: &str| {
        let others = before["remarks"].as_array().unwrap();
        json!([&[json!(remark)][..], others].concat())
    };
    let scans = before["scans"].as_u64().unwrap();
    let is_scan = |message: &Message| message.channel.topic == "/scan";
    let is_odometry = |message: &Message| message.channel.topic == "/odom";

    // The clock of the recorder jumps far ahead and back, three times.
    let mut jumped = 0;
    rewritten(Path::new(log), &changed, |index, message| {
        let jumps = is_scan(message) && index > 500 * (jumped + 1) && jumped < 3;
        if jumps {
            jumped += 1;
            message.log_time = FAR;
        }
        true
    });
    let changed = changed.to_str().unwrap();
    let after = json_of(changed);
    let skipped = json!({"off_clock": 3, "scans_without_odometry": 0});
    assert_eq!((&after["skipped_messages"], &after["scans"]), (&skipped, &json!(scans - 3)));
    let remark = "skipped messages: 3 whose time is far from that of all others";
    assert_eq!(after["remarks"], remarks(remark));
    for fact in ["verdict", "events", "lengths"] {
        assert_eq!(after[fact], before[fact], "{fact}");
    }
    let (_, text, _) = report(changed, &["--html", page.to_str().unwrap()]);
    assert!(text.contains(remark), "{text}");
    let sentence = "<p>Skipped messages: 3 whose time is far from that of all others.</p>";
    assert!(fs::read_to_string(page).unwrap().contains(sentence));

    // The odometry begins late, or never. Of the scans before it, the last 50 wait for it.
    let mut seen = 0;
    rewritten(Path::new(log), Path::new(changed), |_, message| {
        seen += usize::from(is_scan(message));
        seen > 60 || !is_odometry(message)
    });
    let late = json_of(changed);
    assert_eq!(late["skipped_messages"]["off_clock"], 0);
    let without = late["skipped_messages"]["scans_without_odometry"].as_u64().unwrap();
    assert!((9..=11).contains(&without), "{late}");
    let remark = format!("skipped messages: {without} scans without odometry");
    assert_eq!(late["remarks"][0], json!(remark));
    // Topics that have no message carry no odometry.
    rewritten(Path::new(log), Path::new(changed), |_, message| {
        !is_odometry(message) && message.channel.topic != "/tf"
    });
    let (code, _, error) = report(changed, &[]);
    assert_eq!(code, Some(2), "{error}");
    assert!(error.contains("the log does not have what this needs"), "{error}");
    fs::remove_dir_all(folder).unwrap();
}

/// The recorder of a database of rosbag2 or a ROS 1 bag has a clock, too.
#[test]
fn messages_off_the_clock_are_skipped_in_a_database_and_a_bag() {
    let folder = folder("laser_containers");
    let log = folder.join("run.mcap");
    let noise = ["--sensor", "laser", "--noise", "0.1", "--log"];
    stdout_of([&["simulate", PLAN][..], &noise, &[log.to_str().unwrap()]].concat());
    let files: &[_] = if cfg!(feature = "sqlite") {
        &[("run.db3", "db3"), ("run.bag", "bag")]
    } else {
        &[("run.bag", "bag")]
    };
    for (file, format) in files {
        let changed = folder.join(file);
        let text = changed.to_str().unwrap();
        let conform = || {
            let events = ["--events", "laser", "--driver", "anyone", "--marker", "none", "--json"];
            let output = run([&["conform", text][..], &events].concat());
            objects(&stdout(&output)).pop().unwrap_or_else(|| panic!("{}", stderr(&output)))
        };
        // Seconds since 1970, as on a real robot.
        let begun = 1_700_000_000_000_000_000;
        rewritten(&log, &changed, |_, message| {
            message.log_time += begun;
            true
        });
        assert_eq!(objects(&stdout_of(["info", text, "--json"]))[0]["format"], *format);
        let before = conform();
        let none = json!({"off_clock": 0, "scans_without_odometry": 0});
        assert_eq!(before["skipped_messages"], none, "{file}");
        // Two scans and an odometry far ahead, and a scan at the very beginning of time.
        let mut scans = 0;
        let mut odometry = 0;
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
        let after = conform();
        let skipped = json!({"off_clock": 4, "scans_without_odometry": 0});
        assert_eq!(after["skipped_messages"], skipped, "{file}");
        let scans = [&before, &after].map(|line| line["scans"].as_u64().unwrap());
        assert_eq!(scans[0], scans[1] + 3, "{file}");
        let remark: Value = "skipped messages: 4 whose time is far from that of all others".into();
        assert_eq!(after["remarks"][0], remark, "{file}");
        for fact in ["verdict", "events", "event", "cause"] {
            assert_eq!(after[fact], before[fact], "{file}: {fact}");
        }
        assert_eq!(before["events"], 10, "{file}");
    }
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_robot_with_both_sensors_drives_by_its_camera_and_records_scans() {
    let folder = folder("simulate_both");
    let log = folder.join("both.mcap");
    let log = log.to_str().unwrap();
    let scanner = folder.join("scanner.toml");
    fs::write(&scanner, "field_of_view = 180.0\nnoise = 0.0\n").unwrap();
    let scanner = scanner.to_str().unwrap();
    let options = ["--by-scene", "--sensor", "both", "--scanner", scanner, "--log", log];
    let text = stdout_of([&["simulate", "worlds/shape-6.toml"][..], &options].concat());
    assert!(text.contains("\n  scenes            "), "{text}");
    let object = objects(&stdout_of(["info", log, "--json"])).remove(0);
    let count = |name: &str| {
        let topics = object["topics"].as_array().unwrap();
        let topic = topics.iter().find(|topic| topic["name"] == name);
        topic.unwrap_or_else(|| panic!("{object}"))["messages"].clone()
    };
    assert_eq!(count("/scan"), count("/toposlam/scene"));
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn options_without_an_effect_on_a_laser_scanner_are_errors() {
    let folder = folder("laser_bad");
    let write = |name: &str, text: &str| {
        let file = folder.join(name);
        fs::write(&file, text).unwrap();
        file.to_str().unwrap().to_owned()
    };
    let unknown = write("unknown.toml", "noises = 1.0\n");
    let far = write("far.toml", "range = 1000.0\n");
    let simulate = ["simulate", PLAN];
    let laser = ["simulate", PLAN, "--sensor", "laser"];
    let cases: [(&[&str], &[&str], &str); 7] = [
        (&simulate, &["--scanner", &far], "--scanner: the robot has no laser scanner"),
        (&laser, &["--by-scene"], "--by-scene: has no effect with --sensor laser"),
        (&laser, &["--size", "640x480"], "--size: has no effect with --sensor laser"),
        (&laser, &["--look", "vinyl"], "--look: has no effect with --sensor laser"),
        (&laser, &["--effect", "blur=1"], "--effect: has no effect with --sensor laser"),
        (&laser, &["--scanner", &unknown], "unknown.toml: line 1, column 1: noises: unknown key"),
        (&laser, &["--scanner", &far], "far.toml: line 1, column 9: range: 1000 is out of range"),
    ];
    for (verb, options, cause) in cases {
        let output = run([verb, options].concat());
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{options:?}: {message}");
        assert!(message.contains(cause), "{options:?}: {message}");
        assert!(output.stdout.is_empty(), "{options:?}");
    }
    fs::remove_dir_all(folder).unwrap();
}
