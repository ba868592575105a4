//! The four directions of hallways. Section 2.4.

use std::fmt;

/// The largest difference between equal lengths, in metres.
pub(crate) const TOLERANCE: f64 = 1e-6;

/// Where a door of a junction leads, in clockwise order from north.
// paper: env.right-angles
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Direction {
    North,
    East,
    South,
    West,
}

impl Direction {
    /// All four, clockwise from north.
    pub const ALL: [Self; 4] = [Self::North, Self::East, Self::South, Self::West];

    /// The direction so many right angles further clockwise.
    #[must_use]
    pub fn turned(self, right_angles: u32) -> Self {
        Self::ALL[(self as usize + right_angles as usize % 4) % 4]
    }

    #[must_use]
    pub fn reversed(self) -> Self {
        self.turned(2)
    }

    /// How many right angles clockwise another direction is: from 0 to 3.
    #[must_use]
    pub fn right_angles_to(self, other: Self) -> u32 {
        (other as u32 + 4 - self as u32) % 4
    }

    /// The unit vector, x to the east and y to the north.
    pub fn vector(self) -> [f64; 2] {
        match self {
            Self::North => [0.0, 1.0],
            Self::East => [1.0, 0.0],
            Self::South => [0.0, -1.0],
            Self::West => [-1.0, 0.0],
        }
    }

    /// The direction from one position to another; `None` if it is not along an axis.
    pub fn between(from: [f64; 2], to: [f64; 2]) -> Option<Self> {
        let [x, y] = [to[0] - from[0], to[1] - from[1]];
        match (x.abs() <= TOLERANCE, y.abs() <= TOLERANCE) {
            (true, false) if y > 0.0 => Some(Self::North),
            (true, false) => Some(Self::South),
            (false, true) if x > 0.0 => Some(Self::East),
            (false, true) => Some(Self::West),
            _ => None,
        }
    }
}

/// `north`, `east`, `south` or `west`.
impl fmt::Display for Direction {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        out.write_str(match self {
            Self::North => "north",
            Self::East => "east",
            Self::South => "south",
            Self::West => "west",
        })
    }
}
