//! Where names stand that do not fit into a disc, and the names of edges: on their curves, clear of
//! everything else as far as there is room.

use std::f64::consts::TAU;

use super::{
    Picture,
    drawing::Drawing,
    geometry::{Extent, Point},
    text,
};

/// What a label names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A vertex, inside its disc.
    Inside,
    /// A vertex, beside its disc.
    Beside,
    /// An edge, on its curve.
    Edge,
}

/// A text at its place.
#[derive(Clone, Debug)]
pub(super) struct Label {
    pub(super) text: String,
    /// The middle of the text.
    pub(super) centre: Point,
    /// The font size.
    pub(super) size: f64,
    pub(super) kind: Kind,
}

impl Label {
    fn new(text: &str, centre: Point, size: f64, kind: Kind) -> Self {
        let text = text.to_owned();
        Self { text, centre, size, kind }
    }

    /// The box that the text fills.
    pub(super) fn extent(&self) -> Extent {
        let width = text::width(&self.text, self.size);
        Extent::around(self.centre, width / 2.0 + 1.5, self.size * 0.58)
    }
}

/// The font size of names of edges.
const EDGE_SIZE: f64 = 11.0;

/// The labels of vertices and edges.
pub(super) fn labels(drawing: &Drawing, picture: &Picture) -> Vec<Label> {
    let mut labels = Vec::new();
    let mut homeless = Vec::new();
    let size = &drawing.size;
    for (vertex, name) in picture.vertex_names.iter().enumerate() {
        let Some(&centre) = drawing.centres.get(vertex) else {
            break;
        };
        if size.holds(vertex, name) {
            labels.push(Label::new(name, centre, size.name, Kind::Inside));
        } else {
            homeless.push(vertex);
        }
    }
    if size.knob == 0.0 {
        return labels;
    }
    for vertex in homeless {
        let name = &picture.vertex_names[vertex];
        let places = (0..48).map(|turn| {
            let angle = TAU * f64::from(turn % 24) / 24.0;
            let away = size.discs[vertex] + size.knob + if turn < 24 { 9.0 } else { 22.0 };
            let half = text::width(name, 11.0) / 2.0;
            let step = Point::polar(angle, away);
            let aside = Point::new(angle.cos() * half, 0.0);
            Label::new(name, drawing.centres[vertex] + step + aside, 11.0, Kind::Beside)
        });
        labels.extend(roomiest(drawing, picture, &labels, None, places));
    }
    if let Some(names) = picture.edge_names {
        for (number, (dart, _, curve)) in drawing.edges.iter().enumerate() {
            let Some(name) = names.get(dart.at()) else {
                continue;
            };
            let shares = [0.5, 0.45, 0.55, 0.4, 0.6, 0.35, 0.65, 0.3, 0.7, 0.25, 0.75, 0.2, 0.8];
            let places =
                shares.map(|share| Label::new(name, curve.at(share), EDGE_SIZE, Kind::Edge));
            labels.extend(roomiest(drawing, picture, &labels, Some(number), places));
        }
    }
    labels
}

/// The place that covers least; the first among equals.
fn roomiest(
    drawing: &Drawing,
    picture: &Picture,
    taken: &[Label],
    own: Option<usize>,
    places: impl IntoIterator<Item = Label>,
) -> Option<Label> {
    let mut best: Option<(f64, Label)> = None;
    for (rank, label) in places.into_iter().enumerate() {
        let cost = covered(drawing, picture, taken, own, &label) + 0.3 * rank as f64;
        if best.as_ref().is_none_or(|(least, _)| cost < *least) {
            best = Some((cost, label));
        }
    }
    best.map(|(_, label)| label)
}

/// How much the label covers of what is there already.
fn covered(
    drawing: &Drawing,
    picture: &Picture,
    taken: &[Label],
    own: Option<usize>,
    label: &Label,
) -> f64 {
    let extent = label.extent();
    let half = extent.size() * 0.5 + Point::new(3.0, 3.0);
    let roomy = Extent::around(extent.centre(), half.x, half.y);
    let mut cost = 0.0;
    for other in taken {
        cost += extent.shared_area(&other.extent());
    }
    for (centre, disc) in drawing.centres.iter().zip(&drawing.size.discs) {
        let radius = disc + drawing.size.knob;
        let nearest = Point::new(
            centre.x.clamp(extent.least.x, extent.most.x),
            centre.y.clamp(extent.least.y, extent.most.y),
        );
        cost += 8.0 * (radius + 1.0 - nearest.distance(*centre)).max(0.0);
    }
    for (number, (_, _, curve)) in drawing.edges.iter().enumerate() {
        if Some(number) != own {
            let inside = curve.trace.windows(2).flat_map(|two| {
                (0..4).map(|quarter| two[0] + (two[1] - two[0]) * (f64::from(quarter) / 4.0))
            });
            cost += 6.0 * inside.filter(|point| roomy.contains(*point)).count() as f64;
        }
    }
    if let Some(start) = picture.start {
        let vertex = picture.graph.vertex(start).at();
        let away = drawing.size.discs[vertex] + drawing.size.knob + 9.0;
        let arrow = drawing.centres[vertex] + Point::polar(drawing.doors[start.at()], away);
        cost += extent.shared_area(&Extent::around(arrow, 9.0, 9.0));
    }
    cost
}
