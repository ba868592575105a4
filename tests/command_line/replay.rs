//! `toposlam replay`: what the off-line version makes of a log.

use std::fs;

use serde_json::Value;

use super::{folder, objects, read_world, run, stderr, stdout, stdout_of};

// paper: exp.off-line-time
#[test]
fn a_log_gives_the_same_map_again_in_less_time() {
    let folder = folder("replay");
    let log = folder.join("run.mcap");
    let log = log.to_str().unwrap();
    let few = ["--size", "640x480", "--effects", "none"];
    let shape = ["simulate", "worlds/shapes/shape-2.toml", "--json", "--log", log];
    let simulated = objects(&stdout_of([&shape[..], &few].concat())).remove(0);
    let map = folder.join("map.toml");
    let arguments = ["conform", "--rerun", log, "--json", "--map", map.to_str().unwrap()];
    let report = objects(&stdout_of(arguments)).remove(0);
    assert_eq!((&report["map"], &report["difference"]), (&true.into(), &Value::Null));
    assert_eq!(report["moves"], simulated["moves"]);
    assert_eq!(report["certificate"], simulated["certificate"]);
    for what in ["scenes", "commands", "percepts", "doors"] {
        assert_eq!(report[what][0], report[what][1], "{what}");
        assert!(report[what][1].as_u64().unwrap() > 0, "{what}");
    }
    // What computing takes is report beside what the robot took.
    assert_eq!(report["recorded_seconds"], simulated["simulated_seconds"]);
    assert!(report["compute_seconds"].as_f64().unwrap() > 0.0);
    let edges = read_world(&map).graph.edge_count();
    assert_eq!(report["edges"], edges);
}

#[test]
fn a_truncated_log_is_replayed_to_its_end_and_a_log_without_commands_is_an_error() {
    let folder = folder("replay-cut");
    let log = folder.join("run.mcap");
    let path = log.to_str().unwrap();
    stdout_of(["simulate", "worlds/shape-6.toml", "--by-scene", "--json", "--log", path]);
    let bytes = fs::read(&log).unwrap();
    let mapping = folder.join("mapping.toml");
    fs::write(&mapping, "[odometry]\ntopic = \"/odom\"\n").unwrap();
    let output = run(["conform", "--rerun", path, "--topics", mapping.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("it has neither images nor scenes"), "{}", stderr(&output));
    fs::write(&log, &bytes[..bytes.len() / 2]).unwrap();
    let output = run(["conform", "--rerun", path, "--json"]);
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    let report = objects(&stdout(&output)).remove(0);
    assert_eq!(report["complete"], false);
    assert!(report["error"].as_str().unwrap().contains("the log has no more images"), "{report}");
}

#[test]
fn a_calibration_of_another_size_is_bad_input_and_the_bound_on_darts_is_a_limit() {
    let folder = folder("replay-limits");
    let log = folder.join("run.mcap");
    let log = log.to_str().unwrap();
    let few = ["--size", "640x480", "--effects", "none", "--json", "--log", log];
    stdout_of([&["simulate", "worlds/shapes/shape-2.toml"][..], &few].concat());
    let output = run(["conform", "--rerun", log, "--max-darts", "4", "--json"]);
    assert_eq!(output.status.code(), Some(3), "{}", stdout(&output));
    let report = &objects(&stdout(&output))[0];
    assert_eq!((&report["map"], &report["difference"]), (&Value::Null, &Value::Null));
    let text = stdout(&run(["conform", "--rerun", log, "--max-darts", "4"]));
    assert!(text.contains("Use --max-darts N to raise the bound."), "{text}");
    let images = folder.join("large.png");
    let images = images.to_str().unwrap();
    let camera = folder.join("camera.toml");
    let camera = camera.to_str().unwrap();
    let pose = ["--pose", "2,4,0", "--size", "1280x960", "--out", images];
    stdout_of([&["draw", "worlds/shape-6.toml"][..], &pose].concat());
    stdout_of(["camera", "calibrate", images, "--out", camera]);
    let output = run(["conform", "--rerun", log, "--calibration", camera]);
    assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
    let message = "the image has 640 x 480 pixels; those of the calibrated camera have 1280 x 960";
    assert!(stderr(&output).contains(message), "{}", stderr(&output));
}
