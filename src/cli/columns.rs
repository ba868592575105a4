//! Text in columns, for people to read.

use std::io::{self, Write};

/// The widest line.
pub(super) const WIDTH: usize = 100;

/// Prints a text after its head; the lines that it needs beyond the first begin below its first
/// word.
pub(super) fn print_hanging(out: &mut dyn Write, head: &str, text: &str) -> io::Result<()> {
    let mut column = head.len();
    write!(out, "{head}")?;
    for (nth, word) in text.split(' ').enumerate() {
        if nth > 0 && column + 1 + word.len() > WIDTH {
            write!(out, "\n{:1$}", "", head.len())?;
            column = head.len();
        } else if nth > 0 {
            write!(out, " ")?;
            column += 1;
        }
        write!(out, "{word}")?;
        column += word.len();
    }
    writeln!(out)
}

/// Prints rows below their heads, each column as wide as its widest cell, but the last.
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
        let cells = row.iter().zip(widths).map(|(cell, width)| format!("  {cell:width$}"));
        writeln!(out, "{}", cells.collect::<String>().trim_end())?;
    }
    Ok(())
}
