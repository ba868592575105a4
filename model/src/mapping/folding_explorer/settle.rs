//! Conclusions from the trail: loops of the map are closed, and places join it.

use std::mem;

use super::{FoldingRun, Pending, hypotheses::Witness};
use crate::{
    embedded_graph::Dart,
    injected_flaw::InjectedFlaw,
    mapping::{MappingError, MappingEvent, Observer},
    percept::Door,
    world::World,
};

impl FoldingRun {
    /// Joins the ends of edges that are both known, and puts pending places without a living hypothesis
    /// into the map, until nothing changes.
    pub(super) fn settle<W: World>(
        &mut self,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        loop {
            self.close_loops(world, observer);
            let pending = mem::take(&mut self.pending);
            let new = pending.iter().find(|&&pending| self.is_new(pending)).copied();
            self.pending = pending;
            let Some(new) = new else { return Ok(()) };
            self.add_place(new, world, observer)?;
        }
    }

    /// Finds the edges of the map whose far ends are now known, and the pending places.
    fn close_loops<W: World>(&mut self, world: &mut W, observer: &mut impl Observer<W>) {
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
            self.journey.map.join(edge, other);
            self.to_marker_is_current = false;
            observer.event(world, &self.journey, MappingEvent::LoopClosed { edge, other });
            false
        });
        self.unexplored = unexplored;
    }

    /// A pending place is a new place of the map.
    fn add_place<W: World>(
        &mut self,
        pending: Pending,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        let Pending { edge, far, .. } = pending;
        let degree = self.trail.degree(far);
        self.journey.check_bound(degree)?;
        let vertex = self.journey.map.add_vertex(degree);
        self.journey.map.join(edge, self.journey.map.first_dart(vertex));
        self.to_marker_is_current = false;
        self.put_in_map(far);
        self.find_robot();
        observer.event(world, &self.journey, MappingEvent::VertexAdded { edge, vertex });
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

    /// The robot's pose in the map, if it is known now.
    pub(super) fn find_robot(&mut self) {
        if let Some(robot) = self.trail.number(self.trail.pose()) {
            self.journey.robot = Dart(robot);
        }
    }

    /// Whether a pending place is a new place of the map: no hypothesis about it is alive.
    fn is_new(&mut self, pending: Pending) -> bool {
        InjectedFlaw::PlaceAddedTooEarly.is_present() || !self.has_hypothesis(pending)
    }

    /// Whether a hypothesis about a pending place is alive.
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

    /// Whether a pending place may be entered by an unexplored dart of the map.
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
