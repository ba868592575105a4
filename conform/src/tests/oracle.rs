//! An independent answer to the question whether a world of any size explains a trace, with that world as
//! the witness. It is slow and simple: the ends of all vertices of the trail are labelled, and labels are
//! made equal until nothing changes.

use std::{
    collections::{BTreeMap, BTreeSet},
    ops::ControlFlow,
};

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Class, Each, EnumeratedGraph, Enumeration},
    mapping::{
        Algorithm1Run, Explorer, MapWalk, MappingAlgorithm, MappingError, MappingEvent, Observed,
        explore_with,
    },
    percept::{Door, Percept, Sighting},
    trace::{Trace, TraceEventKind},
    world::{GraphWorld, World},
};

/// A world with a robot in it.
pub(super) struct Position<'g> {
    pub(super) graph: &'g EmbeddedGraph,
    /// The dart along which the marker lies, if there is one.
    pub(super) marker: Option<Dart>,
    /// The dart by which the robot came in.
    pub(super) pose: Dart,
}

impl Position<'_> {
    /// Whether the walk of a trace from here has its percepts. The rules of motion and perception are
    /// written out here once more.
    pub(super) fn explains(&self, trace: &Trace) -> bool {
        let Self { graph, marker, mut pose } = *self;
        let points = !is_undirected(trace);
        for (moves, percept) in trace.percepts().iter().enumerate() {
            let degree = graph.degree(graph.vertex(pose));
            let here = marker.filter(|&marker| graph.vertex(marker) == graph.vertex(pose));
            let sighting = here.map_or(Sighting::Nothing, |marker| {
                if !points {
                    return Sighting::Lying(1);
                }
                let along =
                    |&door: &u32| (graph.index(pose) + door) % degree == graph.index(marker);
                Sighting::Pointing(Door((0..degree).find(along).unwrap()))
            });
            if *percept != (Percept { degree, sighting }) {
                return false;
            }
            let Some(door) = trace.doors().get(moves) else { break };
            if door.0 >= degree {
                return false;
            }
            let index = (graph.index(pose) + door.0) % degree;
            pose = graph.opposite(graph.dart(graph.vertex(pose), index).unwrap());
        }
        true
    }
}

/// Whether the marker of a trace points along no door.
fn is_undirected(trace: &Trace) -> bool {
    let lies = |percept: &Percept| matches!(percept.sighting, Sighting::Lying(_));
    trace.percepts().iter().any(lies)
}

/// Whether a world with at most this many edges explains a trace, from any start, with the marker along any
/// dart; also without one, unless the robot has one.
pub(super) fn is_explained_by_small(trace: &Trace, edges: usize, is_marked: bool) -> bool {
    (1..=edges).any(|edges| {
        let mut visit = |found: EnumeratedGraph| {
            let graph = found.graph;
            let without = (!is_marked).then_some(None);
            let mut markers = graph.darts().map(Some).chain(without);
            let explains = |marker| Position { graph, marker, pose: Dart(0) }.explains(trace);
            if markers.any(explains) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let all = Enumeration::new(Each::Start, Class::Multigraph, edges).unwrap();
        all.for_each(&mut visit).is_break()
    })
}

/// A world, a dart of its marker and the robot's pose at the start.
type Witness = (EmbeddedGraph, Option<Dart>, Dart);

/// An undirected marker may lie in too many ways.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TooManyWays;

/// The number of ways in which an undirected marker may lie that are tried.
const WAYS: usize = 300;

/// A world that explains a trace; `None` if there is none of any size. An undirected marker is one that points along a
/// door that is not recorded: every door is tried at each sighting but the first.
pub(super) fn witness(trace: &Trace) -> Result<Option<Witness>, TooManyWays> {
    let percepts = || trace.percepts().iter().enumerate();
    let mut ways = 0;
    let mut open = vec![Vec::new()];
    while let Some(doors) = open.pop() {
        ways += 1;
        if ways > WAYS {
            return Err(TooManyWays);
        }
        // The next sighting after those whose doors are chosen.
        let lying = percepts().filter(|(_, percept)| percept.sighting == Sighting::Lying(1));
        let next = lying.map(|(visit, percept)| (visit, percept.degree)).nth(doors.len());
        let mut chosen = doors.iter();
        let mut kinds = Vec::new();
        for (visit, percept) in percepts().take(next.map_or(usize::MAX, |(visit, _)| visit)) {
            let sighting = match percept.sighting {
                Sighting::Lying(1) => Sighting::Pointing(Door(*chosen.next().unwrap())),
                other => other,
            };
            kinds.push(TraceEventKind::Percept(Percept { sighting, ..*percept }));
            kinds.extend(trace.doors().get(visit).map(|&door| TraceEventKind::Door(door)));
        }
        let found = Trace::new(kinds).ok().and_then(|trace| directed_witness(&trace));
        if found.is_none() && next.is_none_or(|(visit, _)| visit > 0) {
            continue;
        }
        let Some((_, degree)) = next else { return Ok(found) };
        let most = if doors.is_empty() { 1 } else { degree };
        open.extend((0..most).rev().map(|door| [doors.clone(), vec![door]].concat()));
    }
    Ok(None)
}

/// A world that explains a trace without an undirected marker; `None` if there is none of any size.
fn directed_witness(trace: &Trace) -> Option<Witness> {
    let degrees: Vec<_> = trace.percepts().iter().map(|percept| percept.degree as usize).collect();
    let first = |vertex: usize| degrees[..vertex].iter().sum::<usize>();
    let count = degrees.iter().sum();
    let vertices: Vec<_> =
        degrees.iter().enumerate().flat_map(|(vertex, &degree)| vec![vertex; degree]).collect();
    let clockwise = |dart: usize| {
        let vertex = vertices[dart];
        first(vertex) + (dart - first(vertex) + 1) % degrees[vertex]
    };
    let mut label: Vec<usize> = (0..count).collect();
    let mut links = Vec::new();
    for (moves, door) in trace.doors().iter().enumerate() {
        if door.0 as usize >= degrees[moves] {
            return None;
        }
        if moves + 1 < degrees.len() {
            let ends = [first(moves) + door.0 as usize, first(moves + 1)];
            links.extend([ends, [ends[1], ends[0]]]);
        }
    }
    let mut markers = Vec::new();
    for (vertex, percept) in trace.percepts().iter().enumerate() {
        match percept.sighting {
            Sighting::Nothing if percept.degree > 0 => {}
            Sighting::Pointing(door) if door.0 < percept.degree => {
                markers.push(first(vertex) + door.0 as usize);
            }
            _ => return None,
        }
    }
    let mut same: Vec<[usize; 2]> = markers.windows(2).map(|two| [two[0], two[1]]).collect();
    loop {
        for [one, other] in std::mem::take(&mut same) {
            let [one, other] = [label[one], label[other]];
            if degrees[vertices[one]] != degrees[vertices[other]] {
                return None;
            }
            let least = one.min(other);
            for label in &mut label {
                if *label == one || *label == other {
                    *label = least;
                }
            }
        }
        let turned = label.iter().enumerate();
        same.extend(turned.map(|(dart, &label)| [clockwise(dart), clockwise(label)]));
        for [near, far] in &links {
            let other = links.iter().find(|[other, _]| label[*other] == label[*near]);
            same.extend(other.map(|[_, other]| [*far, *other]));
        }
        same.retain(|[one, other]| label[*one] != label[*other]);
        if same.is_empty() {
            break;
        }
    }
    let is_whole = |vertex: usize| {
        let labels = (first(vertex)..first(vertex + 1)).map(|dart| label[dart]);
        labels.collect::<BTreeSet<_>>().len() == degrees[vertex]
    };
    let marker = markers.first().map(|&dart| label[dart]);
    let looks = |vertex: usize| {
        let marked = (first(vertex)..first(vertex + 1)).any(|dart| Some(label[dart]) == marker);
        marked == (trace.percepts()[vertex].sighting != Sighting::Nothing)
    };
    let itself = links.iter().any(|[near, far]| label[*near] == label[*far]);
    if itself || !(0..degrees.len()).all(|vertex| is_whole(vertex) && looks(vertex)) {
        return None;
    }
    let turn: Vec<_> = (0..count).map(|dart| [label[dart], label[clockwise(dart)]]).collect();
    let links: Vec<_> = links.iter().map(|ends| ends.map(|dart| label[dart])).collect();
    let (graph, number) = world(&turn, &links);
    Some((graph, marker.map(|label| number[&label]), number[&label[0]]))
}

/// The world of labelled darts, given what follows each clockwise and the known ends, and the dart of each
/// label. A dart whose other end is not known leads to a dead end.
fn world(clockwise: &[[usize; 2]], links: &[[usize; 2]]) -> (EmbeddedGraph, BTreeMap<usize, Dart>) {
    let mut number = BTreeMap::new();
    for [label, _] in clockwise {
        let next = number.len();
        number.entry(*label).or_insert(next);
    }
    let mut turn = vec![0; number.len()];
    let mut opposite = vec![None; number.len()];
    for [label, next] in clockwise {
        turn[number[label]] = number[next] as u32;
    }
    for [near, far] in links {
        opposite[number[near]] = Some(number[far] as u32);
    }
    for dart in 0..opposite.len() {
        if opposite[dart].is_none() {
            let end = opposite.len() as u32;
            opposite[dart] = Some(end);
            turn.push(end);
            opposite.push(Some(dart as u32));
        }
    }
    let opposite: Vec<_> = opposite.into_iter().flatten().collect();
    let (graph, darts) = EmbeddedGraph::from_permutations(&opposite, &turn).unwrap();
    let number = number.into_iter().map(|(label, dart)| (label, darts[dart])).collect();
    (graph, number)
}

/// A robot that takes only the doors of a trace.
struct DoorsOf<'t, 'g> {
    world: GraphWorld<'g>,
    doors: &'t [Door],
}

/// Why it goes no further: all doors were taken, or another door would be taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum DoorsEnd {
    All,
    Other,
}

impl World for DoorsOf<'_, '_> {
    type Error = DoorsEnd;

    fn percept(&mut self) -> Result<Percept, DoorsEnd> {
        Ok(self.world.sensed())
    }

    fn traverse(&mut self, door: Door) -> Result<(), DoorsEnd> {
        let Some((first, rest)) = self.doors.split_first() else { return Err(DoorsEnd::All) };
        if *first != door {
            return Err(DoorsEnd::Other);
        }
        self.doors = rest;
        if rest.is_empty() {
            return Err(DoorsEnd::All);
        }
        self.world.traverse(door).map_err(|_| DoorsEnd::Other)
    }
}

/// The choices of one run of Algorithm 1: for each, its index and the number of those that are open.
#[derive(Default)]
struct Script {
    choices: Vec<[usize; 2]>,
    made: usize,
}

impl Script {
    fn choose(&mut self, open: usize) -> usize {
        if self.made == self.choices.len() {
            self.choices.push([0, open]);
        }
        self.made += 1;
        self.choices[self.made - 1][0]
    }

    /// The choices of the next run; `false` if there is none.
    fn advance(&mut self) -> bool {
        self.choices.truncate(self.made);
        self.made = 0;
        while let Some([chosen, open]) = self.choices.pop() {
            if chosen + 1 < open {
                self.choices.push([chosen + 1, open]);
                return true;
            }
        }
        false
    }
}

/// The number of runs of Algorithm 1 that are tried.
const RUNS: usize = 1000;

/// Whether some run of an algorithm takes all doors of a trace whose last event is a door: run after run in a world
/// that explains the percepts. `None` if there are too many runs.
pub(super) fn takes_doors(algorithm: MappingAlgorithm, trace: &Trace) -> Option<bool> {
    let before = trace.up_to(2 * trace.percepts().len() - 2);
    let (graph, marker, pose) = witness(&before).ok()??;
    // A run begins with the marker along the entry door.
    if marker != Some(pose) {
        return Some(false);
    }
    let mut script = Script::default();
    for _ in 0..RUNS {
        let mut world = DoorsOf { world: GraphWorld::new(&graph, pose), doors: trace.doors() };
        let mut nobody = |_: &mut DoorsOf, _: &MapWalk, _: MappingEvent| {};
        let end = match algorithm {
            MappingAlgorithm::Algorithm1 => {
                let mut exploration = Algorithm1Run::new(usize::MAX);
                explore_with(&mut exploration, &mut Observed::new(&mut world, &mut nobody), |run| {
                    let open = run.choices()?;
                    if open.is_empty() {
                        return Ok(None);
                    }
                    Ok(open.get(script.choose(open.len())).copied())
                })
            }
            _ => algorithm.map_world(&mut world, usize::MAX, &mut nobody).1,
        };
        if matches!(end, Err(MappingError::World(DoorsEnd::All))) {
            return Some(true);
        }
        if algorithm == MappingAlgorithm::Folding || !script.advance() {
            return Some(false);
        }
    }
    None
}
