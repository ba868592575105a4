//! Driving: what sensing tells of a place, and what is decided on it. Sections 3 and 4.

pub mod algorithm2;
pub mod odometry;
pub mod scene;
pub mod visit;
