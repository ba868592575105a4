//! Quantiles of a sample.

/// A quantile.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantile {
    /// Half of the values are below it.
    Median,
    /// 95 % of the values are below it.
    P95,
    /// 99 % of the values are below it.
    P99,
    /// The greatest value.
    Most,
}

impl Quantile {
    /// All quantiles.
    pub const ALL: [Self; 4] = [Self::Median, Self::P95, Self::P99, Self::Most];

    /// The share of values below it.
    #[must_use]
    pub fn part(self) -> f64 {
        match self {
            Self::Median => 0.5,
            Self::P95 => 0.95,
            Self::P99 => 0.99,
            Self::Most => 1.0,
        }
    }
}

/// ArrivalMeasurement values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ErrorSample {
    /// Ascending.
    values: Vec<f64>,
}

impl FromIterator<f64> for ErrorSample {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut values: Vec<_> = values.into_iter().collect();
        values.sort_by(f64::total_cmp);
        Self { values }
    }
}

impl ErrorSample {
    /// The number of values.
    #[must_use]
    pub fn count(&self) -> usize {
        self.values.len()
    }

    /// The number of values greater than a limit.
    #[must_use]
    pub fn exceeding(&self, limit: f64) -> usize {
        self.values.len() - self.values.partition_point(|value| *value <= limit)
    }

    /// The value below which this share of the values lies, from 0 to 1; `None` without values.
    /// Between two values it is interpolated (Hyndman and Fan 1996, definition 7, as in R and
    /// NumPy).
    #[must_use]
    #[expect(clippy::cast_sign_loss, reason = "a place in a list is not negative")]
    pub fn quantile(&self, part: f64) -> Option<f64> {
        let at = part.clamp(0.0, 1.0) * (self.values.len().checked_sub(1)? as f64);
        let (below, above) = (at.floor(), at.ceil());
        let [low, high] = [below, above].map(|at| self.values[at as usize]);
        Some(low + (high - low) * (at - below))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_definition_7() {
        // quantile(c(15, 20, 35, 40, 50), c(0, 0.05, 0.4, 0.5, 0.95, 1)) in R.
        let sample: ErrorSample = [40.0, 15.0, 50.0, 35.0, 20.0].into_iter().collect();
        let expected =
            [(0.0, 15.0), (0.05, 16.0), (0.4, 29.0), (0.5, 35.0), (0.95, 48.0), (1.0, 50.0)];
        for (part, value) in expected {
            let found = sample.quantile(part).unwrap();
            assert!((found - value).abs() < 1e-12, "{part}: {found}");
        }
    }

    #[test]
    fn a_value_at_the_limit_does_not_exceed_it() {
        let sample: ErrorSample = [3.0, 1.0, 2.0, 2.0].into_iter().collect();
        assert_eq!([0.5, 1.0, 2.0, 3.0].map(|limit| sample.exceeding(limit)), [4, 3, 1, 0]);
    }

    #[test]
    fn an_empty_sample_has_no_quantile() {
        assert_eq!(ErrorSample::default().quantile(0.5), None);
        assert_eq!([7.0].into_iter().collect::<ErrorSample>().quantile(0.99), Some(7.0));
    }
}
