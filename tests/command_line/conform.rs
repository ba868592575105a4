//! `toposlam conform`: the verdicts and their facts, with which exit code, and what is written.
//!
//! The sentences are in `tests/snapshots/conform`.

use std::{f64::consts::PI, fs, path::Path, process::Command};

use serde_json::{Value, json};
use toposlam_logs::{
    messages::{self, End, Percept, ProjectMessage, Scene, Stamp},
    recorder::ODOM,
    standard::{OdometryMessage, Twist},
    writer::LogWriter,
};
use toposlam_model::{counts::grouped, driving};

use super::{
    Scratch,
    containers::{rewritten, set_stamp},
    has, objects, read_world, stderr, stdout,
};

const SHAPE_6: &str = "worlds/shape-6.toml";
const SHAPE_8: &str = "worlds/shape-8.toml";
const OF_SHAPE_6: &str = "conform run.mcap --world worlds/shape-6.toml";
const OF_SHAPE_8: &str = "conform run.mcap --world worlds/shape-8.toml";

/// A folder with the log of a run without images, `run.mcap`. Algorithm 1 maps, unless the options choose how.
fn logged(name: &str, world: &str, options: &str) -> Scratch {
    let scratch = Scratch::new(name);
    log(&scratch, world, options);
    scratch
}

fn log(scratch: &Scratch, world: &str, options: &str) {
    let chooses = ["--algorithm", "--recover"].iter().any(|option| options.contains(option));
    let algorithm = if chooses { "" } else { "--algorithm algorithm1" };
    scratch.run(&format!("simulate {world} --by-scene --log run.mcap {algorithm} {options}"));
}

/// What `--json` prints of a log.
fn judged(scratch: &Scratch, line: &str, code: i32) -> Value {
    let lines = scratch.lines(line, code);
    lines.into_iter().find(|line| line["kind"] == "log").unwrap()
}

/// The report on a log that diverges, and that of the command that it gives for a shorter log.
fn shortened(scratch: &Scratch, line: &str) -> [Value; 2] {
    let report = judged(scratch, &format!("{line} --minimise short.mcap"), 1);
    let command = report["command"].as_str().unwrap().strip_prefix("toposlam ").unwrap();
    let again = scratch.last(command, 1);
    for fact in ["cause", "class"] {
        assert_eq!(again[fact], report[fact], "{line}: {fact}");
    }
    [report, again]
}

/// Writes `walk.jsonl`: percepts and doors of a robot without numbers, shapes and odometry.
fn walk(scratch: &Scratch, steps: &[(u32, i32, Option<u32>)]) {
    let line = |&(degree, marker, door): &(u32, i32, Option<u32>)| {
        format!("{}\n", json!({ "degree": degree, "marker": marker, "door": door }))
    };
    scratch.write("walk.jsonl", steps.iter().map(line).collect::<String>());
}

/// The junctions that the robot visited are the same, whether they are recorded or inferred.
#[test]
fn each_visit_is_a_line_if_the_source_of_events_is_chosen() {
    let scratch = logged("conform-visits", SHAPE_6, "--seed 3");
    let visits = |source: &str| {
        let mut lines = scratch.lines(&format!("{OF_SHAPE_6} --events {source}"), 0);
        assert_eq!(lines.pop().unwrap()["kind"], "log");
        let fields = ["kind", "index", "degree", "door", "marker", "turned_back"];
        let chosen = |line: &Value| fields.map(|field| line[field].clone());
        lines.iter().map(chosen).collect::<Vec<_>>()
    };
    let recorded = visits("recorded");
    assert_eq!(recorded, visits("scenes"));
    // 15 events: percepts, and a door after each but the last.
    assert_eq!(recorded.len(), 8);
    assert_eq!(json!(recorded[0]), json!(["event", 0, 2, 0, 0, false]));
    assert_eq!(recorded[7][3], Value::Null);
}

#[test]
fn a_correct_log_conforms_to_its_world_to_some_world_and_by_its_scenes() {
    let scratch = logged("conform-good", SHAPE_6, "--seed 3");
    // The end is the only dead end of shape 6, and one loop is closed.
    for (options, confirmed) in [
        ("--world worlds/shape-6.toml", json!(1)),
        ("--world worlds/shape-6.toml --start any", json!(1)),
        ("--world worlds/shape-6.toml --events scenes", json!(1)),
        ("", json!(1)),
        ("--class corridor", json!(1)),
        ("--driver anyone", json!(0)),
    ] {
        let report = judged(&scratch, &format!("conform run.mcap {options}"), 0);
        let expected = json!({
            "verdict": "conforms", "event": null, "class": null, "candidates": 1, "events": 15,
            "coverage.dead-end": 1, "coverage.confirmed": confirmed, "divergence": null,
        });
        has(&report, &expected, options);
    }
    scratch.facts(&[
        (OF_SHAPE_6, 0, json!({
            "remarks": [], "recorded.same_world": true, "ending.how": "mapped",
            "map": { "complete": true, "vertices": 6, "edges": 6, "unexplored": 0 },
            "doors": { "algorithm": "algorithm1", "choices": "default", "from_event": null },
        })),
        // Another world is a remark of the report.
        (OF_SHAPE_8, 1, json!({
            "remarks.0": "the log was recorded in another world, shape-6", "world.name": "shape-8",
            "recorded.world": "shape-6", "recorded.same_world": false,
        })),
        // The run of shape 6 meets no L to the left.
        ("conform run.mcap --require-coverage confirmed,dead-end", 0, json!({ "not_covered": [] })),
        ("conform run.mcap --require-coverage confirmed,l-left,rejected-on-the-way", 3, json!([
            { "verdict": "conforms" }, { "not_covered": ["l-left", "rejected-on-the-way"] },
        ])),
    ]);
    let required = "--require-coverage confirmed,l-left --junit report.xml";
    scratch.out(&format!("conform run.mcap {required}"), 3);
    let xml = scratch.text("report.xml");
    assert!(xml.contains("message=\"2 required cases: not covered: l-left\""), "{xml}");
}

#[test]
fn an_undirected_marker_is_written_in_lines_as_it_is_seen() {
    let scratch = Scratch::new("conform-undirected");
    let undirected = "--driver anyone --marker undirected";
    // Into a dead end beside the marker, and back past it.
    let walk = |first: &str, last: &str| {
        format!(
            "{{\"degree\":2,\"marker\":{first},\"door\":1}}\n{{\"degree\":1,\"marker\":false,\"door\":0}}\n\
             {{\"degree\":2,\"marker\":{last},\"door\":1}}\n{{\"degree\":3,\"marker\":-1}}\n"
        )
    };
    for (first, last, code) in
        [("0", "0", 0), ("0", "true", 0), ("true", "-1", 1), ("true", "true", 0)]
    {
        scratch.write("events.jsonl", walk(first, last));
        judged(&scratch, &format!("conform events.jsonl {undirected}"), code);
    }
    let recorded = format!("conform events.jsonl --events recorded {undirected}");
    assert_eq!(scratch.lines(&recorded, 0)[0]["marker"], true);
    let message = scratch.error("conform events.jsonl --driver anyone");
    let expected = "its percepts do not record along which door the marker points; for an undirected \
                    marker add --driver anyone --marker undirected\n";
    assert!(message.ends_with(expected), "{message}");
}

#[test]
fn a_log_of_another_world_diverges_and_so_does_a_shorter_log() {
    let scratch = logged("conform-other", SHAPE_6, "--seed 3");
    // After the first move there is a T, and after the second a corner instead of the other T.
    let diverged = format!("{OF_SHAPE_8} --html report.html");
    let [report, again] = shortened(&scratch, &diverged);
    let expected = json!({
        "verdict": "diverged", "event": 5, "class": "perception", "matched": 4, "unique": null,
        "allowed": ["at e, having come from w: 3 doors"], "shorter.#": 3, "shorter_events.#": 3,
        "divergence.found.what": "percept", "divergence.allowed.#": 1,
        "divergence.allowed.0.vertex": "e", "divergence.allowed.0.from": "w",
        "open_doors": null, "never_followed": null,
    });
    has(&report, &expected, &diverged);
    assert_eq!(again["event"], 3);
    assert!(scratch.text("report.html").contains("at e, having come from w"), "no page");
    // The command has the options that decide.
    let [report, again] = shortened(&scratch, &format!("{OF_SHAPE_8} --start se:e"));
    assert!(report["command"].as_str().unwrap().ends_with(" --start se:e"), "{report}");
    assert_eq!(again["event"], report["shorter"].as_array().unwrap().len());
    // A quirk is tolerated and counted, and is not where it diverges.
    let quirk =
        "[[quirk]]\nname = \"rebuilt\"\ncause = \"percept\"\nreason = \"the wall is new\"\n";
    scratch.write("quirks.toml", quirk);
    let tolerated =
        scratch.run(&format!("{OF_SHAPE_8} --driver anyone --quirks quirks.toml --json"));
    let tolerated = objects(&stdout(&tolerated)).remove(0);
    assert!(tolerated["tolerated"]["rebuilt"].as_u64() > Some(0), "{tolerated}");
    let without = judged(&scratch, &format!("{OF_SHAPE_8} --driver anyone"), 1);
    assert_ne!(tolerated["event"], without["event"]);
}

#[test]
fn a_truncated_log_and_a_run_that_was_given_up_are_incomplete() {
    let scratch = logged("conform-cut", SHAPE_6, "--seed 3");
    let bytes = scratch.bytes("run.mcap");
    scratch.write("run.mcap", &bytes[..bytes.len() / 2]);
    let remark = |start: &str| {
        let report = judged(&scratch, &format!("{OF_SHAPE_6} --html page.html"), 3);
        assert_eq!(report["verdict"], "incomplete");
        assert!(report["remarks"][0].as_str().unwrap().starts_with(start), "{report}");
    };
    remark("the log is truncated at byte ");
    // A case that a complete run has is expected.
    let page = scratch.text("page.html");
    assert!(page.contains("<tr class=\"missed\"><th scope=\"row\">confirmed</th>"), "{page}");
    assert!(page.contains("<tr class=\"beyond\"><th scope=\"row\">l-left</th>"));
    log(&scratch, SHAPE_6, "--fault lights-out@20");
    remark("the run was given up: ");
    let [log, endless] = ["run.mcap", "endless.mcap"].map(|name| scratch.path(name));
    rewritten(&log, &endless, |_, message| message.channel.topic != End::TOPIC);
    fs::rename(endless, log).unwrap();
    remark("the log does not record how the run ended");
}

#[test]
fn a_log_is_compared_with_the_algorithm_that_it_names_or_with_another() {
    let scratch = logged("conform-folding", SHAPE_6, "--seed 3 --algorithm folding");
    for options in ["--world worlds/shape-6.toml", "", "--algorithm folding"] {
        let report = judged(&scratch, &format!("conform run.mcap {options}"), 0);
        // It has junctions, and not the cases of Algorithm 1.
        let expected = json!({
            "verdict": "conforms", "map.complete": true,
            "doors": { "algorithm": "folding", "choices": "default", "from_event": null },
            "coverage.dead-end": 1, "coverage.confirmed": null,
        });
        has(&report, &expected, options);
    }
    let text = scratch.out("conform run.mcap --require-coverage confirmed,dead-end", 3);
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let cause = "the folding explorer does not have these cases of Algorithm 1: confirmed";
    assert!(text.contains(cause), "{text}");
    // Algorithm 1 would come to a T from its other side too.
    log(&scratch, SHAPE_8, "--seed 3 --algorithm folding");
    scratch.out(&format!("{OF_SHAPE_8} --html report.html"), 0);
    let page = scratch.text("report.html");
    assert!(page.contains("<tr class=\"beyond\"><th scope=\"row\">t-stem-right</th>"));
    assert!(!page.contains("<tr class=\"missed\">"));
}

#[test]
fn a_log_of_algorithm_1_diverges_from_the_folding_explorer_at_a_door() {
    let scratch = logged("conform-not-folding", "worlds/building-12.toml", "--seed 3");
    scratch.out("conform run.mcap", 0);
    let diverged = "conform run.mcap --algorithm folding";
    let [report, _] = shortened(&scratch, diverged);
    let expected = json!({
        "class": "algorithm", "cause": "door", "divergence.found.what": "door",
        "condition": "the folding explorer does not take this door here",
    });
    has(&report, &expected, diverged);
    let allowed = report["allowed"][0].as_str().unwrap();
    assert!(allowed.starts_with("door ") && allowed.contains("dart"), "{allowed}");
    assert!(report["divergence"]["allowed"][0]["purpose"].is_string(), "{report}");
    assert!(report["command"].as_str().unwrap().ends_with("--algorithm folding"), "{report}");
}

#[test]
fn several_logs_are_reported_together_and_an_unreadable_one_does_not_hide_the_others() {
    let scratch = logged("conform-several", SHAPE_6, "--seed 3");
    scratch.write("other.mcap", scratch.bytes("run.mcap"));
    scratch.write("text.mcap", "not a log");
    let report = scratch.lines("conform run.mcap other.mcap", 0);
    has(&report[2], &json!({ "logs": 2, "conform": 2 }), "conform run.mcap other.mcap");
    let [one, all] =
        [&report[0], &report[2]].map(|report| report["coverage"]["new-vertex"].as_u64());
    assert_eq!(all, one.map(|one| 2 * one));
    let output = scratch.run("conform --json text.mcap run.mcap missing.mcap");
    assert_eq!(output.status.code(), Some(2));
    let message = stderr(&output);
    assert!(message.contains("text.mcap: ") && message.contains("missing.mcap: "), "{message}");
    let report = objects(&stdout(&output));
    has(
        &report.clone().into(),
        &json!([
            { "kind": "unread" },
            { "kind": "log", "verdict": "conforms" },
            { "kind": "unread", "file": "missing.mcap" },
            { "kind": "logs", "logs": 3, "conform": 1, "unreadable": 2 },
        ]),
        "conform",
    );
    assert_ne!(report[2]["cause"], "");
    // So is it in JUnit.
    scratch.out("conform text.mcap run.mcap --junit report.xml", 2);
    let junit = scratch.text("report.xml");
    assert!(junit.contains("tests=\"2\" failures=\"0\" errors=\"1\""), "{junit}");
    assert!(junit.contains("message=\"the log cannot be checked: "), "{junit}");
    // A divergence is worse than an incomplete log, and a log that is not read is worse than both.
    scratch.out(OF_SHAPE_8, 1);
    scratch.out(&format!("{OF_SHAPE_8} text.mcap"), 2);
    // What is not known has its reason.
    walk(&scratch, &[(3, 0, Some(1)), (1, -1, None)]);
    scratch.out("conform walk.jsonl --max-darts 1 --junit report.xml", 3);
    let junit = scratch.text("report.xml");
    assert!(junit.contains("Algorithm 1 was followed up to event 1: "), "{junit}");
}

/// PyPI's `rosbags` makes a ROS 1 bag of a log.
#[test]
fn a_log_converted_to_ros_1_conforms_and_is_replayed() {
    let scratch = logged("conform-ros1", SHAPE_6, "--seed 3");
    let mut convert = Command::new("rosbags-convert");
    let convert = convert.current_dir(&scratch.0).args(["--src", "run.mcap", "--dst", "run.bag"]);
    let Ok(output) = convert.output() else {
        let required = std::env::var("TOPOSLAM_PYTHON_LOGS").is_ok_and(|is| is == "required");
        assert!(!required, "there is no rosbags-convert");
        return eprintln!("skipped: there is no rosbags-convert of PyPI's rosbags");
    };
    assert!(output.status.success(), "{}", stderr(&output));
    scratch.facts(&[
        (
            "conform run.bag --world worlds/shape-6.toml",
            0,
            json!({ "verdict": "conforms", "events": 15 }),
        ),
        ("conform --rerun run.bag", 0, json!({ "map": true, "difference": null })),
    ]);
}

/// Somebody drives a robot along x to an L, and then between its doors. The log has only scenes and
/// odometry.
#[test]
fn the_shorter_log_contains_the_scenes_before_the_robot_strayed() {
    let scratch = Scratch::new("conform-strayed");
    let mut writer = LogWriter::new(Vec::new()).unwrap();
    let mut see = |second: i32, x: f64, heading: f64, doors: &[f64]| {
        let stamp = Stamp { sec: second, nanosec: 0 };
        let time = stamp.nanoseconds();
        let at = driving::odometry::Odometry { position: [x, 0.0], heading };
        let odometry = OdometryMessage::new(stamp, &at, Twist::default());
        writer.write(ODOM, time, &odometry).unwrap();
        let mut scene =
            Scene { stamp, place: "hallway".into(), status: "clear".into(), ..Scene::default() };
        if !doors.is_empty() {
            scene = Scene { stamp, place: "junction".into(), ..Scene::default() };
            (scene.doors, scene.turning_point) = (doors.to_vec(), [-x, 0.0]);
        }
        writer.write(Scene::TOPIC, time, &scene).unwrap();
    };
    let l = [PI, PI / 2.0];
    for second in 0..20 {
        see(second, -12.0 + 0.5 * f64::from(second), 0.0, &[]);
    }
    see(20, -0.5, 0.0, &l);
    see(21, -0.2, 0.0, &l);
    see(22, 0.9, PI / 4.0, &[]);
    scratch.write("run.mcap", writer.finish().unwrap());
    let [report, again] = shortened(&scratch, "conform run.mcap --driver anyone");
    let condition = "the robot drove off 45 degrees from the door";
    let expected = json!({ "class": "motion", "cause": "aside", "condition": condition });
    has(&report, &expected, "run.mcap");
    assert_eq!(again["event"], report["event"]);
    assert!(scratch.bytes("short.mcap").len() < scratch.bytes("run.mcap").len());
}

/// Real bags, recorded by ROS itself: there is nothing in them that could be judged.
#[test]
fn logs_without_evidence_are_an_error() {
    let scratch = Scratch::new("conform-bags");
    let logs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/logs");
    if !logs.is_dir() {
        eprintln!("skipped: there are no bags in {}", logs.display());
        return;
    }
    for (name, cause) in [
        ("example.bag", "2 topics could carry odometry: /turtle1/pose, /turtle2/pose"),
        ("example-unsorted-chunks.bag", "no topics are known for percepts and doors"),
        ("no-messages.bag", "the log is empty: it has no messages"),
    ] {
        let message = scratch.error(&format!("conform {}", logs.join(name).display()));
        assert!(message.contains(cause), "{name}: {message}");
    }
}

/// The log of a robot in building 12, without its world, which has 14 edges.
#[test]
fn a_complete_run_determines_its_world_whatever_its_size() {
    let scratch = logged("conform-unique", "worlds/building-12.toml", "--start north-west:north");
    let facts = |options: &str, code, fields: Value| {
        scratch.facts(&[(&format!("conform run.mcap --driver anyone {options}"), code, fields)]);
    };
    // A complete folded trail needs no search.
    let smallest = json!({ "vertices": 12, "edges": 14, "least": true });
    let whole = json!({ "unique": true, "open_doors": 0, "limits": [], "smallest": smallest });
    facts("--max-steps 1 --map smallest.toml", 0, whole);
    facts("--world smallest.toml", 0, json!({ "unique": true, "smallest": null }));
    let limit = json!({ "option": "--max-edges", "value": 13, "decides": true, "event": null });
    facts("--max-edges 13", 3, json!({ "event": null, "smallest": null, "limits": [limit] }));
    facts("--max-edges 14", 0, json!({ "limits": [] }));
}

#[test]
fn facts_of_short_walks() {
    let scratch = Scratch::new("conform-walks");
    let star = "name = \"star\"\n[clockwise]\nhub = [\"a\", \"b\", \"c\"]\na = [\"hub\"]\n\
                b = [\"hub\"]\nc = [\"hub\"]\n[start]\nat = \"hub\"\nfacing = \"a\"\n";
    scratch.write("star.toml", star);
    let facts = |steps: &[(u32, i32, Option<u32>)], options: &str, code: i32, fields: Value| {
        walk(&scratch, steps);
        scratch.facts(&[(&format!("conform walk.jsonl {options}"), code, fields)]);
    };
    let anyone = |steps: &[(u32, i32, Option<u32>)], options: &str, fields: Value| {
        facts(steps, &format!("--driver anyone {options}"), 0, fields);
    };
    // From the marker at a junction with three doors to a dead end and back. The two doors that are open are the ends
    // of one hallway, in the smallest world; in a class without loops there are two more dead ends.
    let open = [(3, 0, Some(1)), (1, -1, Some(0)), (3, 2, None)];
    let smallest = |vertices, edges| json!({ "vertices": vertices, "edges": edges, "least": true });
    let door = |vertex, door, toward| json!({ "vertex": vertex, "door": door, "toward": toward });
    let doors = [door("v0", 0, Value::Null), door("v0", 2, Value::Null)];
    anyone(&open, "", json!({ "unique": false, "open_doors": 2, "never_followed": doors }));
    anyone(&open, "", json!({ "verdict": "conforms", "smallest": smallest(2, 2) }));
    anyone(&open, "--class simple", json!({ "smallest": smallest(4, 3) }));
    // In a known world the doors have its names.
    let doors = [door("hub", 0, "a".into()), door("hub", 2, "c".into())];
    anyone(&open, "--world star.toml", json!({ "unique": false, "never_followed": doors }));
    // Smaller worlds stay open if the search is limited, which does not decide.
    let six_doors = [(6, 0, None)];
    let limit = json!({ "option": "--max-steps", "value": 1, "decides": false, "event": null });
    let limited = json!({ "smallest.least": false, "limits": [limit], "remarks.#": 1 });
    anyone(&six_doors, "--class simple --max-steps 1", limited);
    anyone(&six_doors, "--class simple", json!({ "smallest.least": true, "limits": [] }));
    // What was not searched does not matter to a log that diverges.
    let wrong = [(3, 0, Some(1)), (3, 1, Some(0)), (4, -1, None)];
    facts(&wrong, "--max-darts 1", 1, json!({ "remarks": [] }));
    let remark = "the log ends with a door: where it led is not recorded";
    anyone(&[(3, 0, Some(0)), (1, -1, Some(0))], "", json!({ "remarks": [remark] }));
    // The default choice is door 0. Algorithm 1 would go on.
    let other_choice = [(3, 0, Some(2)), (1, -1, None)];
    let doors = json!({ "algorithm": "algorithm1", "choices": "other", "from_event": 2 });
    facts(&other_choice, "", 0, json!({ "doors": doors, "remarks.#": 1 }));
    anyone(&other_choice, "", json!({ "remarks": [] }));
    let lengths = json!({ "moves": 2, "measured": 0, "compared": 0 });
    let there_and_back = [(1, -1, Some(0)), (3, 1, Some(0)), (1, -1, None)];
    anyone(&there_and_back, "", json!({ "lengths": lengths }));
    // A robot that should see its marker does not.
    let contradiction = json!({ "event": 1, "cause": "contradiction" });
    facts(&[(1, -1, Some(0)), (1, -1, None)], "--marker directional", 1, contradiction);
    // Without --marker it may be one that has none.
    let message = scratch.error("conform walk.jsonl");
    assert!(message.contains("--driver anyone --marker none"), "{message}");
    // From a dead end to a junction with three doors, where the marker lies along door 1. The robot did not come by
    // its dart.
    walk(&scratch, &[(1, -1, Some(0)), (3, 1, None)]);
    scratch.out("conform walk.jsonl --driver anyone --map map.toml", 0);
    let world = read_world(&scratch.path("map.toml"));
    let facing = world.start.unwrap();
    assert_eq!(world.graph.degree(world.graph.vertex(facing)), 3);
    assert_ne!(world.graph.degree(world.graph.vertex(world.graph.opposite(facing))), 1);
}

#[test]
fn a_shorter_log_of_an_impossible_walk_diverges_for_the_same_reason() {
    let scratch = Scratch::new("conform-impossible");
    let shortened_walk = |steps: &[(u32, i32, Option<u32>)], options: &str| {
        walk(&scratch, steps);
        shortened(&scratch, &format!("conform walk.jsonl --driver anyone {options}"))
    };
    // A robot without a marker sees none, and the head of a shorter log says so.
    let [report, _] = shortened_walk(&[(3, 0, Some(1)), (1, -1, None)], "--marker none");
    assert_eq!(report["event"], 1, "{report}");
    // A hallway that leads back to its own junction is impossible in some classes only.
    let [report, again] = shortened_walk(&[(3, 0, Some(1)), (3, 1, None)], "--class simple");
    assert_eq!(report["cause"], "no-world", "{report}");
    assert_eq!(again["condition"], report["condition"]);
    scratch.out("conform walk.jsonl --driver anyone", 0);
    // There and back again, twice. In the end the first junction has another degree.
    let there = (3, -1, Some(0));
    let walk = [(3, 0, Some(1)), there, (3, 2, Some(0)), there, (2, -1, None)];
    let [report, again] = shortened_walk(&walk, "");
    has(&report, &json!({ "cause": "no-world", "event": 9, "class": "perception" }), "walk");
    let events = report["shorter"].as_array().unwrap().len();
    assert!((3..9).contains(&events), "{report}");
    assert_eq!(again["event"], events);
    let why = again["condition"].as_str().unwrap();
    assert!(why.ends_with("are the same one, with 3 doors and with 2"), "{why}");
}

#[test]
fn the_marker_is_asked_for_if_it_is_not_recorded() {
    let scratch = logged("conform-marker", SHAPE_6, "--seed 3");
    let topics = "[percept]\ntopic = \"/toposlam/percept\"\ndegree = \"degree\"\n\
                  [door]\ntopic = \"/toposlam/door\"\ndoor = \"door\"\n";
    scratch.write("mapping.toml", topics);
    let mapped = "conform run.mcap --topics mapping.toml";
    // Nothing is mapped as the marker: that is not a marker that was not seen.
    let message = scratch.error(mapped);
    assert!(message.contains("--driver anyone --marker none"), "{message}");
    let known = "--world worlds/shape-6.toml --start any";
    for options in ["", known] {
        scratch.out(&format!("{mapped} --driver anyone --marker none {options}"), 0);
    }
}

#[test]
fn the_page_shows_version_command_date_and_hashes() {
    let scratch = logged("conform-origin", SHAPE_6, "--seed 3");
    let write = || {
        scratch.out(&format!("{OF_SHAPE_6} --html page.html"), 0);
        scratch.text("page.html")
    };
    let page = write();
    assert!(page.contains(&format!("<code>toposlam {OF_SHAPE_6} --html page.html</code>")));
    let version = scratch.out("--version", 0);
    assert!(page.contains(&format!("Made by {} with", version.trim_end())));
    let begun =
        "<th scope=\"row\">first message</th><td>no date: 0.000 s on the clock of the log</td>";
    assert!(page.contains(begun));
    for file in ["run.mcap", SHAPE_6] {
        let output = Command::new("sha256sum").arg(scratch.path(file)).output().unwrap();
        let hash = stdout(&output).split(' ').next().unwrap().to_owned();
        assert!(page.contains(&format!("<code class=\"hash\">{hash}</code>")), "{file}");
    }
    assert_eq!(write(), page, "the same log, the same bytes");
    // A complete run has no case that was expected and not reached: the others are grey.
    assert!(page.contains("<tr class=\"beyond\"><th scope=\"row\">l-left</th>"));
    assert!(!page.contains("<tr class=\"missed\">"));
}

#[test]
fn a_robot_that_was_carried_was_moved_between_two_events() {
    let scratch = Scratch::new("conform-moved");
    let mut shorter = 0;
    for (seed, image) in [(0, 40), (1, 40), (2, 60)] {
        log(&scratch, SHAPE_6, &format!("--seed {seed} --fault carried@{image}"));
        let report = judged(&scratch, "conform run.mcap --driver anyone", 1);
        // Percepts may show it first.
        if report["cause"] != "moved" {
            continue;
        }
        assert_eq!(report["class"], "motion");
        // The shorter log ends with the event that diverges.
        let [report, again] = shortened(&scratch, "conform run.mcap --driver anyone");
        let events = report["shorter"].as_array().unwrap().len();
        has(&again, &json!({ "event": events, "events": events }), "short.mcap");
        let measured = |report: &Value| {
            let condition = report["condition"].as_str().unwrap();
            let (begin, what) = condition.split_once(": ").unwrap();
            assert!(begin.starts_with("moved by hand or slipped between events "), "{condition}");
            // The way of a closed walk is shorter; how far from its beginning it ends is not.
            what.split_once(" ends ").map_or(what, |(_, off)| off).to_owned()
        };
        assert_eq!(measured(&again), measured(&report));
        shorter += usize::from(events < report["event"].as_u64().unwrap() as usize);
        if seed == 0 {
            has(&report["lengths"], &json!({ "moves": 15, "measured": 15 }), "lengths");
        }
    }
    assert!(shorter > 0);
}

#[test]
fn a_divergence_in_a_log_of_lines_has_a_line_and_no_time() {
    let scratch = Scratch::new("conform-lines");
    // There and back: the first junction has three doors, and then two.
    let lines = "# a robot that turns around twice\n{\"degree\":3,\"door\":1}\n\
                 {\"degree\":1,\"door\":0}\n{\"degree\":2,\"door\":null}\n";
    scratch.write("walk.jsonl", lines);
    // With stamps it has a time.
    scratch.write("stamped.jsonl", lines.replace('{', "{\"stamp\":7.5,"));
    let anyone = "--driver anyone --marker none";
    let place =
        json!({ "event": 5, "message": 3, "offset": 4, "offset_unit": "line", "time": null });
    scratch.facts(&[
        (&format!("conform walk.jsonl {anyone} --html page.html"), 1, place),
        (&format!("conform stamped.jsonl {anyone}"), 1, json!({ "time": 0.0 })),
    ]);
    let page = scratch.text("page.html");
    assert!(page.contains("Event 5 of 5</a> \u{b7} message 3 of the log, at line 4 "), "no line");
}

#[test]
fn a_scene_or_odometry_with_a_wrong_stamp_is_skipped_and_counted() {
    let scratch = logged("conform-stamps", SHAPE_6, "--seed 3");
    let before = judged(&scratch, &format!("{OF_SHAPE_6} --events scenes"), 0);
    let none = json!({"off_clock": 0, "scans_without_odometry": 0});
    assert_eq!(before["skipped_messages"], none);
    // The stamps of these messages, by their numbers on a topic, are far from all others.
    let far = 2_000_000_000;
    let change = |topic: &str, is_far: &dyn Fn(usize) -> bool| {
        let mut numbers = 0..;
        let [log, changed] = ["run.mcap", "changed.mcap"].map(|name| scratch.path(name));
        rewritten(&log, &changed, |_, message| {
            if message.channel.topic == topic && numbers.next().is_some_and(is_far) {
                set_stamp(message, far);
            }
            true
        });
    };
    let of_changed = "conform changed.mcap --world worlds/shape-6.toml --events scenes";
    for topic in [ODOM, Scene::TOPIC] {
        // In the middle of a stretch of hallway, and at a junction.
        change(topic, &|number| [30, 50].contains(&number));
        let after = judged(&scratch, of_changed, 0);
        let skipped = json!({"off_clock": 2, "scans_without_odometry": 0});
        let remark = "skipped messages: 2 whose time is far from that of all others";
        has(&after, &json!({ "skipped_messages": skipped, "remarks.0": remark }), topic);
        for fact in ["verdict", "events", "candidates", "unique"] {
            assert_eq!(after[fact], before[fact], "{topic}: {fact}");
        }
    }
    // What cannot be skipped is an error: the time of a scene decides where the robot was.
    change(Scene::TOPIC, &|number| number >= 60);
    let message = scratch.error(of_changed);
    let cause = "its time, 2000000000.000 s, is more than an hour from that of all odometry";
    assert!(message.contains(cause), "{message}");
    // An event has its place in the order; without it the others mean something else.
    change(Percept::TOPIC, &|number| number == 2);
    let message = scratch.error("conform changed.mcap");
    assert!(message.contains("the one before it at 2000000000.000 s"), "{message}");
}

/// The number of a row is that of the table, not that of the message in the order of time.
#[cfg(feature = "sqlite")]
#[test]
fn a_divergence_in_a_database_names_its_row() {
    let scratch = logged("conform-row", SHAPE_6, "--seed 3");
    let database = scratch.path("run.db3");
    rewritten(&scratch.path("run.mcap"), &database, |_, _| true);
    let of_file = judged(&scratch, &format!("{OF_SHAPE_8} --start any"), 1);
    let other = "conform run.db3 --world worlds/shape-8.toml --start any";
    let line = judged(&scratch, other, 1);
    for fact in ["event", "cause", "class", "message", "condition"] {
        assert_eq!(line[fact], of_file[fact], "{fact}");
    }
    assert_eq!((&of_file["offset_unit"], &line["offset_unit"]), (&"byte".into(), &"row".into()));
    // The first row is 101.
    let row = line["offset"].as_i64().unwrap();
    assert_eq!(row, line["message"].as_i64().unwrap() + 100);
    let topic = rusqlite::Connection::open(&database).unwrap().query_row(
        "SELECT name FROM messages JOIN topics ON topics.id = topic_id WHERE messages.id = ?1",
        [row],
        |found| found.get::<_, String>(0),
    );
    let is_percept = line["event"].as_u64().unwrap() % 2 == 1;
    assert_eq!(topic.unwrap(), if is_percept { Percept::TOPIC } else { messages::Door::TOPIC });
    let text = scratch.out(&format!("{other} --html page.html"), 1);
    let place = format!(", at row {}", grouped(u64::try_from(row).unwrap().into()));
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains(&place), "{text}");
    assert!(scratch.text("page.html").contains(&place));
}

/// One log is checked, and the next one is being read.
#[cfg(unix)]
#[test]
fn an_interrupted_check_leaves_the_page_as_it_was() {
    let scratch = logged("conform-interrupted", SHAPE_6, "--seed 3");
    for earlier in [None, Some("the page of an earlier check")] {
        if let Some(text) = earlier {
            scratch.write("page.html", text);
        }
        let paths = ["run.mcap", "page.html"].map(|name| scratch.path(name).display().to_string());
        let output = super::interrupted(&format!("conform {} - --html {}", paths[0], paths[1]));
        assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
        assert_eq!(stderr(&output), "interrupted\n");
        let files: &[_] =
            if earlier.is_some() { &["page.html", "run.mcap"] } else { &["run.mcap"] };
        assert_eq!(scratch.written(), files);
        assert!(earlier.is_none_or(|earlier| scratch.text("page.html") == earlier));
    }
}
