//! `toposlam conform` on logs that a test writes or changes. Most facts are in `tests/facts/conform.txt` and
//! `tests/facts/walks.txt`, the sentences in `tests/snapshots/conform`.

use std::{f64::consts::PI, path::Path, process::Command};

use serde_json::{Value, json};
use toposlam_logs::{
    messages::{self, End, Percept, ProjectMessage, Scene, Stamp},
    recorder::ODOM,
    standard::{OdometryMessage, Twist},
    writer::LogWriter,
};
use toposlam_model::{counts::grouped, driving};

use super::{
    Scratch,
    containers::{rewritten, set_stamp},
    flat, has, stderr,
};

const OF_SHAPE_6: &str = "conform run.mcap --world worlds/shape-6.toml";
const OF_SHAPE_8: &str = "conform run.mcap --world worlds/shape-8.toml";

/// A folder with the log of a run without images in shape 6, `run.mcap`. Algorithm 1 maps.
fn logged(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    let run = "simulate worlds/shape-6.toml --by-scene --algorithm algorithm1 --seed 3";
    scratch.out(&format!("{run} --log run.mcap"), 0);
    scratch
}

/// What `--json` prints of a log.
fn judged(scratch: &Scratch, line: &str, code: i32) -> Value {
    let lines = scratch.lines(line, code);
    lines.into_iter().find(|line| line["kind"] == "log").unwrap()
}

#[test]
fn a_log_without_an_end_is_not_known_to_conform() {
    let scratch = logged("conform-endless");
    let [log, endless] = ["run.mcap", "endless.mcap"].map(|name| scratch.path(name));
    rewritten(&log, &endless, |_, message| message.channel.topic != End::TOPIC);
    let expected = json!({
        "verdict": "not-known", "remarks.0": "the log does not record how the run ended",
    });
    scratch.fact("conform endless.mcap --world worlds/shape-6.toml", 3, &expected);
}

/// PyPI's `rosbags` makes a ROS 1 bag of a log.
#[test]
fn a_log_converted_to_ros_1_conforms_and_is_replayed() {
    let scratch = logged("conform-ros1");
    let mut convert = Command::new("rosbags-convert");
    let convert = convert.current_dir(&scratch.0).args(["--src", "run.mcap", "--dst", "run.bag"]);
    let Ok(output) = convert.output() else {
        let required = std::env::var("TOPOSLAM_PYTHON_LOGS").is_ok_and(|is| is == "required");
        assert!(!required, "there is no rosbags-convert");
        return eprintln!("skipped: there is no rosbags-convert of PyPI's rosbags");
    };
    assert!(output.status.success(), "{}", stderr(&output));
    scratch.facts(&[
        (
            "conform run.bag --world worlds/shape-6.toml",
            0,
            json!({ "verdict": "conforms", "events": 15 }),
        ),
        ("conform --rerun run.bag", 0, json!({ "map": true, "difference": null })),
    ]);
}

/// Somebody drives a robot along x to an L, and then between its doors. The log has only scenes and
/// odometry.
#[test]
fn the_shorter_log_contains_the_scenes_before_the_robot_strayed() {
    let scratch = Scratch::new("conform-strayed");
    let mut writer = LogWriter::new(Vec::new()).unwrap();
    let mut see = |second: i32, x: f64, heading: f64, doors: &[f64]| {
        let stamp = Stamp { sec: second, nanosec: 0 };
        let time = stamp.nanoseconds();
        let at = driving::odometry::Odometry { position: [x, 0.0], heading };
        let odometry = OdometryMessage::new(stamp, &at, Twist::default());
        writer.write(ODOM, time, &odometry).unwrap();
        let mut scene =
            Scene { stamp, place: "hallway".into(), status: "clear".into(), ..Scene::default() };
        if !doors.is_empty() {
            scene = Scene { stamp, place: "junction".into(), confidence: 1.0, ..Scene::default() };
            (scene.doors, scene.turning_point) = (doors.to_vec(), [-x, 0.0]);
        }
        writer.write(Scene::TOPIC, time, &scene).unwrap();
    };
    let l = [PI, PI / 2.0];
    for second in 0..20 {
        see(second, -12.0 + 0.5 * f64::from(second), 0.0, &[]);
    }
    see(20, -0.5, 0.0, &l);
    see(21, -0.2, 0.0, &l);
    see(22, 0.9, PI / 4.0, &[]);
    scratch.write("run.mcap", writer.finish().unwrap());
    let minimise = "conform run.mcap --driver anyone --minimise short.mcap";
    let condition = "the robot drove off 45 degrees from the door";
    let expected = json!({ "class": "motion", "cause": "aside", "condition": condition });
    scratch.fact(minimise, 1, &expected);
    scratch.fact("conform short.mcap --driver anyone", 1, &expected);
    assert!(scratch.bytes("short.mcap").len() < scratch.bytes("run.mcap").len());
}

/// Real bags, recorded by ROS itself: there is nothing in them that could be judged.
#[test]
fn logs_without_evidence_are_an_error() {
    let scratch = Scratch::new("conform-bags");
    let logs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/logs");
    if !logs.is_dir() {
        eprintln!("skipped: there are no bags in {}", logs.display());
        return;
    }
    for (name, cause) in [
        ("example.bag", "2 topics could carry odometry: /turtle1/pose, /turtle2/pose"),
        ("example-unsorted-chunks.bag", "no topics are known for percepts and doors"),
        ("no-messages.bag", "the log is empty: it has no messages"),
    ] {
        let message = scratch.error(&format!("conform {}", logs.join(name).display()));
        assert!(message.contains(cause), "{name}: {message}");
    }
}

#[test]
fn a_scene_or_odometry_with_a_wrong_stamp_is_skipped_and_counted() {
    let scratch = logged("conform-stamps");
    let before = judged(&scratch, &format!("{OF_SHAPE_6} --events scenes"), 0);
    let none = json!({"off_clock": 0, "scans_without_odometry": 0});
    assert_eq!(before["skipped_messages"], none);
    // The stamps of these messages, by their numbers on a topic, are far from all others.
    let far = 2_000_000_000;
    let change = |topic: &str, is_far: &dyn Fn(usize) -> bool| {
        let mut numbers = 0..;
        let [log, changed] = ["run.mcap", "changed.mcap"].map(|name| scratch.path(name));
        rewritten(&log, &changed, |_, message| {
            if message.channel.topic == topic && numbers.next().is_some_and(is_far) {
                set_stamp(message, far);
            }
            true
        });
    };
    let of_changed = "conform changed.mcap --world worlds/shape-6.toml --events scenes";
    for topic in [ODOM, Scene::TOPIC] {
        // In the middle of a stretch of hallway, and at a junction.
        change(topic, &|number| [30, 50].contains(&number));
        let after = judged(&scratch, of_changed, 0);
        let skipped = json!({"off_clock": 2, "scans_without_odometry": 0});
        let remark = "skipped messages: 2 whose time is far from that of all others";
        has(&after, &json!({ "skipped_messages": skipped, "remarks.0": remark }), topic);
        for fact in ["verdict", "events", "candidates", "unique"] {
            assert_eq!(after[fact], before[fact], "{topic}: {fact}");
        }
    }
    // What cannot be skipped is an error: the time of a scene decides where the robot was.
    change(Scene::TOPIC, &|number| number >= 60);
    let message = scratch.error(of_changed);
    let cause = "its time, 2000000000.000 s, is more than an hour from that of all odometry";
    assert!(message.contains(cause), "{message}");
    // An event has its place in the order; without it the others mean something else.
    change(Percept::TOPIC, &|number| number == 2);
    let message = scratch.error("conform changed.mcap");
    assert!(message.contains("the one before it at 2000000000.000 s"), "{message}");
}

/// The number of a row is that of the table, not that of the message in the order of time.
#[cfg(feature = "sqlite")]
#[test]
fn a_divergence_in_a_database_names_its_row() {
    let scratch = logged("conform-row");
    let database = scratch.path("run.db3");
    rewritten(&scratch.path("run.mcap"), &database, |_, _| true);
    let of_file = judged(&scratch, &format!("{OF_SHAPE_8} --start any"), 1);
    let other = "conform run.db3 --world worlds/shape-8.toml --start any";
    let line = judged(&scratch, other, 1);
    for fact in ["event", "cause", "class", "message", "condition"] {
        assert_eq!(line[fact], of_file[fact], "{fact}");
    }
    assert_eq!((&of_file["offset_unit"], &line["offset_unit"]), (&"byte".into(), &"row".into()));
    // The first row is 101.
    let row = line["offset"].as_i64().unwrap();
    assert_eq!(row, line["message"].as_i64().unwrap() + 100);
    let topic = rusqlite::Connection::open(&database).unwrap().query_row(
        "SELECT name FROM messages JOIN topics ON topics.id = topic_id WHERE messages.id = ?1",
        [row],
        |found| found.get::<_, String>(0),
    );
    let is_percept = line["event"].as_u64().unwrap() % 2 == 1;
    assert_eq!(topic.unwrap(), if is_percept { Percept::TOPIC } else { messages::Door::TOPIC });
    let text = scratch.out(&format!("{other} --html page.html"), 1);
    let place = format!(", at row {}", grouped(u64::try_from(row).unwrap().into()));
    assert!(flat(&text).contains(&place), "{text}");
    assert!(scratch.text("page.html").contains(&place));
}

/// *Database File Format* of SQLite, section 1.3: the size of a page, and the number of pages.
#[cfg(feature = "sqlite")]
#[test]
fn a_database_whose_header_counts_other_pages_is_truncated() {
    let scratch = logged("conform-pages");
    rewritten(&scratch.path("run.mcap"), &scratch.path("run.db3"), |_, _| true);
    let whole = scratch.bytes("run.db3");
    let page = usize::from(u16::from_be_bytes([whole[16], whole[17]]));
    let pages = whole.len() / page;
    assert_eq!(whole[28..32], u32::try_from(pages).unwrap().to_be_bytes());
    let messages = scratch.last("info run.db3 --verify", 0)["messages"].as_u64().unwrap();
    let verdict = |log: &str, code| judged(&scratch, &format!("conform {log}"), code);
    assert_eq!(verdict("run.db3", 0)["verdict"], "conforms");
    let counts = format!("its header counts {pages} pages, and it has");
    for (bytes, cause, expected) in [
        (
            [&whole[..], b"another log"].concat(),
            "11 more bytes follow".to_owned(),
            messages..=messages,
        ),
        // The last page may have none of the messages.
        (whole[..whole.len() - 1].to_vec(), format!("{counts} {}", pages - 1), 1..=messages),
        (whole[..whole.len() / 2 / page * page].to_vec(), counts, 1..=messages - 1),
    ] {
        scratch.write("other.db3", &bytes);
        for options in ["", " --verify"] {
            let line = scratch.last(&format!("info other.db3{options}"), 3);
            let truncated = line["truncated"]["cause"].as_str().unwrap();
            assert!(truncated.contains(&cause), "{truncated}");
            let read = line["messages"].as_u64().unwrap();
            assert!(expected.contains(&read), "{read} of {messages}");
        }
        let line = verdict("other.db3", 3);
        assert_eq!(line["verdict"], "not-known");
        assert!(line["truncated"]["cause"].as_str().unwrap().contains(&cause), "{line}");
    }
    // What is missing may be in the log of a transaction that did not end.
    scratch.write("other.db3", &whole[..whole.len() - page]);
    scratch.write("other.db3-wal", "frames");
    scratch.out("info other.db3", 2);
}

/// One log is checked, and the next one is being read.
#[cfg(unix)]
#[test]
fn an_interrupted_check_leaves_the_page_as_it_was() {
    let scratch = logged("conform-interrupted");
    for earlier in [None, Some("the page of an earlier check")] {
        if let Some(text) = earlier {
            scratch.write("page.html", text);
        }
        let paths = ["run.mcap", "page.html"].map(|name| scratch.path(name).display().to_string());
        let output = super::interrupted(&format!("conform {} - --html {}", paths[0], paths[1]));
        assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
        assert_eq!(stderr(&output), "interrupted\n");
        let files: &[_] =
            if earlier.is_some() { &["page.html", "run.mcap"] } else { &["run.mcap"] };
        assert_eq!(scratch.written(), files);
        assert!(earlier.is_none_or(|earlier| scratch.text("page.html") == earlier));
    }
}
