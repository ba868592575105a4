//! The story of a robot's run, for a person who follows it line by line.

use std::io::{self, Write};

/// Writes the story to the terminal, if wanted, and keeps its text.
pub(super) struct StoryLines<'o> {
    out: Option<&'o mut dyn Write>,
    text: String,
}

impl<'o> StoryLines<'o> {
    pub(super) fn new(out: Option<&'o mut dyn Write>) -> Self {
        Self { out, text: String::new() }
    }

    /// The text so far; its last line may be incomplete.
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    pub(super) fn into_text(self) -> String {
        self.text
    }
}

impl Write for StoryLines<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.text += &String::from_utf8_lossy(bytes);
        if let Some(out) = &mut self.out {
            out.write_all(bytes)?;
            if bytes.ends_with(b"\n") {
                out.flush()?;
            }
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.as_mut().map_or(Ok(()), Write::flush)
    }
}
