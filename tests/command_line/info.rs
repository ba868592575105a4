//! `toposlam info`: what logs hold, whole or not.

use std::fs;

use serde_json::json;

use super::{folder, objects, run, stderr, stdout, stdout_of};

const RUN: &str = "fuzz/corpus/mcap/of-a-run";

#[test]
fn the_report_lists_the_topics_and_what_they_can_carry() {
    let text = "fuzz/corpus/mcap/of-a-run: MCAP, 847 bytes
has no index, contents not verified
from 1.000 s, for 1.000 s
7 messages

    messages  a second  topic                     type
           1      1.00  /camera/image/compressed  sensor_msgs/CompressedImage
           1      1.00  /odom                     geometry_msgs/PoseStamped
           1      1.00  /cmd_vel                  geometry_msgs/Twist
           1      1.00  /toposlam/percept         toposlam_msgs/Percept
           2      2.00  /junction                 lab_msgs/Junction
           1      1.00  /place                    lab_msgs/Place

  role      topic
  image     /camera/image/compressed
  odometry  /odom
  motion    /cmd_vel
  percept   /toposlam/percept
";
    assert_eq!(stdout_of(["info", RUN]), text);
}

#[test]
fn json_has_one_line_for_each_log() {
    let text = stdout_of(["info", "--json", RUN, "fuzz/corpus/bag/bz2"]);
    let [run, bag] = &objects(&text)[..] else { panic!("{text}") };
    assert_eq!(run["schema"], 1);
    assert_eq!(run["mapping"]["percept"], json!(["/toposlam/percept"]));
    assert_eq!(run["truncated"], json!(null));
    assert_eq!((&bag["format"], &bag["messages"]), (&json!("bag"), &json!(6)));
    assert_eq!((&bag["start"], &bag["end"]), (&json!(1_000_000_000), &json!(1_000_000_035)));
    let topic = &bag["topics"][0];
    assert_eq!(
        (&topic["name"], &topic["type"], &topic["encoding"], &topic["messages"]),
        (&json!("/t0"), &json!("a/Said"), &json!("ros1"), &json!(2))
    );
}

#[test]
fn a_truncated_log_is_reported_up_to_its_end_and_is_incomplete() {
    let output = run(["info", "--json", "fuzz/corpus/bag/not-closed"]);
    assert_eq!(output.status.code(), Some(3));
    let [line] = &objects(&stdout(&output))[..] else { panic!() };
    assert_eq!(line["messages"], 6);
    assert_eq!(line["truncated"]["cause"], "it was not closed, and has no index");
    let output = run(["info", "fuzz/corpus/mcap/cut-in-a-chunk"]);
    assert_eq!(output.status.code(), Some(3));
    assert!(stdout(&output).contains("truncated at byte "), "{}", stdout(&output));
}

#[test]
fn a_log_whose_end_is_missing_has_no_index() {
    let folder = folder("info_cut");
    for (name, bytes) in
        [("cut.mcap", &b"\x89MCAP0\r\n\x01"[..]), ("cut.bag", b"#ROSBAG V2.0\n\x01")]
    {
        let log = folder.join(name);
        fs::write(&log, bytes).unwrap();
        let output = run(["info", log.to_str().unwrap()]);
        assert_eq!(output.status.code(), Some(3));
        let text = stdout(&output);
        assert!(text.contains("\nhas no index, contents not verified\n0 messages\n"), "{text}");
        let output = run(["info", "--json", log.to_str().unwrap()]);
        assert_eq!(objects(&stdout(&output))[0]["indexed"], false);
    }
}

#[test]
fn an_error_is_one_message_with_file_and_place() {
    for (log, message) in [
        (
            "README.md",
            "README.md: byte 0: this is not a log; it must be a ROS 1 bag, an MCAP file, a rosbag2 folder or .db3 file, a CARMEN log, or events as JSON lines or CSV",
        ),
        ("nowhere.bag", "nowhere.bag: cannot be read: No such file or directory (os error 2)"),
        (
            "fuzz/corpus/bag/error-another-compression",
            "fuzz/corpus/bag/error-another-compression: byte 94: the compression \"zip\" is not known; \
             known are none, bz2 and lz4",
        ),
    ] {
        let output = run(["info", log]);
        assert_eq!(output.status.code(), Some(2));
        assert_eq!(stderr(&output), format!("error: {message}\n"));
        assert!(output.stdout.is_empty());
    }
}

#[test]
fn a_topic_map_is_written_and_checked_against_its_log() {
    let mapping = folder("info").join("mapping.toml");
    let path = mapping.to_str().unwrap();
    stdout_of(["info", RUN, "--write-topics", path]);
    let text = fs::read_to_string(&mapping).unwrap();
    assert!(
        text.starts_with("[image]\ntopic = \"/camera/image/compressed\"\n\n[odometry]\n"),
        "{text}"
    );
    let text = stdout_of(["info", RUN, "--topics", path]);
    assert!(text.contains("  odometry  /odom\n"), "{text}");
    let output = run(["info", "fuzz/corpus/bag/bz2", "--topics", path]);
    assert_eq!(output.status.code(), Some(2));
    let message = stderr(&output);
    assert!(
        message.contains("mapping.toml: line 2, column 9: image.topic: the log has no topic"),
        "{message}"
    );
    fs::write(&mapping, "[image]\ntopic = \"/a\"\nsize = 3\n").unwrap();
    let output = run(["info", RUN, "--topics", path]);
    let message = stderr(&output);
    assert!(
        message.contains("mapping.toml: line 3, column 1: image.size: unknown key"),
        "{message}"
    );
    // Nothing is clear in this one.
    let output = run(["info", "fuzz/corpus/bag/bz2", "--write-topics", path]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("no role has exactly one possible topic"));
}

#[test]
fn an_unreadable_log_does_not_stop_the_others_and_the_worst_exit_code_counts() {
    const TRUNCATED: &str = "fuzz/corpus/bag/not-closed";
    let output = run(["info", "--json", RUN, TRUNCATED, RUN]);
    assert_eq!((output.status.code(), objects(&stdout(&output)).len()), (Some(3), 3));
    let output = run(["info", "--json", TRUNCATED, "no-such-log", "Cargo.toml", RUN]);
    assert_eq!(output.status.code(), Some(2), "bad input is worse than a truncated log");
    let logs = objects(&stdout(&output));
    let names: Vec<_> = logs
        .iter()
        .map(|line| if line["kind"] == "unread" { &line["file"] } else { &line["log"] })
        .collect();
    assert_eq!(names, [TRUNCATED, "no-such-log", "Cargo.toml", RUN]);
    let message = stderr(&output);
    let lines: Vec<_> = message.lines().collect();
    assert_eq!(lines.len(), 2, "{message}");
    assert!(lines[0].starts_with("error: no-such-log: "), "{message}");
    assert!(lines[1].starts_with("error: Cargo.toml: "), "{message}");
}

#[test]
fn a_log_is_verified_against_its_checksums() {
    let verify = |log: &str| {
        let output = run(["info", "--verify", "--json", log]);
        let line = objects(&stdout(&output)).remove(0);
        (output.status.code(), line["verification"].clone())
    };
    let (code, found) = verify(RUN);
    assert_eq!((code, &found["holds"], &found["messages"]), (Some(0), &json!(true), &json!(7)));
    let damaged = "fuzz/corpus/mcap/error-a-wrong-checksum";
    // Its index can be read, so without --verify it is listed.
    assert_eq!(run(["info", damaged]).status.code(), Some(0));
    let (code, found) = verify(damaged);
    assert_eq!((code, &found["holds"]), (Some(1), &json!(false)));
    let causes: Vec<_> =
        found["damage"].as_array().unwrap().iter().map(|damage| damage["cause"].clone()).collect();
    assert!(causes.contains(&json!("the checksum of the chunk is wrong")), "{found}");
    let text = stdout(&run(["info", "--verify", damaged]));
    assert!(text.contains(": the checksum of the chunk is wrong\n"), "{text}");
    assert!(stdout_of(["info", "--verify", RUN]).contains("contents verified: 7 messages"));
    // A log without an index cannot be listed without its chunks.
    let unlisted = folder("info-unlisted").join("run.mcap");
    let mut bytes = fs::read(RUN).unwrap();
    bytes[261] ^= 1;
    fs::write(&unlisted, bytes).unwrap();
    let unlisted = unlisted.to_str().unwrap();
    assert_eq!(run(["info", unlisted]).status.code(), Some(2));
    let (code, found) = verify(unlisted);
    assert_eq!((code, &found["holds"]), (Some(1), &json!(false)));
    assert_eq!(found["damage"].as_array().unwrap().len(), 1);
    assert!(stdout(&run(["info", "--verify", unlisted])).contains("damaged, and not read further"));
    // Damaged and truncated is damaged; truncated is not known.
    assert_eq!(verify("fuzz/corpus/bag/error-a-chunk-that-grows-without-end").0, Some(1));
    assert_eq!(verify("fuzz/corpus/mcap/cut-in-a-chunk").0, Some(3));
}

#[test]
fn a_time_since_1970_is_a_date_and_a_short_log_has_no_rate() {
    let text = stdout_of(["info", "fuzz/corpus/mcap/lz4"]);
    assert!(text.contains("\nfrom 1.000 s, for 0.000 s\n"), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    assert!(text.contains("           2            /t0"), "{text}");
}
