//! A run in a world, and its judgement.

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    isomorphism::{Bijection, Candidate},
    mapping::{Flaw, MapWalk, MappedWorld, MappingMethod, Observer},
    marker::Marker,
    world::GraphWorld,
};

/// A run in a world.
pub(super) struct ExploredWorld {
    /// The robot's journey without audits.
    pub(super) journey: MapWalk,
    /// What the map took with its audits; `None` if the run ended early.
    mapped: Option<MappedWorld>,
    /// The most moves that the algorithm may make in this world, without audits.
    pub(super) move_bound: u64,
    /// Whether the robot carries its marker.
    pub(super) carries: bool,
    /// The bijection from the map to the world, or what is wrong.
    pub(super) result: Result<Bijection, Flaw>,
}

impl ExploredWorld {
    /// A run. `bound` is the most darts of the map.
    pub(super) fn new<'g>(
        method: MappingMethod,
        bound: usize,
        graph: &'g EmbeddedGraph,
        facing: Dart,
        observer: &mut impl Observer<GraphWorld<'g, &'static dyn Marker>>,
    ) -> Self {
        let algorithm = method.algorithm();
        let mut robot = GraphWorld::with_marker(graph, algorithm.marker(), facing);
        let (journey, mapped) = method.map_world(&mut robot, bound, &[], observer);
        let move_bound = algorithm.move_bound(graph.edge_count(), graph.vertex_count());
        let (mapped, result) = match mapped {
            Ok(mapped) => {
                let run = (&journey, mapped.pose);
                let mut candidate = Candidate::default();
                let judged =
                    algorithm.judge(run, (graph, facing), robot.pose(), &mut candidate).cloned();
                (Some(mapped), judged)
            }
            Err(error) => (None, Err(error.into())),
        };
        Self { journey, mapped, move_bound, carries: robot.carries(), result }
    }

    /// The moves until the map was complete.
    pub(super) fn moves_without_audits(&self) -> u64 {
        self.journey.moves()
    }

    /// What audits took, if there were any and all agreed with the map.
    pub(super) fn audited(&self) -> Option<&MappedWorld> {
        self.mapped.as_ref().filter(|mapped| !mapped.audited_percepts.is_empty())
    }

    /// All moves.
    pub(super) fn moves(&self) -> u64 {
        self.moves_without_audits() + self.audited().map_or(0, |mapped| mapped.audit_moves)
    }

    /// The robot's pose in the map.
    pub(super) fn robot(&self) -> Dart {
        self.mapped.as_ref().map_or(self.journey.robot(), |mapped| mapped.pose)
    }
}
