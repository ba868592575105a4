//! Standard error: remarks, errors, and their colours.
//!
//! `--quiet` leaves out remarks and progress. The environment (`NO_COLOR`, `CLICOLOR`, `CLICOLOR_FORCE`) decides on
//! colours, and whether standard error is a terminal. On a terminal the lines are wrapped; in a file or a pipe each remark
//! and each error stays on one line.

use std::{
    fmt::Display,
    io::{self, Write},
    sync::{
        LazyLock,
        atomic::{AtomicBool, Ordering},
    },
};

use anstream::AutoStream;
use clap::builder::Styles;

use toposlam_draw::text::{readable, wrapped};

use super::text::printable;

/// Options of every verb.
#[derive(clap::Args)]
pub struct TerminalOptions {
    /// Print no progress and no remarks on standard error, only errors
    #[arg(short, long, global = true, display_order = 900)]
    quiet: bool,
}

static QUIET: AtomicBool = AtomicBool::new(false);

impl TerminalOptions {
    pub fn apply(&self) {
        QUIET.store(self.quiet, Ordering::Relaxed);
    }
}

pub fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

pub fn has_colors() -> bool {
    AutoStream::choice(&io::stderr()) != anstream::ColorChoice::Never
}

/// Prints a remark on standard error, unless `--quiet` is given.
pub fn remark(text: impl Display) {
    if !is_quiet() {
        print_message(&message_lines(*WIDTH, &printable(&text.to_string())));
    }
}

pub fn error(message: &str) {
    const LABEL: &str = "error:";
    let style = Styles::styled();
    let style = style.get_error();
    let lines = message_lines(*WIDTH, &format!("{LABEL} {}", printable(message)));
    print_message(&lines.replacen(LABEL, &format!("{style}{LABEL}{style:#}"), 1));
}

/// The width of standard error, if it is a terminal.
static WIDTH: LazyLock<Option<usize>> = LazyLock::new(|| {
    terminal_size::terminal_size_of(io::stderr()).map(|(width, _)| readable(width.0))
});

/// The lines of a message. With a width, long ones are wrapped.
fn message_lines(width: Option<usize>, message: &str) -> String {
    let Some(width) = width else { return format!("{message}\n") };
    let lines = message.lines().flat_map(|line| {
        let text = line.trim_start();
        let indent = line.len() - text.len();
        wrapped(width, &line[..indent], indent, text)
    });
    lines.map(|line| line + "\n").collect()
}

/// Prints on standard error, also with `--quiet`. If that is closed, there is nobody to read it.
pub fn print_message(text: &str) {
    let _ = anstream::stderr().write_all(text.as_bytes());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_is_wrapped_on_a_terminal_only() {
        let message = "run.txt: this is not a log\n  known are bags and MCAP files";
        assert_eq!(message_lines(None, message), format!("{message}\n"));
        let lines = message_lines(Some(20), message);
        let expected = "run.txt: this is not\na log\n  known are bags and\n  MCAP files\n";
        assert_eq!(lines, expected);
    }
}
