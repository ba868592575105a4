//! Ground views drawn from geometry, for tests: floor in rectangles, a tape along its border.

use std::f64::consts::TAU;

use crate::{
    boundary::{Bearings, Boundary},
    cluster::clusters,
    colour::{PixelClass, Stripe, StripeKind},
    ground_view::GroundView,
    line::lines,
    wall::{WallFrame, WallSegment},
};

/// The floor of a place: rectangles along the axes, in metres.
pub(crate) struct DrawnPlace {
    pub(crate) floor: Vec<[f64; 4]>,
}

/// The width of the tape along the walls, in metres.
pub(crate) const TAPE: f64 = 0.05;
pub(crate) const STRIPE: Stripe = Stripe { kind: StripeKind::OnFloor, width: TAPE };

pub(crate) fn bearings() -> Bearings {
    Bearings::new(STRIPE, 1.05)
}

/// The walls within a boundary.
pub(crate) fn walls(boundary: &Boundary) -> Option<(WallFrame, Vec<WallSegment>)> {
    let lines = lines(&clusters(boundary));
    let frame = WallFrame::fit(&lines)?;
    Some((frame, frame.walls(&lines)))
}

impl DrawnPlace {
    /// A junction at the origin with arms in some of the four directions, counter-clockwise from x.
    pub(crate) fn junction(doors: [bool; 4], half: f64) -> Self {
        let mut floor = vec![[-half, -half, half, half]];
        let arms = [
            [0.0, -half, 9.0, half],
            [-half, 0.0, half, 9.0],
            [-9.0, -half, 0.0, half],
            [-half, -9.0, half, 0.0],
        ];
        floor.extend(arms.iter().zip(doors).filter(|(_, door)| *door).map(|(&arm, _)| arm));
        Self { floor }
    }

    fn holds(&self, [x, y]: [f64; 2], margin: f64) -> bool {
        self.floor.iter().any(|[left, low, right, high]| {
            (left - margin..=right + margin).contains(&x)
                && (low - margin..=high + margin).contains(&y)
        })
    }

    /// Whether a point lies on the tape: on the floor, with no floor a tape's width away.
    fn taped(&self, [x, y]: [f64; 2]) -> bool {
        (0..16).any(|part| {
            let (sine, cosine) = (TAU * f64::from(part) / 16.0).sin_cos();
            !self.holds([x + TAPE * cosine, y + TAPE * sine], 0.0)
        })
    }

    pub(crate) fn boundary(&self, position: [f64; 2], heading: f64) -> Boundary {
        bearings().look(&self.seen_from(position, heading))
    }

    pub(crate) fn seen_from(&self, position: [f64; 2], heading: f64) -> GroundView {
        const RAYS: usize = 4 * 720;
        let exits: Vec<f64> = (0..RAYS)
            .map(|ray| {
                let (sine, cosine) = (TAU * ray as f64 / RAYS as f64).sin_cos();
                let at = |range: f64| [position[0] + range * cosine, position[1] + range * sine];
                (0..500)
                    .map(|step| f64::from(step) * 0.01)
                    .find(|&range| !self.holds(at(range), 1e-9))
                    .unwrap_or(5.0)
            })
            .collect();
        let mut view = GroundView::drawn();
        for (index, class) in view.classes.iter_mut().enumerate() {
            let [x, y] = GroundView::ground(index).into();
            let range = x.hypot(y);
            if range < 0.32 {
                continue;
            }
            let angle = y.atan2(x) + heading;
            let ray = (angle.rem_euclid(TAU) / TAU * RAYS as f64) as usize % RAYS;
            let point = [position[0] + range * angle.cos(), position[1] + range * angle.sin()];
            *class = if range > exits[ray] || !self.holds(point, 0.0) {
                PixelClass::Other
            } else if self.taped(point) {
                PixelClass::Stripe
            } else {
                PixelClass::Floor
            };
        }
        view
    }
}
