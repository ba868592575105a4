//! Folded trails against worlds, against brute force over all small worlds, and against each other.

use std::collections::BTreeMap;

use proptest::prelude::*;

use super::*;
use crate::{
    aid::State,
    any_graph::{Class, any_graph, starts, walk},
    direction::Direction,
    embedded_graph::{Dart, EmbeddedGraph},
    isomorphism::code,
    marker::{DirectedEdge, Directional, Marker, NoMarker},
    percept::{CompassView, Sighting},
    world::{GraphWorld, World},
};

/// What a robot perceives from a pose on a walk, and its doors.
fn walk_with<M: Marker + Copy>(
    marker: M,
    graph: &EmbeddedGraph,
    facing: Dart,
    pose: Dart,
    turns: &[u8],
) -> (Vec<Percept>, Vec<Door>) {
    let world = GraphWorld::with_aid(graph, marker, facing);
    let world = world.clone().at(State { pose, ..world.state() });
    walk(world, turns.iter().copied().map(u32::from))
}

/// The numbers of vertices and of open darts, by an equivalence of darts that grows until it is closed;
/// `None` if it contradicts itself. There is one vertex for each percept.
fn forced_equivalence(percepts: &[Percept], doors: &[Door]) -> Option<(usize, usize)> {
    let darts: Vec<(usize, u32)> = (0..percepts.len())
        .flat_map(|visit| (0..percepts[visit].degree).map(move |door| (visit, door)))
        .collect();
    let at = |wanted: (usize, u32)| darts.iter().position(|&dart| dart == wanted).unwrap();
    let clockwise = |dart: usize| {
        let (visit, door) = darts[dart];
        at((visit, (door + 1) % percepts[visit].degree))
    };
    let marked = |dart: usize| {
        let (visit, door) = darts[dart];
        percepts[visit].sighting == Sighting::Pointing(Door(door))
    };
    let mut edges: Vec<(usize, usize)> = Vec::new();
    for (moves, door) in doors.iter().enumerate() {
        let (left, entered) = (at((moves, door.0)), at((moves + 1, 0)));
        edges.extend([(left, entered), (entered, left)]);
    }
    // The class of each dart: its smallest member.
    let mut class: Vec<usize> = (0..darts.len()).collect();
    let merge = |class: &mut Vec<usize>, one: usize, other: usize| {
        let (low, high) = (class[one].min(class[other]), class[one].max(class[other]));
        class.iter_mut().filter(|class| **class == high).for_each(|class| *class = low);
        low != high
    };
    let sightings: Vec<usize> = (0..darts.len()).filter(|&dart| marked(dart)).collect();
    let mut changed = true;
    while changed {
        changed = false;
        for pair in sightings.windows(2) {
            changed |= merge(&mut class, pair[0], pair[1]);
        }
        for one in 0..darts.len() {
            for other in 0..one {
                if class[one] == class[other] {
                    if percepts[darts[one].0].degree != percepts[darts[other].0].degree {
                        return None;
                    }
                    changed |= merge(&mut class, clockwise(one), clockwise(other));
                }
            }
        }
        for &(one, far) in &edges {
            for &(other, other_far) in &edges {
                if class[one] == class[other] {
                    changed |= merge(&mut class, far, other_far);
                }
            }
        }
    }
    let alike = |one: usize, other: usize| class[one] == class[other];
    let contradicts = (0..darts.len()).any(|one| {
        (0..one).any(|other| {
            alike(one, other) && (darts[one].0 == darts[other].0 || marked(one) != marked(other))
        })
    });
    if contradicts || edges.iter().any(|&(one, far)| alike(one, far)) {
        return None;
    }
    let classes = |wanted: &dyn Fn(usize) -> bool| {
        let mut found: Vec<usize> =
            (0..darts.len()).filter(|&dart| wanted(dart)).map(|dart| class[dart]).collect();
        found.sort_unstable();
        found.dedup();
        found
    };
    let all = classes(&|_| true);
    let joined = classes(&|dart| edges.iter().any(|&(one, _)| one == dart));
    // A vertex has as many classes of darts as darts.
    let mut vertices: Vec<Vec<usize>> = (0..percepts.len())
        .map(|visit| {
            let mut around: Vec<usize> =
                (0..percepts[visit].degree).map(|door| class[at((visit, door))]).collect();
            around.sort_unstable();
            around
        })
        .collect();
    vertices.sort_unstable();
    vertices.dedup();
    Some((vertices.len(), all.len() - joined.len()))
}

/// Whether a walk fits a world, with the marker by any facing dart or with none, from any pose.
/// Whether a walk fits a world, with the marker by any facing dart or with none, from any pose.
fn explains(
    marker: &dyn Marker,
    graph: &EmbeddedGraph,
    percepts: &[Percept],
    doors: &[Door],
) -> bool {
    let fits = |mut world: GraphWorld<'_, &dyn Marker>| {
        percepts.iter().enumerate().all(|(moves, &percept)| {
            let door = doors.get(moves).copied();
            world.sensed() == percept && door.is_none_or(|door| world.traverse(door).is_ok())
        })
    };
    let bare = GraphWorld::with_aid(graph, &NoMarker as &dyn Marker, Dart(0));
    let marked = graph.darts().map(|facing| GraphWorld::with_aid(graph, marker, facing));
    marked.chain([bare]).any(|world| {
        graph.darts().any(|pose| fits(world.clone().at(State { pose, ..world.state() })))
    })
}

fn percept(degree: u32, door: Option<u32>) -> Percept {
    let sighting = door.map_or(Sighting::Nothing, |door| Sighting::Pointing(Door(door)));
    Percept { degree, sighting }
}

fn reason(percepts: &[Percept], doors: &[u32]) -> (usize, ContradictionReason) {
    let doors: Vec<Door> = doors.iter().copied().map(Door).collect();
    match fold(percepts, &doors) {
        Err(FoldError { event, error: TrailError::Contradiction(reason) }) => {
            (event.index(), reason)
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn each_contradiction_has_its_reason() {
    use ContradictionReason as Why;
    let corner = percept(2, None);
    assert_eq!(reason(&[percept(0, None)], &[]), (0, Why::NoDoors));
    let past = Why::MarkerDoor { door: 2, degree: 2 };
    assert_eq!(reason(&[percept(2, Some(2))], &[]), (0, past));
    assert_eq!(reason(&[corner], &[2]), (1, Why::NoSuchDoor { door: 2, degree: 2 }));
    // There and back.
    let degree = Why::Degree { visits: [0, 2], degrees: [2, 3] };
    assert_eq!(reason(&[corner, corner, percept(3, None)], &[1, 0]), (4, degree));
    let sightings = [Sighting::Nothing, Sighting::Pointing(Door(0))];
    let marker = Why::Marker { visits: [0, 2], sightings };
    assert_eq!(reason(&[corner, corner, percept(2, Some(0))], &[1, 0]), (4, marker));
    // Two sightings of the marker, at places with different degrees.
    let apart = Why::Degree { visits: [0, 1], degrees: [1, 2] };
    assert_eq!(reason(&[percept(1, Some(0)), percept(2, Some(0))], &[0]), (2, apart));
    // The robot leaves by the marked door, and comes in by it.
    let own = Why::OwnOpposite { visit: 0 };
    assert_eq!(reason(&[percept(3, Some(1)), percept(3, Some(0))], &[1]), (2, own));
    // Back over an edge, the marker points another way.
    let [there, back] = [percept(2, Some(0)), percept(2, Some(0))];
    let sightings = [Sighting::Pointing(Door(1)), Sighting::Pointing(Door(0))];
    let turned = Why::Marker { visits: [0, 2], sightings };
    assert_eq!(reason(&[there, corner, back], &[1, 0]), (4, turned));
}

/// A robot that starts at the marked edge of a ring with its back to it passes the arrow after a whole round.
#[test]
fn an_arrow_on_an_edge_of_a_ring_closes_it() {
    let corner = |sighting| Percept { degree: 2, sighting };
    let [plain, against, along] =
        [Sighting::Nothing, Sighting::PassedAgainst, Sighting::PassedAlong].map(corner);
    let trail = fold(&[against, plain, plain], &[Door(1); 2]).unwrap();
    assert_eq!((trail.vertex_count(), trail.open_count(), trail.is_complete()), (3, 2, false));
    let trail = fold(&[against, plain, plain, against], &[Door(1); 3]).unwrap();
    assert_eq!((trail.vertex_count(), trail.open_count(), trail.is_complete()), (3, 0, true));
    assert_eq!(trail.marker(), Some(Dart(0)));
    // The other way round.
    let trail = fold(&[against, along, plain], &[Door(0), Door(1)]).unwrap();
    assert_eq!((trail.vertex_count(), trail.marker()), (3, Some(Dart(0))));
    let trail = fold(&[against, along, plain, plain], &[Door(0), Door(1), Door(1)]).unwrap();
    assert_eq!((trail.vertex_count(), trail.open_count()), (4, 2));
    // From the other end of the marked edge.
    let trail = fold(&[along, plain, plain, along], &[Door(1); 3]).unwrap();
    assert!(trail.is_complete());
    assert_eq!(trail.marker(), trail.opposite(Dart(0)));
}

#[test]
fn an_arrow_that_is_there_once_and_not_again_is_a_contradiction() {
    use Sighting::{Nothing, PassedAgainst, PassedAlong};
    let marker = |visits, sightings| ContradictionReason::Marker { visits, sightings };
    let corner = |sighting| Percept { degree: 2, sighting };
    let walked = |sightings: &[Sighting], doors: &[u32]| {
        let percepts: Vec<_> = sightings.iter().copied().map(corner).collect();
        reason(&percepts, doors)
    };
    // There and back.
    assert_eq!(
        walked(&[Nothing, PassedAlong, Nothing], &[1, 0]),
        (4, marker([0, 2], [PassedAgainst, Nothing]))
    );
    assert_eq!(
        walked(&[Nothing, Nothing, PassedAlong], &[1, 0]),
        (4, marker([0, 2], [Nothing, PassedAlong]))
    );
    // It starts on the edge, and is not seen when the robot goes back over it.
    assert_eq!(
        walked(&[PassedAgainst, Nothing], &[0]),
        (2, marker([1, 1], [PassedAlong, Nothing]))
    );
    // A loop on which the robot comes in against the arrow, whichever way it goes.
    assert_eq!(
        walked(&[PassedAgainst, PassedAgainst], &[0]).1,
        ContradictionReason::OwnOpposite { visit: 0 }
    );
}

#[test]
fn a_rotation_of_a_vertex_is_a_contradiction() {
    let mut trail = FoldedTrail::new(percept(3, None)).unwrap();
    let error = trail.unite(Dart(0), Dart(1));
    assert_eq!(error, Err(ContradictionReason::Rotation { visit: 0 }));
}

#[test]
fn a_trail_with_too_many_darts_is_refused_and_proves_nothing() {
    let huge = percept(u32::MAX, None);
    let error = FoldError { event: WalkEvent::Percept(0), error: TrailError::TooManyDarts };
    assert_eq!(fold(&[huge], &[]).unwrap_err(), error);
}

/// The root of a dart, its opposite, the length of its edge, and its direction.
type DartState = (Dart, Option<Dart>, LengthInterval, Option<Direction>);

/// Every function of a trail that a union could change.
fn state(trail: &FoldedTrail, darts: usize) -> (usize, usize, Vec<DartState>) {
    let darts = (0..darts as u32).map(Dart);
    let of_dart = |dart| {
        let (length, direction) = (trail.length(dart), trail.direction(dart));
        (trail.root_of(dart), trail.opposite(dart), length, direction)
    };
    let darts = darts.map(of_dart).collect();
    (trail.vertex_count(), trail.open_count(), darts)
}

/// A world, the dart that its marker points along, the dart by which the robot comes in, and its turns.
fn long_walk() -> impl Strategy<Value = (EmbeddedGraph, Dart, Dart, Vec<u8>)> {
    let darts = any::<[prop::sample::Index; 2]>();
    let turns = prop::collection::vec(any::<u8>(), 0..60);
    (any_graph(Class::Multigraph, 9), darts, turns).prop_map(|(graph, darts, turns)| {
        let [facing, start] = darts.map(|dart| Dart(dart.index(graph.dart_count()) as u32));
        (graph, facing, start, turns)
    })
}

/// The folded trail with its dead ends explains the walk. If it is complete it is the world.
fn explains_the_walk<M: Marker + Copy>(
    marker: M,
    (graph, facing, start, turns): &(EmbeddedGraph, Dart, Dart, Vec<u8>),
) -> Result<(), TestCaseError> {
    let (percepts, doors) = walk_with(marker, graph, *facing, *start, turns);
    let trail = fold(&percepts, &doors).unwrap();
    let ClosedTrail { graph: closed, marker: placed, .. } = trail.closed().unwrap();
    prop_assert!(explains(&marker, &closed, &percepts, &doors));
    let is_seen = percepts.iter().any(|percept| percept.sighting != Sighting::Nothing);
    prop_assert_eq!(placed.is_some(), is_seen);
    if trail.is_complete() {
        prop_assert_eq!(code(&closed, placed.unwrap()), code(graph, *facing));
    }
    Ok(())
}

/// A walk that ends with a false percept is reported as a contradiction exactly if no world explains it.
fn reported_exactly<M: Marker + Copy>(
    marker: M,
    (mut percepts, mut doors): (Vec<Percept>, Vec<Door>),
    wrong: prop::sample::Index,
    lie: Percept,
) -> Result<(), TestCaseError> {
    let wrong = wrong.index(percepts.len());
    percepts.truncate(wrong);
    percepts.push(lie);
    doors.truncate(wrong);
    let folded = fold(&percepts, &doors);
    // A folded trail with its dead ends explains the walk, so no more edges are needed.
    let most = folded.as_ref().map_or(5, |trail| trail.closed().unwrap().graph.edge_count());
    if most <= 5 {
        let mut worlds = (1..=most).flat_map(|edges| starts(Class::Multigraph, edges));
        let is_explained = worlds.any(|graph| explains(&marker, &graph, &percepts, &doors));
        prop_assert_eq!(folded.is_ok(), is_explained);
    }
    Ok(())
}

/// What a robot senses on a walk with the directional marker: for each percept a length, and the quarter turns by which its compass
/// is wrong there, or `None` if it shows nothing. Doors of vertices with up to four darts lead north, east, south and west, in the
/// order of the darts.
fn sensed_on_walk(
    graph: &EmbeddedGraph,
    doors: &[Door],
    measured: &[(u32, Option<u32>)],
) -> Vec<ArrivalSenses> {
    let mut pose = Dart(0);
    let mut senses = Vec::new();
    for (number, &(length, turn)) in measured.iter().enumerate() {
        let around = (0..graph.degree_around(pose)).map(|door| graph.behind(pose, Door(door)));
        let view = |turn| {
            let direction = |dart| Direction::North.turned(graph.index(dart) + turn);
            CompassView::new(around.map(direction))
        };
        let length = Some(LengthInterval::measured(length, 100));
        senses.push(ArrivalSenses { length, compass: turn.map(view) });
        pose = doors.get(number).map_or(pose, |&door| graph.after(pose, door));
    }
    senses
}

/// A walk with what was sensed after each percept, folded.
fn fold_sensing(
    percepts: &[Percept],
    doors: &[Door],
    senses: &[ArrivalSenses],
) -> Result<FoldedTrail, TrailError> {
    let mut trail = FoldedTrail::new(percepts[0])?;
    trail.sense(senses[0])?;
    for ((&door, &percept), &senses) in doors.iter().zip(&percepts[1..]).zip(&senses[1..]) {
        trail.step(door, percept)?;
        trail.sense(senses)?;
    }
    Ok(trail)
}

/// The lengths of all edges that were traversed, by the larger of their darts in a trail that was folded without senses; `None` if
/// an edge has two lengths, or a vertex two views.
fn sensed_of_each(
    trail: &FoldedTrail,
    doors: &[Door],
    senses: &[ArrivalSenses],
) -> Option<BTreeMap<Dart, LengthInterval>> {
    let (mut lengths, mut views) = (BTreeMap::new(), BTreeMap::new());
    let mut pose = trail.start();
    for (number, senses) in senses.iter().enumerate() {
        let degree = trail.degree(pose);
        let seen: Vec<_> = senses.compass.iter().flat_map(|view| view.directions()).collect();
        if seen.len() == degree as usize {
            for (door, &direction) in (0..degree).zip(&seen) {
                let dart = trail.behind(pose, Door(door));
                if *views.entry(dart).or_insert(direction) != direction {
                    return None;
                }
            }
        }
        if let Some(far) = trail.opposite(pose).filter(|_| number > 0) {
            let length = lengths.entry(pose.max(far)).or_insert(LengthInterval::ANY);
            *length = length.intersection(senses.length.unwrap())?;
        }
        let Some(&door) = doors.get(number) else { break };
        pose = trail.opposite(trail.behind(pose, door)).unwrap();
    }
    Some(lengths)
}

/// Walks may begin anywhere in the same world. The first visit of the second one is after one move more, which was none.
#[test]
fn a_second_walk_counts_as_a_move() {
    let [marked, plain] = [Sighting::Pointing(Door(0)), Sighting::Nothing]
        .map(|sighting| Percept { degree: 2, sighting });
    let mut trail = FoldedTrail::new(marked).unwrap();
    trail.begin_walk(plain).unwrap();
    assert_eq!((trail.moves(), trail.vertex_count()), (1, 2));
    trail.step(Door(1), plain).unwrap();
    trail.step(Door(1), marked).unwrap();
    assert_eq!((trail.moves(), trail.vertex_count(), trail.open_count()), (3, 3, 2));
}

/// Doors are counted modulo the degree, however large they are.
#[test]
fn a_door_beyond_the_degree_is_one_of_the_first_round() {
    let percept = Percept { degree: 3, sighting: Sighting::Nothing };
    let trail = FoldedTrail::new(percept).unwrap();
    for pose in 0..3 {
        for door in (0..10).chain([u32::MAX - 2, u32::MAX]) {
            let dart = Dart((pose + door % 3) % 3);
            assert_eq!(trail.behind(Dart(pose), Door(door)), dart, "{pose} {door}");
        }
    }
}

proptest! {
    /// Memory that is kept from an earlier walk, whatever it showed, changes nothing.
    #[test]
    fn a_trail_that_is_used_again_is_as_good_as_new(
        graphs in [any_graph(Class::Multigraph, 6), any_graph(Class::Multigraph, 6)],
        turns in [prop::collection::vec(any::<u8>(), 0..25), prop::collection::vec(any::<u8>(), 0..25)],
        wrong in any::<prop::sample::Index>(),
    ) {
        let [earlier, later] = [0, 1].map(|one| {
            walk_with(Directional, &graphs[one], Dart(0), Dart(0), &turns[one])
        });
        let mut used = FoldedTrail::default();
        used.restart(earlier.0[0]).unwrap();
        for (at, (&door, &percept)) in earlier.1.iter().zip(&earlier.0[1..]).enumerate() {
            let is_wrong = wrong.index(earlier.1.len()) == at;
            let degree = percept.degree + u32::from(is_wrong);
            let senses = ArrivalSenses { length: Some(LengthInterval::exact(at as u32 + 1)), ..Default::default() };
            if used.step(door, Percept { degree, ..percept }).is_err() || used.sense(senses).is_err() {
                break;
            }
        }
        // What its user takes to be one, as far as nothing contradicts it.
        for dart in 1..used.dart_count() as u32 {
            let _ = used.unite(Dart(0), Dart(dart));
        }
        used.restart(later.0[0]).unwrap();
        let mut closed = 0;
        used.for_each_closed_dart(|_, _| closed += 1);
        prop_assert_eq!(closed, 0);
        let mut new = FoldedTrail::new(later.0[0]).unwrap();
        for (&door, &percept) in later.1.iter().zip(&later.0[1..]) {
            used.step(door, percept).unwrap();
            new.step(door, percept).unwrap();
        }
        let shown = |trail: &FoldedTrail| {
            let darts = (0..trail.dart_count() as u32).map(Dart);
            let lengths: Vec<_> = darts.map(|dart| trail.length(dart)).collect();
            let counts = (trail.vertex_count(), trail.open_count(), trail.moves(), trail.marker());
            (trail.seen_from_robot(), counts, lengths)
        };
        prop_assert_eq!(shown(&used), shown(&new));
    }

    #[test]
    fn senses_contradict_exactly_if_an_edge_has_two_lengths_or_a_vertex_two_views(
        graph in any_graph(Class::Multigraph, 6),
        turns in prop::collection::vec(any::<u8>(), 0..25),
        length in 1000_u32..1300,
        shown in prop::collection::vec(any::<bool>(), 26),
        wrong in prop::option::of((any::<prop::sample::Index>(), 900_u32..1400, 0_u32..4)),
    ) {
        let (percepts, doors) = walk_with(Directional, &graph, Dart(0), Dart(0), &turns);
        let of_visit = shown.iter().map(|&is_shown| (length, is_shown.then_some(0)));
        let mut measured: Vec<_> = of_visit.take(percepts.len()).collect();
        if let Some((at, length, turn)) = wrong {
            measured[at.index(percepts.len())] = (length, Some(turn));
        }
        let senses = sensed_on_walk(&graph, &doors, &measured);
        let sensing = fold_sensing(&percepts, &doors, &senses);
        let trail = fold(&percepts, &doors).unwrap();
        let lengths = sensed_of_each(&trail, &doors, &senses);
        prop_assert_eq!(sensing.is_ok(), lengths.is_some());
        for (dart, length) in lengths.into_iter().flatten() {
            let sensing = sensing.as_ref().unwrap();
            let far = sensing.opposite(dart).unwrap();
            prop_assert_eq!([dart, far].map(|dart| sensing.length(dart)), [length; 2]);
        }
    }

    #[test]
    fn the_folded_trail_is_the_smallest_equivalence_of_the_darts_that_the_walk_forces(
        graph in any_graph(Class::Multigraph, 5),
        turns in prop::collection::vec(any::<u8>(), 0..14),
        lie in prop::option::of((any::<prop::sample::Index>(), 1_u32..4)),
    ) {
        let (mut percepts, doors) = walk_with(Directional, &graph, Dart(0), Dart(0), &turns);
        if let Some((wrong, degree)) = lie {
            percepts[wrong.index(turns.len() + 1)] = percept(degree, None);
        }
        prop_assume!(doors.iter().zip(&percepts).all(|(door, percept)| door.0 < percept.degree));
        let folded = fold(&percepts, &doors).ok();
        let counts = folded.map(|trail| (trail.vertex_count(), trail.open_count()));
        prop_assert_eq!(counts, forced_equivalence(&percepts, &doors));
    }

    #[test]
    fn the_folded_trail_explains_the_walk_and_is_the_world_if_it_is_complete(walk in long_walk()) {
        explains_the_walk(Directional, &walk)?;
        explains_the_walk(DirectedEdge, &walk)?;
    }

    #[test]
    fn a_contradiction_is_reported_exactly_if_no_world_explains_the_walk(
        graph in any_graph(Class::Multigraph, 3),
        start in any::<[prop::sample::Index; 2]>(),
        turns in prop::collection::vec(0_u8..4, 0..4),
        wrong in any::<prop::sample::Index>(),
        lie in (1_u32..4, prop::option::of(0_u32..3)),
    ) {
        let [facing, pose] = start.map(|dart| Dart(dart.index(graph.dart_count()) as u32));
        let (degree, seen) = lie;
        let marked = percept(degree, seen.map(|door| door % degree));
        let walked = walk_with(Directional, &graph, facing, facing, &turns);
        reported_exactly(Directional, walked, wrong, marked)?;
        let arrow = [Sighting::Nothing, Sighting::PassedAlong, Sighting::PassedAgainst];
        let sighting = arrow[seen.unwrap_or(0) as usize];
        let walked = walk_with(DirectedEdge, &graph, facing, pose, &turns);
        reported_exactly(DirectedEdge, walked, wrong, Percept { degree, sighting })?;
    }

    #[test]
    fn a_union_is_undone_completely(
        graph in any_graph(Class::Multigraph, 8),
        turns in prop::collection::vec(any::<u8>(), 0..40),
        shown in prop::collection::vec(any::<bool>(), 41),
        pairs in prop::collection::vec(any::<(prop::sample::Index, prop::sample::Index)>(), 1..6),
    ) {
        let (percepts, doors) = walk_with(Directional, &graph, Dart(0), Dart(0), &turns);
        let lengths = (1000..).step_by(2);
        let of_visit = lengths.zip(&shown).map(|(length, shown)| (length, shown.then_some(0)));
        let measured: Vec<_> = of_visit.take(percepts.len()).collect();
        let senses = sensed_on_walk(&graph, &doors, &measured);
        let mut trail = fold_sensing(&percepts, &doors, &senses).unwrap();
        let darts: usize = trail.dart_count();
        for (one, other) in pairs {
            let [one, other] = [one, other].map(|index| Dart(index.index(darts) as u32));
            let before = state(&trail, darts);
            let united = trail.with_united(one, other, |trail| trail.root_of(one) == trail.root_of(other));
            prop_assert_eq!(&state(&trail, darts), &before);
            prop_assert!(united.unwrap_or(true));
            // What fails changes nothing. What was sensed stays true.
            if trail.unite(one, other).is_err() {
                prop_assert_eq!(&state(&trail, darts), &before);
            }
            for (dart, (_, _, length, direction)) in (0..).map(Dart).zip(before.2) {
                prop_assert_eq!(trail.length(dart).intersection(length), Some(trail.length(dart)));
                prop_assert_eq!(trail.direction(dart).filter(|_| direction.is_some()), direction);
            }
        }
    }

    #[test]
    fn what_follows_if_a_leaf_is_a_known_place_is_what_a_union_shows(
        graph in any_graph(Class::Multigraph, 8),
        turns in prop::collection::vec(any::<u8>(), 0..40),
        numbered in any::<prop::sample::Index>(),
    ) {
        let (percepts, doors) = walk_with(Directional, &graph, Dart(0), Dart(0), &turns);
        let mut trail = fold(&percepts, &doors).unwrap();
        let darts: Vec<Dart> = (0..trail.dart_count()).map(|dart| Dart(dart as u32)).collect();
        let numbered = darts[numbered.index(darts.len())];
        trail.set_numbers(numbered, 7);
        for &leaf in darts.iter().filter(|&&dart| trail.is_leaf(dart)).collect::<Vec<_>>() {
            for &dart in &darts {
                if trail.vertex(dart) == trail.vertex(leaf) || !trail.takes_leaf(dart, leaf) {
                    continue;
                }
                let mut closed = Vec::new();
                trail.for_each_closed_by_leaf(leaf, dart, |dart, number| closed.push((dart, number)));
                let united = trail.with_united(leaf, dart, |united| {
                    let mut closed = Vec::new();
                    united.for_each_closed_dart(|dart, far| closed.push((dart, united.number(far))));
                    closed.sort_unstable();
                    closed
                });
                closed.sort_unstable();
                prop_assert_eq!(united, Ok(closed));
            }
        }
    }
}
