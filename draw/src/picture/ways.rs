//! The curves that an edge may take: all leave through its own doors, straight on, in bows, around
//! discs, or as petals.

use std::f64::consts::TAU;

use super::{
    curves::{Curve, DoorKnob},
    geometry::{Point, turn, wrapped},
    size::DrawingSize,
};

/// An edge that needs a curve.
#[derive(Clone, Debug)]
pub(super) struct UnroutedEdge {
    /// The vertices at its ends.
    pub(super) vertices: [usize; 2],
    /// The directions of its doors.
    pub(super) directions: [f64; 2],
    /// The bends that the layout gave it.
    pub(super) bends: Vec<Point>,
}

/// The discs between which the edges run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Discs<'a> {
    /// The middle of each.
    pub(super) centres: &'a [Point],
    pub(super) size: &'a DrawingSize,
}

impl Discs<'_> {
    pub(super) fn doors(&self, edge: &UnroutedEdge) -> [DoorKnob; 2] {
        [0, 1].map(|end| {
            let vertex = edge.vertices[end];
            DoorKnob::new(self.centres[vertex], self.size.discs[vertex], edge.directions[end])
        })
    }

    pub(super) fn plain(&self, edge: &UnroutedEdge) -> Curve {
        let [from, to] = self.doors(edge);
        if edge.vertices[0] == edge.vertices[1] {
            let handle = 3.0 * self.size.discs[edge.vertices[0]];
            return Curve::cubic(from, to, [handle, handle]);
        }
        if edge.bends.is_empty() {
            let handle = from.at.distance(to.at) / 3.0;
            return Curve::cubic(from, to, [handle, handle]);
        }
        Curve::through(from, &edge.bends, to)
    }

    /// The candidates, the plain curve first.
    pub(super) fn candidates(&self, edge: &UnroutedEdge) -> Vec<Curve> {
        let mut curves = vec![self.plain(edge)];
        if !edge.bends.is_empty() {
            let [from, to] = self.doors(edge);
            let middle = (from.at + to.at) * 0.5;
            for stretch in [1.0, 1.15, 1.3, 1.5] {
                let bends = edge.bends.iter();
                let way: Vec<_> = bends.map(|&bend| middle + (bend - middle) * stretch).collect();
                curves.push(Curve::through(from, &way, to));
            }
        }
        if edge.vertices[0] == edge.vertices[1] {
            self.petals(edge, &mut curves);
        } else {
            self.bows(edge, &mut curves);
        }
        curves
    }

    /// Loops: wide and narrow, around either side of the disc.
    fn petals(&self, edge: &UnroutedEdge, curves: &mut Vec<Curve>) {
        let [from, to] = self.doors(edge);
        let vertex = edge.vertices[0];
        let (centre, radius) = (self.centres[vertex], self.size.discs[vertex]);
        let clockwise = turn(edge.directions[0], edge.directions[1]);
        for gap in [clockwise, clockwise - TAU] {
            if gap.abs() < 2.3 {
                for reach in [3.2, 3.7, 4.3, 5.0, 6.0] {
                    let handle = reach * self.size.base;
                    curves.push(Curve::cubic(from, to, [handle, handle]));
                }
            }
            let stops = 1 + (1..5).filter(|&stops| gap.abs() > 1.3 * f64::from(stops)).count();
            for level in [1.7, 2.1, 2.5, 3.1, 3.8, 4.6, 5.6] {
                let way: Vec<_> = (0..stops)
                    .map(|stop| {
                        let share = (stop as f64 + 0.5) / stops as f64;
                        let angle = edge.directions[0] + gap * share;
                        centre + Point::polar(angle, radius + level * self.size.base)
                    })
                    .collect();
                curves.push(Curve::through(from, &way, to));
            }
        }
    }

    /// Edges between two vertices: straight on, in a bow to either side, or around their own discs.
    fn bows(&self, edge: &UnroutedEdge, curves: &mut Vec<Curve>) {
        let [from, to] = self.doors(edge);
        let span = from.at.distance(to.at);
        for one in [0.33, 0.5, 0.75, 1.1] {
            for two in [0.33, 0.5, 0.75, 1.1] {
                let least = 0.8 * self.size.base;
                let handles = [(one * span).max(least), (two * span).max(least)];
                curves.push(Curve::cubic(from, to, handles));
            }
        }
        let along = to.at - from.at;
        for share in [0.3, 0.5, 0.7] {
            for bow in [-1.1, -0.8, -0.55, -0.35, -0.2, 0.2, 0.35, 0.55, 0.8, 1.1] {
                let by = from.at + along * share + along.quarter_turn() * bow;
                curves.push(Curve::through(from, &[by], to));
            }
        }
        let swings = [self.swings(edge, 0), self.swings(edge, 1)];
        for first in &swings[0] {
            for second in &swings[1] {
                let way: Vec<_> = first.iter().chain(second.iter().rev()).copied().collect();
                if !way.is_empty() {
                    curves.push(Curve::through(from, &way, to));
                }
            }
        }
    }

    /// Paths around the disc, for an edge that leaves it in the wrong direction.
    fn swings(&self, edge: &UnroutedEdge, end: usize) -> Vec<Vec<Point>> {
        let vertex = edge.vertices[end];
        let (centre, radius) = (self.centres[vertex], self.size.discs[vertex]);
        let out = edge.directions[end];
        let straight = (self.centres[edge.vertices[1 - end]] - centre).angle();
        let mut ways = vec![Vec::new()];
        let off = wrapped(straight - out).abs();
        if off > 0.7 {
            for side in [-1.0, 1.0] {
                for level in [0.9, 1.3, 1.8] {
                    let at = |angle: f64| {
                        centre + Point::polar(out + side * angle, radius + level * self.size.base)
                    };
                    ways.push(vec![at(0.9)]);
                    if off > 1.6 {
                        ways.push(vec![at(0.7), at(1.7)]);
                    }
                }
            }
        }
        ways
    }
}
