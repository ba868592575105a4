//! `toposlam compare A B`.

use std::{fs, path::Path};

use serde_json::{Value, json};
use toposlam_model::format::{named_world::NamedWorld, world_file};

use super::{folder, objects, read_world, stdout_of, world_files};

#[test]
fn figure_1a_and_figure_1b_are_not_isomorphic_and_not_mirror_images() {
    let files = ["worlds/figure-1a.toml", "worlds/figure-1b.toml"];
    let line = &objects(&stdout_of(["compare", "--json", files[0], files[1]]))[0];
    assert_eq!((&line["isomorphic"], &line["mirror"]), (&false.into(), &false.into()));
    assert_eq!(line["difference"], "genus 0 against 1");
    assert_eq!(line["differing"], json!({"what": "genus", "degree": null, "counts": [0, 1]}));
    let text = stdout_of(["compare", files[0], files[1]]);
    assert!(text.contains("\nnot isomorphic: genus 0 against 1\nnot mirror images\n"), "{text}");
}

#[test]
fn a_building_is_the_same_with_and_without_its_corners_if_these_are_left_out() {
    for name in ["aces", "seattle"] {
        let files =
            [name, &format!("{name}-corners")].map(|name| format!("worlds/real/{name}.toml"));
        let compare = |options: &[&str]| {
            let files = [&*files[0], &*files[1], "--marker", "none"];
            let text = stdout_of([&["compare", "--json"], &files[..], options].concat());
            objects(&text).remove(0)["isomorphic"].clone()
        };
        assert_eq!((compare(&[]), compare(&["--smooth-corners"])), (false.into(), true.into()));
    }
}

#[test]
fn a_world_is_isomorphic_to_itself_by_a_bijection_of_all_edge_ends() {
    for path in world_files() {
        let file = path.to_str().unwrap();
        let line = &objects(&stdout_of(["compare", "--json", file, file]))[0];
        assert_eq!(line["isomorphic"], true, "{file}");
        let pairs = line["bijection"].as_array().unwrap();
        assert_eq!(pairs.len(), read_world(&path).graph.dart_count());
    }
}

#[test]
fn a_world_is_the_mirror_image_of_its_mirror_image() {
    let folder = folder("compare_mirror");
    let mut chiral = 0;
    for path in world_files() {
        let world = read_world(&path);
        let mirror = folder.join("mirror.toml");
        let image = NamedWorld::numbered("mirror", "", world.graph.mirror_image(), None);
        fs::write(&mirror, world_file::to_toml(&image)).unwrap();
        let files = [path.to_str().unwrap(), mirror.to_str().unwrap()];
        let line = &objects(&stdout_of(["compare", "--json", files[0], files[1]]))[0];
        assert_eq!(line["mirror"], true, "{}", files[0]);
        chiral += usize::from(line["isomorphic"] == false);
    }
    assert!(chiral > 0, "no world differs from its mirror image");
}

const FIGURE_1: [&str; 2] = ["worlds/figure-1a.toml", "worlds/figure-1b.toml"];
const CYCLES: [&str; 2] = ["worlds/cycle-3.toml", "worlds/cycle-4.toml"];

fn compared(files: [&str; 2], more: &[&str]) -> Value {
    let arguments = [&["compare", "--json"], &files[..], more].concat();
    objects(&stdout_of(arguments)).remove(0)
}

#[test]
fn an_undirected_marker_does_not_distinguish_the_worlds_of_figure_1() {
    let line = compared(FIGURE_1, &["--marker", "undirected"]);
    assert_eq!((&line["marker"], &line["distinguishable"]), (&"undirected".into(), &false.into()));
    assert_eq!(line["walk"], Value::Null);
    let relation = line["relation"].as_array().unwrap();
    assert_eq!(relation.len(), 32);
    assert_eq!(relation[0], json!(["x:0", "X:0"]));
    assert_eq!(relation[1], json!(["a:1", "A:1"]));
    let text = stdout_of(["compare", FIGURE_1[0], FIGURE_1[1], "--marker", "undirected"]);
    let verdict = "\nNo walk distinguishes the worlds from x:a in A and X:A in B. ";
    assert!(text.contains(verdict), "{text}");
    assert!(text.contains("  x:0~X:0  a:1~A:1  "), "{text}");
}

#[test]
fn a_directional_marker_distinguishes_the_worlds_of_figure_1_and_is_the_default() {
    let line = compared(FIGURE_1, &["--marker", "directional"]);
    assert_eq!((&line["distinguishable"], &line["relation"]), (&true.into(), &Value::Null));
    assert_eq!((&line["walk"], &line["walks"]), (&json!([0, 1, 1]), &json!([[0, 1, 1]])));
    assert_eq!(compared(FIGURE_1, &[]), line);
    let text = stdout_of(["compare", FIGURE_1[0], FIGURE_1[1]]);
    let end = "the walk 0,1,1 distinguishes the worlds:\n  A: 4 doors, marker along door 1\n  \
               B: 4 doors, marker along door 3\n";
    assert!(text.ends_with(end), "{text}");
}

/// The marker is placed once. The pose in B varies over those that the marker cannot distinguish.
#[test]
fn the_robot_in_b_starts_at_each_pose_that_the_marker_cannot_distinguish() {
    for (marker, starts) in [
        ("none", 8),
        ("undirected", 2),
        ("directional", 1),
        ("undirected-edge", 2),
        ("directed-edge", 2),
        ("two-identical", 4),
        ("two-distinct", 2),
        ("movable", 2),
    ] {
        let line = compared(CYCLES, &["--marker", marker]);
        assert_eq!(line["starts"].as_array().unwrap().len(), starts, "{marker}");
        assert_eq!(line["walks"].as_array().unwrap().len(), starts, "{marker}");
        assert_eq!(line["distinguishable"], marker != "none", "{marker}");
        assert_eq!(line["starts"][0], "v0:v1");
        let both = ["--marker", marker, "--start", "v1:v2", "--start", "v3:v0"];
        let line = compared(CYCLES, &both);
        assert_eq!((&line["start"], &line["starts"]), (&"v1:v2".into(), &json!(["v3:v0"])));
    }
}

#[test]
fn a_movable_marker_is_handled_in_walks_and_named_in_states() {
    let line = compared(FIGURE_1, &["--marker", "movable"]);
    assert_eq!(line["walk"], json!(["pick-up", 0, "drop", 0, 1, 1]));
    let file = "worlds/theta-plane.toml";
    let line = compared([file, file], &["--marker", "movable"]);
    let relation = line["relation"].as_array().unwrap();
    // 6 poses, and the marker at one of two vertices or carried.
    assert_eq!(relation.len(), 18);
    assert_eq!(relation[0], json!(["u:0@u", "u:0@u"]));
    assert!(relation.contains(&json!(["u:0+marker", "u:0+marker"])));
}

#[test]
fn a_walk_is_replayed_percept_by_percept() {
    let line = compared(FIGURE_1, &["--walk", "0,1,1"]);
    let percepts = line["walked"]["percepts"].as_array().unwrap();
    let centre =
        |door: u32| json!({ "degree": 4, "sighting": format!("marker along door {door}") });
    assert_eq!(percepts.len(), 4);
    assert_eq!(percepts[0], json!([centre(0), centre(0)]));
    assert_eq!(percepts[3], json!([centre(1), centre(3)]));
    let text =
        stdout_of(["compare", CYCLES[0], CYCLES[1], "--marker", "undirected", "--walk", "1, 1,1"]);
    let rows: Vec<_> = text.lines().rev().take(4).collect();
    assert!(rows[0].contains("2 doors, marker  "), "{text}");
    assert!(rows[0].ends_with("  <- differs"), "{text}");
    assert!(!rows[1].contains("differs") && rows[3].starts_with("  start  "), "{text}");
}

#[test]
fn worlds_without_starts_are_still_compared() {
    let folder = folder("compare_no_start");
    let file = folder.join("path.toml");
    fs::write(&file, "[clockwise]\na = [\"b\"]\nb = [\"a\", \"c\"]\nc = [\"b\"]\n").unwrap();
    let files = [file.to_str().unwrap(); 2];
    let line = compared(files, &[]);
    assert_eq!((&line["isomorphic"], &line["marker"]), (&true.into(), &Value::Null));
    assert_eq!(compared(files, &["--marker", "none"])["distinguishable"], false);
    let starts = ["--marker", "movable", "--start", "a:b", "--start", "b:a"];
    assert_eq!(compared(files, &starts)["walk"], json!([]));
}

#[test]
fn a_page_for_walking_is_written() {
    let folder = folder("compare_page");
    let page = folder.join("page.html");
    let files = [FIGURE_1[0], FIGURE_1[1], "--html", page.to_str().unwrap()];
    stdout_of([&["compare"], &files[..]].concat());
    let page = fs::read_to_string(&page).unwrap();
    assert!(page.contains("<title>figure-1a and figure-1b, directional marker</title>"));
    assert!(page.contains("\"walk\":[\"0\",\"1\",\"1\"]"));
    let namespace = "http://www.w3.org/2000/svg";
    assert!(!page.replace(namespace, "").contains("://"), "nothing is asked of the network");
}

/// The chain a-b-c-d with a start.
fn chain(folder: &Path, name: &str, start: [&str; 2]) -> String {
    let file = folder.join(format!("{name}.toml"));
    let [at, facing] = start;
    let orders = "a = [\"b\"]\nb = [\"a\", \"c\"]\nc = [\"b\", \"d\"]\nd = [\"c\"]\n";
    let start = format!("[start]\nat = \"{at}\"\nfacing = \"{facing}\"\n");
    fs::write(&file, format!("[clockwise]\n{orders}{start}")).unwrap();
    file.to_str().unwrap().to_owned()
}

/// The relation, the walk and the page begin at the first start that no walk distinguishes.
#[test]
fn the_robot_in_b_starts_where_no_walk_distinguishes_the_worlds() {
    let folder = folder("compare_chain");
    let files = [chain(&folder, "end", ["a", "b"]), chain(&folder, "middle", ["b", "c"])];
    let files = files.each_ref().map(String::as_str);
    let page = folder.join("page.html");
    let more = ["--marker", "none", "--walk", "0,1", "--html", page.to_str().unwrap()];
    let line = compared(files, &more);
    assert_eq!((&line["distinguishable"], &line["starts"][0]), (&false.into(), &"b:c".into()));
    assert_eq!(line["walks"][0], json!([]));
    assert_eq!(line["relation_starts"], json!(["a:b", "a:b"]));
    assert_eq!(line["walked"]["starts"], json!(["a:b", "a:b"]));
    assert_eq!(line["relation"][0], json!(["a:0", "a:0"]));
    let page = fs::read_to_string(&page).unwrap();
    assert!(page.contains("From a:b in A and a:b in B no walk distinguishes these worlds"));
    // With both starts given, there is no other one.
    let both = ["--start", "a:b", "--start", "b:c"];
    let line = compared(files, &[&more[..4], &both[..]].concat());
    assert_eq!((&line["distinguishable"], &line["walk"]), (&true.into(), &json!([])));
    // A single start is for A; the pose in B varies.
    let line = compared(files, &["--marker", "none", "--start", "d:c"]);
    assert_eq!((&line["start"], &line["distinguishable"]), (&"d:c".into(), &false.into()));
    assert_eq!(line["starts"].as_array().unwrap().len(), 6);
}

#[test]
fn a_walk_goes_as_far_as_both_robots_can() {
    let files = [FIGURE_1[0], CYCLES[0]];
    let line = compared(files, &["--marker", "none", "--walk", "0,2,1"]);
    assert_eq!(line["walked"]["actions"], json!([0]));
    assert_eq!(line["walked"]["stopped"], "door 2 was taken at a vertex with 2 doors, in B");
    assert_eq!(line["walked"]["stopped_in"], "B");
    let text = stdout_of(["compare", files[0], files[1], "--marker", "none", "--walk", "0,2,1"]);
    let end = "3 doors             2 doors             <- differs\n  \
               stopped: door 2 was taken at a vertex with 2 doors, in B\n";
    assert!(text.ends_with(end), "{text}");
}

/// A world file of a cycle.
fn cycle(folder: &Path, edges: usize) -> String {
    let file = folder.join(format!("cycle-{edges}.toml"));
    let line = |vertex: usize| {
        let (last, next) = ((vertex + edges - 1) % edges, (vertex + 1) % edges);
        format!("v{vertex} = [\"v{last}\", \"v{next}\"]\n")
    };
    let lines: String = (0..edges).map(line).collect();
    fs::write(&file, format!("[clockwise]\n{lines}")).unwrap();
    file.to_str().unwrap().to_owned()
}

/// Without a marker, two robots in cycles of coprime lengths `n` and `m` reach `2 n m` pairs of poses.
#[test]
fn for_many_pairs_of_states_the_proof_is_the_classes_of_states() {
    let folder = folder("compare_cycles");
    let files = [300, 301].map(|edges| cycle(&folder, edges));
    let page = folder.join("page.html").to_str().unwrap().to_owned();
    let more = ["--marker", "none", "--html", &page];
    let line = compared([&files[0], &files[1]], &more);
    assert_eq!((&line["distinguishable"], &line["relation"]), (&false.into(), &Value::Null));
    let classes = line["classes"].as_array().unwrap();
    let [class] = &classes[..] else { panic!("{line}") };
    let sizes = [0, 1].map(|side| class[side].as_array().unwrap().len());
    assert_eq!(sizes, [2 * 300, 2 * 301]);
    assert_eq!(line["starts"].as_array().unwrap().len(), 2 * 301);
    let text = stdout_of(["compare", &files[0], &files[1], "--marker", "none"]);
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let verdict = "The robots can be in more than 100,000 pairs of states. Two states of one class are \
                   indistinguishable, and each action leads from them to states of one class. There is 1 \
                   class: 1 600 states of A (v0:0, ...) and 602 states of B (v0:0, ...)";
    assert!(text.contains(verdict), "{text}");
    assert!(fs::read_to_string(page).unwrap().contains("\"relation\":null"));
    // Few pairs are listed.
    assert_eq!(compared(CYCLES, &["--marker", "none"])["classes"], Value::Null);
}
