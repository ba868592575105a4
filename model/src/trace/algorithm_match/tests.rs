use proptest::prelude::*;

use super::*;
use crate::{
    aid::Action,
    any_graph::{any_graph, starts},
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Class,
    isomorphism::code,
    mapping::{
        Contradiction, FACING,
        MappingAlgorithm::{Algorithm1, Folding},
    },
    percept::{Door, Sighting},
    trace::{
        AllowedStep, TraceEventKind,
        tests::{doors_of, explored, explored_by, lollipop, walked},
    },
};

/// A run of Algorithm 1 that chooses by a row of numbers.
fn chosen(graph: &EmbeddedGraph, numbers: &[u8]) -> Trace {
    let mut numbers = numbers.iter().cycle().map(|&number| usize::from(number));
    let choose = |run: &mut Algorithm1Run| {
        let open = run.choices()?;
        Ok(open.get(numbers.next().unwrap() % open.len().max(1)).copied())
    };
    doors_of(graph, Dart(0), |world| explore_with(&mut Algorithm1Run::default(), world, choose))
}

#[test]
fn a_door_that_no_choice_takes_departs_with_the_allowed_doors() {
    let graph = lollipop();
    // At the fork the robot goes back where it came from, while nothing is left there.
    let trace = walked(&graph, Dart(0), &[Door(0), Door(0)]);
    let followed = match_algorithm(Algorithm1, &trace, TraceClaim::Whole, 100);
    let MatchEnd::Departure(departure) = followed.reached else { panic!("{followed:?}") };
    let allowed: Vec<_> = departure.allowed.iter().map(ToString::to_string).collect();
    assert_eq!(departure.event.id, 3);
    assert_eq!(
        allowed,
        [
            "door 1 (line 5: explores the unexplored dart 1 of vertex v1)",
            "door 2 (line 5: explores the unexplored dart 2 of vertex v1)",
        ]
    );
    assert_eq!(followed.choices, MatchedChoices::Default);
}

#[test]
fn a_robot_that_goes_on_when_all_is_known_departs() {
    let graph = lollipop();
    let mut doors = explored(&graph, Dart(0)).doors().to_vec();
    let moves = doors.len();
    doors.push(Door(0));
    let trace = walked(&graph, Dart(0), &doors);
    let followed = match_algorithm(Algorithm1, &trace, TraceClaim::Whole, 100);
    let done = AllowedStep { action: None, purpose: StepPurpose::Done };
    let departure =
        Departure { algorithm: Algorithm1, event: trace.event(2 * moves + 1), allowed: vec![done] };
    assert_eq!(followed.reached, MatchEnd::Departure(departure));
    assert!(followed.run.map().complete().is_some());
}

#[test]
fn a_start_without_the_marker_departs_at_once() {
    let percept = Percept { degree: 2, sighting: Sighting::Nothing };
    let followed = match_algorithm(
        Algorithm1,
        &Trace::new([TraceEventKind::Percept(percept)]).unwrap(),
        TraceClaim::Part,
        100,
    );
    let MatchEnd::Departure(departure) = followed.reached else { panic!("{followed:?}") };
    assert_eq!(departure.event.id, 0);
    let contradiction = Contradiction::Start { perceived: percept };
    assert_eq!(departure.allowed[0].purpose, StepPurpose::Contradicted(contradiction));
}

#[test]
fn a_run_that_reaches_the_bound_is_not_matched_further() {
    let trace = explored(&lollipop(), Dart(0));
    // The end of the tail has one dart, and the fork behind it has three.
    for (bound, event) in [(0, 0), (3, 2)] {
        let end = MatchEnd::Bound { event: trace.event(event), bound };
        let followed = match_algorithm(Algorithm1, &trace, TraceClaim::Part, bound);
        assert_eq!((followed.reached, followed.choices), (end, MatchedChoices::Default));
    }
}

/// Every start with up to four edges, and runs with many choices in it.
fn for_each_choice(mut visit: impl FnMut(&EmbeddedGraph, &Trace)) {
    for graph in (1..=4).flat_map(|edges| starts(Class::Multigraph, edges)) {
        for numbers in [[1, 0], [0, 1], [2, 1], [5, 2]] {
            visit(&graph, &chosen(&graph, &numbers));
        }
    }
}

#[test]
fn the_first_event_of_other_choices_is_where_the_default_ones_differ() {
    let mut others = 0;
    for_each_choice(|graph, trace| {
        let default = explored(graph, Dart(0));
        let same = trace.events().zip(default.events()).take_while(|(one, other)| one == other);
        let same = same.count();
        let choices = if *trace == default {
            MatchedChoices::Default
        } else {
            others += 1;
            MatchedChoices::Other { from: Some(same) }
        };
        let followed = match_algorithm(Algorithm1, trace, TraceClaim::Whole, 100);
        assert_eq!((&followed.reached, followed.choices), (&MatchEnd::Mapped, choices));
        let part = match_algorithm(Algorithm1, trace, TraceClaim::Part, 100);
        assert_eq!((part.reached, part.choices), (MatchEnd::Mapped, choices));
        // After it there is nothing left to do.
        let mut doors = trace.doors().to_vec();
        doors.push(Door(0));
        let longer = walked(graph, Dart(0), &doors);
        let followed = match_algorithm(Algorithm1, &longer, TraceClaim::Whole, 100);
        let MatchEnd::Departure(departure) = &followed.reached else { panic!("{followed:?}") };
        let last = 2 * doors.len() - 1;
        assert_eq!(departure.event.id, last);
        let from = longer.events().zip(default.events()).position(|(one, other)| one != other);
        let from = from.unwrap_or(default.len().min(last));
        let expected = if from == last {
            MatchedChoices::Default
        } else {
            MatchedChoices::Other { from: Some(from) }
        };
        assert_eq!(followed.choices, expected);
        // Each door that is allowed instead is one that some choices take.
        assert!(departure.allowed.iter().any(|step| step.purpose == StepPurpose::Done));
        for action in departure.allowed.iter().filter_map(|step| step.action) {
            let Action::Take(door) = action else { panic!("{action} is no door") };
            doors[last / 2] = door;
            let instead = walked(graph, Dart(0), &doors);
            let followed = match_algorithm(Algorithm1, &instead, TraceClaim::Part, 100);
            assert!(!matches!(followed.reached, MatchEnd::Departure(_)), "{followed:?}");
        }
    });
    assert!(others > 1000, "{others}");
}

#[test]
fn the_bound_is_where_the_longest_run_reaches_it() {
    let mut bounded = 0;
    for_each_choice(|graph, trace| {
        for bound in 1..graph.dart_count() {
            let followed = match_algorithm(Algorithm1, trace, TraceClaim::Whole, bound);
            let MatchEnd::Bound { event, .. } = followed.reached else { continue };
            // No run goes on to the end of the trace up to there.
            let part = trace.up_to(event.id);
            let again = match_algorithm(Algorithm1, &part, TraceClaim::Part, bound);
            assert_eq!(again.reached, followed.reached);
            bounded += 1;
        }
    });
    assert!(bounded > 1000, "{bounded}");
}

#[test]
fn every_part_of_a_run_with_other_choices_is_followed_to_its_end() {
    for_each_choice(|_, trace| {
        for event in 0..trace.len() - 1 {
            let part = trace.up_to(event);
            let followed = match_algorithm(Algorithm1, &part, TraceClaim::Part, 100);
            assert!(matches!(followed.reached, MatchEnd::EndOfTrace | MatchEnd::Mapped));
        }
    });
}

/// The percept that Algorithm 1 expects in place of one that contradicts its map.
fn expected(departure: &Departure) -> Option<Percept> {
    departure.allowed.iter().find_map(|allowed| match allowed.purpose {
        StepPurpose::Contradicted(
            Contradiction::KnownPlace { expected, .. } | Contradiction::WayBack { expected, .. },
        ) => Some(expected),
        _ => None,
    })
}

/// The trace with one more door at each of these moves.
fn wrong_after(trace: &Trace, moves: &[usize]) -> Trace {
    let mut wrong = trace.clone();
    for &at in moves {
        wrong.percepts[at].degree += 1;
    }
    wrong
}

#[test]
fn all_contradictions_are_amended_in_one_match() {
    let mut most = 0;
    for_each_choice(|graph, trace| {
        let departs = |wrong: &Trace| match match_algorithm(
            Algorithm1,
            wrong,
            TraceClaim::Whole,
            100,
        )
        .reached
        {
            MatchEnd::Departure(departure) => Some(departure),
            _ => None,
        };
        // The moves after which a wrong percept is a contradiction.
        let contradicted = |&moves: &usize| {
            let found = departs(&wrong_after(trace, &[moves]));
            found.is_some_and(|found| {
                found.event.id == 2 * moves && expected(&found) == Some(trace.percepts()[moves])
            })
        };
        let wrong: Vec<usize> = (1..trace.percepts().len()).filter(contradicted).collect();
        let all = wrong_after(trace, &wrong);
        let mut amended = Vec::new();
        let mut amend = |departure: &Departure| {
            amended.push(departure.event.id / 2);
            expected(departure)
        };
        let followed = match_amended(Algorithm1, &all, TraceClaim::Whole, 100, Some(&mut amend));
        assert_eq!((&followed.reached, &amended), (&MatchEnd::Mapped, &wrong));
        let map = followed.run.map().complete().unwrap();
        assert_eq!(code(map, FACING), code(graph, Dart(0)));
        let good = match_algorithm(Algorithm1, trace, TraceClaim::Whole, 100);
        assert_eq!(followed.choices, good.choices);
        // One that is not replaced stays a departure.
        if let [first, second, ..] = wrong[..] {
            let mut once = |departure: &Departure| {
                expected(departure).filter(|_| departure.event.id == 2 * first)
            };
            let stopped = match_amended(Algorithm1, &all, TraceClaim::Whole, 100, Some(&mut once));
            let MatchEnd::Departure(departure) = stopped.reached else { panic!() };
            assert_eq!(departure.event.id, 2 * second);
        }
        // A percept that is replaced by a wrong one is not replaced again.
        if let Some(&first) = wrong.first() {
            let mut asked = 0;
            let mut wrongly = |_: &Departure| {
                asked += 1;
                Some(Percept { degree: 9, sighting: Sighting::Nothing })
            };
            let stopped =
                match_amended(Algorithm1, &all, TraceClaim::Whole, 100, Some(&mut wrongly));
            let MatchEnd::Departure(departure) = stopped.reached else { panic!() };
            assert_eq!((departure.event.id, asked), (2 * first, 1));
        }
        most = most.max(wrong.len());
    });
    assert!(most > 5, "{most}");
}

proptest! {
    #[test]
    fn every_run_is_followed_to_its_map_and_every_part_to_its_end(
        graph in any_graph(Class::Multigraph, 20), part in any::<prop::sample::Index>(),
    ) {
        for algorithm in [Algorithm1, Folding] {
            let trace = explored_by(algorithm, &graph, Dart(0));
            let followed = match_algorithm(algorithm, &trace, TraceClaim::Whole, 100);
            prop_assert_eq!(followed.choices, MatchedChoices::Default);
            prop_assert_eq!(&followed.reached, &MatchEnd::Mapped);
            let map = followed.run.map().complete().unwrap();
            prop_assert_eq!(code(map, FACING), code(&graph, Dart(0)));
            let part = trace.up_to(part.index(trace.len() - 1));
            let followed = match_algorithm(algorithm, &part, TraceClaim::Part, 100);
            prop_assert_eq!(followed.reached, MatchEnd::EndOfTrace);
            // Where no choices are at their end there, the default ones count all the same.
            let followed = match_algorithm(algorithm, &part, TraceClaim::Whole, 100);
            let default = followed.choices == MatchedChoices::Default;
            prop_assert_eq!(followed.reached == MatchEnd::EndOfTrace, default);
        }
    }

    #[test]
    fn a_false_door_departs_there(
        graph in any_graph(Class::Multigraph, 12), part in any::<prop::sample::Index>(),
    ) {
        // A door that is not there, and the next one, which the folding explorer never takes.
        for (algorithm, by) in [(Algorithm1, 1000), (Folding, 1)] {
            let trace = explored_by(algorithm, &graph, Dart(0));
            let moves = part.index(trace.doors().len());
            let taken = trace.doors()[moves];
            let mut false_door = trace.up_to(2 * moves + 1);
            false_door.doors[moves] = Door(taken.0 + by);
            let followed = match_algorithm(algorithm, &false_door, TraceClaim::Whole, 100);
            let MatchEnd::Departure(departure) = followed.reached else {
                panic!("it is followed")
            };
            prop_assert_eq!(departure.event.id, 2 * moves + 1);
            prop_assert!(departure.allowed.iter().any(|allowed| allowed.action == Some(Action::Take(taken))));
            prop_assert!(algorithm == Algorithm1 || departure.allowed.len() == 1);
        }
    }
}

#[test]
fn the_folding_explorer_departs_with_its_purpose() {
    let graph = lollipop();
    let trace = explored_by(Folding, &graph, Dart(0));
    let mut wrong = trace.clone();
    wrong.doors[1] = Door(0);
    let followed = match_algorithm(Folding, &wrong, TraceClaim::Part, 100);
    let MatchEnd::Departure(departure) = followed.reached else { panic!() };
    assert_eq!(departure.event.id, 3);
    let allowed: Vec<_> = departure.allowed.iter().map(ToString::to_string).collect();
    assert_eq!(allowed, ["door 1 (explores the open dart 1 of vertex v1)"]);
    // At its end it has nothing left to do.
    let mut doors = trace.doors().to_vec();
    doors.push(Door(0));
    let longer = walked(&graph, Dart(0), &doors);
    let followed = match_algorithm(Folding, &longer, TraceClaim::Part, 100);
    let MatchEnd::Departure(departure) = followed.reached else { panic!() };
    assert_eq!(departure.event.id, 2 * doors.len() - 1);
    assert_eq!(departure.allowed[0].purpose, StepPurpose::NoOpenDart);
    // The start of another degree than the marker shows later is a contradiction.
    let mut contradicted = trace;
    let last = contradicted.percepts.len() - 1;
    contradicted.percepts[0].degree = 2;
    assert_ne!(contradicted.percepts[last].sighting, Sighting::Nothing);
    let followed = match_algorithm(Folding, &contradicted, TraceClaim::Part, 100);
    assert!(matches!(followed.reached, MatchEnd::Departure(_)));
}
