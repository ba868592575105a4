//! Corners: where two walls meet at a right angle, or where one ends. Section 3, Figures 8 and 9.

use nalgebra::{Point2, Vector2};

use crate::wall::{Axis, WallSegment};

/// Walls meet if both end this near to the point where they would meet. Views.
const TOUCH: f64 = 0.22;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// In the frame, in metres.
    pub position: Point2<f64>,
    /// The directions of its two walls, on x and on y: -1 or 1. This is its type: the wall behind it,
    /// followed ahead, turns to the left or to the right.
    pub arms: Vector2<f64>,
    pub bend: Bend,
    pub formed: CornerSource,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bend {
    Inwards,
    Outwards,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CornerSource {
    Clusters,
    Cluster,
    /// The end of a wall whose continuation around the corner cannot be seen from the robot.
    End,
}

/// All corners of some walls.
// paper: sense.corner.pair, sense.corner.direction
pub fn corners(walls: &[WallSegment]) -> Vec<Corner> {
    let along = |axis: Axis| walls.iter().filter(move |wall| wall.along == axis);
    let mut corners: Vec<Corner> = Vec::new();
    for x_wall in along(Axis::X) {
        corners.extend(along(Axis::Y).filter_map(|y_wall| meeting(x_wall, y_wall, TOUCH)));
    }
    for wall in walls {
        let ends = [(wall.to, -1.0), (wall.from, 1.0)];
        corners.extend(ends.map(|(end, back)| edge(wall, end, back)));
    }
    corners
}

/// The corner of two walls, if their ends touch.
fn meeting(x_wall: &WallSegment, y_wall: &WallSegment, touch: f64) -> Option<Corner> {
    let position = Point2::new(y_wall.offset, x_wall.offset);
    let touches =
        |wall: &WallSegment, at: f64| (wall.from - at).abs().min((wall.to - at).abs()) <= touch;
    if !touches(x_wall, position.x) || !touches(y_wall, position.y) {
        return None;
    }
    let towards = |wall: &WallSegment, at: f64| f64::midpoint(wall.from, wall.to) - at;
    let arms =
        Vector2::new(towards(x_wall, position.x).signum(), towards(y_wall, position.y).signum());
    // The robot sees the two walls from between them or from over the edge.
    let between = [0, 1].map(|axis| -position[axis] * arms[axis] > 0.0);
    let bend = match between {
        [true, true] => Bend::Inwards,
        [false, false] => Bend::Outwards,
        _ => return None,
    };
    let formed = if x_wall.cluster == y_wall.cluster {
        CornerSource::Cluster
    } else {
        CornerSource::Clusters
    };
    Some(Corner { position, arms, bend, formed })
}

fn edge(wall: &WallSegment, end: f64, back: f64) -> Corner {
    let position = wall.along.point(end, wall.offset);
    let arms = wall.along.point(back, wall.offset.signum()).coords;
    Corner { position, arms, bend: Bend::Outwards, formed: CornerSource::End }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wall(along: Axis, offset: f64, from: f64, to: f64, cluster: usize) -> WallSegment {
        WallSegment { along, offset, from, to, cluster }
    }

    fn met(walls: &[WallSegment]) -> Vec<Corner> {
        corners(walls).into_iter().filter(|corner| corner.formed != CornerSource::End).collect()
    }

    /// Figure 8: an L to the left, half a metre before its turning point.
    // paper: sense.corner.pair, sense.junction.two
    #[test]
    fn the_two_corners_of_an_l_are_of_the_same_type() {
        let corners = met(&[
            wall(Axis::X, -0.8, -1.0, 1.3, 0),
            wall(Axis::Y, 1.3, -0.8, 2.0, 0),
            wall(Axis::X, 0.8, -1.0, -0.3, 1),
            wall(Axis::Y, -0.3, 0.85, 2.0, 2),
        ]);
        let [outer, inner] = corners[..] else { panic!("{corners:?}") };
        assert_eq!((outer.bend, outer.formed), (Bend::Inwards, CornerSource::Cluster));
        assert_eq!((inner.bend, inner.formed), (Bend::Outwards, CornerSource::Clusters));
        assert_eq!(outer.arms, inner.arms);
        assert_eq!(outer.position, Point2::new(1.3, -0.8));
    }

    /// Figure 9: a T entered by its stem.
    // paper: sense.corner.direction, sense.junction.three
    #[test]
    fn the_two_corners_of_a_t_are_of_different_types() {
        let corners = met(&[
            wall(Axis::X, -0.8, -1.0, -0.1, 0),
            wall(Axis::Y, -0.1, -2.0, -0.8, 0),
            wall(Axis::X, 0.8, -1.0, -0.1, 1),
            wall(Axis::Y, -0.1, 0.8, 2.0, 1),
            wall(Axis::Y, 1.5, -2.0, 2.0, 2),
        ]);
        let [right, left] = corners[..] else { panic!("{corners:?}") };
        assert_eq!([right.arms, left.arms], [[-1.0, -1.0], [-1.0, 1.0]].map(Vector2::from));
        assert_eq!([right.bend, left.bend], [Bend::Outwards; 2]);
    }

    #[test]
    fn walls_that_do_not_touch_have_no_corner() {
        assert_eq!(met(&[wall(Axis::X, 0.8, -1.0, 0.5, 0), wall(Axis::Y, 1.5, -0.8, 0.7, 1)]), []);
    }

    #[test]
    fn the_end_of_a_wall_may_be_an_edge() {
        let [ahead, behind] = corners(&[wall(Axis::X, 0.8, -1.0, 0.4, 0)])[..] else {
            panic!("two ends")
        };
        assert_eq!(
            [ahead, behind].map(|end| end.position),
            [[0.4, 0.8], [-1.0, 0.8]].map(Point2::from)
        );
        assert_eq!(
            [ahead, behind].map(|end| end.arms),
            [[-1.0, 1.0], [1.0, 1.0]].map(Vector2::from)
        );
    }
}
