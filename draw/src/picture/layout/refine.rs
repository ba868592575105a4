//! Springs along segments, and room around nodes, segments and corners. Each node moves downhill; if the
//! embedding must be kept, only as far as nothing crosses and no order changes.

use std::f64::consts::TAU;

use super::{
    super::geometry::{Point, crossing, turn},
    subdivision::Subdivision,
};

/// What a move may not change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Keep {
    /// No new crossings; the order around each node stays.
    Embedding,
    /// Anything may change.
    Nothing,
}

/// The budget, in computed distances.
const BUDGET: usize = 60_000_000;

/// Moves the points of the nodes to a better place.
pub(super) fn refine(web: &Subdivision, points: &mut [Point], keep: Keep) {
    let mut field = Field::new(web, points, keep);
    let segments = web.node.len() / 2;
    let work = web.nodes * (web.nodes + 8 * segments) * 6;
    let share = match keep {
        Keep::Embedding => BUDGET,
        Keep::Nothing => BUDGET / 12,
    };
    let sweeps = (share / work.max(1)).clamp(20, 400);
    let mut steps = vec![0.2_f64; web.nodes];
    for _ in 0..sweeps {
        let mut furthest = 0.0_f64;
        for (node, step) in steps.iter_mut().enumerate() {
            let moved = field.improve(node, step);
            furthest = furthest.max(moved);
        }
        if furthest < 1e-7 {
            break;
        }
    }
}

struct Field<'a> {
    web: &'a Subdivision,
    points: &'a mut [Point],
    keep: Keep,
    darts: Vec<Vec<usize>>,
    segments: Vec<(usize, usize)>,
}

impl<'a> Field<'a> {
    fn new(web: &'a Subdivision, points: &'a mut [Point], keep: Keep) -> Self {
        let segments = (0..web.node.len())
            .filter(|&dart| dart < web.opposite[dart])
            .map(|dart| (web.node[dart], web.far(dart)))
            .filter(|(a, b)| a != b)
            .collect();
        Self { darts: web.darts_of_nodes(), web, points, keep, segments }
    }

    /// Moves one node downhill, and returns the distance.
    fn improve(&mut self, node: usize, step: &mut f64) -> f64 {
        const TOUCH: f64 = 1e-5;
        let here = self.points[node];
        let before = self.energy(node);
        let mut at = |dx: f64, dy: f64| {
            self.points[node] = here + Point::new(dx, dy);
            self.energy(node)
        };
        let slope = Point::new(at(TOUCH, 0.0) - at(-TOUCH, 0.0), at(0.0, TOUCH) - at(0.0, -TOUCH));
        let downhill = slope.direction() * -1.0;
        for _ in 0..4 {
            self.points[node] = here + downhill * *step;
            if self.energy(node) < before && self.is_allowed(node) {
                let moved = *step;
                *step = (*step * 1.4).min(0.5);
                return moved;
            }
            *step *= 0.4;
        }
        self.points[node] = here;
        *step = step.max(1e-8);
        0.0
    }

    /// The part of the energy that depends on the node's place.
    fn energy(&self, node: usize) -> f64 {
        let here = self.points[node];
        let weight = |node: usize| if node < self.web.vertices { 1.0 } else { 0.4 };
        let mut energy = 0.0;
        for &dart in &self.darts[node] {
            let length = here.distance(self.points[self.web.far(dart)]);
            let stretch = length - self.web.wish[dart];
            energy += 2.0 * stretch * stretch;
        }
        for (other, &there) in self.points.iter().enumerate() {
            if other != node {
                let distance = here.distance(there).max(1e-6);
                energy += 0.14 * weight(node) * weight(other) / distance;
            }
        }
        for &(a, b) in &self.segments {
            if a != node && b != node {
                energy += crowding(here.distance_to_segment(self.points[a], self.points[b]));
            } else {
                for (other, there) in self.points.iter().enumerate() {
                    if other != a && other != b {
                        let segment = (self.points[a], self.points[b]);
                        energy += crowding(there.distance_to_segment(segment.0, segment.1));
                    }
                }
            }
        }
        if self.keep == Keep::Embedding {
            energy += self.tightness(node);
            for &dart in &self.darts[node] {
                energy += self.tightness(self.web.far(dart));
            }
        }
        energy
    }

    /// The clockwise turns between neighbouring darts of the node.
    fn gaps(&self, node: usize) -> impl Iterator<Item = f64> + '_ {
        let darts = &self.darts[node];
        let angle =
            move |dart: usize| (self.points[self.web.far(dart)] - self.points[node]).angle();
        (0..darts.len()).map(move |at| turn(angle(darts[at]), angle(darts[(at + 1) % darts.len()])))
    }

    /// The lack of room for the doors of the node.
    fn tightness(&self, node: usize) -> f64 {
        if self.darts[node].len() < 2 || node >= self.web.vertices {
            return 0.0;
        }
        let roomy = (TAU / self.darts[node].len() as f64).min(0.9);
        self.gaps(node)
            .map(|gap| {
                let lack = (roomy / gap.max(1e-3) - 1.0).max(0.0);
                0.12 * lack * lack
            })
            .sum()
    }

    /// Whether the required properties hold after the node has moved.
    fn is_allowed(&self, node: usize) -> bool {
        if self.keep == Keep::Nothing {
            return true;
        }
        self.keeps_order(node)
            && self.darts[node].iter().all(|&dart| {
                let far = self.web.far(dart);
                self.keeps_order(far) && self.crosses_nothing(node, far)
            })
    }

    fn keeps_order(&self, node: usize) -> bool {
        if self.darts[node].len() < 3 {
            return true;
        }
        let mut whole = 0.0;
        for gap in self.gaps(node) {
            if gap < 1e-3 {
                return false;
            }
            whole += gap;
        }
        whole < 1.5 * TAU
    }

    fn crosses_nothing(&self, a: usize, b: usize) -> bool {
        self.segments.iter().all(|&(c, d)| {
            let apart = a != c && a != d && b != c && b != d;
            !apart
                || crossing(self.points[a], self.points[b], self.points[c], self.points[d])
                    .is_none()
        })
    }
}

/// The cost of a node that is this far from a segment that is not its own.
fn crowding(distance: f64) -> f64 {
    let lack = (0.55 / distance.max(1e-3) - 1.0).max(0.0);
    0.15 * lack * lack
}
