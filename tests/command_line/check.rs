//! `toposlam check`: files of worlds, the worst start, and Ctrl-C. The counts are in `tests/facts/check.txt`.

use serde_json::json;

use super::{Scratch, has, objects, read_world, world_files};

// paper: cost.moves, movable.place
#[test]
fn worlds_in_files_are_checked_by_size_and_the_worst_start_is_written() {
    let scratch = Scratch::new("check_files");
    for path in world_files() {
        let file = path.to_str().unwrap();
        let graph = read_world(&path).graph;
        let line = scratch.last(&format!("check --from {file}"), 0);
        has(&line, &json!({ "edges": graph.edge_count(), "worlds": 1 }), file);
        let starts = line["starts"].as_u64().unwrap() as usize;
        assert!(starts >= 1 && graph.dart_count().is_multiple_of(starts), "{file}: {starts}");
    }
    for file in ["worst.toml", "worst.json"] {
        let lines = scratch.lines(&format!("check --edges 1..=4 --worst {file}"), 0);
        let moves = &lines[3]["moves_max"];
        scratch.fact(&format!("explore {file}"), 0, &json!({ "moves": moves, "edges": 4 }));
    }
}

#[cfg(unix)]
#[test]
fn an_interrupted_check_prints_its_results_and_does_not_hold() {
    let lines = objects(&super::interrupted_after_a_line("check --json --edges 3..=9"));
    let (last, before) = lines.split_last().unwrap();
    has(last, &json!({ "interrupted": true, "holds": false, "failed": 0 }), "check");
    assert!(before.iter().all(|line| line["holds"] == true));
    assert_eq!(last["starts"], last["mapped"]);
}
