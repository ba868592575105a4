//! The judge finds each flaw of the folding explorer.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::*;
use crate::{
    any_graph::{Class, starts},
    check::{
        judge,
        smallest_failure::{Failure, new},
    },
    injected_flaw::{InjectedFlaw, inject},
    isomorphism::{Candidate, code},
    mapping::{Flaw, explore},
    world::GraphWorld,
};

/// The first start of the class `multigraph` with up to so many edges on which the explorer fails.
fn first_failure(most: usize) -> Option<Failure> {
    let mut explorer = FoldingRun::default();
    let mut candidate = Candidate::default();
    (1..=most).flat_map(|edges| starts(Class::Multigraph, edges)).find_map(|graph| {
        // With a flaw, what the code relies on may be false. Overflows panic in tests.
        let judged = catch_unwind(AssertUnwindSafe(|| {
            let bound = explorer.move_bound(graph.edge_count(), graph.vertex_count());
            // The map may have more darts than the world.
            let mut world = GraphWorld::new(&graph, Dart(0)).with_bound(bound);
            let ended = explore(&mut explorer, &mut world).map_err(Flaw::from);
            let judged =
                ended.and_then(|()| judge(&explorer, Dart(0), &world, &mut candidate).map(|_| ()));
            judged.map_err(|flaw| format!("after {} moves: {flaw}", world.moves()))
        }));
        let report = judged.unwrap_or_else(|_| Err("it panics".to_owned())).err()?;
        Some((graph.edge_count(), code(&graph, Dart(0)).words().to_vec(), report))
    })
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
