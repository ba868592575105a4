//! `toposlam merge`, and the journal of a check.

use std::{
    fs,
    io::{BufRead, BufReader, Read, Write},
    path::Path,
    process::{Command, Stdio},
    thread,
    time::Duration,
};

use super::{folder, objects, run, stderr, stdout, stdout_of, toposlam};

/// Writes the lines of a shard, and returns the file.
fn shard(folder: &Path, name: &str, arguments: &[&str]) -> String {
    let file = folder.join(name);
    fs::write(&file, stdout_of([&["check", "--json"], arguments].concat())).unwrap();
    file.to_str().unwrap().to_owned()
}

fn refused(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert_eq!(stdout(&output), "");
    stderr(&output)
}

#[test]
fn the_shards_together_are_the_whole_check_byte_for_byte() {
    let folder = folder("merge");
    for options in [
        &["--edges", "1..=5"][..],
        &["--edges", "4..=7", "--class", "planar", "--marker", "movable"],
        &["--edges", "5", "--algorithm", "folding"],
        &["--edges", "2..=3", "--choices", "all"],
    ] {
        let file = |n: usize| {
            let part = format!("{n}/3");
            shard(&folder, &format!("{n}.jsonl"), &[options, &["--shard", &part]].concat())
        };
        let [one, two, three] = [1, 2, 3].map(file);
        let [of_whole, of_merged] = ["whole.xml", "merged.xml"].map(|name| folder.join(name));
        let [of_whole, of_merged] = [&of_whole, &of_merged].map(|path| path.to_str().unwrap());
        for format in [&["--json"][..], &[]] {
            let whole = stdout_of([&["check", "--junit", of_whole][..], options, format].concat());
            // In any order.
            let files = ["check", "--add", "--junit", of_merged, &*three, &one, &two];
            assert_eq!(stdout_of([&files[..], format].concat()), whole);
            assert_eq!(fs::read(of_merged).unwrap(), fs::read(of_whole).unwrap());
        }
    }
}

#[test]
fn shards_are_read_from_standard_input() {
    let check = |shard: &str| stdout_of(["check", "--edges", "3", "--shard", shard, "--json"]);
    let shards = check("1/2") + &check("2/2");
    let mut merge = toposlam();
    merge.args(["check", "--add", "-", "--json"]).stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut merge = merge.spawn().unwrap();
    merge.stdin.take().unwrap().write_all(shards.as_bytes()).unwrap();
    let output = merge.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(stdout(&output), stdout_of(["check", "--edges", "3", "--json"]));
}

#[test]
fn missing_duplicated_and_foreign_shards_are_listed() {
    let folder = folder("merge_refused");
    let five = |n: &str| shard(&folder, &n.replace('/', "-"), &["--edges", "5", "--shard", n]);
    let [one, two, four] = ["1/4", "2/4", "4/4"].map(five);
    assert_eq!(
        refused(&["check", "--add", &one, &two, &four]),
        "error: 5 edges: shard 3/4 is missing\n"
    );
    let message = refused(&["check", "--add", &one, &two, &four, &two]);
    let twice = format!("5 edges: shard 2/4 occurs twice: {two}: line 1, {two}: line 1");
    assert!(message.contains(&twice) && message.contains("3/4 is missing"), "{message}");
    let third = five("1/3");
    let message = refused(&["check", "--add", &one, &third]);
    assert!(
        message.contains(&format!("{third}: line 1: 5 edges: 1/3 is not one of 4")),
        "{message}"
    );
    let simple = ["--edges", "5", "--class", "simple", "--shard", "3/4"];
    let simple = shard(&folder, "simple", &simple);
    let message = refused(&["check", "--add", &one, &two, &simple, &four]);
    assert!(message.contains("line 1: class is simple, not multigraph"), "{message}");
    let other = fs::read_to_string(&one).unwrap().replace("\"version\":\"", "\"version\":\"9.");
    let newer = folder.join("newer");
    fs::write(&newer, other).unwrap();
    let message = refused(&["check", "--add", &two, newer.to_str().unwrap()]);
    assert!(message.contains("version is 9."), "{message}");
    let whole = shard(&folder, "whole", &["--edges", "3"]);
    let message = refused(&["check", "--add", &whole]);
    assert!(message.contains("line 1: this is the result of a whole check"), "{message}");
    let message = refused(&["check", "--add", "README.md"]);
    assert!(
        message.contains("README.md: line 1: this is not a line of `check --json`"),
        "{message}"
    );
    let huge = fs::read_to_string(&one).unwrap().replace("1/4", "1/18446744073709551615");
    fs::write(&newer, huge).unwrap();
    let message = refused(&["check", "--add", newer.to_str().unwrap()]);
    assert!(message.contains("2/18446744073709551615 is missing"), "{message}");
}

/// Changes the last line of a shard: one of its starts was mapped wrongly.
fn with_wrong_map(file: &str, cause: &str) {
    let world = r#"{"name":"failed","about":"","doors":{"v0":["e0","e0"]},"start":{"at":"v0","facing":"e0:1"}}"#;
    let failure = format!(
        r#""failure":{{"cause":"{cause}","step":null,"moves":1,"world":{world}}},"holds":false"#
    );
    let text = fs::read_to_string(file).unwrap();
    let (before, last) = text.trim_end().rsplit_once('\n').unwrap_or(("", text.trim_end()));
    let mapped = objects(&format!("{last}\n"))[0]["mapped"].as_u64().unwrap();
    let last = last
        .replace(&format!("\"mapped\":{mapped},"), &format!("\"mapped\":{},", mapped - 1))
        .replace("\"failed\":0", "\"failed\":1")
        .replace("\"holds\":true", &failure);
    fs::write(file, format!("{before}\n{last}\n")).unwrap();
}

#[test]
fn a_wrong_map_in_one_shard_is_the_first_of_the_whole() {
    let folder = folder("merge_wrong");
    let one = shard(&folder, "one", &["--edges", "3", "--shard", "1/2"]);
    let two = shard(&folder, "two", &["--edges", "3", "--shard", "2/2"]);
    with_wrong_map(&two, "the map is wrong");
    let output = run(["check", "--add", "--json", &one, &two]);
    assert_eq!(output.status.code(), Some(1));
    let line = &objects(&stdout(&output))[0];
    assert_eq!((&line["failed"], &line["holds"]), (&1.into(), &false.into()));
    assert_eq!(line["failure"]["cause"], "the map is wrong");
    let text = stdout(&run(["check", "--add", &one, &two]));
    assert!(text.contains("Wrong: the map is wrong") && text.contains("violated"), "{text}");
}

#[test]
fn a_wrong_map_is_followed_by_the_command_that_explores_its_world() {
    let folder = folder("merge_folding");
    let folding = ["--algorithm", "folding", "--edges", "3", "--shard"];
    let shard = |n: &str| shard(&folder, &n.replace('/', "-"), &[&folding[..], &[n]].concat());
    let [one, two] = ["1/2", "2/2"].map(shard);
    with_wrong_map(&two, "the map is wrong");
    let text = stdout(&run(["check", "--add", &one, &two]));
    let words: Vec<_> = text.split_whitespace().collect();
    let command = "`toposlam explore --marker directional --algorithm folding`";
    assert!(words.join(" ").contains(command), "{text}");
}

/// A shard stops after a size with a wrong map, as the whole check does. The other shards go on.
#[test]
fn a_wrong_map_is_reported_although_its_shard_has_no_larger_sizes() {
    let folder = folder("merge_stopped");
    let one = shard(&folder, "one", &["--edges", "1..=4", "--shard", "1/2"]);
    let two = shard(&folder, "two", &["--edges", "1..=6", "--shard", "2/2"]);
    let message = refused(&["check", "--add", &one, &two]);
    assert!(message.contains("5 edges: shard 1/2 is missing\n6 edges: shard 1/2"), "{message}");
    with_wrong_map(&one, "the map is wrong");
    let junit = folder.join("merged.xml");
    let output = run(["check", "--add", &one, &two, "--json", "--junit", junit.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let lines = objects(&stdout(&output));
    let sizes: Vec<_> = lines.iter().map(|line| (&line["edges"], &line["holds"])).collect();
    let expected = [(1, true), (2, true), (3, true), (4, false)];
    let expected = expected.map(|(edges, holds)| (edges.into(), holds.into()));
    assert_eq!(sizes, expected.each_ref().map(|(edges, holds)| (edges, holds)));
    assert_eq!(lines[3]["failure"]["cause"], "the map is wrong");
    assert!(stderr(&output).contains("shards are missing from 5 edges on"), "{output:?}");
    let junit = fs::read_to_string(junit).unwrap();
    assert!(junit.contains("tests=\"6\" failures=\"1\" errors=\"2\""), "{junit}");
    // Before the wrong map, each shard must be there.
    let text = fs::read_to_string(&two).unwrap();
    fs::write(&two, text.split_inclusive('\n').skip(1).collect::<String>()).unwrap();
    let message = refused(&["check", "--add", &one, &two]);
    assert_eq!(message, "error: 1 edge: shard 2/2 is missing\n");
}

#[test]
fn counts_that_contradict_each_other_are_refused() {
    let folder = folder("merge_counts");
    let [one, two] = ["1/2", "2/2"]
        .map(|n| shard(&folder, &n.replace('/', "-"), &["--edges", "3", "--shard", n]));
    let good = fs::read_to_string(&one).unwrap();
    let starts = objects(&good)[0]["starts"].as_u64().unwrap();
    let [starts, mapped] = ["starts", "mapped"].map(|key| format!("\"{key}\":{starts},"));
    let most = |text: &str| {
        text.replace(&starts, "\"starts\":18446744073709551615,")
            .replace(&mapped, "\"mapped\":18446744073709551615,")
    };
    for (text, problem) in [
        (good.replace(&mapped, "\"mapped\":0,"), "line 1: `starts` is "),
        (good.replace("\"failed\":0", "\"failed\":18446744073709551615"), "line 1: `starts` is "),
        (good.replace("\"holds\":true", "\"holds\":false"), "line 1: `holds` is false, but"),
        (
            good.replace("\"moves_total\":", "\"moves_total\":0,\"unknown\":"),
            "line 1: `moves_max` is ",
        ),
        (most(&good), "line 1: with this, the sum of `starts` is 2^64 or more"),
    ] {
        fs::write(&one, &text).unwrap();
        let message = refused(&["check", "--add", &one, &two]);
        assert!(message.contains(problem), "{text}: {message}");
    }
}

fn journal_of(folder: &Path) -> (String, std::path::PathBuf) {
    let journal = folder.join("journal");
    (journal.to_str().unwrap().to_owned(), journal.join("7-edges.journal"))
}

/// Killed without a warning, again and again.
#[test]
fn a_check_that_was_killed_goes_on_and_prints_the_same_bytes() {
    let folder = folder("journal");
    let (journal, file) = journal_of(&folder);
    let check = ["check", "--json", "--edges", "7"];
    let with_journal = [&check[..], &["--journal", &journal]].concat();
    let mut sizes = vec![0];
    for _ in 0..2 {
        let mut child = toposlam();
        let mut child =
            child.args(&with_journal).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        let size = || fs::metadata(&file).map_or(0, |found| found.len());
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
    let mut bytes = fs::read(&file).unwrap();
    bytes.extend(b"01234567 {\"unit\":");
    fs::write(&file, bytes).unwrap();
    let resumed = run(&with_journal);
    assert!(stderr(&resumed).contains("7 edges: "), "{resumed:?}");
    assert_eq!(stdout(&resumed), stdout_of(check));
    // Finished: nothing is left to do.
    let finished = fs::read(&file).unwrap();
    assert_eq!(stdout_of(&with_journal), stdout_of(check));
    assert_eq!(fs::read(&file).unwrap(), finished);
}

/// The line of a unit with one start more, and with a right checksum.
fn other_counts(line: &str) -> String {
    let (_, json) = line.split_once(' ').unwrap();
    let json = json.replacen("\"starts\":", "\"starts\":1", 1);
    format!("{:08x} {json}\n", crc32fast::hash(json.as_bytes()))
}

#[test]
fn a_journal_is_for_one_process_at_a_time() {
    let folder = folder("journal_locked");
    let (journal, file) = journal_of(&folder);
    let check = ["check", "--edges", "7", "--journal", &journal];
    let whole = stdout_of(check);
    let locked = fs::File::open(&file).unwrap();
    locked.lock().unwrap();
    let name = file.to_str().unwrap();
    assert_eq!(refused(&check), format!("error: {name}: another process is writing this file\n"));
    drop(locked);
    assert_eq!(stdout_of(check), whole);
}

/// A limit on the size of a file takes the place of a full disk.
#[cfg(unix)]
#[test]
fn a_check_stops_when_its_journal_cannot_be_written_and_continues_later() {
    let folder = folder("journal_full");
    let (journal, file) = journal_of(&folder);
    let check = ["check", "--json", "--edges", "7", "--journal", &journal];
    let limited = "trap '' XFSZ; ulimit -f 8; exec \"$0\" \"$@\"";
    let mut shell = Command::new("sh");
    let shell = shell.current_dir(env!("CARGO_MANIFEST_DIR")).stdin(Stdio::null());
    let output =
        shell.args(["-c", limited, env!("CARGO_BIN_EXE_toposlam")]).args(check).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert_eq!(stdout(&output), "");
    let message = stderr(&output);
    let cause = format!("error: {}: the journal cannot be written: ", file.display());
    assert!(message.starts_with(&cause) && message.contains("continues"), "{message}");
    let resumed = run(check);
    assert!(stderr(&resumed).contains("of the work finished before"), "{resumed:?}");
    assert_eq!(stdout(&resumed), stdout_of(&check[..4]));
}

/// Ctrl-C can come when a size begins: its journal has the number of all units, and can be continued.
#[cfg(unix)]
#[test]
fn ctrl_c_leaves_journals_that_can_be_continued() {
    let folder = folder("journal_interrupted");
    let (journal, _) = journal_of(&folder);
    let check =
        ["check", "--json", "--edges", "4..=8", "--class", "corridor", "--journal", &journal];
    let mut child = toposlam();
    let mut child = child.args(check).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    // The journal of the next size is opened after the first line.
    let mut out = BufReader::new(child.stdout.take().unwrap());
    out.read_line(&mut String::new()).unwrap();
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(killed.success());
    out.read_to_string(&mut String::new()).unwrap();
    child.wait().unwrap();
    assert_eq!(stdout_of(check), stdout_of(&check[..6]));
}

#[test]
fn a_corrupt_or_foreign_journal_is_refused() {
    let folder = folder("journal_refused");
    let (journal, _) = journal_of(&folder);
    let check = ["check", "--edges", "4", "--journal", &journal];
    let whole = stdout_of(check);
    assert_eq!(stdout_of(check), whole);
    let file = folder.join("journal/4-edges.journal");
    let name = file.to_str().unwrap();
    let message = refused(&[&check[..], &["--class", "simple"]].concat());
    let foreign = "this is the journal of another check: the class is multigraph, not simple";
    assert_eq!(message, format!("error: {name}: {foreign}\n"));
    let message = refused(&[&check[..], &["--shard", "1/2"]].concat());
    assert!(message.contains("the shard is 1/1, not 1/2"), "{message}");
    let good = fs::read_to_string(&file).unwrap();
    let lines: Vec<_> = good.lines().collect();
    for (text, problem) in [
        (
            good.replacen("\"starts\":", "\"starts\":1", 1),
            "line 2: the journal is corrupt: the checksum",
        ),
        (good.replacen("\"edges\":4", "\"edges\":5", 1), "line 1: this is not the first line"),
        ("nothing\n".to_owned(), "line 1: this is not the first line"),
        ("nothing, and no end of a line".to_owned(), "line 1: this is not the first line"),
        ("nothing\nan unfinished line".to_owned(), "line 1: this is not the first line"),
        (format!("{good}{}", other_counts(lines[1])), "a unit occurs twice, with different counts"),
        (format!("{good}\n"), "the checksum is wrong"),
    ] {
        fs::write(&file, &text).unwrap();
        let message = refused(&check);
        assert!(message.starts_with(&format!("error: {name}: ")), "{message}");
        assert!(message.contains(problem), "{message}");
        // A file that may belong to someone else is not changed.
        assert_eq!(fs::read_to_string(&file).unwrap(), text);
    }
    // A unit that two processes finished, and the first line of a check that was killed.
    for text in [format!("{good}{}\n", lines[1]), lines[0][..40].to_owned(), String::new()] {
        fs::write(&file, text).unwrap();
        assert_eq!(stdout_of(check), whole);
    }
    for without_effect in
        [&["--choices", "all"][..], &["--from", "worlds/petersen.toml"], &["--estimate"]]
    {
        let arguments = [&["check", "--journal", &journal], without_effect].concat();
        refused(&arguments);
    }
}

/// A000698 and the published numbers of moves are within the intervals.
#[test]
fn an_estimate_is_near_the_truth_and_follows_its_seed() {
    let estimate = |more: &[&str]| {
        let arguments = ["check", "--estimate", "--json", "--edges", "7", "--probes", "400"];
        objects(&stdout_of([&arguments[..], more].concat())).remove(0)
    };
    let [one, same, other] = [&["--seed", "1"][..], &[], &["--seed", "2"]].map(estimate);
    for key in ["starts", "moves_total", "moves_made"] {
        assert_eq!(one[key], same[key]);
        assert_ne!(one[key], other[key]);
    }
    let published =
        [("starts", 1_708_394.0), ("moves_total", 25_375_585.0), ("moves_made", 13_166_198.0)];
    for (key, truth) in published {
        let [low, high] = ["low", "high"].map(|bound| one[key][bound].as_f64().unwrap());
        assert!(low < truth && truth < high && high - low < 0.4 * truth, "{key}: {}", one[key]);
    }
    let seconds = |bound: &str| one["seconds"][bound].as_f64().unwrap();
    assert!(0.0 < seconds("mean") && seconds("low") <= seconds("mean"), "{}", one["seconds"]);
    assert!(seconds("mean") <= seconds("high"), "{}", one["seconds"]);
    refused(&["check", "--probes", "9"]);
    refused(&["check", "--estimate", "--shard", "1/2"]);
    refused(&["check", "--estimate", "--choices", "all"]);
}

/// In a class with few worlds most probes end where none is left.
#[test]
fn an_estimate_without_a_start_knows_nothing() {
    let arguments = ["check", "--estimate", "--class", "simple", "--edges", "14", "--probes", "2"];
    let output = run(arguments);
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    let text = stdout(&output);
    assert_eq!(text.matches("not known").count(), 4, "{text}");
    assert!(
        text.contains("  none of 2 probes found a start, seed 1; use more --probes\n"),
        "{text}"
    );
    let line = objects(&stdout(&run([&arguments[..], &["--json"]].concat()))).remove(0);
    for key in ["starts", "moves_total", "moves_made", "seconds"] {
        assert!(line[key].is_null(), "{line}");
    }
}
