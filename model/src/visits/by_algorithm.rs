//! Searches for a choice of visits whose doors a mapping algorithm takes. Section 2.3.
//!
//! The door of an algorithm depends on all that it perceived before. So choices are followed one by one, depth first in the
//! order of time, with the runs of the algorithm that make the moves of each. A run waits for its next percept until a visit is
//! chosen, and is dropped if it then takes another door than that of the visit. In a known world from a known start the
//! percepts are known, and the choices that are left are the pairs of a visit and a move.
//!
//! An algorithm does not turn back between vertices. Where a robot turned back without a vertex, it was at a dead end.

use std::collections::{BTreeSet, HashSet};

use super::{
    Explanation, VisitAlternative, VisitSet, VisitWay,
    in_some_world::{Next, VisitWalk},
    in_world::VisitStep,
};
use crate::{
    aid::State,
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Watch,
    mapping::{
        Explorer, InvalidStep, MappingAlgorithm, MappingError, PartialMap, StateLevel,
        with_explorer,
    },
    marker::MarkerKind,
    percept::{Door, Percept, Sighting},
    trace::{Trace, TraceEventKind, TraceWorld, TraceWorldError},
};

/// The limits of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AlgorithmSearchBounds {
    /// The largest number of darts that the algorithm may know.
    pub darts: usize,
    /// The number of steps of all runs together.
    pub steps: usize,
}

/// Where the robot of a choice may be.
#[derive(Clone)]
enum Place<'g> {
    InWorld(&'g EmbeddedGraph, Vec<State>),
    InSomeWorld(VisitWalk),
}

/// The first visits with a choice of each.
#[derive(Clone)]
struct Choice<'g, E: Explorer> {
    /// The vertices, each with the door that was taken.
    moves: Vec<VisitAlternative>,
    place: Place<'g>,
    runs: Vec<Run<E>>,
}

/// A run of the algorithm before a step in which it waits for what was not chosen yet.
#[derive(Clone)]
struct Run<E: Explorer> {
    explorer: E,
    /// The number of moves before the step.
    moves: usize,
    next: NextStep<E::Choice>,
}

#[derive(Clone, Copy)]
enum NextStep<C> {
    Begin,
    Make(C),
    /// None: the map is complete.
    Done,
}

/// What distinguishes runs with the same moves between two steps.
type RunKey = (usize, StateLevel, Vec<u32>, Option<(PartialMap, Dart)>);

/// A choice, and the ways to go on that have not been tried, the last one first.
struct Branch<'g, E: Explorer> {
    choice: Choice<'g, E>,
    untried: Vec<(Option<VisitAlternative>, Option<VisitAlternative>)>,
}

struct Search {
    algorithm: MappingAlgorithm,
    marker: MarkerKind,
    bounds: AlgorithmSearchBounds,
    steps: usize,
    /// Whether a run would know too many darts.
    is_cut: bool,
}

/// Searches for a choice of the visits that a world explains and whose doors an algorithm takes: Algorithm 1 with any of its
/// open choices, others with their default ones.
/// The world is a known one, with the states in which the robot may begin, or else any world. An algorithm that carries its
/// marker is not followed.
pub fn explain_by_algorithm(
    algorithm: MappingAlgorithm,
    visits: &[VisitSet],
    world: Option<(&EmbeddedGraph, &[State])>,
    bounds: AlgorithmSearchBounds,
    watch: &dyn Watch,
) -> Explanation {
    let Some(marker) = algorithm.aid().fixed() else { return Explanation::NotKnown };
    let place = world.map_or_else(
        || Place::InSomeWorld(VisitWalk::begin()),
        |(graph, states)| Place::InWorld(graph, states.to_vec()),
    );
    let search = Search { algorithm, marker, bounds, steps: 0, is_cut: false };
    with_explorer!(algorithm, new => search.run(new(), visits, place, watch))
}

impl Search {
    fn run<E: Explorer>(
        mut self,
        mut explorer: E,
        visits: &[VisitSet],
        place: Place,
        watch: &dyn Watch,
    ) -> Explanation {
        let Some(first) = visits.first() else { return Explanation::Explained(Vec::new()) };
        explorer.limit_darts(self.bounds.darts);
        let runs = vec![Run { explorer, moves: 0, next: NextStep::Begin }];
        let choice = Choice { moves: Vec::new(), place, runs };
        let mut branches = vec![Branch { choice, untried: ways(first, visits.len() == 1) }];
        let (mut chosen, mut tried, mut farthest) = (Vec::new(), BTreeSet::new(), 0);
        loop {
            let visit = branches.len();
            let Some(Branch { choice, untried }) = branches.last_mut() else { break };
            let Some((alternative, vertex)) = untried.pop() else {
                branches.pop();
                chosen.pop();
                continue;
            };
            self.steps += 1;
            if self.steps > self.bounds.steps || watch.stop() {
                return Explanation::NotKnown;
            }
            let moves: Vec<_> = choice.moves.iter().copied().chain(vertex).collect();
            let next = match vertex {
                _ if !tried.insert((visit, moves.clone())) => None,
                None => Some(choice.clone()),
                Some(vertex) => self.after(&*choice, vertex, moves),
            };
            let Some(choice) = next else { continue };
            farthest = farthest.max(visit);
            chosen.push(alternative);
            let Some(set) = visits.get(visit) else { return Explanation::Explained(chosen) };
            branches.push(Branch { choice, untried: ways(set, visit + 1 == visits.len()) });
        }
        let is_known = !self.is_cut && self.steps <= self.bounds.steps;
        if is_known { Explanation::Impossible { visit: farthest } } else { Explanation::NotKnown }
    }

    /// A choice with one more vertex, by which there are these moves; `None` if it fits no world, or no run.
    fn after<'g, E: Explorer>(
        &mut self,
        choice: &Choice<'g, E>,
        vertex: VisitAlternative,
        moves: Vec<VisitAlternative>,
    ) -> Option<Choice<'g, E>> {
        let place = choice.place.after(vertex, self.marker)?;
        let kinds = moves.iter().flat_map(|&VisitAlternative { percept, door }| {
            let door = door.map(TraceEventKind::Door);
            std::iter::once(TraceEventKind::Percept(percept)).chain(door)
        });
        let runs = self.waiting(&choice.runs, &Trace::new(kinds).ok()?);
        (!runs.is_empty()).then_some(Choice { moves, place, runs })
    }

    /// The runs that take the doors of a trace, where they wait for more.
    fn waiting<E: Explorer>(&mut self, runs: &[Run<E>], trace: &Trace) -> Vec<Run<E>> {
        let (mut waiting, mut known) = (Vec::new(), HashSet::new());
        let mut ready = runs.to_vec();
        while let Some(mut run) = ready.pop() {
            self.steps += 1;
            if self.steps > self.bounds.steps {
                break;
            }
            let before = run.clone();
            let mut world = TraceWorld::after(trace, run.moves);
            let stepped = match run.next {
                NextStep::Begin => run.explorer.begin(&mut world),
                NextStep::Make(choice) => run.explorer.step(choice, &mut world),
                NextStep::Done => {
                    waiting.extend((run.moves == trace.doors().len()).then_some(run));
                    continue;
                }
            };
            run.moves = world.moves();
            match stepped {
                Ok(()) if run.key().is_some_and(|key| !known.insert(key)) => {}
                Ok(()) => {
                    let choices = self.choices(&mut run.explorer).unwrap_or_default();
                    if choices.is_empty() && run.explorer.explored().is_ok() {
                        ready.push(Run { next: NextStep::Done, ..run.clone() });
                    }
                    let with = |choice| Run { next: NextStep::Make(choice), ..run.clone() };
                    ready.extend(choices.into_iter().map(with));
                }
                Err(MappingError::World(TraceWorldError::End)) => waiting.push(before),
                Err(MappingError::Bound { .. }) => self.is_cut = true,
                Err(_) => {}
            }
        }
        waiting
    }

    /// The choices with which a run goes on: Algorithm 1 allows any, others have their default ones alone.
    fn choices<E: Explorer>(&self, explorer: &mut E) -> Result<Vec<E::Choice>, InvalidStep> {
        if self.algorithm == MappingAlgorithm::Algorithm1 {
            explorer.choices()
        } else {
            Ok(explorer.choose()?.into_iter().collect())
        }
    }
}

impl<E: Explorer> Run<E> {
    /// `None` if its state is not compared with others.
    fn key(&self) -> Option<RunKey> {
        let map = self.explorer.map_walk().map(|walk| (walk.map().clone(), walk.robot()));
        let mut key = Vec::new();
        let level = self.explorer.write_key(&mut key)?;
        Some((self.moves, level, key, map))
    }
}

impl Place<'_> {
    /// Where the robot may be after a visit to a vertex.
    fn after(&self, vertex: VisitAlternative, marker: MarkerKind) -> Option<Self> {
        match self {
            &Self::InWorld(graph, ref before) => {
                let (way, is_last) = (VisitWay::Through, vertex.door.is_none());
                let step = VisitStep { graph, marker: &marker, way, is_last };
                let states = before.iter().flat_map(|&state| step.after(state, Some(vertex)));
                let states: BTreeSet<State> = states.collect();
                let may_be = !states.is_empty();
                may_be.then(|| Self::InWorld(graph, states.into_iter().collect()))
            }
            Self::InSomeWorld(walk) => {
                let next = vertex.door.map_or(Next::Stands, Next::Leaves);
                let walk = walk.after(Some(vertex), next);
                walk.filter(VisitWalk::may_hold_marker).map(Self::InSomeWorld)
            }
        }
    }
}

/// The alternatives of a visit, each with the vertex that it is to an algorithm, from the last to the first.
fn ways(
    visit: &VisitSet,
    is_last: bool,
) -> Vec<(Option<VisitAlternative>, Option<VisitAlternative>)> {
    let dead_end = |sighting| VisitAlternative {
        percept: Percept { degree: 1, sighting },
        door: Some(Door::BACK),
    };
    let dead_ends = [Sighting::Nothing, Sighting::Pointing(Door::BACK)].map(dead_end);
    let mut ways = Vec::new();
    for &alternative in visit.alternatives() {
        match (alternative, visit.way()) {
            (None, VisitWay::Through) => ways.push((None, None)),
            (None, VisitWay::Back) => ways.extend(dead_ends.map(|end| (None, Some(end)))),
            (Some(vertex), _) if is_last && vertex.door.is_none() => {
                ways.push((alternative, alternative));
            }
            (Some(vertex), _) => {
                let leaves = |door| Some(VisitAlternative { door: Some(door), ..vertex });
                ways.extend(vertex.doors().map(|door| (alternative, leaves(door))));
            }
        }
    }
    ways.reverse();
    ways
}
