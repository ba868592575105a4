//! `toposlam conform`: remarks, limits, starts and commands in its report, and the map that it writes.

use std::fs;

use serde_json::json;
use toposlam_logs::{
    messages::{Door, Percept, ProjectMessage, Run, Stamp},
    writer::LogWriter,
};

use super::{
    conform::{judged, logged, walked},
    folder, objects, read_world, run, stderr, stdout,
};

/// Without --world, doors of any driver.
const ANYONE: [&str; 2] = ["--driver", "anyone"];

#[test]
fn the_map_of_a_log_has_the_marker_where_the_robot_saw_it() {
    let folder = folder("conform-map-marker");
    // From a dead end to a junction with three doors, where the marker lies along door 1.
    let log = walked(&folder, &[(1, -1, Some(0)), (3, 1, None)]);
    let map = folder.join("map.toml");
    let (code, _) = judged(&log, &[&ANYONE[..], &["--map", map.to_str().unwrap()]].concat());
    assert_eq!(code, Some(0));
    let world = read_world(&map);
    let facing = world.start.unwrap();
    assert_eq!(world.graph.degree(world.graph.vertex(facing)), 3);
    // The robot did not come by the dart of the marker.
    assert_ne!(world.graph.degree(world.graph.vertex(world.graph.opposite(facing))), 1);
}

#[test]
fn a_limit_that_leaves_smaller_worlds_open_is_a_remark_and_does_not_decide() {
    let folder = folder("conform-smaller");
    // Six doors that were never followed.
    let log = walked(&folder, &[(6, 0, None)]);
    let simple = [&ANYONE[..], &["--class", "simple"]].concat();
    let (code, report) = judged(&log, &[&simple[..], &["--max-steps", "1"]].concat());
    assert_eq!((code, &report["verdict"]), (Some(0), &"conforms".into()), "{report}");
    assert_eq!(report["smallest"]["least"], false, "{report}");
    let limit = json!({ "option": "--max-steps", "value": 1, "decides": false, "event": null });
    assert_eq!(report["limits"], json!([limit]));
    let remark =
        "a smaller world may explain it: the search reached its limit of 1 step (--max-steps)";
    assert_eq!(report["remarks"], json!([remark]));
    let world = report["facts"]["world"].as_str().unwrap();
    assert!(world.starts_with("unknown; one that explains the log has "), "{world}");
    let (_, report) = judged(&log, &simple);
    assert_eq!((&report["smallest"]["least"], &report["limits"]), (&true.into(), &json!([])));
    let world = report["facts"]["world"].as_str().unwrap();
    assert!(world.starts_with("unknown; the smallest that explains the log has "), "{world}");
    // What was not searched does not matter to a log that diverges.
    let marked = walked(&folder, &[(3, 0, Some(1)), (3, 1, Some(0)), (4, -1, None)]);
    let (code, report) = judged(&marked, &["--max-darts", "1"]);
    assert_eq!((code, &report["remarks"]), (Some(1), &json!([])), "{report}");
}

#[test]
fn many_doors_that_were_never_followed_are_counted() {
    let folder = folder("conform-many-doors");
    let unique = |doors: u32| {
        let log = walked(&folder, &[(doors, 0, None)]);
        let (_, report) = judged(&log, &[&ANYONE[..], &["--max-steps", "1"]].concat());
        report["facts"]["unique"].as_str().unwrap().to_owned()
    };
    assert!(unique(8).ends_with("v0 door 6, v0 door 7."), "{}", unique(8));
    assert!(unique(9).ends_with("v0 door 7, and 1 more."), "{}", unique(9));
    let many = unique(12);
    assert!(
        many.contains("12 doors were never followed: v0 door 0, ")
            && many.ends_with("v0 door 7, and 4 more."),
        "{many}"
    );
}

#[test]
fn the_remarks_name_what_the_log_does_not_have() {
    let folder = folder("conform-remarks");
    // Algorithm 1 would go on.
    let log = walked(&folder, &[(3, 0, Some(0)), (1, -1, None)]);
    let (code, report) = judged(&log, &[]);
    assert_eq!((code, &report["verdict"]), (Some(0), &"conforms".into()), "{report}");
    assert_eq!(report["remarks"], json!(["the log ends before the map is complete"]));
    assert_eq!(judged(&log, &ANYONE).1["remarks"], json!([]));
    // A head without an end.
    let log = folder.join("head.mcap");
    let mut writer = LogWriter::new(Vec::new()).unwrap();
    writer.write(Run::TOPIC, 0, &Run::default()).unwrap();
    let at = |second| Stamp { sec: second, nanosec: 0 };
    for (moves, degree, marker) in [(0, 3, 0), (1, 1, -1)] {
        let (stamp, entry) = (at(2 * moves), f64::NAN);
        let number = moves as u32;
        let percept = Percept { stamp, r#move: number, degree, marker, form: [false; 4], entry };
        writer.write(Percept::TOPIC, stamp.nanoseconds(), &percept).unwrap();
        if moves == 0 {
            let door = Door { stamp: at(1), r#move: 1, door: 0 };
            writer.write(Door::TOPIC, door.stamp.nanoseconds(), &door).unwrap();
        }
    }
    fs::write(&log, writer.finish().unwrap()).unwrap();
    let (code, report) = judged(&log, &[]);
    assert_eq!((code, &report["verdict"]), (Some(3), &"incomplete".into()), "{report}");
    assert_eq!(report["remarks"], json!(["the log does not record how the run ended"]));
}

#[test]
fn a_recorded_start_counts_only_in_the_world_of_the_log() {
    let folder = folder("conform-same-names");
    let log = logged(&folder, "worlds/shape-6.toml", &["--start", "ne:tee"]);
    let start = |world: &str| judged(&log, &["--world", world]).1["world"]["start"].clone();
    assert_eq!(start("worlds/shape-6.toml"), "ne:tee");
    // Another world with the same names: the way in leads to another junction.
    let other = folder.join("other.toml");
    let text = fs::read_to_string("worlds/shape-6.toml").unwrap();
    let text = text.replace("from = \"end\"\nto = \"corner\"", "from = \"end\"\nto = \"ne\"");
    fs::write(&other, text).unwrap();
    assert_eq!(start(other.to_str().unwrap()), "corner:tee");
}

#[test]
fn the_command_of_a_shorter_log_has_the_options_that_decide() {
    let folder = folder("conform-command");
    let short = folder.join("short.mcap");
    let minimise = ["--minimise", short.to_str().unwrap()];
    let command = |report: &serde_json::Value| report["command"].as_str().unwrap().to_owned();
    let again = |command: &str| {
        let output =
            run([&command.split(' ').skip(1).collect::<Vec<_>>()[..], &["--json"]].concat());
        assert_eq!(output.status.code(), Some(1), "{command} {}", stderr(&output));
        objects(&stdout(&output)).remove(0)
    };
    // A hallway that leads back to its own junction is impossible in some classes only.
    let log = walked(&folder, &[(3, 0, Some(1)), (3, 1, None)]);
    assert_eq!(judged(&log, &ANYONE).0, Some(0));
    let arguments = [&ANYONE[..], &["--class", "simple"], &minimise].concat();
    let (code, report) = judged(&log, &arguments);
    assert_eq!((code, &report["cause"]), (Some(1), &"no-world".into()), "{report}");
    assert_eq!(again(&command(&report))["condition"], report["condition"]);
    let log = logged(&folder, "worlds/shape-6.toml", &["--seed", "3"]);
    let world = ["--world", "worlds/shape-8.toml", "--start", "se:e"];
    let (code, report) = judged(&log, &[&world[..], &minimise].concat());
    assert_eq!(code, Some(1), "{report}");
    let command = command(&report);
    assert!(command.ends_with(" --start se:e"), "{command}");
    let again = again(&command);
    assert_eq!((&again["cause"], &again["class"]), (&report["cause"], &report["class"]));
    assert_eq!(again["event"], report["shorter"].as_array().unwrap().len());
}

#[test]
fn a_complete_run_of_the_folding_explorer_has_each_case_that_is_expected() {
    let folder = folder("conform-expected-folding");
    // Algorithm 1 would come to a T from its other side too.
    let plan = "worlds/shape-8.toml";
    let log = logged(&folder, plan, &["--seed", "3", "--algorithm", "folding"]);
    let page = folder.join("report.html");
    let (code, _) = judged(&log, &["--world", plan, "--html", page.to_str().unwrap()]);
    assert_eq!(code, Some(0));
    let written = fs::read_to_string(page).unwrap();
    assert!(written.contains("<tr class=\"beyond\"><th scope=\"row\">t-stem-right</th>"));
    assert!(!written.contains("<tr class=\"missed\">"));
}

#[test]
fn a_log_that_cannot_be_read_is_a_case_without_a_result() {
    let folder = folder("conform-junit");
    let good = logged(&folder, "worlds/shape-6.toml", &["--seed", "3"]);
    let bad = folder.join("text.mcap");
    fs::write(&bad, "not a log").unwrap();
    let [good, bad] = [&good, &bad].map(|path| path.to_str().unwrap());
    let report = folder.join("report.xml");
    let output = run(["conform", good, bad, "--junit", report.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    let written = fs::read_to_string(&report).unwrap();
    assert!(written.contains("tests=\"2\" failures=\"0\" errors=\"1\""), "{written}");
    assert!(written.contains("message=\"the log cannot be checked: "), "{written}");
    // What is not known has its reason.
    let walk = walked(&folder, &[(3, 0, Some(1)), (1, -1, None)]);
    let walk = walk.to_str().unwrap();
    let output = run(["conform", walk, "--max-darts", "1", "--junit", report.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    let written = fs::read_to_string(&report).unwrap();
    assert!(written.contains("Algorithm 1 was followed up to event 1: "), "{written}");
}

#[test]
fn a_robot_that_should_see_its_marker_and_does_not_diverges() {
    let folder = folder("conform-no-marker");
    let log = walked(&folder, &[(1, -1, Some(0)), (1, -1, None)]);
    // Without --marker the log may be of a robot that has none.
    assert_eq!(run(["conform", log.to_str().unwrap()]).status.code(), Some(2));
    let (code, report) = judged(&log, &["--marker", "directional"]);
    assert_eq!((code, &report["event"]), (Some(1), &1.into()), "{report}");
    assert_eq!(report["cause"], "contradiction");
}

#[test]
fn the_marker_of_the_check_is_in_the_head_of_a_shorter_log() {
    let folder = folder("conform-short-marker");
    let log = walked(&folder, &[(3, 0, Some(1)), (1, -1, None)]);
    let short = folder.join("short.mcap");
    // A robot without a marker sees none.
    let unmarked = ["--marker", "none", "--minimise", short.to_str().unwrap()];
    let (code, report) = judged(&log, &[&ANYONE[..], &unmarked].concat());
    assert_eq!((code, &report["event"]), (Some(1), &1.into()), "{report}");
    let command = report["command"].as_str().unwrap();
    let output = run(command.split(' ').skip(1));
    assert_eq!(output.status.code(), Some(1), "{command}: {}", stdout(&output));
}

#[test]
fn other_choices_are_reported_from_the_first_event_that_differs() {
    let folder = folder("conform-other-choices");
    // The default choice is door 0.
    let log = walked(&folder, &[(3, 0, Some(2)), (1, -1, None)]);
    let (code, report) = judged(&log, &[]);
    assert_eq!(code, Some(0), "{report}");
    let doors = json!({ "algorithm": "algorithm1", "choices": "other", "from_event": 2 });
    assert_eq!(report["doors"], doors);
    let words = "allowed by Algorithm 1; not its default choices from event 2 on";
    assert_eq!(report["facts"]["doors"], words);
}

#[test]
fn the_last_six_steps_before_a_divergence_are_shown() {
    let folder = folder("conform-last-steps");
    let there = (3, -1, Some(0));
    let log = walked(&folder, &[(3, 0, Some(0)), there, (3, 0, Some(0)), there, (2, -1, None)]);
    let text = stdout(&run([&["conform", log.to_str().unwrap()][..], &ANYONE].concat()));
    let (_, steps) = text.split_once("  the last steps before it:\n").expect(&text);
    let numbers: Vec<_> = steps
        .lines()
        .map_while(|line| line.strip_prefix("    ")?.split_whitespace().next()?.parse::<u32>().ok())
        .collect();
    assert_eq!(numbers, [3, 4, 5, 6, 7, 8], "{text}");
}

#[test]
fn a_robot_that_was_carried_was_moved_between_two_events() {
    let folder = folder("conform-moved");
    let log = logged(&folder, "worlds/shape-6.toml", &["--fault", "carried@40"]);
    let page = folder.join("moved.html");
    let arguments = [&ANYONE[..], &["--html", page.to_str().unwrap()]].concat();
    let (code, report) = judged(&log, &arguments);
    assert_eq!(
        (code, &report["cause"], &report["class"]),
        (Some(1), &json!("moved"), &json!("motion"))
    );
    let condition = report["condition"].as_str().unwrap();
    assert!(condition.starts_with("moved by hand or slipped between events "), "{condition}");
    let page = fs::read_to_string(page).unwrap();
    assert!(page.contains("oved by hand or slipped between events "), "no page");
    let lengths = &report["lengths"];
    assert_eq!((&lengths["moves"], &lengths["measured"]), (&json!(15), &json!(15)), "{lengths}");
}

#[test]
fn a_shorter_log_of_a_robot_that_was_carried_has_its_lengths() {
    let folder = folder("conform-moved-shorter");
    let short = folder.join("short.mcap");
    let mut shorter = 0;
    for (seed, image) in [("0", "40"), ("1", "40"), ("2", "60")] {
        let fault = format!("carried@{image}");
        let log = logged(&folder, "worlds/shape-6.toml", &["--seed", seed, "--fault", &fault]);
        let minimise = [&ANYONE[..], &["--minimise", short.to_str().unwrap()]].concat();
        let (code, report) = judged(&log, &minimise);
        // Percepts may show it first.
        if report["cause"] != "moved" {
            continue;
        }
        let command = report["command"].as_str().unwrap();
        let words = command.split(' ').skip(1).chain(["--json"]);
        let output = run(words);
        assert_eq!((code, output.status.code()), (Some(1), Some(1)), "{command}");
        let again = objects(&stdout(&output)).remove(0);
        assert_eq!((&again["cause"], &again["class"]), (&report["cause"], &report["class"]));
        // It ends with the event that diverges.
        let events = report["shorter"].as_array().unwrap().len();
        assert_eq!((&again["event"], &again["events"]), (&events.into(), &events.into()));
        let measured = |report: &serde_json::Value| {
            let condition = report["condition"].as_str().unwrap();
            // The way of a closed walk is shorter; how far from its beginning it ends is not.
            let what = condition.split_once(": ").unwrap().1;
            what.split_once(" ends ").map_or(what, |(_, off)| off).to_owned()
        };
        assert_eq!(measured(&again), measured(&report));
        shorter += usize::from(events < report["event"].as_u64().unwrap() as usize);
    }
    assert!(shorter > 0);
}

#[test]
fn without_odometry_the_report_states_that_lengths_were_not_compared() {
    let folder = folder("conform-no-odometry");
    let log = walked(&folder, &[(1, -1, Some(0)), (3, 1, Some(0)), (1, -1, None)]);
    let (code, report) = judged(&log, &ANYONE);
    assert_eq!(code, Some(0), "{report}");
    assert_eq!(report["lengths"], json!({"moves": 2, "measured": 0, "compared": 0}));
    let fact = "not compared: no odometry between the junctions";
    assert_eq!(report["facts"]["lengths"], json!(fact));
}

#[test]
fn a_divergence_in_a_log_of_lines_has_a_line_and_no_time() {
    let folder = folder("conform-lines");
    let log = folder.join("walk.jsonl");
    // There and back: the first junction has three doors, and then two.
    let lines = [
        "# a robot that turns around twice",
        "{\"degree\":3,\"door\":1}",
        "{\"degree\":1,\"door\":0}",
        "{\"degree\":2,\"door\":null}",
    ];
    fs::write(&log, lines.join("\n") + "\n").unwrap();
    let page = folder.join("page.html");
    let options = ["--driver", "anyone", "--marker", "none", "--html", page.to_str().unwrap()];
    let (code, report) = judged(&log, &options);
    assert_eq!((code, &report["event"]), (Some(1), &5.into()), "{report}");
    assert_eq!(
        (&report["message"], &report["offset"], &report["offset_unit"]),
        (&3.into(), &4.into(), &"line".into())
    );
    // Nothing is known of the time of lines without stamps.
    assert_eq!(report["time"], json!(null));
    let output = run([&["conform", log.to_str().unwrap()][..], &options[..4]].concat());
    let text = stdout(&output);
    assert!(text.contains("diverges at event 5 of 5: "), "{text}");
    assert!(text.contains("\n  message 3 of the log, at line 4\n"), "{text}");
    let shown = fs::read_to_string(&page).unwrap();
    assert!(shown.contains("Event 5 of 5</a> \u{b7} message 3 of the log, at line 4 "), "no line");
    // With stamps it has a time.
    let stamped = lines.map(|line| line.replace('{', "{\"stamp\":7.5,"));
    fs::write(&log, stamped.join("\n") + "\n").unwrap();
    assert_eq!(judged(&log, &options).1["time"], json!(0.0));
    // An MCAP file has bytes.
    let bytes = walked(&folder, &[(3, -1, Some(1)), (1, -1, Some(0)), (2, -1, None)]);
    let (_, report) = judged(&bytes, &options[..4]);
    assert_eq!((&report["event"], &report["offset_unit"]), (&5.into(), &"byte".into()), "{report}");
}

#[test]
fn the_end_of_a_log_with_a_door_is_a_remark_if_anyone_drove() {
    let folder = folder("conform-last-door");
    let steps = [(3, 0, Some(0)), (1, -1, Some(0))];
    let remark = "the log ends with a door: where it led is not recorded";
    let (_, report) = judged(&walked(&folder, &steps), &ANYONE);
    assert_eq!(report["remarks"], json!([remark]));
    let (_, report) = judged(&walked(&folder, &[(3, 0, Some(0)), (1, -1, None)]), &ANYONE);
    assert_eq!(report["remarks"], json!([]));
}
