//! Several drawings in one.

use std::fmt::Write;

use super::svg::PAPER;

/// The drawings of several SVG documents side by side as one document, their titles at one height.
#[must_use]
pub fn side_by_side(documents: &[String]) -> String {
    let sizes: Vec<_> = documents.iter().map(|document| size(document)).collect();
    let height = sizes.iter().map(|&(_, height)| height).fold(0.0, f64::max);
    let width: f64 = sizes.iter().map(|&(width, _)| width).sum();
    let mut together = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\">\n<rect width=\"100%\" height=\"100%\" fill=\"{PAPER}\"/>\n"
    );
    let mut left = 0.0;
    for (document, (width, _)) in documents.iter().zip(sizes) {
        let inner = document.find("<svg").map_or(document.as_str(), |at| &document[at..]);
        let _ = writeln!(together, "<g transform=\"translate({left} 0)\">\n{inner}</g>");
        left += width;
    }
    together + "</svg>\n"
}

/// The width and the height of an SVG document of this crate.
fn size(document: &str) -> (f64, f64) {
    let attribute = |name: &str| {
        let (_, rest) = document.split_once(&format!(" {name}=\""))?;
        rest.split_once('"')?.0.parse().ok()
    };
    let [width, height] = ["width", "height"].map(|name| attribute(name).unwrap_or_default());
    (width, height)
}

#[cfg(test)]
mod tests {
    use resvg::usvg::roxmltree::Document;

    use super::*;

    #[test]
    fn drawings_stand_beside_each_other_and_all_are_shown() {
        let drawing = |width: f64, height: f64| {
            format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\"/>\n"
            )
        };
        let together = side_by_side(&[drawing(30.0, 20.0), drawing(12.5, 40.0)]);
        let document = Document::parse(&together).unwrap();
        let root = document.root_element();
        assert_eq!([root.attribute("width"), root.attribute("height")], [Some("42.5"), Some("40")]);
        let places = root.descendants().filter_map(|node| node.attribute("transform"));
        assert_eq!(places.collect::<Vec<_>>(), ["translate(0 0)", "translate(30 0)"]);
    }
}
