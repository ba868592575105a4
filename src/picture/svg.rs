//! The drawing as SVG text.
//!
//! Discs are `circle.vertex`, doors `circle.door`, edges `path.edge`; `data-vertex`, `data-door`
//! and `data-darts` say which, so that a program can read the order off the picture too.

use std::fmt::Write;

use super::{
    Picture,
    curves::Curve,
    drawing::{Drawing, INKS},
    geometry::Point,
    labels::Kind,
    text,
};

/// Room around everything.
const MARGIN: f64 = 18.0;
/// Text is broken so that the picture need not be wider than this, or than its drawing.
const COLUMN: f64 = 380.0;
/// Font sizes and line heights of the title, the caption and the legend.
const TITLE: [f64; 2] = [17.0, 23.0];
const CAPTION: [f64; 2] = [12.5, 17.0];
const LEGEND: [f64; 2] = [11.0, 15.5];

const PAPER: &str = "#fdfcf9";
const INK: &str = "#2b3440";
const FAINT: &str = "#6b7280";
const FLOOR: &str = "#ebe6db";
const START: &str = "#c8281e";
/// Inks of edges: the usual one, and those of edges that cross others.
const EDGES: [&str; INKS + 1] =
    ["#4a5568", "#1f6fb2", "#b3541e", "#2e7d4f", "#7b4fa3", "#a3842a", "#0f8b8d", "#ad3f7c"];

/// The picture as an SVG document.
pub(super) fn document(picture: &Picture, drawing: &Drawing) -> String {
    let extent = drawing.extent();
    let column = extent.size().x.max(COLUMN);
    let title = text::lines(picture.title, TITLE[0], column);
    let caption = text::lines(picture.caption, CAPTION[0], column);
    let legend: Vec<_> = legend(picture, drawing)
        .iter()
        .flat_map(|line| text::lines(line, LEGEND[0], column - 18.0))
        .collect();
    let widest = [(&title, TITLE[0]), (&caption, CAPTION[0])]
        .into_iter()
        .flat_map(|(lines, size)| lines.iter().map(move |line| text::width(line, size)))
        .chain(legend.iter().map(|line| text::width(line, LEGEND[0]) + 18.0))
        .fold(extent.size().x, f64::max)
        .ceil();
    let above = title.len() as f64 * TITLE[1] + if title.is_empty() { 0.0 } else { 10.0 };
    let bar = if drawing.metre.is_some() { 34.0 } else { 0.0 };
    let between = if caption.is_empty() { 0.0 } else { 5.0 };
    let captions = caption.len() as f64 * CAPTION[1] + legend.len() as f64 * LEGEND[1] + between;
    let below = bar + captions + if captions > 0.0 { 14.0 } else { 0.0 };
    let width = widest + 2.0 * MARGIN;
    let height = (extent.size().y + above + below).ceil() + 2.0 * MARGIN;
    let middle = width / 2.0;
    let shift = Point::new(middle - extent.centre().x, MARGIN + above - extent.least.y);

    let mut page = Page(String::new());
    page.line(&format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" \
         viewBox=\"0 0 {0} {1}\" role=\"img\" font-family=\"{2}\">",
        short(width),
        short(height),
        text::FAMILY,
    ));
    page.line(&format!("<title>{}</title>", text::escaped(picture.title)));
    page.line(&format!("<rect width=\"100%\" height=\"100%\" fill=\"{PAPER}\"/>"));
    for (number, line) in title.iter().enumerate() {
        let baseline = MARGIN + TITLE[0] + number as f64 * TITLE[1] - 2.0;
        page.text(line, Point::new(middle, baseline), TITLE[0], INK, "title");
    }
    page.drawing(picture, drawing, shift);
    let mut baseline = MARGIN + above + extent.size().y + 14.0;
    if let Some(metre) = drawing.metre {
        page.scale_bar(metre, extent.size().x, Point::new(middle, baseline + 8.0));
        baseline += bar;
    }
    for line in &caption {
        baseline += CAPTION[1];
        let at = Point::new(middle, baseline - 4.0);
        page.text(line, at, CAPTION[0], INK, "caption");
    }
    baseline += between;
    for (number, line) in legend.iter().enumerate() {
        baseline += LEGEND[1];
        let with_sign = number == 0 && picture.start.is_some();
        let aside = if with_sign { 9.0 } else { 0.0 };
        let at = Point::new(middle + aside, baseline - 4.0);
        page.text(line, at, LEGEND[0], FAINT, "legend");
        if with_sign {
            let left = at.x - text::width(line, LEGEND[0]) / 2.0 - 18.0;
            page.arrow(Point::new(left, at.y - 4.0), 0.0, 1.0);
        }
    }
    page.line("</svg>");
    page.0
}

/// What the signs mean.
fn legend(picture: &Picture, drawing: &Drawing) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(start) = picture.start {
        let graph = picture.graph;
        let vertex = graph.vertex(start);
        let number = vertex.at().to_string();
        let name = picture.vertex_names.get(vertex.at()).unwrap_or(&number);
        lines.push(format!(
            "start at {name}, facing door {}: the marker points along it",
            graph.index(start)
        ));
    }
    if drawing.size.knob > 0.0 && picture.graph.vertices().any(|v| picture.graph.degree(v) > 1) {
        lines.push("doors are numbered clockwise from each vertex's first".to_owned());
    }
    lines
}

/// A number without needless digits: tenths.
fn short(number: f64) -> String {
    let tenths = (number * 10.0).round() / 10.0;
    // No negative zero.
    format!("{}", tenths + 0.0)
}

/// The document as far as it is written.
struct Page(String);

impl Page {
    fn line(&mut self, line: &str) {
        self.0.push_str(line);
        self.0.push('\n');
    }

    fn text(&mut self, text: &str, at: Point, size: f64, fill: &str, class: &str) {
        self.line(&format!(
            "<text class=\"{class}\" x=\"{}\" y=\"{}\" font-size=\"{}\" fill=\"{fill}\" \
             text-anchor=\"middle\">{}</text>",
            short(at.x),
            short(at.y),
            short(size),
            text::escaped(text),
        ));
    }

    fn drawing(&mut self, picture: &Picture, drawing: &Drawing, shift: Point) {
        let graph = picture.graph;
        let size = &drawing.size;
        let thick = if size.knob > 0.0 { 2.2 } else { 1.2 };
        if drawing.metre.is_some() {
            self.line(&format!(
                "<g fill=\"none\" stroke=\"{FLOOR}\" stroke-width=\"{}\" \
                 stroke-linecap=\"round\">",
                short(1.5 * size.base)
            ));
            for (dart, other, _) in &drawing.edges {
                let [a, b] =
                    [dart, other].map(|end| drawing.centres[graph.vertex(*end).at()] + shift);
                self.line(&format!(
                    "<path d=\"M{} {}L{} {}\"/>",
                    short(a.x),
                    short(a.y),
                    short(b.x),
                    short(b.y)
                ));
            }
            self.line("</g>");
        }
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
                 stroke-width=\"{thick}\"/>",
                dart.0, other.0, EDGES[ink]
            ));
        }
        self.line("</g>");
        for vertex in graph.vertices() {
            let at = drawing.centres[vertex.at()] + shift;
            self.line(&format!(
                "<circle class=\"vertex\" data-vertex=\"{}\" cx=\"{}\" cy=\"{}\" r=\"{}\" \
                 fill=\"#ffffff\" stroke=\"{INK}\" stroke-width=\"{}\"/>",
                vertex.0,
                short(at.x),
                short(at.y),
                short(size.discs[vertex.at()]),
                if size.knob > 0.0 { 1.8 } else { 1.0 },
            ));
        }
        if size.knob > 0.0 {
            self.doors(picture, drawing, shift);
        }
        if let Some(start) = picture.start {
            let vertex = graph.vertex(start).at();
            let direction = drawing.doors[start.at()];
            let away = size.discs[vertex] + size.knob + 1.5;
            let at = drawing.centres[vertex] + Point::polar(direction, away) + shift;
            self.arrow(at, direction, if size.knob > 0.0 { 1.35 } else { 0.9 });
        }
        for label in &drawing.labels {
            let at = label.centre + shift + Point::new(0.0, label.size * 0.36);
            let (fill, class) = match label.kind {
                Kind::Inside | Kind::Beside => (INK, "name"),
                Kind::Edge => (FAINT, "edge-name"),
            };
            if label.kind != Kind::Inside {
                let extent = label.extent();
                let corner = extent.least + shift;
                self.line(&format!(
                    "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"3\" \
                     fill=\"{PAPER}\" fill-opacity=\"0.88\"/>",
                    short(corner.x),
                    short(corner.y),
                    short(extent.size().x),
                    short(extent.size().y)
                ));
            }
            self.text(&label.text, at, label.size, fill, class);
        }
    }

    /// The knobs of the doors, with their numbers.
    fn doors(&mut self, picture: &Picture, drawing: &Drawing, shift: Point) {
        let graph = picture.graph;
        for dart in graph.darts() {
            let vertex = graph.vertex(dart);
            let rim = Point::polar(drawing.doors[dart.at()], drawing.size.discs[vertex.at()]);
            let at = drawing.centres[vertex.at()] + rim + shift;
            let facing = picture.start == Some(dart);
            let (fill, stroke, ink) =
                if facing { (START, START, "#ffffff") } else { ("#ffffff", INK, INK) };
            let number = graph.index(dart);
            self.line(&format!(
                "<circle class=\"door\" data-door=\"{number}\" cx=\"{}\" cy=\"{}\" r=\"{}\" \
                 fill=\"{fill}\" stroke=\"{stroke}\" stroke-width=\"1\"/>",
                short(at.x),
                short(at.y),
                short(drawing.size.knob - 0.5),
            ));
            let font = if number < 10 { 8.0 } else { 6.5 };
            let baseline = at + Point::new(0.0, font * 0.365);
            self.text(&number.to_string(), baseline, font, ink, "door-number");
        }
    }

    /// A triangle that points along a direction, its base at `at`.
    fn arrow(&mut self, at: Point, direction: f64, scale: f64) {
        let along = Point::polar(direction, 1.0);
        let tip = at + along * (12.0 * scale);
        let one = at + along.quarter_turn() * (5.0 * scale);
        let two = at - along.quarter_turn() * (5.0 * scale);
        self.line(&format!(
            "<path class=\"marker\" d=\"M{} {}L{} {}L{} {}Z\" fill=\"{START}\"/>",
            short(tip.x),
            short(tip.y),
            short(one.x),
            short(one.y),
            short(two.x),
            short(two.y)
        ));
    }

    /// A bar of a round number of metres, and where north is.
    fn scale_bar(&mut self, metre: f64, room: f64, middle: Point) {
        let fits = |length: &&f64| **length * metre <= (room * 0.75).max(60.0);
        let lengths = [0.1, 0.2, 0.5, 1.0, 2.0, 4.0, 10.0, 20.0, 50.0, 100.0, 500.0];
        let wish = |length: &&f64| **length * metre <= 200.0;
        let length = lengths.iter().rev().filter(fits).find(wish).unwrap_or(&0.1);
        let half = length * metre / 2.0;
        let (left, right) = (middle.x - half, middle.x + half);
        self.line(&format!(
            "<path class=\"scale\" d=\"M{0} {1}v6M{0} {2}H{3}M{3} {1}v6\" fill=\"none\" \
             stroke=\"{FAINT}\" stroke-width=\"1.2\"/>",
            short(left),
            short(middle.y - 3.0),
            short(middle.y),
            short(right),
        ));
        let words = format!("{length} m, north is up");
        let at = middle + Point::new(0.0, 15.0);
        self.text(&words, at, LEGEND[0], FAINT, "legend");
    }
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
