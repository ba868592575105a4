//! Text for people: numbers, sentences, wrapped lines and tables.

use std::io::{self, Write};

use textwrap::core::display_width;

pub use toposlam_draw::{
    moment::{grouped, moment, since_start, tenths},
    text::{WIDTH, counted, print_hanging, print_indented, print_paragraph, vertices, wrapped},
};

/// A text as it can be printed: a name of a file may have characters that control a terminal.
pub fn printable(text: &str) -> String {
    let is_kept = |character: char| character == '\n' || !character.is_control();
    let shown = |character: char| {
        let escaped = (!is_kept(character)).then(|| character.escape_debug().to_string());
        escaped.unwrap_or_else(|| character.to_string())
    };
    if text.chars().all(is_kept) { text.to_owned() } else { text.chars().map(shown).collect() }
}

/// The three finite numbers in a text, with commas between them.
pub fn three_numbers(text: &str) -> Option<[f64; 3]> {
    let number = |part: &str| part.trim().parse().ok().filter(|number: &f64| number.is_finite());
    let numbers: Option<Vec<f64>> = text.split(',').map(number).collect();
    numbers?.try_into().ok()
}

/// Prints a command. A line that is too long continues after a backslash, as in a shell.
pub fn print_command(out: &mut dyn Write, head: &str, command: &str) -> io::Result<()> {
    let lines = wrapped(*WIDTH - 2, head, display_width(head) + 2, command);
    writeln!(out, "{}", lines.join(" \\\n"))
}

/// Prints short texts in columns, row by row, each line indented by two columns.
pub fn print_columns(out: &mut dyn Write, texts: &[String]) -> io::Result<()> {
    let widest = texts.iter().map(|text| display_width(text)).max().unwrap_or_default();
    for row in texts.chunks((*WIDTH / (widest + 2)).max(1)) {
        let row: Vec<_> = row.iter().map(|text| cell(text, widest)).collect();
        writeln!(out, "{}", row.concat().trim_end())?;
    }
    Ok(())
}

/// Prints rows below their heads. Each column is as wide as its widest cell; the last one is wrapped.
pub fn print_rows<const COLUMNS: usize>(
    out: &mut dyn Write,
    heads: [&str; COLUMNS],
    rows: &[[String; COLUMNS]],
) -> io::Result<()> {
    let widths: [_; COLUMNS] = std::array::from_fn(|column| {
        let texts = rows.iter().map(|row| display_width(&row[column]));
        texts.chain([display_width(heads[column])]).max().unwrap_or_default()
    });
    let heads = heads.map(str::to_owned);
    for row in [&heads].into_iter().chain(rows) {
        let Some((last, others)) = row.split_last() else { return Ok(()) };
        let cells = others.iter().zip(widths).map(|(text, width)| cell(text, width));
        print_hanging(out, &format!("{}  ", cells.collect::<String>()), last)?;
    }
    Ok(())
}

/// A text in a column of this width, after two spaces. Some letters are two columns wide.
fn cell(text: &str, width: usize) -> String {
    format!("  {text}{}", " ".repeat(width.saturating_sub(display_width(text))))
}

/// A duration in words, as in "9 s", "2 min 5 s", "1 h 20 min".
pub fn duration_text(seconds: f64) -> String {
    let seconds = seconds.round() as u64;
    match (seconds / 3600, seconds / 60 % 60, seconds % 60) {
        (0, 0, seconds) => format!("{seconds} s"),
        (0, minutes, seconds) => format!("{minutes} min {seconds} s"),
        (hours, minutes, _) => format!("{} h {minutes} min", grouped(hours.into())),
    }
}

/// A number to two digits, as in "0.31", "8.4", "1,200", "57 million".
pub fn rough(number: f64) -> String {
    let places = if number < 1.0 { 2 } else { usize::from(number < 10.0) };
    if number < 100.0 {
        return format!("{number:.places$}");
    }
    if number >= 1e6 {
        return format!("{} million", rough(number / 1e6));
    }
    let step = 10_f64.powi(number.log10().floor() as i32 - 1);
    grouped(((number / step).round() * step) as u128)
}

/// Starts with a capital and ends with a full stop, or with its own question mark.
pub fn sentence(words: &str) -> String {
    let stop = if words.ends_with('?') { "" } else { "." };
    format!("{}{stop}", capital(words))
}

pub fn capital(words: &str) -> String {
    let (first, rest) = words.split_at(words.chars().next().map_or(0, char::len_utf8));
    format!("{}{rest}", first.to_uppercase())
}

/// A word as a shell reads it.
pub fn quoted(word: &str) -> String {
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
    fn what_controls_a_terminal_is_shown() {
        assert_eq!(printable("a\u{1b}[31mb\n東"), "a\\u{1b}[31mb\n東");
        assert_eq!(printable("run.mcap"), "run.mcap");
    }

    #[test]
    fn a_column_is_as_wide_as_its_widest_text_on_a_terminal() {
        let mut out = Vec::new();
        let rows = [["東口", "x"], ["a", "y"]].map(|row| row.map(str::to_owned));
        print_rows(&mut out, ["at", "to"], &rows).unwrap();
        let text = String::from_utf8(out).unwrap();
        assert_eq!(text, "  at    to\n  東口  x\n  a     y\n");
        let mut out = Vec::new();
        print_hanging(&mut out, "東口 ", &"a b ".repeat(20)).unwrap();
        let text = String::from_utf8(out).unwrap();
        assert!(text.lines().nth(1).unwrap().starts_with("     "), "{text}");
    }

    #[test]
    fn durations_and_rates_have_few_digits() {
        let texts = [0.2, 59.4, 59.6, 125.0, 3600.0, 4830.0, 4e7].map(duration_text);
        let expected =
            ["0 s", "59 s", "1 min 0 s", "2 min 5 s", "1 h 0 min", "1 h 20 min", "11,111 h 6 min"];
        assert_eq!(texts, expected);
        let texts = [0.0, 0.312, 8.44, 57.1, 123.4, 1234.0, 57_142.0, 1.26e6, 57_142_857.14];
        let texts = texts.map(rough);
        let expected =
            ["0.00", "0.31", "8.4", "57", "120", "1,200", "57,000", "1.3 million", "57 million"];
        assert_eq!(texts, expected);
    }
}
