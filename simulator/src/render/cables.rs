//! Cables on the floor of a building.

use std::f64::consts::{PI, TAU};

use rand::{Rng, RngExt, seq::IndexedRandom};
use toposlam_model::floor_plan::Rectangle;

use crate::render::{
    random_stream::{StreamPurpose, about, stream},
    squares::Squares,
};

/// Length of a straight piece of a cable, in metres.
const STEP: f64 = 0.15;

/// Reflectances: black, grey and white.
const COLOURS: [[f32; 3]; 4] =
    [[0.012, 0.012, 0.012], [0.030, 0.030, 0.032], [0.160, 0.160, 0.165], [0.620, 0.610, 0.580]];

#[derive(Clone, Copy, Debug)]
struct CablePiece {
    from: [f32; 2],
    to: [f32; 2],
    half: f32,
    colour: [f32; 3],
}

#[derive(Clone, Debug)]
pub(crate) struct Cables(Squares<CablePiece>);

impl Cables {
    /// Cables on these floors, `per_floor` on each 10 m.
    pub(crate) fn new(floors: &[Rectangle], per_floor: f64, seed: u64) -> Self {
        let mut pieces = Vec::new();
        for (number, floor) in floors.iter().enumerate() {
            let mut rng = stream(seed, StreamPurpose::Cables, number);
            let [width, length] = [0, 1].map(|axis| floor.greatest[axis] - floor.least[axis]);
            for _ in 0..about(per_floor * width.max(length) / 10.0, &mut rng) {
                cable(floor, &mut rng, &mut pieces);
            }
        }
        Self(Squares::new(floors, 0.25, pieces, CablePiece::around))
    }

    #[inline]
    pub(crate) fn at(&self, place: [f32; 2]) -> Option<[f32; 3]> {
        if self.0.things().is_empty() {
            return None;
        }
        self.0.at(place).find(|piece| piece.covers(place)).map(|piece| piece.colour)
    }
}

/// Lays a cable on a floor: it begins anywhere, bends at random, and ends at the floor's border or after
/// some metres.
fn cable(floor: &Rectangle, rng: &mut impl Rng, pieces: &mut Vec<CablePiece>) {
    let mut at = [0, 1].map(|axis| rng.random_range(floor.least[axis]..=floor.greatest[axis]));
    let mut heading = rng.random_range(0.0..TAU);
    let half = rng.random_range(0.004..=0.012) as f32;
    let colour = COLOURS.choose(rng).copied().unwrap_or_default();
    let mut bend: f64 = 0.0;
    for _ in 0..rng.random_range(8..=24) {
        bend = (bend + rng.random_range(-0.25..=0.25)).clamp(-0.5, 0.5);
        heading = (heading + bend) % (2.0 * PI);
        let next = [at[0] + STEP * heading.cos(), at[1] + STEP * heading.sin()];
        if !floor.holds(next) {
            break;
        }
        let [from, to] = [at, next].map(|place| place.map(|coordinate| coordinate as f32));
        pieces.push(CablePiece { from, to, half, colour });
        at = next;
    }
}

impl CablePiece {
    fn around(&self) -> Rectangle {
        let [from, to] = [self.from, self.to].map(|end| end.map(f64::from));
        Rectangle::around(from, to).widened(self.half.into())
    }

    #[inline]
    fn covers(&self, place: [f32; 2]) -> bool {
        let along = [0, 1].map(|axis| self.to[axis] - self.from[axis]);
        let off = [0, 1].map(|axis| place[axis] - self.from[axis]);
        let length = along[0] * along[0] + along[1] * along[1];
        let share = ((off[0] * along[0] + off[1] * along[1]) / length.max(1e-12)).clamp(0.0, 1.0);
        let [x, y] = [0, 1].map(|axis| off[axis] - share * along[axis]);
        x * x + y * y <= self.half * self.half
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cable_covers_a_narrow_strip_of_the_floor() {
        let floor = Rectangle { least: [0.0, 0.0], greatest: [10.0, 1.6] };
        let cables = Cables::new(&[floor], 4.0, 1);
        let pieces = cables.0.things();
        assert!(pieces.len() > 10, "{}", pieces.len());
        let inside = |end: [f32; 2]| floor.holds(end.map(f64::from));
        assert!(pieces.iter().all(|piece| inside(piece.from) && inside(piece.to)));
        let places = (0..2000).flat_map(|x| (0..320).map(move |y| [x, y]));
        let covered = places
            .filter(|place| cables.at(place.map(|at| (at as f32 + 0.5) * 0.005)).is_some())
            .count() as f32
            * 0.005
            * 0.005;
        let area: f32 = pieces.iter().map(|piece| 2.0 * piece.half * STEP as f32).sum();
        // Pieces of a cable overlap, and so do cables.
        assert!((0.7..1.1).contains(&(covered / area)), "{covered} {area}");
        assert!(Cables::new(&[floor], 0.0, 1).at([1.0, 1.0]).is_none());
    }
}
