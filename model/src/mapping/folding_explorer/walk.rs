//! Walks of the robot: to an open dart and over it, and to the marker as a hypothesis predicts.

use std::mem;

use super::{FoldingRun, HypothesisTest};
use crate::{
    embedded_graph::Dart,
    folding::TrailError,
    injected_flaw::InjectedFlaw,
    mapping::{
        Contradiction, FoldingEvent, Mapped, MappingError, MappingEvent, ObservedWorld, PartialMap,
        tree::BreadthFirstTree,
    },
    percept::{Door, Percept},
};

impl FoldingRun {
    pub(super) fn explore<W: ObservedWorld>(&mut self, edge: Dart, world: &mut W) -> Mapped<W> {
        let before = self.trail.vertex_count() + 1;
        let percept = self.take_open(self.in_trail[edge.at()], world)?;
        self.report(FoldingEvent::Explored { edge, percept }, world);
        self.report_folding(before, world);
        Ok(())
    }

    /// Walks to the marker as if a hypothesis were true, until it is confirmed or refuted.
    pub(super) fn test<W: ObservedWorld>(
        &mut self,
        test: HypothesisTest,
        world: &mut W,
    ) -> Mapped<W> {
        let to_marker = mem::take(&mut self.to_marker);
        let walked = self.walk_to_root(test, &to_marker, world, |map, believed, perceived, _| {
            [map.expected(believed), perceived]
        });
        self.to_marker = to_marker;
        if walked? && InjectedFlaw::ProofByOtherWalk.is_present() {
            self.believe(test)?;
        }
        Ok(())
    }

    /// Walks to the root of a tree as if a hypothesis were true, until it is confirmed or refuted. Returns whether it
    /// is confirmed. `compared` returns the percept that is expected by a dart of the map, and the one there.
    pub(super) fn walk_to_root<W: ObservedWorld>(
        &mut self,
        test: HypothesisTest,
        to_root: &BreadthFirstTree,
        world: &mut W,
        compared: impl Fn(&PartialMap, Dart, Percept, &W) -> [Percept; 2],
    ) -> Mapped<W, bool> {
        let HypothesisTest { edge, hypothesis, cost, open, entry, .. } = test;
        self.report(FoldingEvent::Testing { edge, hypothesis, cost }, world);
        let is_new = self.trail.opposite(open).is_none();
        let mut before = self.trail.vertex_count() + usize::from(is_new);
        let mut percept = self.take_open(open, world)?;
        let mut believed = entry;
        let is_confirmed = loop {
            let [expected, perceived] = compared(self.map(), believed, percept, world);
            let pose = self.trail.pose();
            if perceived != expected || !self.trail.senses_agree(pose, self.in_trail[believed.at()])
            {
                self.hypotheses.refute(edge, hypothesis);
                let event = FoldingEvent::Refuted { edge, hypothesis, expected, perceived };
                self.report(event, world);
                break false;
            }
            let Some((door, next)) = to_root.toward_root(self.map(), believed) else {
                self.report(FoldingEvent::Confirmed { edge, hypothesis }, world);
                break true;
            };
            let open = self.trail.opposite(self.trail.behind(self.trail.pose(), door)).is_none();
            before = self.trail.vertex_count() + usize::from(open);
            percept = self.go_through(door, world)?;
            believed = next;
        };
        self.report_folding(before, world);
        Ok(is_confirmed)
    }

    /// Takes a hypothesis as true, as an [`InjectedFlaw`].
    pub(super) fn believe(&mut self, test: HypothesisTest) -> Result<(), TrailError> {
        let HypothesisTest { edge, hypothesis, .. } = test;
        let [edge, hypothesis] = [edge, hypothesis].map(|dart| self.in_trail[dart.at()]);
        if let Some(far) = self.trail.opposite(edge) {
            self.trail.unite(far, hypothesis)?;
            self.from_robot.clear();
            self.find_robot();
        }
        Ok(())
    }

    fn take_open<W: ObservedWorld>(&mut self, open: Dart, world: &mut W) -> Mapped<W, Percept> {
        self.go_to(open, world)?;
        self.go_through(self.trail.door(self.trail.pose(), open), world)
    }

    pub(super) fn go_to<W: ObservedWorld>(&mut self, dart: Dart, world: &mut W) -> Mapped<W> {
        if self.trail.vertex(dart) != self.trail.vertex(self.trail.pose()) {
            self.from_robot.find(&self.trail);
            let mut way = mem::take(&mut self.way);
            self.from_robot.darts_to(&self.trail, dart, &mut way);
            for &dart in &way {
                let door = self.trail.door(self.trail.pose(), dart);
                self.go_through(door, world)?;
            }
            self.way = way;
        }
        Ok(())
    }

    fn go_through<W: ObservedWorld>(&mut self, door: Door, world: &mut W) -> Mapped<W, Percept> {
        let percept = self.walk.go(door, world)?;
        if let Err(error) = self.trail.step(door, percept) {
            return Err(match error {
                TrailError::Contradiction(reason) => {
                    Contradiction::Trail { reason, expected: self.trail.seen_before() }.into()
                }
                TrailError::TooManyDarts => MappingError::from(error),
            });
        }
        self.sense(world)?;
        self.find_robot();
        Ok(percept)
    }

    /// Compares what the robot senses besides its percept. No percept is then the one that is false.
    pub(super) fn sense<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        Ok(self.trail.sense(world.senses()).map_err(TrailError::from)?)
    }

    /// Reports that the trail has fewer vertices, if it has: the robot has seen the marker.
    pub(super) fn report_folding(&self, before: usize, world: &mut impl ObservedWorld) {
        let after = self.trail.vertex_count();
        if after < before {
            self.report(FoldingEvent::Folded { before, after }, world);
        }
    }

    fn report(&self, event: FoldingEvent, world: &mut impl ObservedWorld) {
        world.event(&self.walk, MappingEvent::Folding(event));
    }
}
