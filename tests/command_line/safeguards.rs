//! `toposlam simulate` with audits, recovery, blocked doors, budgets and earlier runs.

use serde_json::{Value, json};

use super::{Scratch, has, stderr, stdout};

const SHAPE_8: &str = "simulate worlds/shape-8.toml --by-scene";
const BUILDING: &str = "simulate worlds/building-12.toml --by-scene";
const OF_BUILDING: &str = "conform run.mcap --world worlds/building-12.toml";

#[test]
fn an_audit_takes_moves_of_its_own_and_changes_nothing_else() {
    let scratch = Scratch::new("audit-moves");
    for algorithm in ["algorithm1", "folding"] {
        let moves = |audit: &str| {
            let object = scratch.last(&format!("{SHAPE_8} --algorithm {algorithm} {audit}"), 0);
            ["moves", "audit_moves", "explore_moves"].map(|name| object[name].as_u64().unwrap())
        };
        let [none, one, two] = ["", "--audit", "--audit=2"].map(moves);
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
    let scratch = Scratch::new("unaudited-map");
    for (most, code) in [(19, 3), (40, 0)] {
        let audited = "--algorithm folding --audit --map map.toml";
        let output = scratch.run(&format!("{SHAPE_8} {audited} --max-moves {most}"));
        assert_eq!(output.status.code(), Some(code), "{}", stderr(&output));
        assert_eq!(scratch.path("map.toml").exists(), code == 0);
        let says = stderr(&output).contains("the map is not written: the run ended early");
        assert_eq!(says, code != 0, "{}", stderr(&output));
    }
    let object = scratch.last(&format!("{SHAPE_8} --recover --max-moves 1"), 3);
    assert_eq!(object["blocked"], Value::Null);
    assert!(object["error"].as_str().unwrap().contains("to keep within 1 move;"), "{object}");
}

#[test]
fn the_log_of_an_audited_run_conforms_to_its_algorithm_and_audits() {
    let scratch = Scratch::new("audited-log");
    for [algorithm, other] in [["algorithm1", "folding"], ["folding", "algorithm1"]] {
        scratch.out(&format!("{BUILDING} --algorithm {algorithm} --audit=2 --log run.mcap"), 0);
        scratch.facts(&[
            (OF_BUILDING, 0, json!({ "verdict": "conforms" })),
            (
                &format!("conform run.mcap --algorithm {algorithm}"),
                0,
                json!({ "verdict": "conforms" }),
            ),
            (&format!("conform run.mcap --algorithm {other}"), 1, json!({})),
        ]);
    }
}

#[test]
fn a_log_is_compared_within_the_limits_of_its_robot() {
    let scratch = Scratch::new("recorded-limits");
    for limits in ["--max-moves 12 --algorithm folding", "--recover --max-darts 12"] {
        scratch.out(&format!("{BUILDING} --log run.mcap {limits}"), 3);
        scratch.out(OF_BUILDING, 3);
        scratch.out(&format!("{OF_BUILDING} --algorithm folding"), 3);
    }
    // A limit that was asked for counts.
    scratch.out(&format!("{OF_BUILDING} --max-darts 100"), 1);
}

#[test]
fn a_map_without_what_is_behind_an_obstacle_is_incomplete_unless_that_is_allowed() {
    let scratch = Scratch::new("blocked");
    let recover = format!("{SHAPE_8} --recover");
    scratch.facts(&[
        // Both sides of the one hallway.
        (&format!("{recover} --fault blocked@20"), 3, json!({ "blocked": ["v1.1", "v5.1"] })),
        (&format!("{recover} --fault blocked@20 --allow-blocked"), 0, json!({})),
        // It stays, or somebody takes it away after the audit.
        (
            &format!("{recover} --retry-blocked --fault blocked@20"),
            3,
            json!({ "blocked.#": 2, "isomorphic": true }),
        ),
        (
            &format!("{recover} --retry-blocked --fault blocked@20:250"),
            0,
            json!({ "blocked": [], "isomorphic": true }),
        ),
        // A robot that is carried recovers.
        (&format!("{SHAPE_8} --fault carried@80"), 1, json!({})),
        (&format!("{recover} --fault carried@80"), 0, json!({ "recoveries": 1, "blocked": [] })),
    ]);
}

#[test]
fn a_robot_returns_within_its_budget_and_goes_on_from_its_log() {
    let scratch = Scratch::new("budget");
    let whole = scratch.last(&format!("{BUILDING} --recover"), 0);
    for limit in ["--max-moves 25", "--max-minutes 25", "--battery-per-metre 0.01"] {
        let object = scratch.last(&format!("{BUILDING} --recover {limit} --log part.mcap"), 3);
        let within = match limit {
            "--max-moves 25" => object["moves"].as_u64().unwrap() <= 25,
            "--max-minutes 25" => object["simulated_seconds"].as_f64().unwrap() <= 25.0 * 60.0,
            _ => object["error"].to_string().contains("to keep within 100 m on one battery"),
        };
        assert!(within && object["error"].is_string(), "{object}");
        // The log repeats the run, with its end.
        scratch.facts(&[("conform --rerun part.mcap", 3, json!({ "map": true }))]);
        let resume = format!("{BUILDING} --recover --resume part.mcap --log rest.mcap");
        let again = scratch.last(&resume, 0);
        assert!(again["moves"].as_u64() < whole["moves"].as_u64(), "{again} {whole}");
    }
    let message = scratch.error("conform --rerun rest.mcap");
    assert!(message.contains("its robot went on from an earlier run"), "{message}");
    // The walks are of another building.
    let message = scratch.error(&format!("{SHAPE_8} --recover --resume part.mcap"));
    assert!(message.contains("it was made in another world"), "{message}");
    // Whatever chose the doors, its percepts are those of the building.
    let output = scratch.run("conform rest.mcap --world worlds/building-12.toml");
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(stderr(&output).contains("its robot went on from an earlier run"), "{output:?}");
}

#[test]
fn the_log_of_a_robot_that_recovers_or_turns_back_conforms_as_far_as_it_goes() {
    let scratch = Scratch::new("recovered-log");
    let log = |options: &str, code: i32| {
        scratch.out(&format!("{BUILDING} --log run.mcap {options}"), code);
    };
    let of_recovery = |code: i32, fields: Value| {
        let text = scratch.out(OF_BUILDING, code);
        let doors = "doors      those of the folding explorer with recovery\n";
        assert!(text.contains(doors), "{text}");
        has(&scratch.last(OF_BUILDING, code), &fields, OF_BUILDING);
    };
    // It got lost, and its world agrees with all that it saw.
    log("--recover --fault lights-out@40:120", 0);
    of_recovery(0, json!({ "verdict": "conforms" }));
    let text = scratch.out("conform run.mcap", 3);
    assert!(text.contains("the robot got lost before event"), "{text}");
    // Algorithm 1, with as many audits, would have given up.
    scratch.out(&format!("{OF_BUILDING} --algorithm algorithm1"), 1);
    // It was carried, which is a divergence, and did what it should.
    log("--recover --fault carried@80", 0);
    of_recovery(1, json!({ "class": "motion" }));
    // It tried its blocked doors again.
    log("--recover --retry-blocked --fault blocked@20:250", 0);
    let text = stdout(&scratch.run(OF_BUILDING));
    assert!(text.contains("those of the folding explorer with recovery\n"), "{text}");
    // It turned back, which the budget in the head of the log explains.
    for budget in ["--max-moves 25", "--max-minutes 20"] {
        log(&format!("--algorithm folding {budget}"), 3);
        let text = scratch.out(OF_BUILDING, 3);
        assert!(text.contains("no divergence so far") && text.contains("turned back"), "{text}");
    }
}
