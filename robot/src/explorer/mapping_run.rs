//! A whole run of a robot: the mapping algorithm, its events, and the way back to the marker.

use toposlam_logs::record::{EventKind, RunEnd, RunEnding};
use toposlam_model::mapping::{MapWalk, MappedWorld, MappingError, MappingEvent, Relocate};

use super::ExplorerError;
use crate::{
    budget::{Allowance, BudgetLimit},
    run_settings::RunSettings,
};

/// A robot that maps a building within a budget.
pub(crate) trait MappingRobot: Relocate<Error = ExplorerError> + Sized {
    fn allowance(&mut self) -> &mut Allowance;

    /// The number of doors taken, and of moves that ended at a junction or before an obstacle.
    fn moves_made(&self) -> [u64; 2];

    /// Reports a step of the algorithm.
    fn report(&mut self, journey: &MapWalk, event: MappingEvent);

    fn emit(&mut self, kind: EventKind);

    /// Maps the building. Returns the state of the algorithm, too.
    ///
    /// # Errors
    /// Returns an error if the run ended before the map was complete.
    fn map_building(
        &mut self,
        settings: &RunSettings,
    ) -> (MapWalk, Result<MappedWorld, MappingError<ExplorerError>>) {
        let RunSettings { method, dart_bound, budget, ref earlier, .. } = *settings;
        *self.allowance() = Allowance::new(budget);
        let mut observer = |robot: &mut Self, journey: &MapWalk, event: MappingEvent| {
            robot.report(journey, event);
        };
        let (run, mut mapped) = method.map_world(self, dart_bound, earlier, &mut observer);
        if let Err(MappingError::World(ExplorerError::Budget { limit, .. })) = mapped {
            mapped = Err(MappingError::World(self.return_to_marker(limit)));
        }
        let ending = match &mapped {
            Ok(_) => RunEnding::Mapped,
            Err(MappingError::World(ExplorerError::Stopped { .. })) => RunEnding::Stopped,
            Err(error @ MappingError::World(ExplorerError::Budget { .. })) => {
                RunEnding::OutOfBudget(error.to_string())
            }
            Err(error) => RunEnding::GaveUp(error.to_string()),
        };
        let [_, moves] = self.moves_made();
        self.emit(EventKind::End(RunEnd { moves, ending }));
        (run, mapped)
    }

    /// Returns to the marker, and returns the reason.
    fn return_to_marker(&mut self, limit: BudgetLimit) -> ExplorerError {
        self.allowance().begin_return();
        while let Some(door) = self.allowance().door_back() {
            match self.traverse(door) {
                Ok(()) => {}
                Err(error @ (ExplorerError::Stopped { .. } | ExplorerError::Robot(_))) => {
                    return error;
                }
                Err(_) => break,
            }
        }
        let ([moves, _], is_at_marker) = (self.moves_made(), self.allowance().is_at_marker());
        ExplorerError::Budget { moves, limit, is_at_marker }
    }
}
