//! The drawing as SVG text.
//!
//! Discs are `circle.vertex`, doors `circle.door`, edges `path.edge`; `data-vertex`, `data-door`,
//! `data-dart` and `data-darts` say which, so that a program can read the order off the picture
//! too. An edge runs from the first of its darts to the second. All names are in one `g.names`, so
//! that the walk page can put a robot below them.

mod figure;
mod page;

use super::{
    Picture,
    drawing::Drawing,
    geometry::Point,
    labels::{Label, labels},
    signs::{Sign, signs},
    text,
};

use page::{FAINT, INK, PAPER, Page, short};

/// Room around everything.
const MARGIN: f64 = 18.0;
/// Text is broken so that the picture need not be wider than this, or than its drawing.
const COLUMN: f64 = 380.0;
/// Font sizes and line heights of the title, the caption and the legend.
const TITLE: [f64; 2] = [17.0, 23.0];
const CAPTION: [f64; 2] = [12.5, 17.0];
const LEGEND: [f64; 2] = [11.0, 15.5];

/// The picture as an SVG document.
pub(super) fn document(picture: &Picture, drawing: &Drawing) -> String {
    let signs = signs(picture, drawing);
    let labels = labels(drawing, picture, &signs);
    let mut extent = drawing.extent();
    for each in labels.iter().map(Label::extent).chain(signs.iter().map(Sign::extent)) {
        extent.join(each);
    }
    let column = extent.size().x.max(COLUMN);
    let title = text::lines(picture.title, TITLE[0], column);
    let caption = text::lines(picture.caption, CAPTION[0], column);
    let legend = legend(picture, drawing, column - 18.0);
    let widest = [(&title, TITLE[0]), (&caption, CAPTION[0])]
        .into_iter()
        .flat_map(|(lines, size)| lines.iter().map(move |line| text::width(line, size)))
        .chain(legend.iter().map(|line| text::width(line, LEGEND[0]) + 18.0))
        .fold(extent.size().x, f64::max)
        .ceil();
    let above = title.len() as f64 * TITLE[1] + if title.is_empty() { 0.0 } else { 10.0 };
    let bar = if drawing.floor.is_some() { 34.0 } else { 0.0 };
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
    page.drawing(picture, drawing, &signs, shift);
    page.line("<g class=\"names\">");
    for label in &labels {
        page.label(label, shift);
    }
    page.line("</g>");
    let mut baseline = MARGIN + above + extent.size().y + 14.0;
    if let Some(floor) = drawing.floor {
        page.scale_bar(floor.metre, extent.size().x, Point::new(middle, baseline + 8.0));
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
        let sign = signs.first().filter(|_| number == 0);
        let aside = if sign.is_some() { 9.0 } else { 0.0 };
        let at = Point::new(middle + aside, baseline - 4.0);
        page.text(line, at, LEGEND[0], FAINT, "legend");
        if let Some(sign) = sign {
            let left = at.x - text::width(line, LEGEND[0]) / 2.0 - 18.0;
            page.sign(&sign.small(Point::new(left, at.y - 4.0)));
        }
    }
    page.line("</svg>");
    page.0
}

/// What the signs mean, in lines that are at most as wide as given.
fn legend(picture: &Picture, drawing: &Drawing, widest: f64) -> Vec<String> {
    let mut says = Vec::new();
    says.extend(picture.where_the_marker_is());
    if drawing.size.knob > 0.0 && picture.graph.vertices().any(|v| picture.graph.degree(v) > 1) {
        says.push("doors are numbered clockwise from each vertex's first".to_owned());
    }
    let whole = says.join("; ");
    if text::width(&whole, LEGEND[0]) <= widest {
        says = vec![whole];
    }
    says.iter().flat_map(|line| text::lines(line, LEGEND[0], widest)).collect()
}

impl Page {
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
