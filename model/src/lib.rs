//! The executable specification of deterministic topological SLAM, after Wang, Jenkin and Dymond,
//! "Deterministic Topological Visual SLAM".
//!
//! From the ground up, each room importing only from those above it in this list:
//!
//! * [`embedded_graph`]: darts, `opposite`, `clockwise` (Section 2.1);
//! * [`percept`]: degrees, doors, sightings, door sequences (Section 2.1);
//! * [`floor_plan`]: hallways with geometry (Section 2.4);
//! * [`format`](mod@format): world files, plantri's codes, DOT: bytes in, types out.

pub mod embedded_graph;
pub mod floor_plan;
pub mod format;
pub mod percept;
