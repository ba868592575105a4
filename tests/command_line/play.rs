//! `play`: the page of a world or of a random one.

use std::collections::BTreeSet;

use super::Scratch;

/// The data of the page of a random world.
fn random(scratch: &Scratch, options: &str) -> String {
    let page = scratch.out(&format!("play --random {options}"), 0);
    let (_, data) = page.split_once("id=\"data\">").unwrap();
    data.split_once("</script>").unwrap().0.to_owned()
}

#[test]
fn a_random_world_is_the_same_for_the_same_seed_and_each_start_may_be_one() {
    let scratch = Scratch::new("play_random");
    assert_eq!(random(&scratch, "--seed 5"), random(&scratch, "--seed 5"));
    let seeds: BTreeSet<_> = (0..60)
        .map(|seed| random(&scratch, &format!("--edges 2 --class multigraph --seed {seed}")))
        .collect();
    // A000698: there are 10 starts with 2 edges.
    assert_eq!(seeds.len(), 10);
    let largest: serde_json::Value = serde_json::from_str(&random(&scratch, "--edges 8")).unwrap();
    let world = largest["world"].as_array().unwrap();
    assert_eq!(world.iter().map(|vertex| vertex.as_array().unwrap().len()).sum::<usize>(), 16);
}

#[test]
fn a_page_is_a_file_or_standard_output() {
    let scratch = Scratch::new("play_page");
    let play = "play worlds/shape-6.toml --start tee:sw";
    let printed = scratch.out(play, 0);
    assert_eq!(scratch.out(&format!("{play} -o play.html"), 0), "");
    assert_eq!(scratch.text("play.html"), printed);
    assert!(printed.starts_with("<!doctype html>") && printed.ends_with("</html>\n"));
    let vertex = |n: u32| {
        let neighbours = [n.checked_sub(1), (n < 100).then_some(n + 1)].into_iter().flatten();
        let names: Vec<_> = neighbours.map(|n| format!("\"a{n}\"")).collect();
        format!("a{n} = [{}]\n", names.join(", "))
    };
    scratch
        .write("long.toml", format!("[clockwise]\n{}", (0..=100).map(vertex).collect::<String>()));
    let message = "error: long.toml: it has 101 vertices; a page can have 100 vertices";
    assert!(scratch.error("play long.toml").starts_with(message));
}
