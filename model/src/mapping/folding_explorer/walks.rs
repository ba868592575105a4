//! The walks of a robot that recovers: what it perceived, split where it saw the marker, and what of it agrees.

use std::mem;

use crate::{
    driving::visit::JunctionShape,
    embedded_graph::{Dart, EmbeddedGraph},
    folding::{FoldedTrail, TrailError},
    measurement::{HallwayMeasurement, MeasuredVisit},
    percept::{Door, Percept, Sighting},
};

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EarlierWalk {
    percepts: Vec<Percept>,
    doors: Vec<Door>,
    /// Whether the robot turned round at an obstacle.
    is_blocked: bool,
}

/// What a robot measures besides its percepts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ArrivalMeasurement {
    pub hallway: Option<HallwayMeasurement>,
    /// The shape of the junction, if its doors are at right angles and the hallways are straight.
    pub shape: Option<JunctionShape>,
}

pub(super) fn sees_marker(percept: &Percept) -> bool {
    matches!(percept.sighting, Sighting::Pointing(_))
}

impl EarlierWalk {
    /// A walk that begins with a percept; after each door there is another percept. `is_blocked`: whether the robot
    /// turned round at an obstacle.
    pub fn new(
        first: Percept,
        moves: impl IntoIterator<Item = (Door, Percept)>,
        is_blocked: bool,
    ) -> Self {
        let (doors, mut percepts): (Vec<Door>, Vec<Percept>) = moves.into_iter().unzip();
        percepts.insert(0, first);
        Self { percepts, doors, is_blocked }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.percepts.is_empty()
    }

    /// The robot perceives this, if it has not yet perceived where it is. Returns whether it has not.
    pub(super) fn perceive(&mut self, percept: Percept, is_blocked: bool) -> bool {
        let is_new = self.percepts.len() == self.doors.len();
        if is_new {
            self.percepts.push(percept);
            self.is_blocked |= is_blocked;
        }
        is_new
    }

    pub(super) fn leave(&mut self, door: Door) {
        if !self.is_empty() {
            self.doors.push(door);
        }
    }

    /// Its parts that begin or end at the marker. Without the marker a part says nothing about the world with the
    /// marker, and is left out.
    pub(super) fn split_at_marker(self) -> Vec<Self> {
        let Self { percepts, doors, is_blocked } = self;
        let mut parts = Vec::new();
        let new = || Self { is_blocked, ..Self::default() };
        let mut part = new();
        let mut doors = doors.into_iter();
        for percept in percepts {
            part.percepts.push(percept);
            if sees_marker(&percept) && part.percepts.len() > 1 {
                parts.push(mem::replace(&mut part, new()));
                part.percepts.push(percept);
            }
            part.doors.extend(doors.next());
        }
        // The robot may have taken a door, and not have perceived what is behind it.
        part.doors.truncate(part.percepts.len().saturating_sub(1));
        parts.push(part);
        parts.retain(|part| part.percepts.iter().any(sees_marker) && !part.doors.is_empty());
        parts
    }

    /// The visits in a map that agrees with all percepts, if the walk begins at the marker, with what was measured on
    /// the way to each.
    pub(super) fn visits(
        &self,
        measured: &[ArrivalMeasurement],
        map: &EmbeddedGraph,
        facing: Dart,
    ) -> Vec<MeasuredVisit> {
        let Some(Percept { degree, sighting: Sighting::Pointing(along) }) = self.percepts.first()
        else {
            return Vec::new();
        };
        let mut pose = map.behind(facing, along.inverse(*degree));
        let visit = |(number, measured): (usize, &ArrivalMeasurement)| {
            let left_by = self.doors.get(number).copied();
            let doors = (0..map.degree_around(pose)).map(Door);
            let visit = MeasuredVisit {
                darts: doors.map(|door| map.behind(pose, door)).collect(),
                shape: measured.shape,
                arrived: measured.hallway,
                left_by,
            };
            if let Some(door) = left_by {
                pose = map.after(pose, door);
            }
            visit
        };
        measured.iter().enumerate().map(visit).collect()
    }

    fn fold_into(&self, trail: &mut FoldedTrail) -> Result<(), TrailError> {
        let mut percepts = self.percepts.iter();
        let Some(&first) = percepts.next() else { return Ok(()) };
        trail.begin_walk(first)?;
        for (&door, &percept) in self.doors.iter().zip(percepts) {
            trail.step(door, percept)?;
        }
        Ok(())
    }
}

/// What a robot knows: its walks, each from or to the marker, the newest last.
#[derive(Clone, Debug, Default)]
pub(super) struct EarlierWalks(Vec<EarlierWalk>);

impl EarlierWalks {
    pub(super) fn add(&mut self, walk: EarlierWalk) {
        self.0.extend(walk.split_at_marker());
    }

    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    pub(super) fn forget(&mut self) {
        self.0.clear();
    }

    pub(super) fn forget_blocked(&mut self) {
        self.0.retain(|walk| !walk.is_blocked);
    }

    /// Adds as many walks as agree to a trail, and returns it and their number. The suspect comes last.
    fn fold_newest_first(
        &self,
        mut trail: FoldedTrail,
        suspect: Option<usize>,
    ) -> (FoldedTrail, usize) {
        let others = (0..self.len()).rev().filter(|&at| Some(at) != suspect);
        let mut kept = 0;
        for at in others.chain(suspect) {
            let mut more = trail.clone();
            if self.0[at].fold_into(&mut more).is_ok() {
                trail = more;
                kept += 1;
            }
        }
        (trail, kept)
    }

    /// Folds the largest set of walks that agree, of those that are found with each walk as the suspect. Of sets
    /// of the same size it is the one with the newest suspect. The `sure` newest walks are no suspects, and all agree
    /// with the given trail. Returns the number of walks, too.
    pub(super) fn fold_most(&self, trail: &FoldedTrail, sure: usize) -> (FoldedTrail, usize) {
        let suspects = (0..self.len().saturating_sub(sure)).rev().map(Some);
        let mut best = (trail.clone(), 0);
        for suspect in suspects.chain([None]) {
            let folded = self.fold_newest_first(trail.clone(), suspect);
            if folded.1 > best.1 {
                best = folded;
            }
            if best.1 == self.len() {
                break;
            }
        }
        best
    }
}
