//! Sensing: from one image of a panoramic camera to a scene. Sections 3 and 5.1.
//!
//! [`sensing`] has the steps in their order; [`laser`] senses with a laser scanner; [`place`] and [`visits`] are what both
//! see, and the visits of places.
//!
//! The constants of a step stand at the beginning of its file; what users may change for their building is in
//! [`laser::params`]. The paper gives none of them. Lengths are in metres and angles in radians, if nothing else is
//! written. A *bearing* is half a degree, a *step* is one pixel of the ground view along a bearing: 7.5 mm. "A part of" is
//! a number from 0 to 1. The values come from:
//!
//! * **geometry**: the robot, the sensor, the building or the arithmetic gives the value;
//! * **views**: chosen on rendered views, where it meets the targets of `evaluate vision` (`docs/sensing.md`);
//! * **logs**, **simulated buildings**: as in [`laser::params`].

// Tests compare numbers exactly and list many wrong files.
#![cfg_attr(test, allow(clippy::float_cmp, clippy::too_many_lines))]

pub mod agreement;
pub mod annotate;
pub mod bearing;
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
