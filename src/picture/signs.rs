//! The signs of a marker: what lies where, drawn in red.

use super::{
    Picture,
    drawing::Drawing,
    geometry::{Extent, Point},
};
use crate::model::{
    embedded_graph::Dart,
    marker::{Look, Part},
};

/// A sign, at its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Sign {
    /// A ring around a vertex.
    Ring { centre: Point, radius: f64, look: Look },
    /// A triangle that points along a direction, its base at `at`.
    Arrow { at: Point, direction: f64, scale: f64 },
    /// A bar across a direction, its middle at `at`.
    Bar { at: Point, direction: f64, scale: f64 },
}

/// How long a triangle is at scale 1.
pub(super) const ARROW: f64 = 12.0;

/// The signs of the marker of a picture.
pub(super) fn signs(picture: &Picture, drawing: &Drawing) -> Vec<Sign> {
    let mut signs: Vec<Sign> = Vec::new();
    let scale = if drawing.size.knob > 0.0 { 1.35 } else { 0.9 };
    for part in picture.parts() {
        let sign = match part {
            Part::At { vertex, look } => {
                let centre = drawing.centres[vertex.at()];
                let radius = drawing.size.discs[vertex.at()] + drawing.size.knob + 3.5;
                // A second one at the same vertex lies around the first.
                let there =
                    |sign: &&Sign| matches!(sign, Sign::Ring { centre: c, .. } if *c == centre);
                let around = signs.iter().filter(there).count() as f64;
                Sign::Ring { centre, radius: radius + 4.5 * around, look }
            }
            Part::Pointing(dart) => {
                let vertex = picture.graph.vertex(dart).at();
                let direction = drawing.doors[dart.at()];
                let away = drawing.size.discs[vertex] + drawing.size.knob + 1.5;
                let at = drawing.centres[vertex] + Point::polar(direction, away);
                Sign::Arrow { at, direction, scale }
            }
            Part::OnEdge(dart) => match on_edge(picture, drawing, dart) {
                Some((at, direction)) => Sign::Bar { at, direction, scale },
                None => continue,
            },
            Part::OnEdgeAlong(dart) => match on_edge(picture, drawing, dart) {
                Some((middle, direction)) => {
                    let at = middle - Point::polar(direction, 0.5 * ARROW * scale);
                    Sign::Arrow { at, direction, scale }
                }
                None => continue,
            },
        };
        signs.push(sign);
    }
    signs
}

/// The place of a mark on a dart's edge, and the direction there away from the dart's vertex.
fn on_edge(picture: &Picture, drawing: &Drawing, dart: Dart) -> Option<(Point, f64)> {
    let (first, _, curve) =
        drawing.edges.iter().find(|&&(one, other, _)| one == dart || other == dart)?;
    let away = if *first == dart { 1.0 } else { -1.0 };
    // In the middle of an edge stands its name, if it has one.
    let share = match (picture.edge_names, *first == dart) {
        (None, _) => 0.5,
        (Some(_), true) => 0.3,
        (Some(_), false) => 0.7,
    };
    let along = (curve.at(share + 0.02) - curve.at(share - 0.02)) * away;
    Some((curve.at(share), along.angle()))
}

impl Sign {
    /// The box that it fills.
    pub(super) fn extent(&self) -> Extent {
        match *self {
            Self::Ring { centre, radius, .. } => Extent::around(centre, radius + 1.5, radius + 1.5),
            Self::Arrow { at, direction, scale } => {
                let middle = at + Point::polar(direction, 0.5 * ARROW * scale);
                Extent::around(middle, 6.7 * scale, 6.7 * scale)
            }
            Self::Bar { at, scale, .. } => Extent::around(at, 6.0 * scale, 6.0 * scale),
        }
    }

    /// The same sign, moved by a step.
    pub(super) fn moved(self, step: Point) -> Self {
        match self {
            Self::Ring { centre, radius, look } => {
                Self::Ring { centre: centre + step, radius, look }
            }
            Self::Arrow { at, direction, scale } => Self::Arrow { at: at + step, direction, scale },
            Self::Bar { at, direction, scale } => Self::Bar { at: at + step, direction, scale },
        }
    }

    /// The same sign as it stands in a legend.
    pub(super) fn small(self, at: Point) -> Self {
        let right = Point::new(6.0, 0.0);
        match self {
            Self::Ring { look, .. } => Self::Ring { centre: at + right, radius: 5.0, look },
            Self::Arrow { .. } => Self::Arrow { at, direction: 0.0, scale: 1.0 },
            Self::Bar { .. } => Self::Bar { at: at + right, direction: 0.0, scale: 1.0 },
        }
    }
}
