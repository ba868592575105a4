//! The sheet around a drawing: its title above; a scale, its caption and its legend below.

use super::{
    super::{
        geometry::{Extent, Point},
        signs::Sign,
        text,
    },
    page::{FAINT, INK, PAPER, Page, short},
};

/// Room around everything.
const MARGIN: f64 = 18.0;
/// Text is broken into lines so that the picture is not wider than this, or than its drawing.
const COLUMN: f64 = 380.0;
/// Font sizes and line heights of the title, the caption and the legend.
const TITLE: [f64; 2] = [17.0, 23.0];
const CAPTION: [f64; 2] = [12.5, 17.0];
const LEGEND: [f64; 2] = [11.0, 15.5];
/// Room in a line of the legend for a sign before it.
const ASIDE: f64 = 18.0;

/// The texts around a drawing.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Sheet<'a> {
    /// Above the drawing; may be empty.
    pub(in super::super) title: &'a str,
    /// Below it; may be empty.
    pub(in super::super) caption: &'a str,
    /// All that is drawn lies in this box.
    pub(in super::super) extent: Extent,
    /// Units of the picture in a metre, if the sheet shows a scale.
    pub(in super::super) metre: Option<f64>,
    /// What is up, beside the scale.
    pub(in super::super) up: &'a str,
}

/// What is up in a floor plan.
pub(in super::super) const NORTH: &str = "north is up";

impl Sheet<'_> {
    fn column(&self) -> f64 {
        self.extent.size().x.max(COLUMN)
    }

    /// These texts as a legend: in one line if they fit, otherwise one a line.
    pub(in super::super) fn legend(&self, mut says: Vec<String>) -> Vec<String> {
        let widest = self.column() - ASIDE;
        let whole = says.join("; ");
        if text::width(&whole, LEGEND[0]) <= widest {
            says = vec![whole];
        }
        says.iter().flat_map(|line| text::lines(line, LEGEND[0], widest)).collect()
    }

    /// The SVG document of a drawing. The sign is before the first line of the legend.
    pub(in super::super) fn document(
        &self,
        legend: &[String],
        sign: Option<&Sign>,
        draw: impl FnOnce(&mut Page),
    ) -> String {
        let Self { extent, .. } = *self;
        let title = text::lines(self.title, TITLE[0], self.column());
        let caption = text::lines(self.caption, CAPTION[0], self.column());
        let widest = [(&title, TITLE[0]), (&caption, CAPTION[0])]
            .into_iter()
            .flat_map(|(lines, size)| lines.iter().map(move |line| text::width(line, size)))
            .chain(legend.iter().map(|line| text::width(line, LEGEND[0]) + ASIDE))
            .fold(extent.size().x, f64::max)
            .ceil();
        let above = title.len() as f64 * TITLE[1] + if title.is_empty() { 0.0 } else { 10.0 };
        let bar = if self.metre.is_some() { 34.0 } else { 0.0 };
        let between = if caption.is_empty() { 0.0 } else { 5.0 };
        let captions =
            caption.len() as f64 * CAPTION[1] + legend.len() as f64 * LEGEND[1] + between;
        let below = bar + captions + if captions > 0.0 { 14.0 } else { 0.0 };
        let width = widest + 2.0 * MARGIN;
        let height = (extent.size().y + above + below).ceil() + 2.0 * MARGIN;
        let middle = width / 2.0;

        let mut page = Page::default();
        page.line(&format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" \
             viewBox=\"0 0 {0} {1}\" role=\"img\" font-family=\"{2}\">",
            short(width),
            short(height),
            text::FAMILY,
        ));
        page.line(&format!("<title>{}</title>", text::escaped(self.title)));
        page.line(&format!("<rect width=\"100%\" height=\"100%\" fill=\"{PAPER}\"/>"));
        for (number, line) in title.iter().enumerate() {
            let baseline = MARGIN + TITLE[0] + number as f64 * TITLE[1] - 2.0;
            page.text(line, Point::new(middle, baseline), TITLE[0], INK, "title");
        }
        page.shift = Point::new(middle - extent.centre().x, MARGIN + above - extent.least.y);
        draw(&mut page);
        page.shift = Point::default();
        let mut baseline = MARGIN + above + extent.size().y + 14.0;
        if let Some(metre) = self.metre {
            let at = Point::new(middle, baseline + 8.0);
            page.scale_bar(metre, extent.size().x, at, self.up);
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
            let sign = sign.filter(|_| number == 0);
            let aside = if sign.is_some() { ASIDE / 2.0 } else { 0.0 };
            let at = Point::new(middle + aside, baseline - 4.0);
            page.text(line, at, LEGEND[0], FAINT, "legend");
            if let Some(sign) = sign {
                let left = at.x - text::width(line, LEGEND[0]) / 2.0 - ASIDE;
                page.sign(&sign.small(Point::new(left, at.y - 4.0)));
            }
        }
        page.line("</svg>");
        page.text
    }
}

impl Page {
    /// A bar of a round number of metres, and what is up.
    fn scale_bar(&mut self, metre: f64, room: f64, middle: Point, up: &str) {
        let fits = |length: &&f64| **length * metre <= (room * 0.75).max(60.0);
        let lengths = [0.1, 0.2, 0.5, 1.0, 2.0, 4.0, 10.0, 20.0, 50.0, 100.0, 500.0];
        let wish = |length: &&f64| **length * metre <= 200.0;
        let length = lengths.iter().rev().filter(fits).find(wish).unwrap_or(&0.1);
        let half = length * metre / 2.0;
        let (left, right) = (middle.x - half, middle.x + half);
        let [left, right, top, y] = [left, right, middle.y - 3.0, middle.y].map(short);
        let bar = format!("M{left} {top}v6M{left} {y}H{right}M{right} {top}v6");
        let stroke = format!("fill=\"none\" stroke=\"{FAINT}\" stroke-width=\"1.2\"");
        self.path("class=\"scale\"", &bar, &stroke);
        let words = format!("{length} m, {up}");
        let at = middle + Point::new(0.0, 15.0);
        self.text(&words, at, LEGEND[0], FAINT, "legend");
    }
}
