//! Text for people that a page, a terminal and other programs show: sentences in wrapped lines, counts.

use std::{
    borrow::Cow,
    io::{self, IsTerminal, Write},
    sync::LazyLock,
};

use textwrap::{Options, WordSplitter, core::display_width};

pub use toposlam_model::counts::{counted, vertices};

/// The widest line that is printed: the terminal's width, and at most 80 columns.
pub static WIDTH: LazyLock<usize> = LazyLock::new(|| {
    let terminal = io::stdout().is_terminal().then(terminal_size::terminal_size).flatten();
    terminal.map_or(MAX_WIDTH, |(width, _)| readable(width.0))
});

/// The width of the text on a terminal of this width.
pub fn readable(terminal: u16) -> usize {
    usize::from(terminal).clamp(MIN_WIDTH, MAX_WIDTH)
}

const MAX_WIDTH: usize = 80;
/// Narrower text is not readable.
const MIN_WIDTH: usize = 40;

/// Prints a text after its head. The lines that follow are indented as far as the head is wide.
///
/// # Errors
/// Returns the error of the output.
pub fn print_hanging(out: &mut dyn Write, head: &str, text: &str) -> io::Result<()> {
    print_indented(out, head, display_width(head), text)
}

/// Prints a text after its head. The lines that follow are indented by `indent` columns.
///
/// # Errors
/// Returns the error of the output.
pub fn print_indented(
    out: &mut dyn Write,
    head: &str,
    indent: usize,
    text: &str,
) -> io::Result<()> {
    for line in wrapped(*WIDTH, head, indent, text) {
        writeln!(out, "{}", line.trim_end())?;
    }
    Ok(())
}

/// The lines of a text after its head, none wider than `width` columns if its words are not.
pub fn wrapped(width: usize, head: &str, indent: usize, text: &str) -> Vec<String> {
    if text.is_empty() {
        return vec![head.to_owned()];
    }
    let indent = " ".repeat(indent);
    let options = Options::new(width)
        .initial_indent(head)
        .subsequent_indent(&indent)
        .break_words(false)
        .word_splitter(WordSplitter::NoHyphenation);
    textwrap::wrap(text, options).into_iter().map(Cow::into_owned).collect()
}

/// Prints a paragraph.
///
/// # Errors
/// Returns the error of the output.
pub fn print_paragraph(out: &mut dyn Write, text: &str) -> io::Result<()> {
    print_indented(out, "", 0, text)
}
