//! Searches for a choice of visits that some world explains: that of a walk that can be folded.
//!
//! To decide whether there is one is NP-complete, even without a marker. The search goes depth first in the order of
//! time. At a place that the walk has folded onto a known vertex, only what was perceived there before can be chosen, so
//! it branches at new vertices alone. What was tried in vain is not tried again from the same
//! [folded trail](FoldedTrail).

use std::collections::BTreeSet;

use super::{VisitAlternative, VisitSet, VisitWay};
use crate::{
    enumerate::Watch,
    folding::{ClosedTrail, FoldedTrail},
    percept::Door,
};

/// Whether some choice of visits is explained: by a known world or by any, and by the doors of an algorithm if one drives.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Explanation {
    /// These alternatives are, one of each visit.
    Explained(Vec<Option<VisitAlternative>>),
    /// No choice of the visits up to this one is, counted from 0.
    Impossible { visit: usize },
    /// The search was stopped, or its bound was reached.
    NotKnown,
}

/// The folded walk of some visits.
#[derive(Clone, Debug)]
pub(super) struct VisitWalk {
    trail: FoldedTrail,
    next: Next,
}

/// Where the robot is after a visit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Next {
    /// It has not come to a vertex.
    Begins,
    /// It drives away from the last vertex, which it left by this door.
    Leaves(Door),
    /// It drives back to the last vertex, having left it by this door.
    ComesBack(Door),
    /// It stands at the last vertex.
    Stands,
}

/// A walk, and the ways to go on that have not been tried, the last one first.
struct Branch {
    walk: VisitWalk,
    untried: Vec<(Option<VisitAlternative>, Next)>,
}

/// Searches for a choice of the visits that some world explains, and returns a world that does; `None` if a choice without
/// vertices is explained by all worlds. The robot has a directional marker, or none. If the marker was not seen, it lies
/// behind the last dart of the world. `bound` is the largest number of darts in the trails that are tried, all together: it
/// limits time and memory.
pub fn explain(
    visits: &[VisitSet],
    is_marked: bool,
    bound: usize,
    watch: &dyn Watch,
) -> (Explanation, Option<ClosedTrail>) {
    let begin = VisitWalk::begin();
    let Some(first) = visits.first() else { return (Explanation::Explained(Vec::new()), None) };
    let mut branches = vec![Branch { untried: begin.ways(first, visits.len() == 1), walk: begin }];
    let mut choice = Vec::new();
    let mut tried = BTreeSet::new();
    let (mut darts, mut farthest) = (0_usize, 0);
    while let Some(branch) = branches.last_mut() {
        let Some((alternative, next)) = branch.untried.pop() else {
            branches.pop();
            choice.pop();
            continue;
        };
        darts = darts.saturating_add(branch.walk.trail.dart_count() + 1);
        if darts > bound || watch.stop() {
            return (Explanation::NotKnown, None);
        }
        let walk = branch.walk.after(alternative, next);
        let Some(walk) = walk.filter(|walk| !is_marked || walk.may_hold_marker()) else { continue };
        let visit = branches.len();
        farthest = farthest.max(visit);
        if !tried.insert((visit, next, walk.form())) {
            continue;
        }
        choice.push(alternative);
        let Some(set) = visits.get(visit) else {
            return (Explanation::Explained(choice), walk.trail.closed());
        };
        let untried = walk.ways(set, visit + 1 == visits.len());
        branches.push(Branch { walk, untried });
    }
    (Explanation::Impossible { visit: farthest }, None)
}

impl VisitWalk {
    pub(super) fn begin() -> Self {
        Self { trail: FoldedTrail::default(), next: Next::Begins }
    }

    /// The alternatives of the next visit, each with where the robot is after it, from the last to the first.
    fn ways(&self, visit: &VisitSet, is_last: bool) -> Vec<(Option<VisitAlternative>, Next)> {
        let mut ways = Vec::new();
        for &alternative in visit.alternatives() {
            match alternative {
                None => ways.push((None, self.next.without_vertex(visit.way()))),
                Some(vertex) if is_last && vertex.door.is_none() => {
                    ways.push((alternative, Next::Stands));
                }
                Some(vertex) => {
                    ways.extend(vertex.doors().map(|door| (alternative, Next::Leaves(door))));
                }
            }
        }
        ways.reverse();
        ways
    }

    /// The walk after a visit; `None` if no world explains it.
    pub(super) fn after(&self, alternative: Option<VisitAlternative>, next: Next) -> Option<Self> {
        let mut trail = self.trail.clone();
        if let Some(VisitAlternative { percept, .. }) = alternative {
            match self.next {
                Next::Begins => trail = FoldedTrail::new(percept).ok()?,
                Next::Leaves(door) => trail.step(door, percept).ok()?,
                Next::ComesBack(door) => trail.come_back(door, percept).ok()?,
                Next::Stands => {}
            }
        }
        Some(Self { trail, next })
    }

    pub(super) fn may_hold_marker(&self) -> bool {
        self.next == Next::Begins || self.trail.may_hold_marker()
    }

    /// What is known of the world: walks with one form can go on alike.
    fn form(&self) -> Vec<u32> {
        if self.next == Next::Begins { Vec::new() } else { self.trail.seen_from_robot() }
    }
}

impl Next {
    fn without_vertex(self, way: VisitWay) -> Self {
        match (way, self) {
            (VisitWay::Back, Self::Leaves(door)) => Self::ComesBack(door),
            (VisitWay::Back, Self::ComesBack(door)) => Self::Leaves(door),
            (_, same) => same,
        }
    }
}
