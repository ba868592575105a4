//! `toposlam counterexample`. Most facts are in `tests/facts/check.txt`.

use std::{collections::BTreeSet, fs, process::Stdio};

use toposlam_model::format::world_file;

use super::{Scratch, names_in, numbers, read_world, stderr};
use crate::process;

/// Each world is in a file. No walk distinguishes the worlds of a pair, and they are not isomorphic.
#[test]
fn all_pairs_are_reported_and_written_and_are_pairs() {
    let scratch = Scratch::new("counterexample_all");
    let all = "counterexample --all --marker undirected --class multigraph --max-edges 3";
    let lines = scratch.lines(&format!("{all} --out-dir new/deep"), 0);
    let of_kind = |kind| lines.iter().filter(move |line| line["kind"] == kind).cloned();
    let ambiguous: u64 = numbers(&of_kind("size").collect::<Vec<_>>(), "ambiguous").iter().sum();
    let out = scratch.path("new/deep");
    assert_eq!(names_in(&out).len() as u64, ambiguous);
    assert_eq!(of_kind("world").count() as u64, ambiguous);
    for line in of_kind("world") {
        let world = world_file::read(line["world"].to_string().as_bytes()).unwrap();
        assert_eq!(read_world(&out.join(format!("{}.toml", world.name))), world);
    }
    let mut in_pairs = BTreeSet::new();
    for line in of_kind("pair") {
        let names = [0, 1].map(|place| line["pair"]["worlds"][place].as_str().unwrap().to_owned());
        let files = names.clone().map(|name| format!("new/deep/{name}.toml")).join(" ");
        facts! { scratch;
            format!("compare --marker undirected {files}") => 0 { "distinguishable": false, "isomorphic": false };
        }
        in_pairs.extend(names);
    }
    assert_eq!(in_pairs.len() as u64, ambiguous);
}

#[cfg(target_os = "linux")]
#[test]
fn a_search_that_ends_early_leaves_no_temporary_files() {
    let scratch = Scratch::new("counterexample_interrupted");
    let temporary = scratch.path("temporary");
    fs::create_dir(&temporary).unwrap();
    let search =
        "counterexample --marker undirected --class multigraph --max-edges 9 --memory 64MB";
    for (signal, code) in [("-INT", Some(3)), ("-TERM", Some(3)), ("-KILL", None)] {
        let mut search = scratch.command(search);
        search.env("TMPDIR", &temporary).stdout(Stdio::null()).stderr(Stdio::piped());
        let search = search.spawn().unwrap();
        let open = format!("/proc/{}/fd", search.id());
        let has_file = || {
            let open = fs::read_dir(&open)
                .unwrap()
                .filter_map(|file| fs::read_link(file.ok()?.path()).ok());
            open.filter(|file| file.starts_with(&temporary)).count() > 0
        };
        process::until("it has a temporary file", 60, has_file);
        process::signal(&search, signal);
        let output = search.wait_with_output().unwrap();
        assert_eq!(output.status.code(), code, "{signal}: {}", stderr(&output));
        assert_eq!(names_in(&temporary), [""; 0], "{signal}");
    }
}
