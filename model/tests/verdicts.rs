//! The judge names each flaw.

use toposlam_model::{
    check::{Check, RunChoices, Shard, Tally, judge},
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Class,
    isomorphism::{Candidate, code},
    mapping::{
        Algorithm1Run, DEFAULT_DART_BOUND, Explorer, Flaw, InvalidStep, MappingChoice,
        MappingError, Nearest, map_world, step,
    },
    percept::Door,
    world::{GraphWorld, World},
};

fn theta(far: [&'static str; 3]) -> EmbeddedGraph {
    EmbeddedGraph::from_edge_lists(&[("u", vec!["a", "b", "c"]), ("v", far.to_vec())]).unwrap()
}

fn mapped(graph: &EmbeddedGraph) -> (Algorithm1Run, GraphWorld<'_>) {
    let mut exploration = Algorithm1Run::new(graph.dart_count());
    let mut world = GraphWorld::new(graph, Dart(0));
    map_world(&mut world, &mut Nearest, &mut exploration, &mut ()).unwrap();
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
    // Back and forth, until it is one move too many.
    let bound = exploration.move_bound(3, 2);
    while exploration.moves() <= bound {
        assert_eq!(verdict(&exploration, &world), None);
        for _ in 0..2 {
            exploration.go_through(Door::BACK, &mut world, &mut ()).unwrap();
        }
    }
    let moves = exploration.moves();
    assert_eq!(verdict(&exploration, &world), Some(Flaw::TooManyMoves { moves, bound }));
    // Broken off.
    let mut world = GraphWorld::new(&plane, Dart(0));
    exploration.begin(&mut world, &mut ()).unwrap();
    assert_eq!(verdict(&exploration, &world), Some(Flaw::Unfinished { unexplored: 3 }));
}

#[test]
fn a_world_of_as_many_darts_as_the_bound_is_mapped_and_of_one_more_is_not() {
    let graph = EmbeddedGraph::from_edge_lists(&[("u", vec!["a"]), ("v", vec!["a"])]).unwrap();
    let map = |bound| {
        let mut world = GraphWorld::new(&graph, Dart(0));
        map_world(&mut world, &mut Nearest, &mut Algorithm1Run::new(bound), &mut ())
    };
    assert_eq!(map(2), Ok(()));
    assert_eq!(map(1), Err(MappingError::Bound { bound: 1 }));
    assert_eq!(DEFAULT_DART_BOUND, 16_384);
}

/// A step out of order is an error and changes nothing. Nothing is left of an earlier run.
#[test]
fn a_step_out_of_order_is_an_error() {
    let error = |step| Err(MappingError::InvalidStep(step));
    let [edge, hypothesis] = [MappingChoice::Edge(Dart(0)), MappingChoice::Hypothesis(0)];
    let no_hypothesis = InvalidStep::NoHypothesis { index: 0, left: 0 };
    let graph = theta(["c", "b", "a"]);
    let mut world = GraphWorld::new(&graph, Dart(0));
    let mut fresh = Algorithm1Run::new(6);
    assert_eq!(fresh.choose().unwrap(), None);
    let unexplored = InvalidStep::NotUnexplored(Dart(0));
    assert_eq!(step(&mut fresh, edge, &mut world, &mut ()), error(unexplored));
    assert_eq!(step(&mut fresh, hypothesis, &mut world, &mut ()), error(no_hypothesis));
    assert_eq!(fresh.close_loop(Dart(0), &mut world, &mut ()), Err(InvalidStep::NoEdge));
    assert_eq!(fresh.add_place(&mut world, &mut ()), error(InvalidStep::NoEdge));
    assert_eq!((fresh.moves(), fresh.map().dart_count()), (0, 0));
    assert_eq!(fresh.map().complete(), None);
    let (mut done, mut world) = mapped(&graph);
    let map = done.map().clone();
    assert_eq!(done.open_choices().next(), None);
    assert_eq!(step(&mut done, edge, &mut world, &mut ()), error(unexplored));
    assert_eq!(step(&mut done, hypothesis, &mut world, &mut ()), error(no_hypothesis));
    assert_eq!(done.close_loop(Dart(1), &mut world, &mut ()), Err(InvalidStep::NoEdge));
    assert_eq!(done.add_place(&mut world, &mut ()), error(InvalidStep::NoEdge));
    assert_eq!(done.map(), &map);
    // A start that is refused leaves nothing of the run before.
    world.traverse(Door(1)).unwrap();
    done.begin(&mut world, &mut ()).unwrap_err();
    assert_eq!((done.robot(), done.moves(), done.map().dart_count()), (Dart(0), 0, 0));
}

/// A loop is closed by another unexplored dart than the one that is being explored, or not at all.
/// Meanwhile no other edge can be chosen.
#[test]
fn a_loop_is_not_closed_by_a_dart_that_is_explored() {
    let graph = theta(["c", "b", "a"]);
    let mut world = GraphWorld::new(&graph, Dart(0));
    let mut exploration = Algorithm1Run::new(6);
    exploration.begin(&mut world, &mut ()).unwrap();
    step(&mut exploration, MappingChoice::Edge(Dart(0)), &mut world, &mut ()).unwrap();
    let map = exploration.map().clone();
    exploration.explore(Dart(4), &mut world, &mut ()).unwrap();
    for (dart, invalid) in [
        (Dart(0), InvalidStep::NotUnexplored(Dart(0))),
        (Dart(3), InvalidStep::NotUnexplored(Dart(3))),
        (Dart(6), InvalidStep::NotUnexplored(Dart(6))),
        (Dart(4), InvalidStep::SameDart(Dart(4))),
    ] {
        assert_eq!(exploration.close_loop(dart, &mut world, &mut ()), Err(invalid));
        assert_eq!(exploration.map(), &map);
    }
    for other in [1, 2, 4, 5] {
        let chosen = MappingChoice::Edge(Dart(other));
        let chosen = step(&mut exploration, chosen, &mut world, &mut ());
        let in_progress = InvalidStep::EdgeInProgress(Dart(4));
        assert_eq!(chosen, Err(MappingError::InvalidStep(in_progress)));
    }
    let left = exploration.hypotheses().len();
    let chosen = MappingChoice::Hypothesis(left);
    let none = InvalidStep::NoHypothesis { index: left, left };
    let chosen = step(&mut exploration, chosen, &mut world, &mut ());
    assert_eq!(chosen, Err(MappingError::InvalidStep(none)));
    // All of that has changed nothing.
    assert!(exploration.is_at_line_8());
    exploration.close_loop(Dart(1), &mut world, &mut ()).unwrap();
    assert_eq!(exploration.map().opposite(Dart(1)), Some(Dart(4)));
}

/// A caller that follows its own path reports where it ended.
#[test]
fn from_the_marker_the_robot_finds_its_way_to_what_it_has_just_come_to_know() {
    let graph = theta(["c", "b", "a"]);
    let mut world = GraphWorld::new(&graph, Dart(0));
    let mut exploration = Algorithm1Run::new(6);
    exploration.begin(&mut world, &mut ()).unwrap();
    step(&mut exploration, MappingChoice::Edge(Dart(0)), &mut world, &mut ()).unwrap();
    exploration.clear_trail();
    exploration.go_through(Door::BACK, &mut world, &mut ()).unwrap();
    exploration.arrive_at_marker(Dart(0));
    // Out, back, out again and over the edge.
    exploration.explore(Dart(4), &mut world, &mut ()).unwrap();
    assert_eq!((exploration.moves(), exploration.robot()), (4, Dart(3)));
}

/// The run with the most moves for its vertices, and the first start that takes the most moves.
#[test]
fn the_tally_keeps_the_extremes_of_small_worlds() {
    let new = |degree: u32| u32::MAX - degree;
    for (edges, most) in [(3, (10, 2)), (4, (21, 2)), (5, (36, 2)), (6, (55, 2))] {
        let sweep = Check::new(Class::Multigraph, edges, Shard::WHOLE);
        let tally = sweep.unwrap().run(Algorithm1Run::default, RunChoices::Default, &());
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
