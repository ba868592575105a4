//! `toposlam counterexample`.

use std::{
    collections::BTreeSet,
    fs,
    process::{Command, Output},
    thread,
    time::Duration,
};

use serde_json::{Value, json};
use toposlam_model::format::world_file;

use super::{folder, names_in, objects, read_world, run, stderr, stdout, stdout_of, toposlam};

/// The lines of a search, those of sizes and then the rest.
fn searched(arguments: &[&str]) -> (Vec<Value>, Vec<Value>) {
    let arguments = [&["counterexample", "--json"], arguments].concat();
    let lines = objects(&stdout_of(arguments));
    lines.into_iter().partition(|line| line["placed_worlds"].is_number())
}

#[test]
fn a_line_for_each_size_and_one_for_the_smallest_pair() {
    let (sizes, rest) = searched(&["--marker", "undirected", "--max-edges", "7"]);
    let edges: Vec<_> = sizes.iter().map(|line| line["edges"].as_u64().unwrap()).collect();
    assert_eq!(edges, [1, 2, 3, 4, 5, 6, 7]);
    let six = &sizes[5];
    assert_eq!((&six["class"], &six["marker"]), (&"simple".into(), &"undirected".into()));
    assert_eq!((&six["placed_worlds"], &six["ambiguous"]), (&306.into(), &6.into()));
    assert_eq!(rest.len(), 1);
    assert_eq!(rest[0]["searched_edges"], 7);
    assert_eq!(rest[0]["smallest"]["edges"], 6);
    let worlds = rest[0]["smallest"]["worlds"].as_array().unwrap();
    assert_eq!(worlds.len(), 2);
    for world in worlds {
        let world = world_file::read(world.to_string().as_bytes()).unwrap();
        assert_eq!((world.graph.edge_count(), world.graph.vertex_count()), (6, 5));
        assert!(world.start.is_some());
    }
}

#[test]
fn without_a_pair_the_smallest_is_null() {
    let (_, rest) = searched(&["--marker", "directional", "--max-edges", "5"]);
    assert_eq!((rest.len(), &rest[0]["smallest"]), (1, &Value::Null));
    let text = stdout_of(["counterexample", "--marker", "directional", "--max-edges", "5"]);
    let end = "\nno pair up to 5 edges: a walk distinguishes any two\n\
               none in any world of the class: `directional_marker_suffices`, proved in Coq\n";
    assert!(text.ends_with(end), "{text}");
}

#[test]
fn several_markers_make_a_table() {
    let text = stdout_of(["counterexample", "--max-edges", "7"]);
    let rows: Vec<_> = text.lines().skip(3).map(|row| row.split_whitespace().next()).collect();
    let markers = [
        "none",
        "undirected",
        "directional",
        "undirected-edge",
        "directed-edge",
        "two-identical",
        "two-distinct",
        "movable",
    ];
    assert_eq!(rows, markers.map(Some));
    assert!(text.contains("undirected               2,177         10  6 and 6 edges\n"), "{text}");
    let (sizes, rest) = searched(&["--max-edges", "3"]);
    assert_eq!((sizes.len(), rest.len()), (8 * 3, 8));
    // A repeated marker counts once. The pairs are printed after the table.
    let twice = ["counterexample", "--max-edges", "4", "--marker", "none", "--marker", "none"];
    assert!(stdout_of(twice).starts_with("none marker: "));
    let text = stdout_of(["counterexample", "--max-edges", "4", "--all"]);
    let (table, pairs) = text.split_once("\nAll pairs: 1\n").unwrap();
    assert_eq!(table.lines().count(), 3 + 8);
    assert!(pairs.contains("none-simple-1 ~ none-simple-2: 3 and 4 edges"), "{text}");
}

/// Each world is in a file. No walk distinguishes the worlds of a pair, and they are not isomorphic.
#[test]
fn all_pairs_are_reported_and_written_and_are_pairs() {
    let folder = folder("counterexample_all");
    let out = folder.join("new/deep");
    let arguments =
        ["--all", "--marker", "undirected", "--class", "multigraph", "--max-edges", "3"];
    let written = ["--out-dir", out.to_str().unwrap()];
    let (sizes, rest) = searched(&[&arguments[..], &written[..]].concat());
    let ambiguous: u64 = sizes.iter().map(|line| line["ambiguous"].as_u64().unwrap()).sum();
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
        let file = |name: &Value| out.join(format!("{}.toml", name.as_str().unwrap()));
        let files: Vec<_> = names.iter().map(file).collect();
        let files: Vec<_> = files.iter().map(|file| file.to_str().unwrap()).collect();
        let compared = ["compare", "--json", "--marker", "undirected", files[0], files[1]];
        let compared = &objects(&stdout_of(compared))[0];
        let expected = (&compared["distinguishable"], &compared["isomorphic"]);
        assert_eq!(expected, (&false.into(), &false.into()));
        in_pairs.extend(names.iter().map(ToString::to_string));
    }
    assert_eq!(in_pairs.len() as u64, ambiguous);
}

#[test]
fn the_expectation_decides_the_exit_code() {
    let code = |marker, expect: &[&str]| {
        let arguments =
            [&["counterexample", "--max-edges", "4", "--marker", marker], expect].concat();
        run(arguments).status.code()
    };
    assert_eq!(code("none", &[]), Some(0));
    assert_eq!(code("none", &["--expect", "none"]), Some(1));
    assert_eq!(code("directional", &["--expect", "none"]), Some(0));
}

/// With one edge there is no pair for most markers. A theorem about some classes does not prove that for all.
#[test]
fn a_small_atlas_claims_no_theorem_about_all_classes() {
    let folder = folder("counterexample_small_atlas");
    stdout_of(["counterexample", "--max-edges", "1", "--atlas", folder.to_str().unwrap()]);
    let page = fs::read_to_string(folder.join("README.md")).unwrap();
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
    let folder = folder("counterexample_keep_going");
    let junit = folder.join("report.xml");
    let arguments = ["counterexample", "--max-edges", "4", "--expect", "none", "--json", "--junit"];
    let arguments = [&arguments[..], &[junit.to_str().unwrap()]].concat();
    let markers = |output: &Output| -> BTreeSet<String> {
        let lines = objects(&stdout(output)).into_iter();
        lines.map(|line| line["marker"].as_str().unwrap().to_owned()).collect()
    };
    let output = run(&arguments);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(markers(&output), BTreeSet::from(["none".to_owned()]));
    assert!(stderr(&output).contains("7 markers not searched; --keep-going"));
    let report = fs::read_to_string(&junit).unwrap();
    assert!(report.contains("tests=\"8\" failures=\"1\" errors=\"7\""), "{report}");
    assert!(report.contains("not checked after none, class "), "{report}");
    let output = run([&arguments[..], &["--keep-going"]].concat());
    assert_eq!((output.status.code(), markers(&output).len()), (Some(1), 8));
    let report = fs::read_to_string(&junit).unwrap();
    assert!(report.contains("errors=\"0\"") && !report.contains("not checked"), "{report}");
    let output = run(["counterexample", "--keep-going"]);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn the_output_is_the_same_at_any_number_of_threads() {
    let searched = |threads| {
        let sizes = ["--class", "multigraph", "--max-edges", "4", "--all", "--json"];
        stdout(&run([&["counterexample", "--threads", threads], &sizes[..]].concat()))
    };
    let one = searched("1");
    assert!(one.lines().count() > 100);
    assert_eq!(one, searched("3"));
}

#[test]
fn a_page_is_written_if_there_is_a_pair() {
    let folder = folder("counterexample_page");
    let page = folder.join("page.html");
    let written = ["--max-edges", "4", "--html", page.to_str().unwrap()];
    let output = run([&["counterexample", "--marker", "directional"], &written[..]].concat());
    assert_eq!((output.status.code(), names_in(&folder).len()), (Some(0), 0));
    stdout_of([&["counterexample", "--marker", "none"], &written[..]].concat());
    let page = fs::read_to_string(&page).unwrap();
    assert!(page.starts_with("<!doctype html>") && page.contains("none-simple-2"));
}

const LARGE: [&str; 6] = ["--marker", "undirected", "--class", "multigraph", "--max-edges", "7"];

/// What does not fit in the memory is sorted in temporary files, which are removed.
#[test]
fn with_little_memory_the_result_is_the_same() {
    let temporary = folder("counterexample_memory");
    let search = |memory: &[&str]| {
        let mut search = toposlam();
        search.args(["counterexample", "--json"]).args(LARGE).args(memory);
        search.env("TMPDIR", &temporary).output().unwrap()
    };
    let (free, bounded) = (search(&[]), search(&["--memory", "64MB"]));
    assert_eq!(bounded.status.code(), Some(0), "{}", stderr(&bounded));
    assert_eq!(stdout(&bounded), stdout(&free));
    assert_eq!(names_in(&temporary).len(), 0);
}

#[test]
fn a_memory_or_a_temporary_folder_that_cannot_be_used_is_bad_input() {
    for (memory, cause) in [
        ("2", "write a number with MB, GB, MiB or GiB, as in 2GB"),
        ("-1GB", "write a number"),
        ("1kB", "write a number"),
        ("10MB", "a search needs at least 64MB"),
    ] {
        let output = run(["counterexample", &format!("--memory={memory}")]);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(cause), "{}", stderr(&output));
    }
    let output = run(["counterexample", "--memory", "1GB", "--all"]);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    let missing = folder("counterexample_temporary").join("missing");
    let mut search = toposlam();
    search.args(["counterexample", "--max-edges", "2", "--memory", "1.5GiB"]);
    let output = search.env("TMPDIR", &missing).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let message = stderr(&output);
    assert!(message.contains("no folder for temporary files can be created in"), "{message}");
    assert!(message.contains("counterexample_temporary/missing: No such file"), "{message}");
}

#[cfg(unix)]
#[test]
fn an_interrupted_search_leaves_no_temporary_files() {
    use std::process::Stdio;

    let temporary = folder("counterexample_interrupted");
    let mut search = toposlam();
    search.args(["counterexample", "--memory", "64MB"]).args(&LARGE[..5]).arg("9");
    search.env("TMPDIR", &temporary).stdout(Stdio::null()).stderr(Stdio::piped());
    let search = search.spawn().unwrap();
    // The search is running once its folder is there. The files in it have no names.
    while names_in(&temporary).is_empty() {
        thread::sleep(Duration::from_millis(20));
    }
    thread::sleep(Duration::from_millis(500));
    let killed = Command::new("kill").args(["-INT", &search.id().to_string()]).status().unwrap();
    assert!(killed.success());
    let output = search.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    assert_eq!(names_in(&temporary).len(), 0);
}
