//! Tests of hypotheses: walks whose success confirms one.

use std::{cmp::Reverse, collections::BinaryHeap, iter, mem};

use super::{FoldingRun, HypothesisTest, Pending};
use crate::{
    embedded_graph::Dart, folding::FoldedTrail, injected_flaw::InjectedFlaw,
    mapping::partial_map::START,
};

impl FoldingRun {
    /// The cheapest walk of at most `most` moves that confirms a hypothesis about a place if it ends at the
    /// marker. Of walks of one cost it is that of the hypothesis nearest to the marker, then with the nearest
    /// open dart, then of the first hypothesis, and with the first open dart of the trail.
    pub(super) fn cheapest_test(
        &mut self,
        pending: Pending,
        most: usize,
    ) -> Option<HypothesisTest> {
        self.list_tests(pending, most);
        let mut tests = BinaryHeap::from(mem::take(&mut self.tests));
        let found =
            iter::from_fn(|| tests.pop()).find(|Reverse(test)| self.confirms(pending, test));
        self.tests = tests.into_vec();
        found.map(|Reverse(test)| test)
    }

    /// Lists the walks that lead to the marker if a hypothesis about a place is true: to an open dart
    /// that would then lead to a place of the map, over it, and through the map to the marker, in at most
    /// `most` moves.
    fn list_tests(&mut self, pending: Pending, most: usize) {
        let Pending { edge, far, is_leaf } = pending;
        let Self { trail, journey, to_marker, from_robot, hypotheses, tests, .. } = self;
        tests.clear();
        let degree = trail.degree(far);
        for &hypothesis in &self.unexplored {
            let target = self.in_trail[hypothesis.at()];
            if hypotheses.is_refuted(edge, hypothesis) || trail.degree(target) != degree {
                continue;
            }
            let distance = to_marker.hops(journey.map.vertex(hypothesis));
            let mut list = |trail: &FoldedTrail, open, entry: Option<u32>| {
                let Some(entry) = entry.map(Dart) else { return };
                let rest = to_marker.hops(journey.map.vertex(entry)) as usize;
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
    pub(super) fn confirms(&mut self, pending: Pending, test: &HypothesisTest) -> bool {
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

    /// The walk from a pending place along the way to the marker that the first hypothesis predicts, as
    /// in Algorithm 1.
    pub(super) fn strict_test(&mut self, pending: Pending) -> Option<HypothesisTest> {
        let Pending { edge, far, .. } = pending;
        let all = mem::take(&mut self.unexplored);
        let hypothesis = all.iter().copied().find(|&dart| self.is_alive(pending, dart));
        self.unexplored = all;
        let hypothesis = hypothesis?;
        let distance = self.to_marker.hops(self.map().vertex(hypothesis));
        let (mut pose, mut believed) = (far, hypothesis);
        loop {
            let cost = self.to_marker.hops(self.map().vertex(believed)) as usize;
            let (door, entry) = self.to_marker.toward_root(self.map(), believed)?;
            let open = self.trail.behind(pose, door);
            match self.trail.opposite(open) {
                None => {
                    let approach = self.from_robot.moves_to(&self.trail, open);
                    let test =
                        HypothesisTest { cost, distance, approach, hypothesis, open, edge, entry };
                    return Some(test);
                }
                Some(next) => (pose, believed) = (next, entry),
            }
        }
    }

    /// Finds the ways to the marker through the map, if it has grown.
    pub(super) fn find_ways_to_marker(&mut self) {
        if !mem::replace(&mut self.to_marker_is_current, true) {
            self.to_marker.grow_from(&self.journey.map, START);
            self.to_marker.grow_whole(&self.journey.map);
        }
    }
}
