//! Matches a trace with an algorithm: does the algorithm take, or may it take, the doors of the trace? Section 2.3.

use std::borrow::Cow;

use super::{
    AlgorithmCoverage, Trace, TracePosition, TraceWorld, TraceWorldError,
    choice_search::{Search, TraceClaim},
    match_end::{Departure, MatchEnd, RunStop},
};
use crate::{
    mapping::{
        Algorithm1Run, Explorer, MapWalk, MappingAlgorithm, MappingChoice, MappingError, Observed,
        StepPurpose, audit::audit_times, explore_with, with_explorer,
    },
    percept::{Percept, WalkEvent},
};

/// How far an algorithm follows a trace.
#[derive(Clone, Debug)]
pub struct AlgorithmMatch {
    pub algorithm: MappingAlgorithm,
    pub choices: MatchedChoices,
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
pub fn match_algorithm(
    algorithm: MappingAlgorithm,
    trace: &Trace,
    claim: TraceClaim,
    bound: usize,
) -> AlgorithmMatch {
    match_amended(algorithm, trace, claim, bound, None)
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
    amend: Option<Amendment>,
) -> AlgorithmMatch {
    if algorithm == MappingAlgorithm::Algorithm1 {
        return match_choices(trace, claim, bound, amend);
    }
    with_explorer!(algorithm, new => match_default(new, algorithm, trace, bound, amend))
}

/// Matches a trace with an algorithm with the default choices, and then with audits of its map. If the map is
/// not complete before the end of the trace, it is a match with the algorithm. At most `bound` darts may
/// become known.
pub fn match_audited(
    algorithm: MappingAlgorithm,
    audits: u32,
    trace: &Trace,
    claim: TraceClaim,
    bound: usize,
) -> AlgorithmMatch {
    let mut world = TraceWorld::after(trace, 0);
    let mut coverage = AlgorithmCoverage::default();
    let (run, mapped) = algorithm.map_world(&mut world, bound, &mut coverage);
    if mapped.is_err() {
        return match_algorithm(algorithm, trace, claim, bound);
    }
    let audited = audit_times(audits, &mut world, &run, |_, _| {});
    let stop = match audited {
        Ok(_) => RunStop::after_end(world.position(), StepPurpose::Audited, trace),
        Err(error) => Some(RunStop::new(&error, world.position(), StepPurpose::Audit)),
    };
    let reached = MatchEnd::of_only_run(stop, algorithm, trace);
    AlgorithmMatch { algorithm, choices: MatchedChoices::Default, reached, run, coverage }
}

/// The run of an explorer with the default choices.
#[derive(Clone)]
struct DefaultRun<E> {
    explorer: E,
    coverage: AlgorithmCoverage,
    position: TracePosition,
    has_begun: bool,
    /// That of the last step.
    purpose: StepPurpose,
}

impl<E: Explorer> DefaultRun<E> {
    fn new(mut explorer: E, bound: usize) -> Self {
        explorer.limit_darts(bound);
        let (coverage, purpose) = (AlgorithmCoverage::default(), StepPurpose::Begin);
        Self { explorer, coverage, position: TracePosition::default(), has_begun: false, purpose }
    }

    /// Goes on until an error or the end, and returns the state before the last step, if it is kept.
    fn match_trace(
        &mut self,
        trace: &Trace,
        is_kept: bool,
    ) -> (Result<(), MappingError<TraceWorldError>>, Option<Self>) {
        let mut before = None;
        loop {
            if is_kept {
                before = Some(self.clone());
            }
            let mut world = TraceWorld::at(trace, self.position);
            let observed = &mut Observed::new(&mut world, &mut self.coverage);
            let stepped = if self.has_begun {
                match self.explorer.choose() {
                    Ok(None) => return (Ok(()), before),
                    Ok(Some(choice)) => {
                        self.purpose = self.explorer.purpose(Some(choice));
                        self.explorer.step(choice, observed)
                    }
                    Err(invalid) => Err(invalid.into()),
                }
            } else {
                self.has_begun = true;
                self.explorer.begin(observed)
            };
            self.position = world.position();
            if stepped.is_err() {
                return (stepped, before);
            }
        }
    }
}

/// Matches a trace with the default choices of an algorithm, which are its only ones.
fn match_default<E: Explorer + Into<MapWalk>>(
    new: impl Fn() -> E,
    algorithm: MappingAlgorithm,
    trace: &Trace,
    bound: usize,
    mut amend: Option<Amendment>,
) -> AlgorithmMatch {
    let mut trace = Cow::Borrowed(trace);
    let mut run = DefaultRun::new(new(), bound);
    let mut amended_before = 0;
    let reached = loop {
        let (ended, before) = run.match_trace(&trace, amend.is_some());
        let stop = match ended {
            Ok(()) => RunStop::after_end(run.position, run.explorer.purpose(None), &trace),
            Err(error) => Some(RunStop::new(&error, run.position, run.purpose)),
        };
        let reached = MatchEnd::of_only_run(stop, algorithm, &trace);
        let amended = match (&reached, &mut amend) {
            (MatchEnd::Departure(departure), Some(amend))
                if run.position.moves >= amended_before =>
            {
                amend(departure)
            }
            _ => None,
        };
        let (Some(percept), Some(before)) = (amended, before) else { break reached };
        trace.to_mut().percepts[run.position.moves] = percept;
        // No percept is replaced twice.
        amended_before = run.position.moves + 1;
        run = before;
    };
    let (choices, coverage) = (MatchedChoices::Default, AlgorithmCoverage::default());
    AlgorithmMatch { algorithm, choices, reached, run: run.explorer.into(), coverage }
}

fn match_choices(
    trace: &Trace,
    claim: TraceClaim,
    bound: usize,
    mut amend: Option<Amendment>,
) -> AlgorithmMatch {
    let algorithm = MappingAlgorithm::Algorithm1;
    let mut trace = Cow::Borrowed(trace);
    let mut default = DefaultRun::new(Algorithm1Run::default(), bound);
    let mut search = Search::new(claim, bound);
    let mut amended_before = WalkEvent::Percept(0);
    let (run, found) = loop {
        let (run, before) = default.match_trace(&trace, amend.is_some());
        let reached = match &run {
            Ok(()) if default.position.moves == trace.doors().len() => Some(MatchEnd::Mapped),
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
            let DefaultRun { explorer, coverage, .. } = default;
            let (choices, run) = (MatchedChoices::Default, explorer.into());
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
    let (trace, moves) = (&*trace, default.position.moves);
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
    let mut choices = script.iter().copied();
    let mut world = TraceWorld::after(trace, 0);
    let world = &mut Observed::new(&mut world, &mut coverage);
    // The result is known.
    let _ = explore_with(&mut exploration, world, |_| Ok(choices.next()));
    (exploration, coverage)
}

#[cfg(test)]
mod tests;
