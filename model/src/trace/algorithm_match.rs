//! Matches a trace with an algorithm: are the doors those that it takes, or may take? Section 2.3.

use std::borrow::Cow;

use super::{
    AlgorithmCoverage, Trace, TraceWorld, TraceWorldError,
    choice_search::{Search, TraceClaim},
    folding_match::follow,
    match_end::{Departure, MatchEnd},
};
use crate::{
    mapping::{
        DirectionalAlgorithm, Exploration, MappingChoice, MappingError, MappingRun, Nearest, step,
    },
    percept::{Percept, WalkEvent},
};

/// How far an algorithm follows a trace.
#[derive(Clone, Debug)]
pub struct AlgorithmMatch {
    /// The algorithm.
    pub algorithm: DirectionalAlgorithm,
    /// The choices that it takes.
    pub choices: MatchedChoices,
    /// How far it follows the trace.
    pub reached: MatchEnd,
    /// Its state at that point.
    pub run: MappingRun,
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
    algorithm: DirectionalAlgorithm,
    trace: &Trace,
    claim: TraceClaim,
    bound: usize,
) -> AlgorithmMatch {
    match algorithm {
        DirectionalAlgorithm::Algorithm1 => match_choices(trace, claim, bound, None),
        DirectionalAlgorithm::Folding => match_folding(trace, bound, &mut |_| None),
    }
}

/// A percept in place of one that contradicts the map; `None` if it is not replaced.
pub type Amendment<'a> = &'a mut dyn FnMut(&Departure) -> Option<Percept>;

/// Matches a trace with an algorithm. At a contradiction, `amend` may replace the percept; the match then
/// goes on.
pub fn match_amended(
    algorithm: DirectionalAlgorithm,
    trace: &Trace,
    claim: TraceClaim,
    bound: usize,
    amend: Amendment,
) -> AlgorithmMatch {
    match algorithm {
        DirectionalAlgorithm::Algorithm1 => match_choices(trace, claim, bound, Some(amend)),
        DirectionalAlgorithm::Folding => match_folding(trace, bound, amend),
    }
}

/// Matches a trace with the folding explorer.
fn match_folding(trace: &Trace, bound: usize, amend: Amendment) -> AlgorithmMatch {
    let mut trace = Cow::Borrowed(trace);
    let mut amended_before = 0;
    let (reached, exploration) = loop {
        let (reached, exploration) = follow(&trace, bound);
        let moves = exploration.trail().moves();
        let percept = match &reached {
            MatchEnd::Departure(departure) if moves >= amended_before => amend(departure),
            _ => None,
        };
        let Some(percept) = percept else { break (reached, exploration) };
        trace.to_mut().percepts[moves] = percept;
        // No percept is replaced twice.
        amended_before = moves + 1;
    };
    AlgorithmMatch {
        algorithm: DirectionalAlgorithm::Folding,
        choices: MatchedChoices::Default,
        reached,
        run: MappingRun::Folding(Box::new(exploration)),
        coverage: AlgorithmCoverage::default(),
    }
}

/// The run with the default choices.
#[derive(Clone)]
struct DefaultRun {
    exploration: Exploration,
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
                let Some(choice) = self.exploration.choose(&mut Nearest) else {
                    return (Ok(()), before);
                };
                step(&mut self.exploration, choice, &mut world, &mut self.coverage)
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
    let algorithm = DirectionalAlgorithm::Algorithm1;
    let mut trace = Cow::Borrowed(trace);
    let mut default = DefaultRun {
        exploration: Exploration::new(bound),
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
            let (choices, run) =
                (MatchedChoices::Default, MappingRun::Algorithm1(Box::new(exploration)));
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
    let run = MappingRun::Algorithm1(Box::new(exploration));
    AlgorithmMatch { algorithm, choices, reached, run, coverage }
}

/// The run of Algorithm 1 along a trace with these choices.
fn with_choices(
    script: &[MappingChoice],
    trace: &Trace,
    bound: usize,
) -> (Exploration, AlgorithmCoverage) {
    let mut exploration = Exploration::new(bound);
    let mut coverage = AlgorithmCoverage::default();
    let mut world = TraceWorld::after(trace, 0);
    // The result is known.
    let _ = exploration.begin(&mut world, &mut coverage).and_then(|()| {
        let mut choices = script.iter();
        choices.try_for_each(|&choice| step(&mut exploration, choice, &mut world, &mut coverage))
    });
    (exploration, coverage)
}

#[cfg(test)]
mod tests;
