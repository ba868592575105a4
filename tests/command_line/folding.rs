//! `--algorithm folding`: simulated runs of the folding explorer.

use serde_json::json;

use super::Scratch;

#[test]
fn a_simulated_run_is_logged_and_replayed_with_its_algorithm() {
    let scratch = Scratch::new("folding-run");
    let simulate = "simulate worlds/building-12.toml --by-scene --log run.mcap --algorithm folding";
    let line = scratch.last(&format!("{simulate} --html run.html"), 0);
    scratch.facts(&[
        (
            simulate,
            0,
            json!({
                "algorithm": "folding", "isomorphic": true, "pose_true": true, "conforms": true,
                "explore_moves": line["moves"],
            }),
        ),
        (
            "conform --rerun run.mcap",
            0,
            json!({ "map": true, "difference": null, "moves": line["moves"] }),
        ),
        (
            "conform --rerun run.mcap --algorithm algorithm1",
            1,
            json!({ "difference.what": "door" }),
        ),
    ]);
    assert!(scratch.text("run.html").contains("the trail folds from"));
    let lost = "simulate worlds/shape-6.toml --by-scene --fault lights-out@20 --algorithm folding";
    assert!(scratch.out(lost, 1).contains("The robot gave up: on move "));
}
