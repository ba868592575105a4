//! Traversals and whole runs: small parts of long measurements.

use super::{objects, stdout_of};

// paper: exp.simulated
#[test]
fn whole_runs_are_right_with_the_moves_of_the_specification() {
    let text = stdout_of("runs --plans 12 --starts 2 --json".split(' '));
    let lines = objects(&text);
    let last = lines.last().unwrap();
    assert_eq!((&last["kind"], &last["holds"]), (&"runs".into(), &true.into()), "{text}");
    let runs: Vec<_> = lines.iter().filter(|line| line["kind"] == "run").collect();
    assert!(runs.len() > 25 && runs.iter().all(|run| run["moves"] == run["explore_moves"]));
}

#[test]
fn whole_runs_are_right_with_the_folding_explorer_in_fewer_moves() {
    let measured =
        |options: &str| objects(&stdout_of(format!("runs --plans 5 --json{options}").split(' ')));
    let lines = measured(" --algorithm folding");
    let runs: Vec<_> = lines.iter().filter(|line| line["kind"] == "run").collect();
    assert!(runs.len() > 10 && runs.iter().all(|run| run["right"] == true));
    let last = lines.last().unwrap();
    assert_eq!(last["algorithm"], "folding");
    let total = |name: &str| runs.iter().filter_map(|run| run[name].as_u64()).sum::<u64>();
    assert_eq!(last["moves_total"], total("moves"));
    assert_eq!(last["certificate_total"], total("certificate_moves"));
    assert!(runs.iter().all(|run| run["moves"].as_u64() >= run["certificate_moves"].as_u64()));
    assert_eq!(lines, measured(""), "it is the default");
    let other = measured(" --algorithm algorithm1");
    let other = other.iter().filter_map(|line| line["moves"].as_u64()).sum::<u64>();
    assert!(total("moves") < other);
}

#[test]
#[ignore = "a long sweep, for `.ci/run --all`"]
fn runs_by_image_are_right_with_both_algorithms() {
    for algorithm in ["algorithm1", "folding"] {
        let words =
            "runs --images --look tiles --runs 1 --json --plan worlds/shape-8.toml --algorithm";
        let lines = objects(&stdout_of(words.split(' ').chain([algorithm])));
        let run = lines.iter().find(|line| line["kind"] == "run").unwrap();
        assert!(run["right"] == true && run["frames"].as_u64() > Some(10), "{run}");
        assert_eq!(run["moves"], run["explore_moves"], "{run}");
    }
}
