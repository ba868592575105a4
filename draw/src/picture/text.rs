//! The width of text in the font of the pictures, and its line breaks.

/// The font's family, as the SVG names it.
pub(super) const FAMILY: &str = "DejaVu Sans, sans-serif";

/// Advance widths of the characters U+0020 to U+007E in thousandths of the font size.
#[rustfmt::skip]
const ADVANCES: [u16; 95] = [
    318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361, 318, 337, 636, 636, 636,
    636, 636, 636, 636, 636, 636, 636, 337, 337, 838, 838, 838, 531, 1000, 684, 686, 698, 770, 632,
    575, 775, 752, 295, 295, 656, 557, 863, 748, 787, 603, 787, 695, 635, 611, 732, 684, 989, 685,
    611, 685, 390, 337, 390, 838, 500, 500, 613, 635, 550, 635, 615, 352, 635, 634, 278, 278, 579,
    278, 974, 634, 612, 635, 635, 411, 521, 392, 634, 592, 818, 592, 592, 525, 636, 337, 636, 838,
];

/// The width of the text at a font size. Characters beyond ASCII count as wide ones.
pub(super) fn width(text: &str, size: f64) -> f64 {
    let advance = |letter: char| {
        let place = (letter as usize).checked_sub(0x20);
        place.and_then(|place| ADVANCES.get(place)).map_or(1000, |&advance| u32::from(advance))
    };
    f64::from(text.chars().map(advance).sum::<u32>()) * size / 1000.0
}

/// The text in lines of at most the given width, broken at spaces if there are any.
pub(super) fn lines(text: &str, size: f64, widest: f64) -> Vec<String> {
    let mut lines = Vec::new();
    for paragraph in text.lines() {
        let mut line = String::new();
        for word in paragraph.split_whitespace() {
            let mut longer = line.clone();
            if !longer.is_empty() {
                longer.push(' ');
            }
            longer.push_str(word);
            if width(&longer, size) <= widest {
                line = longer;
                continue;
            }
            if !line.is_empty() {
                lines.push(std::mem::take(&mut line));
            }
            for letter in word.chars() {
                line.push(letter);
                if width(&line, size) > widest && line.chars().count() > 1 {
                    line.pop();
                    lines.push(std::mem::replace(&mut line, letter.to_string()));
                }
            }
        }
        if !line.is_empty() {
            lines.push(line);
        }
    }
    lines
}

/// A name in two lines of similar length, broken at a space or after a `-` or a `_`; in one line if it has
/// none.
pub(super) fn in_two(name: &str) -> Vec<String> {
    let ends = name.char_indices().filter(|(_, letter)| [' ', '-', '_'].contains(letter));
    let breaks = ends.map(|(at, _)| name.split_at(at + 1)).filter(|(_, rest)| !rest.is_empty());
    let widest = |two: &(&str, &str)| width(two.0, 1.0).max(width(two.1, 1.0));
    match breaks.min_by(|one, other| widest(one).total_cmp(&widest(other))) {
        Some((first, second)) => vec![first.trim_end().to_owned(), second.to_owned()],
        None => vec![name.to_owned()],
    }
}

/// The text with XML's markup characters as references, and without characters that XML does not allow.
pub(crate) fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            '\t' | '\n' | '\r' => escaped.push(' '),
            '\0'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => escaped.push('\u{fffd}'),
            _ => escaped.push(letter),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_break_at_spaces_and_inside_long_words() {
        assert_eq!(lines("aa aa aa", 10.0, 32.0), ["aa aa", "aa"]);
        assert_eq!(lines("aaaaaa", 10.0, 20.0), ["aaa", "aaa"]);
        assert!(lines("", 10.0, 20.0).is_empty());
    }

    #[test]
    fn names_break_behind_their_signs() {
        assert_eq!(in_two("north-west"), ["north-", "west"]);
        assert_eq!(in_two("a_b_room"), ["a_b_", "room"]);
        assert_eq!(in_two("große Küche"), ["große", "Küche"]);
        assert_eq!(in_two("corner"), ["corner"]);
        assert_eq!(in_two("corner-"), ["corner-"]);
    }

    #[test]
    fn markup_is_escaped() {
        assert_eq!(escaped("<a&'\"\u{1}"), "&lt;a&amp;&#39;&quot;\u{fffd}");
    }
}
