//! Several drawings in one.

use std::fmt::Write;

use super::svg::PAPER;

/// The drawings of several SVG documents side by side as one document, their titles at one height.
#[must_use]
pub fn side_by_side(documents: &[String]) -> String {
    let sizes: Vec<_> = documents.iter().map(|document| size(document)).collect();
    let height = sizes.iter().map(|&[_, height]| height).fold(0.0, f64::max);
    let width: f64 = sizes.iter().map(|&[width, _]| width).sum();
    let mut together = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\">\n<rect width=\"100%\" height=\"100%\" fill=\"{PAPER}\"/>\n"
    );
    let mut left = 0.0;
    for (document, [width, _]) in documents.iter().zip(sizes) {
        let inner = document.find("<svg").map_or(document.as_str(), |at| &document[at..]);
        let _ = writeln!(together, "<g transform=\"translate({left} 0)\">\n{inner}</g>");
        left += width;
    }
    together + "</svg>\n"
}

/// The width and the height of an SVG document of this crate.
fn size(document: &str) -> [f64; 2] {
    let (_, rest) = document.split_once("viewBox=\"").unwrap_or_default();
    let (view, _) = rest.split_once('"').unwrap_or_default();
    let mut numbers = view.split(' ').skip(2).map(|number| number.parse().unwrap_or_default());
    std::array::from_fn(|_| numbers.next().unwrap_or_default())
}
