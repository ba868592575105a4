//! The drawing itself: hallways, curves, discs, doors, the marker and names.

use std::fmt::Write;

use toposlam_model::marker::MarkerPart;

use super::{
    super::{
        WorldPicture,
        curves::Curve,
        drawing::{Drawing, INKS},
        geometry::{Extent, Point},
        labels::{LINE, Label, LabelKind},
        signs::Sign,
        text,
    },
    page::{FAINT, INK, MARKER, PAPER, Page, short},
};

/// The colour of the floor.
pub(in super::super) const FLOOR: &str = "#ebe6db";
/// Inks of edges: the usual one, and those of edges that cross others.
const EDGES: [&str; INKS + 1] =
    ["#4a5568", "#1f6fb2", "#b3541e", "#2e7d4f", "#7b4fa3", "#a3842a", "#0f8b8d", "#ad3f7c"];

impl Page {
    /// The whole drawing, moved by `shift`.
    pub(super) fn drawing(
        &mut self,
        picture: &WorldPicture,
        drawing: &Drawing,
        signs: &[Sign],
        shift: Point,
    ) {
        self.floor(drawing, shift);
        self.edges(drawing, shift);
        self.discs(drawing, shift);
        let size = &drawing.size;
        if size.knob > 0.0 {
            self.doors(picture, drawing, shift);
        }
        for sign in signs {
            self.sign(&sign.moved(shift));
        }
    }

    /// The hallways of a floor plan.
    fn floor(&mut self, drawing: &Drawing, shift: Point) {
        if drawing.floor.is_none() {
            return;
        }
        self.line(&format!("<g fill=\"{FLOOR}\">"));
        for hallway in drawing.hallways() {
            self.rectangle("class=\"hallway\"", hallway, shift);
        }
        self.line("</g>");
    }

    pub(in super::super) fn rectangle(&mut self, attributes: &str, extent: Extent, shift: Point) {
        let corner = extent.least + shift;
        self.line(&format!(
            "<rect {attributes} x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>",
            short(corner.x),
            short(corner.y),
            short(extent.size().x),
            short(extent.size().y)
        ));
    }

    fn edges(&mut self, drawing: &Drawing, shift: Point) {
        let thick = thickness(drawing);
        self.line("<g fill=\"none\">");
        for ((dart, other, curve), &ink) in drawing.edges.iter().zip(&drawing.inks) {
            let path = path(curve, shift);
            if ink > 0 {
                let casing = thick + 4.0;
                self.line(&format!(
                    "<path d=\"{path}\" stroke=\"{PAPER}\" stroke-width=\"{casing}\"/>"
                ));
            }
            self.line(&format!(
                "<path class=\"edge\" data-darts=\"{} {}\" d=\"{path}\" stroke=\"{}\" \
                 stroke-width=\"{}\"/>",
                dart.0,
                other.0,
                EDGES[ink],
                short(thick),
            ));
        }
        self.line("</g>");
    }

    fn discs(&mut self, drawing: &Drawing, shift: Point) {
        let thick = if drawing.size.knob > 0.0 { 1.8 } else { 1.0 };
        for (vertex, (centre, disc)) in drawing.centres.iter().zip(&drawing.size.discs).enumerate()
        {
            let at = *centre + shift;
            if vertex >= drawing.known {
                self.line(&format!(
                    "<circle class=\"unexplored\" cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{PAPER}\" \
                     stroke=\"{INK}\" stroke-width=\"1.6\" stroke-dasharray=\"2.4 2\"/>",
                    short(at.x),
                    short(at.y),
                    short(*disc),
                ));
                continue;
            }
            self.line(&format!(
                "<circle class=\"vertex\" data-vertex=\"{vertex}\" cx=\"{}\" cy=\"{}\" \
                 r=\"{}\" fill=\"#ffffff\" stroke=\"{INK}\" stroke-width=\"{thick}\"/>",
                short(at.x),
                short(at.y),
                short(*disc),
            ));
        }
    }

    pub(in super::super) fn label(&mut self, label: &Label, shift: Point) {
        let (fill, class) = match label.kind {
            LabelKind::Inside | LabelKind::Beside => (INK, "name"),
            LabelKind::Edge => (FAINT, "edge-name"),
        };
        if label.kind != LabelKind::Inside {
            let veil = format!("rx=\"3\" fill=\"{PAPER}\" fill-opacity=\"0.88\"");
            self.rectangle(&veil, label.extent(), shift);
        }
        let at = label.centre + shift;
        let first = at.y + label.size * (0.36 - LINE * (label.lines.len() as f64 - 1.0) / 2.0);
        let mut spans = String::new();
        for (number, line) in label.lines.iter().enumerate() {
            let baseline = short(first + number as f64 * LINE * label.size);
            let line = text::escaped(line);
            // Writing to a string does not fail.
            let _ = write!(spans, "<tspan x=\"{}\" y=\"{baseline}\">{line}</tspan>", short(at.x));
        }
        self.line(&format!(
            "<text class=\"{class}\" font-size=\"{}\" fill=\"{fill}\" \
             text-anchor=\"middle\">{spans}</text>",
            short(label.size),
        ));
    }

    /// The knobs of the doors, with their numbers.
    fn doors(&mut self, picture: &WorldPicture, drawing: &Drawing, shift: Point) {
        let graph = picture.graph;
        let pointing = picture.parts();
        for dart in graph.darts() {
            let vertex = graph.vertex(dart);
            if vertex.at() >= drawing.known {
                continue;
            }
            let rim = Point::polar(drawing.doors[dart.at()], drawing.size.discs[vertex.at()]);
            let at = drawing.centres[vertex.at()] + rim + shift;
            let facing = pointing.contains(&MarkerPart::Pointing(dart));
            let (fill, stroke, ink) =
                if facing { (MARKER, MARKER, "#ffffff") } else { ("#ffffff", INK, INK) };
            let number = graph.index(dart);
            self.line(&format!(
                "<circle class=\"door\" data-door=\"{number}\" data-dart=\"{}\" cx=\"{}\" cy=\"{}\" \
                 r=\"{}\" fill=\"{fill}\" stroke=\"{stroke}\" stroke-width=\"1\"/>",
                dart.0,
                short(at.x),
                short(at.y),
                short(drawing.size.knob - 0.5),
            ));
            let font = drawing.size.knob * if number < 10 { 1.35 } else { 1.1 };
            let baseline = at + Point::new(0.0, font * 0.365);
            self.text(&number.to_string(), baseline, font, ink, "door-number");
        }
    }
}

/// The width of edges: visible when the whole of a large picture is on the screen.
fn thickness(drawing: &Drawing) -> f64 {
    if drawing.size.knob > 0.0 {
        return 2.2;
    }
    let sides = drawing.extent().size();
    (sides.x.max(sides.y) / 3000.0).clamp(1.2, 0.6 * drawing.size.base)
}

/// The curve as path data.
fn path(curve: &Curve, shift: Point) -> String {
    let mut path = String::new();
    let mut put = |sign: char, point: Point| {
        let point = point + shift;
        // Writing to a string does not fail.
        let _ = write!(path, "{sign}{} {}", short(point.x), short(point.y));
    };
    put('M', curve.start);
    for &[one, two, to] in &curve.pieces {
        put('C', one);
        put(' ', two);
        put(' ', to);
    }
    path
}
