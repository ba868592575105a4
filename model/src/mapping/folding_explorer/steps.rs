//! The choice of the next step.

use std::cmp::Reverse;

use super::{FoldingRun, FoldingStep, HypothesisTest, Pending};
use crate::embedded_graph::Dart;

/// The most moves of a test that the robot prefers to the nearest open dart of the map. The figures are the best
/// that were tried.
fn worthwhile(moves_to_open: usize) -> usize {
    8 * moves_to_open + 2
}

impl FoldingRun {
    /// What to do next; `None` if no dart is open.
    pub(super) fn next_step(&mut self) -> Option<FoldingStep> {
        if self.trail.open_count() == 0 {
            return None;
        }
        if self.pending.is_empty()
            && let Some(edge) = self.open_here()
        {
            return Some(FoldingStep::Explore(edge));
        }
        self.from_robot.find(&self.trail);
        let open = self.nearest_open();
        let near = self.pending.iter().copied();
        let pending = near.min_by_key(|pending| self.from_robot.moves_to(&self.trail, pending.far));
        self.step_for(open, pending)
    }

    /// All steps that [`next_step`](Self::next_step) may return if ties are broken in another way.
    pub(super) fn open_steps(&mut self) -> Vec<FoldingStep> {
        let Some(first) = self.next_step() else { return Vec::new() };
        self.from_robot.find(&self.trail);
        let mut steps = vec![first];
        let near = |at: &Self, dart: Dart| at.from_robot.moves_to(&at.trail, dart);
        let nearest = self.nearest_open().map(|(moves, _)| moves);
        let edges: Vec<Option<(usize, Dart)>> = match nearest {
            None => vec![None],
            Some(moves) => {
                let tied = |&&edge: &&Dart| near(self, self.in_trail[edge.at()]) == moves;
                self.open.iter().filter(tied).map(|&edge| Some((moves, edge))).collect()
            }
        };
        let least = self.pending.iter().map(|pending| near(self, pending.far)).min();
        let tied = |pending: &&Pending| Some(near(self, pending.far)) == least;
        let mut places: Vec<_> = self.pending.iter().filter(tied).copied().map(Some).collect();
        if places.is_empty() {
            places.push(None);
        }
        for place in places {
            for &edge in &edges {
                match self.step_for(edge, place) {
                    Some(FoldingStep::Test(test)) => {
                        steps.push(FoldingStep::Test(test));
                        let same = |tied: &&Reverse<HypothesisTest>| tied.0.cost == test.cost;
                        let mut tied: Vec<_> = self.tests.iter().filter(same).copied().collect();
                        tied.sort_unstable_by_key(|&Reverse(test)| test);
                        for Reverse(test) in tied {
                            if place.is_some_and(|place| self.confirms(place, &test)) {
                                steps.push(FoldingStep::Test(test));
                            }
                        }
                    }
                    step => steps.extend(step),
                }
            }
        }
        let mut once = Vec::new();
        for step in steps {
            if !once.contains(&step) {
                once.push(step);
            }
        }
        once
    }

    /// The first open dart of the map at the robot's vertex.
    fn open_here(&self) -> Option<Dart> {
        let robot = Dart(self.trail.number(self.trail.pose())?);
        let is_open = |&edge: &Dart| self.trail.opposite(self.in_trail[edge.at()]).is_none();
        self.map().darts_of(self.map().vertex(robot)).find(is_open)
    }

    /// The nearest open dart of the map, and the moves to it.
    fn nearest_open(&self) -> Option<(usize, Dart)> {
        let moves_to =
            |&edge: &Dart| self.from_robot.moves_to(&self.trail, self.in_trail[edge.at()]);
        let open = self.open.iter().map(|edge| (moves_to(edge), *edge));
        open.min_by_key(|&(moves, _)| moves)
    }

    /// Explores an open dart or tests a hypothesis about a pending place. Afterwards `tests` holds the
    /// tests from which that was chosen.
    fn step_for(
        &mut self,
        open: Option<(usize, Dart)>,
        pending: Option<Pending>,
    ) -> Option<FoldingStep> {
        let explore = open.map(|(_, edge)| FoldingStep::Explore(edge));
        let Some(pending) = pending else { return explore };
        self.find_ways_to_marker();
        self.tests.clear();
        let late = self.is_late();
        let strict = if late { self.strict_test(pending) } else { None };
        let most = open.filter(|_| !late).map_or(usize::MAX, |(moves, _)| worthwhile(moves));
        let test = strict.or_else(|| self.cheapest_test(pending, most));
        test.map(FoldingStep::Test).or(explore)
    }

    /// Whether the robot only makes strict tests.
    fn is_late(&self) -> bool {
        self.strict || self.trail.moves() > self.patience()
    }

    /// The number of moves after which the robot only makes strict tests, `4 n m + 200` for a map with `n`
    /// vertices and `m` edges. A strict test takes at most as many moves as a validation of Algorithm 1.
    fn patience(&self) -> usize {
        2 * self.map().vertex_count() * self.map().dart_count() + 200
    }
}
