//! Robots and walks with a laser scanner.

use std::fs;

use super::{folder, objects, run, stdout, stdout_of};

#[test]
fn control_and_runs_can_be_measured_by_laser() {
    let control = ["control", "--sensor", "laser", "--plan", "worlds/shape-6.toml"];
    let folder = folder("laser_control");
    let plain = folder.join("plain.toml");
    fs::write(&plain, "glass = 0\nblack = 0\ndoors = 0\nfurniture = 0\npeople = 0\n").unwrap();
    let options = ["--traversals", "26", "--scanner", plain.to_str().unwrap()];
    let text = stdout_of([&control[..], &options].concat());
    assert!(text.contains("Driving by scans of a laser scanner"), "{text}");
    assert!(text.contains("holds in these traversals"), "{text}");
    let runs = ["runs", "--sensor", "laser", "--plan", "worlds/shape-8.toml"];
    let options = ["--starts", "1", "--scanner", plain.to_str().unwrap(), "--json"];
    let lines = objects(&stdout_of([&runs[..], &options].concat()));
    assert_eq!(lines.last().unwrap()["holds"], true);
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn one_walk_is_printed_visit_by_visit() {
    let output = run(["laser", "--walk", "4", "--places", "6"]);
    let text = stdout(&output);
    assert!(text.contains("Laser scanner on 1 walk with ") && text.contains("walk 4, "), "{text}");
    assert!(text.contains(" doors, left by door "), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
}
