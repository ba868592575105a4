//! The folding explorer maps every small start in few moves, and right however its ties are broken.

use proptest::prelude::*;
use toposlam_model::{
    aid::RefusedAction,
    check::{every_way, first_false_step, judge_start},
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Class,
    folding::certificate_length,
    isomorphism::Candidate,
    mapping::{Explorer, FoldingRun, MappingError, ObservedWorld, explore},
    percept::{Door, Percept, Sighting},
    world::{GraphWorld, World},
};

use crate::{checked, starts};

/// A number of edges, the starts, their moves, and the most moves of one.
type Moves = (usize, u64, u64, u64);

const MOVES: [(Class, &[Moves]); 3] = [
    (Class::Multigraph, &[(3, 74, 289, 10), (4, 706, 4052, 21), (5, 8162, 63858, 35)]),
    (Class::Simple, &[(5, 108, 766, 9), (6, 596, 5338, 14), (7, 3790, 42006, 27)]),
    (Class::Corridor, &[(6, 309, 2730, 14), (7, 1128, 12199, 27), (8, 4201, 54402, 34)]),
];

#[test]
fn the_folding_explorer_maps_every_start_in_few_moves() {
    for (class, sizes) in MOVES {
        for &(edges, starts, total, most) in sizes {
            let tally = checked(class, edges, FoldingRun::default);
            assert_eq!(tally.failure, None, "{class} {edges}");
            assert_eq!((tally.starts, tally.mapped), (starts, starts), "{class} {edges}");
            assert_eq!((tally.moves_total, tally.moves_max()), (total, most), "{class} {edges}");
        }
    }
}

#[test]
fn strict_tests_map_every_start_in_more_moves() {
    let strict = checked(Class::Multigraph, 5, FoldingRun::strict);
    assert_eq!((strict.failure, strict.mapped), (None, 8162));
    assert!(strict.moves_total > 63858);
}

#[test]
fn no_run_is_shorter_than_the_certificate_and_each_map_embeds_in_its_world() {
    let mut explorer = FoldingRun::default();
    let mut candidate = Candidate::default();
    for (class, edges) in [(Class::Multigraph, 4), (Class::Simple, 6), (Class::Corridor, 7)] {
        let mut shortest = 0;
        for graph in starts(class, edges) {
            let (moves, judged) = judge_start(&mut explorer, &graph, Dart(0), &mut candidate);
            let certificate = certificate_length(&graph, Dart(0)) as u64;
            assert_eq!(judged, Ok(()));
            assert!(moves >= certificate, "{moves} < {certificate}: {graph:?}");
            shortest += u64::from(moves == certificate);
            assert_eq!(first_false_step(FoldingRun::default(), &graph, Dart(0)), None, "{graph:?}");
        }
        assert!(shortest > 0, "some runs are certificates");
    }
}

#[test]
fn the_default_choice_is_the_first_of_all() {
    for graph in starts(Class::Multigraph, 4) {
        let mut world = GraphWorld::new(&graph, Dart(0));
        let mut run = FoldingRun::default();
        run.begin(&mut world).unwrap();
        while let Some(choice) = run.choose().unwrap() {
            assert_eq!(run.choices().unwrap().first(), Some(&choice));
            run.step(choice, &mut world).unwrap();
        }
    }
}

#[test]
fn every_start_with_up_to_four_edges_is_mapped_however_ties_are_broken() {
    let runs = [1, 2, 3, 4].map(|edges| -> u128 {
        // The end of each run is judged.
        let runs = starts(Class::Multigraph, edges).into_iter().map(|graph| {
            every_way(FoldingRun::default(), &graph, Dart(0), u64::MAX, &()).unwrap().runs
        });
        runs.sum()
    });
    assert_eq!(runs, [3, 43, 1521, 472_285]);
}

/// A world in which one percept is false.
struct Lying<'g> {
    world: GraphWorld<'g>,
    at: u64,
    lie: Percept,
}

impl ObservedWorld for Lying<'_> {}

impl World for Lying<'_> {
    type Error = RefusedAction;

    fn percept(&mut self) -> Result<Percept, RefusedAction> {
        if self.world.moves() == self.at { Ok(self.lie) } else { self.world.percept() }
    }

    fn traverse(&mut self, door: Door) -> Result<(), RefusedAction> {
        let degree = self.world.sensed().degree;
        self.world.traverse(Door(door.0 % degree))
    }
}

proptest! {
    #[test]
    fn a_sensor_that_lies_once_never_panics(at in 0..30u64, lie in (1..4u32, 0..6u32)) {
        // A loop of four edges, and a tail at which the robot starts.
        let graph = EmbeddedGraph::from_neighbour_lists(&[
            ("end", vec!["a"]),
            ("a", vec!["end", "b", "d"]),
            ("b", vec!["a", "c"]),
            ("c", vec!["b", "d"]),
            ("d", vec!["c", "a"]),
        ])
        .unwrap();
        let (degree, door) = lie;
        let sighting =
            if door < degree { Sighting::Pointing(Door(door)) } else { Sighting::Nothing };
        let world = GraphWorld::new(&graph, Dart(0));
        let mut world = Lying { world, at, lie: Percept { degree, sighting } };
        let mut run = FoldingRun::new(60);
        match explore(&mut run, &mut world) {
            Ok(()) => prop_assert!(run.is_complete()),
            Err(MappingError::Contradiction(_) | MappingError::Bound { .. }) => {}
            Err(error) => panic!("{error}"),
        }
    }
}
