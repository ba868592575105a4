//! The smallest world that explains a walk with any marker that identifies vertices.

use super::{FoldedTrail, MarkedTrails, SearchLimit, SmallestWorld, WorldSearch, smallest};
use crate::{embedded_graph::EmbeddedGraph, enumerate::Watch};

/// Finds the world of a class with the fewest edges that explains the walk of a trail: a robot from some
/// start in it, with the directional or an undirected marker somewhere or without one, has the percepts of the
/// walk. Of several, it is the first in the order of the search.
#[must_use]
pub fn smallest_world(
    trail: &FoldedTrail,
    search: WorldSearch,
    watch: &dyn Watch,
) -> SmallestWorld {
    if trail.marked_vertex().is_none() {
        return smallest::smallest_world(trail, search, watch);
    }
    let MarkedTrails { trails, may_be_more } = trail.with_one_marked_vertex(watch);
    let mut limit = may_be_more.then_some(SearchLimit::Steps);
    let mut best = None;
    for trail in &trails {
        let found = match smallest::smallest_world(trail, search, watch) {
            SmallestWorld::World { graph, marker, limit: reached } => {
                limit = limit.or(reached);
                (graph, marker)
            }
            SmallestWorld::NotFound { limit: reached } => {
                limit = limit.or(Some(reached));
                continue;
            }
            SmallestWorld::NoWorld => continue,
        };
        if best
            .as_ref()
            .is_none_or(|(best, _): &(EmbeddedGraph, _)| found.0.edge_count() < best.edge_count())
        {
            best = Some(found);
        }
    }
    match (best, limit) {
        (Some((graph, marker)), limit) => SmallestWorld::World { graph, marker, limit },
        (None, Some(limit)) => SmallestWorld::NotFound { limit },
        (None, None) => SmallestWorld::NoWorld,
    }
}
