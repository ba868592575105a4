//! An SVG document under construction: text, the marker's sign, numbers.

use toposlam_model::marker::MarkerLook;

use super::super::{
    geometry::Point,
    signs::{ARROW, Sign},
    text,
};

pub(in super::super) const PAPER: &str = "#fdfcf9";
pub(in super::super) const INK: &str = "#2b3440";
pub(in super::super) const FAINT: &str = "#6b7280";
/// The colour of the marker and of the door that it points along.
pub(in super::super) const MARKER: &str = "#c8281e";

/// A number, rounded to tenths.
pub(in super::super) fn short(number: f64) -> String {
    let tenths = (number * 10.0).round() / 10.0;
    // No negative zero.
    format!("{}", tenths + 0.0)
}

/// The document so far.
pub(in super::super) struct Page(pub(in super::super) String);

impl Page {
    /// A line of the document's text.
    pub(in super::super) fn line(&mut self, line: &str) {
        self.0.push_str(line);
        self.0.push('\n');
    }

    /// Words in one line, their middle at `at`.
    pub(in super::super) fn text(
        &mut self,
        text: &str,
        at: Point,
        size: f64,
        fill: &str,
        class: &str,
    ) {
        self.line(&format!(
            "<text class=\"{class}\" x=\"{}\" y=\"{}\" font-size=\"{}\" fill=\"{fill}\" \
             text-anchor=\"middle\">{}</text>",
            short(at.x),
            short(at.y),
            short(size),
            text::escaped(text),
        ));
    }

    /// A sign of the marker.
    pub(in super::super) fn sign(&mut self, sign: &Sign) {
        match *sign {
            Sign::Ring { centre, radius, look } => {
                let dashes = match look {
                    MarkerLook::One => "",
                    MarkerLook::Other => " stroke-dasharray=\"4 3\"",
                };
                self.line(&format!(
                    "<circle class=\"marker\" cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"none\" \
                     stroke=\"{MARKER}\" stroke-width=\"2.4\"{dashes}/>",
                    short(centre.x),
                    short(centre.y),
                    short(radius),
                ));
            }
            Sign::Arrow { at, direction, scale } => {
                let along = Point::polar(direction, scale);
                let across = along.quarter_turn() * 5.0;
                self.marker([at + along * ARROW, at + across, at - across].as_slice());
            }
            Sign::Bar { at, direction, scale } => {
                let along = Point::polar(direction, scale) * 2.2;
                let across = along.quarter_turn() * (5.5 / 2.2);
                self.marker(&[
                    at + along + across,
                    at + along - across,
                    at - along - across,
                    at - along + across,
                ]);
            }
        }
    }

    /// A shape in the marker's colour, by its corners.
    pub(in super::super) fn marker(&mut self, corners: &[Point]) {
        let corners: Vec<_> =
            corners.iter().map(|at| format!("{} {}", short(at.x), short(at.y))).collect();
        self.line(&format!(
            "<path class=\"marker\" d=\"M{}Z\" fill=\"{MARKER}\"/>",
            corners.join("L")
        ));
    }
}
