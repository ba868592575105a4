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
const FLOOR: &str = "#ebe6db";
/// Inks of edges: the usual one, and those of edges that cross others.
const EDGES: [&str; INKS + 1] =
    ["#4a5568", "#1f6fb2", "#b3541e", "#2e7d4f", "#7b4fa3", "#a3842a", "#0f8b8d", "#ad3f7c"];

impl Page {
    pub(super) fn drawing(&mut self, picture: &WorldPicture, drawing: &Drawing, signs: &[Sign]) {
        if drawing.floor.is_some() {
            self.hallways(drawing.hallways());
        }
        self.edges(drawing);
        self.discs(drawing);
        if drawing.size.knob > 0.0 {
            self.doors(picture, drawing);
        }
        for sign in signs {
            self.sign(sign);
        }
    }

    /// The floor of hallways.
    pub(in super::super) fn hallways(&mut self, hallways: impl Iterator<Item = Extent>) {
        self.line(&format!("<g fill=\"{FLOOR}\">"));
        for hallway in hallways {
            self.rectangle("class=\"hallway\"", hallway, "");
        }
        self.line("</g>");
    }

    fn edges(&mut self, drawing: &Drawing) {
        let thick = thickness(drawing);
        self.line("<g fill=\"none\">");
        for ((dart, other, curve), &ink) in drawing.edges.iter().zip(&drawing.inks) {
            let path = path(curve, self);
            if ink > 0 {
                let casing = format!("stroke=\"{PAPER}\" stroke-width=\"{}\"", thick + 4.0);
                self.path("", &path, &casing);
            }
            let darts = format!("class=\"edge\" data-darts=\"{} {}\"", dart.0, other.0);
            let stroke = format!("stroke=\"{}\" stroke-width=\"{}\"", EDGES[ink], short(thick));
            self.path(&darts, &path, &stroke);
        }
        self.line("</g>");
    }

    fn discs(&mut self, drawing: &Drawing) {
        let thick = if drawing.size.knob > 0.0 { 1.8 } else { 1.0 };
        for (vertex, (&at, &disc)) in drawing.centres.iter().zip(&drawing.size.discs).enumerate() {
            if vertex < drawing.known {
                let name = format!("class=\"vertex\" data-vertex=\"{vertex}\"");
                let look = format!("fill=\"#ffffff\" stroke=\"{INK}\" stroke-width=\"{thick}\"");
                self.circle(&name, at, disc, &look);
            } else {
                let look = format!(
                    "fill=\"{PAPER}\" stroke=\"{INK}\" stroke-width=\"1.6\" \
                     stroke-dasharray=\"2.4 2\""
                );
                self.circle("class=\"unexplored\"", at, disc, &look);
            }
        }
    }

    pub(in super::super) fn label(&mut self, label: &Label) {
        let (fill, class) = match label.kind {
            LabelKind::Inside | LabelKind::Beside => (INK, "name"),
            LabelKind::Edge => (FAINT, "edge-name"),
        };
        if label.kind != LabelKind::Inside {
            let veil = format!("rx=\"3\" fill=\"{PAPER}\" fill-opacity=\"0.88\"");
            self.rectangle(&veil, label.extent(), "");
        }
        let at = self.at(label.centre);
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
    fn doors(&mut self, picture: &WorldPicture, drawing: &Drawing) {
        let graph = picture.graph;
        let pointing = picture.parts();
        for dart in graph.darts() {
            let vertex = graph.vertex(dart);
            if vertex.at() >= drawing.known {
                continue;
            }
            let rim = Point::polar(drawing.doors[dart.at()], drawing.size.discs[vertex.at()]);
            let at = drawing.centres[vertex.at()] + rim;
            let facing = pointing.contains(&MarkerPart::Pointing(dart));
            let (fill, stroke, ink) =
                if facing { (MARKER, MARKER, "#ffffff") } else { ("#ffffff", INK, INK) };
            let number = graph.index(dart);
            let name = format!("class=\"door\" data-door=\"{number}\" data-dart=\"{}\"", dart.0);
            let look = format!("fill=\"{fill}\" stroke=\"{stroke}\" stroke-width=\"1\"");
            self.circle(&name, at, drawing.size.knob - 0.5, &look);
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
fn path(curve: &Curve, page: &Page) -> String {
    let mut path = format!("M{}", page.at(curve.start));
    for piece in &curve.pieces {
        let [one, two, to] = piece.map(|point| page.at(point));
        // Writing to a string does not fail.
        let _ = write!(path, "C{one} {two} {to}");
    }
    path
}
