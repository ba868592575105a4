//! `toposlam simulate` with audits, recovery, blocked doors, budgets and earlier runs. Most facts
//! are in `tests/facts/safeguards.txt`.

use serde_json::json;

use super::{Scratch, stdout};

const SHAPE_8: &str = "simulate worlds/shape-8.toml --by-scene";
const BUILDING: &str = "simulate worlds/building-12.toml --by-scene";

#[test]
fn an_audit_takes_moves_of_its_own() {
    let scratch = Scratch::new("audits");
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
    // After 10 moves the map is complete, and its audit takes 12 more. Before, the map is not written.
    for (most, code) in [(19, 3), (40, 0)] {
        let audited = "--algorithm folding --audit --map map.toml";
        scratch.out(&format!("{SHAPE_8} {audited} --max-moves {most}"), code);
        assert_eq!(scratch.path("map.toml").exists(), code == 0);
    }
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
        scratch.fact("conform --rerun part.mcap", 3, &json!({ "map": true }));
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
    scratch.out("conform rest.mcap --world worlds/building-12.toml", 0);
}

#[test]
fn the_log_of_a_robot_that_tried_its_blocked_doors_again_is_compared_with_its_explorer() {
    let scratch = Scratch::new("recovered-log");
    let again = "--recover --retry-blocked --fault blocked@20:250";
    scratch.out(&format!("{BUILDING} --log run.mcap {again}"), 0);
    let text = stdout(&scratch.run("conform run.mcap --world worlds/building-12.toml"));
    assert!(text.contains("those of the folding explorer with recovery\n"), "{text}");
}
