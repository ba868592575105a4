//! Mapping a world with markers: Algorithm 1 and what it stands on. Section 2.3.

mod algorithm1;
mod choices;
mod contradiction;
mod exploration;
mod partial_map;
mod story;
mod tree;

pub use algorithm1::{Verdict, map_world, try_path};
pub use choices::{Choices, Nearest};
pub use contradiction::{Contradiction, MappingError};
pub use exploration::{DEFAULT_DART_BOUND, Exploration};
pub use partial_map::{FACING, PartialMap};
pub use story::{Event, Observer};
