//! `evaluate vision`, on a few views.

use std::fs;

use super::{folder, names_in, objects, read_world, run, stderr, stdout};

#[test]
fn one_view_is_shown_stage_by_stage() {
    let folder = folder("evaluate_view");
    let words = "vision --size 640x480 --look tiles --view 5 --json --out-dir".split(' ');
    let output = run(words.chain([folder.to_str().unwrap()]));
    let line = &objects(&stdout(&output))[0];
    assert_eq!(line["view"], 5);
    assert!(line["truth"].is_string() && line["verdict"].is_string());
    assert_eq!(names_in(&folder), ["view-00005"]);
    let view = folder.join("view-00005");
    let names = names_in(&view).join(" ");
    let steps = "1-classes.png 2-boundary.png 3-clusters.png 4-lines.png 5-scene.png 6-image.png";
    assert_eq!(names, format!("0-image.png {steps} plan.toml view.json"));
    assert!(read_world(&view.join("plan.toml")).plan.is_some());
    assert_eq!(fs::read_to_string(view.join("view.json")).unwrap(), stdout(&output));
}

/// In this view of an L a hallway fits well in which the robot is not.
#[test]
fn a_view_with_a_strong_yellow_cast_is_not_called_a_hallway_elsewhere() {
    let words =
        "vision --size 640x480 --look vinyl --seed 100 --view 118 --json --effect cast=0.77";
    let output = run(words.split(' '));
    let line = &objects(&stdout(&output))[0];
    assert_eq!((&line["view"], &line["truth"]), (&118.into(), &"l-left".into()));
    let verdict = line["verdict"].as_str().unwrap();
    assert!(["right", "unknown"].contains(&verdict), "{line}");
}

#[test]
fn a_world_without_a_floor_plan_is_refused() {
    let output = run(["vision", "--plan", "worlds/petersen.toml"]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(
        stderr(&output),
        "error: worlds/petersen.toml: this world is not a floor plan: it has no [floor]\n"
    );
}
