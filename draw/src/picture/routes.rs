//! The choice of a curve for each edge: of several that leave through the right doors, one that is short
//! and smooth, clear of discs, and has few crossings.

use super::{
    curves::Curve,
    geometry::{Extent, Point, crossing, wrapped},
    size::DrawingSize,
    ways::{Discs, UnroutedEdge},
};

/// The most edges for which every curve is compared with every other.
const WEIGHED: usize = 200;
/// The number of times that every edge may choose again.
const ROUNDS: usize = 4;

/// Whether a drawing without crossings exists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Crossings {
    /// The layout has none.
    Needless,
    /// Some edges have to cross.
    Needed,
}

/// A curve for each edge.
pub(super) fn routes(
    edge_routes: &[UnroutedEdge],
    centres: &[Point],
    size: &DrawingSize,
    crossings: Crossings,
) -> Vec<Curve> {
    let room = Room {
        crossing: match crossings {
            Crossings::Needed => 1.6,
            Crossings::Needless => 40.0,
        },
        discs: Discs { centres, size },
    };
    let mut chosen: Vec<Curve> = edge_routes.iter().map(|route| room.discs.plain(route)).collect();
    if edge_routes.len() > WEIGHED {
        return chosen;
    }
    let offers: Vec<Vec<(f64, Curve)>> = edge_routes
        .iter()
        .map(|route| {
            room.discs
                .candidates(route)
                .into_iter()
                .map(|curve| (room.cost_alone(route, &curve), curve))
                .collect()
        })
        .collect();
    for _ in 0..ROUNDS {
        let mut changed = false;
        for edge in 0..edge_routes.len() {
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

pub(super) fn crossings(one: &Curve, other: &Curve) -> Vec<Point> {
    let mut places = Vec::new();
    if !one.extent.meets(&other.extent) {
        return places;
    }
    for a in one.trace.windows(2) {
        let step = Extent::from_points([a[0], a[1]]);
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
    discs: Discs<'a>,
}

impl Room<'_> {
    fn cost_alone(&self, route: &UnroutedEdge, curve: &Curve) -> f64 {
        let base = self.discs.size.base;
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
        let doors = self.discs.doors(route);
        for (vertex, &centre) in self.discs.centres.iter().enumerate() {
            let clear = self.discs.size.discs[vertex] + self.discs.size.knob + 0.3 * base;
            if !Extent::around(centre, clear, clear).meets(&curve.extent) {
                continue;
            }
            let own = |point: Point| {
                (0..2).any(|end| {
                    route.vertices[end] == vertex
                        && point.distance(doors[end].at) < self.discs.size.knob + 0.45 * base
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

    /// The cost of a curve because of another.
    fn cost_against(&self, curve: &Curve, other: &Curve) -> f64 {
        let near = 0.36 * self.discs.size.base;
        if !curve.extent.widened(near).meets(&other.extent) {
            return 0.0;
        }
        let mut cost = 0.0;
        for place in crossings(curve, other) {
            cost += self.crossing;
            for (vertex, &centre) in self.discs.centres.iter().enumerate() {
                let lack = self.discs.size.discs[vertex] + 1.6 * self.discs.size.base
                    - place.distance(centre);
                cost += 1.5 * (lack / self.discs.size.base).max(0.0);
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
