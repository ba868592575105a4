//! The movable marker algorithm ends on every world, also on one that breaks, lies, or has no end.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

use proptest::prelude::*;
use toposlam_model::{
    embedded_graph::{Dart, Vertex},
    mapping::{
        Contradiction, Explorer, InvalidStep, MappingError, MovableMarkerRun, Nearest,
        explore_edge, map_with_movable_marker,
    },
    percept::{Door, Percept, Sighting},
    world::{MarkerCarrier, RefusedAction, World},
};

use crate::scripted_world::{ScriptedWorld, plain};

const BOUND: usize = 60;

fn map(world: &mut impl World<Error = RefusedAction>) -> Result<u64, MappingError<RefusedAction>> {
    let mut search = MovableMarkerRun::new(BOUND);
    map_with_movable_marker(world, &mut Nearest, &mut search, &mut ()).map(|()| search.moves())
}

fn lying(degree: u32) -> Percept {
    Percept { degree, sighting: Sighting::Lying(1) }
}

fn scripted(percepts: &[Percept]) -> MappingError<RefusedAction> {
    map(&mut ScriptedWorld::new(percepts)).unwrap_err()
}

/// The percepts with the last of them replaced.
fn but_then<const N: usize>(percepts: [Percept; N], last: Percept) -> Vec<Percept> {
    let mut percepts = percepts.to_vec();
    *percepts.last_mut().unwrap() = last;
    percepts
}

fn known_place(
    (vertex, index): (u32, u32),
    expected: Percept,
    perceived: Percept,
) -> MappingError<RefusedAction> {
    Contradiction::KnownPlace { vertex: Vertex(vertex), index, expected, perceived }.into()
}

#[test]
fn a_world_without_end_runs_into_the_bound() {
    // No two places look alike.
    let endless: Vec<_> = std::iter::once(lying(1)).chain((2..99).map(plain)).collect();
    assert_eq!(scripted(&endless), MappingError::Bound { bound: BOUND });
    assert_eq!(scripted(&[lying(u32::MAX)]), MappingError::Bound { bound: BOUND });
    assert_eq!(scripted(&[lying(3), plain(u32::MAX)]), MappingError::Bound { bound: BOUND });
}

#[test]
fn a_start_without_its_marker_is_a_contradiction() {
    let pointing = Percept { degree: 3, sighting: Sighting::Pointing(Door::BACK) };
    let two = Percept { degree: 3, sighting: Sighting::Lying(2) };
    for perceived in [plain(3), plain(0), lying(0), pointing, two] {
        let expected = Contradiction::StartWithoutMarker { perceived };
        assert_eq!(scripted(&[perceived]), expected.into());
    }
    assert_eq!(
        scripted(&[plain(3)]).to_string(),
        "the world contradicts itself: the marker must lie at the start, but there is degree 3 \
         without the marker"
    );
}

#[test]
fn a_second_marker_is_a_contradiction() {
    let pointing = Percept { degree: 3, sighting: Sighting::Pointing(Door::BACK) };
    for perceived in [lying(3), pointing] {
        let expected = Contradiction::SecondMarker { vertex: Vertex(0), index: 0, perceived };
        assert_eq!(scripted(&[lying(2), perceived]), expected.into());
    }
    assert_eq!(
        scripted(&[lying(2), lying(3)]).to_string(),
        "the world contradicts itself: the robot carries the marker, but behind the unexplored \
         dart 0 of vertex v0 there is degree 3 with a marker lying there"
    );
    // At a known place, too.
    let expected = known_place((0, 0), plain(2), lying(2));
    assert_eq!(scripted(&[lying(2), plain(1), lying(2)]), expected);
}

#[test]
fn a_percept_that_no_vertex_gives_is_a_contradiction() {
    let expected = Contradiction::Impossible { perceived: plain(0) };
    assert_eq!(scripted(&[lying(1), plain(0)]), expected.into());
}

/// Of a cycle: out to v1 and v2 and over the next edge, where the marker is dropped, for this may be
/// v0; back to v2, to v1, to v0.
const CYCLE: [Percept; 7] = {
    const TWO: Percept = Percept { degree: 2, sighting: Sighting::Nothing };
    [Percept { degree: 2, sighting: Sighting::Lying(1) }, TWO, TWO, TWO, TWO, TWO, TWO]
};

// paper: movable.place
#[test]
fn a_known_place_that_changed_is_a_contradiction() {
    let [start, v1, v2, unknown, back, again, _] = CYCLE;
    // On the way to an unexplored edge.
    let expected = known_place((0, 0), plain(2), plain(3));
    assert_eq!(scripted(&[lying(2), plain(1), plain(3)]), expected);
    // At the known end, back from the unknown one; the marker cannot be there, either.
    for perceived in [plain(3), lying(2)] {
        let percepts = but_then([start, v1, v2, unknown, back], perceived);
        assert_eq!(scripted(&percepts), known_place((2, 1), plain(2), perceived));
    }
    // At a vertex that the unknown end cannot be.
    for perceived in [plain(1), lying(2)] {
        let percepts = but_then([start, v1, v2, unknown, back, again], perceived);
        assert_eq!(scripted(&percepts), known_place((1, 1), plain(2), perceived));
    }
    // At one that it can be.
    for perceived in [plain(1), lying(3)] {
        let percepts = but_then(CYCLE, perceived);
        assert_eq!(scripted(&percepts), known_place((0, 0), plain(2), perceived));
    }
}

// paper: movable.new
#[test]
fn a_marker_that_is_gone_is_a_contradiction() {
    for perceived in [plain(2), lying(3)] {
        let percepts = [&CYCLE[..], &[plain(2), plain(2), perceived]].concat();
        let expected = Contradiction::WayBack { expected: lying(2), perceived };
        assert_eq!(scripted(&percepts), expected.into());
    }
}

/// Out to v1 and v2 and over the next edge to a place that looks like v0, and is; then the marker is
/// carried to v2, and the robot is back at v0, with two darts to try.
const BACK_LINK: [Percept; 11] = {
    const TWO: Percept = Percept { degree: 2, sighting: Sighting::Nothing };
    const THREE: Percept = Percept { degree: 3, sighting: Sighting::Nothing };
    const HERE: Percept = Percept { degree: 3, sighting: Sighting::Lying(1) };
    [HERE, TWO, TWO, THREE, TWO, TWO, HERE, TWO, TWO, TWO, THREE]
};

// paper: movable.back-link
#[test]
fn a_back_link_that_is_not_there_is_a_contradiction() {
    let with = |more: &[Percept]| scripted(&[&BACK_LINK[..], more].concat());
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
    /// A world in which something is refused.
    struct Closed(RefusedAction);
    impl World for Closed {
        type Error = RefusedAction;
        fn percept(&mut self) -> Result<Percept, RefusedAction> {
            Ok(lying(2))
        }
        fn traverse(&mut self, _: Door) -> Result<(), RefusedAction> {
            Err(self.0)
        }
        fn carrier(&mut self) -> Option<&mut dyn MarkerCarrier<Error = RefusedAction>> {
            Some(self)
        }
    }
    impl MarkerCarrier for Closed {
        type Error = RefusedAction;
        fn pick_up(&mut self) -> Result<(), RefusedAction> {
            if self.0 == RefusedAction::NothingToPickUp { Err(self.0) } else { Ok(()) }
        }
        fn drop(&mut self) -> Result<(), RefusedAction> {
            Err(self.0)
        }
    }
    for refused in
        [RefusedAction::NothingToPickUp, RefusedAction::NoSuchDoor { door: Door(0), degree: 0 }]
    {
        assert_eq!(map(&mut Closed(refused)), Err(MappingError::World(refused)));
    }
}

/// A step out of order is an error and changes nothing. Nothing is left of an earlier run.
#[test]
fn a_step_out_of_order_is_an_error() {
    let error = |step| Err(MappingError::InvalidStep(step));
    let percepts = [lying(2), plain(1)];
    let mut world = ScriptedWorld::new(&percepts);
    let mut search = MovableMarkerRun::new(BOUND);
    assert_eq!(search.choose().unwrap(), None);
    assert_eq!((search.next_candidate(), search.next_back_link()), (None, None));
    let unexplored = InvalidStep::NotUnexplored(Dart(0));
    assert_eq!(explore_edge(Dart(0), &mut search, &mut world, &mut ()), error(unexplored));
    assert_eq!(search.carry_over(Dart(0), &mut world, &mut ()), error(unexplored));
    assert_eq!(search.go_back(&mut world, &mut ()), error(InvalidStep::NoEdge));
    let found = search.look_for_marker(Vertex(0), &mut world, &mut ());
    assert_eq!(
        found.unwrap_err(),
        MappingError::InvalidStep(InvalidStep::UnknownVertex(Vertex(0)))
    );
    assert_eq!(search.return_to_marker(&mut world, &mut ()), error(InvalidStep::NoEdge));
    let unknown = InvalidStep::UnknownVertex(Vertex(3));
    assert_eq!(search.travel_to(Vertex(3), &mut world, &mut ()), error(unknown));
    assert_eq!(search.close_loop(Dart(0), &mut world, &mut ()), Err(InvalidStep::NoEdge));
    assert_eq!(search.add_place(&mut world, &mut ()), error(InvalidStep::NoEdge));
    assert_eq!((search.moves(), search.map().dart_count()), (0, 0));
    search.begin(&mut world, &mut ()).unwrap();
    search.carry_over(Dart(1), &mut world, &mut ()).unwrap();
    let in_progress = InvalidStep::EdgeInProgress(Dart(1));
    assert_eq!(search.carry_over(Dart(0), &mut world, &mut ()), error(in_progress));
    search.add_place(&mut world, &mut ()).unwrap();
    assert_eq!((search.moves(), search.map().dart_count(), search.robot()), (1, 3, Dart(2)));
    // A start that is refused leaves nothing of the run before.
    search.begin(&mut world, &mut ()).unwrap_err();
    assert_eq!((search.robot(), search.moves(), search.map().dart_count()), (Dart(0), 0, 0));
}

proptest! {
    #[test]
    fn every_sensor_comes_to_an_end(
        percepts in proptest::collection::vec((0..5u32, 0..4u32), 1..200),
    ) {
        let percepts: Vec<_> = std::iter::once(lying(2))
            .chain(percepts.into_iter().map(|(degree, marked)| {
                if marked == 0 { lying(degree) } else { plain(degree) }
            }))
            .collect();
        let _ = map(&mut ScriptedWorld::new(&percepts));
    }

    /// Also one that never lies about the marker while the robot carries it or looks for it in vain.
    #[test]
    fn every_sensor_of_degrees_comes_to_an_end(
        percepts in proptest::collection::vec(1..4u32, 1..200),
    ) {
        let percepts: Vec<_> =
            std::iter::once(lying(2)).chain(percepts.into_iter().map(plain)).collect();
        let _ = map(&mut ScriptedWorld::new(&percepts));
    }
}
