//! `toposlam simulate` with audits, recovery, blocked doors, budgets and earlier runs.

use std::fs;

use serde_json::{Value, json};

use super::{folder, objects, run, stderr, stdout, stdout_of};

const SHAPE_8: &str = "worlds/shape-8.toml";
const BUILDING: &str = "worlds/building-12.toml";

/// The exit code, the output in one line, and the object that `--json` prints.
fn simulated(arguments: &[&str]) -> (i32, String, Value) {
    let arguments = [&["simulate", "--by-scene"], arguments].concat();
    let output = run(&arguments);
    let text = stdout(&output).split_whitespace().collect::<Vec<_>>().join(" ");
    let object = objects(&stdout(&run([&arguments[..], &["--json"]].concat())));
    (output.status.code().unwrap(), text, object.into_iter().next().unwrap_or_default())
}

#[test]
fn an_audit_takes_moves_of_its_own_and_changes_nothing_else() {
    for algorithm in ["algorithm1", "folding"] {
        let with =
            |audit: &[&str]| simulated(&[&[SHAPE_8, "--algorithm", algorithm], audit].concat());
        let [none, one, two] = [&[][..], &["--audit"], &["--audit=2"]].map(with);
        assert_eq!([none.0, one.0, two.0], [0; 3]);
        let moves = |object: &Value| {
            ["moves", "audit_moves", "explore_moves"].map(|name| object[name].as_u64().unwrap())
        };
        let [none, one, two] = [none.2, one.2, two.2].map(|object| moves(&object));
        assert_eq!(none[1..], [0, none[0]]);
        for audited in [one, two] {
            assert_eq!(audited[0], audited[1] + none[0]);
        }
        assert!(0 < one[1] && one[1] < two[1]);
    }
}

/// After 10 moves the map is complete, and its audit takes 12 more.
#[test]
fn a_map_whose_audit_did_not_end_is_not_written() {
    let folder = folder("unaudited-map");
    let map = folder.join("map.toml").display().to_string();
    let audited = [SHAPE_8, "--algorithm", "folding", "--audit", "--map", &map];
    for (most, code) in [("19", 3), ("40", 0)] {
        let output = run([&["simulate", "--by-scene", "--max-moves", most], &audited[..]].concat());
        assert_eq!(output.status.code(), Some(code), "{}", stdout(&output));
        assert_eq!(fs::exists(&map).unwrap(), code == 0);
        let says = stderr(&output).contains("the map is not written: the run ended early");
        assert_eq!(says, code != 0, "{}", stderr(&output));
    }
    let (_, _, object) = simulated(&[SHAPE_8, "--recover", "--max-moves", "1"]);
    assert_eq!(object["blocked"], Value::Null);
    assert!(object["error"].as_str().unwrap().contains("to keep within 1 move;"), "{object}");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn the_log_of_an_audited_run_conforms_to_its_algorithm_and_audits() {
    let folder = folder("audited-log");
    let log = folder.join("audited.mcap").display().to_string();
    for [algorithm, other] in [["algorithm1", "folding"], ["folding", "algorithm1"]] {
        let audited = [BUILDING, "--algorithm", algorithm, "--audit=2", "--log", &log];
        assert_eq!(simulated(&audited).0, 0);
        for options in [&["--world", BUILDING][..], &["--algorithm", algorithm]] {
            let conform = [&["conform", &log, "--json"], options].concat();
            let lines = objects(&stdout_of(conform));
            assert!(lines.iter().any(|line| line["verdict"] == "conforms"), "{lines:?}");
        }
        let output = run(["conform", &log, "--algorithm", other]);
        assert_eq!(output.status.code(), Some(1), "{}", stdout(&output));
    }
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_log_is_compared_within_the_limits_of_its_robot() {
    let folder = folder("recorded-limits");
    let log = folder.join("limited.mcap").display().to_string();
    let of_budget = ["--max-moves", "12", "--algorithm", "folding"];
    let of_darts = ["--recover", "--max-darts", "12"];
    for limits in [&of_budget[..], &of_darts] {
        let simulate = ["simulate", BUILDING, "--by-scene", "--log", &log];
        assert_ne!(run([&simulate, limits].concat()).status.code(), Some(0));
        for options in [&[][..], &["--algorithm", "folding"]] {
            let output = run([&["conform", &log, "--world", BUILDING], options].concat());
            assert_eq!(output.status.code(), Some(3), "{limits:?}: {}", stdout(&output));
        }
    }
    // A limit that was asked for counts.
    let output = run(["conform", &log, "--world", BUILDING, "--max-darts", "100"]);
    assert_eq!(output.status.code(), Some(1), "{}", stdout(&output));
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_map_without_what_is_behind_an_obstacle_is_incomplete_unless_that_is_allowed() {
    let blocked = [SHAPE_8, "--recover", "--fault", "blocked@20"];
    let (code, text, object) = simulated(&blocked);
    assert_eq!(code, 3, "{text}");
    assert!(
        text.contains("The map is right, and complete but for 2 blocked doors, after"),
        "{text}"
    );
    // Both sides of the one hallway.
    assert_eq!(object["blocked"], json!(["v1.1", "v5.1"]));
    assert!(text.contains("blocked doors v1.1, v5.1"), "{text}");
    let (code, text, _) = simulated(&[&blocked[..], &["--allow-blocked"]].concat());
    assert_eq!(code, 0, "{text}");
    // It stays, or somebody takes it away after the audit.
    for (lasting, code) in [("blocked@20", 3), ("blocked@20:250", 0)] {
        let (found, text, object) =
            simulated(&[SHAPE_8, "--recover", "--retry-blocked", "--fault", lasting]);
        assert_eq!(found, code, "{text}");
        assert!(text.contains("The robot tries 2 blocked doors once more."), "{text}");
        let is_free = text.contains("a door that was blocked is free");
        assert_eq!((is_free, object["isomorphic"] == true), (code == 0, true), "{text}");
    }
}

#[test]
fn a_robot_that_is_carried_recovers() {
    let carried = [SHAPE_8, "--fault", "carried@80"];
    assert_eq!(simulated(&carried).0, 1);
    let (code, text, object) = simulated(&[&carried[..], &["--recover"]].concat());
    assert_eq!(code, 0, "{text}");
    assert!(text.contains("Contradiction ("), "{text}");
    assert!(text.contains("It finds the marker") && text.contains("recoveries 1"), "{text}");
    assert_eq!((&object["recoveries"], &object["blocked"]), (&json!(1), &json!([])));
}

#[test]
fn a_robot_returns_within_its_budget_and_goes_on_from_its_log() {
    let folder = folder("budget");
    let [part, rest] =
        ["part.mcap", "rest.mcap"].map(|name| folder.join(name).display().to_string());
    let whole = simulated(&[BUILDING, "--recover"]).2;
    for (option, limit) in
        [("--max-moves", "25"), ("--max-minutes", "25"), ("--battery-per-metre", "0.01")]
    {
        let (code, text, object) =
            simulated(&[BUILDING, "--recover", option, limit, "--log", &part]);
        assert_eq!(code, 3, "{text}");
        assert!(text.contains("it is back at its marker."), "{text}");
        let within = match option {
            "--max-moves" => object["moves"].as_u64().unwrap() <= 25,
            "--max-minutes" => object["simulated_seconds"].as_f64().unwrap() <= 25.0 * 60.0,
            _ => text.contains("to keep within 100 m on one battery"),
        };
        assert!(within && object["error"].is_string(), "{object}");
        // The log repeats the run, with its end.
        let replayed = run(["conform", "--rerun", &part, "--json"]);
        assert_eq!(replayed.status.code(), Some(3));
        let replayed = objects(&stdout(&replayed)).remove(0);
        assert_eq!(replayed["map"], true, "{replayed}");
        let (code, text, again) =
            simulated(&[BUILDING, "--recover", "--resume", &part, "--log", &rest]);
        assert_eq!(code, 0, "{text}");
        assert!(text.contains("It finds the marker."), "{text}");
        let spent = |object: &Value| object["moves"].as_u64().unwrap();
        assert!(spent(&again) < spent(&whole), "{again} {whole}");
    }
    let output = run(["conform", "--rerun", &rest]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("its robot went on from an earlier run"), "{output:?}");
    // The walks are of another building.
    let output = run(["simulate", SHAPE_8, "--by-scene", "--recover", "--resume", &part]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("it was made in another world"), "{}", stderr(&output));
    // Whatever chose the doors, its percepts are those of the building.
    let output = run(["conform", &rest, "--world", BUILDING]);
    assert_eq!(output.status.code(), Some(0), "{}", stdout(&output));
    assert!(stderr(&output).contains("its robot went on from an earlier run"), "{output:?}");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn the_log_of_a_robot_that_recovers_or_turns_back_conforms_as_far_as_it_goes() {
    let folder = folder("recovered-log");
    let log = folder.join("run.mcap").display().to_string();
    let conform = |arguments: &[&str]| {
        let output = run([&["conform", &log, "--world", BUILDING], arguments].concat());
        (output.status.code().unwrap(), stdout(&output))
    };
    let simulated =
        |arguments: &[&str]| simulated(&[&[BUILDING, "--log", &log], arguments].concat()).0;
    // It got lost, and its world agrees with all that it saw.
    assert_eq!(simulated(&["--recover", "--fault", "lights-out@40:120"]), 0);
    let (code, text) = conform(&[]);
    assert_eq!(code, 0, "{text}");
    assert!(text.contains("doors      those of the folding explorer with recovery\n"), "{text}");
    let output = run(["conform", &log]);
    let text = stdout(&output);
    assert_eq!(output.status.code(), Some(3), "{text}");
    assert!(text.contains("the robot got lost before event"), "{text}");
    // Algorithm 1, with as many audits, would have given up.
    let (code, text) = conform(&["--algorithm", "algorithm1"]);
    assert_eq!(code, 1, "{text}");
    // It was carried, which is a divergence, and did what it should.
    assert_eq!(simulated(&["--recover", "--fault", "carried@80"]), 0);
    let (code, text) = conform(&[]);
    assert_eq!(code, 1, "{text}");
    assert!(text.contains(": motion\n"), "{text}");
    assert!(text.contains("doors      those of the folding explorer with recovery\n"), "{text}");
    // It tried its blocked doors again.
    let blocked = ["--recover", "--retry-blocked", "--fault", "blocked@20:250"];
    assert_eq!(simulated(&blocked), 0);
    let text = conform(&[]).1;
    assert!(text.contains("doors      those of the folding explorer with recovery\n"), "{text}");
    // It turned back, which the budget in the head of the log explains.
    for budget in [["--max-moves", "25"], ["--max-minutes", "20"]] {
        assert_eq!(simulated(&[&["--algorithm", "folding"], &budget[..]].concat()), 3);
        let (code, text) = conform(&[]);
        assert_eq!(code, 3, "{text}");
        assert!(text.contains("no divergence so far") && text.contains("turned back"), "{text}");
    }
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn options_that_need_recovery_are_refused_without_it() {
    for (option, cause) in [
        (&["--retry-blocked"][..], "--recover"),
        (&["--allow-blocked"], "--recover"),
        (&["--resume", "x.mcap"], "--recover"),
        (&["--recover", "--algorithm", "algorithm1"], "only the folding explorer recovers"),
        (&["--max-moves", "0"], "0 is not in 1.."),
        (&["--max-minutes", "-1"], "expected a number greater than 0"),
        (&["--battery-per-metre", "2"], "expected a number greater than 0, and at most 1"),
    ] {
        let output = run([&["simulate", SHAPE_8, "--by-scene"], option].concat());
        assert_eq!(output.status.code(), Some(2), "{option:?}");
        assert!(stderr(&output).contains(cause), "{option:?}: {}", stderr(&output));
    }
}
