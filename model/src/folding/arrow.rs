//! An arrow on an edge: a robot notices it on its way along that edge, and in which sense. So all poses after a
//! move along the arrow are one pose, all poses after a move against it are another one, and the two are the
//! ends of one edge. Every other edge that was traversed is without an arrow.

use super::{
    ContradictionReason, TrailError,
    classes::{DartClasses, OPEN},
};
use crate::{
    embedded_graph::Dart,
    percept::{Percept, Sighting},
};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sense {
    Along,
    Against,
}

/// The pose after a move in each sense, as far as there was one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Arrow {
    along: Option<Dart>,
    against: Option<Dart>,
}

fn of_arrow(sighting: Sighting) -> Sighting {
    match sighting {
        Sighting::PassedAlong | Sighting::PassedAgainst => sighting,
        _ => Sighting::Nothing,
    }
}

impl Arrow {
    fn pose_after(&mut self, sense: Sense) -> &mut Option<Dart> {
        match sense {
            Sense::Along => &mut self.along,
            Sense::Against => &mut self.against,
        }
    }

    /// The robot has passed the arrow, and has come in by the dart `pose` after some moves.
    pub(super) fn pass(
        &mut self,
        sense: Sense,
        (pose, moves): (u32, usize),
        classes: &mut DartClasses,
    ) -> Result<(), TrailError> {
        let first = *self.pose_after(sense).get_or_insert(Dart(pose));
        classes.unite(first.0, pose)?;
        let other = match sense {
            Sense::Along => self.against,
            Sense::Against => self.along,
        };
        if let Some(other) = other {
            let [pose, other] = [first, other].map(|dart| classes.find(dart.0));
            match [pose, other].map(|dart| classes.opposite(dart)) {
                [OPEN, OPEN] if pose == other => {
                    return Err(ContradictionReason::OwnOpposite { visit: moves }.into());
                }
                [OPEN, OPEN] => classes.join(pose, other),
                [OPEN, far] => classes.unite(pose, far)?,
                [far, _] => classes.unite(far, other)?,
            }
        }
        classes.flatten();
        Ok(self.check(moves, classes)?)
    }

    /// The ends of the edge with the arrow, as darts of roots: the one from which it points, and the other one.
    pub(super) fn ends(&self, classes: &DartClasses) -> [Option<Dart>; 2] {
        let end = |entered: Option<Dart>, other: Option<Dart>| {
            let known = entered.map(|dart| classes.find(dart.0));
            let far = || Some(classes.opposite(classes.find(other?.0))).filter(|&far| far != OPEN);
            known.or_else(far).map(Dart)
        };
        [end(self.against, self.along), end(self.along, self.against)]
    }

    /// What a robot sees of the arrow if it comes in by a dart of an edge that was traversed.
    fn seen_by(&self, pose: u32, classes: &DartClasses) -> Sighting {
        let pose = Some(Dart(classes.find(pose)));
        match self.ends(classes) {
            [tail, _] if tail == pose => Sighting::PassedAgainst,
            [_, head] if head == pose => Sighting::PassedAlong,
            _ => Sighting::Nothing,
        }
    }

    /// Compares what the robot has just seen, when it came in by the dart `pose` after some moves, with what is known of
    /// that edge.
    #[inline]
    pub(super) fn compare(
        &self,
        percept: Percept,
        (pose, moves): (u32, usize),
        classes: &DartClasses,
    ) -> Result<(), ContradictionReason> {
        let seen = of_arrow(percept.sighting);
        if *self == Self::default() && seen == Sighting::Nothing {
            return Ok(());
        }
        let pose = classes.find(pose);
        let before = self.seen_by(pose, classes);
        let visits = [classes.visit(pose), moves];
        if before == seen {
            Ok(())
        } else {
            Err(ContradictionReason::Marker { visits, sightings: [before, seen] })
        }
    }

    /// Compares what the robot saw each time it traversed an edge for the first time.
    #[inline]
    pub(super) fn check(
        &self,
        moves: usize,
        classes: &DartClasses,
    ) -> Result<(), ContradictionReason> {
        if *self == Self::default() {
            return Ok(());
        }
        for vertex in 0..classes.trail_vertex_count() as u32 {
            let pose = classes.first(vertex);
            let seen = of_arrow(classes.percept(pose).sighting);
            let other = self.seen_by(pose, classes);
            if seen != other {
                let visits = [classes.visit(pose), moves];
                return Err(ContradictionReason::Marker { visits, sightings: [seen, other] });
            }
        }
        Ok(())
    }
}
