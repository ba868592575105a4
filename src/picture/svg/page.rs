//! An SVG document as far as it is written: text, the marker's sign, numbers.

use super::super::{geometry::Point, text};

pub(super) const PAPER: &str = "#fdfcf9";
pub(super) const INK: &str = "#2b3440";
pub(super) const FAINT: &str = "#6b7280";
/// The colour of the marker and of the door that it points along.
pub(super) const MARKER: &str = "#c8281e";

/// A number without needless digits: tenths.
pub(super) fn short(number: f64) -> String {
    let tenths = (number * 10.0).round() / 10.0;
    // No negative zero.
    format!("{}", tenths + 0.0)
}

/// The document as far as it is written.
pub(super) struct Page(pub(super) String);

impl Page {
    /// A line of the document's text.
    pub(super) fn line(&mut self, line: &str) {
        self.0.push_str(line);
        self.0.push('\n');
    }

    /// Words in one line, their middle at `at`.
    pub(super) fn text(&mut self, text: &str, at: Point, size: f64, fill: &str, class: &str) {
        self.line(&format!(
            "<text class=\"{class}\" x=\"{}\" y=\"{}\" font-size=\"{}\" fill=\"{fill}\" \
             text-anchor=\"middle\">{}</text>",
            short(at.x),
            short(at.y),
            short(size),
            text::escaped(text),
        ));
    }

    /// A triangle that points along a direction, its base at `at`.
    pub(super) fn arrow(&mut self, at: Point, direction: f64, scale: f64) {
        let along = Point::polar(direction, 1.0);
        let tip = at + along * (12.0 * scale);
        let one = at + along.quarter_turn() * (5.0 * scale);
        let two = at - along.quarter_turn() * (5.0 * scale);
        self.line(&format!(
            "<path class=\"marker\" d=\"M{} {}L{} {}L{} {}Z\" fill=\"{MARKER}\"/>",
            short(tip.x),
            short(tip.y),
            short(one.x),
            short(one.y),
            short(two.x),
            short(two.y)
        ));
    }
}
