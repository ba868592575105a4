//! `toposlam compare A B`.

use serde_json::json;
use toposlam_model::format::{named_world::NamedWorld, world_file};

use super::{Scratch, read_world, world_files};

const FIGURE_1: &str = "compare worlds/figure-1a.toml worlds/figure-1b.toml";
const CYCLES: &str = "compare worlds/cycle-3.toml worlds/cycle-4.toml";

#[test]
fn facts_of_comparisons() {
    let scratch = Scratch::new("compare_facts");
    scratch.write("path.toml", "[clockwise]\na = [\"b\"]\nb = [\"a\", \"c\"]\nc = [\"b\"]\n");
    let undirected = format!("{FIGURE_1} --marker undirected");
    let directional = format!("{FIGURE_1} --marker directional");
    let movable = format!("{FIGURE_1} --marker movable");
    let walked = format!("{FIGURE_1} --walk 0,1,1");
    let few_pairs = format!("{CYCLES} --marker none");
    let centre =
        |door: u32| json!({ "degree": 4, "sighting": format!("marker along door {door}") });
    scratch.facts(&[
        (FIGURE_1, 0, json!({
            "isomorphic": false, "mirror": false, "difference": "genus 0 against 1",
            "differing": {"what": "genus", "degree": null, "counts": [0, 1]},
        })),
        (&undirected, 0, json!({
            "marker": "undirected", "distinguishable": false, "walk": null, "relation.#": 32,
            "relation.0": ["x:0", "X:0"], "relation.1": ["a:1", "A:1"],
        })),
        (&directional, 0, json!({
            "distinguishable": true, "relation": null, "walk": [0, 1, 1], "walks": [[0, 1, 1]],
        })),
        // The marker is handled in walks, and named in states: 6 poses, and the marker at one of two vertices
        // or carried.
        (&movable, 0, json!({ "walk": ["pick-up", 0, "drop", 0, 1, 1] })),
        ("compare worlds/theta-plane.toml worlds/theta-plane.toml --marker movable", 0,
            json!({ "relation.#": 18, "relation.0": ["u:0@u", "u:0@u"] })),
        (&walked, 0, json!({
            "walked.percepts.#": 4, "walked.percepts.0": [centre(0), centre(0)],
            "walked.percepts.3": [centre(1), centre(3)],
        })),
        // A walk goes as far as both robots can.
        ("compare worlds/figure-1a.toml worlds/cycle-3.toml --marker none --walk 0,2,1", 0, json!({
            "walked.actions": [0], "walked.stopped_in": "B",
            "walked.stopped": "door 2 was taken at a vertex with 2 doors, in B",
        })),
        // Few pairs are listed, not classes.
        (&few_pairs, 0, json!({ "classes": null })),
        // Worlds without starts.
        ("compare path.toml path.toml", 0, json!({ "isomorphic": true, "marker": null })),
        ("compare path.toml path.toml --marker none", 0, json!({ "distinguishable": false })),
        ("compare path.toml path.toml --marker movable --start a:b --start b:a", 0,
            json!({ "walk": [] })),
        // Corners can be left out.
        ("compare worlds/real/aces.toml worlds/real/aces-corners.toml --marker none", 0,
            json!({ "isomorphic": false })),
        ("compare worlds/real/aces.toml worlds/real/aces-corners.toml --marker none --smooth-corners",
            0, json!({ "isomorphic": true })),
        ("compare worlds/real/seattle.toml worlds/real/seattle-corners.toml --marker none", 0,
            json!({ "isomorphic": false })),
        ("compare worlds/real/seattle.toml worlds/real/seattle-corners.toml --marker none \
          --smooth-corners", 0, json!({ "isomorphic": true })),
    ]);
    // The directional marker is the default.
    assert_eq!(scratch.last(FIGURE_1, 0), scratch.last(&directional, 0));
    let relation = &scratch
        .last("compare worlds/theta-plane.toml worlds/theta-plane.toml --marker movable", 0)["relation"];
    assert!(relation.as_array().unwrap().contains(&json!(["u:0+marker", "u:0+marker"])));
}

#[test]
fn a_world_is_isomorphic_to_itself_and_the_mirror_image_of_its_mirror_image() {
    let scratch = Scratch::new("compare_mirror");
    let mut chiral = 0;
    for path in world_files() {
        let file = path.to_str().unwrap();
        let line = scratch.last(&format!("compare {file} {file}"), 0);
        assert_eq!(line["isomorphic"], true, "{file}");
        let world = read_world(&path);
        // The bijection is one of all edge ends.
        assert_eq!(line["bijection"].as_array().unwrap().len(), world.graph.dart_count());
        let image = NamedWorld::numbered("mirror", "", world.graph.mirror_image(), None);
        scratch.write("mirror.toml", world_file::to_toml(&image));
        let line = scratch.last(&format!("compare {file} mirror.toml"), 0);
        assert_eq!(line["mirror"], true, "{file}");
        chiral += usize::from(line["isomorphic"] == false);
    }
    assert!(chiral > 0, "no world differs from its mirror image");
}

/// The marker is placed once. The pose in B varies over those that the marker cannot distinguish.
#[test]
fn the_robot_in_b_starts_at_each_pose_that_the_marker_cannot_distinguish() {
    let scratch = Scratch::new("compare_starts");
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
        let compare = format!("{CYCLES} --marker {marker}");
        let both = format!("{compare} --start v1:v2 --start v3:v0");
        scratch.facts(&[
            (
                &compare,
                0,
                json!({
                    "starts.#": starts, "walks.#": starts, "distinguishable": marker != "none",
                    "starts.0": "v0:v1",
                }),
            ),
            (&both, 0, json!({ "start": "v1:v2", "starts": ["v3:v0"] })),
        ]);
    }
}

#[test]
fn a_page_for_walking_is_written() {
    let scratch = Scratch::new("compare_page");
    scratch.out(&format!("{FIGURE_1} --html page.html"), 0);
    let page = scratch.text("page.html");
    assert!(page.contains("<title>figure-1a and figure-1b, directional marker</title>"));
    assert!(page.contains("\"walk\":[\"0\",\"1\",\"1\"]"));
    let namespace = "http://www.w3.org/2000/svg";
    assert!(!page.replace(namespace, "").contains("://"), "nothing is asked of the network");
}

/// The relation, the walk and the page begin at the first start that no walk distinguishes.
#[test]
fn the_robot_in_b_starts_where_no_walk_distinguishes_the_worlds() {
    let scratch = Scratch::new("compare_chain");
    for (name, at, facing) in [("end", "a", "b"), ("middle", "b", "c")] {
        let orders = "a = [\"b\"]\nb = [\"a\", \"c\"]\nc = [\"b\", \"d\"]\nd = [\"c\"]\n";
        let start = format!("[start]\nat = \"{at}\"\nfacing = \"{facing}\"\n");
        scratch.write(&format!("{name}.toml"), format!("[clockwise]\n{orders}{start}"));
    }
    scratch.facts(&[
        (
            "compare end.toml middle.toml --marker none --walk 0,1 --html page.html",
            0,
            json!({
                "distinguishable": false, "starts.0": "b:c", "walks.0": [],
                "relation_starts": ["a:b", "a:b"], "walked.starts": ["a:b", "a:b"],
                "relation.0": ["a:0", "a:0"],
            }),
        ),
        // With both starts given, there is no other one.
        (
            "compare end.toml middle.toml --marker none --start a:b --start b:c",
            0,
            json!({ "distinguishable": true, "walk": [] }),
        ),
        // A single start is for A; the pose in B varies.
        (
            "compare end.toml middle.toml --marker none --start d:c",
            0,
            json!({ "start": "d:c", "distinguishable": false, "starts.#": 6 }),
        ),
    ]);
    let page = scratch.text("page.html");
    assert!(page.contains("From a:b in A and a:b in B no walk distinguishes these worlds"));
}

/// Without a marker, two robots in cycles of coprime lengths `n` and `m` reach `2 n m` pairs of poses.
#[test]
fn for_many_pairs_of_states_the_proof_is_the_classes_of_states() {
    let scratch = Scratch::new("compare_cycles");
    for edges in [300, 301] {
        let line = |v: usize| {
            format!("v{v} = [\"v{}\", \"v{}\"]\n", (v + edges - 1) % edges, (v + 1) % edges)
        };
        let lines: String = (0..edges).map(line).collect();
        scratch.write(&format!("cycle-{edges}.toml"), format!("[clockwise]\n{lines}"));
    }
    let compare = "compare cycle-300.toml cycle-301.toml --marker none";
    scratch.facts(&[(
        &format!("{compare} --html page.html"),
        0,
        json!({
            "distinguishable": false, "relation": null, "classes.#": 1,
            "classes.0.0.#": 2 * 300, "classes.0.1.#": 2 * 301, "starts.#": 2 * 301,
        }),
    )]);
    let text = scratch.out(compare, 0);
    assert!(
        text.contains("\n    1  600 states of A (v0:0, ...) and 602 states of B (v0:0, ...)"),
        "{text}"
    );
    assert!(scratch.text("page.html").contains("\"relation\":null"));
}
