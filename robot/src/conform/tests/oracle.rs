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
    percept::{Door, Percept, Sighting},
    trace::Trace,
};

/// A world with a robot in it.
#[derive(Clone, Debug)]
pub(super) struct Place<'g> {
    pub(super) graph: &'g EmbeddedGraph,
    /// The dart along which the marker lies, if there is one.
    pub(super) marker: Option<Dart>,
    /// The dart by which the robot came in.
    pub(super) pose: Dart,
}

impl Place<'_> {
    /// Whether the walk of a trace from here has its percepts. The rules of motion and perception are
    /// written out here once more.
    pub(super) fn explains(&self, trace: &Trace) -> bool {
        let Self { graph, marker, mut pose } = *self;
        for (moves, percept) in trace.percepts().iter().enumerate() {
            let degree = graph.degree(graph.vertex(pose));
            let here = marker.filter(|&marker| graph.vertex(marker) == graph.vertex(pose));
            let sighting = here.map_or(Sighting::Nothing, |marker| {
                let points =
                    |&door: &u32| (graph.index(pose) + door) % degree == graph.index(marker);
                Sighting::Pointing(Door((0..degree).find(points).unwrap()))
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

/// Whether a world with at most this many edges explains a trace, from any start, with the marker along any
/// dart or without one.
pub(super) fn is_explained_by_small(trace: &Trace, edges: usize) -> bool {
    (1..=edges).any(|edges| {
        let mut visit = |found: EnumeratedGraph| {
            let graph = found.graph;
            let place = |marker| Place { graph, marker, pose: Dart(0) };
            let markers = graph.darts().map(Some).chain([None]);
            if markers.map(place).any(|place| place.explains(trace)) {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let all = Enumeration::new(Each::Start, Class::Multigraph, edges).unwrap();
        all.for_each(&mut visit).is_break()
    })
}

/// A world that explains a trace, the marker in it and the robot's pose at the start; `None` if there is
/// none of any size.
pub(super) fn witness(trace: &Trace) -> Option<(EmbeddedGraph, Option<Dart>, Dart)> {
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
