//! Sensing: from one image of a panoramic camera to a scene. Sections 3 and 5.1.
//!
//! From the ground up:
//!
//! * [`params`](mod@params): the thresholds of all steps;
//! * [`geometry`]: directions and motions, besides what nalgebra has;
//! * [`image_file`]: the image in a PNG or JPEG file;
//! * [`colour`]: floor, stripe, marker or something else, by a Bayes classifier on HSV colours;
//! * [`camera`]: the point of the floor that a pixel shows;
//! * [`ground_view`]: the floor from straight above;
//! * [`boundary`]: the end of the floor on every bearing;
//! * [`cluster`], [`line`](mod@line), [`wall`]: pieces of wall, straight, at right angles to each other;
//! * [`outline`], [`agreement`]: the walls of a hallway or junction, compared with what is seen;
//! * [`hallway`], [`corner`], [`junction`]: what place it is;
//! * [`marker`]: whether the marker is there, and its direction;
//! * [`sensing`]: all of these steps;
//! * [`annotate`]: a picture of each step.
//!
//! And [`laser`]: sensing with a laser scanner; [`place`] and [`visits`]: what both see, and the visits of places.

// Tests compare numbers exactly and list many wrong files.
#![cfg_attr(test, allow(clippy::float_cmp, clippy::too_many_lines))]

pub mod agreement;
pub mod annotate;
pub mod boundary;
pub mod camera;
pub mod cluster;
pub mod colour;
pub mod corner;
mod draw;
pub mod fuzz;
pub mod geometry;
pub mod ground_view;
pub mod hallway;
pub mod image_file;
pub mod junction;
pub mod laser;
mod least_squares;
pub mod line;
pub mod marker;
pub mod outline;
pub mod params;
pub mod place;
pub mod sensing;
pub mod visits;
pub mod wall;

#[cfg(test)]
mod drawn_place;
