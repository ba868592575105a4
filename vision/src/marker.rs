//! The marker: a plain rectangle of a colour of its own on the floor. Section 5.1, Figure 10.

use toposlam_model::{
    driving::scene::{JunctionView, MarkerView, undirected},
    percept::Door,
};

use crate::{
    boundary::{BEARINGS, Boundary},
    colour::Class,
    ground_view::GroundView,
    line::Line,
};

/// The marker's length, in metres.
pub const LENGTH: f64 = 0.60;
/// Its width, in metres.
pub const WIDTH: f64 = 0.18;

/// Part of the marker's area that must be seen.
const SEEN: f64 = 0.12;
/// It lies on the floor before the wall; so far behind it a colour is something else, in metres.
const BEHIND: f64 = 0.05;
/// How far from the median point of its colour a point may be, in metres.
const FAR: f64 = 0.40;
/// At a junction it lies within this of the turning point, in metres.
const CENTRED: f64 = 0.30;

/// The marker, if enough of its colour is seen on the floor.
// paper: marker.colour
// paper: marker.pca
#[must_use]
pub fn marker(
    view: &GroundView,
    boundary: &Boundary,
    junction: Option<&JunctionView>,
) -> Option<MarkerView> {
    let points = pixels(view, boundary);
    let least = SEEN * LENGTH * WIDTH / (GroundView::SCALE * GroundView::SCALE);
    if (points.len() as f64) < least {
        return None;
    }
    let line = Line::through(&points)?;
    let axis = undirected(line.direction());
    let at_l = junction.filter(|junction| {
        let [x, y] = junction.turning_point;
        junction.doors.len() == 2 && (x - line.middle[0]).hypot(y - line.middle[1]) < CENTRED
    });
    let Some(junction) = at_l else {
        return Some(MarkerView { position: line.middle, axis, door: None });
    };
    // The body may hide a part, and then the principal component misleads: which door's rectangle
    // explains more of what is seen?
    let explained = |direction: f64| {
        let (sine, cosine) = direction.sin_cos();
        let [u, v] = junction.turning_point;
        let inside = points.iter().filter(|[x, y]| {
            let [x, y] = [x - u, y - v];
            (cosine * x + sine * y).abs() <= LENGTH / 2.0
                && (cosine * y - sine * x).abs() <= WIDTH / 2.0
        });
        inside.count()
    };
    let by_door = [0, 1].map(|door| explained(junction.doors[door].direction));
    let door = usize::from(by_door[1] > by_door[0]);
    Some(MarkerView {
        position: junction.turning_point,
        axis: undirected(junction.doors[door].direction),
        door: Some(Door(door as u32)),
    })
}

/// The points of the floor that have the marker's colour, without those far from most of them.
fn pixels(view: &GroundView, boundary: &Boundary) -> Vec<[f64; 2]> {
    let on_floor = view.marker.iter().filter_map(|&index| {
        let [x, y] = GroundView::ground(index as usize);
        let bearing = y.atan2(x) / std::f64::consts::TAU * BEARINGS as f64;
        let bearing = (bearing.round() as i64).rem_euclid(BEARINGS as i64) as usize;
        let sight = boundary.sights[bearing];
        let reach = sight.wall.unwrap_or(sight.floor) + BEHIND;
        (x.hypot(y) <= reach && is_within(view, index as usize)).then_some([x, y])
    });
    let points: Vec<_> = on_floor.collect();
    if points.is_empty() {
        return points;
    }
    let median = [0, 1].map(|axis| {
        let mut parts: Vec<f64> = points.iter().map(|point| point[axis]).collect();
        let middle = parts.len() / 2;
        *parts.select_nth_unstable_by(middle, f64::total_cmp).1
    });
    points.into_iter().filter(|[x, y]| (x - median[0]).hypot(y - median[1]) <= FAR).collect()
}

/// Whether a pixel's neighbours to the left and above have the colour, too: a speck has none.
fn is_within(view: &GroundView, index: usize) -> bool {
    let of_marker = |index: Option<usize>| {
        index.and_then(|index| view.classes.get(index)).is_some_and(|&class| class == Class::Marker)
    };
    of_marker(index.checked_sub(1)) && of_marker(index.checked_sub(GroundView::SIDE))
}
