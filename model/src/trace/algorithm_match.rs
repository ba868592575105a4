//! Matches a trace with an algorithm: are the doors those that it takes, or may take? Section 2.3.

use std::borrow::Cow;

use super::{
    AlgorithmCoverage, Trace, TraceWorld, TraceWorldError,
    choice_search::{Search, TraceClaim},
    default_match::follow,
    match_end::{Departure, MatchEnd},
};
use crate::{
    mapping::{
        Algorithm1Run, Explorer, MapWalk, MappingAlgorithm, MappingChoice, MappingError,
        with_explorer,
    },
    percept::{Percept, WalkEvent},
};

/// How far an algorithm follows a trace.
#[derive(Clone, Debug)]
pub struct AlgorithmMatch {
    /// The algorithm.
    pub algorithm: MappingAlgorithm,
    /// The choices that it takes.
    pub choices: MatchedChoices,
    /// How far it follows the trace.
    pub reached: MatchEnd,
    /// Its map, the robot's pose in the map and its moves at that point.
    pub run: MapWalk,
    /// The cases of Algorithm 1 that it covers.
    pub coverage: AlgorithmCoverage,
}

/// The choices that match a trace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MatchedChoices {
    /// The default ones. The folding explorer has no others.
    Default,
    /// Others that Algorithm 1 allows.
    Other {
        /// The id of the first event that the default choices would not have; `None` if they would go on
        /// after the last one.
        from: Option<usize>,
    },
}

/// Matches a trace with an algorithm; Algorithm 1 with the default choices as long as they match, otherwise
/// with any choices. At most `bound` darts may become known.
#[must_use]
pub fn match_algorithm(
    algorithm: MappingAlgorithm,
    trace: &Trace,
    claim: TraceClaim,
    bound: usize,
) -> AlgorithmMatch {
    if algorithm == MappingAlgorithm::Algorithm1 {
        match_choices(trace, claim, bound, None)
    } else {
        match_default(algorithm, trace, bound, &mut |_| None)
    }
}

/// A percept in place of one that contradicts the map; `None` if it is not replaced.
pub type Amendment<'a> = &'a mut dyn FnMut(&Departure) -> Option<Percept>;

/// Matches a trace with an algorithm. At a contradiction, `amend` may replace the percept; the match then
/// goes on.
pub fn match_amended(
    algorithm: MappingAlgorithm,
    trace: &Trace,
    claim: TraceClaim,
    bound: usize,
    amend: Amendment,
) -> AlgorithmMatch {
    if algorithm == MappingAlgorithm::Algorithm1 {
        match_choices(trace, claim, bound, Some(amend))
    } else {
        match_default(algorithm, trace, bound, amend)
    }
}

/// Matches a trace with the default choices of an algorithm, which are its only ones.
fn match_default(
    algorithm: MappingAlgorithm,
    trace: &Trace,
    bound: usize,
    amend: Amendment,
) -> AlgorithmMatch {
    let mut trace = Cow::Borrowed(trace);
    let mut amended_before = 0;
    let (reached, run) = loop {
        let (reached, moves, run) =
            with_explorer!(algorithm, E => follow::<E>(algorithm, &trace, bound));
        let percept = match &reached {
            MatchEnd::Departure(departure) if moves >= amended_before => amend(departure),
            _ => None,
        };
        let Some(percept) = percept else { break (reached, run) };
        trace.to_mut().percepts[moves] = percept;
        // No percept is replaced twice.
        amended_before = moves + 1;
    };
    let coverage = AlgorithmCoverage::default();
    AlgorithmMatch { algorithm, choices: MatchedChoices::Default, reached, run, coverage }
}

/// The run with the default choices.
#[derive(Clone)]
struct DefaultRun {
    exploration: Algorithm1Run,
    coverage: AlgorithmCoverage,
    moves: usize,
    has_begun: bool,
}

impl DefaultRun {
    /// Goes on until an error or the end, and returns the state before the last step, if it is kept.
    fn go_on(
        &mut self,
        trace: &Trace,
        is_kept: bool,
    ) -> (Result<(), MappingError<TraceWorldError>>, Option<Self>) {
        let mut before = None;
        loop {
            if is_kept {
                before = Some(self.clone());
            }
            let mut world = TraceWorld::after(trace, self.moves);
            let stepped = if self.has_begun {
                match self.exploration.choose() {
                    Ok(None) => return (Ok(()), before),
                    Ok(Some(choice)) => {
                        self.exploration.step(choice, &mut world, &mut self.coverage)
                    }
                    Err(invalid) => Err(invalid.into()),
                }
            } else {
                self.has_begun = true;
                self.exploration.begin(&mut world, &mut self.coverage)
            };
            self.moves = world.moves();
            if stepped.is_err() {
                return (stepped, before);
            }
        }
    }
}

fn match_choices(
    trace: &Trace,
    claim: TraceClaim,
    bound: usize,
    mut amend: Option<Amendment>,
) -> AlgorithmMatch {
    let algorithm = MappingAlgorithm::Algorithm1;
    let mut trace = Cow::Borrowed(trace);
    let mut default = DefaultRun {
        exploration: Algorithm1Run::new(bound),
        coverage: AlgorithmCoverage::default(),
        moves: 0,
        has_begun: false,
    };
    let mut search = Search::new(claim, bound);
    let mut amended_before = WalkEvent::Percept(0);
    let (run, found) = loop {
        let (run, before) = default.go_on(&trace, amend.is_some());
        let reached = match &run {
            Ok(()) if default.moves == trace.doors().len() => Some(MatchEnd::Mapped),
            Err(MappingError::World(TraceWorldError::End)) => Some(MatchEnd::EndOfTrace),
            _ => None,
        };
        let to_the_end = reached == Some(MatchEnd::Mapped);
        let part = reached == Some(MatchEnd::EndOfTrace);
        // Other choices may take the same doors and complete the map.
        let found = if to_the_end || (part && claim == TraceClaim::Part) {
            None
        } else {
            search.run(&trace).filter(|(found, _)| !part || *found == MatchEnd::Mapped)
        };
        if let (Some(reached), None) = (reached, &found) {
            let DefaultRun { exploration, coverage, .. } = default;
            let (choices, run) = (MatchedChoices::Default, exploration.into());
            return AlgorithmMatch { algorithm, choices, reached, run, coverage };
        }
        if let Some(found) = found {
            break (run, found);
        }
        let end = search.end(&trace);
        let amended = match (&end.0, &mut amend) {
            (MatchEnd::Departure(departure), Some(amend))
                if search.can_go_on() && search.farthest() >= amended_before =>
            {
                amend(departure)
            }
            _ => None,
        };
        let (Some(percept), Some(before)) = (amended, before) else { break (run, end) };
        trace.to_mut().percepts[search.farthest().moves()] = percept;
        // No percept is replaced twice.
        amended_before = WalkEvent::Door(search.farthest().moves());
        default = before;
    };
    let (trace, moves) = (&*trace, default.moves);
    // If the default choices match the whole trace, they differ after its end.
    let from = match run {
        Err(MappingError::Contradiction(_) | MappingError::Bound { .. }) => {
            WalkEvent::Percept(moves).index()
        }
        _ => WalkEvent::Door(moves).index(),
    };
    let from = (from < trace.len()).then(|| trace.event(from).id);
    let (reached, script) = found;
    let choices = match &reached {
        MatchEnd::Departure(Departure { event, .. }) | MatchEnd::Bound { event, .. }
            if Some(event.id) == from =>
        {
            MatchedChoices::Default
        }
        _ => MatchedChoices::Other { from },
    };
    let (exploration, coverage) = with_choices(&script, trace, bound);
    let run = exploration.into();
    AlgorithmMatch { algorithm, choices, reached, run, coverage }
}

/// The run of Algorithm 1 along a trace with these choices.
fn with_choices(
    script: &[MappingChoice],
    trace: &Trace,
    bound: usize,
) -> (Algorithm1Run, AlgorithmCoverage) {
    let mut exploration = Algorithm1Run::new(bound);
    let mut coverage = AlgorithmCoverage::default();
    let mut world = TraceWorld::after(trace, 0);
    // The result is known.
    let _ = exploration.begin(&mut world, &mut coverage).and_then(|()| {
        let mut choices = script.iter();
        choices.try_for_each(|&choice| exploration.step(choice, &mut world, &mut coverage))
    });
    (exploration, coverage)
}

#[cfg(test)]
mod tests;
