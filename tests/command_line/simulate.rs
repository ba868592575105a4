//! `toposlam simulate`. Exit codes are in `tests/facts/simulate.txt`.

use serde_json::{Value, json};

use super::{Scratch, has, read_world, stderr};

// paper: exp.simulated
// paper: exp.maps
#[test]
fn a_robot_that_sees_only_its_images_maps_shape_6() {
    let scratch = Scratch::new("simulate");
    let files = "--map map.toml --svg run.svg --html run.html";
    let run = format!("simulate worlds/shape-6.toml --seed 3 {files}");
    scratch.fact(&run, 0, &json!({ "moves": 7, "isomorphic": true }));
    let [world, map] =
        ["worlds/shape-6.toml", "map.toml"].map(|name| read_world(&scratch.path(name)));
    assert_eq!(map.graph.edge_count(), world.graph.edge_count());
    assert!(scratch.text("run.html").contains("data:image/jpeg;base64,"));
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
        let fields = json!({
            "schema": 1, "moves": moves, "explore_moves": moves, "edges": edges,
            "algorithm": "folding", "certificate": { "moves": moves, "ratio": 1.0 },
            "isomorphic": true, "pose_true": true, "conforms": true, "divergence": null,
            "error": null,
        });
        has(&object, &fields, &simulate);
        assert!(object["frames"].as_u64().unwrap() > 60);
        assert!(object["simulated_seconds"].as_f64().unwrap() > 180.0);
    }
}

#[test]
fn a_camera_that_sees_nothing_is_refused() {
    let scratch = Scratch::new("simulate_bad");
    let camera = "[camera]\nkind = \"spherical-mirror\"\nimage = [640, 480]\ncentre = [320.0, 240.0]\n\
         focal = 636.4\nmirror_radius = 0.05\nmirror_distance = 0.15\ncamera_height = 0.9\n\
         ahead = 90.0\nseen_from = \"below\"\nmask = \"dark.png\"\n";
    scratch.write("camera.toml", camera);
    image::GrayImage::new(640, 480).save(scratch.path("dark.png")).unwrap();
    facts! { scratch; "simulate worlds/shape-6.toml --calibration camera.toml" => 2 ""; }
}

/// Far too long to end by itself. Its first line shows that it is at work.
#[cfg(unix)]
#[test]
fn an_interrupted_run_reports_its_results_and_is_incomplete() {
    let run = "simulate worlds/building-25.toml --start north-west:west-upper";
    let text = super::interrupted_after_a_line(run);
    assert!(text.contains("The robot gave up: the run was ended on move "), "{text}");
    assert!(text.contains("  map               "), "{text}");
}

#[test]
fn a_run_starts_at_the_l_nearest_to_a_start_that_is_none() {
    let scratch = Scratch::new("simulate_starts");
    for (plan, start) in [("building-12", "courtyard"), ("building-25", "east-door")] {
        let output = scratch.run(&format!("simulate worlds/{plan}.toml --by-scene --json"));
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(0), "{message}");
        let note = format!("the start of the plan, {start}, is not an L, where a marker can lie\n");
        assert!(message.starts_with("the run starts at ") && message.contains(&note), "{message}");
    }
}
