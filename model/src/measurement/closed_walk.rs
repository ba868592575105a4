//! Closed walks in a building of straight hallways and right angles: the turns at the junctions add up to whole
//! turns, and the displacements to none.

use std::collections::BTreeMap;

use super::{ContradictoryMeasurement, MeasuredVisit, MeasurementNoise, two_degrees};
use crate::embedded_graph::Dart;

/// A direction: quarter turns counter-clockwise from where the robot looked at first.
type Quarter = u32;

/// Follows the robot by the shapes of junctions and the lengths of hallways.
#[derive(Clone, Debug, Default)]
pub(super) struct ClosedWalks {
    here: Option<WalkPosition>,
    /// For each vertex, by its least dart, the last visit.
    visited: BTreeMap<Dart, PastVisit>,
}

/// Where the robot is, from where it began.
#[derive(Clone, Copy, Debug, Default)]
struct WalkPosition {
    /// In metres.
    position: [f64; 2],
    /// The sum of the variances of the way so far, along each axis, in square metres.
    variance: [f64; 2],
    /// The direction in which the robot came in.
    heading: Quarter,
    /// The length of the way so far, in metres.
    way: f64,
}

#[derive(Clone, Debug)]
struct PastVisit {
    visit: usize,
    here: WalkPosition,
    /// The direction of the vertex's least dart.
    direction: Quarter,
    /// The directions of all darts clockwise from that one, in quarter turns clockwise from it.
    quarters: Vec<Quarter>,
}

impl ClosedWalks {
    /// Goes on to a visit. Returns how it contradicts the last visit of its vertex, and the number of that one.
    pub(super) fn go(
        &mut self,
        number: usize,
        before: Option<&MeasuredVisit>,
        visit: &MeasuredVisit,
        noise: &MeasurementNoise,
    ) -> Option<(usize, ContradictoryMeasurement)> {
        let here = match before {
            None => Some(WalkPosition::default()),
            Some(before) => self.here.and_then(|here| here.after(before, visit, noise)),
        };
        let mut here = here.unwrap_or_else(|| {
            // It is not known how the robot came here: the walk begins again.
            self.visited.clear();
            WalkPosition::default()
        });
        let found = self.compare(number, visit, &mut here);
        // Of two shapes it is not known which leads on.
        let leads_on = !matches!(found, Some((_, ContradictoryMeasurement::Shape)));
        self.here = leads_on.then_some(here);
        found
    }

    /// Compares a visit with the last one of its vertex. If they contradict each other, the walk goes on from that
    /// one.
    fn compare(
        &mut self,
        number: usize,
        visit: &MeasuredVisit,
        here: &mut WalkPosition,
    ) -> Option<(usize, ContradictoryMeasurement)> {
        let (door, &vertex) = visit.darts.iter().enumerate().min_by_key(|(_, dart)| **dart)?;
        let mut quarters = visit.shape?.quarters();
        if quarters.len() != visit.darts.len() {
            return None;
        }
        quarters.rotate_left(door);
        let first = quarters[0];
        let mut direction = (here.heading + 6 - first) % 4;
        for quarter in &mut quarters {
            *quarter = (*quarter + 4 - first) % 4;
        }
        let past = self.visited.get(&vertex);
        if let Some(past) = past.filter(|past| past.quarters != quarters) {
            return Some((past.visit, ContradictoryMeasurement::Shape));
        }
        let found =
            past.and_then(|past| Some((past.clone(), past.contradiction(here, direction)?)));
        if let Some((past, _)) = &found {
            here.heading = (here.heading + past.direction + 4 - direction) % 4;
            here.position = past.here.position;
            direction = past.direction;
            self.visited.retain(|_, other| other.visit <= past.visit);
        }
        let now = PastVisit { visit: number, here: *here, direction, quarters };
        self.visited.insert(vertex, now);
        found.map(|(past, measurement)| (past.visit, measurement))
    }
}

impl WalkPosition {
    /// Where the robot is after a move; `None` if that is not known.
    fn after(
        mut self,
        before: &MeasuredVisit,
        now: &MeasuredVisit,
        noise: &MeasurementNoise,
    ) -> Option<Self> {
        let length = now.arrived?.length;
        let leaving = *before.shape?.quarters().get(before.left_by?.0 as usize)?;
        self.heading = (self.heading + 6 - leaving) % 4;
        let along = (self.heading % 2) as usize;
        let sign = if self.heading < 2 { 1.0 } else { -1.0 };
        self.position[along] += sign * length;
        // The robot may stand beside the middle of a hallway as well.
        let aside = 2.0 * noise.standing.powi(2);
        self.variance[along] += noise.length_variance(length);
        self.variance[1 - along] += aside;
        self.way += length;
        Some(self)
    }
}

impl PastVisit {
    fn contradiction(
        &self,
        now: &WalkPosition,
        direction: Quarter,
    ) -> Option<ContradictoryMeasurement> {
        if self.direction != direction {
            let quarters = (direction + 4 - self.direction) % 4;
            return Some(ContradictoryMeasurement::ClosedTurns { quarters });
        }
        let off = [0, 1].map(|axis| now.position[axis] - self.here.position[axis]);
        let statistic = [0, 1].map(|axis| {
            let variance = now.variance[axis] - self.here.variance[axis];
            if variance > 0.0 { off[axis].powi(2) / variance } else { 0.0 }
        });
        (statistic[0] + statistic[1] > two_degrees()).then(|| {
            let way = now.way - self.here.way;
            ContradictoryMeasurement::ClosedWalk { off: off[0].hypot(off[1]), way }
        })
    }
}
