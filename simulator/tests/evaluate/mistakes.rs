//! `evaluate mistakes`.

use super::{folder, names_in, objects, read_world, run, stdout};

fn mistakes(options: &[&str]) -> (Option<i32>, String) {
    let output = run([&["mistakes", "--edges", "1..=3"], options].concat());
    (output.status.code(), stdout(&output))
}

#[test]
fn an_audit_detects_what_the_algorithm_alone_does_not() {
    for algorithm in ["algorithm1", "folding"] {
        let with = ["--algorithm", algorithm];
        let (code, text) = mistakes(&with);
        assert_eq!(code, Some(1), "{text}");
        assert!(
            text.contains("\nWrong degree, the smallest that is not detected: in a world with 2")
        );
        assert!(text.lines().any(|line| line.starts_with("violated: ")), "{text}");
        let (code, text) = mistakes(&[&with[..], &["--audit"]].concat());
        assert_eq!(code, Some(0), "{text}");
        assert!(
            text.ends_with("holds: each run ends with the right map, or the mistake is detected\n")
        );
    }
}

#[test]
fn with_recovery_every_run_is_right_but_for_a_pose_that_nothing_shows() {
    let (code, text) = mistakes(&["--algorithm", "folding", "--recover", "--json"]);
    assert_eq!(code, Some(0), "{text}");
    let lines = objects(&text);
    assert_eq!(lines.len(), 6);
    for line in &lines[..5] {
        let pose = if line["mistake"] == "robot carried" { 13 } else { 0 };
        assert_eq!(line["wrong_pose"], pose);
        let right = line["right"].as_u64().unwrap();
        assert_eq!(right + pose, line["runs"].as_u64().unwrap());
    }
    assert_eq!((&lines[5]["kind"], &lines[5]["starts"]), (&"mistakes".into(), &86.into()));
}

#[test]
fn the_smallest_mistakes_are_written_as_worlds() {
    let folder = folder("mistakes");
    let written = folder.join("worlds");
    assert_eq!(mistakes(&["--out-dir", written.to_str().unwrap()]).0, Some(1));
    let names =
        ["marker-invented", "marker-missed", "marker-turned", "robot-carried", "wrong-degree"];
    assert_eq!(names_in(&written), names.map(|name| format!("{name}.toml")));
    for name in names_in(&written) {
        let world = read_world(&written.join(name));
        assert!(world.start.is_some());
    }
}
