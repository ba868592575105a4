//! The folding explorer on every small start.

use std::ops::ControlFlow;

use toposlam_model::{
    check::{Check, RunChoices, Shard, judge_start},
    embedded_graph::Dart,
    enumerate::{Class, Each, EnumeratedGraph, Enumeration},
    folding::certificate_length,
    isomorphism::Candidate,
    mapping::FoldingRun,
};

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
            let sweep = Check::new(class, edges, Shard::WHOLE).unwrap();
            let tally = sweep.run(FoldingRun::default, RunChoices::Default, &());
            assert_eq!(tally.failure, None, "{class} {edges}");
            assert_eq!((tally.starts, tally.mapped), (starts, starts), "{class} {edges}");
            assert_eq!((tally.moves_total, tally.moves_max()), (total, most), "{class} {edges}");
        }
    }
}

#[test]
fn strict_tests_map_every_start_in_more_moves() {
    let sweep = Check::new(Class::Multigraph, 5, Shard::WHOLE).unwrap();
    let strict = sweep.run(FoldingRun::strict, RunChoices::Default, &());
    assert_eq!((strict.failure, strict.mapped), (None, 8162));
    let cheapest = sweep.run(FoldingRun::default, RunChoices::Default, &());
    assert!(strict.moves_total > cheapest.moves_total);
}

#[test]
fn no_run_is_shorter_than_the_certificate() {
    let mut explorer = FoldingRun::default();
    let mut candidate = Candidate::default();
    for (class, edges) in [(Class::Multigraph, 5), (Class::Simple, 7), (Class::Planar, 6)] {
        let starts = Enumeration::new(Each::Start, class, edges).unwrap();
        let mut shortest = 0;
        let mut visit = |found: EnumeratedGraph| {
            let (moves, judged) = judge_start(&mut explorer, found.graph, Dart(0), &mut candidate);
            let certificate = certificate_length(found.graph, Dart(0)) as u64;
            assert_eq!(judged, Ok(()));
            assert!(moves >= certificate, "{moves} < {certificate}: {:?}", found.graph);
            shortest += u64::from(moves == certificate);
            ControlFlow::Continue(())
        };
        let _: ControlFlow<()> = starts.for_each(&mut visit);
        assert!(shortest > 0, "some runs are certificates");
    }
}
