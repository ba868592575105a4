//! `toposlam conform`: what is stdout_of of a log, with which exit code, and what is written.

use std::{
    cell::Cell,
    f64::consts::PI,
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use serde_json::{Value, json};
use toposlam_logs::{
    messages::{Door, Percept, ProjectMessage, Scene, Stamp},
    recorder::ODOM,
    standard::{OdometryMessage, Twist},
    writer::LogWriter,
};
use toposlam_model::{counts::grouped, driving};

use super::{
    containers::{rewritten, set_stamp, stamp},
    folder, objects, run, stderr, stdout, stdout_of,
};

const SHAPE_6: &str = "worlds/shape-6.toml";
const SHAPE_8: &str = "worlds/shape-8.toml";

/// The log of a run without images. Algorithm 1 maps, unless the arguments choose how.
pub(super) fn logged(folder: &Path, world: &str, arguments: &[&str]) -> PathBuf {
    let log = folder.join("run.mcap");
    let simulate = ["simulate", world, "--by-scene", "--json", "--log", log.to_str().unwrap()];
    let chooses = arguments.iter().any(|word| ["--algorithm", "--recover"].contains(word));
    let algorithm: &[&str] = if chooses { &[] } else { &["--algorithm", "algorithm1"] };
    run([&simulate[..], algorithm, arguments].concat());
    log
}

/// The log of a run in shape 6, and the file of its page.
fn log_and_page(name: &str) -> [PathBuf; 2] {
    let folder = folder(name);
    [logged(&folder, SHAPE_6, &["--seed", "3"]), folder.join("report.html")]
}

/// The exit code and what `--json` says.
pub(super) fn judged(log: &Path, arguments: &[&str]) -> (Option<i32>, Value) {
    let conform = ["conform", log.to_str().unwrap(), "--json"];
    let output = run([&conform[..], arguments].concat());
    let code = output.status.code();
    assert!(code != Some(2), "{}", stderr(&output));
    let lines = objects(&stdout(&output));
    (code, lines.into_iter().find(|line| line["kind"] == "log").unwrap())
}

/// The junctions that the robot visited are the same, whether they are recorded or inferred.
#[test]
fn each_visit_is_a_line_if_the_source_of_events_is_chosen() {
    let log = logged(&folder("conform-visits"), SHAPE_6, &["--seed", "3"]);
    let visits = |source: &str| {
        let log = log.to_str().unwrap();
        let output = run(["conform", log, "--json", "--world", SHAPE_6, "--events", source]);
        let mut lines = objects(&stdout(&output));
        assert_eq!(lines.pop().unwrap()["kind"], "log");
        let fields = ["kind", "index", "degree", "door", "marker", "turned_back"];
        let chosen = |line: &Value| fields.map(|field| line[field].clone());
        lines.iter().map(chosen).collect::<Vec<_>>()
    };
    let recorded = visits("recorded");
    assert_eq!(recorded, visits("scenes"));
    // 15 events: percepts, and a door after each but the last.
    assert_eq!(recorded.len(), 8);
    assert_eq!(
        recorded[0][..],
        serde_json::json!(["event", 0, 2, 0, 0, false]).as_array().unwrap()[..]
    );
    assert_eq!(recorded[7][3], Value::Null);
}

#[test]
fn a_correct_log_conforms_to_its_world_to_some_world_and_by_its_scenes() {
    let log = logged(&folder("conform-good"), SHAPE_6, &["--seed", "3"]);
    for arguments in [
        &["--world", SHAPE_6][..],
        &["--world", SHAPE_6, "--start", "any"],
        &["--world", SHAPE_6, "--events", "scenes"],
        &[],
        &["--class", "corridor"],
        &["--driver", "anyone"],
    ] {
        let (code, report) = judged(&log, arguments);
        assert_eq!(
            (code, &report["verdict"]),
            (Some(0), &"conforms".into()),
            "{arguments:?} {report}"
        );
        assert_eq!((&report["event"], &report["class"]), (&Value::Null, &Value::Null));
        assert_eq!((&report["candidates"], &report["events"]), (&1.into(), &15.into()), "{report}");
        // The end is the only dead end of shape 6, and one loop is closed.
        assert_eq!(report["coverage"]["dead-end"], 1);
        if !arguments.contains(&"anyone") {
            assert_eq!(report["coverage"]["confirmed"], 1);
        }
    }
    let text = stdout_of(["conform", log.to_str().unwrap(), "--world", SHAPE_6]);
    assert!(text.contains("run.mcap: conforms\n"), "{text}");
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("the robot is at end, having come from corner"), "{text}");
}

#[test]
fn a_log_of_another_world_diverges_and_so_does_a_shorter_log() {
    let folder = folder("conform-other");
    let log = logged(&folder, SHAPE_6, &["--seed", "3"]);
    let short = folder.join("short.mcap");
    let page = folder.join("report.html");
    let written = ["--minimise", short.to_str().unwrap(), "--html", page.to_str().unwrap()];
    let (code, report) = judged(&log, &[&["--world", SHAPE_8][..], &written].concat());
    assert_eq!((code, &report["verdict"]), (Some(1), &"diverged".into()));
    // After the first move there is a T, and after the second a corner instead of the other T.
    assert_eq!((&report["event"], &report["class"]), (&5.into(), &"perception".into()), "{report}");
    assert_eq!(report["matched"], 4);
    assert_eq!(report["allowed"], serde_json::json!(["at e, having come from w: 3 doors"]));
    assert_eq!(report["shorter"].as_array().unwrap().len(), 3);
    let command = report["command"].as_str().unwrap();
    let words: Vec<_> = command.split(' ').skip(1).chain(["--json"]).collect();
    let output = run(&words);
    assert_eq!(output.status.code(), Some(1), "{command}");
    let again = objects(&stdout(&output)).remove(0);
    assert_eq!((&again["event"], &again["class"]), (&3.into(), &"perception".into()), "{again}");
    let page = fs::read_to_string(page).unwrap();
    assert!(page.contains("diverge") && page.contains("at e, having come from w"), "no page");
}

#[test]
fn a_truncated_log_and_a_run_that_was_given_up_are_incomplete() {
    let folder = folder("conform-cut");
    let log = logged(&folder, SHAPE_6, &["--seed", "3"]);
    let bytes = fs::read(&log).unwrap();
    fs::write(&log, &bytes[..bytes.len() / 2]).unwrap();
    let (code, report) = judged(&log, &["--world", SHAPE_6]);
    assert_eq!((code, &report["verdict"]), (Some(3), &"incomplete".into()), "{report}");
    assert!(report["remarks"][0].as_str().unwrap().starts_with("the log is truncated at byte "));
    let log = logged(&folder, SHAPE_6, &["--fault", "lights-out@20"]);
    let (code, report) = judged(&log, &["--world", SHAPE_6]);
    assert_eq!((code, &report["verdict"]), (Some(3), &"incomplete".into()), "{report}");
    assert!(
        report["remarks"][0].as_str().unwrap().starts_with("the run was given up: "),
        "{report}"
    );
}

#[test]
fn a_robot_that_was_carried_does_not_conform() {
    let folder = folder("conform-carried");
    // A map of shape 8 that is wrong.
    let carried = (0..20).find_map(|seed| {
        let seed = seed.to_string();
        let log = logged(&folder, SHAPE_8, &["--seed", &seed, "--fault", "carried@30"]);
        let (code, report) = judged(&log, &["--world", SHAPE_8]);
        (code == Some(1)).then_some(report)
    });
    let report = carried.unwrap();
    assert!(["perception", "motion"].contains(&report["class"].as_str().unwrap()), "{report}");
}

#[test]
fn a_log_is_compared_with_the_algorithm_that_it_names_or_with_another() {
    let folder = folder("conform-folding");
    let log = logged(&folder, SHAPE_6, &["--seed", "3", "--algorithm", "folding"]);
    for arguments in [&["--world", SHAPE_6][..], &[], &["--algorithm", "folding"]] {
        let (code, report) = judged(&log, arguments);
        assert_eq!((code, &report["verdict"]), (Some(0), &"conforms".into()), "{report}");
        let doors = json!({"algorithm": "folding", "choices": "default", "from_event": null});
        assert_eq!(report["doors"], doors);
        assert_eq!(report["facts"]["doors"], "those of the folding explorer");
        assert_eq!(report["map"]["complete"], true);
        // It has junctions, and not the cases of Algorithm 1.
        assert_eq!(report["coverage"]["dead-end"], 1);
        assert_eq!(report["coverage"].get("confirmed"), None);
    }
    let (code, report) = judged(&log, &["--max-darts", "3"]);
    assert_eq!((code, &report["limits"][0]["option"]), (Some(3), &"--max-darts".into()));
    let path = log.to_str().unwrap();
    let output = run(["conform", path, "--require-coverage", "confirmed,dead-end"]);
    assert_eq!(output.status.code(), Some(3));
    let words = stdout(&output).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        words.contains("the folding explorer does not have these cases of Algorithm 1: confirmed"),
        "{words}"
    );
    // The page shows it too.
    let page = folder.join("report.html");
    judged(&log, &["--html", page.to_str().unwrap()]);
    assert!(fs::read_to_string(page).unwrap().contains("those of the folding explorer"));
}

#[test]
fn a_log_of_algorithm_1_diverges_from_the_folding_explorer_at_a_door() {
    let folder = folder("conform-not-folding");
    let log = logged(&folder, "worlds/building-12.toml", &["--seed", "3"]);
    assert_eq!(judged(&log, &[]).0, Some(0));
    let short = folder.join("short.mcap");
    let arguments = ["--algorithm", "folding", "--minimise", short.to_str().unwrap()];
    let (code, report) = judged(&log, &arguments);
    assert_eq!((code, &report["class"]), (Some(1), &"algorithm".into()), "{report}");
    assert_eq!(report["cause"], "door");
    assert_eq!(report["condition"], "the folding explorer does not take this door here");
    let allowed = report["allowed"][0].as_str().unwrap();
    assert!(allowed.starts_with("door ") && allowed.contains("dart"), "{allowed}");
    let before = report["event"].as_u64().unwrap() - 1;
    let doors = format!("those of the folding explorer; up to event {before}");
    assert_eq!(report["facts"]["doors"], doors);
    let command = report["command"].as_str().unwrap();
    assert!(command.ends_with("--algorithm folding"), "{command}");
    let again = run(command.split(' ').skip(1).collect::<Vec<_>>());
    assert_eq!(again.status.code(), Some(1), "{command}");
}

#[test]
fn several_logs_are_reported_together() {
    let folder = folder("conform-several");
    let good = logged(&folder, SHAPE_6, &["--seed", "3"]);
    let other = folder.join("other.mcap");
    fs::copy(&good, &other).unwrap();
    let paths = [good.to_str().unwrap(), other.to_str().unwrap()];
    let output = run([&["conform", "--json"][..], &paths].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let report = objects(&stdout(&output));
    assert_eq!(
        (report.len(), &report[2]["logs"], &report[2]["conform"]),
        (3, &2.into(), &2.into())
    );
    let [one, all] =
        [&report[0], &report[2]].map(|report| report["coverage"]["new-vertex"].as_u64());
    assert_eq!(all, one.map(|one| 2 * one));
    let text = stdout_of([&["conform"][..], &paths].concat());
    assert!(text.contains("2 logs: 2 conform, 0 diverge, 0 incomplete"), "{text}");
}

#[test]
fn a_quirk_is_tolerated_and_counted() {
    let folder = folder("conform-quirk");
    let log = logged(&folder, SHAPE_6, &["--seed", "3"]);
    let quirks = folder.join("quirks.toml");
    let quirk =
        "[[quirk]]\nname = \"rebuilt\"\ncause = \"percept\"\nreason = \"the wall is new\"\n";
    fs::write(&quirks, quirk).unwrap();
    let arguments =
        ["--world", SHAPE_8, "--driver", "anyone", "--quirks", quirks.to_str().unwrap()];
    let (_, report) = judged(&log, &arguments);
    assert!(report["tolerated"]["rebuilt"].as_u64().unwrap() > 0, "{report}");
    // What is tolerated is not where it diverges.
    let (_, without) = judged(&log, &arguments[..4]);
    assert_ne!(report["event"], without["event"]);
}

#[test]
fn bad_input_is_one_message_and_exit_code_2() {
    let folder = folder("conform-bad");
    let log = logged(&folder, SHAPE_6, &["--seed", "3"]);
    let log = log.to_str().unwrap();
    let text = folder.join("text.mcap");
    fs::write(&text, "not a log").unwrap();
    let quirks = folder.join("quirks.toml");
    fs::write(&quirks, "[[quirk]]\nname = \"x\"\ncause = \"door\"\nreason = \"y\"\n").unwrap();
    let mapping = folder.join("mapping.toml");
    fs::write(&mapping, "[percept]\ntopic = \"/nowhere\"\n").unwrap();
    let misspelt = folder.join("misspelt.toml");
    fs::write(&misspelt, "[[quirk]]\nname = \"x\"\ncuase = \"percept\"\nreason = \"y\"\n").unwrap();
    let files = [&text, &quirks, &mapping, &misspelt];
    let [text, quirks, mapping, misspelt] = files.map(|path| path.to_str().unwrap());
    for (arguments, cause) in [
        (&["missing.mcap"][..], "missing.mcap: "),
        (&[text], "text.mcap: "),
        (&[log, "--quirks", quirks], "cannot be tolerated"),
        (&[log, "--quirks", misspelt], "misspelt.toml: line 3, column 1: quirk[0].cuase: unknown"),
        (&[log, "--topics", mapping], "/nowhere"),
        (&[log, "--world", "missing.toml"], "missing.toml: cannot be read"),
        (&[log, "--world", SHAPE_6, "--start", "nowhere:here"], "--start: "),
        (&[log, "--minimise", "x.bag"], "x.bag"),
        (&[log, "--events", "pictures"], "--events: the log does not have"),
        (&[log, "--max-edges", "0"], "a world has at least one edge"),
        (&[log, "--edges", "30"], "--edges"),
        (&[log, "--map", "x.toml", "--world", SHAPE_6], "--map"),
        (&[log, "--minimise", log], "this output would replace the input"),
        (&[log, text, "--map", "x.toml"], "--map: this needs exactly one log"),
        (&[log, text, "--minimise", "x.mcap"], "--minimise: this needs exactly one log"),
        (&[log, "--marker", "movable"], "--marker"),
        (&[log, "--driver", "anyone", "--algorithm", "folding"], "--algorithm: with --driver"),
        (&[log, "--algorithm", "other"], "--algorithm"),
    ] {
        let output = run([&["conform"][..], arguments].concat());
        let stdout_of = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{arguments:?} {stdout_of}");
        assert!(
            stdout_of.starts_with("error: ") && stdout_of.contains(cause),
            "{arguments:?} {stdout_of}"
        );
        assert!(output.stdout.is_empty());
    }
}

#[test]
fn events_out_of_order_are_an_error() {
    let log = folder("conform-order").join("run.mcap");
    let mut writer = LogWriter::new(Vec::new()).unwrap();
    let at = |second| Stamp { sec: second, nanosec: 0 };
    let form = [true, false, false, false];
    let percept = Percept { stamp: at(2), degree: 1, marker: 0, form, ..Percept::default() };
    writer.write(Percept::TOPIC, 2, &percept).unwrap();
    let door = Door { stamp: at(1), r#move: 1, door: 0 };
    writer.write(Door::TOPIC, 3, &door).unwrap();
    fs::write(&log, writer.finish().unwrap()).unwrap();
    let output = run(["conform", log.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    let stdout_of = stderr(&output);
    assert!(
        stdout_of.contains("message 2: the events are out of order: this one is at 1.000 s"),
        "{stdout_of}"
    );
}

/// PyPI's `rosbags` makes a ROS 1 bag of a log.
#[test]
fn a_log_converted_to_ros_1_conforms_and_is_replayed() {
    let folder = folder("conform-ros1");
    let log = logged(&folder, SHAPE_6, &["--seed", "3"]);
    let bag = folder.join("run.bag");
    let mut convert = Command::new("rosbags-convert");
    let Ok(output) = convert.arg("--src").arg(&log).arg("--dst").arg(&bag).output() else {
        let required = std::env::var("TOPOSLAM_PYTHON_LOGS").is_ok_and(|is| is == "required");
        assert!(!required, "there is no rosbags-convert");
        return eprintln!("skipped: there is no rosbags-convert of PyPI's rosbags");
    };
    assert!(output.status.success(), "{}", stderr(&output));
    let (code, report) = judged(&bag, &["--world", SHAPE_6]);
    assert_eq!(
        (code, &report["verdict"], &report["events"]),
        (Some(0), &"conforms".into(), &15.into())
    );
    let replayed =
        objects(&stdout_of(["conform", "--rerun", bag.to_str().unwrap(), "--json"])).remove(0);
    assert_eq!((&replayed["map"], &replayed["difference"]), (&true.into(), &Value::Null));
}

/// Somebody drives a robot along x to an L, and then between its doors. The log has only scenes and
/// odometry.
#[test]
fn the_shorter_log_contains_the_scenes_before_the_robot_strayed() {
    let folder = folder("conform-strayed");
    let log = folder.join("run.mcap");
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
    fs::write(&log, writer.finish().unwrap()).unwrap();
    let short = folder.join("short.mcap");
    let arguments = ["--driver", "anyone", "--minimise", short.to_str().unwrap()];
    let (code, report) = judged(&log, &arguments);
    assert_eq!(
        (code, &report["class"], &report["cause"]),
        (Some(1), &"motion".into(), &"aside".into())
    );
    assert_eq!(report["condition"], "the robot drove off 45 degrees from the door");
    let words: Vec<_> = report["command"].as_str().unwrap().split(' ').skip(1).collect();
    let output = run([&words[..], &["--json"]].concat());
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let again = objects(&stdout(&output)).remove(0);
    assert_eq!((&again["cause"], &again["event"]), (&report["cause"], &report["event"]));
    assert!(fs::metadata(&short).unwrap().len() < fs::metadata(&log).unwrap().len());
}

/// Real bags, recorded by ROS itself: there is nothing in them that could be judged.
#[test]
fn logs_without_evidence_are_an_error() {
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
        let output = run(["conform", logs.join(name).to_str().unwrap()]);
        assert_eq!(output.status.code(), Some(2), "{name}");
        assert!(stderr(&output).contains(cause), "{name}: {}", stderr(&output));
    }
}

/// The log of a robot in building 12, without its world, which has 14 edges.
#[test]
fn a_complete_run_determines_its_world_whatever_its_size() {
    let folder = folder("conform-unique");
    let log = logged(&folder, "worlds/building-12.toml", &["--start", "north-west:north"]);
    let map = folder.join("smallest.toml");
    let map = map.to_str().unwrap();
    // A complete folded trail needs no search.
    let search = ["--driver", "anyone", "--max-steps", "1", "--map", map];
    let (code, report) = judged(&log, &search);
    assert_eq!((code, &report["verdict"]), (Some(0), &"conforms".into()), "{report}");
    assert_eq!((&report["unique"], &report["open_doors"]), (&true.into(), &0.into()));
    assert_eq!(report["smallest"], json!({ "vertices": 12, "edges": 14, "least": true }));
    assert_eq!((&report["limits"], &report["never_followed"]), (&json!([]), &json!([])));
    assert_eq!(report["facts"]["unique"], "This log determines its world.");
    let (code, report) = judged(&log, &["--driver", "anyone", "--world", map]);
    assert_eq!((code, &report["verdict"]), (Some(0), &"conforms".into()), "{report}");
    assert_eq!((&report["unique"], &report["smallest"]), (&true.into(), &Value::Null));
    // A limit is not a divergence.
    let (code, report) = judged(&log, &["--driver", "anyone", "--max-edges", "13"]);
    assert_eq!((code, &report["verdict"]), (Some(3), &"incomplete".into()), "{report}");
    assert_eq!((&report["event"], &report["smallest"]), (&Value::Null, &Value::Null));
    let edges = json!([{ "option": "--max-edges", "value": 13, "decides": true, "event": null }]);
    assert_eq!(report["limits"], edges);
    let remark = report["remarks"][0].as_str().unwrap();
    assert!(remark.contains("at most 13 edges (--max-edges)"), "{remark}");
    let (code, report) = judged(&log, &["--driver", "anyone", "--max-edges", "14"]);
    assert_eq!((code, &report["limits"]), (Some(0), &json!([])), "{report}");
    // Few edge ends.
    let (code, report) = judged(&log, &["--max-darts", "1"]);
    assert_eq!((code, &report["verdict"]), (Some(3), &"incomplete".into()), "{report}");
    let darts = json!([{ "option": "--max-darts", "value": 1, "decides": true, "event": 1 }]);
    assert_eq!(report["limits"], darts);
    // A log that diverges determines nothing.
    let (code, report) = judged(&log, &["--world", SHAPE_8]);
    assert_eq!((code, &report["unique"]), (Some(1), &Value::Null), "{report}");
    assert_eq!((&report["open_doors"], &report["never_followed"]), (&Value::Null, &Value::Null));
}

/// A robot goes from the marker at a junction with three doors to a dead end and back.
#[test]
fn doors_that_were_never_followed_are_listed() {
    let folder = folder("conform-open");
    let log = walked(&folder, &[(3, 0, Some(1)), (1, -1, Some(0)), (3, 2, None)]);
    let page = folder.join("open.html");
    let arguments = ["--driver", "anyone", "--html", page.to_str().unwrap()];
    let (code, report) = judged(&log, &arguments);
    assert_eq!((code, &report["verdict"]), (Some(0), &"conforms".into()), "{report}");
    assert_eq!((&report["unique"], &report["open_doors"]), (&false.into(), &2.into()));
    // The two doors are the ends of one hallway, in the smallest world.
    assert_eq!(report["smallest"], json!({ "vertices": 2, "edges": 2, "least": true }));
    let door = |door| json!({ "vertex": "v0", "door": door, "toward": null });
    assert_eq!(report["never_followed"], json!([door(0), door(2)]));
    let words =
        "This log does not determine its world: 2 doors were never followed: v0 door 0, v0 door 2.";
    assert_eq!(report["facts"]["unique"], words);
    let written = fs::read_to_string(page).unwrap();
    assert!(written.contains(&format!("<p>{words}</p>")));
    assert!(written.contains("What the log proves about its world"));
    // In a class without loops there are two more dead ends.
    let (_, report) = judged(&log, &["--driver", "anyone", "--class", "simple"]);
    assert_eq!(report["smallest"], json!({ "vertices": 4, "edges": 3, "least": true }));
    let output = run(["conform", log.to_str().unwrap(), "--driver", "anyone", "--max-steps", "1"]);
    let text = stdout(&output);
    assert!(text.contains("  unique     This log does not determine its world: 2 doors"), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    // In a known world the doors have its names.
    let world = folder.join("world.toml");
    let star = "name = \"star\"\n[clockwise]\nhub = [\"a\", \"b\", \"c\"]\na = [\"hub\"]\n\
                b = [\"hub\"]\nc = [\"hub\"]\n[start]\nat = \"hub\"\nfacing = \"a\"\n";
    fs::write(&world, star).unwrap();
    let known = ["--driver", "anyone", "--world", world.to_str().unwrap()];
    let (code, report) = judged(&log, &known);
    assert_eq!((code, &report["unique"]), (Some(0), &false.into()), "{report}");
    let words = report["facts"]["unique"].as_str().unwrap();
    assert!(words.ends_with("2 doors were never followed: hub toward a, hub toward c."), "{words}");
}

/// Percepts and doors of a robot without numbers, shapes and odometry.
pub(super) fn walked(folder: &Path, steps: &[(u32, i32, Option<u32>)]) -> PathBuf {
    let log = folder.join("walk.mcap");
    let mut writer = LogWriter::new(Vec::new()).unwrap();
    for (moves, &(degree, marker, door)) in steps.iter().enumerate() {
        let time = 2 * moves as u64;
        let stamp = |second| Stamp { sec: second as i32, nanosec: 0 };
        let number = moves as u32;
        let percept = Percept {
            stamp: stamp(time),
            r#move: number,
            degree,
            marker,
            form: [false; 4],
            entry: f64::NAN,
        };
        writer.write(Percept::TOPIC, time, &percept).unwrap();
        if let Some(door) = door {
            let message = Door { stamp: stamp(time + 1), r#move: number + 1, door };
            writer.write(Door::TOPIC, time + 1, &message).unwrap();
        }
    }
    fs::write(&log, writer.finish().unwrap()).unwrap();
    log
}

#[test]
fn a_shorter_log_of_an_impossible_walk_diverges_for_the_same_reason() {
    let folder = folder("conform-impossible");
    // There and back again, twice. In the end the first junction has another degree.
    let there = (3, -1, Some(0));
    let log = walked(&folder, &[(3, 0, Some(1)), there, (3, 2, Some(0)), there, (2, -1, None)]);
    let short = folder.join("short.mcap");
    let arguments = ["--driver", "anyone", "--minimise"];
    let (code, report) = judged(&log, &[&arguments[..], &[short.to_str().unwrap()]].concat());
    assert_eq!((code, &report["cause"]), (Some(1), &"no-world".into()), "{report}");
    assert_eq!((&report["event"], &report["class"]), (&9.into(), &"perception".into()));
    let condition = report["condition"].as_str().unwrap();
    assert!(condition.starts_with("no world of any size explains"), "{condition}");
    let events = report["shorter"].as_array().unwrap().len();
    assert!((3..9).contains(&events), "{report}");
    let words: Vec<_> = report["command"].as_str().unwrap().split(' ').skip(1).collect();
    let output = run([&words[..], &["--json"]].concat());
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let again = objects(&stdout(&output)).remove(0);
    assert_eq!((&again["cause"], &again["event"]), (&report["cause"], &events.into()), "{again}");
    let why = again["condition"].as_str().unwrap();
    assert!(why.ends_with("are the same one, with 3 doors and with 2"), "{why}");
}

#[test]
fn the_marker_is_asked_for_if_it_is_not_recorded() {
    let folder = folder("conform-marker");
    let log = logged(&folder, SHAPE_6, &["--seed", "3"]);
    let log = log.to_str().unwrap();
    let mapping = folder.join("mapping.toml");
    let topics = "[percept]\ntopic = \"/toposlam/percept\"\ndegree = \"degree\"\n\
                  [door]\ntopic = \"/toposlam/door\"\ndoor = \"door\"\n";
    fs::write(&mapping, topics).unwrap();
    let mapping = ["--topics", mapping.to_str().unwrap()];
    // Nothing is mapped as the marker: that is not a marker that was not seen.
    for arguments in [&[][..], &["--driver", "anyone"], &["--world", SHAPE_6]] {
        let output = run([&["conform", log][..], &mapping, arguments].concat());
        assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
        let message = stderr(&output);
        assert!(message.contains("--driver anyone --marker none"), "{message}");
    }
    let without = ["--driver", "anyone", "--marker", "none"];
    for arguments in [&[][..], &["--world", SHAPE_6, "--start", "any"]] {
        let output = run([&["conform", log][..], &mapping, &without, arguments].concat());
        assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
    }
    // A marker that the log records is one that the robot has.
    let (code, report) = judged(Path::new(log), &without);
    assert_eq!((code, &report["event"]), (Some(1), &1.into()), "{report}");
    assert_eq!((&report["cause"], &report["class"]), (&"no-world".into(), &"perception".into()));
    let output = run(["conform", log, "--marker", "none"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("add --driver anyone"), "{}", stderr(&output));
    // A robot that never sees a marker cannot run Algorithm 1.
    let corridor = walked(&folder, &[(1, -1, Some(0)), (1, -1, None)]);
    let output = run(["conform", corridor.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
    assert!(stderr(&output).contains("--driver anyone --marker none"), "{}", stderr(&output));
}

#[test]
fn another_world_is_a_remark_of_the_report() {
    let [log, page] = log_and_page("conform-remark");
    let output = run([
        "conform",
        log.to_str().unwrap(),
        "--world",
        SHAPE_8,
        "--html",
        page.to_str().unwrap(),
    ]);
    let remark = "the log was recorded in another world, shape-6";
    assert!(stdout(&output).contains(remark), "{}", stdout(&output));
    assert!(!stderr(&output).contains(remark), "{}", stderr(&output));
    assert!(fs::read_to_string(page).unwrap().contains("recorded in another world, shape-6"));
    let (_, report) = judged(&log, &["--world", SHAPE_8]);
    assert_eq!(report["remarks"][0], remark);
    let start = &report["recorded"]["start"];
    let recorded = json!({ "world": "shape-6", "start": start, "same_world": false });
    assert_eq!((&report["recorded"], &report["world"]["name"]), (&recorded, &"shape-8".into()));
    let (_, report) = judged(&log, &["--world", SHAPE_6]);
    assert_eq!(report["recorded"]["same_world"], true);
    let map = json!({ "complete": true, "vertices": 6, "edges": 6, "unexplored": 0 });
    assert_eq!((&report["map"], &report["ending"]["how"]), (&map, &"mapped".into()));
    assert_eq!(
        report["doors"],
        json!({ "algorithm": "algorithm1", "choices": "default", "from_event": null })
    );
    assert_eq!(report["remarks"], serde_json::json!([]));
}

#[test]
fn an_unreadable_log_does_not_hide_the_others() {
    let folder = folder("conform-unreadable");
    let good = logged(&folder, SHAPE_6, &["--seed", "3"]);
    let text = folder.join("text.mcap");
    fs::write(&text, "not a log").unwrap();
    let [good, text] = [&good, &text].map(|path| path.to_str().unwrap());
    let output = run(["conform", "--json", text, good, "missing.mcap"]);
    assert_eq!(output.status.code(), Some(2));
    let message = stderr(&output);
    assert!(message.contains("text.mcap: ") && message.contains("missing.mcap: "), "{message}");
    let report = objects(&stdout(&output));
    let kinds: Vec<_> = report.iter().map(|line| line["kind"].as_str().unwrap()).collect();
    assert_eq!(kinds, ["unread", "log", "unread", "logs"]);
    assert_eq!(report[1]["verdict"], "conforms");
    assert!(report[2]["file"] == "missing.mcap" && report[2]["cause"] != "", "{report:?}");
    assert_eq!(
        (&report[3]["logs"], &report[3]["conform"], &report[3]["unreadable"]),
        (&3.into(), &1.into(), &2.into())
    );
    // So is it on the page.
    let page = folder.join("report.html");
    run(["conform", text, good, "--html", page.to_str().unwrap()]);
    let page = fs::read_to_string(page).unwrap();
    assert!(page.contains("<title>2 logs: 1 conforms, 1 not checked</title>"), "{page}");
    // A divergence is worse than an incomplete log, and a log that is not read is worse than both.
    let other = ["--world", SHAPE_8];
    let code = |logs: &[&str]| run([&["conform"][..], logs, &other].concat()).status.code();
    assert_eq!((code(&[good]), code(&[good, text])), (Some(1), Some(2)));
}

#[test]
fn required_cases_that_are_not_covered_are_listed() {
    let folder = folder("conform-required");
    let log = logged(&folder, SHAPE_6, &["--seed", "3"]);
    let path = log.to_str().unwrap();
    let run = |list| run(["conform", path, "--json", "--require-coverage", list]);
    let output = run("confirmed,dead-end");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(objects(&stdout(&output))[1]["not_covered"], serde_json::json!([]));
    // The run of shape 6 meets no L to the left.
    let output = run("confirmed,l-left,rejected-on-the-way");
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    let report = objects(&stdout(&output));
    assert_eq!(report[0]["verdict"], "conforms");
    assert_eq!(report[1]["not_covered"], serde_json::json!(["l-left", "rejected-on-the-way"]));
    let [page, xml] = ["report.html", "report.xml"].map(|name| folder.join(name));
    let files = ["--html", page.to_str().unwrap(), "--junit", xml.to_str().unwrap()];
    let list = ["conform", path, "--require-coverage", "confirmed,l-left"];
    assert_eq!(super::run([&list[..], &files].concat()).status.code(), Some(3));
    let [page, xml] = [page, xml].map(|file| fs::read_to_string(file).unwrap());
    assert!(page.contains("<p>2 required cases: not covered: l-left.</p>"), "{page}");
    assert!(xml.contains("message=\"2 required cases: not covered: l-left\""), "{xml}");
    let output = run("confirmed,no-such-case");
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("rejected-at-once"), "{}", stderr(&output));
}

#[test]
fn the_page_shows_version_command_date_and_hashes() {
    let [log, page] = log_and_page("conform-origin");
    let [log, page] = [&log, &page].map(|path| path.to_str().unwrap());
    let write = || {
        stdout_of(["conform", log, "--world", SHAPE_6, "--html", page]);
        fs::read_to_string(page).unwrap()
    };
    let written = write();
    let command = format!("toposlam conform {log} --world {SHAPE_6} --html {page}");
    assert!(written.contains(&format!("<code>{command}</code>")));
    let version = stdout_of(["--version"]);
    assert!(written.contains(&format!("Made by {} with", version.trim_end())));
    let begun =
        "<th scope=\"row\">first message</th><td>no date: 0.000 s on the clock of the log</td>";
    assert!(written.contains(begun));
    let hash = |path: &str| {
        let output = Command::new("sha256sum").arg(path).output().unwrap();
        String::from_utf8(output.stdout).unwrap().split(' ').next().unwrap().to_owned()
    };
    for path in [log, SHAPE_6] {
        assert!(written.contains(&format!("<code class=\"hash\">{}</code>", hash(path))), "{path}");
    }
    assert_eq!(write(), written, "the same log, the same bytes");
    // A complete run has no case that was expected and not reached: the others are grey.
    assert!(written.contains("<tr class=\"beyond\"><th scope=\"row\">l-left</th>"));
    assert!(!written.contains("<tr class=\"missed\">"));
}

#[test]
fn a_case_that_a_complete_run_has_is_expected() {
    let [log, page] = log_and_page("conform-expected");
    let cut = log.with_file_name("cut.mcap");
    let bytes = fs::read(&log).unwrap();
    fs::write(&cut, &bytes[..bytes.len() / 2]).unwrap();
    let [cut, page] = [&cut, &page].map(|path| path.to_str().unwrap());
    let output = run(["conform", cut, "--world", SHAPE_6, "--html", page]);
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    let written = fs::read_to_string(page).unwrap();
    assert!(written.contains("<tr class=\"missed\"><th scope=\"row\">confirmed</th>"), "{written}");
    assert!(written.contains("<tr class=\"beyond\"><th scope=\"row\">l-left</th>"));
}

/// An undirected marker is seen with or without a direction. A correct log conforms, whatever its events come from.
#[test]
fn a_correct_log_conforms_with_an_undirected_marker() {
    let folder = folder("conform-undirected");
    let log = logged(&folder, SHAPE_6, &["--seed", "3"]);
    let undirected = ["--driver", "anyone", "--marker", "undirected"];
    for more in [
        &["--world", SHAPE_6][..],
        &["--world", SHAPE_6, "--start", "any"],
        &["--world", SHAPE_6, "--events", "scenes"],
        &["--world", SHAPE_6, "--events", "scenes", "--start", "any"],
        &[],
        &["--events", "scenes"],
    ] {
        let (code, line) = judged(&log, &[&undirected, more].concat());
        assert_eq!((code, &line["verdict"]), (Some(0), &"conforms".into()), "{more:?} {line}");
    }
    // Into a dead end beside the marker, and back past it, with the marker as it is written in lines.
    let walk = |first: &str, last: &str| {
        let lines = folder.join("events.jsonl");
        let text = format!(
            "{{\"degree\":2,\"marker\":{first},\"door\":1}}\n{{\"degree\":1,\"marker\":false,\"door\":0}}\n\
             {{\"degree\":2,\"marker\":{last},\"door\":1}}\n{{\"degree\":3,\"marker\":-1}}\n"
        );
        fs::write(&lines, text).unwrap();
        lines
    };
    for (first, last, code) in
        [("true", "true", 0), ("0", "0", 0), ("0", "true", 0), ("true", "-1", 1)]
    {
        let (found, line) = judged(&walk(first, last), &undirected);
        assert_eq!(found, Some(code), "{first} {last} {line}");
    }
    let lines = walk("true", "true");
    let lines = lines.to_str().unwrap();
    let printed = stdout_of(
        [&["conform", lines, "--json", "--events", "recorded"], &undirected[..]].concat(),
    );
    assert_eq!(objects(&printed)[0]["marker"], true);
    let directional = run(["conform", lines, "--driver", "anyone"]);
    let expected = "its percepts do not record along which door the marker points; for an undirected marker add \
                    --driver anyone --marker undirected\n";
    assert_eq!(directional.status.code(), Some(2));
    assert!(stderr(&directional).ends_with(expected), "{}", stderr(&directional));
    // A shorter log has the sightings, too.
    let wrong = folder.join("wrong.jsonl");
    let text = fs::read_to_string(lines).unwrap().replacen("true", "false", 1);
    fs::write(&wrong, text).unwrap();
    let short = folder.join("short.mcap");
    let (code, line) =
        judged(&wrong, &[&undirected, &["--minimise", short.to_str().unwrap()][..]].concat());
    assert_eq!(code, Some(1), "{line}");
    if short.exists() {
        assert_eq!(judged(&short, &["--driver", "anyone"]).0, Some(1));
    }
}

#[test]
fn an_option_without_effect_on_a_log_is_an_error() {
    let log = logged(&folder("conform-no-effect"), SHAPE_6, &["--seed", "3"]);
    let conform = ["conform", log.to_str().unwrap(), "--driver", "anyone"];
    for (options, place) in [
        (&["--max-darts", "1"][..], "--max-darts: "),
        (&["--require-coverage", "t-by-stem,confirmed"], "--require-coverage: "),
    ] {
        let output = run([&conform[..], options].concat());
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(place), "{}", stderr(&output));
    }
}

#[test]
fn a_divergence_is_fields_too() {
    let log = logged(&folder("conform-fields"), SHAPE_6, &["--seed", "3"]);
    let (code, line) = judged(&log, &["--world", SHAPE_8, "--start", "any"]);
    assert_eq!(code, Some(1));
    let Value::Object(divergence) = &line["divergence"] else { panic!("{line}") };
    let event = line["event"].as_u64().unwrap();
    let what = if event % 2 == 1 { "percept" } else { "door" };
    assert_eq!(divergence["found"]["what"], what, "{line}");
    let allowed = divergence["allowed"].as_array().unwrap();
    assert_eq!(allowed.len(), line["allowed"].as_array().unwrap().len().min(8), "{line}");
    assert!(allowed.iter().all(|one| one["vertex"].is_string() || one["purpose"].is_string()));
    let short = line["shorter_events"].as_array().unwrap();
    assert_eq!(short.len(), line["shorter"].as_array().unwrap().len(), "{line}");
    let (_, good) = judged(&log, &["--world", SHAPE_6]);
    assert_eq!(good["divergence"], Value::Null);
}

#[test]
fn a_scene_or_odometry_with_a_wrong_stamp_is_skipped_and_counted() {
    let folder = folder("conform-stamps");
    let log = logged(&folder, SHAPE_6, &["--seed", "3"]);
    let options = ["--events", "scenes", "--world", SHAPE_6];
    let (code, before) = judged(&log, &options);
    let none = json!({"off_clock": 0, "scans_without_odometry": 0});
    assert_eq!((code, &before["skipped_messages"]), (Some(0), &none));
    let changed = folder.join("changed.mcap");
    // The stamps of these messages, by their numbers on a topic, become others.
    let change = |topic: &str, seconds: &dyn Fn(usize, i32) -> i32| {
        let mut number = 0;
        rewritten(&log, &changed, |_, message| {
            if message.channel.topic == topic {
                let other = seconds(number, stamp(message));
                if other != stamp(message) {
                    set_stamp(message, other);
                }
                number += 1;
            }
            true
        });
    };
    let far = 2_000_000_000;
    for topic in [ODOM, Scene::TOPIC] {
        // In the middle of a stretch of hallway, and at a junction.
        change(topic, &|number, seconds| if [30, 50].contains(&number) { far } else { seconds });
        let (code, after) = judged(&changed, &options);
        let skipped = json!({"off_clock": 2, "scans_without_odometry": 0});
        assert_eq!((code, &after["skipped_messages"]), (Some(0), &skipped), "{topic}");
        let remark = "skipped messages: 2 whose time is far from that of all others";
        assert_eq!(after["remarks"][0], remark, "{topic}");
        for fact in ["verdict", "events", "candidates", "unique"] {
            assert_eq!(after[fact], before[fact], "{topic}: {fact}");
        }
    }
    // What cannot be skipped is an error: the time of a scene decides where the robot was.
    let error = || {
        let output = run([&["conform", changed.to_str().unwrap()][..], &options].concat());
        assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
        stderr(&output)
    };
    change(Scene::TOPIC, &|number, seconds| if number >= 60 { far } else { seconds });
    let message = error();
    assert!(
        message
            .contains("its time, 2000000000.000 s, is more than an hour from that of all odometry")
            && message.contains("those of all 10 images or scenes from there on"),
        "{message}"
    );
    for topic in [ODOM, Scene::TOPIC] {
        let jumped = Cell::new(0);
        change(topic, &|number, seconds| {
            jumped.set(if number == 50 { seconds + 1000 } else { jumped.get() });
            if number == 50 { jumped.get() } else { seconds }
        });
        let message = error();
        let back = format!("its clock goes back, from {}.000 s to ", jumped.get());
        assert!(message.contains(&back), "{topic}: {message}");
    }
    // An event has its place in the order; without it the others mean something else.
    change(Percept::TOPIC, &|number, seconds| if number == 2 { far } else { seconds });
    let output = run(["conform", changed.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
    let message = stderr(&output);
    assert!(message.contains("the one before it at 2000000000.000 s"), "{message}");
    fs::remove_dir_all(folder).unwrap();
}

/// The number of a row is that of the table, not that of the message in the order of time.
#[cfg(feature = "sqlite")]
#[test]
fn a_divergence_in_a_database_names_its_row() {
    let folder = folder("conform-row");
    let log = logged(&folder, SHAPE_6, &["--seed", "3"]);
    let [database, page] = ["run.db3", "page.html"].map(|name| folder.join(name));
    rewritten(&log, &database, |_, _| true);
    let other = ["--world", SHAPE_8, "--start", "any"];
    let (code, of_file) = judged(&log, &other);
    let (same, line) = judged(&database, &other);
    assert_eq!((code, same), (Some(1), Some(1)), "{line}");
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
    assert_eq!(topic.unwrap(), if is_percept { Percept::TOPIC } else { Door::TOPIC });
    let html = ["--html", page.to_str().unwrap()];
    let report = run([&["conform", database.to_str().unwrap()][..], &other, &html].concat());
    let place = format!(", at row {}", grouped(u64::try_from(row).unwrap().into()));
    let text = stdout(&report);
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains(&place), "{text}");
    assert!(fs::read_to_string(page).unwrap().contains(&place));
    fs::remove_dir_all(folder).unwrap();
}

/// One log is checked, and the next one is being read.
#[cfg(unix)]
#[test]
fn an_interrupted_check_leaves_the_page_as_it_was() {
    use super::interrupted;

    let folder = folder("conform-interrupted");
    let log = logged(&folder, SHAPE_6, &["--seed", "3"]);
    let page = folder.join("page.html");
    for earlier in [None, Some("the page of an earlier check")] {
        if let Some(text) = earlier {
            fs::write(&page, text).unwrap();
        }
        let paths = [&log, &page].map(|path| path.to_str().unwrap());
        let output = interrupted(&["conform", paths[0], "-", "--html", paths[1]]);
        assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
        assert_eq!(stderr(&output), "interrupted\n");
        assert_eq!(fs::read_to_string(&page).ok().as_deref(), earlier);
        let mut files: Vec<_> =
            fs::read_dir(&folder).unwrap().map(|file| file.unwrap().path()).collect();
        files.sort();
        let page = earlier.map(|_| page.clone());
        assert_eq!(files, page.into_iter().chain([log.clone()]).collect::<Vec<_>>());
    }
    fs::remove_dir_all(folder).unwrap();
}
