//! The judge names each flaw.

use toposlam_model::{
    check::{Tally, judge},
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Class,
    isomorphism::{Candidate, code},
    mapping::{Algorithm1Run, DEFAULT_DART_BOUND, Explorer, Flaw, MappingError, explore},
    percept::Door,
    world::{GraphWorld, World},
};

use crate::checked;

fn theta(far: [&'static str; 3]) -> EmbeddedGraph {
    EmbeddedGraph::from_edge_lists(&[("u", vec!["a", "b", "c"]), ("v", far.to_vec())]).unwrap()
}

fn mapped(graph: &EmbeddedGraph) -> (Algorithm1Run, GraphWorld<'_>) {
    let mut exploration = Algorithm1Run::new(graph.dart_count());
    let mut world = GraphWorld::new(graph, Dart(0));
    explore(&mut exploration, &mut world).unwrap();
    (exploration, world)
}

fn verdict(exploration: &Algorithm1Run, world: &GraphWorld) -> Option<Flaw> {
    judge(exploration, Dart(0), world, &mut Candidate::default()).err()
}

// paper: alg1.isomorphic, alg1.located, cost.bound
#[test]
fn a_run_is_wrong_by_its_map_its_pose_or_its_moves() {
    let (plane, torus) = (theta(["c", "b", "a"]), theta(["a", "b", "c"]));
    let (mut exploration, mut world) = mapped(&plane);
    assert_eq!(verdict(&exploration, &world), None);
    // The map of another world.
    assert_eq!(verdict(&exploration, &GraphWorld::new(&torus, Dart(0))), Some(Flaw::WrongMap));
    // A move that the robot is not aware of.
    let mut moved = world.clone();
    moved.traverse(Door::BACK).unwrap();
    assert!(matches!(verdict(&exploration, &moved), Some(Flaw::WrongPose { .. })));
    // Back and forth, until it is one move too many. The world counts the moves.
    let bound = exploration.move_bound(3, 2);
    while world.moves() <= bound {
        assert_eq!(verdict(&exploration, &world), None);
        for _ in 0..2 {
            world.traverse(Door::BACK).unwrap();
        }
    }
    let moves = world.moves();
    assert_eq!(verdict(&exploration, &world), Some(Flaw::TooManyMoves { moves, bound }));
    // Broken off.
    let mut world = GraphWorld::new(&plane, Dart(0));
    exploration.begin(&mut world).unwrap();
    assert_eq!(verdict(&exploration, &world), Some(Flaw::Unfinished { unexplored: 3 }));
}

#[test]
fn a_world_of_as_many_darts_as_the_bound_is_mapped_and_of_one_more_is_not() {
    let graph = EmbeddedGraph::chain(1);
    let map = |bound| {
        let mut world = GraphWorld::new(&graph, Dart(0));
        explore(&mut Algorithm1Run::new(bound), &mut world)
    };
    assert_eq!(map(2), Ok(()));
    assert_eq!(map(1), Err(MappingError::Bound { bound: 1 }));
    assert_eq!(DEFAULT_DART_BOUND, 16_384);
}

/// The run with the most moves for its vertices, and the first start that takes the most moves.
#[test]
fn the_tally_keeps_the_extremes_of_small_worlds() {
    let new = |degree: u32| u32::MAX - degree;
    for (edges, most) in [(3, (10, 2)), (4, (21, 2)), (5, (36, 2)), (6, (55, 2))] {
        let tally = checked(Class::Multigraph, edges, Algorithm1Run::default);
        assert_eq!(tally.most_moves_per_vertex, Some(most));
        if edges == 3 {
            let worst = tally.worst.clone().unwrap();
            let words = code(&worst.graph, worst.facing).words().to_vec();
            assert_eq!(words, [new(1), new(5), 5, 4]);
        }
        // Of two equals the first stays.
        let mut both = tally.clone();
        let mut other = tally.clone();
        other.worst.as_mut().unwrap().facing = Dart(99);
        both.merge(other);
        assert_eq!(both.worst, tally.worst);
        assert_eq!((both.starts, both.runs), (2 * tally.starts, 0));
    }
    let mut runs: Tally = Tally { runs: 3, ..Tally::default() };
    runs.merge(Tally { runs: u128::MAX, ..Tally::default() });
    assert_eq!(runs.runs, u128::MAX);
}
