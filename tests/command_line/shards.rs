//! `toposlam check` in parts: shards and `--add`, of which most facts are in `tests/facts/shards.txt`; the journal; the
//! estimate.

use std::{fs, process::Stdio, thread, time::Duration};

use super::{Scratch, objects, stderr, stdout};

/// Writes the lines of a shard.
fn shard(scratch: &Scratch, file: &str, options: &str) {
    scratch.write(file, scratch.out(&format!("check --json {options}"), 0));
}

/// The lines of a shard; one of the last size's starts was mapped wrongly.
fn with_wrong_map(text: &str) -> String {
    let world = r#"{"name":"failed","about":"","doors":{"v0":["e0","e0"]},"start":{"at":"v0","facing":"e0:1"}}"#;
    let failure = format!(
        r#""failure":{{"cause":"the map is wrong","step":null,"moves":1,"world":{world}}},"holds":false"#
    );
    let mapped = objects(text).pop().unwrap()["mapped"].as_u64().unwrap();
    let [mapped, one_less] = [mapped, mapped - 1].map(|count| format!("\"mapped\":{count},"));
    let (before, last) = text.trim_end().rsplit_once('\n').unwrap();
    let last = last.replace(&mapped, &one_less).replace("\"failed\":0", "\"failed\":1");
    format!("{before}\n{}\n", last.replace("\"holds\":true", &failure))
}

/// A shard stops after a size with a wrong map, as the whole check does. The other shards go on.
#[test]
fn a_wrong_map_in_one_shard_is_the_first_of_the_whole() {
    let scratch = Scratch::new("shards_wrong");
    shard(&scratch, "1", "--edges 1..=4 --shard 1/2");
    shard(&scratch, "2", "--edges 1..=6 --shard 2/2");
    facts! { scratch; "check --add 1 2" => 2 "5 edges: shard 1/2 is missing\n6 edges: shard 1/2 is missing"; }
    scratch.write("1", with_wrong_map(&scratch.text("1")));
    facts! { scratch;
        "check --add 1 2 --junit added.xml" => 1 [
            { "holds": true }, { "holds": true }, { "holds": true },
            { "edges": 4, "failed": 1, "holds": false, "failure.cause": "the map is wrong" },
        ];
    }
    let junit = scratch.text("added.xml");
    assert!(junit.contains("tests=\"6\" failures=\"1\" errors=\"2\""), "{junit}");
    // Before the wrong map, each shard must be there.
    let two = scratch.text("2");
    scratch.write("2", two.split_inclusive('\n').skip(1).collect::<String>());
    facts! { scratch; "check --add 1 2" => 2 "1 edge: shard 2/2 is missing\n"; }
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
    facts! { scratch; RECORDED => 2 (format!("{JOURNAL}: another process is writing this file\n")); }
    drop(locked);
    assert_eq!(scratch.out(RECORDED, 0), whole);
}

/// Ctrl-C can come when a size begins: its journal has the number of all units, and can be continued.
#[cfg(unix)]
#[test]
fn ctrl_c_leaves_journals_that_can_be_continued() {
    let scratch = Scratch::new("journal_stopped");
    let check = "check --json --edges 4..=8 --class corridor";
    let journal = scratch.path("other").display().to_string();
    // The journal of the next size is opened after the first line.
    super::interrupted_after_a_line(&format!("{check} --journal {journal}"));
    let resumed = scratch.out(&format!("{check} --journal other"), 0);
    assert_eq!(resumed, scratch.out(check, 0));
}

#[test]
fn a_corrupt_or_foreign_journal_is_refused() {
    let scratch = Scratch::new("journal_refused");
    let check = "check --edges 4 --journal journal";
    let file = "journal/4-edges.journal";
    let whole = scratch.out(check, 0);
    assert_eq!(scratch.out(check, 0), whole);
    let foreign = format!("{file}: this is the journal of another check: the");
    facts! { scratch;
        format!("{check} --class simple") => 2 (format!("{foreign} class is multigraph, not simple\n"));
        format!("{check} --shard 1/2") => 2 (format!("{foreign} shard is 1/1, not 1/2"));
    }
    let good = scratch.text(file);
    let lines: Vec<_> = good.lines().collect();
    // The line of a unit with one start more, and with a right checksum.
    let (_, unit) = lines[1].split_once(' ').unwrap();
    let unit = unit.replacen("\"starts\":", "\"starts\":1", 1);
    let unit = format!("{:08x} {unit}\n", crc32fast::hash(unit.as_bytes()));
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
        (format!("{good}{unit}"), "a unit occurs twice, with different counts"),
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
}
