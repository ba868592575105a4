//! Text as outlines of its letters, in the font that is shipped: the renderer needs no fonts.

use std::{fmt::Write, ops::Range};

use resvg::usvg::roxmltree::{Document, Error, Node};
use ttf_parser::{Face, OutlineBuilder};

/// DejaVu Sans, reduced to Latin, Greek, Cyrillic and some symbols; its licence stands beside it.
const FONT: &[u8] = include_bytes!("font/DejaVuSans-subset.ttf");

/// The SVG with a `path` in the place of each `text`. Text has a size, an anchor and places; lines and
/// words can be in `tspan` elements.
pub(super) fn with_outlines(svg: &str) -> Result<String, Error> {
    let document = Document::parse(svg)?;
    let Ok(face) = Face::parse(FONT, 0) else { return Ok(svg.to_owned()) };
    let mut outlined = String::with_capacity(2 * svg.len());
    let mut copied = 0;
    for text in document.descendants().filter(|node| node.has_tag_name("text")) {
        let Range { start, end } = text.range();
        outlined += &svg[copied..start];
        outlined += "<path";
        for attribute in text.attributes().filter(|a| ["class", "fill"].contains(&a.name())) {
            let _ = write!(outlined, " {}=\"{}\"", attribute.name(), attribute.value());
        }
        let _ = write!(outlined, " d=\"{}\"/>", outline(text, &face));
        copied = end;
    }
    outlined += &svg[copied..];
    Ok(outlined)
}

fn outline(text: Node<'_, '_>, face: &Face<'_>) -> String {
    let inherited = |name| text.ancestors().find_map(|node| node.attribute(name));
    let size = inherited("font-size").and_then(|size| size.parse().ok()).unwrap_or(16.0);
    let scale = size / f32::from(face.units_per_em());
    let before = match inherited("text-anchor") {
        Some("middle") => 0.5,
        Some("end") => 1.0,
        _ => 0.0,
    };
    let mut outline = Outline { path: String::new(), scale, x: 0.0, y: 0.0 };
    for chunk in chunks(text) {
        let glyphs: Vec<_> = chunk
            .words
            .chars()
            .map(|letter| face.glyph_index(letter).unwrap_or_default())
            .collect();
        let advance = |glyph| f32::from(face.glyph_hor_advance(glyph).unwrap_or(0)) * scale;
        let width: f32 = glyphs.iter().map(|&glyph| advance(glyph)).sum();
        outline.x = chunk.x - before * width;
        outline.y = chunk.y;
        for glyph in glyphs {
            face.outline_glyph(glyph, &mut outline);
            outline.x += advance(glyph);
        }
    }
    outline.path
}

/// Words with a place of their own.
struct Chunk {
    x: f32,
    y: f32,
    words: String,
}

fn chunks(text: Node<'_, '_>) -> Vec<Chunk> {
    let mut chunks = Vec::<Chunk>::new();
    for node in text.descendants() {
        let number = |name| node.attribute(name).and_then(|number| number.parse().ok());
        if let (Some(x), Some(y)) = (number("x"), number("y")) {
            chunks.push(Chunk { x, y, words: String::new() });
        } else if let (Some(words), Some(chunk)) =
            (node.text().filter(|_| node.is_text()), chunks.last_mut())
        {
            chunk.words += words;
        }
    }
    chunks
}

/// The data of a path, in the SVG's coordinates.
struct Outline {
    path: String,
    scale: f32,
    /// Where the present glyph begins.
    x: f32,
    y: f32,
}

impl Outline {
    fn add(&mut self, command: char, points: &[(f32, f32)]) {
        self.path.push(command);
        for (x, y) in points {
            let (x, y) = (self.x + x * self.scale, self.y - y * self.scale);
            let _ = write!(self.path, "{x:.3} {y:.3} ");
        }
    }
}

impl OutlineBuilder for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        self.add('M', &[(x, y)]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.add('L', &[(x, y)]);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.add('Q', &[(x1, y1), (x, y)]);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.add('C', &[(x1, y1), (x2, y2), (x, y)]);
    }

    fn close(&mut self) {
        self.path.push('Z');
    }
}
