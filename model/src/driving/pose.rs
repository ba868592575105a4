//! The robot's pose on the floor.

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The robot's centre, in metres, x to the east and y to the north.
    pub position: [f64; 2],
    /// Radians counter-clockwise from east.
    pub heading: f64,
}
