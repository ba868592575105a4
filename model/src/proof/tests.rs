use proptest::prelude::*;

use super::*;
use crate::{
    aid::{Action, AidAction, markers::MOVABLE},
    ambiguity::Comparison,
    any_graph::{Class, any_graph},
    folding::FoldedTrail,
    mapping::{MappingEvent, MappingMethod, MovableEvent, SafeguardEvent},
    marker::{MARKERS, NoMarker, Undirected},
    percept::{Door, MarkerSet, Percept, Sighting},
    trace::{Trace, TraceEventKind},
    visits::{ChosenAlternative, VisitAlternative, VisitSet, VisitWay},
    world::GraphWorld,
};

/// How folded trails end: the number of open darts, or the visit that contradicts those before it.
fn end_of_trail(walk: &PerceivedWalk) -> Result<usize, usize> {
    let mut trail = FoldedTrail::new(walk.percepts()[0]).map_err(|_| 0_usize)?;
    for (move_, (&door, &percept)) in walk.doors().iter().zip(&walk.percepts()[1..]).enumerate() {
        trail.step(door, percept).map_err(|_| move_ + 1)?;
    }
    Ok(trail.open_count())
}

fn end_of_steps(walk: &PerceivedWalk, marker: MarkerKind) -> Result<usize, usize> {
    match fold_walk(walk, marker).end {
        // Folded trails leave it to their users that the marker was not seen.
        WalkEnd::Complete
        | WalkEnd::Contradiction { contradiction: WalkContradiction::Unmarked, .. } => Ok(0),
        WalkEnd::Open(open) => Ok(open),
        WalkEnd::Contradiction { visit, .. } => Err(visit),
    }
}

/// The text in `docs/proofs-of-verdicts.md`.
#[test]
fn the_proof_of_two_parallel_edges_is_that_of_the_page() {
    let ring = EmbeddedGraph::cycle(2);
    let walk = PerceivedWalk::in_world((&ring, Dart(0)), Directional, Dart(0), &[Door(1), Door(1)]);
    let proof = Proof::of_map(&ring, Dart(0), walk).unwrap().to_string();
    let page = include_str!("../../../docs/proofs-of-verdicts.md");
    assert!(page.contains(&format!("```text\n{proof}```")), "{proof}");
}

/// The visits of that page, and a bound that they reach.
#[test]
fn the_proof_of_impossible_visits_is_that_of_the_page() {
    let seen = |degree, door, sighting| {
        let percept = Percept { degree, sighting };
        Some(VisitAlternative { percept, door })
    };
    let (nothing, pointing) = (Sighting::Nothing, Sighting::Pointing(Door(0)));
    let corner = |door, sighting| seen(2, Some(Door(door)), sighting);
    let end = seen(1, Some(Door(0)), nothing);
    let mut visits = vec![
        VisitSet::new([corner(1, nothing), corner(0, pointing)], VisitWay::Through),
        VisitSet::new([None, end], VisitWay::Back),
        VisitSet::new([seen(3, None, nothing)], VisitWay::Through),
    ];
    let proof = Proof::of_impossible_visits(&visits, 2, Directional).unwrap().to_string();
    let page = include_str!("../../../docs/proofs-of-verdicts.md");
    assert!(page.contains(&format!("```text\n{proof}```")), "{proof}");
    let possible = Proof::of_impossible_visits(&visits, 1, Directional).unwrap_err();
    assert_eq!(possible, NotProved::PossibleInSomeWorld);
    // Between two vertices with the marker, of which one has another degree, are many of which nothing is known.
    let through = |alternative| VisitSet::new([alternative], VisitWay::Through);
    let any = [1, 2, 3].map(|degree| seen(degree, None, nothing));
    visits = vec![through(corner(1, pointing))];
    visits.extend(vec![VisitSet::new(any, VisitWay::Through); 12]);
    visits.push(through(seen(1, Some(Door(0)), pointing)));
    let long = Proof::of_impossible_visits(&visits, 13, Directional).unwrap_err();
    assert_eq!(long, NotProved::TooManyChoices);
    // Visits that do not matter are no part of a proof.
    visits.push(VisitSet::new([], VisitWay::Through));
    let none = Proof::of_impossible_visits(&visits, 14, Directional).unwrap().to_string();
    assert!(none.ends_with("visits\nvisit through\nclaim impossible\nend\n"), "{none}");
}

/// The run of that page. Runs with other aids have no proof.
#[test]
fn the_run_with_a_marker_that_is_carried_is_that_of_the_page() {
    let ring = EmbeddedGraph::cycle(2);
    let mut world = GraphWorld::with_aid(&ring, MOVABLE, Dart(0));
    let mut events = vec![TraceEventKind::Percept(world.sensed())];
    let next = Action::Take(Door(1));
    let [pick_up, drop] = [AidAction::PickUp, AidAction::Drop].map(Action::Do);
    for (action, is_seen) in [(pick_up, true), (next, true), (drop, false), (next, true)] {
        world.act(action).unwrap();
        events.push(match action {
            Action::Take(door) => TraceEventKind::Door(door),
            Action::Do(action) => TraceEventKind::Action(action),
        });
        events.extend(is_seen.then(|| TraceEventKind::Percept(world.sensed())));
    }
    let trace = Trace::new(events).unwrap();
    let run = PerceivedRun::new(MOVABLE.into(), &trace).unwrap();
    let (worlds, claims) = (vec![(&ring, Dart(0))], vec![Claim::Conforms { from: Dart(0) }]);
    let proof = Proof { worlds, marker: NoMarker, seen: Some(Seen::Run(run)), claims }.to_string();
    let page = include_str!("../../../docs/proofs-of-verdicts.md");
    assert!(page.contains(&format!("```text\n{proof}```")), "{proof}");
    let fixed = PerceivedRun::new(Undirected.into(), &trace);
    assert_eq!(fixed, Err(NotProved::Aid("undirected")));
    let dropped = Trace::new([
        TraceEventKind::Percept(world.sensed()),
        TraceEventKind::Action(AidAction::DropMarker(1)),
    ]);
    assert_eq!(
        PerceivedRun::new(MOVABLE.into(), &dropped.unwrap()),
        Err(NotProved::Action(AidAction::DropMarker(1)))
    );
}

#[test]
fn each_claim_is_written_with_what_shows_it() {
    let walks = || vec![WalkPair { from: [Dart(1), Dart(3)], doors: vec![Door(2), Door(0)] }];
    let steps = || vec![UnionStep::Mark([0, 2])];
    let chosen = |number, door| ChosenAlternative { number, door };
    for (claim, lines) in [
        (Claim::Determined { from: Dart(1), steps: steps() }, "determined\nfrom 1\nmark 0 2"),
        (
            Claim::Unexplained { steps: steps(), contradiction: WalkContradiction::Door(3) },
            "unexplained\nmark 0 2\ncontradiction door 3",
        ),
        (Claim::Conforms { from: Dart(4) }, "conforms\nfrom 4"),
        (Claim::Diverges { from: None }, "diverges\nfrom any"),
        (Claim::Diverges { from: Some(vec![Dart(0), Dart(2)]) }, "diverges\nfrom 0 2"),
        (
            Claim::Fits { from: Dart(2), choice: vec![chosen(1, None), chosen(0, Some(Door(2)))] },
            "fits\nfrom 2\nchoose 1\nchoose 0 2",
        ),
        (Claim::Misfits { from: Some(vec![Dart(5)]) }, "misfits\nfrom 5"),
        (
            Claim::Impossible {
                lines: vec![ChoiceLine::Choose(chosen(0, None)), ChoiceLine::BackElsewhere],
            },
            "impossible\nchoose 0\ncontradiction back",
        ),
        (
            Claim::Indistinguishable { pairs: vec![[Dart(0), Dart(1)], [Dart(2), Dart(3)]] },
            "indistinguishable\npair 0 1\npair 2 3",
        ),
        (Claim::Distinguishable { walks: walks() }, "distinguishable\nfrom 1 3\ndoor 2\ndoor 0"),
        (Claim::NotIsomorphic { walks: walks() }, "not-isomorphic\nfrom 1 3\ndoor 2\ndoor 0"),
        (Claim::Isomorphic { images: vec![Dart(1), Dart(0)] }, "isomorphic\nimage 0 1\nimage 1 0"),
    ] {
        assert_eq!(claim.to_string(), format!("claim {lines}\nend\n"));
    }
}

/// The poses of a bisimulation: equal doors lead from each pair to another one.
#[test]
fn rings_that_a_marker_does_not_distinguish_have_a_bisimulation() {
    let ring = EmbeddedGraph::cycle(3);
    let comparison = Comparison::new(NoMarker, (&ring, Dart(0)), (&ring, Dart(0)));
    let poses = [Dart(0), Dart(2)];
    let Claim::Indistinguishable { pairs } = Claim::indistinguishable(&comparison, poses) else {
        panic!()
    };
    assert_eq!(pairs[0], poses);
    for pair in &pairs {
        for door in [0, 1].map(Door) {
            let next = pair.map(|pose| ring.opposite(ring.behind(pose, door)));
            assert!(pairs.contains(&next), "{next:?}");
        }
    }
}

/// A mark on an edge is seen by a robot that comes over it; other markers lie at their vertex.
#[test]
fn a_robot_that_turns_back_sees_the_same_vertex_and_another_edge() {
    let seen = |sighting| {
        let percept = Percept { degree: 2, sighting };
        let alternative = Some(VisitAlternative { percept, door: Some(Door(1)) });
        VisitSet::new([alternative], VisitWay::Through)
    };
    let proved = |again, marker| {
        let visits = [seen(Sighting::Nothing), VisitSet::turned_back(), seen(again)];
        Proof::of_impossible_visits(&visits, 2, marker).map(|_| ())
    };
    let possible = Err(NotProved::PossibleInSomeWorld);
    assert_eq!(proved(Sighting::Passed, MarkerKind::UndirectedEdge), possible);
    assert_eq!(proved(Sighting::PassedAlong, MarkerKind::DirectedEdge), possible);
    assert_eq!(proved(Sighting::Pointing(Door(0)), Directional), Ok(()));
    assert_eq!(proved(Sighting::Lying(1), Undirected), Ok(()));
    assert_eq!(proved(Sighting::Nothing, Directional), possible);
}

#[test]
fn a_robot_that_turns_back_twice_goes_on() {
    let seen = |degree| {
        let percept = Percept { degree, sighting: Sighting::Nothing };
        let alternative = Some(VisitAlternative { percept, door: Some(Door(1)) });
        VisitSet::new([alternative], VisitWay::Through)
    };
    let proved = |turns: usize| {
        let turned = vec![VisitSet::turned_back(); turns];
        let visits = [vec![seen(3)], turned, vec![seen(4)]].concat();
        Proof::of_impossible_visits(&visits, turns + 1, NoMarker).map(|_| ())
    };
    let possible = Err(NotProved::PossibleInSomeWorld);
    assert_eq!([0, 1, 2, 3].map(proved), [possible.clone(), Ok(()), possible, Ok(())]);
}

#[test]
fn what_is_too_large_or_seen_of_another_aid_has_no_proof() {
    let none = VisitSet::new([None], VisitWay::Through);
    let proved = |count| {
        let visits = vec![none.clone(); count];
        Proof::of_impossible_visits(&visits, count, NoMarker).map(|_| ())
    };
    assert_eq!(proved(1000), Err(NotProved::PossibleInSomeWorld));
    assert_eq!(proved(1001), Err(NotProved::TooManyChoices));
    let seen = |degree| Percept { degree, sighting: Sighting::Nothing };
    let large = Some(VisitAlternative { percept: seen(u32::MAX), door: Some(Door(0)) });
    let visits = [VisitSet::new([large], VisitWay::Through)];
    let proof = Proof::of_impossible_visits(&visits, 0, NoMarker).map(|_| ());
    assert_eq!(proof, Err(NotProved::TooManyDarts));
    let most = u32::try_from(crate::folding::MAX_DARTS).unwrap();
    assert!(PerceivedWalk::new(&[seen(most)], &[]).is_ok());
    assert_eq!(
        PerceivedWalk::new(&[seen(most), seen(1)], &[Door(0)]),
        Err(NotProved::TooManyDarts)
    );
    let sighting = Sighting::Lying(3);
    let three = Trace::new([TraceEventKind::Percept(Percept { degree: 2, sighting })]).unwrap();
    let run = PerceivedRun::new(MOVABLE.into(), &three);
    assert_eq!(run, Err(NotProved::Sighting(sighting)));
}

#[test]
fn a_vertex_has_a_door() {
    let walk =
        PerceivedWalk::new(&[Percept { degree: 0, sighting: Sighting::Nothing }], &[]).unwrap();
    let contradiction = WalkContradiction::Percept(0);
    assert_eq!(fold_walk(&walk, NoMarker).end, WalkEnd::Contradiction { visit: 0, contradiction });
}

#[test]
fn a_walk_that_no_world_gives_is_cut_where_it_contradicts_itself() {
    let seen = |degree| Percept { degree, sighting: Sighting::Nothing };
    // It goes back, and finds another number of doors; what follows does not matter.
    let percepts = [2, 1, 3, 2].map(seen);
    let walk = PerceivedWalk::new(&percepts, &[Door(1), Door(0), Door(1)]).unwrap();
    let (cut, claim) = unexplained(&walk, NoMarker).unwrap();
    assert_eq!((cut.percepts(), cut.doors()), (&percepts[..3], &[Door(1), Door(0)][..]));
    assert!(matches!(claim, Claim::Unexplained { .. }));
    let ring = EmbeddedGraph::cycle(3);
    let walk = PerceivedWalk::in_world((&ring, Dart(0)), NoMarker, Dart(0), &[Door(1), Door(1)]);
    assert_eq!(unexplained(&walk, NoMarker), None);
}

#[test]
fn a_walk_determines_its_world_with_a_directional_marker_and_no_open_door() {
    let open = |doors| NotProved::Open(doors).to_string();
    assert_eq!(open(1), "the walk does not determine its world: 1 door was never followed");
    assert_eq!(open(2), "the walk does not determine its world: 2 doors were never followed");
    let chain = EmbeddedGraph::chain(1);
    let walk =
        |marker, doors: &[Door]| PerceivedWalk::in_world((&chain, Dart(0)), marker, Dart(0), doors);
    let [there, back] = [1, 2].map(|moves| vec![Door(0); moves]);
    let determined = |marker, doors: &[Door]| {
        Claim::determined(&walk(marker, doors), marker, Dart(0)).map(|_| ())
    };
    assert_eq!(determined(Directional, &back), Ok(()));
    assert_eq!(determined(NoMarker, &back), Err(NotProved::OtherMarker));
    assert_eq!(determined(Directional, &there), Ok(()));
    assert_eq!(determined(Directional, &[]), Err(NotProved::Open(1)));
}

#[test]
fn a_walk_that_leaves_a_door_open_has_no_proof() {
    let ring = EmbeddedGraph::cycle(3);
    let walk = PerceivedWalk::in_world((&ring, Dart(0)), Directional, Dart(0), &[Door(1), Door(1)]);
    assert_eq!(Proof::of_map(&ring, Dart(0), walk).unwrap_err(), NotProved::Open(2));
}

/// A log may say that a junction has any number of doors.
#[test]
fn a_walk_along_too_many_doors_has_no_proof() {
    let seen = |degree| [Percept { degree, sighting: Sighting::Nothing }; 2];
    assert_eq!(PerceivedWalk::new(&seen(u32::MAX), &[Door(0)]), Err(NotProved::TooManyDarts));
    assert!(PerceivedWalk::new(&seen(1000), &[Door(0)]).is_ok());
}

/// A robot leaves the marked vertex by its door 1, and comes back to it by the same dart: that edge has one end.
#[test]
fn no_edge_has_one_end_only() {
    let seen = |door| Percept { degree: 2, sighting: Sighting::Pointing(Door(door)) };
    let walk = PerceivedWalk::new(&[seen(0), seen(1)], &[Door(1)]).unwrap();
    let contradiction = WalkContradiction::Edge(0);
    assert_eq!(
        fold_walk(&walk, Directional).end,
        WalkEnd::Contradiction { visit: 1, contradiction }
    );
    // By the other dart it is a loop.
    let walk = PerceivedWalk::new(&[seen(0), seen(0)], &[Door(1)]).unwrap();
    assert_eq!(fold_walk(&walk, Directional).end, WalkEnd::Complete);
}

#[test]
fn each_sighting_of_a_fixed_marker_has_a_word_and_is_seen_with_its_markers_only() {
    use MarkerKind::{TwoDistinct, TwoIdentical, UndirectedEdge};
    let these = |numbers: &[usize]| {
        Sighting::These(MarkerSet::from_numbers(numbers.iter().copied()).unwrap())
    };
    for (sighting, word, markers) in [
        (Sighting::Pointing(Door(1)), Some("pointing 1"), &[Directional][..]),
        (Sighting::Pointing(Door(2)), Some("pointing 2"), &[]),
        (Sighting::Nothing, Some("nothing"), &MARKERS),
        (Sighting::Lying(1), Some("lying"), &[Undirected, TwoIdentical]),
        (Sighting::Lying(2), Some("two"), &[TwoIdentical]),
        (Sighting::Lying(3), None, &[]),
        (these(&[0]), Some("first"), &[TwoDistinct]),
        (these(&[1]), Some("second"), &[TwoDistinct]),
        (these(&[0, 1]), Some("both"), &[TwoDistinct]),
        (these(&[2]), None, &[]),
        (Sighting::Passed, Some("passed"), &[UndirectedEdge]),
        (Sighting::PassedAlong, Some("along"), &[MarkerKind::DirectedEdge]),
        (Sighting::PassedAgainst, Some("against"), &[MarkerKind::DirectedEdge]),
    ] {
        assert_eq!(text::word(sighting).as_deref(), word, "{sighting:?}");
        let seen = Percept { degree: 2, sighting };
        let Ok(walk) = PerceivedWalk::new(&[seen], &[]) else {
            assert_eq!(word, None, "what has no word is part of no walk");
            continue;
        };
        for marker in MARKERS {
            let contradiction = WalkContradiction::Percept(0);
            let is_impossible =
                fold_walk(&walk, marker).end == WalkEnd::Contradiction { visit: 0, contradiction };
            assert_eq!(is_impossible, !markers.contains(&marker), "{sighting:?}, {marker:?}");
        }
    }
}

#[test]
fn a_run_of_a_robot_that_got_lost_or_moved_its_marker_is_no_walk() {
    let percept = Percept { degree: 1, sighting: Sighting::Nothing };
    let with = |event| {
        let mut recorder = WalkRecorder::default();
        recorder.event(MappingEvent::Started { percept });
        recorder.event(event);
        recorder.walk().err()
    };
    assert_eq!(with(MappingEvent::Moved { door: Door(0), percept }), None);
    let lost = MappingEvent::Safeguard(SafeguardEvent::Relocated);
    assert_eq!(with(lost), Some(NotProved::Lost));
    let dropped = MappingEvent::Movable(MovableEvent::Did(AidAction::Drop));
    assert_eq!(with(dropped), Some(NotProved::Action(AidAction::Drop)));
}

#[test]
fn a_walk_differs_from_a_world_where_its_percepts_or_doors_do() {
    let ring = EmbeddedGraph::cycle(3);
    let doors = [Door(1); 4];
    let walk = PerceivedWalk::in_world((&ring, Dart(0)), Directional, Dart(0), &doors);
    let in_ring = |of| {
        let larger = EmbeddedGraph::cycle(of);
        walk.first_difference((&larger, Dart(0)), Directional, Dart(0))
    };
    assert_eq!((in_ring(3), in_ring(4), in_ring(2)), (None, Some(3), Some(2)));
    let chain = EmbeddedGraph::chain(3);
    let [none, one] = [NoMarker, Directional]
        .map(|marker| PerceivedWalk::in_world((&chain, Dart(0)), marker, Dart(0), &[Door(1)]));
    assert_eq!(none.percepts().len(), 1);
    assert_eq!(one.doors(), []);
}

#[test]
fn what_a_marker_never_shows_is_a_contradiction() {
    let seen = |sighting| {
        let walk = PerceivedWalk::new(&[Percept { degree: 2, sighting }], &[]).unwrap();
        move |marker| end_of_steps(&walk, marker).is_err()
    };
    let pointing = seen(Sighting::Pointing(Door(1)));
    assert!(!pointing(Directional) && pointing(Undirected) && pointing(NoMarker));
    assert!(seen(Sighting::Pointing(Door(2)))(Directional));
    let lying = seen(Sighting::Lying(1));
    assert!(!lying(Undirected) && lying(Directional));
}

#[test]
fn without_a_place_for_the_marker_no_world_gives_a_walk() {
    let alone = Percept { degree: 1, sighting: Sighting::Nothing };
    let walk = PerceivedWalk::new(&[alone, alone], &[Door(0)]).unwrap();
    let visit = 1;
    let contradiction = WalkContradiction::Unmarked;
    assert_eq!(fold_walk(&walk, Directional).end, WalkEnd::Contradiction { visit, contradiction });
    assert_eq!(fold_walk(&walk, NoMarker).end, WalkEnd::Complete);
}

#[test]
fn worlds_that_differ_have_a_walk_for_each_dart() {
    let [ring, larger] = [3, 4].map(EmbeddedGraph::cycle);
    let Claim::NotIsomorphic { walks } = Claim::isomorphism(&ring, &larger) else { panic!() };
    assert_eq!(walks.len(), larger.dart_count());
    for WalkPair { from: [one, other], doors } in walks {
        let walk = |graph, from| PerceivedWalk::in_world((graph, from), Directional, from, &doors);
        assert_ne!(walk(&ring, one).percepts().last(), walk(&larger, other).percepts().last());
    }
}

fn any_walk() -> impl Strategy<Value = (EmbeddedGraph, Dart, Dart, Vec<Door>)> {
    let index = any::<prop::sample::Index>;
    let doors = proptest::collection::vec(any::<u8>(), 0..60);
    (any_graph(Class::Multigraph, 12), index(), index(), doors).prop_map(
        |(graph, facing, from, numbers)| {
            let dart = |index: prop::sample::Index| Dart(index.index(graph.dart_count()) as u32);
            let (facing, from) = (dart(facing), dart(from));
            let mut pose = from;
            let door = |number| {
                let door = Door(u32::from(number) % graph.degree_around(pose));
                pose = graph.opposite(graph.behind(pose, door));
                door
            };
            let doors = numbers.into_iter().map(door).collect();
            (graph, facing, from, doors)
        },
    )
}

proptest! {
    /// The steps show what folding shows: as many open darts, or the same first contradiction, if one percept is
    /// wrong.
    #[test]
    fn steps_fold_as_folded_trails_do(
        (graph, facing, from, doors) in any_walk(),
        is_marked in any::<bool>(),
        lie in any::<(prop::sample::Index, bool, u8)>(),
        lies in any::<bool>(),
    ) {
        let marker = if is_marked { Directional } else { NoMarker };
        let mut walk = PerceivedWalk::in_world((&graph, facing), marker, from, &doors);
        if lies {
            let mut percepts = walk.percepts().to_vec();
            let (visit, changes_degree, number) = lie;
            let wrong = &mut percepts[visit.index(doors.len() + 1)];
            if changes_degree {
                wrong.degree = 1 + u32::from(number) % 5;
            } else if is_marked {
                let door = Door(u32::from(number) % (wrong.degree + 1));
                wrong.sighting = if door.0 == 0 { Sighting::Nothing } else { Sighting::Pointing(door) };
            }
            walk = PerceivedWalk::new(&percepts, walk.doors()).unwrap();
        }
        prop_assert_eq!(end_of_steps(&walk, marker), end_of_trail(&walk));
    }

    /// No marker contradicts itself.
    #[test]
    fn a_walk_in_a_world_has_no_contradiction((graph, facing, from, doors) in any_walk()) {
        for marker in MARKERS {
            let walk = PerceivedWalk::in_world((&graph, facing), marker, from, &doors);
            prop_assert!(end_of_steps(&walk, marker).is_ok(), "{}", marker.name());
        }
    }

    /// There are at most as many steps as visits.
    #[test]
    fn a_map_of_algorithm_1_is_proved(
        graph in any_graph(Class::Multigraph, 20),
        facing in any::<prop::sample::Index>(),
    ) {
        let facing = Dart(facing.index(graph.dart_count()) as u32);
        let mut recorder = WalkRecorder::default();
        let mut world = GraphWorld::new(&graph, facing);
        MappingMethod::default()
            .map_world(&mut world, graph.dart_count(), &[], &mut recorder)
            .1
            .unwrap();
        let walk = recorder.walk().unwrap();
        let visits = walk.percepts().len();
        let proof = Proof::of_map(&graph, facing, walk).unwrap();
        let [Claim::Determined { steps, .. }] = &proof.claims[..] else { panic!() };
        prop_assert!(steps.len() < visits);
    }
}
