//! The data of the page, as JSON for its script.

use serde_json::{Value, json};
use toposlam_model::{
    aid::Action,
    aid::AidKind,
    embedded_graph::{Dart, EmbeddedGraph},
    folding,
    format::named_world::NamedWorld,
    mapping::{MapWalk, MappingAlgorithm, MappingEvent},
    marker::Directional,
    world::GraphWorld,
};

use super::facing_of;
use crate::page::{
    graph_json::{dart_json, graph_json},
    template::in_script,
};

pub(super) fn json(games: &[NamedWorld], marker: AidKind) -> String {
    let games = games.iter().map(|world| game(world, marker)).collect::<Vec<_>>();
    in_script(&json!({ "marker": marker.name(), "games": games }))
}

/// The world, the start, and the walks to compare with: the certificate, if there is one, and those of the algorithms
/// that map with this marker.
fn game(world: &NamedWorld, marker: AidKind) -> Value {
    let (graph, facing) = (&world.graph, facing_of(world));
    let certificate = (marker == Directional.into()).then(|| {
        let doors = folding::certificate(graph, facing);
        walk("Certificate", &doors.into_iter().map(Action::Take).collect::<Vec<_>>(), true)
    });
    let algorithms: Vec<_> =
        MappingAlgorithm::all().filter(|algorithm| algorithm.aid() == marker).collect();
    let runs = algorithms.into_iter().rev().filter_map(|algorithm| {
        Some(walk(algorithm.info().title, &actions_of(algorithm, marker, graph, facing)?, false))
    });
    json!({
        "name": world.name,
        "world": graph_json(graph),
        "start": dart_json(graph, facing),
        "walks": certificate.into_iter().chain(runs).collect::<Vec<_>>(),
    })
}

fn walk(name: &str, actions: &[Action], is_shortest: bool) -> Value {
    let actions: Vec<_> = actions.iter().map(ToString::to_string).collect();
    json!({ "name": name, "actions": actions, "isShortest": is_shortest })
}

/// The actions of an algorithm until its map is complete; `None` if its marker does not suffice.
fn actions_of(
    algorithm: MappingAlgorithm,
    marker: AidKind,
    graph: &EmbeddedGraph,
    facing: Dart,
) -> Option<Vec<Action>> {
    if algorithm.needs_simple() && !graph.is_simple() {
        return None;
    }
    let mut actions = Vec::new();
    let mut watch = |_: &mut GraphWorld<'_, AidKind>, _: &MapWalk, event: MappingEvent| {
        actions.extend(event.action());
    };
    let mut world = GraphWorld::with_aid(graph, marker, facing);
    // No world that is a graph contradicts itself or has more darts.
    let _ = algorithm.map_world(&mut world, graph.dart_count(), &mut watch);
    Some(actions)
}
