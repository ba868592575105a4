//! How often a percept is false, as it was measured, and the chance that a wrong map survives its audits.

use super::bound::upper_bound;

/// A measurement of false percepts, and the command that repeats it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FalsePercepts {
    /// The number of traversals with a false percept, or to a wrong place.
    pub seen: usize,
    /// The number of traversals.
    pub of: usize,
    /// The command.
    pub command: &'static str,
}

impl FalsePercepts {
    /// Of scenes with the measured error rates of sensing.
    pub const BY_SCENE: Self = Self { seen: 0, of: 20_000, command: "evaluate control" };
    /// Of rendered images.
    pub const BY_IMAGE: Self =
        Self { seen: 0, of: 400, command: "evaluate control --images --traversals 400 --plans 10" };
    /// Of simulated laser scans.
    pub const BY_LASER: Self = Self {
        seen: 6,
        of: 2000,
        command: "evaluate control --sensor laser --traversals 2000 --plans 10",
    };

    /// The upper bound of their rate, with a confidence of 95 %.
    #[must_use]
    pub fn rate(self) -> f64 {
        upper_bound(self.seen, self.of)
    }

    /// The largest chance that a wrong map survives audits with these numbers of percepts. In each of them a
    /// percept must be false, and any percept may be the one.
    #[must_use]
    pub fn survival(self, audits: &[u64]) -> f64 {
        audits.iter().map(|&percepts| (percepts as f64 * self.rate()).min(1.0)).product()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_audit_must_have_a_false_percept_of_its_own() {
        let rate = FalsePercepts::BY_IMAGE.rate();
        // The rule of three.
        assert!((rate - 3.0 / 400.0).abs() < 1e-4, "{rate}");
        let survival = |audits: &[u64]| FalsePercepts::BY_IMAGE.survival(audits);
        assert!((survival(&[]) - 1.0).abs() < 1e-12);
        assert!((survival(&[13]) - 13.0 * rate).abs() < 1e-12);
        assert!((survival(&[13, 12]) - 13.0 * 12.0 * rate * rate).abs() < 1e-12);
        assert!((survival(&[1000]) - 1.0).abs() < 1e-12);
    }
}
