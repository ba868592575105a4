//! Driving: scenes, the estimate of a junction, and Algorithm 2. Sections 3 and 4.

pub mod algorithm2;
pub mod odometry;
pub mod pose;
pub mod scene;
pub mod visit;

/// A robot of a team that waits stands in the hallway by which it came, this far from the turning point, in metres: so
/// another one sees along which door it stands.
pub const WAITING: f64 = 0.5;
