//! Dark furniture that fills parts of the view just inside of the mirror's rim.

use std::f32::consts::TAU;

use rand::{RngExt, seq::SliceRandom};

use crate::render::{
    random_stream::{StreamPurpose, stream},
    rig::WorldRay,
};

/// The number of directions in which there is furniture or none.
const CELLS: usize = 24;

/// The most neighbouring directions with the same piece of furniture.
const WIDEST: usize = 4;

/// Height of the lower edge of the furniture over its distance, seen from the mirror.
const SLOPES: std::ops::RangeInclusive<f32> = -0.3..=0.8;

const SHADES: std::ops::RangeInclusive<f32> = 0.003..=0.010;

/// Tall dark furniture around the robot, by direction: all that is seen above its lower edge is dark.
#[derive(Clone, Debug)]
pub(crate) struct Overhead {
    /// Empty without furniture.
    cells: Vec<Option<OverheadPiece>>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct OverheadPiece {
    /// A number that is different for different pieces.
    pub(crate) number: u32,
    /// The direction in which its front faces the robot, counter-clockwise from east, in radians.
    middle: f32,
    slope: f32,
    shade: f32,
}

impl OverheadPiece {
    pub(crate) fn colour(&self) -> [f32; 3] {
        [1.1, 1.0, 0.9].map(|channel| channel * self.shade)
    }
}

impl Overhead {
    /// Furniture in this share of all directions.
    pub(crate) fn new(share: f64, seed: u64) -> Self {
        let dark = (share * CELLS as f64).round() as usize;
        if dark == 0 {
            return Self { cells: Vec::new() };
        }
        let mut rng = stream(seed, StreamPurpose::Overhead, 0);
        let mut starts: Vec<usize> = (0..CELLS).collect();
        starts.shuffle(&mut rng);
        let mut cells = vec![None; CELLS];
        let mut left = dark;
        for (number, start) in starts.into_iter().enumerate() {
            let width = rng.random_range(1..=WIDEST).min(left);
            let direction = (start as f32 + width as f32 / 2.0) / CELLS as f32 * TAU;
            let piece = OverheadPiece {
                number: number as u32,
                middle: direction,
                slope: rng.random_range(SLOPES),
                shade: rng.random_range(SHADES),
            };
            for cell in start..start + width {
                let cell = &mut cells[cell % CELLS];
                if cell.is_none() {
                    *cell = Some(piece);
                    left -= 1;
                }
            }
        }
        Self { cells }
    }

    #[inline]
    pub(crate) fn met(&self, ray: &WorldRay) -> Option<&OverheadPiece> {
        let [x, y, up] = ray.direction;
        let piece = self.cells.get(usize::from(ray.turn) * CELLS / 65_536)?.as_ref()?;
        let towards = x * piece.middle.cos() + y * piece.middle.sin();
        (up > piece.slope * towards).then_some(piece)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_furniture_fills_its_share_of_all_directions_above_its_lower_edge() {
        for seed in 0..20 {
            for (share, cells) in [(0.0, 0), (0.25, 6), (0.6, 14), (1.0, 24)] {
                let overhead = Overhead::new(share, seed);
                let ray = |turn: u16, up: f32| {
                    let angle = f32::from(turn) / 65_536.0 * TAU;
                    let direction = [angle.cos(), angle.sin(), up];
                    WorldRay { origin: [0.0, 0.0, 1.0], direction, turn }
                };
                let met = |up: f32| {
                    (0..CELLS)
                        .filter(|cell| {
                            let turn = (*cell as u16 * 2 + 1) * (65_536 / CELLS / 2) as u16;
                            overhead.met(&ray(turn, up)).is_some()
                        })
                        .count()
                };
                // Near the rim, and on the floor up to 3 m away.
                assert_eq!([met(2.7), met(-0.35)], [cells, 0], "{seed} {share}");
            }
        }
    }
}
