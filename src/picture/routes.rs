//! Which curve each edge takes: of several that leave through the right doors, the one that is
//! short and smooth, clear of discs, and crosses little.

use std::f64::consts::TAU;

use super::{
    curves::{Curve, Door},
    geometry::{Extent, Point, crossing, turn, wrapped},
    size::Size,
};

/// Edges up to which every curve is weighed against every other.
const WEIGHED: usize = 200;
/// How often every edge may choose anew.
const ROUNDS: usize = 4;

/// Whether a drawing without crossings exists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Crossings {
    /// The layout has none.
    Needless,
    /// Some edges have to cross.
    Needed,
}

/// An edge that wants a curve.
#[derive(Clone, Debug)]
pub(super) struct Errand {
    /// The vertices at its ends.
    pub(super) vertices: [usize; 2],
    /// The directions of its doors.
    pub(super) directions: [f64; 2],
    /// The bends that the layout gave it.
    pub(super) bends: Vec<Point>,
}

/// A curve for each edge.
pub(super) fn routes(
    errands: &[Errand],
    centres: &[Point],
    size: &Size,
    crossings: Crossings,
) -> Vec<Curve> {
    let room = Room {
        crossing: match crossings {
            Crossings::Needed => 1.6,
            Crossings::Needless => 40.0,
        },
        centres,
        size,
    };
    let mut chosen: Vec<Curve> = errands.iter().map(|errand| room.plain(errand)).collect();
    if errands.len() > WEIGHED {
        return chosen;
    }
    let offers: Vec<Vec<(f64, Curve)>> = errands
        .iter()
        .map(|errand| {
            room.candidates(errand)
                .into_iter()
                .map(|curve| (room.cost_alone(errand, &curve), curve))
                .collect()
        })
        .collect();
    for _ in 0..ROUNDS {
        let mut changed = false;
        for edge in 0..errands.len() {
            let mut best = (f64::INFINITY, None);
            for (place, (alone, curve)) in offers[edge].iter().enumerate() {
                if *alone >= best.0 {
                    continue;
                }
                let mut cost = *alone;
                for (other, against) in chosen.iter().enumerate() {
                    if other != edge && cost < best.0 {
                        cost += room.cost_against(curve, against);
                    }
                }
                if cost < best.0 - 1e-9 {
                    best = (cost, Some(place));
                }
            }
            if let Some(place) = best.1 {
                let curve = &offers[edge][place].1;
                changed |= chosen[edge].trace != curve.trace;
                chosen[edge] = curve.clone();
            }
        }
        if !changed {
            break;
        }
    }
    chosen
}

/// Where two curves cross.
pub(super) fn crossings(one: &Curve, other: &Curve) -> Vec<Point> {
    let mut places = Vec::new();
    if !one.extent.meets(&other.extent) {
        return places;
    }
    for a in one.trace.windows(2) {
        let step = Extent::of([a[0], a[1]]);
        if !step.meets(&other.extent) {
            continue;
        }
        for b in other.trace.windows(2) {
            places.extend(crossing(a[0], a[1], b[0], b[1]));
        }
    }
    places
}

struct Room<'a> {
    crossing: f64,
    centres: &'a [Point],
    size: &'a Size,
}

impl Room<'_> {
    fn doors(&self, errand: &Errand) -> [Door; 2] {
        [0, 1].map(|end| {
            let vertex = errand.vertices[end];
            Door::new(self.centres[vertex], self.size.discs[vertex], errand.directions[end])
        })
    }

    /// The curve that an edge takes where nothing is weighed.
    fn plain(&self, errand: &Errand) -> Curve {
        let [from, to] = self.doors(errand);
        if errand.vertices[0] == errand.vertices[1] {
            let handle = 3.0 * self.size.discs[errand.vertices[0]];
            return Curve::cubic(from, to, [handle, handle]);
        }
        if errand.bends.is_empty() {
            let handle = from.at.distance(to.at) / 3.0;
            return Curve::cubic(from, to, [handle, handle]);
        }
        Curve::by_way_of(from, &errand.bends, to)
    }

    fn candidates(&self, errand: &Errand) -> Vec<Curve> {
        let mut curves = vec![self.plain(errand)];
        if !errand.bends.is_empty() {
            let [from, to] = self.doors(errand);
            let middle = (from.at + to.at) * 0.5;
            for stretch in [1.0, 1.15, 1.3, 1.5] {
                let bends = errand.bends.iter();
                let way: Vec<_> = bends.map(|&bend| middle + (bend - middle) * stretch).collect();
                curves.push(Curve::by_way_of(from, &way, to));
            }
        }
        if errand.vertices[0] == errand.vertices[1] {
            self.petals(errand, &mut curves);
        } else {
            self.bows(errand, &mut curves);
        }
        curves
    }

    /// Loops: wide and narrow, around either side of the disc.
    fn petals(&self, errand: &Errand, curves: &mut Vec<Curve>) {
        let [from, to] = self.doors(errand);
        let vertex = errand.vertices[0];
        let (centre, radius) = (self.centres[vertex], self.size.discs[vertex]);
        let clockwise = turn(errand.directions[0], errand.directions[1]);
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
                        let angle = errand.directions[0] + gap * share;
                        centre + Point::polar(angle, radius + level * self.size.base)
                    })
                    .collect();
                curves.push(Curve::by_way_of(from, &way, to));
            }
        }
    }

    /// Edges between two vertices: straight on, in a bow to either side, or around their own discs.
    fn bows(&self, errand: &Errand, curves: &mut Vec<Curve>) {
        let [from, to] = self.doors(errand);
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
                curves.push(Curve::by_way_of(from, &[by], to));
            }
        }
        let swings = [self.swings(errand, 0), self.swings(errand, 1)];
        for first in &swings[0] {
            for second in &swings[1] {
                let way: Vec<_> = first.iter().chain(second.iter().rev()).copied().collect();
                if !way.is_empty() {
                    curves.push(Curve::by_way_of(from, &way, to));
                }
            }
        }
    }

    /// Ways around the disc from which the edge leaves in the wrong direction.
    fn swings(&self, errand: &Errand, end: usize) -> Vec<Vec<Point>> {
        let vertex = errand.vertices[end];
        let (centre, radius) = (self.centres[vertex], self.size.discs[vertex]);
        let out = errand.directions[end];
        let straight = (self.centres[errand.vertices[1 - end]] - centre).angle();
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

    /// What a curve costs whatever the others do.
    fn cost_alone(&self, errand: &Errand, curve: &Curve) -> f64 {
        let base = self.size.base;
        let mut cost = 0.16 * curve.length() / base;
        let mut last = None;
        for two in curve.trace.windows(2) {
            let step = two[1] - two[0];
            let length = step.length();
            if length < 1e-9 {
                continue;
            }
            if let Some(before) = last {
                let bend = wrapped(step.angle() - before).abs();
                let radius = length / bend.max(1e-9);
                cost += 0.22 * bend;
                if radius < 0.6 * base {
                    cost += 1.2 * bend * (1.0 - radius / (0.6 * base));
                }
            }
            last = Some(step.angle());
        }
        let doors = self.doors(errand);
        for (vertex, &centre) in self.centres.iter().enumerate() {
            let clear = self.size.discs[vertex] + self.size.knob + 0.3 * base;
            if !Extent::around(centre, clear, clear).meets(&curve.extent) {
                continue;
            }
            let own = |point: Point| {
                (0..2).any(|end| {
                    errand.vertices[end] == vertex
                        && point.distance(doors[end].at) < self.size.knob + 0.45 * base
                        && (point - doors[end].at).dot(doors[end].out) > -0.5
                })
            };
            for &point in &curve.trace {
                let lack = clear - point.distance(centre);
                if lack > 0.0 && !own(point) {
                    cost += 0.5 + 2.5 * lack / base;
                    // Through the disc itself, or a knob: only if there is no other way.
                    if lack > 0.3 * base {
                        cost += 8.0;
                    }
                }
            }
        }
        cost
    }

    /// What a curve costs because of another.
    fn cost_against(&self, curve: &Curve, other: &Curve) -> f64 {
        let near = 0.36 * self.size.base;
        if !curve.extent.widened(near).meets(&other.extent) {
            return 0.0;
        }
        let mut cost = 0.0;
        for place in crossings(curve, other) {
            cost += self.crossing;
            for (vertex, &centre) in self.centres.iter().enumerate() {
                let lack = self.size.discs[vertex] + 1.6 * self.size.base - place.distance(centre);
                cost += 1.5 * (lack / self.size.base).max(0.0);
            }
        }
        for two in curve.trace.windows(2) {
            let middle = (two[0] + two[1]) * 0.5;
            let heading = (two[1] - two[0]).direction();
            for against in other.trace.windows(2) {
                if middle.distance_to_segment(against[0], against[1]) < near {
                    let skew = heading.cross((against[1] - against[0]).direction()).abs();
                    if skew < 0.5 {
                        cost += 0.25 * (0.5 - skew);
                    }
                }
            }
        }
        cost
    }
}
