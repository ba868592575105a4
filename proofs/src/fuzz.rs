//! Bodies for fuzzers: for each parser, and for Algorithm 1, what must hold for any bytes.
//!
//! A target of cargo-fuzz in `fuzz/` runs each body, and so does `tests/fuzz.rs` on stable Rust, with the
//! seeds in `fuzz/corpus/` and mutations of them. A body panics if its property does not hold.

use std::fmt;

use toposlam_model::{
    embedded_graph::EmbeddedGraph,
    format::{
        named_world::NamedWorld,
        plantri::{self, PlantriCode},
        world_file,
    },
};

use crate::{
    bytes::Bytes,
    choose::Stop,
    definition::{is_simple, is_world},
    lemmas::{decoders, mapping::the_theorem},
    odometer::listed,
};

/// The name of a target in `fuzz/` and of the folder of its seeds, and its body.
pub type FuzzTarget = (&'static str, fn(&[u8]));

pub const TARGETS: &[FuzzTarget] = &[
    ("world_file", world_file),
    ("planar_code", planar_code),
    ("edge_code", edge_code),
    ("mapping", mapping),
];

/// What a lemma returns, if it holds.
fn holding<T>(case: Result<T, Stop>, of: &dyn fmt::Debug) -> T {
    case.unwrap_or_else(|stop| panic!("{stop:?}: {of:?}"))
}

/// Any bytes give a world or an error of one line. A world, written as TOML or as JSON, reads as the same
/// world.
///
/// # Panics
/// Panics if that does not hold.
pub fn world_file(bytes: &[u8]) {
    let world = match world_file::read(bytes) {
        Ok(world) => world,
        Err(error) => return assert_is_a_message(&error),
    };
    assert!(is_world(&world.graph), "{world:?} is no world");
    assert_is_named(&world);
    holding(decoders::is_read_as_written(&world), &world);
    let json = world_file::to_json(&world).to_string();
    assert!(world_file::read(json.as_bytes()).as_ref() == Ok(&world), "{world:?} in one line");
}

/// Any bytes, read as `planar_code`, give worlds, and then the end or an error with its place. The worlds,
/// written again, read as the same worlds.
///
/// # Panics
/// Panics if that does not hold.
pub fn planar_code(bytes: &[u8]) {
    let worlds = read(bytes, PlantriCode::Planar);
    // In this code a world has one representation, if its numbers have one byte.
    let is_header = bytes.starts_with(b">>");
    if let (Some(first), Some(1..), false) = (worlds.first(), bytes.first(), is_header) {
        let written = plantri::write(std::slice::from_ref(first), PlantriCode::Planar);
        let body = written.as_deref().ok().and_then(|file| file.strip_prefix(b">>planar_code<<"));
        assert!(body.is_some_and(|body| bytes.starts_with(body)), "{first:?} is written otherwise");
    }
}

/// The same for `edge_code`.
///
/// # Panics
/// Panics if that does not hold.
pub fn edge_code(bytes: &[u8]) {
    read(bytes, PlantriCode::Edge);
}

/// Algorithm 1 maps every world of up to 24 edges correctly, with any choices at lines 5 and 9.
///
/// # Panics
/// Panics if it does not.
pub fn mapping(bytes: &[u8]) {
    let mut choose = Bytes::new(bytes.to_vec());
    let case = the_theorem::<_, 1, 24>(&mut choose);
    holding(case, &format_args!("choices {}", listed(choose.choices())));
}

/// The worlds of a plantri file, up to the first error: each is valid, and written in each code that can
/// represent it, it reads as the same world.
fn read(bytes: &[u8], code: PlantriCode) -> Vec<EmbeddedGraph> {
    let (worlds, error) = holding(decoders::worlds(bytes, code), &bytes);
    error.iter().for_each(assert_is_a_message);
    for code in [PlantriCode::Planar, PlantriCode::Edge] {
        match plantri::write(&worlds, code) {
            Ok(file) if worlds.is_empty() => {
                assert!(plantri::read(&file).all(|result| result.is_err()), "nothing is a world");
            }
            Ok(file) => holding(decoders::reads_as(&file, &worlds), &worlds),
            Err(error) => {
                assert_is_a_message(&error);
                assert!(code == PlantriCode::Planar, "edge_code represents every world: {error}");
                let is_planar_code = |graph: &EmbeddedGraph| is_simple(graph) && is_small(graph);
                assert!(
                    !worlds.iter().all(is_planar_code),
                    "planar_code represents these: {error}"
                );
            }
        }
    }
    worlds
}

/// One line that a person can read.
fn assert_is_a_message(error: &impl fmt::Display) {
    let message = error.to_string();
    assert!(!message.is_empty(), "an error says nothing");
    assert!(!message.contains(char::is_control), "a message has control characters: {message:?}");
}

/// Every vertex has a different name; every edge has a name, or none has and the world is simple; the
/// start is a dart, and its text names it.
fn assert_is_named(world: &NamedWorld) {
    let NamedWorld { graph, vertex_names, edge_names, .. } = world;
    assert_eq!(vertex_names.len(), graph.vertex_count(), "every vertex has a name");
    let mut names: Vec<_> = vertex_names.iter().collect();
    names.sort_unstable();
    assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "{names:?} are different");
    match edge_names {
        None => assert!(is_simple(graph), "neighbours do not represent {graph:?}"),
        Some(edges) => {
            assert_eq!(edges.len(), graph.dart_count(), "every dart has its edge's name");
            let mut named: Vec<_> = graph.edges().map(|(dart, _)| &edges[dart.at()]).collect();
            named.sort_unstable();
            assert!(named.windows(2).all(|pair| pair[0] != pair[1]), "{named:?} are different");
            for (dart, other) in graph.edges() {
                assert_eq!(edges[dart.at()], edges[other.at()], "both ends have the edge's name");
            }
        }
    }
    if let Some(start) = world.start {
        assert!(start.at() < graph.dart_count(), "{start:?} is a dart");
        assert_eq!(
            world.start_from_text(&world.start_text(start)),
            Ok(start),
            "a start has a text"
        );
    }
    let junctions = world.plan.as_ref().map(|plan| plan.junctions().len());
    let positions = world.positions.as_ref().map(Vec::len);
    assert_eq!(junctions, positions, "every junction of a plan has its position");
    assert!(junctions.is_none_or(|count| count == graph.vertex_count()), "junctions are vertices");
}

/// Two bytes number its vertices.
fn is_small(graph: &EmbeddedGraph) -> bool {
    u16::try_from(graph.vertex_count()).is_ok()
}
