//! The places of names: of vertices, in or beside their discs; of edges, on their curves, clear of
//! everything else if there is room.

use std::f64::consts::TAU;

use super::{
    WorldPicture,
    drawing::Drawing,
    geometry::{Extent, Point},
    signs::Sign,
    size::Names,
    text,
};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LabelKind {
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
    pub(super) lines: Vec<String>,
    /// The middle of the text.
    pub(super) centre: Point,
    pub(super) size: f64,
    pub(super) kind: LabelKind,
}

/// The line height, in font sizes.
pub(super) const LINE: f64 = 1.15;

impl Label {
    /// The box that the text fills.
    pub(super) fn extent(&self) -> Extent {
        let widths = self.lines.iter().map(|line| text::width(line, self.size));
        let width = widths.fold(0.0, f64::max);
        let height = self.size * (1.16 + LINE * (self.lines.len() as f64 - 1.0));
        Extent::around(self.centre, width / 2.0 + 1.5, height / 2.0)
    }
}

/// The font size of names of edges.
const EDGE_SIZE: f64 = 11.0;
/// The distances of a name from its disc.
const AWAY: [f64; 5] = [3.0, 8.0, 16.0, 28.0, 44.0];
/// The cost of covering any part of another name.
const COVERED: f64 = 300.0;

pub(super) fn labels(drawing: &Drawing, picture: &WorldPicture, signs: &[Sign]) -> Vec<Label> {
    let mut labels = Vec::new();
    let size = &drawing.size;
    let named = drawing.centres.iter().zip(picture.vertex_names).enumerate();
    for (vertex, (&centre, name)) in named.filter(|(_, (_, name))| !name.is_empty()) {
        match size.names {
            Names::Nowhere => {}
            Names::Inside | Names::Broken => {
                let lines = size.lines(name);
                labels.push(Label { lines, centre, size: size.name, kind: LabelKind::Inside });
            }
            Names::Beside => {
                let places = beside(centre, size.discs[vertex] + size.knob, name, size.name);
                labels.extend(roomiest(drawing, signs, &labels, None, places));
            }
        }
    }
    if size.knob == 0.0 {
        return labels;
    }
    if let Some(names) = picture.edge_names {
        for (number, (dart, _, curve)) in drawing.edges.iter().enumerate() {
            let Some(name) = names.get(dart.at()) else {
                continue;
            };
            let shares = [0.5, 0.45, 0.55, 0.4, 0.6, 0.35, 0.65, 0.3, 0.7, 0.25, 0.75, 0.2, 0.8];
            let places = shares.map(|share| Label {
                lines: vec![name.clone()],
                centre: curve.at(share),
                size: EDGE_SIZE,
                kind: LabelKind::Edge,
            });
            labels.extend(roomiest(drawing, signs, &labels, Some(number), places));
        }
    }
    labels
}

/// Places of a name around a disc of the given reach, the near ones first.
fn beside(centre: Point, reach: f64, name: &str, size: f64) -> Vec<Label> {
    let mut places = Vec::new();
    for away in AWAY {
        for lines in [vec![name.to_owned()], text::in_two(name)] {
            for turn in 0..24 {
                let angle = TAU * f64::from(turn) / 24.0;
                let kind = LabelKind::Beside;
                let mut label = Label { lines: lines.clone(), centre, size, kind };
                let half = label.extent().size() * 0.5;
                let aside = Point::new(angle.cos() * half.x, angle.sin() * half.y);
                label.centre = centre + Point::polar(angle, reach + away) + aside;
                places.push(label);
            }
        }
    }
    places
}

/// The place that covers the least; the first of several.
fn roomiest(
    drawing: &Drawing,
    signs: &[Sign],
    taken: &[Label],
    own: Option<usize>,
    places: impl IntoIterator<Item = Label>,
) -> Option<Label> {
    let costs = places.into_iter().enumerate().map(|(rank, label)| {
        let cost = covered(drawing, signs, taken, own, &label) + 0.1 * rank as f64;
        (cost, label)
    });
    costs.min_by(|(one, _), (other, _)| one.total_cmp(other)).map(|(_, label)| label)
}

/// The cost of what the label covers.
fn covered(
    drawing: &Drawing,
    signs: &[Sign],
    taken: &[Label],
    own: Option<usize>,
    label: &Label,
) -> f64 {
    let extent = label.extent();
    let roomy = extent.widened(3.0);
    let mut cost = 0.0;
    for other in taken {
        let shared = extent.shared_area(&other.extent());
        cost += if shared > 0.0 { COVERED + shared } else { 0.0 };
    }
    if label.kind == LabelKind::Beside {
        for hallway in drawing.hallways() {
            cost += extent.shared_area(&hallway);
        }
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
    for sign in signs {
        cost += extent.shared_area(&sign.extent());
    }
    cost
}
