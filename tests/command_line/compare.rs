//! `toposlam compare A B`.

use std::fs;

use toposlam_model::format::{named_world::NamedWorld, world_file};

use crate::{folder, objects, read_world, said, world_files};

#[test]
fn figure_1a_and_figure_1b_are_not_isomorphic_and_not_mirror_images() {
    let files = ["worlds/figure-1a.toml", "worlds/figure-1b.toml"];
    let line = &objects(&said(["compare", "--json", files[0], files[1]]))[0];
    assert_eq!((&line["isomorphic"], &line["mirror"]), (&false.into(), &false.into()));
    assert_eq!(line["difference"], "genus 0 against 1");
    let told = said(["compare", files[0], files[1]]);
    assert!(told.ends_with("not isomorphic: genus 0 against 1\nnot mirror images\n"), "{told}");
}

#[test]
fn a_world_is_isomorphic_to_itself_by_a_bijection_of_all_edge_ends() {
    for path in world_files() {
        let file = path.to_str().unwrap();
        let line = &objects(&said(["compare", "--json", file, file]))[0];
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
        let line = &objects(&said(["compare", "--json", files[0], files[1]]))[0];
        assert_eq!(line["mirror"], true, "{}", files[0]);
        chiral += usize::from(line["isomorphic"] == false);
    }
    assert!(chiral > 0, "no world differs from its mirror image");
}
