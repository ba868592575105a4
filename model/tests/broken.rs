//! The check fails on broken variants of Algorithm 1, each on its smallest start.

use std::ops::ControlFlow;

use toposlam_model::{
    check::every_way,
    embedded_graph::Dart,
    enumerate::{Class, Each, Enumeration},
    mapping::{
        self, Algorithm1Run, Explorer, InvalidStep, MapWalk, MappingChoice, MappingError, Observer,
        StateKey, ValidationResult, step_with,
    },
    marker::MarkerKind,
    percept::{Door, Percept, Sighting},
    world::World,
};

use crate::smallest_failure::{more_darts_than, new, smallest_failure};

/// Algorithm 1 with something broken in lines 10 to 17.
#[derive(Clone)]
struct Broken {
    flaw: Flaw,
    run: Algorithm1Run,
}

impl Broken {
    fn new(flaw: Flaw) -> Self {
        Self { flaw, run: Algorithm1Run::default() }
    }
}

#[derive(Clone, Copy, Debug)]
enum Flaw {
    /// Line 15 is left out.
    NoRetrace,
    /// Line 12 does not look where the marker points.
    DirectionIgnored,
    /// A hypothesis is confirmed by the first percept that matches: that on arrival.
    FirstPerceptSuffices,
    /// Line 10 expects the marker to point one door further than it does.
    OffByOne,
    /// No hypothesis that takes a path is ever confirmed.
    NeverConfirmed,
    /// At the marker, the robot believes that it is still where the path began.
    LeftBehind,
}

impl Flaw {
    fn matches(self, expected: Percept, perceived: Percept) -> bool {
        match (self, expected.sighting, perceived.sighting) {
            (Self::DirectionIgnored, Sighting::Pointing(_), Sighting::Pointing(_)) => {
                expected.degree == perceived.degree
            }
            (Self::OffByOne, Sighting::Pointing(door), _) => {
                let door = Door((door.0 + 1) % expected.degree);
                Percept { sighting: Sighting::Pointing(door), ..expected } == perceived
            }
            _ => expected == perceived,
        }
    }

    fn try_path<W: World>(
        self,
        exploration: &mut Algorithm1Run,
        hypothesis: Dart,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<ValidationResult, MappingError<W::Error>> {
        exploration.clear_trail();
        let mut pose = hypothesis;
        if matches!(self, Self::FirstPerceptSuffices) {
            exploration.arrive_at_marker(pose);
            return Ok(ValidationResult::Confirmed);
        }
        while let Some((door, next)) = exploration.toward_marker(pose) {
            let expected = exploration.map().expected(next);
            let perceived = exploration.go_through(door, world, observer)?;
            if !self.matches(expected, perceived) {
                match self {
                    Self::NoRetrace => {}
                    _ => exploration.retrace(world, observer)?,
                }
                return Ok(ValidationResult::Rejected);
            }
            pose = next;
        }
        if matches!(self, Self::NeverConfirmed) && pose != hypothesis {
            exploration.retrace(world, observer)?;
            return Ok(ValidationResult::Rejected);
        }
        let believed = if matches!(self, Self::LeftBehind) { hypothesis } else { pose };
        exploration.arrive_at_marker(believed);
        Ok(ValidationResult::Confirmed)
    }
}

impl Explorer for Broken {
    delegate_to_run!(MappingChoice);

    fn choices(&mut self) -> Result<Vec<MappingChoice>, InvalidStep> {
        self.run.choices()
    }

    fn step<W: World>(
        &mut self,
        choice: MappingChoice,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        let flaw = self.flaw;
        step_with(&mut self.run, choice, world, observer, |run, hypothesis, world, observer| {
            flaw.try_path(run, hypothesis, world, observer)
        })
    }

    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        self.run.move_bound(edges, vertices)
    }
}

// paper: alg1.validation, alg1.hypotheses
// paper: alg1.10, alg1.11, alg1.12, alg1.13, alg1.14, alg1.15, alg1.16, alg1.17
#[test]
fn every_broken_variant_is_caught_on_a_small_start() {
    let expected = [
        (
            Flaw::NoRetrace,
            3,
            vec![new(1), new(5), 5, 4],
            format!(
                "after 4 moves the map's darts 2 and 4 are wrongly made one edge: {}",
                more_darts_than(6)
            ),
        ),
        (
            Flaw::DirectionIgnored,
            4,
            vec![new(2), new(6), 4, 7, 6],
            format!(
                "after 5 moves the map's darts 3 and 5 are wrongly made one edge: {}",
                more_darts_than(8)
            ),
        ),
        (
            Flaw::FirstPerceptSuffices,
            3,
            vec![new(1), new(5), 5, 4],
            "after 2 moves the map's darts 2 and 3 are wrongly made one edge: the world \
             contradicts itself: behind the unexplored dart 3 of vertex v1 there is degree 1 with \
             the marker along door 0, which agrees with no unexplored dart of the marked vertex"
                .to_owned(),
        ),
        (
            Flaw::OffByOne,
            3,
            vec![new(2), new(4), 3, 5],
            format!(
                "after 6 moves vertex v2 is wrongly added behind the map's dart 4: {}",
                more_darts_than(6)
            ),
        ),
        (
            Flaw::NeverConfirmed,
            2,
            vec![new(1), new(3), 3],
            format!(
                "after 4 moves vertex v2 is wrongly added behind the map's dart 2: {}",
                more_darts_than(4)
            ),
        ),
    ];
    for (flaw, edges, words, report) in expected {
        let caught = smallest_failure(|| Broken::new(flaw), Class::Multigraph, 4);
        assert_eq!(caught, (edges, words, report), "{flaw:?}");
    }
}

/// With all choices, too, the end of every run is judged: what the broken variants do wrong there is
/// seen in the map and in the pose, not only where they run into a contradiction.
#[test]
fn every_way_of_a_broken_variant_is_judged() {
    let mut seen = std::collections::BTreeMap::new();
    for flaw in [Flaw::DirectionIgnored, Flaw::FirstPerceptSuffices, Flaw::LeftBehind] {
        for edges in 1..=4 {
            let starts = Enumeration::new(Each::Start, Class::Multigraph, edges).unwrap();
            let _ = starts.for_each(&mut |found| {
                let result = every_way(Broken::new(flaw), found.graph, Dart(0), 100_000, &());
                let kind = match result {
                    Ok(_) => "right",
                    Err(mapping::Flaw::WrongMap) => "map",
                    Err(mapping::Flaw::WrongPose { .. }) => "pose",
                    Err(_) => "error",
                };
                *seen.entry((format!("{flaw:?}"), kind)).or_insert(0) += 1;
                ControlFlow::Continue(())
            });
        }
    }
    let starts = |flaw: Flaw, kind| seen.get(&(format!("{flaw:?}"), kind)).copied();
    assert_eq!(starts(Flaw::DirectionIgnored, "map"), Some(32));
    assert_eq!(starts(Flaw::FirstPerceptSuffices, "map"), Some(94));
    assert_eq!(starts(Flaw::LeftBehind, "pose"), Some(142));
}
