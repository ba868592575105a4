//! Least squares, principal components and the median.

use nalgebra::{Matrix2, Point2, SMatrix, SVector, Vector2};

use crate::geometry::unit;

/// The middle one of some numbers, the greater one of two; `None` if there are none.
pub(crate) fn median(numbers: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut numbers: Vec<f64> = numbers.into_iter().collect();
    let middle = numbers.len() / 2;
    (!numbers.is_empty()).then(|| *numbers.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// The normal equations of a least-squares problem with `N` unknowns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NormalEquations<const N: usize> {
    matrix: SMatrix<f64, N, N>,
    right: SVector<f64, N>,
}

impl<const N: usize> NormalEquations<N> {
    /// Equations that pull each unknown to zero with a weight.
    pub(crate) fn with_pull(weight: f64) -> Self {
        Self { matrix: SMatrix::from_diagonal_element(weight), right: SVector::zeros() }
    }

    /// Adds one observation: the unknowns, weighted by a row, sum to a value.
    pub(crate) fn add(&mut self, weight: f64, row: [f64; N], value: f64) {
        let row = SVector::from(row);
        self.matrix += weight * row * row.transpose();
        self.right += weight * value * row;
    }

    /// The unknowns. `None` if the observations do not determine them.
    pub(crate) fn solve(&self) -> Option<[f64; N]> {
        self.matrix.cholesky().map(|root| root.solve(&self.right).into())
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PrincipalAxis {
    pub(crate) mean: Point2<f64>,
    /// The unit vector along the line; which of the two, is not defined.
    pub(crate) along: Vector2<f64>,
    pub(crate) major: f64,
    pub(crate) minor: f64,
}

impl PrincipalAxis {
    /// The first principal component of points; not a number if there are none.
    pub(crate) fn fit(points: &[Point2<f64>]) -> Self {
        let count = points.len() as f64;
        let mean = points.iter().map(|point| point.coords).sum::<Vector2<f64>>() / count;
        let scatter = |point: &Point2<f64>| {
            let off = point.coords - mean;
            off * off.transpose() / count
        };
        let covariance: Matrix2<f64> = points.iter().map(scatter).sum();
        let (a, b, c) = (covariance.m11, covariance.m12, covariance.m22);
        // In two dimensions this is more exact than nalgebra's `SymmetricEigen`, whose vectors lose digits if the
        // points lie almost along an axis.
        let along = unit((2.0 * b).atan2(a - c) / 2.0);
        let (middle, half) = (f64::midpoint(a, c), ((a - c) / 2.0).hypot(b));
        Self { mean: mean.into(), along, major: middle + half, minor: middle - half }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(one: f64, other: f64) {
        assert!((one - other).abs() < 1e-12, "{one} and {other}");
    }

    #[test]
    fn least_squares_find_the_line_through_points() {
        let mut equations = NormalEquations::with_pull(0.0);
        for x in [0.0, 1.0, 2.0, 5.0] {
            equations.add(1.0 + x, [x, 1.0], 3.0 * x - 2.0);
        }
        let [slope, offset] = equations.solve().unwrap_or_default();
        near(slope, 3.0);
        near(offset, -2.0);
        let mut equations = NormalEquations::with_pull(0.0);
        equations.add(1.0, [1.0, 1.0], 2.0);
        assert_eq!(equations.solve(), None);
    }

    #[test]
    fn the_principal_component_is_an_eigenvector() {
        let shapes = [[2.0, 0.5, 1.0], [1.0, -0.3, 4.0], [3.0, 0.0, 1.0], [0.0, 0.0, 2.0]];
        for [x, y, z] in shapes {
            let points = [[x, y], [-x, z], [y, -z], [z, x], [0.3, 0.1]].map(Point2::from);
            let PrincipalAxis { mean, along, major, minor } = PrincipalAxis::fit(&points);
            let off = points.map(|point| point - mean);
            let covariance: Matrix2<f64> = off.iter().map(|off| off * off.transpose() / 5.0).sum();
            assert!((covariance * along - major * along).norm() < 1e-12);
            near(major + minor, covariance.trace());
            assert!(major >= minor);
        }
    }
}
