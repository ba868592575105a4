//! Matches a trace with the only run of an explorer: that with its default choices.

use super::{
    Trace, TraceWorld, TraceWorldError,
    match_end::{AllowedStep, MatchEnd, RunStop},
};
use crate::{
    mapping::{Explorer, MapWalk, MappingAlgorithm, MappingError, StepPurpose},
    percept::WalkEvent,
};

/// How far an explorer follows a trace, after how many moves it ends, and its journey until then.
pub(super) fn follow<E: Explorer + Default + Into<MapWalk>>(
    algorithm: MappingAlgorithm,
    trace: &Trace,
    bound: usize,
) -> (MatchEnd, usize, MapWalk) {
    let mut explorer = E::default();
    explorer.limit_darts(bound);
    let mut world = TraceWorld::after(trace, 0);
    let mut purpose = explorer.purpose(None);
    let run = run(&mut explorer, &mut world, &mut purpose);
    let moves = world.moves();
    let reached = match run {
        Ok(()) if moves == trace.doors().len() => MatchEnd::Mapped,
        Ok(()) => {
            let allowed = AllowedStep { door: None, purpose: explorer.purpose(None) };
            RunStop::Departure { event: WalkEvent::Door(moves), allowed }.end(algorithm, trace)
        }
        Err(error) => RunStop::new(&error, moves, purpose).end(algorithm, trace),
    };
    (reached, moves, explorer.into())
}

/// Runs the explorer. `purpose` is that of its last step.
fn run(
    explorer: &mut impl Explorer,
    world: &mut TraceWorld,
    purpose: &mut StepPurpose,
) -> Result<(), MappingError<TraceWorldError>> {
    explorer.begin(world, &mut ())?;
    while let Some(choice) = explorer.choose()? {
        *purpose = explorer.purpose(Some(choice));
        explorer.step(choice, world, &mut ())?;
    }
    Ok(())
}
