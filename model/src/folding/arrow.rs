//! An arrow on an edge: a robot notices it on its way along that edge, and in which sense. So all poses after a
//! move along the arrow are one pose, all poses after a move against it are another one, and the two are the
//! ends of one edge. Every other edge that was traversed is without an arrow.

use super::{ContradictionReason, FoldedTrail, TrailError, classes::OPEN};
use crate::{
    embedded_graph::Dart,
    percept::{Percept, Sighting},
};

/// In which sense the robot passed the arrow.
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

impl Arrow {
    fn pose_after(&mut self, sense: Sense) -> &mut Option<Dart> {
        match sense {
            Sense::Along => &mut self.along,
            Sense::Against => &mut self.against,
        }
    }
}

/// What a sighting shows of an arrow.
fn of_arrow(sighting: Sighting) -> Sighting {
    match sighting {
        Sighting::PassedAlong | Sighting::PassedAgainst => sighting,
        _ => Sighting::Nothing,
    }
}

impl FoldedTrail {
    /// The robot has passed the arrow.
    pub(super) fn identify_arrow(&mut self, sense: Sense) -> Result<(), TrailError> {
        let pose = *self.arrow.pose_after(sense).get_or_insert(Dart(self.pose));
        self.classes.unite(pose.0, self.pose)?;
        let other = match sense {
            Sense::Along => self.arrow.against,
            Sense::Against => self.arrow.along,
        };
        if let Some(other) = other {
            let [pose, other] = [pose, other].map(|dart| self.classes.find(dart.0));
            match [pose, other].map(|dart| self.classes.opposite(dart)) {
                [OPEN, OPEN] if pose == other => {
                    return Err(ContradictionReason::OwnOpposite { visit: self.moves }.into());
                }
                [OPEN, OPEN] => self.classes.join(pose, other),
                [OPEN, far] => self.classes.unite(pose, far)?,
                [far, _] => self.classes.unite(far, other)?,
            }
        }
        self.classes.flatten();
        Ok(self.check_arrow()?)
    }

    /// The ends of the edge with the arrow, as darts of roots: the one from which it points, and the other one.
    pub(super) fn arrow_ends(&self) -> [Option<Dart>; 2] {
        let Arrow { along, against } = self.arrow;
        let end = |entered: Option<Dart>, other: Option<Dart>| {
            let known = entered.map(|dart| self.root_of(dart));
            known.or_else(|| self.opposite(other?))
        };
        [end(against, along), end(along, against)]
    }

    /// What a robot sees of the arrow if it comes in by a dart of an edge that was traversed.
    fn arrow_seen_by(&self, pose: Dart) -> Sighting {
        let pose = Some(self.root_of(pose));
        match self.arrow_ends() {
            [tail, _] if tail == pose => Sighting::PassedAgainst,
            [_, head] if head == pose => Sighting::PassedAlong,
            _ => Sighting::Nothing,
        }
    }

    /// Compares what the robot has just seen with what is known of the edge by which it came.
    #[inline]
    pub(super) fn compare_arrow(&self, percept: Percept) -> Result<(), ContradictionReason> {
        let seen = of_arrow(percept.sighting);
        if self.arrow == Arrow::default() && seen == Sighting::Nothing {
            return Ok(());
        }
        let pose = self.pose();
        let before = self.arrow_seen_by(pose);
        let visits = [self.classes.visit(pose.0), self.moves];
        if before == seen {
            Ok(())
        } else {
            Err(ContradictionReason::Marker { visits, sightings: [before, seen] })
        }
    }

    /// Compares what the robot saw each time it traversed an edge for the first time.
    #[inline]
    pub(super) fn check_arrow(&self) -> Result<(), ContradictionReason> {
        if self.arrow == Arrow::default() {
            return Ok(());
        }
        for vertex in 0..self.trail_vertex_count() as u32 {
            let pose = self.classes.first(vertex);
            let seen = of_arrow(self.classes.percept(pose).sighting);
            let other = self.arrow_seen_by(Dart(pose));
            if seen != other {
                let visits = [self.classes.visit(pose), self.moves];
                return Err(ContradictionReason::Marker { visits, sightings: [seen, other] });
            }
        }
        Ok(())
    }
}
