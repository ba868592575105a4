//! The data of the page, as JSON for its script.

use serde_json::{Value, json};
use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    folding,
    format::named_world::NamedWorld,
    mapping::{MapWalk, MappingAlgorithm, MappingEvent},
    percept::Door,
    world::GraphWorld,
};

use crate::page::template::in_script;

/// The world, the start, and the walks to compare with, the shortest possible first.
pub(super) fn json(world: &NamedWorld, facing: Dart) -> String {
    let graph = &world.graph;
    let end = |dart: Dart| json!([graph.vertex(dart).at(), graph.index(dart)]);
    let vertex = |vertex| -> Value {
        graph.darts_of(vertex).map(|dart| end(graph.opposite(dart))).collect()
    };
    let walk = |name: &str, doors: Vec<Door>| {
        let doors: Vec<u32> = doors.into_iter().map(|door| door.0).collect();
        json!({ "name": name, "doors": doors })
    };
    let walk_of = |algorithm: MappingAlgorithm| {
        walk(algorithm.info().title, doors_of(algorithm, graph, facing))
    };
    let data = json!({
        "world": graph.vertices().map(vertex).collect::<Value>(),
        "start": end(facing),
        "walks": [
            walk("Certificate", folding::certificate(graph, facing)),
            walk_of(MappingAlgorithm::Folding),
            walk_of(MappingAlgorithm::Algorithm1),
        ],
    });
    in_script(&data)
}

/// The doors that an algorithm takes until its map is complete.
fn doors_of(algorithm: MappingAlgorithm, graph: &EmbeddedGraph, facing: Dart) -> Vec<Door> {
    let mut doors = Vec::new();
    let mut watch = |_: &mut GraphWorld<'_>, _: &MapWalk, event: MappingEvent| {
        if let MappingEvent::Moved { door, .. } = event {
            doors.push(door);
        }
    };
    let mut world = GraphWorld::new(graph, facing);
    // No world that is a graph contradicts itself or has more darts.
    let _ = algorithm.map_world(&mut world, graph.dart_count(), &mut watch);
    doors
}
