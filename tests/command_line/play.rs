//! `play`: the page of a world or of a random one.

use std::{collections::BTreeSet, fs};

use super::{folder, run, stderr, stdout_of};

/// The data of the page of a random world.
fn random(options: &str) -> String {
    let words = ["play", "--random"].into_iter().chain(options.split_whitespace());
    let page = stdout_of(words);
    let (_, data) = page.split_once("id=\"data\">").unwrap();
    data.split_once("</script>").unwrap().0.to_owned()
}

#[test]
fn a_random_world_is_the_same_for_the_same_seed_and_each_start_may_be_one() {
    assert_eq!(random("--seed 5"), random("--seed 5"));
    let seeds: Vec<_> = (0..60)
        .map(|seed| random(&format!("--edges 2 --class multigraph --seed {seed}")))
        .collect();
    let distinct: BTreeSet<_> = seeds.iter().collect();
    // A000698: there are 10 starts with 2 edges.
    assert_eq!(distinct.len(), 10);
    let largest: serde_json::Value = serde_json::from_str(&random("--edges 8")).unwrap();
    let world = largest["world"].as_array().unwrap();
    assert_eq!(world.iter().map(|vertex| vertex.as_array().unwrap().len()).sum::<usize>(), 16);
}

#[test]
fn a_page_is_a_file_or_standard_output() {
    let file = folder("play_page").join("play.html");
    let path = file.to_str().unwrap();
    let printed = stdout_of(["play", "worlds/shape-6.toml", "--start", "tee:sw"]);
    assert_eq!(stdout_of(["play", "worlds/shape-6.toml", "--start", "tee:sw", "-o", path]), "");
    assert_eq!(fs::read_to_string(&file).unwrap(), printed);
    assert!(printed.starts_with("<!doctype html>") && printed.ends_with("</html>\n"));
}

#[test]
fn bad_usage_of_play_is_an_error() {
    let folder = folder("play_errors");
    let file = folder.join("long.toml");
    let vertex = |n: u32| {
        let neighbours = [n.checked_sub(1), (n < 100).then_some(n + 1)].into_iter().flatten();
        let names: Vec<_> = neighbours.map(|n| format!("\"a{n}\"")).collect();
        format!("a{n} = [{}]\n", names.join(", "))
    };
    let text = format!("[clockwise]\n{}", (0..=100).map(vertex).collect::<String>());
    fs::write(&file, text).unwrap();
    let long = file.to_str().unwrap();
    let cases: [(&[&str], &str); 8] = [
        (&[], "<WORLD|--random>"),
        (&["worlds/shape-6.toml", "--random"], "cannot be used with"),
        (&["worlds/shape-6.toml", "--edges", "5"], "cannot be used with"),
        (&["--random", "--start", "a:b"], "cannot be used with"),
        (&["--random", "--edges", "9"], "9 is not in 1..=8"),
        (&["--random", "-o", "x.svg"], "the name must end in .html"),
        (&["worlds/shape-6.toml", "--start", "tee"], "--start: "),
        (&[long], "it has 101 vertices; a page can have 100 vertices"),
    ];
    for (options, cause) in cases {
        let output = run([&["play"], options].concat());
        assert_eq!(output.status.code(), Some(2), "{options:?}");
        assert!(stderr(&output).contains(cause), "{options:?}: {}", stderr(&output));
    }
}
