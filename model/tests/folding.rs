//! The folding explorer maps every small start right, however its ties are broken.

use toposlam_model::{
    check::{every_way, first_false_step, judge_start},
    embedded_graph::Dart,
    enumerate::Class,
    folding::certificate_length,
    isomorphism::Candidate,
    mapping::{Explorer, FoldingRun},
    world::GraphWorld,
};

use crate::{checked, starts};

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
