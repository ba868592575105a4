//! Sources of bytes with random access.

use std::io::{Read, Seek};

/// A source of bytes.
pub trait Storage: Read + Seek + Send {}

impl<S: Read + Seek + Send> Storage for S {}
