//! Matches a trace with the folding explorer. It breaks every tie, so it has one run.

use super::{
    Trace, TraceWorld, TraceWorldError,
    match_end::{AllowedStep, MapDart, MatchEnd, RunStop, StepPurpose},
};
use crate::{
    mapping::{DirectionalAlgorithm, FoldingExploration, FoldingStep, InvalidStep, MappingError},
    percept::WalkEvent,
};

/// How far the folding explorer follows a trace, and its state at that point.
pub(super) fn follow(trace: &Trace, bound: usize) -> (MatchEnd, FoldingExploration) {
    let mut exploration = FoldingExploration::new(bound);
    let mut world = TraceWorld::after(trace, 0);
    let mut purpose = StepPurpose::NoOpenDart;
    let run = run(&mut exploration, &mut world, &mut purpose);
    let moves = world.moves();
    let stop = match run {
        Err(error) => RunStop::of(&error, moves, purpose),
        Ok(()) if moves == trace.doors().len() => return (MatchEnd::Mapped, exploration),
        Ok(()) => {
            let allowed = AllowedStep { door: None, purpose: StepPurpose::NoOpenDart };
            RunStop::Departure { event: WalkEvent::Door(moves), allowed }
        }
    };
    (stop.end(DirectionalAlgorithm::Folding, trace), exploration)
}

/// Runs the explorer. `purpose` is that of its last step.
fn run(
    exploration: &mut FoldingExploration,
    world: &mut TraceWorld,
    purpose: &mut StepPurpose,
) -> Result<(), MappingError<TraceWorldError>> {
    exploration.begin(world, &mut ())?;
    while let Some(step) = exploration.next_step() {
        *purpose = purpose_of(exploration, step);
        exploration.make_step(step, world, &mut ())?;
    }
    if exploration.is_complete() { Ok(()) } else { Err(InvalidStep::NoPlan.into()) }
}

fn purpose_of(exploration: &FoldingExploration, step: FoldingStep) -> StepPurpose {
    let named = |dart| MapDart::of(exploration.map(), dart);
    match step {
        FoldingStep::Explore(edge) => StepPurpose::ExploreOpen(named(edge)),
        FoldingStep::Test(test) => {
            StepPurpose::Test { edge: named(test.edge), hypothesis: named(test.hypothesis) }
        }
    }
}
