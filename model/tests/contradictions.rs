//! Each explorer ends on every world, also on one that breaks, lies, or has no end.

use proptest::prelude::*;
use toposlam_model::{
    aid::{AidAction, RefusedAction},
    embedded_graph::{Dart, EmbeddedGraph, MAX_EDGES, Vertex},
    folding::ContradictionReason,
    mapping::{
        Algorithm1Run, Contradiction, Explorer, FoldingRun, MappingAlgorithm, MappingError,
        MappingMethod, MovableMarkerRun, ObservedWorld, RecoveryConfig, Relocate, explore,
    },
    percept::{Door, DoorSet, MarkerSet, OtherRobot, Percept, Sighting, StringView, TeamView},
    world::{AidHandler, GraphWorld, World},
};

use crate::{marked, plain};

type Error = MappingError<RefusedAction>;

const BOUND: usize = 60;

fn lying(degree: u32) -> Percept {
    Percept { degree, sighting: Sighting::Lying(1) }
}

/// A sensor with scripted percepts, one a move, also such that no world has. The last one repeats. Actions are
/// refused if there is a reason.
struct ScriptedWorld<'s> {
    percepts: &'s [Percept],
    moves: usize,
    refused: Option<RefusedAction>,
}

impl ObservedWorld for ScriptedWorld<'_> {}

impl World for ScriptedWorld<'_> {
    type Error = RefusedAction;

    fn percept(&mut self) -> Result<Percept, RefusedAction> {
        Ok(self.percepts[self.moves.min(self.percepts.len() - 1)])
    }

    fn traverse(&mut self, _: Door) -> Result<(), RefusedAction> {
        self.moves += 1;
        self.refused.map_or(Ok(()), Err)
    }

    fn handler(&mut self) -> Option<&mut dyn AidHandler<Error = RefusedAction>> {
        Some(self)
    }
}

impl AidHandler for ScriptedWorld<'_> {
    type Error = RefusedAction;

    fn handle(&mut self, action: AidAction) -> Result<(), RefusedAction> {
        if let AidAction::Send { .. } = action {
            self.moves += 1;
        }
        let refused = |refused: &RefusedAction| {
            action == AidAction::PickUp && *refused == RefusedAction::NothingToPickUp
        };
        self.refused.filter(refused).map_or(Ok(()), Err)
    }
}

impl Relocate for ScriptedWorld<'_> {}

fn run<E: Explorer + Default>(percepts: &[Percept], bound: usize) -> Result<(), Error> {
    let mut explorer = E::default();
    explorer.limit_darts(bound);
    explore(&mut explorer, &mut ScriptedWorld { percepts, moves: 0, refused: None })
}

fn algorithm1(percepts: &[Percept]) -> Error {
    run::<Algorithm1Run>(percepts, BOUND).unwrap_err()
}

fn folding(percepts: &[Percept]) -> Error {
    run::<FoldingRun>(percepts, BOUND).unwrap_err()
}

fn movable(percepts: &[Percept]) -> Error {
    run::<MovableMarkerRun>(percepts, BOUND).unwrap_err()
}

fn known_place((vertex, index): (u32, u32), expected: Percept, perceived: Percept) -> Error {
    Contradiction::KnownPlace { vertex: Vertex(vertex), index, expected, perceived }.into()
}

// paper: alg1.1, alg1.terminates
#[test]
fn a_world_without_end_runs_into_the_bound() {
    let bound = |bound| MappingError::Bound { bound };
    for percepts in
        [&[marked(3, 0), plain(3)][..], &[marked(u32::MAX, 0)], &[marked(3, 0), plain(u32::MAX)]]
    {
        assert_eq!(algorithm1(percepts), bound(BOUND));
    }
    for percepts in [&[marked(3, 0), plain(3)][..], &[marked(u32::MAX, 0)]] {
        assert_eq!(folding(percepts), bound(BOUND));
    }
    // No two places look alike.
    let endless: Vec<_> = std::iter::once(lying(1)).chain((2..99).map(plain)).collect();
    for percepts in [&endless[..], &[lying(u32::MAX)], &[lying(3), plain(u32::MAX)]] {
        assert_eq!(movable(percepts), bound(BOUND));
    }
    // It is never more than the darts that can be numbered.
    let most = Err(bound(2 * MAX_EDGES));
    assert_eq!(run::<Algorithm1Run>(&[marked(u32::MAX, 0)], usize::MAX), most);
}

#[test]
fn a_start_without_its_marker_is_a_contradiction() {
    for perceived in [plain(3), plain(0), marked(3, 1), marked(0, 0)] {
        let expected = Error::from(Contradiction::Start { perceived });
        assert_eq!(algorithm1(&[perceived]), expected);
        assert_eq!(folding(&[perceived]), expected);
    }
    let two = Percept { degree: 3, sighting: Sighting::Lying(2) };
    for perceived in [plain(3), plain(0), lying(0), marked(3, 0), two] {
        let expected = Contradiction::StartWithoutMarker { perceived };
        assert_eq!(movable(&[perceived]), expected.into());
    }
    assert_eq!(
        movable(&[plain(3)]).to_string(),
        "the world contradicts itself: the marker must lie at the start, but there is degree 3 \
         without the marker"
    );
}

#[test]
fn a_percept_that_no_vertex_gives_is_a_contradiction() {
    for perceived in [plain(0), marked(2, 2), marked(0, 0)] {
        let expected = Error::from(Contradiction::Impossible { perceived });
        assert_eq!(algorithm1(&[marked(1, 0), perceived]), expected);
        assert_eq!(folding(&[marked(1, 0), perceived]), expected);
        assert_eq!(movable(&[lying(1), perceived]), expected);
    }
}

// paper: alg1.6
#[test]
fn a_known_place_that_changed_is_a_contradiction() {
    // A dead end behind each of two doors; but the start has three doors when met again, or the marker turned.
    for perceived in [marked(3, 0), marked(2, 1)] {
        let expected = known_place((0, 0), marked(2, 0), perceived);
        assert_eq!(algorithm1(&[marked(2, 0), plain(1), perceived]), expected);
    }
    assert_eq!(
        known_place((0, 0), marked(2, 0), marked(3, 0)).to_string(),
        "the world contradicts itself: at the known vertex v0, entered by its dart 0: expected \
         degree 2 with the marker along door 0, found degree 3 with the marker along door 0"
    );
}

#[test]
fn a_marker_where_it_cannot_be_is_a_contradiction() {
    for perceived in [marked(3, 1), marked(2, 0)] {
        let expected = Contradiction::Marker { vertex: Vertex(0), index: 0, perceived };
        assert_eq!(algorithm1(&[marked(2, 0), perceived]), expected.into());
    }
    for perceived in [lying(3), marked(3, 0)] {
        let expected = Contradiction::SecondMarker { vertex: Vertex(0), index: 0, perceived };
        assert_eq!(movable(&[lying(2), perceived]), expected.into());
    }
    assert_eq!(
        movable(&[lying(2), lying(3)]).to_string(),
        "the world contradicts itself: the robot carries the marker, but behind the unexplored \
         dart 0 of vertex v0 there is degree 3 with a marker lying there"
    );
    // At a known place, too.
    let expected = known_place((0, 0), plain(2), lying(2));
    assert_eq!(movable(&[lying(2), plain(1), lying(2)]), expected);
}

#[test]
fn a_way_back_that_changed_is_a_contradiction() {
    // v0 has one door, v1 behind it three; behind the second of these again three: is it v1, by its
    // third? The path back to v0 shows three doors again, and the way back of that shows two.
    let percepts = [marked(1, 0), plain(3), plain(3), plain(3), plain(2)];
    let expected = Contradiction::WayBack { expected: plain(3), perceived: plain(2) };
    assert_eq!(algorithm1(&percepts), expected.into());
}

#[test]
fn a_trail_that_contradicts_itself_is_an_error_with_the_visits() {
    // Behind each door of the start is a dead end; but the start has three doors when met again.
    let visits = [0, 2];
    let trail = |reason, expected| Error::from(Contradiction::Trail { reason, expected });
    let reason = ContradictionReason::Degree { visits, degrees: [2, 3] };
    let found = folding(&[marked(2, 0), plain(1), marked(3, 0)]);
    // The robot went back, so it is known what it should have seen.
    assert_eq!(found, trail(reason, Some(marked(2, 0))));
    assert_eq!(
        found.to_string(),
        "the world contradicts itself: the junctions after 0 and 2 moves are the same one, with 2 \
         doors and with 3"
    );
    // The marker may not turn, either.
    let sightings = [0, 1].map(|door| Sighting::Pointing(Door(door)));
    let reason = ContradictionReason::Marker { visits, sightings };
    let found = folding(&[marked(2, 0), plain(1), marked(2, 1)]);
    assert_eq!(found, trail(reason, Some(marked(2, 0))));
    // The marker is behind its own door, and is come to by it.
    let reason = ContradictionReason::OwnOpposite { visit: 0 };
    assert_eq!(folding(&[marked(3, 0), marked(3, 0)]), trail(reason, None));
}

/// Of a cycle: out to v1 and v2 and over the next edge, where the marker is dropped, for this may be
/// v0; back to v2, to v1, to v0.
fn cycle() -> [Percept; 7] {
    [lying(2), plain(2), plain(2), plain(2), plain(2), plain(2), plain(2)]
}

// paper: movable.place, movable.new
#[test]
fn a_known_place_that_changed_or_a_marker_that_is_gone_is_a_contradiction() {
    // On the way to an unexplored edge.
    let expected = known_place((0, 0), plain(2), plain(3));
    assert_eq!(movable(&[lying(2), plain(1), plain(3)]), expected);
    // At the known end, back from the unknown one, where the marker cannot be, either; at a vertex that the unknown
    // end cannot be; and at one that it can be.
    for (moves, place, wrong) in [
        (4, (2, 1), [plain(3), lying(2)]),
        (5, (1, 1), [plain(1), lying(2)]),
        (6, (0, 0), [plain(1), lying(3)]),
    ] {
        for perceived in wrong {
            let percepts = [&cycle()[..moves], &[perceived]].concat();
            assert_eq!(movable(&percepts), known_place(place, plain(2), perceived));
        }
    }
    // Where the marker was left.
    for perceived in [plain(2), lying(3)] {
        let percepts = [&cycle()[..], &[plain(2), plain(2), perceived]].concat();
        let expected = Contradiction::WayBack { expected: lying(2), perceived };
        assert_eq!(movable(&percepts), expected.into());
    }
}

/// Out to v1 and v2 and over the next edge to a place that looks like v0, and is; then the marker is
/// carried to v2, and the robot is back at v0, with two darts to try.
fn back_link() -> [Percept; 11] {
    let (two, three, here) = (plain(2), plain(3), lying(3));
    [here, two, two, three, two, two, here, two, two, two, three]
}

// paper: movable.back-link
#[test]
fn a_back_link_that_is_not_there_is_a_contradiction() {
    let with = |more: &[Percept]| movable(&[&back_link()[..], more].concat());
    let expected = Contradiction::NoBackLink { vertex: Vertex(0), marked: Vertex(2) };
    let error = with(&[plain(1), plain(3), plain(1), plain(3)]);
    assert_eq!(error, expected.into());
    assert_eq!(
        error.to_string(),
        "the world contradicts itself: an unexplored edge joins the vertices v2 and v0, but no \
         unexplored dart of v0 leads to the marker at v2"
    );
    // The marker lies at another vertex than where it was dropped.
    assert_eq!(with(&[lying(3)]), known_place((2, 1), lying(2), lying(3)));
    // The vertex looks different after a dart that did not lead there.
    assert_eq!(with(&[plain(1), plain(2)]), known_place((0, 1), plain(3), plain(2)));
    assert_eq!(with(&[plain(1), lying(3)]), known_place((0, 1), plain(3), lying(3)));
}

#[test]
fn the_worlds_own_error_is_passed_on() {
    fn error<E: Explorer + Default>(percept: Percept, refused: RefusedAction) -> Error {
        let mut world = ScriptedWorld { percepts: &[percept], moves: 0, refused: Some(refused) };
        explore(&mut E::default(), &mut world).unwrap_err()
    }
    let door = RefusedAction::NoSuchDoor { door: Door(0), degree: 0 };
    assert_eq!(error::<Algorithm1Run>(marked(2, 0), door), MappingError::World(door));
    for refused in [door, RefusedAction::NothingToPickUp] {
        assert_eq!(error::<MovableMarkerRun>(lying(2), refused), MappingError::World(refused));
    }
}

proptest! {
    #[test]
    fn every_sensor_comes_to_an_end(
        percepts in proptest::collection::vec((0..5u32, 0..8u32), 1..200),
    ) {
        let sensed = |first: Percept, other: fn(u32, u32) -> Percept| -> Vec<Percept> {
            let others = percepts.iter().map(|&(degree, number)| other(degree, number));
            std::iter::once(first).chain(others).collect()
        };
        let pointing = |degree, door| if door < degree { marked(degree, door) } else { plain(degree) };
        let pointed = sensed(marked(2, 0), pointing);
        let _ = run::<Algorithm1Run>(&pointed, BOUND);
        let _ = run::<FoldingRun>(&pointed, BOUND);
        let lay = |degree, number| if number % 4 == 0 { lying(degree) } else { plain(degree) };
        let _ = run::<MovableMarkerRun>(&sensed(lying(2), lay), BOUND);
        // Also one that never lies about the marker while the robot carries it or looks for it in vain.
        let degrees = sensed(lying(2), |degree, number| plain(1 + (degree + number) % 3));
        let _ = run::<MovableMarkerRun>(&degrees, BOUND);
    }
}

proptest! {
    /// What it perceived earlier and what it perceives now may contradict each other in any way.
    #[test]
    fn a_robot_that_recovers_has_a_next_step_until_its_map_is_complete(
        percepts in proptest::collection::vec((0..4_u32, 0..8_u32), 1..60),
    ) {
        // The door along which a marker points may not be there.
        let percept = |(degree, number): (u32, u32)| match number % 2 {
            0 => marked(degree, number / 2),
            _ => plain(degree),
        };
        let others = percepts.into_iter().map(percept);
        let percepts: Vec<_> = std::iter::once(marked(2, 0)).chain(others).collect();
        let mut world = ScriptedWorld { percepts: &percepts, moves: 0, refused: None };
        let method = MappingMethod::Recovering(RecoveryConfig::default());
        let (_, mapped) = method.map_world(&mut world, BOUND, &[], &mut ());
        prop_assert!(!matches!(mapped, Err(MappingError::InvalidStep(_))), "{mapped:?}");
    }
}

/// Any sighting, also one that no aid has there.
fn any_sighting() -> impl Strategy<Value = Sighting> {
    let robot = (0..6_u8, 0..5_u32).prop_map(|(kind, number)| match kind {
        0 => OtherRobot::Absent,
        1 => OtherRobot::Elsewhere { degree: number },
        2 => OtherRobot::Here,
        3 => OtherRobot::HereAlong(Door(number)),
        4 => OtherRobot::WithSecond,
        _ => OtherRobot::WithSecondAlong(Door(number)),
    });
    let string = (0..32_u32, any::<[bool; 2]>(), proptest::option::of(0..5_u32));
    let string = string.prop_map(|(bits, [fixed_end, free_end], hand)| {
        let mut doors = DoorSet::default();
        (0..5).filter(|door| bits >> door & 1 == 1).for_each(|door| doors.insert(Door(door)));
        StringView { doors, fixed_end, free_end, hand: hand.map(Door) }
    });
    prop_oneof![
        1 => Just(Sighting::Nothing),
        1 => (0..5_u32).prop_map(|door| Sighting::Pointing(Door(door))),
        1 => (0..5_u32).prop_map(Sighting::Lying),
        1 => (0..4_usize).prop_map(|at| Sighting::These(MarkerSet::from_numbers([at]).unwrap())),
        3 => string.prop_map(Sighting::String),
        5 => [robot.clone(), robot].prop_map(|robots| Sighting::Team(TeamView(robots))),
    ]
}

proptest! {
    /// The first percept is that of a ring; the others lie.
    #[test]
    fn with_every_aid_every_sensor_comes_to_an_end(
        others in proptest::collection::vec((0..5_u32, any_sighting()), 1..60),
    ) {
        let ring = EmbeddedGraph::cycle(3);
        for algorithm in MappingAlgorithm::all() {
            let first = GraphWorld::with_aid(&ring, algorithm.aid(), Dart(0)).sensed();
            let others = others.iter().map(|&(degree, sighting)| Percept { degree, sighting });
            let percepts: Vec<_> = std::iter::once(first).chain(others).collect();
            let mut world = ScriptedWorld { percepts: &percepts, moves: 0, refused: None };
            let _ = algorithm.map_world(&mut world, BOUND, &mut ());
        }
    }
}
