//! The data of the page, as JSON for its script.

use serde_json::{Value, json};
use toposlam_model::{
    aid::{AIDS, Aid, AidKind},
    embedded_graph::Dart,
    format::named_world::NamedWorld,
};

use super::WalkPage;
use crate::page::{
    graph_json::{dart_json, graph_json},
    template::in_script,
};

/// The data as JSON that can stand inside a `script` element.
pub(super) fn json(page: &WalkPage) -> String {
    let is_seen = |aid: &AidKind| page.worlds.iter().all(|it| aid.is_seen_everywhere(&it.graph));
    let aids = AIDS.into_iter().filter(is_seen);
    let markers: Vec<_> =
        aids.map(|aid| json!({ "name": aid.name(), "about": aid.about() })).collect();
    let sides = [0, 1].map(|at| side(page.worlds[at], page.facings[at]));
    in_script(&json!({
        "marker": page.marker.name(),
        "markers": markers,
        "sides": sides,
        "pose": dart_json(&page.worlds[1].graph, page.pose),
    }))
}

/// A world for the scripts, with the dart that places the marker.
pub(in crate::page) fn side(world: &NamedWorld, facing: Dart) -> Value {
    let graph = &world.graph;
    json!({
        "name": world.name,
        "world": graph_json(graph),
        "facing": dart_json(graph, facing),
        "vertices": world.vertex_names,
        "edges": world.edge_names,
        "facings": graph.darts().map(|dart| world.facing_text(dart)).collect::<Vec<_>>(),
    })
}
