//! The check fails on broken variants of the movable marker algorithm, each on its smallest start.

use toposlam_model::{
    embedded_graph::{Dart, Vertex},
    enumerate::Class,
    mapping::{
        Explorer, InvalidStep, MapWalk, MappingError, MovableMarkerRun, Observer, ReachedPlace,
        StateKey, ValidationResult, validate_back_link, validate_place,
    },
    marker::MarkerKind,
    world::World,
};

use crate::smallest_failure::{more_darts_than, new, smallest_failure};

/// The movable marker algorithm with something broken in one of its validations.
#[derive(Clone)]
struct Broken {
    flaw: Flaw,
    run: MovableMarkerRun,
}

#[derive(Clone, Copy, Debug)]
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
    fn validate_place<W: World>(
        self,
        search: &mut MovableMarkerRun,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<ReachedPlace, MappingError<W::Error>> {
        match (self, search.candidates()) {
            (_, []) | (Self::EveryPlaceIsNew, _) => return Ok(ReachedPlace::New),
            (Self::OnlyCandidateIsIt, &[only]) => {
                search.drop_marker(world, observer)?;
                search.go_back(world, observer)?;
                search.look_for_marker(only, world, observer)?;
                return Ok(ReachedPlace::Known(only));
            }
            (Self::FirstDartIsIt | Self::NotCarried | Self::RejectedIsConfirmed, _) => {
                return validate_place(search, world, observer);
            }
            _ => {}
        }
        search.drop_marker(world, observer)?;
        search.go_back(world, observer)?;
        let mut last = Vertex(0);
        while let Some(candidate) = search.next_candidate() {
            if let Some(vertex) = search.look_for_marker(candidate, world, observer)? {
                return Ok(ReachedPlace::Known(vertex));
            }
            last = candidate;
            if matches!(self, Self::OneCandidateSearched) {
                break;
            }
        }
        match self {
            Self::NotFoundIsFound => return Ok(ReachedPlace::Known(last)),
            Self::LeftBehind => return Ok(ReachedPlace::New),
            _ => {}
        }
        search.return_to_marker(world, observer)?;
        if !matches!(self, Self::MarkerLeftBehind) {
            search.pick_up(world, observer)?;
        }
        Ok(ReachedPlace::New)
    }

    fn validate_back_link<W: World>(
        self,
        edge: Dart,
        vertex: Vertex,
        search: &mut MovableMarkerRun,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<Dart, MappingError<W::Error>> {
        if !matches!(self, Self::FirstDartIsIt | Self::NotCarried | Self::RejectedIsConfirmed) {
            return validate_back_link(edge, vertex, search, world, observer);
        }
        search.pick_up(world, observer)?;
        if let Some(only) = search.list_back_links(vertex) {
            return Ok(only);
        }
        if !matches!(self, Self::FirstDartIsIt) {
            if matches!(self, Self::NotCarried) {
                search.drop_marker(world, observer)?;
            } else {
                search.travel_to(search.map().vertex(edge), world, observer)?;
                search.drop_marker(world, observer)?;
                search.travel_to(vertex, world, observer)?;
            }
        }
        while let Some(dart) = search.next_back_link() {
            if matches!(self, Self::FirstDartIsIt) {
                return Ok(dart);
            }
            let verdict = search.try_back_link(dart, world, observer)?;
            if verdict == ValidationResult::Confirmed || matches!(self, Self::RejectedIsConfirmed) {
                search.pick_up(world, observer)?;
                return Ok(dart);
            }
        }
        panic!("another variant");
    }
}

impl Explorer for Broken {
    delegate_to_run!(Dart);

    fn step<W: World>(
        &mut self,
        edge: Dart,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        let Self { flaw, run } = self;
        run.carry_over(edge, world, observer)?;
        match flaw.validate_place(run, world, observer)? {
            ReachedPlace::Known(vertex) => {
                let dart = flaw.validate_back_link(edge, vertex, run, world, observer)?;
                run.close_loop(dart, world, observer)?;
            }
            ReachedPlace::New => run.add_place(world, observer)?,
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
    let cycle = |edges: u32| {
        let last = edges as usize;
        let mut words = vec![new(2); last];
        words.push(2 * edges - 1);
        words
    };
    let nothing_here = "there is no marker here that could be picked up";
    let expected = [
        (
            Flaw::EveryPlaceIsNew,
            3,
            cycle(3),
            format!(
                "after 3 moves vertex v3 is wrongly added behind the map's dart 5: {}",
                more_darts_than(6)
            ),
        ),
        (Flaw::OnlyCandidateIsIt, 4, cycle(4), format!("after 6 moves: {nothing_here}")),
        (
            Flaw::OneCandidateSearched,
            6,
            vec![new(3), new(3), new(3), new(3), 7, 10, 11],
            format!(
                "after 16 moves vertex v4 is wrongly added behind the map's dart 10: {}",
                more_darts_than(12)
            ),
        ),
        (Flaw::NotFoundIsFound, 4, cycle(4), format!("after 6 moves: {nothing_here}")),
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
            format!(
                "after 6 moves the map's darts 6 and 1 are wrongly made one edge: {}",
                more_darts_than(8)
            ),
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
        (
            Flaw::RejectedIsConfirmed,
            4,
            vec![new(3), new(2), new(1), new(2), 7],
            format!("after 12 moves: {nothing_here}"),
        ),
    ];
    for (flaw, edges, words, report) in expected {
        let new = || Broken { flaw, run: MovableMarkerRun::default() };
        let caught = smallest_failure(new, Class::Simple, 7);
        assert_eq!(caught, (edges, words, report), "{flaw:?}");
    }
}
