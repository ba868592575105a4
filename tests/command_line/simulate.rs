//! `toposlam simulate`.

use serde_json::{Value, json};

use super::{Scratch, has, read_world, stderr, stdout};

const SHAPE_6: &str = "simulate worlds/shape-6.toml --by-scene";

// paper: exp.simulated
// paper: exp.maps
#[test]
fn a_robot_that_sees_only_its_images_maps_shape_6() {
    let scratch = Scratch::new("simulate");
    let files = "--map map.toml --svg run.svg --html run.html";
    let text = scratch.out(&format!("simulate worlds/shape-6.toml --seed 3 {files}"), 0);
    for part in ["So v1.2 and v4.1 are the two ends of one edge.", "  moves             7 (7 in "] {
        assert!(text.contains(part), "{part}\n{text}");
    }
    let [world, map] =
        ["worlds/shape-6.toml", "map.toml"].map(|name| read_world(&scratch.path(name)));
    assert_eq!(map.graph.edge_count(), world.graph.edge_count());
    let page = scratch.text("run.html");
    assert!(page.contains("data:image/jpeg;base64,") && page.contains("So v1.2 and v4.1"));
    assert!(scratch.text("run.svg").starts_with("<svg"));
}

// paper: exp.multiplicative
#[test]
fn the_result_of_a_run_is_one_object_and_always_the_same() {
    let scratch = Scratch::new("simulate_facts");
    for (plan, seed, moves, edges) in [("shape-6", 0, 7, 6), ("shape-8", 1, 10, 7)] {
        let simulate = format!("simulate worlds/{plan}.toml --by-scene --seed {seed}");
        let report = || {
            let mut object = scratch.last(&simulate, 0);
            // The one thing that is a wall time.
            assert!(object["compute_seconds"].as_f64().unwrap() > 0.0);
            object["compute_seconds"] = Value::Null;
            object
        };
        let object = report();
        assert_eq!(object, report());
        has(
            &object,
            &json!({
                "schema": 1, "moves": moves, "explore_moves": moves, "edges": edges,
                "algorithm": "folding", "certificate": { "moves": moves, "ratio": 1.0 },
                "isomorphic": true, "pose_true": true, "conforms": true, "divergence": null,
                "error": null,
            }),
            &simulate,
        );
        assert!(object["frames"].as_u64().unwrap() > 60);
        assert!(object["simulated_seconds"].as_f64().unwrap() > 180.0);
    }
}

#[test]
fn a_run_with_a_fault_or_a_limit_has_its_exit_code() {
    let scratch = Scratch::new("simulate_faults");
    let missed = format!("{SHAPE_6} --fault carried@99999 --fault");
    scratch.facts(&[
        (&format!("{SHAPE_6} --fault blocked@20"), 1, json!({})),
        (&format!("{SHAPE_6} --fault lights-out@20"), 1, json!({})),
        (&format!("{SHAPE_6} --fault dropped@20:50"), 1, json!({})),
        // A fault that does not happen is not survived.
        (&format!("{missed} late@20"), 3, json!({ "faults_missed": ["carried@99999:1"] })),
        // A violation is worse.
        (&format!("{missed} lights-out@20"), 1, json!({})),
        ("simulate worlds/shape-8.toml --by-scene --max-darts 6", 3, json!({})),
    ]);
}

#[test]
fn a_camera_that_sees_nothing_is_refused() {
    let scratch = Scratch::new("simulate_bad");
    let camera = "[camera]\nkind = \"spherical-mirror\"\nimage = [640, 480]\ncentre = [320.0, 240.0]\n\
         focal = 636.4\nmirror_radius = 0.05\nmirror_distance = 0.15\ncamera_height = 0.9\n\
         ahead = 90.0\nseen_from = \"below\"\nmask = \"dark.png\"\n";
    scratch.write("camera.toml", camera);
    image::GrayImage::new(640, 480).save(scratch.path("dark.png")).unwrap();
    scratch.error("simulate worlds/shape-6.toml --calibration camera.toml");
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_reports_its_results_and_is_incomplete() {
    // Far too long to end by itself. Its first line shows that it is at work.
    let run = "simulate worlds/building-25.toml --start north-west:west-upper";
    let output = super::interrupted_after_a_line(run);
    let text = stdout(&output);
    assert_eq!(output.status.code(), Some(3), "{text}{}", stderr(&output));
    assert!(text.contains("The robot gave up: the run was ended on move "), "{text}");
    assert!(text.contains("  map               "), "{text}");
}

#[test]
fn a_run_starts_at_the_l_nearest_to_a_start_that_is_none() {
    let scratch = Scratch::new("simulate_starts");
    for (plan, start, facing) in
        [("building-12", "courtyard", "west"), ("building-25", "east-door", "south-east")]
    {
        let simulate = format!("simulate worlds/{plan}.toml --by-scene");
        let output = scratch.run(&format!("{simulate} --json"));
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(0), "{message}");
        let note = format!("the start of the plan, {start}, is not an L, where a marker can lie\n");
        assert!(message.starts_with("the run starts at ") && message.contains(&note), "{message}");
        // A start that is asked for is not replaced.
        let message = scratch.error(&format!("{simulate} --start {start}:{facing}"));
        assert!(message.contains("is a dead end; a run starts at an L"), "{message}");
    }
}
