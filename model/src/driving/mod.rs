//! Driving: scenes, the estimate of a junction, and Algorithm 2. Sections 3 and 4.

pub mod algorithm2;
pub mod odometry;
pub mod pose;
pub mod scene;
pub mod visit;
