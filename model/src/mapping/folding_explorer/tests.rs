//! The judge finds each flaw of the folding explorer.

use super::*;
use crate::{
    any_graph::Class,
    check::smallest_failure::{Failure, injected_failure, injected_failure_with, new},
    embedded_graph::EmbeddedGraph,
    folding::{ArrivalSenses, LengthInterval},
};

/// The first start of the class `multigraph` with up to 4 edges on which the explorer fails.
fn first_failure(flaw: Option<InjectedFlaw>) -> Option<Failure> {
    injected_failure(flaw, FoldingRun::default(), Class::Multigraph, 4)
}

#[test]
fn the_judge_finds_each_flaw_of_the_folding_explorer_on_a_small_start() {
    use InjectedFlaw::{
        ContradictionIgnored, ForcedNotUnited, NotTested, OneHypothesisExamined,
        PlaceAddedTooEarly, ProofByOtherWalk, SightingNotUnited, SightingsNotCompared,
    };
    assert_eq!(first_failure(None), None);
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
        assert_eq!(first_failure(Some(flaw)), Some(failure), "{flaw:?}");
    }
}

/// The first start with up to 4 edges on which the explorer fails, where a dart of the graph has a length.
fn first_failure_with(
    length: impl Fn(&EmbeddedGraph, Dart) -> u32,
    flaw: Option<InjectedFlaw>,
) -> Option<Failure> {
    let sense = |graph: &EmbeddedGraph, pose| {
        let length = LengthInterval::exact(length(graph, pose));
        ArrivalSenses { length: Some(length), compass: None }
    };
    injected_failure_with(sense, flaw, FoldingRun::default(), Class::Multigraph, 4)
}

#[test]
fn the_judge_finds_each_flaw_of_lengths_on_a_small_start() {
    use InjectedFlaw::{LengthNotRestored, LengthsNotCompared};
    let of_dart = |_: &EmbeddedGraph, dart: Dart| 1000 * (dart.0 + 1);
    let of_edge =
        |graph: &EmbeddedGraph, dart: Dart| of_dart(graph, dart.min(graph.opposite(dart)));
    assert_eq!(first_failure_with(of_edge, None), None);
    let kept = "after 8 moves: the world contradicts itself: an edge at the junctions after 2 and 7 moves is \
                    the same one, with a length of 1.000 m and of 4.000 m";
    let failure = (3, vec![new(1), new(5), 4, 5], kept.to_owned());
    assert_eq!(first_failure_with(of_edge, Some(LengthNotRestored)), Some(failure));
    // Where the two directions have two lengths, no world has these lengths.
    let two_lengths = "after 2 moves: the world contradicts itself: an edge at the junctions after 0 and 2 \
                           moves is the same one, with a length of 4.000 m and of 1.000 m";
    let failure = (2, vec![new(3), new(1), 2], two_lengths.to_owned());
    assert_eq!(first_failure_with(of_dart, None), Some(failure));
    assert_eq!(first_failure_with(of_dart, Some(LengthsNotCompared)), None);
}

#[test]
fn the_judge_finds_a_movable_marker_that_is_taken_for_a_pose_on_a_small_start() {
    let failure = |flaw| injected_failure(flaw, WithMovableRun::default(), Class::Multigraph, 5);
    assert_eq!(failure(None), None);
    let turned = "after 39 moves: the world contradicts itself: the junction after 5 moves would be turned \
                      onto itself";
    let expected = (5, vec![new(2), new(3), 3, new(5), 9, 8], turned.to_owned());
    assert_eq!(failure(Some(InjectedFlaw::VertexTakenForPose)), Some(expected));
}
