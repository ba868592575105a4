//! `toposlam check` in parts: shards and `--add`, the journal, the estimate.

use std::{fs, process::Stdio, thread, time::Duration};

use serde_json::{Value, json};

use super::{Scratch, has, objects, stderr, stdout};

/// Writes the lines of a shard.
fn shard(scratch: &Scratch, file: &str, options: &str) {
    scratch.write(file, scratch.out(&format!("check --json {options}"), 0));
}

#[test]
fn the_shards_together_are_the_whole_check_byte_for_byte() {
    let scratch = Scratch::new("shards");
    for options in [
        "--edges 1..=5",
        "--edges 4..=7 --class planar --marker movable",
        "--edges 5 --algorithm folding",
        "--edges 2..=3 --choices all",
    ] {
        for n in 1..=3 {
            shard(&scratch, &n.to_string(), &format!("{options} --shard {n}/3"));
        }
        for format in ["--json", ""] {
            let whole = scratch.out(&format!("check {options} --junit whole.xml {format}"), 0);
            // In any order.
            let add = format!("check --junit added.xml --add 3 1 2 {format}");
            assert_eq!(scratch.out(&add, 0), whole);
            assert_eq!(scratch.bytes("added.xml"), scratch.bytes("whole.xml"));
        }
    }
    shard(&scratch, "1", "--edges 3 --shard 1/2");
    shard(&scratch, "2", "--edges 3 --shard 2/2");
    scratch.write("both", scratch.text("1") + &scratch.text("2"));
    let both = fs::File::open(scratch.path("both")).unwrap();
    let output = scratch.command("check --add - --json").stdin(both).output().unwrap();
    assert_eq!(stdout(&output), scratch.out("check --edges 3 --json", 0));
}

#[test]
fn missing_duplicated_and_foreign_shards_are_listed() {
    let scratch = Scratch::new("shards_refused");
    for (file, options) in [
        ("1", "--edges 5 --shard 1/4"),
        ("2", "--edges 5 --shard 2/4"),
        ("4", "--edges 5 --shard 4/4"),
        ("third", "--edges 5 --shard 1/3"),
        ("simple", "--edges 5 --class simple --shard 3/4"),
        ("whole", "--edges 3"),
    ] {
        shard(&scratch, file, options);
    }
    let one = scratch.text("1");
    scratch.write("newer", one.replace("\"version\":\"", "\"version\":\"9."));
    scratch.write("huge", one.replace("1/4", "1/18446744073709551615"));
    for (files, causes) in [
        ("1 2 4", &["error: 5 edges: shard 3/4 is missing\n"][..]),
        ("1 2 4 2", &["shard 2/4 occurs twice: 2: line 1, 2: line 1", "3/4 is missing"]),
        ("1 third", &["third: line 1: 5 edges: 1/3 is not one of 4"]),
        ("1 2 simple 4", &["line 1: class is simple, not multigraph"]),
        ("2 newer", &["version is 9."]),
        ("whole", &["line 1: this is the result of a whole check"]),
        ("worlds/README.md", &["worlds/README.md: line 1: this is not a line of `check --json`"]),
        ("huge", &["2/18446744073709551615 is missing"]),
    ] {
        let message = scratch.error(&format!("check --add {files}"));
        assert!(causes.iter().all(|cause| message.contains(cause)), "{files}: {message}");
    }
}

/// Changes the last line of a shard: one of its starts was mapped wrongly.
fn with_wrong_map(scratch: &Scratch, file: &str) {
    let world = r#"{"name":"failed","about":"","doors":{"v0":["e0","e0"]},"start":{"at":"v0","facing":"e0:1"}}"#;
    let failure = format!(
        r#""failure":{{"cause":"the map is wrong","step":null,"moves":1,"world":{world}}},"holds":false"#
    );
    let text = scratch.text(file);
    let (before, last) = text.trim_end().rsplit_once('\n').unwrap_or(("", text.trim_end()));
    let mapped = objects(&format!("{last}\n"))[0]["mapped"].as_u64().unwrap();
    let last = last
        .replace(&format!("\"mapped\":{mapped},"), &format!("\"mapped\":{},", mapped - 1))
        .replace("\"failed\":0", "\"failed\":1")
        .replace("\"holds\":true", &failure);
    scratch.write(file, format!("{before}\n{last}\n"));
}

/// A shard stops after a size with a wrong map, as the whole check does. The other shards go on.
#[test]
fn a_wrong_map_in_one_shard_is_the_first_of_the_whole() {
    let scratch = Scratch::new("shards_wrong");
    shard(&scratch, "1", "--edges 3 --shard 1/2 --algorithm folding");
    shard(&scratch, "2", "--edges 3 --shard 2/2 --algorithm folding");
    with_wrong_map(&scratch, "2");
    scratch.facts(&[(
        "check --add 1 2",
        1,
        json!({
            "failed": 1, "holds": false, "failure.cause": "the map is wrong",
        }),
    )]);
    let text = scratch.out("check --add 1 2", 1);
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    // It is followed by the command that explores its world.
    let command = "`toposlam explore --marker directional --algorithm folding`";
    assert!(text.contains("Wrong: the map is wrong") && text.contains(command), "{text}");

    shard(&scratch, "1", "--edges 1..=4 --shard 1/2");
    shard(&scratch, "2", "--edges 1..=6 --shard 2/2");
    let message = scratch.error("check --add 1 2");
    assert!(message.contains("5 edges: shard 1/2 is missing\n6 edges: shard 1/2"), "{message}");
    with_wrong_map(&scratch, "1");
    let output = scratch.run("check --add 1 2 --json --junit added.xml");
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let held = json!({ "holds": true });
    let wrong = json!({ "edges": 4, "holds": false, "failure.cause": "the map is wrong" });
    let sizes = json!([held, held, held, wrong]);
    has(&objects(&stdout(&output)).into(), &sizes, "check --add 1 2");
    assert!(stderr(&output).contains("shards are missing from 5 edges on"), "{output:?}");
    let junit = scratch.text("added.xml");
    assert!(junit.contains("tests=\"6\" failures=\"1\" errors=\"2\""), "{junit}");
    // Before the wrong map, each shard must be there.
    let two = scratch.text("2");
    scratch.write("2", two.split_inclusive('\n').skip(1).collect::<String>());
    assert_eq!(scratch.error("check --add 1 2"), "error: 1 edge: shard 2/2 is missing\n");
}

#[test]
fn counts_that_contradict_each_other_are_refused() {
    let scratch = Scratch::new("shards_counts");
    shard(&scratch, "1", "--edges 3 --shard 1/2");
    shard(&scratch, "2", "--edges 3 --shard 2/2");
    let good = scratch.text("1");
    let starts = objects(&good)[0]["starts"].as_u64().unwrap();
    let [starts, mapped] = ["starts", "mapped"].map(|key| format!("\"{key}\":{starts},"));
    let most = good
        .replace(&starts, "\"starts\":18446744073709551615,")
        .replace(&mapped, "\"mapped\":18446744073709551615,");
    for (text, cause) in [
        (good.replace(&mapped, "\"mapped\":0,"), "line 1: `starts` is "),
        (good.replace("\"failed\":0", "\"failed\":18446744073709551615"), "line 1: `starts` is "),
        (good.replace("\"holds\":true", "\"holds\":false"), "line 1: `holds` is false, but"),
        (
            good.replace("\"moves_total\":", "\"moves_total\":0,\"unknown\":"),
            "line 1: `moves_max` is ",
        ),
        (most, "line 1: with this, the sum of `starts` is 2^64 or more"),
    ] {
        scratch.write("1", &text);
        let message = scratch.error("check --add 1 2");
        assert!(message.contains(cause), "{text}: {message}");
    }
}

const LONG: &str = "check --json --edges 7";
const RECORDED: &str = "check --json --edges 7 --journal journal";
const JOURNAL: &str = "journal/7-edges.journal";

/// Killed without a warning, again and again.
#[test]
fn a_check_that_was_killed_goes_on_and_prints_the_same_bytes() {
    let scratch = Scratch::new("journal");
    let mut sizes = vec![0];
    for _ in 0..2 {
        let mut command = scratch.command(RECORDED);
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        let size = || fs::metadata(scratch.path(JOURNAL)).map_or(0, |found| found.len());
        let before = sizes[sizes.len() - 1];
        while size() <= before + 2000 && child.try_wait().unwrap().is_none() {
            thread::sleep(Duration::from_millis(1));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        sizes.push(size());
    }
    assert!(sizes.is_sorted() && sizes[1] > 2000, "{sizes:?}");
    // A line that was being written.
    scratch.write(JOURNAL, [&scratch.bytes(JOURNAL)[..], b"01234567 {\"unit\":"].concat());
    let whole = scratch.out(LONG, 0);
    let resumed = scratch.run(RECORDED);
    assert!(stderr(&resumed).contains("7 edges: "), "{resumed:?}");
    assert_eq!(stdout(&resumed), whole);
    // Finished: nothing is left to do.
    let finished = scratch.bytes(JOURNAL);
    assert_eq!(scratch.out(RECORDED, 0), whole);
    assert_eq!(scratch.bytes(JOURNAL), finished);
    // A journal is for one process at a time.
    let locked = fs::File::open(scratch.path(JOURNAL)).unwrap();
    locked.lock().unwrap();
    let message = format!("error: {JOURNAL}: another process is writing this file\n");
    assert_eq!(scratch.error(RECORDED), message);
    drop(locked);
    assert_eq!(scratch.out(RECORDED, 0), whole);
}

/// A limit on the size of a file takes the place of a full disk.
#[cfg(unix)]
#[test]
fn a_check_stops_when_its_journal_cannot_be_written_and_continues_later() {
    let scratch = Scratch::new("journal_full");
    let limited = "trap '' XFSZ; ulimit -f 8; exec \"$0\" \"$@\"";
    let mut shell = std::process::Command::new("sh");
    let shell = shell.current_dir(&scratch.0).stdin(Stdio::null());
    let shell = shell.args(["-c", limited, env!("CARGO_BIN_EXE_toposlam")]);
    let output = shell.args(RECORDED.split(' ')).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert_eq!(stdout(&output), "");
    let message = stderr(&output);
    let cause = format!("error: {JOURNAL}: the journal cannot be written: ");
    assert!(message.starts_with(&cause) && message.contains("continues"), "{message}");
    let resumed = scratch.run(RECORDED);
    assert!(stderr(&resumed).contains("of the work finished before"), "{resumed:?}");
    assert_eq!(stdout(&resumed), scratch.out(LONG, 0));
}

/// Ctrl-C can come when a size begins: its journal has the number of all units, and can be continued.
#[cfg(unix)]
#[test]
fn ctrl_c_leaves_journals_that_can_be_continued() {
    let scratch = Scratch::new("journal_interrupted");
    let check = "check --json --edges 4..=8 --class corridor";
    let journal = scratch.path("journal").display().to_string();
    // The journal of the next size is opened after the first line.
    super::interrupted_after_a_line(&format!("{check} --journal {journal}"));
    let resumed = scratch.out(&format!("{check} --journal journal"), 0);
    assert_eq!(resumed, scratch.out(check, 0));
}

/// The line of a unit with one start more, and with a right checksum.
fn other_counts(line: &str) -> String {
    let (_, json) = line.split_once(' ').unwrap();
    let json = json.replacen("\"starts\":", "\"starts\":1", 1);
    format!("{:08x} {json}\n", crc32fast::hash(json.as_bytes()))
}

#[test]
fn a_corrupt_or_foreign_journal_is_refused() {
    let scratch = Scratch::new("journal_refused");
    let check = "check --edges 4 --journal journal";
    let whole = scratch.out(check, 0);
    assert_eq!(scratch.out(check, 0), whole);
    let file = "journal/4-edges.journal";
    let foreign = "this is the journal of another check: the class is multigraph, not simple";
    let message = scratch.error(&format!("{check} --class simple"));
    assert_eq!(message, format!("error: {file}: {foreign}\n"));
    let message = scratch.error(&format!("{check} --shard 1/2"));
    assert!(message.contains("the shard is 1/1, not 1/2"), "{message}");
    let good = scratch.text(file);
    let lines: Vec<_> = good.lines().collect();
    let not_first = "line 1: this is not the first line";
    for (text, cause) in [
        (
            good.replacen("\"starts\":", "\"starts\":1", 1),
            "line 2: the journal is corrupt: the checksum",
        ),
        (good.replacen("\"edges\":4", "\"edges\":5", 1), not_first),
        ("nothing\n".to_owned(), not_first),
        ("nothing, and no end of a line".to_owned(), not_first),
        ("nothing\nan unfinished line".to_owned(), not_first),
        (format!("{good}{}", other_counts(lines[1])), "a unit occurs twice, with different counts"),
        (format!("{good}\n"), "the checksum is wrong"),
    ] {
        scratch.write(file, &text);
        let message = scratch.error(check);
        assert!(message.starts_with(&format!("error: {file}: ")), "{message}");
        assert!(message.contains(cause), "{message}");
        // A file that may belong to someone else is not changed.
        assert_eq!(scratch.text(file), text);
    }
    // A unit that two processes finished, and the first line of a check that was killed.
    for text in [format!("{good}{}\n", lines[1]), lines[0][..40].to_owned(), String::new()] {
        scratch.write(file, text);
        assert_eq!(scratch.out(check, 0), whole);
    }
}

/// A000698 and the published numbers of moves are within the intervals.
#[test]
fn an_estimate_is_near_the_truth_and_follows_its_seed() {
    let scratch = Scratch::new("estimate");
    let estimate =
        |seed: &str| scratch.last(&format!("check --estimate --edges 7 --probes 400 {seed}"), 0);
    let [one, same, other] = ["--seed 1", "", "--seed 2"].map(estimate);
    for (key, truth) in
        [("starts", 1_708_394.0), ("moves_total", 25_375_585.0), ("moves_made", 13_166_198.0)]
    {
        assert_eq!(one[key], same[key]);
        assert_ne!(one[key], other[key]);
        let [low, high] = ["low", "high"].map(|bound| one[key][bound].as_f64().unwrap());
        assert!(low < truth && truth < high && high - low < 0.4 * truth, "{key}: {}", one[key]);
    }
    let [low, mean, high] =
        ["low", "mean", "high"].map(|bound| one["seconds"][bound].as_f64().unwrap());
    assert!(0.0 < mean && low <= mean && mean <= high, "{}", one["seconds"]);
    // In a class with few worlds most probes end where none is left.
    scratch.facts(&[(
        "check --estimate --class simple --edges 14 --probes 2",
        3,
        json!({
            "starts": Value::Null, "moves_total": null, "moves_made": null, "seconds": null,
        }),
    )]);
}
