//! Conclusions from the trail: hypotheses are refuted, loops of the map are closed, and places join it.

use std::mem;

use super::{FoldingRun, Pending};
use crate::{
    clone_in_place::clone_in_place,
    embedded_graph::Dart,
    injected_flaw::InjectedFlaw,
    mapping::{Mapped, MappingEvent, ObservedWorld},
    percept::Door,
};

/// What is known about the hypotheses that the place behind one dart of the map is entered by another.
#[derive(Debug, Default)]
pub(super) struct Hypotheses {
    /// One bit for each pair of darts of the map. A refuted hypothesis stays refuted, because a trail
    /// only grows.
    refuted: Vec<u64>,
    /// For each dart of the map, a hypothesis about its far end, and the number of moves after which it was alive.
    witness: Vec<Option<Witness>>,
}

clone_in_place!(Hypotheses { refuted, witness });

#[derive(Clone, Copy, Debug)]
struct Witness {
    hypothesis: Dart,
    moves: usize,
}

/// A number for each pair, so that those of the first `n` darts are the first `n^2`.
fn index(edge: Dart, hypothesis: Dart) -> usize {
    let (edge, hypothesis) = (edge.at(), hypothesis.at());
    if edge < hypothesis { hypothesis * hypothesis + edge } else { edge * edge + edge + hypothesis }
}

impl Hypotheses {
    pub(super) fn clear(&mut self) {
        self.refuted.clear();
        self.witness.clear();
    }

    #[inline]
    pub(super) fn is_refuted(&self, edge: Dart, hypothesis: Dart) -> bool {
        let index = index(edge, hypothesis);
        self.refuted.get(index / 64).is_some_and(|bits| bits >> (index % 64) & 1 == 1)
    }

    pub(super) fn refute(&mut self, edge: Dart, hypothesis: Dart) {
        let index = index(edge, hypothesis);
        if self.refuted.len() <= index / 64 {
            self.refuted.resize(index / 64 + 1, 0);
        }
        self.refuted[index / 64] |= 1 << (index % 64);
    }

    fn witness(&self, edge: Dart) -> Option<Witness> {
        *self.witness.get(edge.at())?
    }

    fn set_witness(&mut self, edge: Dart, witness: Option<Witness>) {
        if self.witness.len() <= edge.at() {
            self.witness.resize(edge.at() + 1, None);
        }
        self.witness[edge.at()] = witness;
    }
}

impl FoldingRun {
    /// Joins the ends of edges that are both known, and puts pending places without a living hypothesis
    /// into the map, until nothing changes.
    pub(super) fn settle<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        loop {
            self.close_loops(world);
            let pending = mem::take(&mut self.pending);
            let new = pending.iter().find(|&&pending| self.is_new(pending)).copied();
            self.pending = pending;
            let Some(new) = new else { return Ok(()) };
            self.add_place(new, world)?;
        }
    }

    /// Finds the edges of the map whose far ends are now known, and the pending places.
    fn close_loops(&mut self, world: &mut impl ObservedWorld) {
        let mut unexplored = mem::take(&mut self.unexplored);
        self.open.clear();
        self.pending.clear();
        unexplored.retain(|&edge| {
            if !self.map().is_unexplored(edge) {
                return false;
            }
            let Some(far) = self.trail.opposite(self.in_trail[edge.at()]) else {
                self.open.push(edge);
                return true;
            };
            let Some(other) = self.trail.number(far).map(Dart) else {
                self.pending.push(Pending { edge, far, is_leaf: self.trail.is_leaf(far) });
                return true;
            };
            self.walk.map.join(edge, other);
            self.to_marker_is_current = false;
            world.event(&self.walk, MappingEvent::LoopClosed { edge, other });
            false
        });
        self.unexplored = unexplored;
    }

    fn add_place<W: ObservedWorld>(&mut self, pending: Pending, world: &mut W) -> Mapped<W> {
        let Pending { edge, far, .. } = pending;
        let degree = self.trail.degree(far);
        self.walk.check_bound(degree)?;
        let vertex = self.walk.map.add_vertex(degree);
        self.walk.map.join(edge, self.walk.map.first_dart(vertex));
        self.to_marker_is_current = false;
        self.put_in_map(far);
        self.find_robot();
        world.event(&self.walk, MappingEvent::VertexAdded { edge, vertex });
        Ok(())
    }

    /// Numbers the darts of a place as the map does, which has just got it, clockwise from a pose.
    pub(super) fn put_in_map(&mut self, pose: Dart) {
        let first = self.in_trail.len() as u32;
        self.trail.set_numbers(pose, first);
        for door in 0..self.trail.degree(pose) {
            self.in_trail.push(self.trail.behind(pose, Door(door)));
            self.unexplored.push(Dart(first + door));
        }
    }

    pub(super) fn find_robot(&mut self) {
        if let Some(robot) = self.trail.number(self.trail.pose()) {
            self.walk.robot = Dart(robot);
        }
    }

    /// Whether a pending place is a new place of the map: no hypothesis about it is alive.
    fn is_new(&mut self, pending: Pending) -> bool {
        InjectedFlaw::PlaceAddedTooEarly.is_present() || !self.has_hypothesis(pending)
    }

    fn has_hypothesis(&mut self, pending: Pending) -> bool {
        let moves = self.trail.moves();
        let witness = self.hypotheses.witness(pending.edge);
        if let Some(witness) = witness.filter(|last| self.map().is_unexplored(last.hypothesis))
            && (witness.moves == moves || self.is_alive(pending, witness.hypothesis))
        {
            let witness = Witness { moves, ..witness };
            self.hypotheses.set_witness(pending.edge, Some(witness));
            return true;
        }
        let all = mem::take(&mut self.unexplored);
        let examined = if InjectedFlaw::OneHypothesisExamined.is_present() { 1 } else { all.len() };
        let alive = all.iter().take(examined).find(|&&dart| self.is_alive(pending, dart)).copied();
        self.unexplored = all;
        let witness = alive.map(|hypothesis| Witness { hypothesis, moves });
        self.hypotheses.set_witness(pending.edge, witness);
        alive.is_some()
    }

    pub(super) fn is_alive(&mut self, pending: Pending, hypothesis: Dart) -> bool {
        if self.hypotheses.is_refuted(pending.edge, hypothesis) {
            return false;
        }
        let target = self.in_trail[hypothesis.at()];
        let Pending { far, is_leaf, .. } = pending;
        let alive = self.trail.degree(far) == self.trail.degree(target)
            && (is_leaf && self.trail.takes_leaf(target, far)
                || self.trail.with_united(far, target, |_| ()).is_ok()
                || InjectedFlaw::ContradictionIgnored.is_present());
        if !alive {
            self.hypotheses.refute(pending.edge, hypothesis);
        }
        alive
    }
}
