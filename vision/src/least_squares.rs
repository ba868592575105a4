//! Small linear algebra: normal equations and principal components.

/// The normal equations of a least-squares problem with `N` unknowns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NormalEquations<const N: usize> {
    matrix: [[f64; N]; N],
    right: [f64; N],
}

impl<const N: usize> NormalEquations<N> {
    /// Equations that pull each unknown to zero with a weight.
    pub(crate) fn with_pull(weight: f64) -> Self {
        let mut matrix = [[0.0; N]; N];
        for (at, row) in matrix.iter_mut().enumerate() {
            row[at] = weight;
        }
        Self { matrix, right: [0.0; N] }
    }

    /// Adds one observation: the unknowns, weighted by a row, sum to a value.
    pub(crate) fn add(&mut self, weight: f64, row: [f64; N], value: f64) {
        for (at, factor) in row.iter().enumerate() {
            for (entry, other) in self.matrix[at].iter_mut().zip(row) {
                *entry += weight * factor * other;
            }
            self.right[at] += weight * value * factor;
        }
    }

    /// The unknowns, by Cholesky's decomposition. `None` if the observations do not determine them.
    pub(crate) fn solve(&self) -> Option<[f64; N]> {
        let mut root = self.matrix;
        let mut unknowns = self.right;
        for column in 0..N {
            for row in column..N {
                let done: f64 = (0..column).map(|k| root[row][k] * root[column][k]).sum();
                let rest = root[row][column] - done;
                root[row][column] = if row > column {
                    rest / root[column][column]
                } else if rest > 0.0 {
                    rest.sqrt()
                } else {
                    return None;
                };
            }
        }
        for row in 0..N {
            let done: f64 = (0..row).map(|k| root[row][k] * unknowns[k]).sum();
            unknowns[row] = (unknowns[row] - done) / root[row][row];
        }
        for row in (0..N).rev() {
            let done: f64 = (row + 1..N).map(|k| root[k][row] * unknowns[k]).sum();
            unknowns[row] = (unknowns[row] - done) / root[row][row];
        }
        Some(unknowns)
    }
}

/// The first principal component of a symmetric matrix `[[a, b], [b, c]]`: the unit vector, and the larger
/// and the smaller eigenvalue.
pub(crate) fn principal_component(a: f64, b: f64, c: f64) -> ([f64; 2], [f64; 2]) {
    let (sine, cosine) = ((2.0 * b).atan2(a - c) / 2.0).sin_cos();
    let middle = f64::midpoint(a, c);
    let half = ((a - c) / 2.0).hypot(b);
    ([cosine, sine], [middle + half, middle - half])
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
        for [a, b, c] in [[2.0, 0.5, 1.0], [1.0, -0.3, 4.0], [3.0, 0.0, 1.0], [0.0, 0.0, 2.0]] {
            let ([x, y], [large, small]) = principal_component(a, b, c);
            near(a * x + b * y, large * x);
            near(b * x + c * y, large * y);
            near(large + small, a + c);
            assert!(large >= small);
        }
    }
}
