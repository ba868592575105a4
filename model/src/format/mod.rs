//! Files of worlds: bytes in, types out, and back.

pub mod document;
pub mod dot;
pub mod named_world;
pub mod plantri;
pub mod world_file;
