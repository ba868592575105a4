//! Sets of percepts against each of their choices, and against every walk in every small world.

use std::collections::BTreeSet;

use proptest::{collection::vec, prelude::*};

use super::*;
use crate::{
    aid::State,
    aid::markers::MOVABLE,
    any_graph::{Class, StopAt, any_graph, by_neighbours, starts},
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Watch,
    mapping::MappingAlgorithm,
    marker::{Directional, Marker, NoMarker},
    percept::Sighting,
    proof::Proof,
    trace::{
        MatchEnd, Trace, TraceClaim, TraceEventKind, anywhere, match_algorithm, poses,
        tests::{explored_by, lollipop},
    },
    world::{GraphWorld, World},
};

#[expect(clippy::unnecessary_wraps, reason = "as it is among alternatives")]
fn unmarked(degree: u32, door: u32) -> Option<VisitAlternative> {
    let percept = Percept { degree, sighting: Sighting::Nothing };
    Some(VisitAlternative { percept, door: Some(Door(door)) })
}

fn explanation(
    visits: &[VisitSet],
    is_marked: bool,
    bound: usize,
    watch: &dyn Watch,
) -> Explanation {
    explain(visits, is_marked, bound, watch).0
}

/// Every choice of some visits.
fn choices(visits: &[VisitSet]) -> Vec<Vec<VisitSet>> {
    visits.iter().fold(vec![Vec::new()], |choices, visit| {
        let with = |choice: &Vec<VisitSet>| {
            let one = |&alternative: &_| {
                let mut choice = choice.clone();
                choice.push(VisitSet::new([alternative], visit.way()));
                choice
            };
            visit.alternatives().iter().map(one).collect::<Vec<_>>()
        };
        choices.iter().flat_map(with).collect()
    })
}

/// Whether a robot that drives as one choice says, moving in the world itself, perceives what it says. Only visits that
/// are all decided, with doors.
fn drives(
    graph: &EmbeddedGraph,
    marker: impl Marker + Copy,
    start: State,
    choice: &[VisitSet],
) -> bool {
    let mut world = GraphWorld::with_aid(graph, marker, start.pose).at(start);
    // The robot is somewhere on the edge before the vertex that the world has it at; to turn back there is to drive
    // on to the vertex, to take the way back, and to be before the other end of the edge.
    for visit in choice {
        match visit.alternatives() {
            [None] if visit.way() == VisitWay::Through => {}
            [None] => world.traverse(Door::BACK).unwrap(),
            [Some(VisitAlternative { percept, door: Some(door) })] => {
                if world.sensed() != *percept || world.traverse(*door).is_err() {
                    return false;
                }
            }
            other => panic!("{other:?}"),
        }
    }
    true
}

/// Visits with up to three alternatives each, of vertices with up to three doors.
fn any_visits(
    marked: bool,
    degrees: std::ops::RangeInclusive<u32>,
    most: usize,
) -> impl Strategy<Value = Vec<VisitSet>> {
    let alternative =
        (degrees, 0..3_u32, 0..6_u32, 0..4_u8).prop_map(move |(degree, door, at, kind)| {
            let sighting = if marked && at < degree {
                Sighting::Pointing(Door(at))
            } else {
                Sighting::Nothing
            };
            let percept = Percept { degree, sighting };
            (kind > 0).then_some(VisitAlternative { percept, door: Some(Door(door % degree)) })
        });
    let visit = (vec(alternative, 1..=3), any::<bool>()).prop_map(|(alternatives, back)| {
        VisitSet::new(alternatives, if back { VisitWay::Back } else { VisitWay::Through })
    });
    vec(visit, 1..=most)
}

#[test]
fn a_visit_that_may_be_none_leaves_the_robot_on_its_edge() {
    // A tail, and a triangle.
    let graph = by_neighbours("end: a | a: end b c | b: a c | c: b a");
    let poses = |visits: &[VisitSet]| {
        let states = states_after(&graph, &NoMarker, &anywhere(&graph, &NoMarker), visits);
        states.into_iter().map(|states| states.len()).collect::<Vec<_>>()
    };
    let fork = |with_none: bool| {
        VisitSet::new(
            [unmarked(3, 1)].into_iter().chain(with_none.then_some(None)),
            VisitWay::Through,
        )
    };
    assert_eq!(poses(&[fork(false)]), [3]);
    assert_eq!(poses(&[fork(true)]), [8]);
    let end = VisitSet::new([unmarked(1, 0)], VisitWay::Back);
    // From the end one comes to the fork, or is still on the way.
    assert_eq!(poses(&[end.clone(), fork(false), end.clone()]), [1, 1, 0]);
    assert_eq!(poses(&[end.clone(), fork(true), end.clone()]), [1, 2, 0]);
    // A robot that turns back before the fork comes to the end again.
    assert_eq!(poses(&[end.clone(), VisitSet::turned_back(), end.clone()]), [1, 1, 1]);
    assert_eq!(poses(&[end.clone(), end]), [1, 0]);
    // Where the log ends, no door was taken.
    let stands = VisitAlternative { door: None, ..unmarked(3, 0).unwrap() };
    let standing = VisitSet::new([Some(stands)], VisitWay::Through);
    assert_eq!(poses(std::slice::from_ref(&standing)), [3]);
    // Elsewhere any door may have been taken: of the ring, which has two ways round, or into the tail.
    assert_eq!(poses(&[standing, VisitSet::new([unmarked(1, 0)], VisitWay::Back)]), [3, 1]);
}

#[test]
fn a_door_that_does_not_exist_leads_nowhere() {
    let graph = EmbeddedGraph::cycle(3);
    let visit = |door| VisitSet::new([unmarked(2, door)], VisitWay::Through);
    let poses = |visit: &VisitSet| {
        let visits = std::slice::from_ref(visit);
        states_after(&graph, &NoMarker, &anywhere(&graph, &NoMarker), visits)[0].len()
    };
    assert_eq!([0, 1, 2, u32::MAX].map(|door| poses(&visit(door))), [6, 6, 0, 0]);
    let open = Some(VisitAlternative { door: None, ..unmarked(2, 0).unwrap() });
    let all = VisitSet::new([unmarked(2, 2), unmarked(2, 1), None, open], VisitWay::Back);
    let existing = all.with_existing_doors();
    assert_eq!(existing, VisitSet::new([None, open, unmarked(2, 1)], VisitWay::Back));
    assert!(visit(1).is_certain() && !existing.is_certain());
    assert!(!VisitSet::new([], VisitWay::Through).is_certain());
}

#[test]
fn turning_back_contradicts_a_vertex_that_has_another_degree_then() {
    let visit = |degree, door| VisitSet::new([unmarked(degree, door)], VisitWay::Through);
    let turned = VisitSet::turned_back;
    let impossible = |visits: &[VisitSet]| match explanation(visits, false, 1000, &()) {
        Explanation::Impossible { visit } => Some(visit),
        Explanation::Explained(_) => None,
        Explanation::NotKnown => panic!("there are few choices"),
    };
    assert_eq!(impossible(&[visit(3, 1), turned(), visit(3, 1)]), None);
    assert_eq!(impossible(&[visit(3, 1), turned(), visit(4, 1), visit(3, 1)]), Some(2));
    assert_eq!(impossible(&[visit(3, 1), turned(), turned(), visit(4, 1)]), None);
    // Round a fork, back into its tail.
    assert_eq!(impossible(&[visit(1, 0), visit(3, 0), visit(1, 0)]), None);
    assert_eq!(impossible(&[visit(1, 0), visit(3, 0), visit(2, 1)]), Some(2));
    assert_eq!(impossible(&[VisitSet::new([], VisitWay::Through)]), Some(0));
    assert_eq!(impossible(&[]), None);
}

/// By whatever door it left a dead end, it is at the fork before it again.
#[test]
fn a_door_that_is_not_known_is_any_door() {
    let visit = |degree, door| VisitSet::new([unmarked(degree, door)], VisitWay::Through);
    let open = |degree| {
        let open = VisitAlternative { door: None, ..unmarked(degree, 0).unwrap() };
        VisitSet::new([Some(open)], VisitWay::Through)
    };
    let found = |visits: &[VisitSet]| explanation(visits, false, 1000, &());
    let impossible = Explanation::Impossible { visit: 2 };
    assert_eq!(found(&[visit(3, 1), open(1), visit(4, 1)]), impossible);
    assert!(matches!(found(&[visit(3, 1), open(1), visit(3, 1)]), Explanation::Explained(_)));
    assert!(matches!(found(&[visit(3, 1), open(2), open(4)]), Explanation::Explained(_)));
    // So it is to an algorithm.
    let graph = lollipop();
    let run = explored_by(MappingAlgorithm::Folding, &graph, Dart(0));
    let open = |&percept: &Percept| {
        VisitSet::new([Some(VisitAlternative { percept, door: None })], VisitWay::Through)
    };
    let visits: Vec<_> = run.percepts().iter().map(open).collect();
    let by_folding = |watch: &dyn Watch| {
        explain_by_algorithm(MappingAlgorithm::Folding, &visits, None, BOUNDS, watch)
    };
    assert!(matches!(by_folding(&()), Explanation::Explained(_)));
    assert_eq!(by_folding(&StopAt::new(1)), Explanation::NotKnown);
}

#[test]
fn a_search_that_is_stopped_or_reaches_its_bound_knows_nothing() {
    let visits = vec![VisitSet::new([unmarked(3, 1)], VisitWay::Through); 20];
    // Before each visit the trail has the three darts of each earlier one.
    let needed = (0..20).map(|visit| 3 * visit + 1).sum();
    assert!(matches!(explanation(&visits, false, needed, &()), Explanation::Explained(_)));
    assert_eq!(explanation(&visits, false, needed - 1, &()), Explanation::NotKnown);
    assert_eq!(explanation(&visits, false, needed, &StopAt::new(20)), Explanation::NotKnown);
    assert!(matches!(
        explanation(&visits, false, needed, &StopAt::new(21)),
        Explanation::Explained(_)
    ));
}

#[test]
fn what_was_tried_in_vain_is_not_tried_again() {
    // Each of 40 visits may be no vertex, which no world shows; the last two contradict each other.
    let either = VisitSet::new([None, unmarked(2, 1)], VisitWay::Through);
    let fork = |degree| VisitSet::new([unmarked(degree, 1)], VisitWay::Through);
    let mut visits = vec![fork(3)];
    visits.extend(vec![either; 40]);
    visits.extend([fork(3), VisitSet::turned_back(), fork(4)]);
    assert_eq!(explanation(&visits, false, 100_000, &()), Explanation::Impossible { visit: 43 });
}

/// Every walk of some visits as an algorithm makes it: where it turned back, it was at a dead end.
fn walks(visits: &[VisitSet]) -> Vec<Vec<VisitAlternative>> {
    let dead_end = |sighting| VisitAlternative {
        percept: Percept { degree: 1, sighting },
        door: Some(Door::BACK),
    };
    let vertices = |visit: &VisitSet| {
        let mut vertices = Vec::new();
        for &alternative in visit.alternatives() {
            if alternative.is_none() && visit.way() == VisitWay::Back {
                let sightings = [Sighting::Nothing, Sighting::Pointing(Door::BACK)];
                vertices.extend(sightings.map(|sighting| Some(dead_end(sighting))));
            } else {
                vertices.push(alternative);
            }
        }
        vertices
    };
    visits.iter().fold(vec![Vec::new()], |walks, visit| {
        let with = |walk: &Vec<VisitAlternative>| {
            let one = |vertex| walk.iter().copied().chain(vertex).collect();
            vertices(visit).into_iter().map(one).collect::<Vec<_>>()
        };
        walks.iter().flat_map(with).collect()
    })
}

/// Whether an algorithm takes the doors of a walk, in a graph or in some world.
fn takes(
    algorithm: MappingAlgorithm,
    walk: &[VisitAlternative],
    graph: Option<&EmbeddedGraph>,
) -> bool {
    let kinds = walk.iter().flat_map(|vertex| {
        let door = vertex.door.map(TraceEventKind::Door);
        [TraceEventKind::Percept(vertex.percept)].into_iter().chain(door)
    });
    let Ok(trace) = Trace::new(kinds) else { return walk.is_empty() };
    let reached = match_algorithm(algorithm, &trace, TraceClaim::Part, 200).reached;
    let is_explained = if let Some(graph) = graph {
        let starts = anywhere(graph, &Directional);
        poses(graph, &Directional, &starts, &trace).misfit.is_none()
    } else {
        let visit = |&vertex: &_| VisitSet::new([Some(vertex)], VisitWay::Through);
        let visits: Vec<_> = walk.iter().map(visit).collect();
        matches!(explanation(&visits, true, 100_000, &()), Explanation::Explained(_))
    };
    is_explained && matches!(reached, MatchEnd::Mapped | MatchEnd::EndOfTrace)
}

const BOUNDS: AlgorithmSearchBounds = AlgorithmSearchBounds { darts: 200, steps: 100_000 };

#[test]
fn the_doors_of_a_whole_run_are_among_those_of_open_visits() {
    let graph = lollipop();
    for algorithm in [MappingAlgorithm::Folding, MappingAlgorithm::Algorithm1] {
        let trace = explored_by(algorithm, &graph, Dart(0));
        let visit = |(at, &percept): (usize, &Percept)| {
            let door = trace.doors().get(at).copied();
            let truth = [Some(VisitAlternative { percept, door })];
            let others = [None, unmarked(3, 1), unmarked(4, 2)];
            VisitSet::new(truth.into_iter().chain(others), VisitWay::Through)
        };
        let visits: Vec<_> = trace.percepts().iter().enumerate().map(visit).collect();
        let start = [GraphWorld::new(&graph, Dart(0)).state()];
        let world = Some((&graph, &start[..]));
        let found = explain_by_algorithm(algorithm, &visits, world, BOUNDS, &());
        assert!(matches!(found, Explanation::Explained(_)), "{algorithm}");
        // The map is complete: no move follows.
        let certain: Vec<_> = trace
            .percepts()
            .iter()
            .zip(trace.doors())
            .map(|(&percept, &door)| {
                VisitSet::new(
                    [Some(VisitAlternative { percept, door: Some(door) })],
                    VisitWay::Through,
                )
            })
            .collect();
        let last = trace.percepts()[certain.len()];
        let more = |door| {
            let door = VisitAlternative { percept: last, door };
            let visits = [&certain[..], &[VisitSet::new([Some(door)], VisitWay::Through)]].concat();
            explain_by_algorithm(algorithm, &visits, world, BOUNDS, &())
        };
        assert!(matches!(more(None), Explanation::Explained(_)), "{algorithm}");
        if algorithm == MappingAlgorithm::Folding {
            let none = Explanation::Impossible { visit: certain.len() };
            assert_eq!(more(Some(Door::BACK)), none);
        }
        for bounds in [
            AlgorithmSearchBounds { steps: 3, ..BOUNDS },
            AlgorithmSearchBounds { darts: 2, ..BOUNDS },
        ] {
            let found = explain_by_algorithm(algorithm, &certain, world, bounds, &());
            assert_eq!(found, Explanation::NotKnown);
        }
    }
    let visits = [VisitSet::new([unmarked(3, 1)], VisitWay::Through)];
    let movable = MappingAlgorithm::MovableMarkers(MOVABLE);
    let found = explain_by_algorithm(movable, &visits, None, BOUNDS, &());
    assert_eq!(found, Explanation::NotKnown);
}

proptest! {
    #[test]
    fn an_algorithm_takes_the_doors_of_visits_exactly_if_it_takes_those_of_a_choice(
        graph in any_graph(Class::Multigraph, 4),
        others in any_visits(true, 1..=3, 4),
        kept in vec(0..4_u8, 4),
        folding in any::<bool>(),
        is_known in any::<bool>(),
    ) {
        let algorithm =
            if folding { MappingAlgorithm::Folding } else { MappingAlgorithm::Algorithm1 };
        let run = explored_by(algorithm, &graph, Dart(0));
        // Of most visits, what the run has there is among the alternatives; a dead end may be none.
        let visit = |(at, other): (usize, &VisitSet)| {
            let truth = run.percepts().get(at).zip(run.doors().get(at)).filter(|_| kept[at] > 0);
            let truth = truth.map(|(&percept, &door)| VisitAlternative { percept, door: Some(door) });
            let is_end = truth.is_some_and(|truth| truth.percept.degree == 1);
            if is_end && kept[at] == 1 {
                return VisitSet::turned_back();
            }
            let all = other.alternatives().iter().copied().chain(truth.map(Some));
            VisitSet::new(all, other.way())
        };
        let visits: Vec<_> = others.iter().enumerate().map(visit).collect();
        let starts = anywhere(&graph, &Directional);
        let world = is_known.then_some((&graph, &starts[..]));
        let taken = walks(&visits).iter().any(|walk| takes(algorithm, walk, world.map(|it| it.0)));
        match explain_by_algorithm(algorithm, &visits, world, BOUNDS, &()) {
            Explanation::Explained(choice) => {
                prop_assert!(taken, "{:?}", choice);
                let chosen = |(visit, one): (&VisitSet, &_)| visit.alternatives().contains(one);
                prop_assert!(visits.iter().zip(&choice).all(chosen));
                prop_assert_eq!(visits.len(), choice.len());
            }
            Explanation::Impossible { visit } => {
                prop_assert!(!taken);
                let before = explain_by_algorithm(algorithm, &visits[..visit], world, BOUNDS, &());
                prop_assert!(matches!(before, Explanation::Explained(_)));
            }
            Explanation::NotKnown => prop_assert!(false, "there are few choices"),
        }
    }

    /// A choice is found exactly if one fits, and a robot can then drive as it says.
    #[test]
    fn a_choice_that_is_found_fits(
        graph in any_graph(Class::Multigraph, 4),
        visits in any_visits(true, 1..=3, 5),
        open in vec(any::<bool>(), 5),
    ) {
        let opened = |alternative: &Option<VisitAlternative>| {
            alternative.map(|known| VisitAlternative { door: None, ..known })
        };
        let visits: Vec<_> = visits.iter().zip(open).map(|(visit, is_open)| {
            let alternatives = visit.alternatives();
            let alternatives: Vec<_> =
                if is_open { alternatives.iter().map(opened).collect() } else { alternatives.to_vec() };
            VisitSet::new(alternatives, visit.way())
        }).collect();
        let starts = anywhere(&graph, &Directional);
        let fits = states_after(&graph, &Directional, &starts, &visits).last().is_none_or(|last| !last.is_empty());
        let found = choice_in_world(&graph, &Directional, &starts, &visits);
        prop_assert_eq!(found.is_some(), fits);
        // What is left of a visit are the alternatives with which alone the others fit.
        let left = alternatives_left(&graph, &Directional, &starts, &visits);
        for (number, visit) in visits.iter().enumerate() {
            let with = |&&alternative: &&_| {
                let mut visits = visits.clone();
                visits[number] = VisitSet::new([alternative], visit.way());
                !states_after(&graph, &Directional, &starts, &visits).last().unwrap().is_empty()
            };
            let expected: Vec<_> = visit.alternatives().iter().filter(with).copied().collect();
            prop_assert_eq!(&left[number], &expected, "visit {}", number);
        }
        if let Some((start, choice)) = found {
            prop_assert!(starts.contains(&start));
            // A door is chosen where the alternative has none, and the robot leaves.
            for (index, (visit, chosen)) in visits.iter().zip(&choice).enumerate() {
                let is_open = visit.alternatives()[chosen.number].is_some_and(|it| it.door.is_none());
                prop_assert_eq!(chosen.door.is_some(), is_open && index + 1 < visits.len());
            }
            let chosen = visits.iter().zip(choice).map(|(visit, ChosenAlternative { number, door })| {
                // At the last visit the robot stays; it could take any door.
                let with_door = |known: VisitAlternative| VisitAlternative {
                    door: known.door.or(door).or(Some(Door::BACK)),
                    ..known
                };
                VisitSet::new([visit.alternatives()[number].map(with_door)], visit.way())
            });
            prop_assert!(drives(&graph, Directional, start, &chosen.collect::<Vec<_>>()));
        }
    }

    #[test]
    fn judging_sets_is_judging_each_choice(
        graph in any_graph(Class::Multigraph, 4),
        visits in any_visits(true, 1..=3, 5),
        marked in any::<bool>(),
    ) {
        let starts = if marked { anywhere(&graph, &Directional) } else { anywhere(&graph, &NoMarker) };
        let after = |visits: &[VisitSet]| {
            let after = if marked {
                states_after(&graph, &Directional, &starts, visits)
            } else {
                states_after(&graph, &NoMarker, &starts, visits)
            };
            if after.len() < visits.len() { Vec::new() } else { after.last().unwrap().clone() }
        };
        let each: BTreeSet<State> = choices(&visits).iter().flat_map(|choice| after(choice)).collect();
        prop_assert_eq!(&after(&visits), &each.into_iter().collect::<Vec<_>>());
        let drives = |start: &State| choices(&visits).iter().any(|choice| {
            if marked { drives(&graph, Directional, *start, choice) } else { drives(&graph, NoMarker, *start, choice) }
        });
        prop_assert_eq!(starts.iter().any(drives), !after(&visits).is_empty());
    }

    #[test]
    fn some_world_explains_visits_exactly_if_a_small_one_does(
        (marked, visits) in any::<bool>().prop_flat_map(|marked| {
            // Each open dart may lead to a dead end: four edges are enough.
            let visits = prop_oneof![any_visits(marked, 1..=2, 4), any_visits(marked, 1..=3, 2)];
            (Just(marked), visits)
        }),
    ) {
        let in_small = (1..=5).any(|edges| starts(Class::Multigraph, edges).iter().any(|graph| {
            let placed = if marked {
                vec![GraphWorld::new(graph, Dart(0)).state()]
            } else {
                anywhere(graph, &NoMarker)
            };
            let poses = placed.iter().flat_map(|&state| graph.darts().map(move |pose| State { pose, ..state }));
            let states: Vec<State> = poses.collect();
            let after = if marked {
                states_after(graph, &Directional, &states, &visits)
            } else {
                states_after(graph, &NoMarker, &states, &visits)
            };
            after.len() == visits.len() && !after[visits.len() - 1].is_empty()
        }));
        let marker = if marked { Directional } else { NoMarker };
        let (found, world) = explain(&visits, marked, 100_000, &());
        match found {
            Explanation::Explained(choice) => {
                prop_assert!(in_small, "{choice:?}");
                let proved = |world| Proof::of_visits_in_world(world, marker, &visits).is_ok();
                prop_assert!(world.as_ref().is_none_or(proved));
                let chosen = |(visit, one): (&VisitSet, &_)| visit.alternatives().contains(one);
                prop_assert!(visits.iter().zip(&choice).all(chosen));
                prop_assert_eq!(visits.len(), choice.len());
                let only: Vec<_> = visits.iter().zip(&choice)
                    .map(|(visit, &one)| VisitSet::new([one], visit.way())).collect();
                prop_assert!(matches!(explanation(&only, marked, 1000, &()), Explanation::Explained(_)));
            }
            Explanation::Impossible { visit } => {
                prop_assert!(!in_small);
                prop_assert!(Proof::of_impossible_visits(&visits, visit, marker).is_ok());
                let before = explanation(&visits[..visit], marked, 100_000, &());
                prop_assert!(matches!(before, Explanation::Explained(_)));
            }
            Explanation::NotKnown => prop_assert!(false, "there are few choices"),
        }
    }
}
