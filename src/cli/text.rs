//! Text for people: numbers, sentences, wrapped lines and tables.

use std::{
    borrow::Cow,
    io::{self, IsTerminal, Write},
    sync::LazyLock,
};

use textwrap::{Options, WordSplitter};

/// The widest line that is printed: the terminal's width, and at most 80 columns.
static WIDTH: LazyLock<usize> = LazyLock::new(|| {
    let terminal = io::stdout().is_terminal().then(terminal_size::terminal_size).flatten();
    terminal.map_or(MAX_WIDTH, |(width, _)| usize::from(width.0).clamp(MIN_WIDTH, MAX_WIDTH))
});

const MAX_WIDTH: usize = 80;
/// Narrower text is not readable.
const MIN_WIDTH: usize = 40;

/// Prints a text after its head. The lines that follow are indented as far as the head is wide.
pub(super) fn print_hanging(out: &mut dyn Write, head: &str, text: &str) -> io::Result<()> {
    print_indented(out, head, head.chars().count(), text)
}

/// Prints a text after its head. The lines that follow are indented by `indent` columns.
pub(super) fn print_indented(
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

/// Prints a command. A line that is too long continues after a backslash, as in a shell.
pub(super) fn print_command(out: &mut dyn Write, head: &str, command: &str) -> io::Result<()> {
    let lines = wrapped(*WIDTH - 2, head, head.chars().count() + 2, command);
    writeln!(out, "{}", lines.join(" \\\n"))
}

fn wrapped(width: usize, head: &str, indent: usize, text: &str) -> Vec<String> {
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
pub(super) fn print_paragraph(out: &mut dyn Write, text: &str) -> io::Result<()> {
    print_indented(out, "", 0, text)
}

/// Prints short texts in columns, row by row, each line indented by two columns.
pub(super) fn print_columns(out: &mut dyn Write, texts: &[String]) -> io::Result<()> {
    let widest = texts.iter().map(|text| text.chars().count()).max().unwrap_or_default();
    for row in texts.chunks((*WIDTH / (widest + 2)).max(1)) {
        let row: Vec<_> = row.iter().map(|text| format!("  {text:widest$}")).collect();
        writeln!(out, "{}", row.concat().trim_end())?;
    }
    Ok(())
}

/// Prints rows below their heads. Each column is as wide as its widest cell; the last one is wrapped.
pub(super) fn print_rows<const COLUMNS: usize>(
    out: &mut dyn Write,
    heads: [&str; COLUMNS],
    rows: &[[String; COLUMNS]],
) -> io::Result<()> {
    let widths: [_; COLUMNS] = std::array::from_fn(|column| {
        let texts = rows.iter().map(|row| row[column].chars().count());
        texts.chain([heads[column].chars().count()]).max().unwrap_or_default()
    });
    let heads = heads.map(str::to_owned);
    for row in [&heads].into_iter().chain(rows) {
        let Some((last, others)) = row.split_last() else { return Ok(()) };
        let cells = others.iter().zip(widths).map(|(cell, width)| format!("  {cell:width$}"));
        print_hanging(out, &format!("{}  ", cells.collect::<String>()), last)?;
    }
    Ok(())
}

/// A number with a comma between thousands.
pub(crate) fn grouped(number: u128) -> String {
    let digits = number.to_string();
    let mut out = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    out
}

/// A number and its noun, as in "1 edge", "2 edges".
pub(crate) fn counted(number: usize, noun: &str) -> String {
    format!("{} {noun}{}", grouped(number as u128), if number == 1 { "" } else { "s" })
}

pub(crate) fn vertices(number: usize) -> String {
    if number == 1 {
        "1 vertex".to_owned()
    } else {
        format!("{} vertices", grouped(number as u128))
    }
}

/// Starts with a capital and ends with a full stop, or with its own question mark.
pub(crate) fn sentence(words: &str) -> String {
    let stop = if words.ends_with('?') { "" } else { "." };
    format!("{}{stop}", capital(words))
}

/// Starts with a capital.
pub(crate) fn capital(words: &str) -> String {
    let (first, rest) = words.split_at(words.chars().next().map_or(0, char::len_utf8));
    format!("{}{rest}", first.to_uppercase())
}

/// A word as a shell reads it.
pub(crate) fn quoted(word: &str) -> String {
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "-_./:=,@+%".contains(letter);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_are_grouped() {
        let texts = [0, 12, 123, 1234, 123_456, 1_234_567].map(grouped);
        assert_eq!(texts, ["0", "12", "123", "1,234", "123,456", "1,234,567"]);
    }
}
