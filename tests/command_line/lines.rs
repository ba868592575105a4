//! Logs that are not one binary file: events as JSON lines or CSV, CARMEN logs, folders of rosbag2.

use std::fs;

use serde_json::{Value, json};

use super::{Scratch, objects, stderr, stdout};

/// From the dead end of shape 6 around its loop and back: degree and door of each visit.
const AROUND: [(u32, Option<u32>); 9] = [
    (1, Some(0)),
    (2, Some(1)),
    (3, Some(1)),
    (2, Some(1)),
    (2, Some(1)),
    (2, Some(1)),
    (3, Some(1)),
    (2, Some(1)),
    (1, None),
];

fn json_lines(events: &[(u32, Option<u32>)]) -> String {
    let line = |(index, (degree, door)): (usize, &(u32, Option<u32>))| {
        let door = door.map_or("null".to_owned(), |door| door.to_string());
        format!(
            "{{\"kind\":\"event\",\"index\":{index},\"stamp\":{index}.5,\"degree\":{degree},\"door\":{door},\
             \"marker\":null}}\n"
        )
    };
    events.iter().enumerate().map(line).collect()
}

fn csv(events: &[(u32, Option<u32>)]) -> String {
    let line = |(degree, door): &(u32, Option<u32>)| {
        let door = door.map_or(String::new(), |door| door.to_string());
        format!("{door},{degree}\n")
    };
    format!("door,degree\n{}", events.iter().map(line).collect::<String>())
}

/// The exit code, the objects and the error of a check of events in shape 6.
fn check(scratch: &Scratch, text: &str, more: &str) -> (i32, Vec<Value>, String) {
    scratch.write("events", text);
    let options = "--world worlds/shape-6.toml --start any --driver anyone --marker none --json";
    let output = scratch.run(&format!("conform events {options} {more}"));
    let printed = stdout(&output);
    let lines = if printed.is_empty() { Vec::new() } else { objects(&printed) };
    (output.status.code().unwrap(), lines, stderr(&output))
}

#[test]
fn events_as_json_lines_or_csv_are_checked() {
    let scratch = Scratch::new("event_lines");
    let around = json_lines(&AROUND);
    let with = |degree| {
        let mut events = AROUND;
        events[4].0 = degree;
        events
    };
    // A number that is missing says nothing of the robot.
    let without_4 = |degree| json_lines(&with(degree)).replace("\"index\":4,", "");
    // A visit was lost.
    let lost: String = around
        .split_inclusive('\n')
        .enumerate()
        .filter(|(index, _)| *index != 3)
        .map(|(_, line)| line)
        .collect();
    for (text, code) in [
        (around.clone(), 0),
        (csv(&AROUND), 0),
        (without_4(2), 0),
        (without_4(3), 1),
        (json_lines(&with(3)), 1),
        (csv(&with(3)), 1),
        (lost, 1),
    ] {
        let (found, lines, error) = check(&scratch, &text, "");
        assert_eq!(found, code, "{text} {error}");
        let verdict = if code == 0 { "conforms" } else { "diverged" };
        assert_eq!(lines[0]["verdict"], verdict, "{text}");
    }
    // What conform prints after the events is skipped.
    let (code, lines, _) = check(
        &scratch,
        &(around.clone() + "{\"kind\":\"conform\",\"verdict\":\"conforms\"}\n"),
        "",
    );
    assert_eq!((code, &lines[0]["skipped"]["unknown"]["conform"]), (0, &1.into()), "{lines:?}");
    assert_eq!(lines[0]["remarks"], json!(["skipped lines: 1 conform"]));
    // A visit with a stamp that is not seconds, or with a marker along no door, is no visit less.
    for (text, cause) in [
        (around.replacen("\"stamp\":4.5", "\"stamp\":1e300", 1), "line 5: its stamp is "),
        (around.replacen("\"stamp\":4.5", "\"stamp\":1700000000000", 1), "line 5: its stamp is "),
        (around.replacen("\"marker\":null", "\"marker\":-9", 1), "line 1: its marker is "),
        (around.replacen("\"marker\":null", "\"marker\":99999999999", 1), "line 1: its marker is "),
        (
            csv(&AROUND).replacen("door,degree", "door,degree,Door", 1),
            "line 1: the column door is there twice\n",
        ),
        (
            around.replace("\"degree\":3,\"door\":1", "\"degree\":3.5,\"door\":1"),
            "line 3: invalid type: floating point `3.5`, expected u32\n",
        ),
    ] {
        let (code, _, error) = check(&scratch, &text, "");
        assert!(code == 2 && error.contains(cause), "{error}");
    }
}

/// What `--json` prints of a log is the same log: also that the robot turned back, and that a junction was not
/// recognised.
#[test]
fn printed_events_are_read_as_they_were_printed() {
    let scratch = Scratch::new("printed_events");
    // From the dead end of shape 6 into the wrong arm of its T, back, and around.
    let around = [(1, 0), (2, 1), (3, 2), (3, 2), (2, 1), (2, 1), (2, 1), (3, 1), (2, 1), (1, 0)];
    let line = |(index, (degree, door)): (usize, &(u32, u32))| {
        format!(
            "{{\"degree\":{degree},\"door\":{door},\"index\":{index},\"kind\":\"event\",\"length\":null,\
             \"marker\":null,\"schema\":1,\"stamp\":{index}.5,\"turned_back\":{}}}\n",
            index == 3
        )
    };
    let text: String = around.iter().enumerate().map(line).collect();
    // What was not recognised is no fault: the events before it are checked.
    let undecided = text.replacen("\"degree\":3,\"door\":1", "\"degree\":null,\"door\":null", 1);
    let remark = "was not recognised: the events from there on are not checked";
    for (text, code, verdict, remark) in
        [(&text, 0, "conforms", ""), (&undecided, 3, "incomplete", remark)]
    {
        let (found, mut lines, _) = check(&scratch, text, "--events recorded");
        let last = lines.pop().unwrap();
        assert_eq!((found, &last["verdict"]), (code, &verdict.into()), "{last}");
        assert!(last["remarks"].to_string().contains(remark), "{last}");
        assert_eq!(lines, objects(text));
    }
    // A robot that has not turned back has come to another junction.
    let onward = text.replace("\"turned_back\":true", "\"turned_back\":false");
    assert_eq!(check(&scratch, &onward, "--events recorded").0, 1);
}

/// The snapshots of `info` show this log.
#[test]
fn info_lists_a_carmen_log() {
    Scratch::new("carmen_log").facts(&[(
        "info tests/snapshots/files/robot.log --verify",
        0,
        json!({
            "format": "carmen", "compression": null, "bytes": 140, "messages": 2,
            "skipped.unknown": {"NEFF": 1}, "skipped.off_clock": 1,
            "mapping": {"scan": ["FLASER"], "odometry": ["ODOM"]}, "verification.messages": 2,
        }),
    )]);
}

#[test]
fn a_folder_of_rosbag2_is_one_log() {
    let scratch = Scratch::new("rosbag2_folder");
    fs::create_dir(scratch.path("run")).unwrap();
    let simulate = "simulate worlds/shape-6.toml --by-scene --seed 3 --log run/run_0.mcap";
    scratch.out(simulate, 0);
    let [of_folder, of_file] =
        ["run", "run/run_0.mcap"].map(|log| scratch.last(&format!("info {log} --verify"), 0));
    assert_eq!(of_folder["format"], "rosbag2");
    for field in ["bytes", "messages", "start", "end", "topics", "mapping", "verification"] {
        assert_eq!(of_folder[field], of_file[field], "{field}");
    }
    scratch.out("conform run --world worlds/shape-6.toml --html page.html", 0);
    assert!(scratch.text("page.html").contains("conforms"));
    // The files of the folder are inputs.
    scratch.error("info run --write-topics run/run_0.mcap");
    scratch.write("run/metadata.yaml", "relative_file_paths: [run_1.mcap]\n");
    let expected =
        "error: run: run_1.mcap: cannot be read: No such file or directory (os error 2)\n";
    assert_eq!(scratch.error("info run"), expected);
}
