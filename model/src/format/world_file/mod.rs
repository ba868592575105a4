//! World files, in TOML and in JSON of the same shape. The embedded graph is given by neighbours
//! (`[clockwise]`), by edges (`[doors]`), or by a floor plan (`[floor]`, `[junctions]`,
//! `[[hallways]]`), and the robot's start by `[start]`. Sections 2.1 and 2.4.

mod error;
mod read;
mod write;

pub use error::{WorldFileError, WorldFileErrorKind};
pub use read::{is_name, read};
pub use write::{to_json, to_json_text, to_toml};

#[cfg(test)]
mod tests;
