//! The marker: a rectangle on the floor in its own colour. Section 5.1, Figure 10.

use nalgebra::{Point2, UnitComplex, distance};
use toposlam_model::{
    driving::scene::{JunctionView, MarkerView, undirected},
    percept::Door,
};

use crate::{
    bearing::bearing,
    boundary::Boundary,
    colour::PixelClass,
    geometry::angle,
    ground_view::GroundView,
    least_squares::median,
    line::WallLine,
    params::{MARKER_LENGTH, MARKER_WIDTH},
};

/// The least part of the marker's area that must be seen. Views.
const MIN_SEEN: f64 = 0.12;
/// The marker lies in front of the wall. Its colour farther behind is something else. Views.
const MAX_BEHIND: f64 = 0.05;
/// Points of its colour farther from their median are something else. Geometry: a little more than half its length.
const MAX_SPREAD: f64 = 0.40;
/// At a junction it lies this near to the turning point. Geometry: half its length.
const MAX_OFF_CENTRE: f64 = 0.30;

/// The marker, if enough of its colour is seen on the floor.
// paper: marker-sense.present, marker-sense.direction
pub fn marker(
    view: &GroundView,
    boundary: &Boundary,
    junction: Option<&JunctionView>,
) -> Option<MarkerView> {
    let points = pixels(view, boundary);
    let least = MIN_SEEN * MARKER_LENGTH * MARKER_WIDTH / (GroundView::SCALE * GroundView::SCALE);
    if (points.len() as f64) < least {
        return None;
    }
    let line = WallLine::through(&points)?;
    let axis = undirected(line.direction());
    let at_l = junction.filter(|junction| {
        junction.doors.len() == 2
            && distance(&junction.turning_point.into(), &line.middle) < MAX_OFF_CENTRE
    });
    let Some(junction) = at_l else {
        return Some(MarkerView { position: line.middle.into(), axis, door: None });
    };
    // The body may hide a part of the marker; then its principal component is wrong. So choose the door
    // whose rectangle contains more of what is seen.
    let explained = |direction: f64| {
        let marker_from_robot = UnitComplex::new(-direction);
        let middle = Point2::from(junction.turning_point);
        let inside = points.iter().filter(|&point| {
            let off = marker_from_robot * (point - middle);
            off.x.abs() <= MARKER_LENGTH / 2.0 && off.y.abs() <= MARKER_WIDTH / 2.0
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

/// The points of the floor in the marker's colour, without those far from most of them.
fn pixels(view: &GroundView, boundary: &Boundary) -> Vec<Point2<f64>> {
    let on_floor = view.pixels_of(PixelClass::Marker).into_iter().filter_map(|index| {
        let point = GroundView::ground(index);
        let sight = boundary.sights[bearing(angle(point.coords))];
        let reach = sight.floor + MAX_BEHIND;
        (point.coords.norm() <= reach && is_within(view, index)).then_some(point)
    });
    let points: Vec<_> = on_floor.collect();
    let middle =
        [0, 1].map(|axis| median(points.iter().map(|point| point[axis])).unwrap_or_default());
    let middle = Point2::from(middle);
    points.into_iter().filter(|point| distance(point, &middle) <= MAX_SPREAD).collect()
}

/// Whether the pixels to the left and above have the colour, too; a speck has no such neighbours.
fn is_within(view: &GroundView, index: usize) -> bool {
    let of_marker = |index: Option<usize>| {
        index.and_then(|index| view.class(index)) == Some(PixelClass::Marker)
    };
    of_marker(index.checked_sub(1)) && of_marker(index.checked_sub(GroundView::SIDE))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use nalgebra::Vector2;
    use toposlam_model::driving::scene::CentreLine;

    use super::*;
    use crate::drawn_place;

    fn floor_with_aid(position: [f64; 2], axis: f64) -> GroundView {
        let mut view = GroundView::drawn();
        for index in 0..view.classes.len() {
            let [x, y] = GroundView::ground(index).into();
            let off = UnitComplex::new(-axis) * Vector2::new(x - position[0], y - position[1]);
            let on_it = off.x.abs() <= MARKER_LENGTH / 2.0 && off.y.abs() <= MARKER_WIDTH / 2.0;
            view.classes[index] = match () {
                () if x.hypot(y) < 0.32 => PixelClass::Unseen,
                () if on_it => PixelClass::Marker,
                () => PixelClass::Floor,
            };
        }
        view
    }

    fn found(position: [f64; 2], axis: f64, junction: Option<&JunctionView>) -> Option<MarkerView> {
        let view = floor_with_aid(position, axis);
        marker(&view, &drawn_place::bearings().look(&view), junction)
    }

    // paper: marker-sense.direction, marker-sense.shape
    #[test]
    fn a_whole_marker_has_its_true_position_and_axis() {
        for axis in [0.0, 0.7, 1.5, -1.2] {
            let view = found([1.0, 0.2], axis, None).unwrap();
            assert!((view.position[0] - 1.0).abs() < 0.01 && (view.position[1] - 0.2).abs() < 0.01);
            assert!(undirected(view.axis - axis).abs() < 0.02, "{} is not {axis}", view.axis);
            assert_eq!(view.door, None);
        }
    }

    // paper: marker-sense.present
    #[test]
    fn no_marker_is_seen_under_the_body_or_behind_a_wall() {
        assert_eq!(found([0.0, 0.0], 0.0, None), None);
        let mut view = floor_with_aid([1.5, 0.0], 0.3);
        for index in 0..view.classes.len() {
            let x = GroundView::ground(index).x;
            if (1.0..1.05).contains(&x) {
                view.classes[index] = PixelClass::Stripe;
            } else if x > 1.05 && view.classes[index] == PixelClass::Floor {
                view.classes[index] = PixelClass::Other;
            }
        }
        let boundary = drawn_place::bearings().look(&view);
        assert_eq!(marker(&view, &boundary, None), None);
    }

    #[test]
    fn a_marker_half_hidden_by_the_body_still_gives_its_door() {
        let l = |distance: f64| JunctionView {
            doors: [PI, FRAC_PI_2]
                .map(|direction| CentreLine { through: [distance, 0.0], direction })
                .to_vec(),
            turning_point: [distance, 0.0],
            confidence: 1.0,
        };
        for distance in [0.3, 0.5, 0.8] {
            for (axis, door) in [(0.0, 0), (FRAC_PI_2, 1)] {
                let view = found([distance, 0.0], axis, Some(&l(distance))).unwrap();
                assert_eq!(view.door, Some(Door(door)), "{distance} before, lying at {axis}");
            }
        }
    }
}
