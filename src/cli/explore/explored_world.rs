//! A run in a world, and its judgement.

use std::borrow::Cow;

use toposlam_model::{
    check::{Algorithm, Algorithm1, ExploredMap, Flaw, Folding, MovableMarker, judge, judge_map},
    embedded_graph::{Dart, EmbeddedGraph},
    isomorphism::{Bijection, Candidate},
    mapping::{
        DirectionalAlgorithm, FACING, Journey, MappedWorld, MappingMethod, MappingRun,
        MarkerSearch, Observer,
    },
    marker::Movable,
    world::GraphWorld,
};

/// A run in a world.
pub(super) struct ExploredWorld {
    state: ExploredState,
    /// What the map took with its audits; `None` if the run ended early, or with a movable marker.
    mapped: Option<MappedWorld>,
    /// The most moves that the algorithm may make in this world, without audits.
    pub(super) move_bound: u64,
    /// Whether the robot carries its marker.
    pub(super) carries: bool,
    /// The bijection from the map to the world, or what is wrong.
    pub(super) result: Result<Bijection, Flaw>,
}

/// The state of the algorithm at the end.
enum ExploredState {
    Directional(MappingRun),
    Movable(Box<MarkerSearch>),
}

impl ExploredWorld {
    /// A run with the directional marker. `bound` is the most darts of the map.
    pub(super) fn by_method<'g>(
        method: MappingMethod,
        bound: usize,
        graph: &'g EmbeddedGraph,
        facing: Dart,
        observer: &mut impl Observer<GraphWorld<'g>>,
    ) -> Self {
        let mut robot = GraphWorld::new(graph, facing);
        let (run, mapped) = method.map_world(&mut robot, bound, &[], observer);
        let size = (graph.edge_count(), graph.vertex_count());
        let move_bound = match method.algorithm() {
            DirectionalAlgorithm::Algorithm1 => Algorithm1.move_bound(size.0, size.1),
            DirectionalAlgorithm::Folding => Folding.move_bound(size.0, size.1),
        };
        let judged = |mapped: &MappedWorld| {
            let unexplored = run.map().unexplored_count();
            let map = run.map().complete().ok_or(Flaw::Unfinished { unexplored })?;
            let map = ExploredMap { graph: Cow::Borrowed(map), facing: FACING, pose: mapped.pose };
            let mut candidate = Candidate::default();
            let bijection = judge_map(&map, (graph, facing), robot.pose(), &mut candidate)?.clone();
            let moves = run.moves();
            if moves > move_bound {
                return Err(Flaw::TooManyMoves { moves, bound: move_bound });
            }
            Ok(bijection)
        };
        let (mapped, result) = match mapped {
            Ok(mapped) => {
                let result = judged(&mapped);
                (Some(mapped), result)
            }
            Err(error) => (None, Err(error.into())),
        };
        Self { state: ExploredState::Directional(run), mapped, move_bound, carries: false, result }
    }

    /// A run with a marker that the robot carries. `bound` is the most darts of the map.
    pub(super) fn by_movable_marker<'g>(
        bound: usize,
        graph: &'g EmbeddedGraph,
        facing: Dart,
        observer: &mut impl Observer<GraphWorld<'g, Movable>>,
    ) -> Self {
        let mut robot = GraphWorld::with_marker(graph, Movable, facing);
        let mut search = Box::new(MarkerSearch::new(bound));
        let run = MovableMarker.run(&mut robot, &mut search, observer);
        let mut candidate = Candidate::default();
        let result = run
            .map_err(Flaw::from)
            .and_then(|()| judge(&MovableMarker, &search, facing, &robot, &mut candidate).cloned());
        Self {
            state: ExploredState::Movable(search),
            mapped: None,
            move_bound: MovableMarker.move_bound(graph.edge_count(), graph.vertex_count()),
            carries: robot.carries(),
            result,
        }
    }

    /// The robot's journey without audits.
    pub(super) fn journey(&self) -> &Journey {
        match &self.state {
            ExploredState::Directional(run) => run.journey(),
            ExploredState::Movable(search) => search.journey(),
        }
    }

    /// The moves until the map was complete.
    pub(super) fn moves_without_audits(&self) -> u64 {
        self.journey().moves()
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
        self.mapped.as_ref().map_or(self.journey().robot(), |mapped| mapped.pose)
    }
}
