//! Traversals and whole runs: small parts of long measurements.

use serde_json::Value;

use super::{objects, run, stderr, stdout, stdout_of};

const SHAPE_6: &str = "worlds/shape-6.toml";
const SHAPE_8: &str = "worlds/shape-8.toml";
/// The options of the folding explorer.
const FOLDING: [&str; 2] = ["--algorithm", "folding"];

#[test]
fn control_is_as_specified_on_any_number_of_threads() {
    let arguments = ["control", "--traversals", "3000", "--plans", "10", "--json"];
    let text = stdout_of(arguments);
    assert_eq!(text, stdout_of([&arguments[..], &["--threads", "3"]].concat()));
    let lines = objects(&text);
    let last = lines.last().unwrap();
    assert_eq!((&last["kind"], &last["holds"]), (&"control".into(), &true.into()), "{text}");
    assert_eq!(last["traversals"], 3000);
    let table = stdout_of(["control", "--traversals", "500", "--plan", SHAPE_6]);
    // Of six junctions: a dead end, four Ls with two entries and two doors each, a T with three.
    assert!(table.contains("  26 pairs of entry door and exit door in 1 floor plan\n"), "{table}");
    assert!(
        table.contains("holds in these traversals: every door leads where it should"),
        "{table}"
    );
}

#[test]
fn a_few_doors_are_taken_with_images() {
    let arguments = ["control", "--images", "--look", "tiles", "--traversals", "4"];
    let output = run([&arguments[..], &["--plan", SHAPE_8]].concat());
    assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
    assert!(
        stdout(&output).contains("Driving by rendered images of 640x480"),
        "{}",
        stdout(&output)
    );
}

// paper: exp.simulated
#[test]
fn whole_runs_are_right_and_those_with_faults_right_or_honest() {
    let text = stdout_of(["runs", "--plans", "12", "--starts", "2", "--json"]);
    let lines = objects(&text);
    let last = lines.last().unwrap();
    assert_eq!((&last["kind"], &last["holds"]), (&"runs".into(), &true.into()), "{text}");
    let runs: Vec<_> = lines.iter().filter(|line| line["kind"] == "run").collect();
    assert!(runs.len() > 25 && runs.iter().all(|run| run["moves"] == run["explore_moves"]));
    let table = stdout_of(["runs", "--plans", "12", "--starts", "2", "--faults"]);
    let verdict = "holds in these runs: every map is right, or the robot gave up or was carried";
    for part in ["dropped", "frozen", "carried", verdict] {
        assert!(table.contains(part), "{part}\n{table}");
    }
}

#[test]
fn whole_runs_are_right_with_the_folding_explorer() {
    let words = ["runs", "--plans", "5", "--json"];
    let lines = objects(&stdout_of([&words[..], &FOLDING].concat()));
    let runs: Vec<_> = lines.iter().filter(|line| line["kind"] == "run").collect();
    assert!(runs.len() > 10 && runs.iter().all(|run| run["right"] == true));
    let last = lines.last().unwrap();
    assert_eq!(last["algorithm"], "folding");
    let total = |name: &str| runs.iter().filter_map(|run| run[name].as_u64()).sum::<u64>();
    assert_eq!(last["moves_total"], total("moves"));
    assert_eq!(last["certificate_total"], total("certificate_moves"));
    assert!(runs.iter().all(|run| run["moves"].as_u64() >= run["certificate_moves"].as_u64()));
    assert_eq!(lines, objects(&stdout_of(words)), "it is the default");
    let other = objects(&stdout_of([&words[..], &["--algorithm", "algorithm1"]].concat()));
    let moves =
        |lines: &[Value]| -> u64 { lines.iter().filter_map(|line| line["moves"].as_u64()).sum() };
    assert!(moves(&lines) < moves(&other));
}

#[test]
fn runs_by_image_are_right_with_both_algorithms() {
    let words = ["runs", "--images", "--look", "tiles", "--runs", "1", "--json"];
    let words = [&words[..], &["--plan", "worlds/shape-8.toml"]].concat();
    for algorithm in ["algorithm1", "folding"] {
        let lines = objects(&stdout_of([&words[..], &["--algorithm", algorithm]].concat()));
        let run = lines.iter().find(|line| line["kind"] == "run").unwrap();
        assert!(run["right"] == true && run["frames"].as_u64() > Some(10), "{run}");
        assert_eq!(run["moves"], run["explore_moves"], "{run}");
    }
}
