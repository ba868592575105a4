//! Straight lines through boundary points, by principal components. Section 3.

use nalgebra::{Point2, Vector2, distance};

use crate::{cluster::Cluster, geometry::angle, least_squares::PrincipalAxis};

/// A cluster is split at a point this far from the chord between its ends, at the robot. Views.
const BEND: f64 = 0.035;
/// What each metre from the robot adds to that distance. Geometry: as `cluster::GAP_PER_METRE`.
const BEND_PER_METRE: f64 = 0.02;
/// The fewest points of a line. Views.
const MIN_POINTS: usize = 5;
/// The least length of a line. Views.
const MIN_LENGTH: f64 = 0.10;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallLine {
    pub middle: Point2<f64>,
    /// The unit vector along it, from the first point to the last.
    pub along: Vector2<f64>,
    /// Its first end, counter-clockwise as seen from the robot, in metres.
    pub from: Point2<f64>,
    pub to: Point2<f64>,
    /// The root mean square of its points' distances from it, in metres.
    pub spread: f64,
    pub points: usize,
    pub cluster: usize,
}

impl WallLine {
    /// The line that fits the points best: their first principal component. `None` for fewer than two
    /// different points.
    // paper: sense.pca
    pub fn through(points: &[Point2<f64>]) -> Option<Self> {
        let (first, last) = (*points.first()?, *points.last()?);
        let PrincipalAxis { mean: middle, along, major, minor } = PrincipalAxis::fit(points);
        if major <= 0.0 {
            return None;
        }
        let along = if along.dot(&(last - first)) < 0.0 { -along } else { along };
        let spread = minor.max(0.0).sqrt();
        let line =
            Self { middle, along, from: first, to: last, spread, points: points.len(), cluster: 0 };
        Some(Self { from: line.foot(first), to: line.foot(last), ..line })
    }

    fn foot(&self, point: Point2<f64>) -> Point2<f64> {
        self.middle + (point - self.middle).dot(&self.along) * self.along
    }

    pub fn length(&self) -> f64 {
        distance(&self.from, &self.to)
    }

    /// Its direction, in radians counter-clockwise from ahead.
    pub fn direction(&self) -> f64 {
        angle(self.along)
    }
}

/// The straight pieces of clusters. A cluster is split at the point farthest from the chord between its
/// ends, until no point is far (Ramer 1972, Douglas and Peucker 1973).
// paper: sense.corner.single
pub fn lines(clusters: &[Cluster]) -> Vec<WallLine> {
    let pieces = clusters.iter().enumerate().flat_map(|(number, cluster)| {
        split(cluster).into_iter().map(move |line| WallLine { cluster: number, ..line })
    });
    pieces.collect()
}

fn split(cluster: &Cluster) -> Vec<WallLine> {
    let mut lines = Vec::new();
    let mut open = vec![cluster.points.as_slice()];
    while let Some(points) = open.pop() {
        match bend(points) {
            Some(at) => open.extend([&points[at..], &points[..=at]]),
            None => lines.extend(
                WallLine::through(points)
                    .filter(|line| line.points >= MIN_POINTS && line.length() >= MIN_LENGTH),
            ),
        }
    }
    lines
}

/// The index of the point farthest from the chord between the ends, if it is far.
fn bend(points: &[Point2<f64>]) -> Option<usize> {
    let (&first, &last) = (points.first()?, points.last()?);
    if points.len() < 2 * MIN_POINTS {
        return None;
    }
    let chord = last - first;
    let off = |point: Point2<f64>| {
        let from_first = point - first;
        if chord.norm() < MIN_LENGTH {
            return from_first.norm();
        }
        from_first.perp(&chord).abs() / chord.norm()
    };
    let inner = 1..points.len() - 1;
    let at = inner.max_by(|&one, &other| off(points[one]).total_cmp(&off(points[other])))?;
    let far = BEND + BEND_PER_METRE * points[at].coords.norm();
    (off(points[at]) > far).then_some(at)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cluster(points: impl IntoIterator<Item = [f64; 2]>) -> Cluster {
        Cluster { points: points.into_iter().map(Point2::from).collect() }
    }

    // paper: sense.pca
    #[test]
    fn a_straight_cluster_is_one_line() {
        let wall =
            cluster((0..50).map(|step| [0.02 * f64::from(step), 1.0 + 0.01 * f64::from(step)]));
        let [line] = split(&wall)[..] else { panic!("one line") };
        assert!((line.direction() - 0.5_f64.atan()).abs() < 1e-9);
        assert!(line.spread < 1e-6);
        assert!((line.length() - 0.02 * 49.0 * 1.25_f64.sqrt()).abs() < 1e-9);
    }

    // paper: sense.corner.single
    #[test]
    fn a_bent_cluster_is_two_lines_at_a_right_angle() {
        let bent = cluster(
            (0..50)
                .map(|step| [1.0, 0.02 * f64::from(step) - 0.5])
                .chain((1..50).map(|step| [1.0 - 0.02 * f64::from(step), 0.48])),
        );
        let [one, other] = split(&bent)[..] else { panic!("two lines") };
        let dot = one.along.dot(&other.along);
        assert!(dot.abs() < 0.02, "{dot}");
        assert!(distance(&one.to, &other.from) < 0.05);
    }

    #[test]
    fn one_point_is_not_a_line() {
        assert_eq!(WallLine::through(&[]), None);
        assert_eq!(WallLine::through(&[Point2::new(1.0, 1.0); 9]), None);
    }
}
