//! `toposlam conform --rerun`: what the off-line version makes of a log.

use serde_json::{Value, json};

use super::{Scratch, has, read_world};

const RERUN: &str = "conform --rerun run.mcap";

// paper: exp.off-line-time
#[test]
fn a_log_gives_the_same_map_again_in_less_time() {
    let scratch = Scratch::new("rerun");
    let simulate = "simulate worlds/shapes/shape-2.toml --size 640x480 --effects none";
    let simulated = scratch.last(&format!("{simulate} --log run.mcap"), 0);
    let report = scratch.last(&format!("{RERUN} --map map.toml"), 0);
    has(
        &report,
        &json!({
            "map": true, "difference": null, "moves": simulated["moves"],
            "certificate": simulated["certificate"],
            // What computing takes is reported beside what the robot took.
            "recorded_seconds": simulated["simulated_seconds"],
            "edges": read_world(&scratch.path("map.toml")).graph.edge_count(),
        }),
        RERUN,
    );
    for what in ["scenes", "commands", "percepts", "doors"] {
        assert_eq!(report[what][0], report[what][1], "{what}");
        assert!(report[what][1].as_u64().unwrap() > 0, "{what}");
    }
    assert!(report["compute_seconds"].as_f64().unwrap() > 0.0);
    // The bound on darts is a limit, and a calibration of another size is bad input.
    let bounded = format!("{RERUN} --max-darts 4");
    scratch.facts(&[(&bounded, 3, json!({ "map": Value::Null, "difference": null }))]);
    let text = scratch.out(&bounded, 3);
    assert!(text.contains("Use --max-darts N to raise the bound."), "{text}");
    let pose = "--pose 2,4,0 --size 1280x960 --out large.png";
    scratch.out(&format!("draw worlds/shape-6.toml {pose}"), 0);
    scratch.out("camera calibrate large.png --out camera.toml", 0);
    let message = scratch.error(&format!("{RERUN} --calibration camera.toml"));
    let cause = "the image has 640 x 480 pixels; those of the calibrated camera have 1280 x 960";
    assert!(message.contains(cause), "{message}");
}

#[test]
fn a_truncated_log_is_rerun_to_its_end_and_a_log_without_commands_is_an_error() {
    let scratch = Scratch::new("rerun-cut");
    scratch.out("simulate worlds/shape-6.toml --by-scene --log run.mcap", 0);
    scratch.write("mapping.toml", "[odometry]\ntopic = \"/odom\"\n");
    let message = scratch.error(&format!("{RERUN} --topics mapping.toml"));
    assert!(message.contains("it has neither images nor scenes"), "{message}");
    let bytes = scratch.bytes("run.mcap");
    scratch.write("run.mcap", &bytes[..bytes.len() / 2]);
    let report = scratch.last(RERUN, 3);
    assert_eq!(report["complete"], false);
    assert!(report["error"].as_str().unwrap().contains("the log has no more images"), "{report}");
}
