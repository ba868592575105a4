//! The drawing as SVG text.
//!
//! Discs are `circle.vertex`, doors `circle.door`, edges `path.edge`; `data-vertex`, `data-door`,
//! `data-dart` and `data-darts` identify them, so that a program can read the order off the
//! picture too. An edge runs from the first of its darts to the second. All names are in one `g.names`, so
//! that the walk page can put a robot below them.

mod figure;
mod page;
mod sheet;

use super::{
    WorldPicture,
    drawing::Drawing,
    labels::{Label, labels},
    signs::{Sign, signs},
};

pub(super) use page::{FAINT, INK, MARKER, PAPER, Page, short};
pub(super) use sheet::{NORTH, Sheet};

/// Whether the picture has a legend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Legend {
    /// Below the drawing.
    Below,
    /// No legend.
    Elsewhere,
}

/// The picture as an SVG document.
pub(super) fn document(picture: &WorldPicture, drawing: &Drawing, legend: Legend) -> String {
    let signs = signs(picture, drawing);
    let labels = labels(drawing, picture, &signs);
    let added = labels.iter().map(Label::extent).chain(signs.iter().map(Sign::extent));
    let extent = drawing.extent().joined(added);
    let metre = drawing.floor.map(|floor| floor.metre);
    let WorldPicture { title, caption, .. } = *picture;
    let sheet = Sheet { title, caption, extent, metre, up: NORTH };
    let says = match legend {
        Legend::Below => sheet.legend(says(picture, drawing)),
        Legend::Elsewhere => Vec::new(),
    };
    sheet.document(&says, signs.first(), |page| {
        page.drawing(picture, drawing, &signs);
        page.line("<g class=\"names\">");
        for label in &labels {
            page.label(label);
        }
        page.line("</g>");
    })
}

/// The legend of the signs.
fn says(picture: &WorldPicture, drawing: &Drawing) -> Vec<String> {
    let mut says = Vec::new();
    says.extend(picture.marker_place());
    if drawing.size.knob > 0.0 && picture.graph.vertices().any(|v| picture.graph.degree(v) > 1) {
        says.push("doors are numbered clockwise from each vertex's first".to_owned());
    }
    says
}
