//! `toposlam info`: what logs hold, whole or not.

use serde_json::json;

use super::{Scratch, has, objects, stderr, stdout};

const RUN: &str = "info fuzz/corpus/mcap/of-a-run";
const DAMAGED: &str = "info fuzz/corpus/mcap/error-a-wrong-checksum";

#[test]
fn facts_of_logs() {
    let scratch = Scratch::new("info");
    // Logs whose ends are missing; and one without an index, which cannot be listed without its chunks.
    scratch.write("cut.mcap", b"\x89MCAP0\r\n\x01");
    scratch.write("cut.bag", b"#ROSBAG V2.0\n\x01");
    let mut bytes = scratch.bytes("fuzz/corpus/mcap/of-a-run");
    bytes[261] ^= 1;
    scratch.write("unlisted.mcap", bytes);
    scratch.error("info unlisted.mcap");
    let verify = |log: &str| format!("{log} --verify");
    scratch.facts(&[
        (
            RUN,
            0,
            json!({
                "schema": 1, "mapping.percept": ["/toposlam/percept"], "truncated": null,
            }),
        ),
        (
            "info fuzz/corpus/bag/bz2",
            0,
            json!({
                "format": "bag", "messages": 6, "start": 1_000_000_000, "end": 1_000_000_035,
                "topics.0.name": "/t0", "topics.0.type": "a/Said", "topics.0.encoding": "ros1",
                "topics.0.messages": 2,
            }),
        ),
        (
            "info fuzz/corpus/bag/not-closed",
            3,
            json!({
                "messages": 6, "truncated.cause": "it was not closed, and has no index",
            }),
        ),
        ("info fuzz/corpus/mcap/cut-in-a-chunk", 3, json!({})),
        ("info cut.mcap", 3, json!({ "indexed": false, "messages": 0 })),
        ("info cut.bag", 3, json!({ "indexed": false, "messages": 0 })),
        (&verify(RUN), 0, json!({ "verification.holds": true, "verification.messages": 7 })),
        // Its index can be read, so without --verify it is listed.
        (DAMAGED, 0, json!({})),
        (&verify(DAMAGED), 1, json!({ "verification.holds": false })),
        (
            "info unlisted.mcap --verify",
            1,
            json!({
                "verification.holds": false, "verification.damage.#": 1,
            }),
        ),
        // Damaged and truncated is damaged; truncated is not known.
        ("info fuzz/corpus/bag/error-a-chunk-that-grows-without-end --verify", 1, json!({})),
        ("info fuzz/corpus/mcap/cut-in-a-chunk --verify", 3, json!({})),
    ]);
}

#[test]
fn a_topic_map_is_written_and_checked_against_its_log() {
    let scratch = Scratch::new("info_mapping");
    scratch.out(&format!("{RUN} --write-topics mapping.toml"), 0);
    let text = scratch.text("mapping.toml");
    let start = "[image]\ntopic = \"/camera/image/compressed\"\n\n[odometry]\n";
    assert!(text.starts_with(start), "{text}");
    let mapped = format!("{RUN} --topics mapping.toml");
    scratch.facts(&[(&mapped, 0, json!({ "mapping.odometry": ["/odom"] }))]);
    let message = scratch.error("info fuzz/corpus/bag/bz2 --topics mapping.toml");
    let cause = "mapping.toml: line 2, column 9: image.topic: the log has no topic";
    assert!(message.contains(cause), "{message}");
    scratch.write("mapping.toml", "[image]\ntopic = \"/a\"\nsize = 3\n");
    let message = scratch.error(&mapped);
    assert!(
        message.contains("mapping.toml: line 3, column 1: image.size: unknown key"),
        "{message}"
    );
}

#[test]
fn an_unreadable_log_does_not_stop_the_others_and_the_worst_exit_code_counts() {
    let scratch = Scratch::new("info_several");
    let of_a_run = "fuzz/corpus/mcap/of-a-run";
    let truncated = "fuzz/corpus/bag/not-closed";
    assert_eq!(scratch.lines(&format!("info {of_a_run} {truncated} {of_a_run}"), 3).len(), 3);
    let output =
        scratch.run(&format!("info --json {truncated} no-such-log worlds/README.md {of_a_run}"));
    assert_eq!(output.status.code(), Some(2), "bad input is worse than a truncated log");
    has(
        &objects(&stdout(&output)).into(),
        &json!([
            { "log": truncated },
            { "kind": "unread", "file": "no-such-log" },
            { "kind": "unread", "file": "worlds/README.md" },
            { "log": of_a_run },
        ]),
        "info",
    );
    let message = stderr(&output);
    let files: Vec<_> = message.lines().map(|line| line.split(": ").nth(1).unwrap()).collect();
    assert_eq!(files, ["no-such-log", "worlds/README.md"], "{message}");
}
