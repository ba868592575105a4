//! `toposlam info`: what logs hold, whole or not. Most facts are in `tests/facts/info.txt`.

use serde_json::json;

use super::{Scratch, has, objects, stderr, stdout};

#[test]
fn an_unreadable_log_does_not_stop_the_others_and_the_worst_exit_code_counts() {
    let scratch = Scratch::new("info_several");
    let (of_a_run, truncated) = ("fuzz/corpus/mcap/of-a-run", "fuzz/corpus/bag/not-closed");
    // Bad input is worse than a truncated log.
    let several = format!("info --json {truncated} no-such-log worlds/README.md {of_a_run}");
    let output = scratch.run(&several);
    assert_eq!(output.status.code(), Some(2));
    let expected = json!([
        { "log": truncated },
        { "kind": "unread", "file": "no-such-log" },
        { "kind": "unread", "file": "worlds/README.md" },
        { "log": of_a_run },
    ]);
    has(&objects(&stdout(&output)).into(), &expected, "info");
    let message = stderr(&output);
    let files: Vec<_> = message.lines().map(|line| line.split(": ").nth(1).unwrap()).collect();
    assert_eq!(files, ["no-such-log", "worlds/README.md"], "{message}");
}
