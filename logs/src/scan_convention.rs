//! How the scans of a topic are read: their sign of no return, and the repair of their angles.

use super::{no_return::NoReturnSign, reading_remark::ReadingRemark};

/// What is repaired in the scans of a topic.
#[derive(Default)]
pub(super) struct ScanRepairs {
    sign: Option<NoReturnSign>,
    no_returns: u64,
    increments: u64,
    without_angle_max: u64,
}

/// The last angle may be so many increments off.
const MOST_OFF: f64 = 3.0;
/// The ratio of the right increment and the recorded one is nearly a whole number, or its inverse.
const WHOLE: f64 = 0.02;

impl ScanRepairs {
    pub(super) fn new(sign: Option<NoReturnSign>) -> Self {
        Self { sign, ..Self::default() }
    }

    /// A reading, which is infinite if there is no return.
    pub(super) fn range(&mut self, range: f64) -> f32 {
        let is_sign = match self.sign {
            None => false,
            Some(NoReturnSign::From(from)) => range >= from,
            Some(NoReturnSign::Zero) => range == 0.0,
            Some(NoReturnSign::NotANumber) => range.is_nan(),
        };
        if is_sign {
            self.no_returns += 1;
            return f32::INFINITY;
        }
        range as f32
    }

    /// The largest range of a scanner, of which its driver states this one: it sees nothing beyond its sign.
    pub(super) fn range_max(&self, stated: f64) -> f64 {
        match self.sign {
            Some(NoReturnSign::From(from)) => stated.min(from),
            _ => stated,
        }
    }

    /// The increment of the angle of a scan with so many readings, in radians.
    ///
    /// # Errors
    /// Returns an error if the last angle contradicts it.
    pub(super) fn increment(
        &mut self,
        [first, last, increment]: [f64; 3],
        readings: usize,
    ) -> Result<f64, String> {
        let steps = readings.saturating_sub(1) as f64;
        let reached = first + steps * increment;
        let off = ((last - reached) / increment).abs();
        if steps == 0.0 || increment == 0.0 || !increment.is_finite() || off <= MOST_OFF {
            return Ok(increment);
        }
        if last == 0.0 || !last.is_finite() {
            self.without_angle_max += 1;
            return Ok(increment);
        }
        let right = (last - first) / steps;
        let ratio = right / increment;
        let is_whole = |ratio: f64| ratio >= 1.5 && (ratio - ratio.round()).abs() <= WHOLE * ratio;
        if is_whole(ratio) || is_whole(1.0 / ratio) {
            self.increments += 1;
            return Ok(right);
        }
        Err(format!(
            "its angle_max is {last:.4}, but {readings} readings from {first:.4} in steps of {increment:.5} end at \
             {reached:.4}"
        ))
    }

    pub(super) fn remarks(&self) -> impl Iterator<Item = ReadingRemark> {
        let Self { no_returns: readings, increments, without_angle_max, .. } = *self;
        let sign = self.sign.filter(|_| readings > 0);
        let no_return = sign.map(|sign| ReadingRemark::NoReturn { sign, readings });
        let spread = ReadingRemark::AngleIncrement { scans: increments };
        let unset = ReadingRemark::NoAngleMax { scans: without_angle_max };
        let spread = (increments > 0).then_some(spread);
        let unset = (without_angle_max > 0).then_some(unset);
        no_return.into_iter().chain(spread).chain(unset)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_increment_leads_to_the_last_angle_or_is_repaired_or_wrong() {
        let increment = |angles, readings| ScanRepairs::default().increment(angles, readings);
        assert_eq!(increment([-1.0, 1.0, 0.02], 101), Ok(0.02));
        // A full circle whose last angle is the first one.
        assert_eq!(increment([0.0, 2.0, 0.02], 100), Ok(0.02));
        // Every second reading, and half of an increment.
        assert_eq!(increment([-1.0, 1.0, 0.02], 51), Ok(0.04));
        assert_eq!(increment([-1.0, 1.0, 0.04], 101), Ok(0.02));
        assert_eq!(increment([-1.0, 0.0, 0.02], 101), Ok(0.02));
        let error = increment([1.0, -1.0, 0.02], 101).unwrap_err();
        let expected = "its angle_max is -1.0000, but 101 readings from 1.0000 in steps of 0.02000 end at 3.0000";
        assert_eq!(error, expected);
        assert!(increment([-1.0, 1.0, 0.02], 80).is_err());
    }
}
