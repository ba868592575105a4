//! The output of `--json`: one object a line. `docs/schema` describes each kind of line.

use std::io::{self, Write};

use serde::Serialize;
use toposlam_logs::error::Truncation;

use super::CliError;

const SCHEMA: u32 = 1;

/// A line: its version, its kind and its content.
#[derive(Serialize)]
struct VersionedLine<'c, C> {
    schema: u32,
    kind: &'static str,
    #[serde(flatten)]
    content: &'c C,
}

/// Prints an object on a line of its own, after its version and its kind.
pub fn print_line(
    out: &mut dyn Write,
    kind: &'static str,
    content: &impl Serialize,
) -> Result<(), CliError> {
    let line = VersionedLine { schema: SCHEMA, kind, content };
    let line = serde_json::to_string(&line).map_err(io::Error::from)?;
    Ok(writeln!(out, "{line}")?)
}

/// Where a log ends before its end.
#[derive(Serialize)]
pub struct TruncatedLine {
    offset: u64,
    cause: String,
}

impl From<&Truncation> for TruncatedLine {
    fn from(found: &Truncation) -> Self {
        Self { offset: found.offset, cause: found.cause.to_string() }
    }
}

/// One of several inputs that could not be used.
#[derive(Serialize)]
struct UnreadLine<'f> {
    file: &'f str,
    cause: &'f str,
}

/// Prints that one of several inputs could not be used.
pub fn print_unread(out: &mut dyn Write, file: &str, cause: &str) -> Result<(), CliError> {
    print_line(out, "unread", &UnreadLine { file, cause })
}
