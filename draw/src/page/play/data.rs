//! The data of the page, as JSON for its script.

use serde_json::{Value, json};
use toposlam_model::{
    check::{Algorithm, Algorithm1, Folding, RunState},
    embedded_graph::{Dart, EmbeddedGraph},
    folding,
    format::named_world::NamedWorld,
    mapping::{Journey, MappingEvent},
    marker::Directional,
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
    let data = json!({
        "world": graph.vertices().map(vertex).collect::<Value>(),
        "start": end(facing),
        "walks": [
            walk("Certificate", folding::certificate(graph, facing)),
            walk(Folding.name(), doors_of(&Folding, graph, facing)),
            walk(Algorithm1.name(), doors_of(&Algorithm1, graph, facing)),
        ],
    });
    in_script(&data)
}

/// The doors that an algorithm takes until its map is complete.
fn doors_of<A: Algorithm<Marker = Directional>>(
    algorithm: &A,
    graph: &EmbeddedGraph,
    facing: Dart,
) -> Vec<Door> {
    let mut doors = Vec::new();
    let mut watch = |_: &mut GraphWorld<'_>, _: &Journey, event: MappingEvent| {
        if let MappingEvent::Moved { door, .. } = event {
            doors.push(door);
        }
    };
    let mut state = A::State::new(graph.dart_count());
    // No world that is a graph contradicts itself or has more darts.
    let _ = algorithm.run(&mut GraphWorld::new(graph, facing), &mut state, &mut watch);
    doors
}
