//! The executable specification of deterministic topological SLAM, after Wang, Jenkin and Dymond,
//! "Deterministic Topological Visual SLAM".
//!
//! From the ground up, each room importing only from those above it in this list:
//!
//! * [`embedded_graph`]: darts, `opposite`, `clockwise` (Section 2.1);
//! * [`percept`]: degrees, doors, sightings, door sequences (Section 2.1);
//! * [`isomorphism`]: codes of starts, canonical forms, bijections as witnesses;
//! * [`marker`]: what a marker adds to a percept (Sections 2.2, 2.3);
//! * [`floor_plan`]: hallways with geometry (Section 2.4);
//! * [`world`]: the trait that is all that a robot can sense and do;
//! * [`mapping`]: Algorithm 1, and what it stands on (Section 2.3);
//! * [`format`](mod@format): world files, plantri's codes, DOT: bytes in, types out.

pub mod check;
pub mod embedded_graph;
pub mod enumerate;
pub mod floor_plan;
pub mod format;
pub mod isomorphism;
pub mod mapping;
pub mod marker;
pub mod percept;
pub mod world;

#[cfg(test)]
mod any_graph;
