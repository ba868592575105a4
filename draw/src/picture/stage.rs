//! A picture of a step of sensing, with its legend and its scale below it. Section 3.

use image::{Rgb, RgbImage, imageops};
use toposlam_vision::annotate::{LegendSign, StageLegend};

use super::{
    geometry::{Extent, Point},
    png::{PictureError, pixels},
    svg::{INK, Page, short},
    text::{FAMILY, width},
};

/// The font size of a legend, as a share of the picture's width, and its bounds.
const SIZE: f64 = 1.0 / 50.0;
const SIZES: [f64; 2] = [11.0, 26.0];
/// Grey, so that white and black signs stand out.
const PAPER: &str = "#bcbcb6";

/// The picture with its legend and its scale below it.
///
/// # Errors
/// Returns an error if the picture has no width.
pub fn with_legend(picture: &RgbImage, legend: &StageLegend) -> Result<RgbImage, PictureError> {
    let below = pixels(&strip(legend, picture.width()))?;
    let mut whole = RgbImage::new(picture.width(), picture.height() + below.height());
    imageops::replace(&mut whole, picture, 0, 0);
    imageops::replace(&mut whole, &below, 0, i64::from(picture.height()));
    Ok(whole)
}

/// The legend as an SVG document of a width. The entries stand in rows.
fn strip(legend: &StageLegend, wide: u32) -> String {
    let right = f64::from(wide);
    let size = (SIZE * right).clamp(SIZES[0], SIZES[1]);
    let (row, margin) = (1.7 * size, 0.8 * size);
    let scale = legend.metre.map(|metre| (None, metre, "1 m"));
    let entries = legend.entries.iter();
    let entries = entries.map(|(sign, words)| (Some(sign), length(sign, size), &**words));
    let mut at = Point::new(margin, margin + 0.5 * row);
    let mut page = Page::default();
    for (sign, long, words) in scale.into_iter().chain(entries) {
        let wanted = long + 0.5 * size + width(words, size);
        if at.x > margin && at.x + wanted > right - margin {
            at = Point::new(margin, at.y + row);
        }
        match sign {
            Some(sign) => write_sign(&mut page, sign, at, size),
            None => write_ruler(&mut page, at, long, size),
        }
        let baseline = at + Point::new(long + 0.5 * size, 0.35 * size);
        page.anchored_text(words, baseline, size, INK, ["entry", "start"]);
        at.x += wanted + 1.4 * size;
    }
    let high = (at.y + 0.5 * row + margin).ceil();
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{wide}\" height=\"{high}\" \
         viewBox=\"0 0 {wide} {high}\" font-family=\"{FAMILY}\"><rect width=\"100%\" \
         height=\"100%\" fill=\"{PAPER}\"/>{}</svg>",
        page.text
    )
}

/// A metre.
fn write_ruler(page: &mut Page, at: Point, metre: f64, size: f64) {
    let [left, right] = [at.x, at.x + metre].map(short);
    let [top, y, bottom] = [at.y - 0.35 * size, at.y, at.y + 0.35 * size].map(short);
    let ruler = format!("M{left} {top}V{bottom}M{right} {top}V{bottom}M{left} {y}H{right}");
    page.path("", &ruler, &format!("fill=\"none\" stroke=\"{INK}\" stroke-width=\"2\""));
}

/// The length of a sign.
fn length(sign: &LegendSign, size: f64) -> f64 {
    match sign {
        LegendSign::Areas(colours) => size * colours.len() as f64,
        LegendSign::Dot(_) | LegendSign::Ring(_) => 0.8 * size,
        LegendSign::Line(_) | LegendSign::Thick(_) => 1.8 * size,
        LegendSign::Robot { .. } => 1.2 * size,
    }
}

/// A sign. Its left end is at a point.
fn write_sign(page: &mut Page, sign: &LegendSign, at: Point, size: f64) {
    let long = length(sign, size);
    let middle = at + Point::new(long / 2.0, 0.0);
    let stroke =
        |colour, thick: f64| format!("stroke=\"{}\" stroke-width=\"{thick}\"", hex(colour));
    match *sign {
        LegendSign::Areas(ref colours) => {
            for (number, &colour) in colours.iter().enumerate() {
                let centre = at + Point::new((number as f64 + 0.5) * size, 0.0);
                let area = Extent::around(centre, 0.5 * size, 0.5 * size);
                page.rectangle("", area, &format!("fill=\"{}\"", hex(colour)));
            }
        }
        LegendSign::Dot(colour) => {
            page.circle("", middle, long / 2.0, &format!("fill=\"{}\"", hex(colour)));
        }
        LegendSign::Ring(colour) => {
            let look = format!("fill=\"none\" {}", stroke(colour, 2.5));
            page.circle("", middle, long / 2.0, &look);
        }
        LegendSign::Line(colour) | LegendSign::Thick(colour) => {
            let thick = if matches!(sign, LegendSign::Thick(_)) { 4.0 } else { 1.5 };
            page.path("", &format!("M{at}H{}", short(at.x + long)), &stroke(colour, thick));
        }
        LegendSign::Robot { body, outline } => {
            let look = format!("fill=\"{}\" {}", hex(body), stroke(outline, 1.5));
            page.circle("", middle, long / 2.0, &look);
            let ahead = format!("M{middle}V{}", short(at.y - long / 2.0));
            page.path("", &ahead, &stroke(outline, 1.5));
        }
    }
}

fn hex(Rgb([red, green, blue]): Rgb<u8>) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

#[cfg(test)]
mod tests {
    use toposlam_vision::annotate::{STAGES, legend};

    use super::*;

    #[test]
    fn every_stage_shows_its_signs_below_an_unchanged_picture() {
        for stage in STAGES {
            let picture = RgbImage::from_pixel(800, 30, Rgb([1, 2, 3]));
            let legend = legend(stage);
            let whole = with_legend(&picture, &legend).unwrap();
            assert_eq!(whole.width(), 800);
            assert!(whole.rows().take(30).flatten().all(|&pixel| pixel == Rgb([1, 2, 3])));
            let shown = |colour: Rgb<u8>| whole.rows().skip(30).flatten().any(|&it| it == colour);
            for (sign, words) in &legend.entries {
                let colours = match sign {
                    LegendSign::Areas(colours) => colours.clone(),
                    LegendSign::Dot(colour) | LegendSign::Thick(colour) => vec![*colour],
                    LegendSign::Robot { body, .. } => vec![*body],
                    // Thin lines may cover no whole pixel.
                    LegendSign::Ring(_) | LegendSign::Line(_) => Vec::new(),
                };
                assert!(colours.into_iter().all(shown), "{stage}: {words}");
            }
        }
    }

    #[test]
    fn a_metre_is_as_long_below_the_picture_as_in_it() {
        let legend = StageLegend { entries: Vec::new(), metre: Some(133.0) };
        let whole = with_legend(&RgbImage::new(800, 1), &legend).unwrap();
        let dark: Vec<bool> = whole.pixels().map(|pixel| pixel.0[0] < 100).collect();
        let longest = dark[800..].split(|dark| !dark).map(<[bool]>::len).max();
        assert!((131..=136).contains(&longest.unwrap()), "{longest:?}");
    }

    #[test]
    fn no_entry_ends_outside_of_a_narrow_picture() {
        let svg = strip(&legend("5-scene"), 640);
        let last = svg.rsplit("<text ").next().unwrap();
        assert!(svg.matches("<text ").count() > 7 && !last.is_empty());
        let rows: std::collections::BTreeSet<_> =
            svg.split("<text ").skip(1).map(|text| text.split('"').nth(5).unwrap()).collect();
        assert!(rows.len() > 1, "{rows:?}");
    }
}
