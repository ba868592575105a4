//! The search through all answers of a world that is decided while the robot explores it.

use std::{mem, ops::ControlFlow};

use super::{
    LazyWorld,
    world::{PrefixSource, RobotState},
};
use crate::{
    aid::Aid,
    enumerate::{Answer, Draft, Watch},
    mapping::{Explorer, Flaw},
};

/// The number of runs after which the watch is asked whether to stop.
const RUNS_TO_A_QUESTION: u64 = 64;

pub(super) enum LazyRunEnd {
    Done,
    Failed(Flaw),
    /// The run was cut after a step: enough edges are decided.
    Cut,
}

/// The explorer and its robot after the approach of a step.
struct Saved<E: Explorer> {
    explorer: E,
    choice: Option<E::Choice>,
    robot: RobotState<<E::Aid as Aid>::Placed>,
}

/// A depth-first search through the runs of an explorer.
pub(super) struct RunSearch<'w, E: Explorer> {
    pub(super) world: LazyWorld<E::Aid>,
    pub(super) explorer: E,
    choice: Option<E::Choice>,
    /// The state before each step in which something was decided. Memory is kept.
    saved: Vec<Saved<E>>,
    /// The number of undecided edges at which a run is cut, after a step.
    cut_at: Option<usize>,
    watch: &'w dyn Watch,
}

impl<'w, E: Explorer> RunSearch<'w, E> {
    pub(super) fn new(
        mut explorer: E,
        draft: Draft,
        prefix: PrefixSource,
        cut_at: Option<usize>,
        watch: &'w dyn Watch,
    ) -> Self {
        let edges = draft.edges_left();
        let bounds = (1..=edges + 1).map(|vertices| explorer.move_bound(edges, vertices));
        let bound = bounds.max().unwrap_or(0);
        let world = LazyWorld::new(draft, explorer.aid(), bound, prefix);
        explorer.limit_darts(2 * edges);
        Self { world, explorer, choice: None, saved: Vec::new(), cut_at, watch }
    }

    /// Visits the end of each run, in a fixed order.
    pub(super) fn for_each_end(
        &mut self,
        visit: &mut impl FnMut(&LazyWorld<E::Aid>, &E, LazyRunEnd) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        self.save(0);
        for run in 1_u64.. {
            if let Some(end) = self.run() {
                visit(&self.world, &self.explorer, end)?;
            }
            let Some(step) = self.world.go_back() else { break };
            if run % RUNS_TO_A_QUESTION == 0 && self.watch.stop() {
                return ControlFlow::Break(());
            }
            self.restore(step);
        }
        ControlFlow::Continue(())
    }

    fn save(&mut self, step: usize) {
        let Self { world, explorer, saved, .. } = self;
        let choice = self.choice;
        match saved.get_mut(step) {
            Some(saved) => {
                saved.explorer.clone_from(explorer);
                saved.robot.clone_from(world.robot());
                saved.choice = choice;
            }
            None => saved.push(Saved {
                explorer: explorer.clone(),
                choice,
                robot: world.robot().clone(),
            }),
        }
        world.step = step;
    }

    fn restore(&mut self, step: usize) {
        let Self { world, explorer, saved, .. } = self;
        let saved = &mut saved[step];
        if world.may_go_back_to(step) {
            explorer.clone_from(&saved.explorer);
        } else {
            mem::swap(explorer, &mut saved.explorer);
        }
        self.choice = saved.choice;
        world.set_robot(&saved.robot);
        world.step = step;
    }

    /// Runs from the present state to an end, which is `None` where no answer was left.
    fn run(&mut self) -> Option<LazyRunEnd> {
        loop {
            let goes_on = self.make_step();
            if self.world.dead_end {
                return None;
            }
            match goes_on {
                Err(flaw) => return Some(LazyRunEnd::Failed(flaw)),
                Ok(false) => return Some(LazyRunEnd::Done),
                Ok(true) => {}
            }
            if self.cut_at.is_some_and(|left| self.world.draft.edges_left() <= left) {
                return Some(LazyRunEnd::Cut);
            }
            // What is decided now was decided in an earlier step.
            if self.world.may_branch() {
                let step = self.world.decisions.last().map_or(0, |decision| decision.step + 1);
                self.save(step);
            }
        }
    }

    /// Begins the run, or makes its next step; and then the approach of the step after it. Returns whether there is
    /// one: otherwise the map is there.
    fn make_step(&mut self) -> Result<bool, Flaw> {
        let Self { world, explorer, choice, .. } = self;
        if !world.robot().has_begun() {
            world.open_start()?;
            explorer.begin(world)?;
        } else if let Some(choice) = *choice {
            explorer.step(choice, world)?;
        }
        *choice = explorer.choose()?;
        let Some(choice) = *choice else { return Ok(false) };
        explorer.approach(choice, world)?;
        Ok(true)
    }
}

/// The prefixes of all runs, up to the step after which at most `cut_at` edges are undecided.
pub(super) fn prefixes<E: Explorer>(
    explorer: E,
    draft: Draft,
    cut_at: usize,
    watch: &dyn Watch,
) -> Vec<Vec<Answer>> {
    let mut found = Vec::new();
    let mut search = RunSearch::new(explorer, draft, PrefixSource::Open, Some(cut_at), watch);
    let _ = search.for_each_end(&mut |world, _, _| {
        found.push(world.answers());
        ControlFlow::Continue(())
    });
    found
}
