//! What hides the floor from a camera, where no mask shows it: the robot's body, and polygons that a user has drawn.

use nalgebra::Point2;

use super::scaled_place;

#[derive(Clone, Debug, PartialEq)]
pub struct HiddenFloor {
    /// The floor nearer than this to the robot's centre is hidden, unless a mask shows it. In metres.
    pub radius: f64,
    pub polygons: Vec<Polygon>,
}

/// A polygon in pixels. It has holes where it crosses itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon(Vec<Point2<f64>>);

impl Default for HiddenFloor {
    /// The SuperScout's body.
    fn default() -> Self {
        Self { radius: 0.32, polygons: Vec::new() }
    }
}

impl HiddenFloor {
    pub(super) fn scaled(&self, factor: f64) -> Self {
        let polygons = self.polygons.iter().map(|Polygon(corners)| {
            Polygon(corners.iter().map(|&corner| scaled_place(corner, factor)).collect())
        });
        Self { radius: self.radius, polygons: polygons.collect() }
    }
}

impl Polygon {
    /// The fewest corners.
    pub const FEWEST: usize = 3;

    /// The polygon with these corners; `None` if they are too few.
    pub fn from_corners(corners: Vec<Point2<f64>>) -> Option<Self> {
        (corners.len() >= Self::FEWEST).then_some(Self(corners))
    }

    pub fn corners(&self) -> &[Point2<f64>] {
        &self.0
    }

    pub fn contains(&self, pixel: Point2<f64>) -> bool {
        let Self(corners) = self;
        let sides = corners.iter().zip(corners.iter().cycle().skip(1));
        let crossed = sides.filter(|(from, to)| {
            let crosses_row = (from.y > pixel.y) != (to.y > pixel.y);
            let along = (pixel.y - from.y) / (to.y - from.y);
            crosses_row && pixel.x < from.x + along * (to.x - from.x)
        });
        crossed.count() % 2 == 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polygon_contains_what_is_within_its_corners_at_any_size() {
        let corners = [[100.0, 100.0], [200.0, 100.0], [200.0, 150.0], [100.0, 150.0]];
        let corners = corners.map(Point2::from);
        let polygon = Polygon::from_corners(corners.to_vec()).unwrap();
        assert_eq!(Polygon::from_corners(corners[..2].to_vec()), None);
        let hidden = HiddenFloor { polygons: vec![polygon], ..HiddenFloor::default() };
        for (factor, hidden) in [(1.0, hidden.clone()), (0.5, hidden.scaled(0.5))] {
            let contains = |u: f64, v: f64| {
                hidden.polygons[0].contains(scaled_place(Point2::new(u, v), factor))
            };
            assert!(contains(150.0, 120.0) && contains(101.0, 101.0) && contains(199.0, 149.0));
            assert!(!contains(99.0, 120.0) && !contains(201.0, 120.0) && !contains(150.0, 151.0));
        }
    }
}
