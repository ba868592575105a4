//! Matches a trace with an algorithm that audits its map.

use super::{
    AlgorithmCoverage, AlgorithmMatch, MatchEnd, MatchedChoices, Trace, TraceClaim, TraceWorld,
    match_algorithm,
    match_end::{AllowedStep, RunStop},
};
use crate::{
    mapping::{FACING, MappingAlgorithm, MappingError, StepPurpose, audit},
    percept::WalkEvent,
};

/// Matches a trace with an algorithm with the default choices, and then with audits of its map. If the map is
/// not complete before the end of the trace, it is a match with the algorithm. At most `bound` darts may
/// become known.
#[must_use]
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
    let (Ok(()), Some(map)) = (mapped, run.map().complete()) else {
        return match_algorithm(algorithm, trace, claim, bound);
    };
    let mut pose = run.robot();
    let mut audited = Ok(());
    for _ in 0..audits {
        match audit(&mut world, map, FACING, pose, |_, _| {}) {
            Ok(audit) => pose = audit.pose,
            Err(error) => {
                audited = Err(MappingError::from(error));
                break;
            }
        }
    }
    let moves = world.moves();
    let reached = match audited {
        Err(error) => RunStop::new(&error, moves, StepPurpose::Audit).end(algorithm, trace),
        Ok(()) if moves == trace.doors().len() => MatchEnd::Mapped,
        Ok(()) => {
            let allowed = AllowedStep { door: None, purpose: StepPurpose::Audited };
            RunStop::Departure { event: WalkEvent::Door(moves), allowed }.end(algorithm, trace)
        }
    };
    AlgorithmMatch { algorithm, choices: MatchedChoices::Default, reached, run, coverage }
}
