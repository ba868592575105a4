//! The signs of a marker, drawn in red.

use toposlam_model::{
    embedded_graph::{Dart, Vertex},
    marker::{MarkerLook, MarkerPart},
};

use super::{
    WorldPicture,
    drawing::Drawing,
    geometry::{Extent, Point},
};

/// A sign, at its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Sign {
    /// A ring around a vertex.
    Ring { centre: Point, radius: f64, look: MarkerLook },
    /// A triangle that points along a direction, its base at `at`.
    Arrow { at: Point, direction: f64, scale: f64 },
    /// A bar across a direction, its middle at `at`.
    Bar { at: Point, direction: f64, scale: f64 },
}

/// The length of a triangle at scale 1.
pub(super) const ARROW: f64 = 12.0;

pub(super) fn signs(picture: &WorldPicture, drawing: &Drawing) -> Vec<Sign> {
    let mut signs: Vec<Sign> = Vec::new();
    let scale = if drawing.size.knob > 0.0 { 1.35 } else { 0.9 };
    for part in picture.parts() {
        let ring = |vertex: Vertex, look| {
            let centre = drawing.centres[vertex.at()];
            let radius = drawing.size.discs[vertex.at()] + drawing.size.knob + 3.5;
            // A second marker at the same vertex is drawn around the first.
            let there = |sign: &&Sign| matches!(sign, Sign::Ring { centre: c, .. } if *c == centre);
            let around = signs.iter().filter(there).count() as f64;
            Sign::Ring { centre, radius: radius + 4.5 * around, look }
        };
        let sign = match part {
            MarkerPart::At { vertex, look } => ring(vertex, look),
            MarkerPart::StringEnd(vertex) => ring(vertex, MarkerLook::Third),
            MarkerPart::Robot { pose, shows_heading: false } => {
                ring(picture.graph.vertex(pose), MarkerLook::One)
            }
            MarkerPart::Pointing(dart) | MarkerPart::Robot { pose: dart, .. } => {
                let vertex = picture.graph.vertex(dart).at();
                let direction = drawing.doors[dart.at()];
                let away = drawing.size.discs[vertex] + drawing.size.knob + 1.5;
                let at = drawing.centres[vertex] + Point::polar(direction, away);
                Sign::Arrow { at, direction, scale }
            }
            MarkerPart::OnEdge(dart) | MarkerPart::OnEdgeAlong(dart) => {
                let Some((middle, direction)) = on_edge(picture, drawing, dart) else { continue };
                if matches!(part, MarkerPart::OnEdge(_)) {
                    Sign::Bar { at: middle, direction, scale }
                } else {
                    let at = middle - Point::polar(direction, 0.5 * ARROW * scale);
                    Sign::Arrow { at, direction, scale }
                }
            }
        };
        signs.push(sign);
    }
    signs
}

/// Possible places of a mark, as shares of an edge, the better ones first.
const SHARES: [f64; 7] = [0.5, 0.42, 0.58, 0.34, 0.66, 0.26, 0.74];
/// A mark at this distance from everything else has enough room.
const CLEAR: f64 = 14.0;

/// The place of a mark on a dart's edge, clear of other edges, discs and the edge's name if there is room;
/// and the direction there away from the dart's vertex.
fn on_edge(picture: &WorldPicture, drawing: &Drawing, dart: Dart) -> Option<(Point, f64)> {
    let number = drawing.edges.iter().position(|&(one, other, _)| one == dart || other == dart)?;
    let (first, _, curve) = &drawing.edges[number];
    let away = if *first == dart { 1.0 } else { -1.0 };
    let clearance = |at: Point| {
        let others = drawing.edges.iter().enumerate().filter(|(other, _)| *other != number);
        let points = others.flat_map(|(_, (.., curve))| &curve.trace);
        let discs = drawing.centres.iter().zip(&drawing.size.discs);
        let name = picture.edge_names.map(|_| curve.at(0.5));
        points
            .chain(&name)
            .map(|point| point.distance(at))
            .chain(discs.map(|(centre, disc)| centre.distance(at) - disc))
            .fold(CLEAR, f64::min)
    };
    // The first of the clearest.
    let mut best = (f64::NEG_INFINITY, 0.5);
    for share in SHARES {
        let clear = clearance(curve.at(share));
        if clear > best.0 + 0.5 {
            best = (clear, share);
        }
    }
    let (_, share) = best;
    let along = (curve.at(share + 0.02) - curve.at(share - 0.02)) * away;
    Some((curve.at(share), along.angle()))
}

impl Sign {
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

    /// The same sign for a legend.
    pub(super) fn small(self, at: Point) -> Self {
        let right = Point::new(6.0, 0.0);
        match self {
            Self::Ring { look, .. } => Self::Ring { centre: at + right, radius: 5.0, look },
            Self::Arrow { .. } => Self::Arrow { at, direction: 0.0, scale: 1.0 },
            Self::Bar { .. } => Self::Bar { at: at + right, direction: 0.0, scale: 1.0 },
        }
    }
}

#[cfg(test)]
mod tests {
    use toposlam_model::{aid::named, format::named_world::NamedWorld};

    use super::{
        super::gallery::worlds::{multigraph, simple},
        *,
    };

    /// The signs of a marker, one letter each, and its text.
    fn drawn(world: &NamedWorld, marker: &str) -> (String, String) {
        let picture = WorldPicture { marker: named(marker).unwrap(), ..WorldPicture::from(world) };
        let letter = |sign: &Sign| match sign {
            Sign::Ring { look: MarkerLook::One, .. } => 'o',
            Sign::Ring { .. } => 'x',
            Sign::Arrow { .. } => '>',
            Sign::Bar { .. } => '|',
        };
        let signs = signs(&picture, &Drawing::new(&picture));
        (signs.iter().map(letter).collect(), picture.marker_place().unwrap_or_default())
    }

    #[test]
    fn each_marker_has_its_signs_and_its_words() {
        let simple = simple("triangle", "v0: v1 v2, v1: v0 v2, v2: v0 v1");
        let with_loop = multigraph("loop", "v0: e0 e0 e1, v1: e1");
        for (marker, signs, words, of_loop) in [
            ("none", "", "", ""),
            ("undirected", "o", "the marker lies at v0", "the marker lies at v0"),
            (
                "directional",
                ">",
                "the marker lies at v0 and points along door 0",
                "the marker lies at v0 and points along door 0",
            ),
            ("undirected-edge", "|", "the edge from v0 to v1 is marked", "edge e0 is marked"),
            (
                "directed-edge",
                ">",
                "the edge from v0 to v1 is marked with an arrow",
                "edge e0 is marked with an arrow",
            ),
            ("two-identical", "oo", "markers lie at v0 and v1", "both markers lie at v0"),
            ("two-distinct", "ox", "markers lie at v0 and v1 (dashed)", "both markers lie at v0"),
            ("movable", "o", "the marker lies at v0", "the marker lies at v0"),
        ] {
            assert_eq!(drawn(&simple, marker), (signs.to_owned(), words.to_owned()), "{marker}");
            assert_eq!(
                drawn(&with_loop, marker),
                (signs.to_owned(), of_loop.to_owned()),
                "{marker}"
            );
        }
    }
}
