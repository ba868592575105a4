//! The SuperScout robot: a simulated building that its camera sees, and what sensing makes of the images,
//! judged against the floor plan. Sections 2.4, 2.5 and 6.

// Tests state numbers as they are.
#![cfg_attr(test, allow(clippy::float_cmp))]

pub mod evaluation;
pub mod simulator;
