//! `toposlam compare A B`. Most facts are in `tests/facts/compare.txt`.

use serde_json::json;
use toposlam_model::format::{named_world::NamedWorld, world_file};

use super::{Scratch, read_world, world_files};

#[test]
fn a_world_is_isomorphic_to_itself_and_the_mirror_image_of_its_mirror_image() {
    let scratch = Scratch::new("compare_mirror");
    let mut chiral = 0;
    for path in world_files() {
        let (file, world) = (path.to_str().unwrap(), read_world(&path));
        let image = NamedWorld::numbered("mirror", "", world.graph.mirror_image(), None);
        scratch.write("mirror.toml", world_file::to_toml(&image));
        // The bijection is one of all edge ends.
        let itself = json!({ "isomorphic": true, "bijection.#": world.graph.dart_count() });
        scratch.fact(&format!("compare {file} {file}"), 0, &itself);
        let line = scratch.last(&format!("compare {file} mirror.toml"), 0);
        assert_eq!(line["mirror"], true, "{file}");
        chiral += usize::from(line["isomorphic"] == false);
    }
    assert!(chiral > 0, "no world differs from its mirror image");
}

#[test]
fn a_relation_has_the_marker_that_is_carried() {
    let thetas = "compare worlds/theta-plane.toml worlds/theta-plane.toml --marker movable";
    let relation = &Scratch::new("compare_carried").last(thetas, 0)["relation"];
    assert!(relation.as_array().unwrap().contains(&json!(["u:0+marker", "u:0+marker"])));
}
