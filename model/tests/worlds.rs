//! The world files of `worlds/`: each is what its name and its README say.

use toposlam_model::{
    floor_plan::JunctionKind,
    format::{
        named_world::NamedWorld,
        plantri::{self, PlantriCode},
        world_file,
    },
    isomorphism::isomorphism,
};

use crate::{text_of, world, world_names};

/// The worlds of real buildings without corners are those with corners, smoothed; and these are Figure 1(a) and
/// shape 6 of the paper, with the corners of the ring on the rim of the wheel.
#[test]
fn the_real_buildings_are_the_same_with_and_without_corners() {
    for (name, of_paper, size, smooth) in
        [("aces", "figure-1a", (9, 12), (5, 8)), ("seattle", "shape-6", (6, 6), (2, 2))]
    {
        let [bare, cornered] =
            [name, &format!("{name}-corners")].map(|name| world(&format!("real/{name}")));
        assert_eq!((cornered.graph.vertex_count(), cornered.graph.edge_count()), size);
        assert_eq!((bare.graph.vertex_count(), bare.graph.edge_count()), smooth);
        let smoothed = cornered.smoothed();
        assert!(isomorphism(&smoothed.graph, &bare.graph).is_ok(), "{name}");
        let of_paper = world(of_paper).smoothed();
        assert!(isomorphism(&of_paper.graph, &bare.graph).is_ok(), "{name}");
        // The same places have the same positions.
        for (vertex, position) in smoothed.vertex_names.iter().zip(smoothed.positions.unwrap()) {
            let other = bare.vertex_named(vertex).unwrap();
            let expected = bare.positions.as_ref().unwrap()[other.0 as usize];
            assert_eq!(expected.map(f64::to_bits), position.map(f64::to_bits), "{vertex}");
        }
        for world in [&bare, &cornered] {
            assert_eq!(
                world_file::to_toml(world),
                text_of(&format!("worlds/real/{}.toml", world.name))
            );
        }
    }
}

/// Every world has a name, a description and a start, and is written as it was read, also in plantri's codes.
#[test]
fn every_world_is_written_as_it_was_read() {
    let readme = text_of("worlds/README.md");
    for name in world_names() {
        let world = world(&name);
        assert_eq!(world.name, name);
        assert!(!world.about.is_empty() && world.start.is_some(), "{name}");
        assert!(readme.contains(&format!("[{name}]({name}.toml)")), "{name}");

        let file = text_of(&format!("worlds/{name}.toml"));
        assert_eq!(world_file::to_toml(&world), file, "{name} is not as the tools would write it");
        let json = world_file::to_json_text(&world);
        assert_eq!(world_file::read(json.as_bytes()).unwrap(), world);

        let graph = std::slice::from_ref(&world.graph);
        for code in [PlantriCode::Planar, PlantriCode::Edge] {
            match plantri::write(graph, code) {
                Ok(bytes) => {
                    let back: Result<Vec<_>, _> = plantri::read(&bytes).collect();
                    assert_eq!(back.unwrap(), graph, "{name}");
                }
                Err(error) => {
                    assert_eq!(code, PlantriCode::Planar, "{name}: {error}");
                    assert!(!world.graph.is_simple(), "{name}: {error}");
                }
            }
        }
    }
}

#[test]
fn every_world_has_the_size_and_the_genus_that_its_name_says() {
    let sizes: Vec<_> = world_names()
        .into_iter()
        .map(|name| {
            let graph = world(&name).graph;
            let size = (graph.vertex_count(), graph.edge_count(), graph.genus());
            (name, size)
        })
        .collect();
    let expected = [
        ("building-12", (12, 14, 0)),
        ("building-25", (25, 31, 0)),
        ("chain-5", (6, 5, 0)),
        ("cycle-12", (12, 12, 0)),
        ("cycle-3", (3, 3, 0)),
        ("cycle-4", (4, 4, 0)),
        ("figure-1a", (5, 8, 0)),
        ("figure-1b", (5, 8, 1)),
        ("k4-plane", (4, 6, 0)),
        ("k4-torus", (4, 6, 1)),
        ("petersen", (10, 15, 1)),
        ("shape-6", (6, 6, 0)),
        ("shape-8", (6, 7, 0)),
        ("star-5", (6, 5, 0)),
        ("theta-plane", (2, 3, 0)),
        ("theta-torus", (2, 3, 1)),
        ("two-loops-plane", (1, 2, 0)),
        ("two-loops-torus", (1, 2, 1)),
    ]
    .map(|(name, size)| (name.to_owned(), size));
    assert_eq!(sizes, expected);
}

#[test]
fn figure_1_is_one_graph_whose_rim_is_reversed() {
    let (a, b) = (world("figure-1a"), world("figure-1b"));
    for vertex in a.graph.vertices() {
        let around = |world: &NamedWorld, reversed: bool| {
            let mut names: Vec<_> = world
                .graph
                .darts_of(vertex)
                .map(|dart| world.at_text(world.graph.opposite(dart)).to_lowercase())
                .collect();
            if reversed {
                names.reverse();
            }
            let least = names.iter().min().cloned();
            let first = names.iter().position(|name| Some(name) == least.as_ref());
            names.rotate_left(first.unwrap());
            names
        };
        let is_rim = a.vertex_names[vertex.at()] != "x";
        assert_eq!(around(&a, is_rim), around(&b, false));
    }
}

// paper: env.hallways, env.junction-types
#[test]
fn buildings_have_all_three_kinds_of_junction() {
    for (name, kinds) in [
        ("shape-6", [1, 4, 1]),
        ("shape-8", [0, 4, 2]),
        ("building-12", [2, 4, 6]),
        ("building-25", [6, 1, 18]),
    ] {
        let plan = world(name).plan.unwrap();
        let count = |kind| plan.junctions().iter().filter(|j| j.kind == kind).count();
        let counts = [JunctionKind::DeadEnd, JunctionKind::L, JunctionKind::T].map(count);
        assert_eq!(counts, kinds, "{name}");
        assert!((plan.hallway_width() - 1.6).abs() < 1e-12);
    }
}
