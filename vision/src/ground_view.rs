//! The floor from straight above. Section 3, Figure 6(c).

use crate::colour::Class;

/// What the floor around the robot shows, seen from straight above: the robot in the middle, ahead up,
/// left to the left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GroundView {
    /// Rows from ahead to behind, in each from left to right.
    pub classes: Vec<Class>,
}

impl GroundView {
    /// Pixels a side.
    pub const SIDE: usize = 800;
    /// Metres a pixel.
    pub const SCALE: f64 = 0.0075;
}
