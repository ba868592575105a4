//! Where one movable marker does not suffice. Section 2.3.

use std::{fmt::Display, path::Path};

use toposlam_model::{
    ambiguity::{AmbiguitySearch, PlacedWorld},
    embedded_graph::EmbeddedGraph,
    enumerate::Class,
    format::named_world::NamedWorld,
    marker::Movable,
};

use super::Failure;

/// Refuses the worlds of a file if one of them has loops or parallel edges.
pub(super) fn check_worlds(path: &Path, graphs: &[EmbeddedGraph]) -> Result<(), Failure> {
    match graphs.iter().position(|graph| !graph.is_simple()) {
        Some(place) => Err(Failure::in_file(path, not_sufficient(format!("world {}", place + 1)))),
        None => Ok(()),
    }
}

/// Why a world, or a class of worlds, is not mapped with a movable marker.
pub(super) fn not_sufficient(what: impl Display) -> String {
    format!(
        "{what} has loops or parallel edges, and with these one movable marker does not suffice: \
         no walk tells {} (toposlam counterexample --marker movable --class multigraph)",
        smallest_pair().unwrap_or_default()
    )
}

/// The smallest two worlds that no robot with one movable marker can tell apart, in words.
fn smallest_pair() -> Option<String> {
    // It has two edges; with three the search still takes no time.
    let findings = AmbiguitySearch::new(Class::Multigraph, 3, &Movable).ok()?.run(&()).ok()?;
    let [one, other] = findings.smallest()?.map(described);
    Some(format!("{one} from {other}"))
}

/// Each vertex with its edges in clockwise order.
fn described(world: &PlacedWorld) -> String {
    let world = NamedWorld::numbered("", "", world.graph.clone(), Some(PlacedWorld::FACING));
    let vertex = |vertex| {
        let edges: Vec<_> = world.graph.darts_of(vertex).map(|dart| world.leads_to(dart)).collect();
        format!("{} = {}", world.vertex_names[vertex.at()], edges.join(" "))
    };
    let vertices: Vec<_> = world.graph.vertices().map(vertex).collect();
    format!("[{}]", vertices.join(", "))
}
