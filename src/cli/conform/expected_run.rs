//! The cases that a complete run has: the algorithm with its default choices, in a known world from a known
//! start.

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    mapping::{Journey, MappingAlgorithm, MappingEvent, Observer},
    trace::AlgorithmCoverage,
    world::GraphWorld,
};

/// The cases of one run, and the poses in which the robot stood.
#[derive(Default)]
pub(super) struct ExpectedRun {
    pub(super) coverage: AlgorithmCoverage,
    pub(super) poses: Vec<Dart>,
}

impl ExpectedRun {
    pub(super) fn of(algorithm: MappingAlgorithm, graph: &EmbeddedGraph, start: Dart) -> Self {
        let mut expected = Self::default();
        let mut world = GraphWorld::new(graph, start);
        // In a world of this size the run ends.
        let _ = algorithm.map_world(&mut world, 2 * graph.dart_count(), &mut expected);
        expected
    }
}

impl Observer<GraphWorld<'_>> for ExpectedRun {
    fn event(&mut self, world: &mut GraphWorld, journey: &Journey, event: MappingEvent) {
        self.coverage.event(world, journey, event);
        self.poses.push(world.state().pose);
    }
}
