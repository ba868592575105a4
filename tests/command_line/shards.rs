//! `toposlam check` in parts that were killed, and the estimate. Other facts are in `tests/facts/shards.txt`.

use std::{fs, process::Stdio, thread, time::Duration};

use super::{Scratch, stderr, stdout};

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

/// A000698 and the published numbers of moves are within the intervals.
#[test]
fn an_estimate_is_near_the_truth_and_follows_its_seed() {
    let scratch = Scratch::new("estimate");
    let estimate = |seed: &str| scratch.last(&format!("check --estimate=400 --edges 7 {seed}"), 0);
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
