//! How the scans of a topic write that there is no return. By REP 117 that is an infinite range; many drivers write
//! a little less than the largest range, 0 or not a number.

use std::{fmt, sync::PoisonError};

use super::{reader::Log, reading_remark::ReadingRemark, value::Value};

/// What the readings of a log are if there is no return.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoReturnSign {
    /// From this range on, in metres, which is below the largest range.
    From(f64),
    Zero,
    NotANumber,
}

impl fmt::Display for NoReturnSign {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::From(range) => write!(out, "a range of {range:.2} m and more"),
            Self::Zero => write!(out, "a range of 0"),
            Self::NotANumber => write!(out, "a range that is not a number"),
        }
    }
}

/// More scans are not looked at.
const SURVEYED: usize = 20_000;
/// The readings without a return are at most this far below the largest range, in bins, of which one is a centimetre.
const BINS: usize = 100;
/// They lie within so many bins.
const WIDTH: usize = 6;
/// Those of walls at the same distance from the scanner are at most one in so many of them.
const SHARE: usize = 5;
/// One reading in so many shows what the sign is.
const SEEN: usize = 500;

#[derive(Default)]
struct Histogram {
    all: usize,
    zeros: usize,
    not_numbers: usize,
    /// Infinite, or not below the largest range.
    beyond: usize,
    range_max: f64,
    /// Below the largest range, the nearest first.
    bins: Vec<usize>,
}

/// The sign of the scans on a topic; `None` if it is the usual one, or none is seen. The scans are read once.
pub(super) fn of_topic(log: &Log, index: usize) -> Option<NoReturnSign> {
    let mut known = log.no_returns.lock().unwrap_or_else(PoisonError::into_inner);
    *known.entry(index).or_insert_with(|| surveyed(log, index))
}

fn surveyed(log: &Log, index: usize) -> Option<NoReturnSign> {
    let topic = log.topics().get(index)?;
    if topic.short_type() != "sensor_msgs/LaserScan" {
        return None;
    }
    let mut histogram = Histogram { bins: vec![0; BINS], ..Histogram::default() };
    for message in log.read(&[index]).take(SURVEYED).map_while(Result::ok) {
        if let Some(Ok(value)) = topic.decode(&message.bytes) {
            histogram.add(&value);
        }
    }
    histogram.sign()
}

impl Histogram {
    fn add(&mut self, scan: &Value<'_>) {
        let Some(range_max) = scan.get::<f64>("range_max") else { return };
        let Some(Value::Numbers(ranges)) = scan.at("ranges") else { return };
        self.range_max = range_max;
        for range in ranges.iter().filter_map(|range| range.f64()) {
            self.all += 1;
            if range.is_nan() {
                self.not_numbers += 1;
            } else if range == 0.0 {
                self.zeros += 1;
            } else if range >= range_max {
                self.beyond += 1;
            } else if let Some(bin) = self.bins.get_mut(((range_max - range) * 100.0) as usize) {
                *bin += 1;
            }
        }
    }

    fn sign(&self) -> Option<NoReturnSign> {
        let enough = (self.all / SEEN).max(10);
        if self.beyond >= enough {
            return None;
        }
        let sums: Vec<usize> = self.bins.windows(WIDTH).map(|bins| bins.iter().sum()).collect();
        let (first, most) =
            sums.iter().copied().enumerate().max_by_key(|(at, sum)| (*sum, -(*at as i64)))?;
        let others = sums.iter().enumerate().filter(|(at, _)| at.abs_diff(first) >= WIDTH);
        let of_walls = others.map(|(_, sum)| *sum).max().unwrap_or(0);
        if most >= enough && of_walls * SHARE <= most {
            let bins = self.bins.get(first..first + WIDTH).unwrap_or_default();
            let last = bins.iter().rposition(|bin| *bin * SHARE * 2 > most).unwrap_or(0);
            return Some(NoReturnSign::From(self.range_max - (first + last + 1) as f64 / 100.0));
        }
        let sign = if self.zeros >= self.not_numbers {
            NoReturnSign::Zero
        } else {
            NoReturnSign::NotANumber
        };
        (self.zeros.max(self.not_numbers) >= enough).then_some(sign)
    }
}

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

    fn sign(
        beyond: usize,
        zeros: usize,
        not_numbers: usize,
        bins: &[(usize, usize)],
    ) -> Option<NoReturnSign> {
        let mut histogram = Histogram {
            all: 10_000,
            zeros,
            not_numbers,
            beyond,
            range_max: 50.0,
            bins: vec![0; BINS],
        };
        for &(bin, count) in bins {
            histogram.bins[bin] += count;
        }
        histogram.sign()
    }

    #[test]
    fn what_many_readings_below_the_largest_range_are_is_no_return() {
        let from = |range: f64| move |sign: Option<NoReturnSign>| matches!(sign, Some(NoReturnSign::From(found)) if (found - range).abs() < 1e-9);
        assert!(from(49.95)(sign(0, 0, 0, &[(4, 80)])));
        // With noise, and walls beside them.
        assert!(from(49.94)(sign(0, 0, 0, &[(3, 10), (4, 60), (5, 20), (40, 3), (90, 2)])));
        // Walls all the way up to the range.
        let walls: Vec<_> = (0..BINS).map(|bin| (bin, 9)).collect();
        assert_eq!(sign(0, 0, 0, &walls), None);
        assert_eq!(sign(0, 60, 5, &[]), Some(NoReturnSign::Zero));
        assert_eq!(sign(0, 5, 60, &[]), Some(NoReturnSign::NotANumber));
        // Few of them are errors, and infinite ranges are the usual sign.
        assert_eq!(sign(0, 10, 10, &[(4, 10)]), None);
        assert_eq!(sign(60, 600, 0, &[(4, 80)]), None);
    }

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
