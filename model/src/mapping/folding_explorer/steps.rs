//! The choice of the next step, and the tests of hypotheses: walks whose success confirms one.

use std::{cmp::Reverse, collections::BinaryHeap, iter, mem};

use super::{FoldingRun, FoldingStep, HypothesisTest, Pending};
use crate::{
    embedded_graph::Dart,
    folding::FoldedTrail,
    injected_flaw::InjectedFlaw,
    mapping::{partial_map::START, tree::BreadthFirstTree},
};

/// The most moves of a test that the robot prefers to the nearest open dart of the map. The figures are the best
/// that were tried.
pub(super) fn worthwhile(moves_to_open: usize) -> usize {
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

    fn open_here(&self) -> Option<Dart> {
        let robot = Dart(self.trail.number(self.trail.pose())?);
        let is_open = |&edge: &Dart| self.trail.opposite(self.in_trail[edge.at()]).is_none();
        self.map().darts_of(self.map().vertex(robot)).find(is_open)
    }

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

    pub(super) fn is_late(&self) -> bool {
        self.strict || self.trail.moves() > self.patience()
    }

    /// The number of moves after which the robot only makes strict tests, `4 n m + 200` for a map with `n`
    /// vertices and `m` edges. A strict test takes at most as many moves as a validation of Algorithm 1.
    fn patience(&self) -> usize {
        2 * self.map().vertex_count() * self.map().dart_count() + 200
    }

    /// The cheapest walk of at most `most` moves that confirms a hypothesis about a place if it ends at the
    /// marker. Of walks of one cost it is that of the hypothesis nearest to the marker, then with the nearest
    /// open dart, then of the first hypothesis, and with the first open dart of the trail.
    fn cheapest_test(&mut self, pending: Pending, most: usize) -> Option<HypothesisTest> {
        let to_marker = mem::take(&mut self.to_marker);
        self.list_tests(pending, most, &to_marker);
        self.to_marker = to_marker;
        let mut tests = BinaryHeap::from(mem::take(&mut self.tests));
        let found =
            iter::from_fn(|| tests.pop()).find(|Reverse(test)| self.confirms(pending, test));
        self.tests = tests.into_vec();
        found.map(|Reverse(test)| test)
    }

    /// Lists the walks that lead to the marker at the root of a tree if a hypothesis about a place is true: to an open
    /// dart that would then lead to a place of the map, over it, and through the map to the marker, in at most `most`
    /// moves.
    pub(super) fn list_tests(
        &mut self,
        pending: Pending,
        most: usize,
        to_marker: &BreadthFirstTree,
    ) {
        let Pending { edge, far, is_leaf } = pending;
        let Self { trail, walk, from_robot, hypotheses, tests, .. } = self;
        tests.clear();
        let degree = trail.degree(far);
        for &hypothesis in &self.unexplored {
            let target = self.in_trail[hypothesis.at()];
            if hypotheses.is_refuted(edge, hypothesis) || trail.degree(target) != degree {
                continue;
            }
            let distance = to_marker.hops(walk.map.vertex(hypothesis));
            let mut list = |trail: &FoldedTrail, open, entry: Option<u32>| {
                let Some(entry) = entry.map(Dart) else { return };
                let rest = to_marker.hops(walk.map.vertex(entry)) as usize;
                let approach = from_robot.moves_to_vertex(trail.trail_vertex(open));
                let cost = approach + 1 + rest;
                if cost <= most {
                    let test =
                        HypothesisTest { cost, distance, approach, hypothesis, open, edge, entry };
                    tests.push(Reverse(test));
                }
            };
            if is_leaf && trail.takes_leaf(target, far) {
                trail.for_each_closed_by_leaf(far, target, |open, entry| list(trail, open, entry));
                continue;
            }
            let united = trail.with_united(far, target, |united| {
                united.for_each_closed_dart(|open, far| list(united, open, united.number(far)));
            });
            if united.is_err() {
                hypotheses.refute(edge, hypothesis);
            }
        }
    }

    /// Whether the success of a test, whose hypothesis is alive, forces the hypothesis.
    fn confirms(&mut self, pending: Pending, test: &HypothesisTest) -> bool {
        let Some(leaving) = self.trail.opposite(self.in_trail[test.entry.at()]) else {
            return false;
        };
        let (trail, open) = (&mut self.trail, test.open);
        let (far, target) = (pending.far, self.in_trail[test.hypothesis.at()]);
        if trail.vertex(open) == trail.vertex(far) {
            // The dart is taken at the place itself, as the hypothesis predicts.
            let predicted = trail.behind(target, trail.door(far, open));
            if predicted == leaving {
                return true;
            }
        }
        let hypothesis = Some(test.hypothesis.0);
        let forced = trail.with_united(open, leaving, |united| united.number(far) == hypothesis);
        forced == Ok(true) || InjectedFlaw::ProofByOtherWalk.is_present()
    }

    /// The walk over the edge of a pending place, and along the way to the marker that the first hypothesis predicts, as in
    /// Algorithm 1.
    fn strict_test(&mut self, pending: Pending) -> Option<HypothesisTest> {
        let all = mem::take(&mut self.unexplored);
        let hypothesis = all.iter().copied().find(|&dart| self.is_alive(pending, dart));
        self.unexplored = all;
        let hypothesis = hypothesis?;
        let distance = self.to_marker.hops(self.map().vertex(hypothesis));
        let edge = pending.edge;
        let open = self.in_trail[edge.at()];
        let approach = self.from_robot.moves_to(&self.trail, open);
        let (cost, entry) = (distance as usize, hypothesis);
        Some(HypothesisTest { cost, distance, approach, hypothesis, open, edge, entry })
    }

    fn find_ways_to_marker(&mut self) {
        if !mem::replace(&mut self.to_marker_is_current, true) {
            self.to_marker.grow_from(&self.walk.map, START);
        }
    }
}
