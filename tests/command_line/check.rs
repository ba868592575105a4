//! `toposlam check` and Ctrl-C. Most facts are in `tests/facts/check.txt`.

use serde_json::json;

use super::{has, objects};

#[cfg(unix)]
#[test]
fn an_interrupted_check_prints_its_results_and_does_not_hold() {
    let lines = objects(&super::interrupted_after_a_line("check --json --edges 3..=9"));
    let (last, before) = lines.split_last().unwrap();
    has(last, &json!({ "interrupted": true, "holds": false, "failed": 0 }), "check");
    assert!(before.iter().all(|line| line["holds"] == true));
    assert_eq!(last["starts"], last["mapped"]);
}
