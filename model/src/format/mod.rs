//! Files of worlds: bytes in, types out, and back.

pub mod dot;
pub mod named_world;
pub mod place;
pub mod plantri;
pub mod world_file;
