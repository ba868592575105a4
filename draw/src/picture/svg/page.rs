//! An SVG document under construction: shapes, text, the marker's sign, numbers.

use std::fmt;

use toposlam_model::marker::MarkerLook;

use super::super::{
    geometry::{Extent, Point},
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

/// The coordinates, as path data has them.
impl fmt::Display for Point {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", short(self.x), short(self.y))
    }
}

/// The document so far. The attributes of an element stand before and after those of its place.
#[derive(Default)]
pub(in super::super) struct Page {
    pub(in super::super) text: String,
    /// The step by which all places are moved.
    pub(super) shift: Point,
}

impl Page {
    /// A line of the document's text.
    pub(in super::super) fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// A place in the document.
    pub(in super::super) fn at(&self, place: Point) -> Point {
        place + self.shift
    }

    fn element(&mut self, name: &str, attributes: [&str; 3]) {
        let attributes: Vec<_> = attributes.into_iter().filter(|some| !some.is_empty()).collect();
        self.line(&format!("<{name} {}/>", attributes.join(" ")));
    }

    pub(in super::super) fn circle(&mut self, before: &str, at: Point, radius: f64, after: &str) {
        let at = self.at(at);
        let [x, y, radius] = [at.x, at.y, radius].map(short);
        let place = format!("cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"");
        self.element("circle", [before, &place, after]);
    }

    pub(in super::super) fn rectangle(&mut self, before: &str, extent: Extent, after: &str) {
        let (corner, size) = (self.at(extent.least), extent.size());
        let [x, y, width, height] = [corner.x, corner.y, size.x, size.y].map(short);
        let place = format!("x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"");
        self.element("rect", [before, &place, after]);
    }

    /// A path by its data, whose places are those [in the document](Self::at).
    pub(in super::super) fn path(&mut self, before: &str, data: &str, after: &str) {
        self.element("path", [before, &format!("d=\"{data}\""), after]);
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
        self.anchored_text(text, at, size, fill, [class, "middle"]);
    }

    /// Words in one line, of a class, with their start, middle or end at `at`.
    pub(in super::super) fn anchored_text(
        &mut self,
        text: &str,
        at: Point,
        size: f64,
        fill: &str,
        [class, anchor]: [&str; 2],
    ) {
        let at = self.at(at);
        let [x, y, size] = [at.x, at.y, size].map(short);
        self.line(&format!(
            "<text class=\"{class}\" x=\"{x}\" y=\"{y}\" font-size=\"{size}\" fill=\"{fill}\" \
             text-anchor=\"{anchor}\">{}</text>",
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
                    MarkerLook::Third => " stroke-dasharray=\"1 3\"",
                    MarkerLook::Fourth => " stroke-dasharray=\"7 2 1 2\"",
                };
                let stroke =
                    format!("fill=\"none\" stroke=\"{MARKER}\" stroke-width=\"2.4\"{dashes}");
                self.circle("class=\"marker\"", centre, radius, &stroke);
            }
            Sign::Arrow { at, direction, scale } => {
                let along = Point::polar(direction, scale);
                let across = along.quarter_turn() * 5.0;
                self.marker(&[at + along * ARROW, at + across, at - across]);
            }
            Sign::Bar { at, direction, scale } => {
                let along = Point::polar(direction, scale) * 2.2;
                self.bar(at, along, along.quarter_turn() * (5.5 / 2.2));
            }
        }
    }

    /// A rectangle in the marker's colour, by its middle and its half sides.
    pub(in super::super) fn bar(&mut self, at: Point, along: Point, across: Point) {
        self.marker(&[
            at + along + across,
            at + along - across,
            at - along - across,
            at - along + across,
        ]);
    }

    /// A shape in the marker's colour, by its corners.
    pub(in super::super) fn marker(&mut self, corners: &[Point]) {
        let corners: Vec<_> = corners.iter().map(|&at| self.at(at).to_string()).collect();
        let outline = format!("M{}Z", corners.join("L"));
        self.path("class=\"marker\"", &outline, &format!("fill=\"{MARKER}\""));
    }
}
