//! `toposlam info`: what logs hold, whole or not.

use std::fs;

use serde_json::json;

use super::{folder, objects, run, stderr, stdout, stdout_of};

const RUN: &str = "fuzz/corpus/mcap/of-a-run";

#[test]
fn the_report_lists_the_topics_and_what_they_can_carry() {
    let text = "fuzz/corpus/mcap/of-a-run: MCAP, 847 bytes
has an index, contents not verified
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
fn an_error_is_one_message_with_file_and_place() {
    for (log, message) in [
        (
            "README.md",
            "README.md: byte 0: this is not a log; it must be a ROS 1 bag or an MCAP file",
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
    stdout_of(["info", RUN, "--write-mapping", path]);
    let text = fs::read_to_string(&mapping).unwrap();
    assert!(
        text.starts_with("[image]\ntopic = \"/camera/image/compressed\"\n\n[odometry]\n"),
        "{text}"
    );
    let text = stdout_of(["info", RUN, "--mapping", path]);
    assert!(text.contains("  odometry  /odom\n"), "{text}");
    let output = run(["info", "fuzz/corpus/bag/bz2", "--mapping", path]);
    assert_eq!(output.status.code(), Some(2));
    let message = stderr(&output);
    assert!(
        message.contains("mapping.toml: line 2, column 9: image.topic: the log has no topic"),
        "{message}"
    );
    fs::write(&mapping, "[image]\ntopic = \"/a\"\nsize = 3\n").unwrap();
    let output = run(["info", RUN, "--mapping", path]);
    let message = stderr(&output);
    assert!(
        message.contains("mapping.toml: line 3, column 1: image.size: unknown key"),
        "{message}"
    );
    // Nothing is clear in this one.
    let output = run(["info", "fuzz/corpus/bag/bz2", "--write-mapping", path]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("no role has exactly one possible topic"));
}
