//! The judge finds each flaw of the folding explorer.

use std::{
    ops::ControlFlow,
    panic::{AssertUnwindSafe, catch_unwind},
};

use super::*;
use crate::{
    check::judge,
    embedded_graph::Dart,
    enumerate::{Class, Each, EnumeratedGraph, Enumeration},
    injected_flaw::{InjectedFlaw, inject},
    isomorphism::{Candidate, code},
    mapping::{Flaw, explore},
    world::GraphWorld,
};

/// The edges of the first start on which the explorer fails, its code, and what the judge reports.
type Failure = (usize, Vec<u32>, String);

/// The first start of the class `multigraph` with up to so many edges on which the explorer fails.
fn first_failure(most: usize) -> Option<Failure> {
    let mut explorer = FoldingRun::default();
    let mut candidate = Candidate::default();
    (1..=most).find_map(|edges| {
        let starts = Enumeration::new(Each::Start, Class::Multigraph, edges).unwrap();
        let mut failure = None;
        let mut visit = |found: EnumeratedGraph| {
            // With a flaw, what the code relies on may be false. Overflows panic in tests.
            let judged = catch_unwind(AssertUnwindSafe(|| {
                let graph = found.graph;
                let bound = explorer.move_bound(graph.edge_count(), graph.vertex_count());
                // The map may have more darts than the world.
                let mut world = GraphWorld::new(graph, Dart(0)).with_bound(bound);
                let ended = explore(&mut explorer, &mut world, &mut ()).map_err(Flaw::from);
                let judged = ended
                    .and_then(|()| judge(&explorer, Dart(0), &world, &mut candidate).map(|_| ()));
                (world.moves(), judged)
            }));
            let report = match judged {
                Ok((_, Ok(()))) => return ControlFlow::Continue(()),
                Ok((moves, Err(flaw))) => format!("after {moves} moves: {flaw}"),
                Err(_) => "it panics".to_owned(),
            };
            let words = code(found.graph, Dart(0)).words().to_vec();
            failure = Some((edges, words, report));
            ControlFlow::Break(())
        };
        let _: ControlFlow<()> = starts.for_each(&mut visit);
        failure
    })
}

/// The word of a code for a new vertex.
fn new(degree: u32) -> u32 {
    u32::MAX - degree
}

#[test]
fn the_judge_finds_each_flaw_of_the_folding_explorer_on_a_small_start() {
    use InjectedFlaw::{
        ContradictionIgnored, ForcedNotUnited, NotTested, OneHypothesisExamined,
        PlaceAddedTooEarly, ProofByOtherWalk, SightingNotUnited, SightingsNotCompared,
    };
    assert_eq!(inject(None, || first_failure(4)), None);
    let not_complete = |moves: u32| {
        format!(
            "after {moves} moves: invalid step: there is nothing left to do, and the trail is \
                 not complete"
        )
    };
    let panics = || "it panics".to_owned();
    let turned = "after 3 moves: the world contradicts itself: the junction after 2 moves would \
                      be turned onto itself";
    let degrees = "after 29 moves: the world contradicts itself: the junctions after 3 and 0 moves \
                       are the same one, with 5 doors and with 1";
    let expected: [(InjectedFlaw, Failure); 8] = [
        (SightingNotUnited, (1, vec![new(2), 1], not_complete(3))),
        (ForcedNotUnited, (2, vec![new(1), new(3), 3], not_complete(6))),
        (ContradictionIgnored, (1, vec![new(1), new(1)], not_complete(1))),
        (SightingsNotCompared, (3, vec![new(3), new(3), 4, 5], not_complete(5))),
        (PlaceAddedTooEarly, (2, vec![new(1), new(3), 3], panics())),
        (OneHypothesisExamined, (2, vec![new(1), new(3), 3], panics())),
        (NotTested, (3, vec![new(2), new(4), 4, 5], turned.to_owned())),
        (ProofByOtherWalk, (3, vec![new(1), new(5), 5, 4], degrees.to_owned())),
    ];
    for (flaw, failure) in expected {
        assert_eq!(inject(Some(flaw), || first_failure(4)), Some(failure), "{flaw:?}");
    }
}
