//! Matches a trace with Algorithm 1: are the doors those that it takes, or may take? Section 2.3.

use std::{collections::HashSet, fmt, mem};

use thiserror::Error;

use super::{AlgorithmCoverage, Trace, TraceEvent};
use crate::{
    embedded_graph::Dart,
    mapping::{
        Contradiction, Exploration, InvalidStep, MappingChoice, MappingError, Nearest, Observer,
        PartialMap, map_world, step,
    },
    percept::{Door, Percept},
    world::World,
};

/// How far Algorithm 1 follows a trace.
#[derive(Clone, Debug)]
pub struct AlgorithmMatch {
    /// The choices that it takes.
    pub choices: MatchedChoices,
    /// How far it follows the trace.
    pub reached: MatchEnd,
    /// Its state at that point.
    pub exploration: Exploration,
    /// The cases that it covers.
    pub coverage: AlgorithmCoverage,
    /// The choices that are not the default ones.
    script: Option<Vec<MappingChoice>>,
}

/// The choices that match a trace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MatchedChoices {
    /// The default ones.
    Default,
    /// Others that Algorithm 1 allows.
    Other {
        /// The id of the first event that the default choices would not have; `None` if they would go on
        /// after the last one.
        from: Option<usize>,
    },
}

/// How far Algorithm 1 follows a trace.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MatchEnd {
    /// To the end of both: the map is complete.
    Mapped,
    /// To the end of the trace.
    EndOfTrace,
    /// To an event that it does not have.
    Departure(Departure),
    /// To an event at which it would know more darts than the bound allows. What follows is not matched.
    Bound {
        /// The event.
        event: TraceEvent,
    },
}

/// The first event of a trace that no run of Algorithm 1 has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Departure {
    /// The event.
    pub event: TraceEvent,
    /// What Algorithm 1 does there instead, for each choice that leads there.
    pub allowed: Vec<AllowedStep>,
}

/// What Algorithm 1 does instead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AllowedStep {
    /// The door that it takes, if any.
    pub door: Option<Door>,
    /// The purpose.
    pub purpose: StepPurpose,
}

/// The purpose of a step of Algorithm 1. Darts of the map are given by vertex and index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepPurpose {
    /// Lines 5 and 6: to explore this dart.
    Explore {
        /// The vertex's number.
        vertex: u32,
        /// The index of the dart.
        index: u32,
    },
    /// Lines 10 to 15: to follow the path of the hypothesis that it arrived by this dart, or to return.
    Try {
        /// The vertex's number.
        vertex: u32,
        /// The index of the dart.
        index: u32,
    },
    /// The map is complete.
    Done,
    /// The percept is a contradiction.
    Contradicted(Contradiction),
    /// The step is not valid: the enumeration of choices is wrong.
    InvalidStep(InvalidStep),
}

impl fmt::Display for StepPurpose {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Explore { vertex, index } => {
                write!(out, "line 5: explores the unexplored dart {index} of vertex v{vertex}")
            }
            Self::Try { vertex, index } => {
                write!(out, "line 9: tests whether it arrived by dart {index} of vertex v{vertex}")
            }
            Self::Done => write!(out, "line 4: the map is complete"),
            Self::Contradicted(contradiction) => write!(out, "{contradiction}"),
            Self::InvalidStep(step) => write!(out, "{step}"),
        }
    }
}

impl fmt::Display for AllowedStep {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        if let Some(door) = self.door {
            write!(out, "door {} (", door.0)?;
            write!(out, "{})", self.purpose)
        } else {
            write!(out, "{}", self.purpose)
        }
    }
}

/// A world with the recorded percepts, as long as the recorded doors are taken.
#[derive(Clone, Debug)]
pub struct TraceWorld<'t> {
    trace: &'t Trace,
    moves: usize,
}

/// Why a recorded world cannot continue.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum TraceWorldError {
    /// Another door was taken.
    #[error("door {} was taken then, not door {}", recorded.0, asked.0)]
    Door {
        /// The door that was taken.
        recorded: Door,
        /// The door that the algorithm takes.
        asked: Door,
    },
    /// The trace has no further event.
    #[error("the trace ends here")]
    End,
}

impl World for TraceWorld<'_> {
    type Error = TraceWorldError;

    fn percept(&mut self) -> Result<Percept, TraceWorldError> {
        self.trace.percepts().get(self.moves).copied().ok_or(TraceWorldError::End)
    }

    fn traverse(&mut self, asked: Door) -> Result<(), TraceWorldError> {
        match self.trace.doors().get(self.moves) {
            None => Err(TraceWorldError::End),
            Some(&recorded) if recorded != asked => Err(TraceWorldError::Door { recorded, asked }),
            Some(_) => {
                self.moves += 1;
                Ok(())
            }
        }
    }
}

/// What a trace claims to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TraceClaim {
    /// A complete run: choices that end with the trace are preferred.
    Whole,
    /// Possibly a part of a run.
    Part,
}

/// Matches a trace with Algorithm 1: with the default choices as long as they match, otherwise with any
/// choices. At most `bound` darts may become known.
#[must_use]
pub fn match_algorithm(trace: &Trace, claim: TraceClaim, bound: usize) -> AlgorithmMatch {
    let mut world = TraceWorld { trace, moves: 0 };
    let mut exploration = Exploration::new(bound);
    let mut coverage = AlgorithmCoverage::default();
    let run = map_world(&mut world, &mut Nearest, &mut exploration, &mut coverage);
    let reached = match &run {
        Ok(()) if world.moves == trace.doors().len() => Some(MatchEnd::Mapped),
        Err(MappingError::World(TraceWorldError::End)) => Some(MatchEnd::EndOfTrace),
        _ => None,
    };
    let to_the_end = reached == Some(MatchEnd::Mapped);
    let part = reached == Some(MatchEnd::EndOfTrace);
    let mut search = Search { claim, ..Search::default() };
    // Other choices may take the same doors and complete the map.
    let found = if to_the_end || (part && claim == TraceClaim::Part) {
        None
    } else {
        search.run(trace, bound).filter(|(found, _)| !part || *found == MatchEnd::Mapped)
    };
    if let (Some(reached), None) = (reached, &found) {
        let choices = MatchedChoices::Default;
        return AlgorithmMatch { choices, reached, exploration, coverage, script: None };
    }
    // If the default choices match the whole trace, they differ after its end.
    let from = match run {
        Err(MappingError::World(TraceWorldError::End)) => trace.len(),
        Err(MappingError::Contradiction(_) | MappingError::Bound { .. }) => 2 * world.moves,
        _ => 2 * world.moves + 1,
    };
    let from = (from < trace.len()).then(|| trace.event(from).id);
    let (reached, script) = found.unwrap_or_else(|| search.end(trace));
    let choices = match &reached {
        MatchEnd::Departure(Departure { event, .. }) | MatchEnd::Bound { event }
            if Some(event.id) == from =>
        {
            MatchedChoices::Default
        }
        _ => MatchedChoices::Other { from },
    };
    let mut followed =
        AlgorithmMatch { choices, reached, exploration, coverage, script: Some(script) };
    let mut coverage = AlgorithmCoverage::default();
    followed.exploration = followed.again(trace, bound, &mut coverage);
    AlgorithmMatch { coverage, ..followed }
}

impl AlgorithmMatch {
    /// Runs along the trace again, as far as Algorithm 1 follows it, for an observer.
    pub fn again(
        &self,
        trace: &Trace,
        bound: usize,
        observer: &mut impl for<'t> Observer<TraceWorld<'t>>,
    ) -> Exploration {
        let mut exploration = Exploration::new(bound);
        let mut world = TraceWorld { trace, moves: 0 };
        // The result is known.
        let _ = match &self.script {
            None => map_world(&mut world, &mut Nearest, &mut exploration, observer),
            Some(script) => exploration.begin(&mut world, observer).and_then(|()| {
                let mut choices = script.iter();
                choices.try_for_each(|&choice| step(&mut exploration, choice, &mut world, observer))
            }),
        };
        exploration
    }
}

/// A run that matches the trace so far.
#[derive(Clone)]
struct Way<'t> {
    exploration: Exploration,
    world: TraceWorld<'t>,
    /// The choices made so far.
    script: Vec<MappingChoice>,
}

impl Way<'_> {
    /// The purpose of a choice.
    fn purpose(&self, choice: MappingChoice) -> StepPurpose {
        let map = self.exploration.map();
        let named = |dart| (map.vertex(dart).0, map.index(dart));
        match choice {
            MappingChoice::Edge(edge) => {
                let (vertex, index) = named(edge);
                StepPurpose::Explore { vertex, index }
            }
            MappingChoice::Hypothesis(place) => {
                let (vertex, index) = named(self.exploration.hypotheses()[place]);
                StepPurpose::Try { vertex, index }
            }
        }
    }
}

/// What distinguishes runs: the moves, the line, the map, the robot in it, and H.
type Known = (usize, bool, PartialMap, Dart, Vec<Dart>);

/// All choices, depth first.
struct Search {
    claim: TraceClaim,
    /// The choices of the first run that matches the trace without completing the map.
    part: Option<Vec<MappingChoice>>,
    seen: HashSet<Known>,
    /// The index of the first event that none of the longest runs has,
    farthest: usize,
    /// what they have instead,
    allowed: Vec<AllowedStep>,
    /// and the choices of the first of them.
    script: Vec<MappingChoice>,
    /// Of the longest run that reached the bound on known darts: the index of the event, and the choices.
    bound: Option<(usize, Vec<MappingChoice>)>,
}

impl Default for Search {
    fn default() -> Self {
        Self {
            claim: TraceClaim::Part,
            part: None,
            seen: HashSet::new(),
            farthest: 0,
            allowed: Vec::new(),
            script: Vec::new(),
            bound: None,
        }
    }
}

impl Search {
    /// A run that matches the whole trace.
    fn run(&mut self, trace: &Trace, bound: usize) -> Option<(MatchEnd, Vec<MappingChoice>)> {
        let mut exploration = Exploration::new(bound);
        let mut world = TraceWorld { trace, moves: 0 };
        let begun = exploration.begin(&mut world, &mut ());
        let way = Way { exploration, world, script: Vec::new() };
        if let Err(error) = begun {
            self.ended(&way, &error, StepPurpose::Done);
            return None;
        }
        let mut ways = vec![way];
        while let Some(way) = ways.pop() {
            let known = (
                way.world.moves,
                way.exploration.is_at_line_8(),
                way.exploration.map().clone(),
                way.exploration.robot(),
                way.exploration.hypotheses().to_vec(),
            );
            if !self.seen.insert(known) {
                continue;
            }
            if way.exploration.map().unexplored_is_empty() {
                if way.world.moves == trace.doors().len() {
                    return Some((MatchEnd::Mapped, way.script));
                }
                let done = AllowedStep { door: None, purpose: StepPurpose::Done };
                self.departed(2 * way.world.moves + 1, done, &way.script);
            }
            // The first choice is tried first.
            ways.extend(self.next(&way).into_iter().rev());
            if self.claim == TraceClaim::Part && self.part.is_some() {
                break;
            }
        }
        self.part.take().map(|part| (MatchEnd::EndOfTrace, part))
    }

    /// Every choice that matches the trace.
    fn next<'t>(&mut self, way: &Way<'t>) -> Vec<Way<'t>> {
        let mut choices: Vec<_> = way.exploration.open_choices().collect();
        let tries_hypotheses = way.exploration.is_at_line_8();
        if tries_hypotheses {
            // The default is the last.
            choices.reverse();
        }
        let mut next = Vec::new();
        let mut rejected = false;
        for choice in choices {
            let purpose = way.purpose(choice);
            let mut way = way.clone();
            way.script.push(choice);
            match step(&mut way.exploration, choice, &mut way.world, &mut ()) {
                Ok(()) => {
                    // Rejected hypotheses are rejected after the same moves: the way back begins with
                    // door 0, which no shortest path takes. So one of them is enough: another one is
                    // rejected after the same moves again.
                    let falls = tries_hypotheses && way.exploration.is_at_line_8();
                    if !falls || !mem::replace(&mut rejected, true) {
                        next.push(way);
                    }
                }
                Err(MappingError::World(TraceWorldError::End)) => {
                    self.part.get_or_insert(way.script);
                }
                Err(error) => self.ended(&way, &error, purpose),
            }
        }
        next
    }

    /// A run ended before the trace.
    fn ended(&mut self, way: &Way, error: &MappingError<TraceWorldError>, purpose: StepPurpose) {
        let at_percept = 2 * way.world.moves;
        let (event, door, purpose) = match error {
            MappingError::World(TraceWorldError::Door { asked, .. }) => {
                (at_percept + 1, Some(*asked), purpose)
            }
            // The end of the trace is no departure.
            MappingError::World(TraceWorldError::End) => return,
            MappingError::Contradiction(contradiction) => {
                (at_percept, None, StepPurpose::Contradicted(*contradiction))
            }
            MappingError::InvalidStep(step) => (at_percept, None, StepPurpose::InvalidStep(*step)),
            // What this run would do after it is not known.
            MappingError::Bound { .. } => {
                if self.bound.as_ref().is_none_or(|(farthest, _)| at_percept > *farthest) {
                    self.bound = Some((at_percept, way.script.clone()));
                }
                return;
            }
        };
        self.departed(event, AllowedStep { door, purpose }, &way.script);
    }

    /// A run has something else instead of an event of the trace.
    fn departed(&mut self, event: usize, allowed: AllowedStep, script: &[MappingChoice]) {
        if self.allowed.is_empty() || event > self.farthest {
            self.farthest = event;
            self.allowed.clear();
            self.script = script.to_vec();
        }
        if event == self.farthest && !self.allowed.contains(&allowed) {
            self.allowed.push(allowed);
        }
    }

    /// The bound, if a run reached it: that run may be longer than all others. Otherwise the departure of
    /// the longest runs.
    fn end(self, trace: &Trace) -> (MatchEnd, Vec<MappingChoice>) {
        if let Some((event, script)) = self.bound {
            return (MatchEnd::Bound { event: trace.event(event) }, script);
        }
        let departure = Departure { event: trace.event(self.farthest), allowed: self.allowed };
        (MatchEnd::Departure(departure), self.script)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{
        any_graph::{Class, any_graph},
        embedded_graph::EmbeddedGraph,
        isomorphism::code,
        mapping::{Choices, FACING, Journey, MappingEvent},
        percept::Sighting,
        trace::{
            TraceEventKind,
            tests::{explored, lollipop, walked},
        },
        world::GraphWorld,
    };

    /// A run of Algorithm 1 that chooses by a row of numbers.
    fn chosen(graph: &EmbeddedGraph, numbers: &[u8]) -> Trace {
        struct Numbers<'n>(std::iter::Cycle<std::slice::Iter<'n, u8>>);
        impl Choices for Numbers<'_> {
            fn next_edge(&mut self, map: &PartialMap, _: Dart, _: Dart) -> Dart {
                let number = usize::from(*self.0.next().unwrap());
                map.unexplored().nth(number % map.unexplored_count() as usize).unwrap()
            }
            fn next_hypothesis(&mut self, _: &PartialMap, hypotheses: &[Dart]) -> usize {
                usize::from(*self.0.next().unwrap()) % hypotheses.len()
            }
        }
        let mut doors = Vec::new();
        let mut listen = |_: &mut GraphWorld, _: &Journey, event: MappingEvent| {
            if let MappingEvent::Moved { door, .. } = event {
                doors.push(door);
            }
        };
        let mut exploration = Exploration::new(graph.dart_count());
        let mut world = GraphWorld::new(graph, Dart(0));
        let mut choices = Numbers(numbers.iter().cycle());
        map_world(&mut world, &mut choices, &mut exploration, &mut listen).unwrap();
        walked(graph, Dart(0), &doors)
    }

    #[test]
    fn a_door_that_no_choice_takes_departs_with_the_allowed_doors() {
        let graph = lollipop();
        // At the fork the robot goes back where it came from, while nothing is left there.
        let trace = walked(&graph, Dart(0), &[Door(0), Door(0)]);
        let followed = match_algorithm(&trace, TraceClaim::Whole, 100);
        let MatchEnd::Departure(departure) = followed.reached else { panic!("{followed:?}") };
        let allowed: Vec<_> = departure.allowed.iter().map(ToString::to_string).collect();
        assert_eq!(departure.event.id, 3);
        assert_eq!(
            allowed,
            [
                "door 1 (line 5: explores the unexplored dart 1 of vertex v1)",
                "door 2 (line 5: explores the unexplored dart 2 of vertex v1)",
            ]
        );
        assert_eq!(followed.choices, MatchedChoices::Default);
    }

    #[test]
    fn a_robot_that_goes_on_when_all_is_known_departs() {
        let graph = lollipop();
        let mut doors = explored(&graph, Dart(0)).doors().to_vec();
        let moves = doors.len();
        doors.push(Door(0));
        let trace = walked(&graph, Dart(0), &doors);
        let followed = match_algorithm(&trace, TraceClaim::Whole, 100);
        let done = AllowedStep { door: None, purpose: StepPurpose::Done };
        let departure = Departure { event: trace.event(2 * moves + 1), allowed: vec![done] };
        assert_eq!(followed.reached, MatchEnd::Departure(departure));
        assert!(followed.exploration.map().complete().is_some());
    }

    #[test]
    fn a_start_without_the_marker_departs_at_once() {
        let percept = Percept { degree: 2, sighting: Sighting::Nothing };
        let followed = match_algorithm(
            &Trace::new([TraceEventKind::Percept(percept)]).unwrap(),
            TraceClaim::Part,
            100,
        );
        let MatchEnd::Departure(departure) = followed.reached else { panic!("{followed:?}") };
        assert_eq!(departure.event.id, 0);
        let contradiction = Contradiction::Start { perceived: percept };
        assert_eq!(departure.allowed[0].purpose, StepPurpose::Contradicted(contradiction));
    }

    #[test]
    fn a_run_that_reaches_the_bound_is_not_matched_further() {
        let trace = explored(&lollipop(), Dart(0));
        // The end of the tail has one dart, and the fork behind it has three.
        for (bound, event) in [(0, 0), (3, 2)] {
            let end = MatchEnd::Bound { event: trace.event(event) };
            assert_eq!(match_algorithm(&trace, TraceClaim::Part, bound).reached, end);
        }
    }

    proptest! {
        #[test]
        fn every_run_is_followed_to_its_map(graph in any_graph(Class::Multigraph, 30)) {
            let trace = explored(&graph, Dart(0));
            let followed = match_algorithm(&trace, TraceClaim::Whole, 100);
            prop_assert_eq!(followed.choices, MatchedChoices::Default);
            prop_assert_eq!(&followed.reached, &MatchEnd::Mapped);
            let map = followed.exploration.map().complete().unwrap();
            prop_assert_eq!(code(map, FACING), code(&graph, Dart(0)));
        }

        #[test]
        fn every_part_of_a_run_is_followed_to_its_end(
            graph in any_graph(Class::Multigraph, 12), part in any::<prop::sample::Index>(),
        ) {
            let trace = explored(&graph, Dart(0));
            let event = part.index(trace.len() - 1);
            let followed = match_algorithm(&trace.up_to(event), TraceClaim::Part, 100);
            prop_assert_eq!(followed.reached, MatchEnd::EndOfTrace);
            // Where no choices are at their end there, the default ones count all the same.
            let followed = match_algorithm(&trace.up_to(event), TraceClaim::Whole, 100);
            let default = followed.choices == MatchedChoices::Default;
            prop_assert_eq!(followed.reached == MatchEnd::EndOfTrace, default);
        }

        #[test]
        fn every_choice_is_followed(
            graph in any_graph(Class::Multigraph, 12),
            numbers in prop::collection::vec(any::<u8>(), 1..40),
        ) {
            let trace = chosen(&graph, &numbers);
            let followed = match_algorithm(&trace, TraceClaim::Whole, 100);
            prop_assert_eq!(&followed.reached, &MatchEnd::Mapped);
            let same = trace == explored(&graph, Dart(0));
            prop_assert_eq!(followed.choices == MatchedChoices::Default, same);
            let map = followed.exploration.map().complete().unwrap();
            prop_assert_eq!(code(map, FACING), code(&graph, Dart(0)));
        }

        #[test]
        fn a_false_door_departs_there_or_is_another_choice(
            graph in any_graph(Class::Multigraph, 12), part in any::<prop::sample::Index>(),
        ) {
            let trace = explored(&graph, Dart(0));
            let moves = part.index(trace.doors().len());
            // The doors up to there, and then one that is not there.
            let mut false_door = trace.up_to(2 * moves + 1);
            false_door.doors[moves] = Door(1000);
            let MatchEnd::Departure(departure) = match_algorithm(&false_door, TraceClaim::Whole, 100).reached else {
                panic!("it is followed")
            };
            prop_assert_eq!(departure.event.id, 2 * moves + 1);
            let taken = trace.doors()[moves];
            prop_assert!(departure.allowed.iter().any(|allowed| allowed.door == Some(taken)));
        }
    }
}
