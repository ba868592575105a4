//! Sensing: from one image of a panoramic camera to a scene. Sections 3 and 5.1.
//!
//! From the ground up:
//!
//! * [`colour`]: floor, stripe, marker or something else, by a Bayes classifier on HSV colours;
//! * [`camera`]: which point of the floor a pixel shows;
//! * [`ground_view`]: the floor from straight above.

pub mod camera;
pub mod colour;
pub mod ground_view;
