//! Logs that are not one binary file: events as JSON lines or CSV, CARMEN logs, folders of rosbag2.

use std::fs;

use super::{folder, objects, run, stderr, stdout, stdout_of};

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

fn json(events: &[(u32, Option<u32>)]) -> String {
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

#[test]
fn events_as_json_lines_or_csv_are_checked() {
    let folder = folder("event_lines");
    let path = folder.join("events");
    let check = |text: &str| {
        fs::write(&path, text).unwrap();
        let arguments = ["conform", path.to_str().unwrap(), "--world", "worlds/shape-6.toml"];
        let options = ["--start", "any", "--driver", "anyone", "--marker", "none", "--json"];
        let output = run([&arguments[..], &options[..]].concat());
        let printed = Some(stdout(&output)).filter(|text| !text.is_empty());
        let line = printed.map(|text| objects(&text).remove(0));
        (output.status.code(), line, stderr(&output))
    };
    for text in [json(&AROUND), csv(&AROUND)] {
        let (code, line, error) = check(&text);
        assert_eq!(code, Some(0), "{error}");
        assert_eq!(line.unwrap()["verdict"], "conforms");
    }
    // A number that is missing says nothing of the robot.
    let mut gap = AROUND;
    for (degree, code) in [(2, 0), (3, 1)] {
        gap[4].0 = degree;
        let (found, line, error) = check(&json(&gap).replace("\"index\":4,", ""));
        assert_eq!(found, Some(code), "{line:?} {error}");
    }
    // What conform prints after the events is skipped.
    let (code, line, _) =
        check(&(json(&AROUND) + "{\"kind\":\"conform\",\"verdict\":\"conforms\"}\n"));
    let line = line.unwrap();
    assert_eq!((code, &line["skipped"]["unknown"]["conform"]), (Some(0), &1.into()), "{line}");
    assert_eq!(line["remarks"], serde_json::json!(["skipped lines: 1 conform"]));
    // A visit with a stamp that is not seconds, or with a marker along no door, is no visit less.
    for (field, wrong) in [
        ("\"stamp\":4.5", "\"stamp\":1e300"),
        ("\"stamp\":4.5", "\"stamp\":1700000000000"),
        ("\"marker\":null", "\"marker\":-9"),
        ("\"marker\":null", "\"marker\":99999999999"),
    ] {
        let (code, _, error) = check(&json(&AROUND).replacen(field, wrong, 1));
        let line = if field.contains("stamp") {
            "line 5: its stamp is "
        } else {
            "line 1: its marker is "
        };
        assert!(code == Some(2) && error.contains(line), "{error}");
    }
    let twice = csv(&AROUND).replacen("door,degree", "door,degree,Door", 1);
    let (code, _, error) = check(&twice);
    assert!(
        code == Some(2) && error.ends_with("line 1: the column door is there twice\n"),
        "{error}"
    );
    let mut wrong = AROUND;
    wrong[4].0 = 3;
    for text in [json(&wrong), csv(&wrong)] {
        let (code, line, _) = check(&text);
        let line = line.unwrap();
        assert_eq!((code, &line["verdict"]), (Some(1), &"diverged".into()), "{line}");
    }
    // A visit was lost.
    let lost: String = json(&AROUND)
        .split_inclusive('\n')
        .enumerate()
        .filter(|(index, _)| *index != 3)
        .map(|(_, line)| line)
        .collect();
    assert_eq!(check(&lost).0, Some(1));
    let broken = json(&AROUND).replace("\"degree\":3,\"door\":1", "\"degree\":3.5,\"door\":1");
    let (code, _, error) = check(&broken);
    let expected = "line 3: invalid type: floating point `3.5`, expected u32\n";
    assert!(code == Some(2) && error.ends_with(expected), "{error}");
    fs::remove_dir_all(folder).unwrap();
}

/// What `--json` prints of a log is the same log: also that the robot turned back, and that a junction was not
/// recognised.
#[test]
fn printed_events_are_read_as_they_were_printed() {
    let folder = folder("printed_events");
    let path = folder.join("events.jsonl");
    let line = |index: usize, degree: &str, door: u32, turned_back: bool| {
        format!(
            "{{\"degree\":{degree},\"door\":{door},\"index\":{index},\"kind\":\"event\",\"length\":null,\"marker\":null,\
             \"schema\":1,\"stamp\":{index}.5,\"turned_back\":{turned_back}}}\n"
        )
    };
    // From the dead end of shape 6 into the wrong arm of its T, back, and around.
    let around = [(1, 0), (2, 1), (3, 2), (3, 2), (2, 1), (2, 1), (2, 1), (3, 1), (2, 1), (1, 0)];
    let text: String = around
        .iter()
        .enumerate()
        .map(|(index, (degree, door))| line(index, &degree.to_string(), *door, index == 3))
        .collect();
    let check = |text: &str| {
        fs::write(&path, text).unwrap();
        let arguments = ["conform", path.to_str().unwrap(), "--world", "worlds/shape-6.toml"];
        let options = ["--start", "any", "--driver", "anyone", "--marker", "none"];
        let output =
            run([&arguments[..], &options[..], &["--events", "recorded", "--json"]].concat());
        let lines = objects(&stdout(&output));
        let events =
            lines.iter().filter(|line| line["kind"] == "event").cloned().collect::<Vec<_>>();
        (output.status.code(), events, lines.last().cloned().unwrap_or_default())
    };
    let (code, events, verdict) = check(&text);
    assert_eq!((code, &verdict["verdict"]), (Some(0), &"conforms".into()), "{verdict}");
    assert_eq!(events, objects(&text));
    let back: Vec<_> = events.iter().map(|event| event["turned_back"] == true).collect();
    assert_eq!(back.iter().position(|&back| back), Some(3));
    // A robot that has not turned back has come to another junction.
    let (code, ..) = check(&text.replace("\"turned_back\":true", "\"turned_back\":false"));
    assert_eq!(code, Some(1));
    let undecided = text.replacen("\"degree\":3,\"door\":1", "\"degree\":null,\"door\":null", 1);
    let (code, events, verdict) = check(&undecided);
    // What was not recognised is no fault: the events before it are checked.
    assert_eq!((code, &verdict["verdict"]), (Some(3), &"incomplete".into()), "{verdict}");
    let remarks = verdict["remarks"].to_string();
    assert!(
        remarks.contains("was not recognised: the events from there on are not checked"),
        "{verdict}"
    );
    assert_eq!(events, objects(&undecided));
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn info_lists_a_carmen_log() {
    let folder = folder("carmen_log");
    let path = folder.join("a.clf");
    let text = "# a comment\nPARAM robot_frontlaser_offset 0.2 h 0\nODOM 0 0 0 0 0 0 10 h 10\n\
        FLASER 3 1 2 3 0 0 0 0 0 0 12 h 12\nNEFF 3\nODOM 0 0 0 0 0 0 0 h 0\n";
    fs::write(&path, text).unwrap();
    let path = path.to_str().unwrap();
    let text = stdout_of(["info", path]);
    for part in [
        ": CARMEN log, 140 bytes\n",
        "\n2 messages\nskipped lines: 1 NEFF, 1 whose time is far from that of their neighbours\n",
        "\n  scan      FLASER\n  odometry  ODOM\n",
        ", for 2.000 s\n",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let line = objects(&stdout_of(["info", path, "--json"])).remove(0);
    assert_eq!((&line["format"], &line["compression"]), (&"carmen".into(), &().into()));
    assert_eq!(line["skipped"]["unknown"], serde_json::json!({"NEFF": 1}));
    assert_eq!(line["skipped"]["off_clock"], 1);
    assert_eq!(line["mapping"], serde_json::json!({"scan": ["FLASER"], "odometry": ["ODOM"]}));
    let verified = stdout_of(["info", path, "--verify"]);
    assert!(verified.contains("contents verified: 2 messages, 0 chunks"), "{verified}");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_folder_of_rosbag2_is_one_log() {
    let folder = folder("rosbag2_folder");
    let log = folder.join("run_0.mcap");
    let [at, file] = [&folder, &log].map(|path| path.to_str().unwrap());
    stdout_of(["simulate", "worlds/shape-6.toml", "--by-scene", "--seed", "3", "--log", file]);
    let text = stdout_of(["info", at]);
    assert!(text.contains(": rosbag2 folder, "), "{text}");
    let [of_folder, of_file] =
        [at, file].map(|log| objects(&stdout_of(["info", log, "--json", "--verify"])).remove(0));
    assert_eq!(of_folder["format"], "rosbag2");
    for field in ["bytes", "messages", "start", "end", "topics", "mapping", "verification"] {
        assert_eq!(of_folder[field], of_file[field], "{field}");
    }
    let html = folder.parent().unwrap().join("rosbag2_folder.html");
    let html = html.to_str().unwrap();
    stdout_of(["conform", at, "--world", "worlds/shape-6.toml", "--html", html]);
    assert!(fs::read_to_string(html).unwrap().contains("conforms"));
    // The files of the folder are inputs.
    let output = run(["info", at, "--write-topics", file]);
    assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
    fs::write(folder.join("metadata.yaml"), "relative_file_paths: [run_1.mcap]\n").unwrap();
    let output = run(["info", at]);
    assert_eq!(output.status.code(), Some(2));
    let expected = format!(
        "error: {at}: run_1.mcap: cannot be read: No such file or directory (os error 2)\n"
    );
    assert_eq!(stderr(&output), expected);
    fs::remove_file(html).unwrap();
    fs::remove_dir_all(folder).unwrap();
}
