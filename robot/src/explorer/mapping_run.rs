//! A whole run of a robot: the mapping algorithm, its events, and the way back to the marker.

use toposlam_logs::record::{EventKind, RunEnd, RunEnding, RunObserver};
use toposlam_model::mapping::{MapWalk, MappedWorld, MappingError, MappingEvent, Relocate};

use super::ExplorerError;
use crate::{
    budget::{Allowance, BudgetLimit},
    event_log::EventLog,
    robot::Robot,
    run_settings::RunSettings,
};

/// What a whole run needs of an explorer.
pub(crate) struct RunParts<'r, R, O> {
    pub(crate) robot: &'r R,
    pub(crate) log: &'r mut EventLog<O>,
    pub(crate) allowance: &'r mut Allowance,
    /// The number of doors taken, and of moves that ended at a junction or before an obstacle.
    pub(crate) last_move: u64,
    pub(crate) moves: u64,
}

/// A robot that maps a building within a budget.
pub(crate) trait MappingRobot: Relocate<Error = ExplorerError> + Sized {
    type Robot: Robot;
    type Observer: RunObserver;

    fn parts(&mut self) -> RunParts<'_, Self::Robot, Self::Observer>;

    /// Reports an event that happens now.
    fn emit(&mut self, kind: EventKind) {
        let RunParts { robot, log, .. } = self.parts();
        log.emit(robot, kind);
    }

    /// Maps the building. Returns the state of the algorithm, too.
    ///
    /// # Errors
    /// Returns an error if the run ended before the map was complete.
    fn map_building(
        &mut self,
        settings: &RunSettings,
    ) -> (MapWalk, Result<MappedWorld, MappingError<ExplorerError>>) {
        let RunSettings { method, dart_bound, budget, ref earlier, .. } = *settings;
        *self.parts().allowance = Allowance::new(budget);
        let mut observer = |robot: &mut Self, journey: &MapWalk, event: MappingEvent| {
            let RunParts { robot, log, .. } = robot.parts();
            log.mapping(robot, journey, event);
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
        let moves = self.parts().moves;
        self.emit(EventKind::End(RunEnd { moves, ending }));
        (run, mapped)
    }

    /// Returns to the marker, and returns the reason.
    fn return_to_marker(&mut self, limit: BudgetLimit) -> ExplorerError {
        self.parts().allowance.begin_return();
        while let Some(door) = self.parts().allowance.door_back() {
            match self.traverse(door) {
                Ok(()) => {}
                Err(error @ (ExplorerError::Stopped { .. } | ExplorerError::Robot(_))) => {
                    return error;
                }
                Err(_) => break,
            }
        }
        let RunParts { allowance, last_move: moves, .. } = self.parts();
        let is_at_marker = allowance.is_at_marker();
        ExplorerError::Budget { moves, limit, is_at_marker }
    }
}
