//! `toposlam counterexample`.

use std::{collections::BTreeSet, thread, time::Duration};

use serde_json::{Value, json};
use toposlam_model::format::world_file;

use super::{Scratch, has, names_in, numbers, objects, read_world, stderr, stdout};

#[test]
fn a_line_for_each_size_and_one_for_the_smallest_pair() {
    let scratch = Scratch::new("counterexample_sizes");
    let lines = scratch.lines("counterexample --marker undirected --max-edges 7", 0);
    let (last, sizes) = lines.split_last().unwrap();
    assert_eq!(numbers(sizes, "edges"), [1, 2, 3, 4, 5, 6, 7]);
    let six = json!({
        "class": "simple", "marker": "undirected", "placed_worlds": 306, "ambiguous": 6,
    });
    has(&sizes[5], &six, "6 edges");
    let smallest = json!({ "searched_edges": 7, "smallest.edges": 6, "smallest.worlds.#": 2 });
    has(last, &smallest, "smallest");
    for world in last["smallest"]["worlds"].as_array().unwrap() {
        let world = world_file::read(world.to_string().as_bytes()).unwrap();
        assert_eq!((world.graph.edge_count(), world.graph.vertex_count()), (6, 5));
        assert!(world.start.is_some());
    }
    // A line for each marker and size, and one for each marker.
    assert_eq!(scratch.lines("counterexample --max-edges 3", 0).len(), 8 * 3 + 8);
    scratch.facts(&[
        ("counterexample --marker directional --max-edges 5", 0, json!({ "smallest": null })),
        // The expectation decides the exit code.
        ("counterexample --marker none --max-edges 4", 0, json!({ "smallest.edges": 4 })),
        ("counterexample --marker none --max-edges 4 --expect none", 1, json!({})),
        ("counterexample --marker directional --max-edges 4 --expect none", 0, json!({})),
    ]);
}

/// Each world is in a file. No walk distinguishes the worlds of a pair, and they are not isomorphic.
#[test]
fn all_pairs_are_reported_and_written_and_are_pairs() {
    let scratch = Scratch::new("counterexample_all");
    let lines = scratch.lines(
        "counterexample --all --marker undirected --class multigraph --max-edges 3 \
         --out-dir new/deep",
        0,
    );
    let (sizes, rest): (Vec<_>, Vec<_>) =
        lines.into_iter().partition(|line| line["placed_worlds"].is_number());
    let ambiguous: u64 = numbers(&sizes, "ambiguous").iter().sum();
    let out = scratch.path("new/deep");
    assert_eq!(names_in(&out).len() as u64, ambiguous);
    let (worlds, pairs): (Vec<_>, Vec<_>) =
        rest[1..].iter().partition(|line| line.get("world").is_some());
    assert_eq!(worlds.len() as u64, ambiguous);
    for line in &worlds {
        let world = world_file::read(line["world"].to_string().as_bytes()).unwrap();
        assert_eq!(read_world(&out.join(format!("{}.toml", world.name))), world);
        let about = "No walk distinguishes it from undirected-multigraph-";
        assert!(world.about.starts_with(about), "{world:?}");
    }
    let smallest = rest[0]["smallest"]["worlds"].as_array().unwrap();
    assert_eq!(pairs[0]["pair"]["worlds"], json!([smallest[0]["name"], smallest[1]["name"]]));
    let mut in_pairs = BTreeSet::new();
    for line in &pairs {
        let names = line["pair"]["worlds"].as_array().unwrap();
        let file = |name: &Value| format!("new/deep/{}.toml", name.as_str().unwrap());
        let files: Vec<_> = names.iter().map(file).collect();
        let compare = format!("compare --marker undirected {} {}", files[0], files[1]);
        scratch.facts(&[(&compare, 0, json!({ "distinguishable": false, "isomorphic": false }))]);
        in_pairs.extend(names.iter().map(ToString::to_string));
    }
    assert_eq!(in_pairs.len() as u64, ambiguous);
}

/// With one edge there is no pair for most markers. A theorem about some classes does not prove that for all.
#[test]
fn a_small_atlas_claims_no_theorem_about_all_classes() {
    let scratch = Scratch::new("counterexample_small_atlas");
    scratch.out("counterexample --max-edges 1 --atlas atlas", 0);
    let page = scratch.text("atlas/README.md");
    let reasons: Vec<_> = page.lines().filter(|line| line.starts_with("No pair: ")).collect();
    assert!(reasons.contains(&"No pair: see the table."), "{page}");
    for reason in reasons {
        let of_all = ["see the table", "`directional_marker_suffices`", "`directed_edge_suffices`"];
        assert!(of_all.iter().any(|of_all| reason.contains(of_all)), "{reason}");
    }
    assert!(page.contains("none up to 1 edge ") && !page.contains("1 edges"), "{page}");
}

#[test]
fn after_a_pair_the_other_markers_are_searched_if_the_search_is_to_keep_going() {
    let scratch = Scratch::new("counterexample_keep_going");
    let search = "counterexample --max-edges 4 --expect none --json --junit report.xml";
    for (more, markers, counts) in [("", 1, "errors=\"7\""), ("--keep-going", 8, "errors=\"0\"")] {
        let output = scratch.run(&format!("{search} {more}"));
        assert_eq!(output.status.code(), Some(1));
        let lines = objects(&stdout(&output));
        let found: BTreeSet<_> = lines.iter().map(|line| line["marker"].to_string()).collect();
        assert_eq!(found.len(), markers);
        let report = scratch.text("report.xml");
        assert!(
            report.contains("tests=\"8\" failures=\"1\"") && report.contains(counts),
            "{report}"
        );
        assert_eq!(report.contains("not checked after none, class "), more.is_empty(), "{report}");
        let remark = stderr(&output).contains("7 markers not searched; --keep-going");
        assert_eq!(remark, more.is_empty());
    }
}

#[test]
fn the_output_is_the_same_at_any_number_of_threads() {
    let scratch = Scratch::new("counterexample_threads");
    let searched = |threads: u32| {
        let search = "counterexample --class multigraph --max-edges 4 --all --json --threads";
        scratch.out(&format!("{search} {threads}"), 0)
    };
    let one = searched(1);
    assert!(one.lines().count() > 100);
    assert_eq!(one, searched(3));
}

#[test]
fn a_page_is_written_if_there_is_a_pair() {
    let scratch = Scratch::new("counterexample_page");
    let search = "counterexample --max-edges 4 --html page.html --marker";
    scratch.out(&format!("{search} directional"), 0);
    assert_eq!(scratch.written(), [""; 0]);
    scratch.out(&format!("{search} none"), 0);
    let page = scratch.text("page.html");
    assert!(page.starts_with("<!doctype html>") && page.contains("none-simple-2"));
}

const LARGE: &str = "counterexample --marker undirected --class multigraph --max-edges";

/// What does not fit in the memory is sorted in temporary files, which are removed.
#[test]
fn with_little_memory_the_result_is_the_same() {
    let scratch = Scratch::new("counterexample_memory");
    std::fs::create_dir(scratch.path("temporary")).unwrap();
    let search = |memory: &str| {
        let mut search = scratch.command(&format!("{LARGE} 7 --json {memory}"));
        search.env("TMPDIR", scratch.path("temporary")).output().unwrap()
    };
    let (free, bounded) = (search(""), search("--memory 64MB"));
    assert_eq!(bounded.status.code(), Some(0), "{}", stderr(&bounded));
    assert_eq!(stdout(&bounded), stdout(&free));
    assert_eq!(names_in(&scratch.path("temporary")).len(), 0);
    let mut search = scratch.command("counterexample --max-edges 2 --memory 1.5GiB");
    let output = search.env("TMPDIR", scratch.path("missing")).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let message = stderr(&output);
    assert!(message.contains("no folder for temporary files can be created in"), "{message}");
    assert!(message.contains("counterexample_memory/missing: No such file"), "{message}");
}

#[cfg(unix)]
#[test]
fn an_interrupted_search_leaves_no_temporary_files() {
    use std::process::Stdio;

    let scratch = Scratch::new("counterexample_interrupted");
    let temporary = scratch.path("temporary");
    std::fs::create_dir(&temporary).unwrap();
    let mut search = scratch.command(&format!("{LARGE} 9 --memory 64MB"));
    search.env("TMPDIR", &temporary).stdout(Stdio::null()).stderr(Stdio::piped());
    let search = search.spawn().unwrap();
    // The search is running once its folder is there. The files in it have no names.
    while names_in(&temporary).is_empty() {
        thread::sleep(Duration::from_millis(20));
    }
    thread::sleep(Duration::from_millis(500));
    super::interrupt(&search);
    let output = search.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    assert_eq!(names_in(&temporary).len(), 0);
}
