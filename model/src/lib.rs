//! The executable specification of deterministic topological SLAM, after Wang, Jenkin and Dymond,
//! "Deterministic Topological Visual SLAM".
//!
//! The modules, bottom up. Each imports only from those above it in this list:
//!
//! * [`counts`]: numbers and counts in messages;
//! * [`embedded_graph`]: darts, `opposite`, `clockwise` (Section 2.1);
//! * [`percept`]: degrees, doors, sightings, door sequences (Section 2.1);
//! * [`isomorphism`]: codes of starts, canonical forms, bijections as witnesses;
//! * [`enumerate`]: every start and every world of a size, once;
//! * [`folding`]: what a walk proves about its world;
//! * [`marker`]: what each kind of fixed marker adds to a percept (Sections 2.2, 2.3);
//! * [`aid`]: marking aids that move: markers to carry, a string, other robots; and other senses;
//! * [`driving`]: scenes, junction estimates and Algorithm 2 (Sections 3 and 4);
//! * [`floor_plan`]: hallways with geometry (Section 2.4);
//! * [`world`]: the trait with everything that a robot can sense and do;
//! * [`format`](mod@format): world files, plantri's codes, DOT: bytes in, types out;
//! * [`ambiguity`]: worlds that a marker does not distinguish, with witnesses (Section 2.2);
//! * [`measurement`]: lengths and turns of hallways by odometry, which contradict each other or not;
//! * [`mapping`]: Algorithm 1, the movable marker algorithm, and their parts (Section 2.3);
//! * [`check`]: runs an algorithm, or any explorer, on every start, and judges the maps;
//! * [`trace`]: checks recorded explorations;
//! * [`visits`]: judges visits that views do not decide;
//! * [`proof`]: proofs of verdicts, which a verified checker confirms.
//!
//! ```
//! use toposlam_model::{
//!     embedded_graph::{Dart, EmbeddedGraph},
//!     mapping::{Algorithm1Run, explore},
//!     world::GraphWorld,
//! };
//!
//! // A triangle with a tail, each vertex with its neighbours in clockwise order.
//! let graph = EmbeddedGraph::from_neighbour_lists(&[
//!     ("end", vec!["a"]),
//!     ("a", vec!["end", "b", "c"]),
//!     ("b", vec!["a", "c"]),
//!     ("c", vec!["b", "a"]),
//! ])?;
//! let mut world = GraphWorld::new(&graph, Dart(0));
//! let mut exploration = Algorithm1Run::default();
//! explore(&mut exploration, &mut world)?;
//! assert_eq!(exploration.moves(), 5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod aid;
pub mod ambiguity;
pub mod check;
mod clone_in_place;
pub mod counts;
mod direction;
pub mod driving;
pub mod embedded_graph;
pub mod enumerate;
pub mod floor_plan;
pub mod folding;
pub mod format;
mod injected_flaw;
pub mod isomorphism;
pub mod mapping;
pub mod marker;
pub mod measurement;
pub mod percept;
pub mod proof;
mod similar;
pub mod trace;
pub mod visits;
mod words;
pub mod world;

#[cfg(test)]
mod any_graph;
