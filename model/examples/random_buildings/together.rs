//! The moves of two robots without radio that map as one robot does with a marker: where it carries the marker, the second
//! robot goes along, and where it drops the marker, the second robot waits.

use toposlam_model::{
    aid::AidKind,
    embedded_graph::{Dart, EmbeddedGraph},
    mapping::{DEFAULT_DART_BOUND, MapWalk, MappingAlgorithm, MappingEvent, Observer},
    world::GraphWorld,
};

/// Counts the moves of both robots.
#[derive(Default)]
struct BothRobots {
    moves: u64,
}

impl Observer<GraphWorld<'_, AidKind>> for BothRobots {
    fn event(&mut self, world: &mut GraphWorld<'_, AidKind>, _: &MapWalk, event: MappingEvent) {
        if matches!(event, MappingEvent::Moved { .. }) {
            self.moves += 1 + u64::from(world.held() > 0);
        }
    }
}

/// The moves of both robots together, for an algorithm with one marker that is carried.
pub(crate) fn moves_together(algorithm: MappingAlgorithm, graph: &EmbeddedGraph) -> u64 {
    let mut world = GraphWorld::with_aid(graph, algorithm.aid(), Dart(0));
    let mut robots = BothRobots::default();
    algorithm.map_world(&mut world, DEFAULT_DART_BOUND, &mut robots).1.unwrap();
    robots.moves
}
