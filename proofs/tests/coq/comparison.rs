//! The proved algorithms, extracted, against the running ones: in each start both do the same in the same
//! order, have the same map, dart for dart, and know the robot in the same pose. With the default choices in
//! every small start, with all choices in every one with up to 3 edges, and with random choices in random
//! starts with 10 to 40 edges. Section 2.3.

use std::{fs, iter, path::Path};

use proptest::{
    prelude::Rng,
    test_runner::{RngAlgorithm, TestRng},
};
use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Class,
    format::{named_world::NamedWorld, world_file},
    mapping::{
        Algorithm1Run, Explorer, MapWalk, MappingChoice, MappingEvent, MovableMarkerRun, Observed,
        Observer, explore_with,
    },
    world::GraphWorld,
};
use toposlam_proofs::{choose::Choose, draw, odometer::ChoiceOdometer};

use super::{compiled, run_extracted, source, starts};

/// A line of a run: the name of what is listed, and the numbers.
pub(super) fn listed<T: ToString>(name: &str, numbers: impl Iterator<Item = T>) -> String {
    iter::once(name.to_owned()).chain(numbers.map(|n| n.to_string())).collect::<Vec<_>>().join(" ")
}

/// A mapping algorithm, by its marker.
#[derive(Clone, Copy)]
enum Mapping {
    Directional,
    Movable,
}

impl Mapping {
    /// As `compare/main.ml` reads it.
    fn name(self) -> &'static str {
        match self {
            Self::Directional => "directional",
            Self::Movable => "movable",
        }
    }

    /// The run of the running algorithm from a start, in the format of `compare/main.ml`. Without options, the choices
    /// are the default ones, and are not recorded.
    fn run_line(self, start: &EmbeddedGraph, options: Option<&mut Options>) -> String {
        let bound = start.dart_count();
        match self {
            Self::Directional => {
                // Options are numbered as Coq lists them: in the order of the darts.
                let number = |run: &Algorithm1Run, choice: &MappingChoice| match *choice {
                    MappingChoice::Edge(edge) => edge,
                    MappingChoice::Hypothesis(index) => run.hypotheses()[index],
                };
                run_line(Algorithm1Run::new(bound), start, options, number)
            }
            Self::Movable => run_line(MovableMarkerRun::new(bound), start, options, |_, _| Dart(0)),
        }
    }
}

/// The same for one explorer. Its options are ordered by their numbers.
fn run_line<E: Explorer>(
    mut run: E,
    start: &EmbeddedGraph,
    mut options: Option<&mut Options>,
    number: impl Fn(&E, &E::Choice) -> Dart,
) -> String {
    let (mut did, mut chose) = (Actions(Vec::new()), Vec::new());
    let mut world = GraphWorld::with_aid(start, run.aid(), Dart(0));
    let ended = explore_with(&mut run, &mut Observed::new(&mut world, &mut did), |run| {
        let Some(choose) = &mut options else { return run.choose() };
        let mut open = run.choices()?;
        open.sort_by_key(|choice| number(run, choice));
        if open.is_empty() {
            return Ok(None);
        }
        let of = u8::try_from(open.len()).unwrap();
        let choice = choose(of);
        chose.push(format!("{choice}/{of}"));
        Ok(Some(open[usize::from(choice)]))
    });
    let known = ended.map_or_else(|error| error.to_string(), |()| known(&run));
    [listed("did", did.0.into_iter()), listed("chose", chose.into_iter()), known].join("; ")
}

/// Chooses one of a number of options.
type Options<'c> = dyn FnMut(u8) -> u8 + 'c;

/// What the robot did, as text.
struct Actions(Vec<String>);

impl<W: ?Sized> Observer<W> for Actions {
    fn event(&mut self, _: &mut W, _: &MapWalk, event: MappingEvent) {
        self.0.extend(event.action().map(|action| action.to_string()));
    }
}

/// The map and the robot's pose in it.
pub(super) fn known(run: &impl Explorer) -> String {
    let walk = run.map_walk().unwrap();
    let map = walk.map().complete().unwrap();
    let first = |dart| map.darts_of(map.vertex(dart)).next().unwrap().0;
    let known = [
        listed("first", map.darts().map(first)),
        listed("degree", map.darts().map(|dart| map.degree_around(dart))),
        listed("other", map.darts().map(|dart| map.opposite(dart).0)),
        listed("robot", iter::once(walk.robot().0)),
    ];
    known.join("; ")
}

/// Random choices. The same seed makes the same ones.
pub(super) struct Random(TestRng);

impl Random {
    pub(super) fn new(seed: u8) -> Self {
        Self(TestRng::from_seed(RngAlgorithm::ChaCha, &[seed; 32]))
    }

    /// A start with so many edges.
    pub(super) fn start_of<const LEAST: usize, const MOST: usize>(&mut self) -> EmbeddedGraph {
        draw::start_of::<LEAST, MOST>(self).unwrap()
    }

    /// A start with 10 to 40 edges, simple if the algorithm needs that.
    fn start(&mut self, mapping: Mapping) -> EmbeddedGraph {
        loop {
            let start = self.start_of::<10, 40>();
            let start = match mapping {
                Mapping::Directional => start,
                Mapping::Movable => subdivided(start),
            };
            if start.edge_count() <= 40 {
                return start;
            }
        }
    }
}

/// The start with a new vertex in the middle of a loop or of one of two parallel edges, until it is simple.
fn subdivided(mut start: EmbeddedGraph) -> EmbeddedGraph {
    let ends =
        |start: &EmbeddedGraph, dart| (start.vertex(dart), start.vertex(start.opposite(dart)));
    let doubled = |start: &EmbeddedGraph, dart: Dart| {
        start.darts().any(|other| other != dart && ends(start, other) == ends(start, dart))
    };
    while let Some(dart) = start.darts().find(|&dart| doubled(&start, dart)) {
        let mut opposite: Vec<_> = start.darts().map(|dart| start.opposite(dart).0).collect();
        let mut clockwise: Vec<_> = start.darts().map(|dart| start.clockwise(dart).0).collect();
        let [near, far] = [0, 1].map(|more| start.dart_count() as u32 + more);
        opposite.extend([dart.0, start.opposite(dart).0]);
        opposite[start.opposite(dart).at()] = far;
        opposite[dart.at()] = near;
        clockwise.extend([far, near]);
        start = draw::world(&opposite, &clockwise).unwrap();
    }
    start
}

impl Choose for Random {
    fn below(&mut self, n: u8) -> u8 {
        (self.0.next_u32() % u32::from(n)) as u8
    }
}

/// A start, the choices or actions as `compare/main.ml` reads them, and the lines of the running algorithm.
#[derive(Clone, Debug)]
pub(super) struct Case {
    /// The name of the algorithm, as `compare/main.ml` reads it.
    pub(super) algorithm: &'static str,
    pub(super) start: EmbeddedGraph,
    pub(super) given: String,
    pub(super) lines: Vec<String>,
}

impl Case {
    /// The run with the default choices.
    fn by_default(mapping: Mapping, start: EmbeddedGraph) -> Self {
        let lines = vec![mapping.run_line(&start, None)];
        Self { algorithm: mapping.name(), start, given: "choices default".to_owned(), lines }
    }

    fn with_all_choices(mapping: Mapping, start: EmbeddedGraph) -> Self {
        let mut lines = Vec::new();
        let run = |choose: &mut ChoiceOdometer| {
            lines.push(mapping.run_line(&start, Some(&mut |of| choose.below(of))));
            Ok(())
        };
        ChoiceOdometer::exhaust(run, &()).unwrap();
        Self { algorithm: mapping.name(), start, given: "choices all".to_owned(), lines }
    }

    fn at_random(mapping: Mapping, start: EmbeddedGraph, random: &mut Random) -> Self {
        let mut chosen = Vec::new();
        let mut choose = |of| {
            chosen.push(random.below(of));
            chosen[chosen.len() - 1]
        };
        let lines = vec![mapping.run_line(&start, Some(&mut choose))];
        let given = listed("choices", chosen.iter());
        Self { algorithm: mapping.name(), start, given, lines }
    }

    /// The start and the choices or actions, as `compare/main.ml` reads them.
    fn line(&self) -> String {
        let Self { algorithm, start, given, .. } = self;
        let opposite = listed("opposite", start.darts().map(|dart| start.opposite(dart).0));
        let clockwise = listed("clockwise", start.darts().map(|dart| start.clockwise(dart).0));
        format!("{algorithm}; {opposite}; {clockwise}; {given}\n")
    }
}

/// Extracts the program in a folder where the development is compiled, builds it, and runs the algorithms
/// in these cases: a line for each run.
pub(super) fn extracted(folder: &Path, cases: &[Case]) -> String {
    let extraction = ["Extraction.vo", "mappings", "compare/main.ml"];
    run_extracted(folder, extraction, &cases.iter().map(Case::line).collect::<String>())
}

/// The first case with different runs, and the difference.
fn difference(cases: &[Case], proved: &str) -> Option<String> {
    let running = cases.iter().flat_map(|case| case.lines.iter().map(move |line| (case, line)));
    let lines = proved.lines().chain(iter::repeat("nothing"));
    let ((case, running), proved) =
        running.zip(lines).find(|((_, line), proved)| line != proved)?;
    let world = NamedWorld::numbered("start", "", case.start.clone(), Some(Dart(0)));
    let world = world_file::to_toml(&world);
    let given = &case.given;
    Some(format!(
        "the proved algorithm\n  {proved}\nthe running one\n  {running}\n\
         with {given}, in\n\n{world}"
    ))
}

/// In all these cases the proved algorithm and the running one do the same.
pub(super) fn assert_same(folder: &Path, cases: &[Case]) {
    let proved = extracted(folder, cases);
    if let Some(difference) = difference(cases, &proved) {
        panic!("{difference}");
    }
    let runs: usize = cases.iter().map(|case| case.lines.len()).sum();
    assert_eq!(proved.lines().count(), runs);
}

/// With a change in a file, some of these cases are different.
pub(super) fn assert_detected(name: &str, cases: &[Case], file: &str, [from, to]: [&str; 2]) {
    let folder = compiled().copy(name);
    let text = fs::read_to_string(source(file)).unwrap();
    assert_eq!(text.matches(from).count(), 1, "{file}");
    fs::write(folder.join(file), text.replace(from, to)).unwrap();
    let difference = difference(cases, &extracted(&folder, cases)).unwrap();
    assert!(difference.contains("[start]\n"), "{difference}");
}

fn by_default(mapping: Mapping, starts: Vec<EmbeddedGraph>) -> Vec<Case> {
    starts.into_iter().map(|start| Case::by_default(mapping, start)).collect()
}

/// The numbers of starts: A000698 with up to 5 edges; and those with up to 7 that are simple, of which
/// `model/tests/counts.rs` compares them with a filter.
#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn the_proved_algorithm_1_and_the_running_one_do_the_same_in_every_small_start() {
    let compiled = compiled();
    let multigraphs = starts(Class::Multigraph, 1..=5);
    let simple = starts(Class::Simple, 1..=7);
    assert_eq!((multigraphs.len(), simple.len()), (8954, 4526));
    let cases = by_default(Mapping::Directional, [multigraphs, simple].concat());
    assert_same(&compiled.copy("directional"), &cases);
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn with_a_movable_marker_both_do_the_same_in_every_small_simple_start() {
    let compiled = compiled();
    let simple = starts(Class::Simple, 1..=7);
    assert_eq!(simple.len(), 4526);
    assert_same(&compiled.copy("movable"), &by_default(Mapping::Movable, simple));
}

/// With up to 3 edges there are 3, 45 and 1777 runs, as the second implementation in Python counts them.
#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn both_do_the_same_with_all_choices() {
    let compiled = compiled();
    for (name, mapping, class, most, runs) in [
        ("directional", Mapping::Directional, Class::Multigraph, 3, 1825),
        ("movable", Mapping::Movable, Class::Simple, 5, 7365),
    ] {
        let cases = starts(class, 1..=most).into_iter();
        let cases: Vec<_> = cases.map(|start| Case::with_all_choices(mapping, start)).collect();
        assert_same(&compiled.copy(&format!("all-choices/{name}")), &cases);
        assert_eq!(cases.iter().map(|case| case.lines.len()).sum::<usize>(), runs);
    }
}

/// The number of random starts, for each algorithm.
const RANDOM_STARTS: usize = 1000;

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn both_do_the_same_with_random_choices_in_random_starts() {
    let compiled = compiled();
    for (name, mapping) in [("directional", Mapping::Directional), ("movable", Mapping::Movable)] {
        let mut random = Random::new(1);
        let cases: Vec<_> = iter::repeat_with(|| {
            let start = random.start(mapping);
            Case::at_random(mapping, start, &mut random)
        })
        .take(RANDOM_STARTS)
        .collect();
        assert_same(&compiled.copy(&format!("random-choices/{name}")), &cases);
    }
}

/// Algorithm 1 with another choice at lines 5 and 9, or another way back, is another algorithm; so is that
/// of the movable marker where it looks for it in another order. If a rejected hypothesis is not the one that
/// is removed, only other than the default choices show it.
#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn another_algorithm_is_detected() {
    let multigraphs = starts(Class::Multigraph, 1..=3);
    let directional = |start| Case::with_all_choices(Mapping::Directional, start);
    let all_choices: Vec<_> = multigraphs.iter().cloned().map(directional).collect();
    let multigraphs = by_default(Mapping::Directional, multigraphs);
    let simple = by_default(Mapping::Movable, starts(Class::Simple, 1..=7));
    for (change, cases, file, from, to) in [
        ("ties", &multigraphs, "Algorithm1.v", "then d else best", "then best else d"),
        ("way back", &multigraphs, "Spec.v", "then 0 :: rev [", "then rev ["),
        ("removed", &all_choices, "Algorithm1.v", "turned' (rem h H)", "turned' (behead H)"),
        ("search", &simple, "MovableMarker.v", "(d < d') ||", "(d > d') ||"),
    ] {
        assert_detected(&format!("another/{change}"), cases, file, [from, to]);
    }
}
