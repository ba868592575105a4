//! A building, and what the robot's camera sees of it. Section 2.4.

mod pose;

pub use pose::Pose;
