//! Sensing: from one image of a panoramic camera to a scene. Sections 3 and 5.1.
//!
//! From the ground up:
//!
//! * [`image_file`]: the image of a PNG or JPEG file;
//! * [`colour`]: floor, stripe, marker or something else, by a Bayes classifier on HSV colours;
//! * [`camera`]: which point of the floor a pixel shows;
//! * [`ground_view`]: the floor from straight above;
//! * [`boundary`]: where the floor ends at a wall, on every bearing;
//! * [`cluster`], [`line`](mod@line), [`wall`]: pieces of wall, straight, and at right angles to each other;
//! * [`outline`], [`agreement`]: a place of a given form, held against what is seen;
//! * [`hallway`], [`corner`], [`junction`]: what place it is;
//! * [`marker`]: whether the marker is there, and along which hallway it lies;
//! * [`sensing`]: all of it;
//! * [`annotate`]: a picture of each step.

// Tests state numbers as they are, and list at length what is wrong with a file.
#![cfg_attr(test, allow(clippy::float_cmp, clippy::too_many_lines))]

pub mod agreement;
pub mod annotate;
pub mod boundary;
pub mod camera;
pub mod cluster;
pub mod colour;
pub mod corner;
pub mod fuzz;
pub mod ground_view;
pub mod hallway;
pub mod image_file;
pub mod junction;
pub mod line;
pub mod marker;
pub mod outline;
pub mod params;
pub mod sensing;
pub mod wall;

#[cfg(test)]
mod drawn;
