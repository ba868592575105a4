//! The check fails on broken variants of the movable marker algorithm, each on its smallest start; steps out of order
//! are errors.

use super::*;
use crate::{
    any_graph::Class,
    check::smallest_failure::{delegate_to_run, new, smallest_failure, too_large},
    embedded_graph::EmbeddedGraph,
    mapping::StateKey,
    world::GraphWorld,
};

/// The movable marker algorithm with something broken in one of its validations.
#[derive(Clone)]
struct Broken {
    flaw: Flaw,
    run: MovableMarkerRun,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Flaw {
    /// There is no place validation: every place is new.
    EveryPlaceIsNew,
    /// The only vertex that looks like the place is taken for it.
    OnlyCandidateIsIt,
    /// The search ends at the first candidate.
    OneCandidateSearched,
    /// A marker that is not found is taken to lie at the last candidate.
    NotFoundIsFound,
    /// After a search in vain, the robot takes itself to be at the new place.
    LeftBehind,
    /// After a search in vain, the marker is left at the new place.
    MarkerLeftBehind,
    /// There is no back-link validation: the first unexplored dart is taken.
    FirstDartIsIt,
    /// The marker is dropped where it was found, and not carried to the known end.
    NotCarried,
    /// The first dart tried that does not lead to the marker is taken.
    RejectedIsConfirmed,
}

impl Flaw {
    fn is_of_back_links(self) -> bool {
        matches!(self, Self::FirstDartIsIt | Self::NotCarried | Self::RejectedIsConfirmed)
    }

    fn validate_place<W: ObservedWorld>(
        self,
        run: &mut MovableMarkerRun,
        world: &mut W,
    ) -> Mapped<W, Option<Vertex>> {
        if self.is_of_back_links() {
            return run.validate_place(world);
        }
        if run.candidates.is_empty() || self == Self::EveryPlaceIsNew {
            return Ok(None);
        }
        let only = match run.candidates[..] {
            [only] => Some(only),
            _ => None,
        };
        run.drop_marker(world)?;
        run.go_back(world)?;
        if let (Self::OnlyCandidateIsIt, Some(only)) = (self, only) {
            run.look_for_marker(only, world)?;
            return Ok(Some(only));
        }
        let mut last = Vertex(0);
        while let Some(candidate) = run.next_candidate() {
            if let Some(vertex) = run.look_for_marker(candidate, world)? {
                return Ok(Some(vertex));
            }
            last = candidate;
            if self == Self::OneCandidateSearched {
                break;
            }
        }
        match self {
            Self::NotFoundIsFound => return Ok(Some(last)),
            Self::LeftBehind => return Ok(None),
            _ => {}
        }
        run.return_to_marker(world)?;
        if self != Self::MarkerLeftBehind {
            run.pick_up(world)?;
        }
        Ok(None)
    }

    fn validate_back_link<W: ObservedWorld>(
        self,
        edge: Dart,
        vertex: Vertex,
        run: &mut MovableMarkerRun,
        world: &mut W,
    ) -> Mapped<W, Dart> {
        if !self.is_of_back_links() {
            return run.validate_back_link(edge, vertex, world);
        }
        run.pick_up(world)?;
        let darts: Vec<Dart> = run.map().unexplored_at(vertex).collect();
        if darts.len() == 1 || self == Self::FirstDartIsIt {
            return Ok(darts[0]);
        }
        if self == Self::NotCarried {
            run.drop_marker(world)?;
        } else {
            run.travel_to(run.map().vertex(edge), world)?;
            run.drop_marker(world)?;
            run.travel_to(vertex, world)?;
        }
        for dart in darts {
            if run.try_back_link(dart, world)? || self == Self::RejectedIsConfirmed {
                run.pick_up(world)?;
                return Ok(dart);
            }
        }
        panic!("another variant");
    }
}

impl Explorer for Broken {
    delegate_to_run!(MovableMarkers, Dart);

    fn step<W: ObservedWorld>(&mut self, edge: Dart, world: &mut W) -> Mapped<W> {
        let Self { flaw, run } = self;
        run.carry_over(edge, world)?;
        if let Some(vertex) = flaw.validate_place(run, world)? {
            let dart = flaw.validate_back_link(edge, vertex, run, world)?;
            run.walk.close_loop(dart, world)?;
        } else {
            run.walk.add_place(Door::BACK, world)?;
        }
        Ok(())
    }

    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        self.run.move_bound(edges, vertices)
    }
}

// paper: movable.place, movable.new, movable.known, movable.back-link
#[test]
fn every_broken_variant_is_caught_on_a_small_start() {
    let cycle = |edges: u32| [vec![new(2); edges as usize], vec![2 * edges - 1]].concat();
    let no_marker =
        |moves| format!("after {moves} moves: there is no marker here that could be picked up");
    for (flaw, edges, code, failure) in [
        (
            Flaw::EveryPlaceIsNew,
            3,
            cycle(3),
            too_large("after 3 moves vertex v3 is wrongly added behind the map's dart 5", 6),
        ),
        (Flaw::OnlyCandidateIsIt, 4, cycle(4), no_marker(6)),
        (
            Flaw::OneCandidateSearched,
            6,
            vec![new(3), new(3), new(3), new(3), 7, 10, 11],
            too_large("after 16 moves vertex v4 is wrongly added behind the map's dart 10", 12),
        ),
        (Flaw::NotFoundIsFound, 4, cycle(4), no_marker(6)),
        (
            Flaw::LeftBehind,
            4,
            cycle(4),
            "after 7 moves: the world contradicts itself: the robot carries the marker, but behind \
             the unexplored dart 1 of vertex v3 there is degree 2 with a marker lying there"
                .to_owned(),
        ),
        (
            Flaw::MarkerLeftBehind,
            4,
            cycle(4),
            "after 10 moves: the robot carries no marker that it could drop".to_owned(),
        ),
        (
            Flaw::FirstDartIsIt,
            4,
            vec![new(3), new(2), new(1), new(2), 7],
            too_large("after 6 moves the map's darts 6 and 1 are wrongly made one edge", 8),
        ),
        (
            Flaw::NotCarried,
            4,
            vec![new(3), new(2), new(2), new(1), 6],
            "after 8 moves: the world contradicts itself: at the known vertex v0, entered by its \
             dart 1: expected degree 3 without the marker, found degree 3 with a marker lying \
             there"
                .to_owned(),
        ),
        (Flaw::RejectedIsConfirmed, 4, vec![new(3), new(2), new(1), new(2), 7], no_marker(12)),
    ] {
        let broken = || Broken { flaw, run: MovableMarkerRun::default() };
        let found = smallest_failure(broken, Class::Simple, 7);
        assert_eq!(found, (edges, code, failure), "{flaw:?}");
    }
}

/// A step out of order is an error and changes nothing. Nothing is left of an earlier run.
#[test]
fn a_step_out_of_order_is_an_error() {
    let error = |step| Err(MappingError::InvalidStep(step));
    let graph = EmbeddedGraph::chain(2);
    let mut world = GraphWorld::with_aid(&graph, MOVABLE, Dart(1));
    let mut run = MovableMarkerRun::new(4);
    assert_eq!((run.choose().unwrap(), run.next_candidate()), (None, None));
    let unexplored = InvalidStep::NotUnexplored(Dart(0));
    assert_eq!(run.step(Dart(0), &mut world), error(unexplored));
    assert_eq!(run.go_back(&mut world), error(InvalidStep::NoEdge));
    assert_eq!(run.return_to_marker(&mut world), error(InvalidStep::NoEdge));
    assert_eq!((run.moves(), run.map().dart_count()), (0, 0));
    run.begin(&mut world).unwrap();
    run.carry_over(Dart(1), &mut world).unwrap();
    assert_eq!(run.step(Dart(0), &mut world), error(InvalidStep::EdgeInProgress(Dart(1))));
    run.walk.add_place(Door::BACK, &mut world).unwrap();
    assert_eq!((run.moves(), run.map().dart_count(), run.robot()), (1, 3, Dart(2)));
    // A start that is refused leaves nothing of the run before.
    run.begin(&mut world).unwrap_err();
    assert_eq!((run.robot(), run.moves(), run.map().dart_count()), (Dart(0), 0, 0));
}
