//! The runs of Algorithm 1 with any choices that match a trace. Section 2.3.

use std::{collections::HashSet, mem};

use super::{
    Trace, TracePosition, TraceWorld,
    match_end::{AllowedStep, Departure, MatchEnd, RunStop},
};
use crate::{
    embedded_graph::Dart,
    mapping::{Algorithm1Run, Explorer, MappingAlgorithm, MappingChoice, PartialMap, StepPurpose},
    percept::WalkEvent,
};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TraceClaim {
    /// A complete run: choices that end with the trace are preferred.
    Whole,
    /// Possibly a part of a run.
    Part,
}

/// A run that matches the trace so far.
#[derive(Clone)]
struct Way {
    exploration: Algorithm1Run,
    moves: usize,
    script: Vec<MappingChoice>,
}

/// What distinguishes runs: the moves, the line, the map, the robot in it, and H.
type Known = (usize, bool, PartialMap, Dart, Vec<Dart>);

/// All choices, depth first.
pub(super) struct Search {
    claim: TraceClaim,
    /// The choices of the first run that matches the trace without completing the map.
    part: Option<Vec<MappingChoice>>,
    seen: HashSet<Known>,
    /// The first event that none of the longest runs has,
    farthest: WalkEvent,
    /// what they have instead,
    allowed: Vec<AllowedStep>,
    /// and the choices of the first of them.
    script: Vec<MappingChoice>,
    /// Of the longest run that reached the bound on known darts: the event, and the choices.
    bound: Option<(WalkEvent, Vec<MappingChoice>)>,
    /// The runs that a percept contradicts at that event, before the step to it.
    stuck: Vec<Way>,
    /// The largest number of darts that may become known.
    dart_bound: usize,
}

impl Search {
    pub(super) fn new(claim: TraceClaim, dart_bound: usize) -> Self {
        Self {
            claim,
            part: None,
            seen: HashSet::new(),
            farthest: WalkEvent::Percept(0),
            allowed: Vec::new(),
            script: Vec::new(),
            bound: None,
            stuck: Vec::new(),
            dart_bound,
        }
    }

    /// The first event that none of the longest runs has.
    pub(super) fn farthest(&self) -> WalkEvent {
        self.farthest
    }

    /// Whether the longest runs can be continued with another percept.
    pub(super) fn can_go_on(&self) -> bool {
        !self.stuck.is_empty()
    }

    /// A run that matches the whole trace. After a search without one the percept that contradicts the
    /// longest runs may be replaced; then they are continued.
    pub(super) fn run(&mut self, trace: &Trace) -> Option<(MatchEnd, Vec<MappingChoice>)> {
        let stuck = mem::take(&mut self.stuck);
        if !stuck.is_empty() {
            self.allowed.clear();
            let next = stuck.iter().flat_map(|way| self.next(trace, way));
            let mut ways: Vec<_> = next.collect();
            ways.reverse();
            return self.search(trace, ways);
        }
        let mut exploration = Algorithm1Run::new(self.dart_bound);
        let begun = exploration.begin(&mut TraceWorld::after(trace, 0));
        let way = Way { exploration, moves: 0, script: Vec::new() };
        if let Err(error) = begun {
            self.ended(
                RunStop::new(&error, TracePosition::default(), StepPurpose::Done),
                way.script,
            );
            return None;
        }
        self.search(trace, vec![way])
    }

    /// Continues these runs, the last one first.
    fn search(
        &mut self,
        trace: &Trace,
        mut ways: Vec<Way>,
    ) -> Option<(MatchEnd, Vec<MappingChoice>)> {
        while let Some(way) = ways.pop() {
            let known = (
                way.moves,
                way.exploration.is_at_line_8(),
                way.exploration.map().clone(),
                way.exploration.robot(),
                way.exploration.hypotheses().to_vec(),
            );
            if !self.seen.insert(known) {
                continue;
            }
            if way.exploration.map().unexplored_is_empty() {
                if way.moves == trace.doors().len() {
                    return Some((MatchEnd::Mapped, way.script));
                }
                let allowed = AllowedStep { action: None, purpose: StepPurpose::Done };
                let event = WalkEvent::Door(way.moves);
                self.ended(RunStop::Departure { event, allowed }, way.script.clone());
            }
            // The first choice is tried first.
            ways.extend(self.next(trace, &way).into_iter().rev());
            if self.claim == TraceClaim::Part && self.part.is_some() {
                break;
            }
        }
        self.part.take().map(|part| (MatchEnd::EndOfTrace, part))
    }

    /// Every choice that matches the trace.
    fn next(&mut self, trace: &Trace, before: &Way) -> Vec<Way> {
        let mut choices = Vec::new();
        before.exploration.add_open_choices(&mut choices);
        let tries_hypotheses = before.exploration.is_at_line_8();
        if tries_hypotheses {
            // The default is the last.
            choices.reverse();
        }
        let mut next = Vec::new();
        let mut rejected = false;
        for choice in choices {
            let purpose = before.exploration.purpose(Some(choice));
            let mut way = before.clone();
            way.script.push(choice);
            let mut world = TraceWorld::after(trace, way.moves);
            let stepped = way.exploration.step(choice, &mut world);
            way.moves = world.moves();
            if let Err(error) = stepped {
                let stop = RunStop::new(&error, world.position(), purpose);
                self.ended(stop, way.script);
                if let RunStop::Departure { event, allowed } = stop
                    && let (StepPurpose::Contradicted(_), true) =
                        (allowed.purpose, event == self.farthest)
                {
                    self.stuck.push(before.clone());
                }
                continue;
            }
            // Rejected hypotheses are rejected after the same moves: the way back begins with door 0,
            // which no shortest path takes. So one of them is enough: another one is rejected after the
            // same moves again.
            let falls = tries_hypotheses && way.exploration.is_at_line_8();
            if !falls || !mem::replace(&mut rejected, true) {
                next.push(way);
            }
        }
        next
    }

    /// A run ended before its map was complete, or before the trace.
    fn ended(&mut self, stop: RunStop, script: Vec<MappingChoice>) {
        match stop {
            RunStop::EndOfTrace => {
                self.part.get_or_insert(script);
            }
            RunStop::Bound { event, .. } => {
                if self.bound.as_ref().is_none_or(|(farthest, _)| event > *farthest) {
                    self.bound = Some((event, script));
                }
            }
            // Algorithm 1 does nothing with its marker: it takes a door.
            RunStop::AtAction { position, allowed }
            | RunStop::AfterAction { position, allowed } => {
                let event = WalkEvent::Door(position.moves);
                self.ended(RunStop::Departure { event, allowed }, script);
            }
            RunStop::Departure { event, allowed } => {
                if self.allowed.is_empty() || event > self.farthest {
                    self.farthest = event;
                    self.allowed.clear();
                    self.stuck.clear();
                    self.script = script;
                }
                if event == self.farthest && !self.allowed.contains(&allowed) {
                    self.allowed.push(allowed);
                }
            }
        }
    }

    /// The bound, if a run reached it: that run may be longer than all others. Otherwise the departure of
    /// the longest runs.
    pub(super) fn end(&self, trace: &Trace) -> (MatchEnd, Vec<MappingChoice>) {
        if let Some((event, script)) = &self.bound {
            let (event, bound) = (trace.event(event.index()), self.dart_bound);
            return (MatchEnd::Bound { event, bound }, script.clone());
        }
        let departure = Departure {
            algorithm: MappingAlgorithm::Algorithm1,
            event: trace.event(self.farthest.index()),
            allowed: self.allowed.clone(),
        };
        (MatchEnd::Departure(departure), self.script.clone())
    }
}
