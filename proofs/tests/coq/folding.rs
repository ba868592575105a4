//! The proved folding explorer, extracted, against the running one. What the running explorer does in a start is given
//! to the proved one as its actions: each must be allowed, and both must take the same doors, have the same map, dart
//! for dart, and know the robot in the same pose after as many moves.

use std::{iter, mem};

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Class,
    mapping::{FoldingEvent, FoldingRun, MapWalk, MappingEvent, Observed, Observer, explore},
    world::GraphWorld,
};

use super::{
    comparison::{Case, Random, assert_detected, assert_same, extracted, known, listed},
    compiled, starts,
};

/// What the folding explorer did.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Given {
    /// It took the doors, and the last of them led over the edge of this dart of the map.
    Explored(Dart, Vec<u32>),
    /// It took the doors to test whether the two darts are the ends of one edge.
    Tested(Dart, Dart, Vec<u32>),
    /// It found that the two darts are the ends of one edge.
    Joined(Dart, Dart),
    /// It added the place behind the dart to the map.
    Added(Dart),
}

impl Given {
    /// As `compare/main.ml` reads it.
    fn text(&self) -> String {
        let by = |doors: &[u32]| listed("by", doors.iter());
        match self {
            Self::Explored(edge, doors) => format!("explore {} {}", edge.0, by(doors)),
            Self::Tested(edge, other, doors) => {
                format!("test {} {} {}", edge.0, other.0, by(doors))
            }
            Self::Joined(edge, other) => format!("join {} {}", edge.0, other.0),
            Self::Added(edge) => format!("add {}", edge.0),
        }
    }
}

/// Records what the folding explorer does, from its events.
#[derive(Default)]
struct Recorded {
    given: Vec<Given>,
    /// All doors, and those since the last action.
    did: Vec<u32>,
    doors: Vec<u32>,
    /// The darts of the last test, if it was confirmed: they are then the ends of one edge.
    confirmed: Option<[Dart; 2]>,
}

impl<W: ?Sized> Observer<W> for Recorded {
    fn event(&mut self, _: &mut W, _: &MapWalk, event: MappingEvent) {
        match event {
            MappingEvent::Moved { door, .. } => {
                self.did.push(door.0);
                self.doors.push(door.0);
            }
            MappingEvent::VertexAdded { edge, .. } => self.given.push(Given::Added(edge)),
            MappingEvent::LoopClosed { edge, other } => {
                let known = self
                    .confirmed
                    .is_some_and(|ends| ends == [edge, other] || ends == [other, edge]);
                if !known {
                    self.given.push(Given::Joined(edge, other));
                }
            }
            MappingEvent::Folding(FoldingEvent::Explored { edge, .. }) => {
                self.given.push(Given::Explored(edge, mem::take(&mut self.doors)));
            }
            MappingEvent::Folding(
                FoldingEvent::Refuted { edge, hypothesis, .. }
                | FoldingEvent::Confirmed { edge, hypothesis },
            ) => {
                let is_true =
                    matches!(event, MappingEvent::Folding(FoldingEvent::Confirmed { .. }));
                self.confirmed = is_true.then_some([edge, hypothesis]);
                self.given.push(Given::Tested(edge, hypothesis, mem::take(&mut self.doors)));
            }
            _ => {}
        }
    }
}

struct Run {
    algorithm: &'static str,
    start: EmbeddedGraph,
    given: Vec<Given>,
    line: String,
}

impl Run {
    fn new(start: EmbeddedGraph) -> Self {
        let exploration = FoldingRun::new(start.dart_count());
        Self::of("folding", exploration, start)
    }

    /// With strict tests only.
    fn strict(start: EmbeddedGraph) -> Self {
        Self::of("strict-folding", FoldingRun::strict(), start)
    }

    fn of(algorithm: &'static str, mut exploration: FoldingRun, start: EmbeddedGraph) -> Self {
        let mut world = GraphWorld::new(&start, Dart(0));
        let mut recorded = Recorded::default();
        let ended = explore(&mut exploration, &mut Observed::new(&mut world, &mut recorded));
        let known = ended.map_or_else(|error| error.to_string(), |()| known(&exploration));
        let moves = listed("moves", iter::once(exploration.moves()));
        let did = listed("did", recorded.did.iter());
        let line = [did, "chose".to_owned(), known, moves].join("; ");
        Self { algorithm, start, given: recorded.given, line }
    }

    /// As if the explorer had done this.
    fn with(&self, given: &[Given]) -> Case {
        let actions: Vec<_> = given.iter().map(Given::text).collect();
        Case {
            algorithm: self.algorithm,
            start: self.start.clone(),
            given: format!("actions {}", actions.join(", ")),
            lines: vec![self.line.clone()],
        }
    }

    fn case(&self) -> Case {
        self.with(&self.given)
    }
}

fn runs(starts: Vec<EmbeddedGraph>) -> Vec<Run> {
    starts.into_iter().map(Run::new).collect()
}

fn cases(runs: &[Run]) -> Vec<Case> {
    runs.iter().map(Run::case).collect()
}

/// The numbers of starts: see `comparison.rs`.
#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn the_running_folding_explorer_takes_allowed_actions_in_every_small_start() {
    let compiled = compiled();
    let multigraphs = starts(Class::Multigraph, 1..=5);
    let simple = starts(Class::Simple, 1..=7);
    assert_eq!((multigraphs.len(), simple.len()), (8954, 4526));
    let runs = runs([multigraphs, simple].concat());
    assert_same(&compiled.copy("folding"), &cases(&runs));
    let tests =
        |run: &Run| run.given.iter().filter(|given| matches!(given, Given::Tested(..))).count();
    assert!(runs.iter().map(tests).sum::<usize>() > 10_000);
}

/// After `4 n m + 200` moves the running explorer makes strict tests, which no start here needs. An explorer that makes
/// only these takes allowed actions, too: in small starts, and in larger ones at random.
#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn strict_tests_are_those_of_the_proved_explorer() {
    let mut random = Random::new(3);
    let larger: Vec<_> = iter::repeat_with(|| random.start_of::<10, 40>()).take(40).collect();
    // The extracted program counts in unary numbers, and takes up to a minute for one of 60 edges.
    let largest = [random.start_of::<60, 60>()];
    let all = [starts(Class::Multigraph, 1..=4), larger, largest.into()].concat();
    let runs: Vec<_> = all.into_iter().map(Run::strict).collect();
    assert_same(&compiled().copy("strict-folding"), &cases(&runs));
    let is_test = |given: &&Given| matches!(given, Given::Tested(..));
    let tests: usize = runs.iter().map(|run| run.given.iter().filter(is_test).count()).sum();
    assert!(tests > 1_500, "{tests}");
}

/// What an explorer with a flaw does, if the run has a place for it.
type Flawed = fn(&[Given]) -> Option<Vec<Given>>;

/// A place joins the map without the test of a hypothesis about it.
fn not_tested(given: &[Given]) -> Option<Vec<Given>> {
    let refuted = given.windows(2).position(
        |pair| matches!(pair, [Given::Tested(edge, ..), Given::Added(added)] if edge == added),
    )?;
    Some([&given[..refuted], &given[refuted + 1..]].concat())
}

/// A hypothesis is taken as true without its test, which would have been the last one.
fn believed(given: &[Given]) -> Option<Vec<Given>> {
    let (last, others) = given.split_last()?;
    let Given::Tested(edge, other, _) = *last else { return None };
    Some([others, &[Given::Joined(edge, other)]].concat())
}

/// The test is about another hypothesis than the walk confirms.
fn misjudged(given: &[Given]) -> Option<Vec<Given>> {
    let (last, others) = given.split_last()?;
    let Given::Tested(edge, _, doors) = last else { return None };
    Some([others, &[Given::Tested(*edge, *edge, doors.clone())]].concat())
}

/// An edge is closed at the wrong dart.
fn misjoined(given: &[Given]) -> Option<Vec<Given>> {
    let at = given.iter().position(|given| matches!(given, Given::Joined(..)))?;
    let Given::Joined(edge, _) = given[at] else { return None };
    Some([&given[..at], &[Given::Joined(edge, edge)], &given[at + 1..]].concat())
}

/// The explorer stops too early.
fn stopped(given: &[Given]) -> Option<Vec<Given>> {
    given.split_last().map(|(_, others)| others.to_vec()).filter(|others| !others.is_empty())
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn what_a_flawed_explorer_does_is_not_allowed() {
    let compiled = compiled();
    let runs = runs(starts(Class::Multigraph, 1..=4));
    let not_predicted = "a test does not predict where the robot comes in";
    let flaws: [(&str, Flawed, &[&str]); 5] = [
        ("not tested", not_tested, &["this is not allowed: add "]),
        ("believed", believed, &["this is not allowed: join "]),
        ("misjudged", misjudged, &[not_predicted, "this is not allowed: test "]),
        ("misjoined", misjoined, &["this is not allowed: join "]),
        ("stopped", stopped, &["there are fewer actions than the run needs"]),
    ];
    for (flaw, flawed, reasons) in flaws {
        let changed = |run: &Run| flawed(&run.given).map(|given| run.with(&given));
        let cases: Vec<_> = runs.iter().filter_map(changed).collect();
        assert!(!cases.is_empty(), "{flaw}");
        let proved = extracted(&compiled.copy(&format!("flaws/{flaw}")), &cases);
        for (case, line) in cases.iter().zip(proved.lines()) {
            let is_refused = reasons.iter().any(|reason| line.starts_with(reason));
            assert!(is_refused, "{flaw}: {line}\n{case:?}");
        }
        assert_eq!(proved.lines().count(), cases.len());
    }
}

/// If the proved explorer draws fewer conclusions, the running one does what is not allowed.
#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn another_folding_explorer_is_detected() {
    let cases = cases(&runs(starts(Class::Multigraph, 1..=4)));
    let own = "\n    || has (fun p => same (from_dart (trail K) p) (to_dart (trail K) p)) (passages (trail K))";
    for (change, from, to) in [
        ("own opposite", own, ""),
        ("sightings", "  | _, _ => false\n", "  | _, _ => true\n"),
        ("degrees", "  (p.1 == q.1) &&\n", ""),
    ] {
        let name = format!("another-folding/{change}");
        assert_detected(&name, &cases, "FoldingExplorer.v", [from, to]);
    }
}
