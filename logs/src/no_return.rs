//! How scans write that there is no return. By REP 117 that is an infinite range; many drivers write a little less
//! than the largest range, 0 or not a number, and a scanner may have a sign of its own far below the largest range that
//! its driver states: 50 m of 81.9 m.

use std::{cmp::Reverse, fmt};

use super::value::Value;

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

/// The readings without a return are at most this far below the largest range, in metres, ...
const BELOW: f64 = 1.0;
/// ... or beyond this range: few walls are seen from there.
const BEYOND: f64 = 40.0;
/// The bins of a metre.
const BINS: f64 = 100.0;
/// So many metres are looked at: a driver may state a range of 1e30 m.
const FARTHEST: f64 = 1000.0;
/// They lie within so many bins.
const WIDTH: usize = 6;
/// Those of walls at the same distance from the scanner are at most one in so many of them.
const SHARE: usize = 5;
/// One reading in so many shows what the sign is.
const SEEN: usize = 500;

/// The readings of scans by their range.
#[derive(Default)]
pub(super) struct RangeHistogram {
    all: usize,
    zeros: usize,
    not_numbers: usize,
    /// Infinite, or not below the largest range.
    beyond: usize,
    range_max: f64,
    /// Below the largest range, the nearest first.
    bins: Vec<usize>,
}

impl RangeHistogram {
    /// Adds the readings of a scan.
    pub(super) fn add(&mut self, scan: &Value<'_>) {
        let range_max = ["range_max", "maximum_range"].into_iter().find_map(|name| scan.get(name));
        let Some(range_max) = range_max else { return };
        let Some(ranges) = scan.at("ranges").and_then(|ranges| ranges.elements()) else { return };
        self.range_max = range_max;
        let far = (range_max - BEYOND).min(FARTHEST);
        let bins = BINS * far.max(BELOW.min(range_max / 2.0));
        self.bins.resize(self.bins.len().max(bins as usize), 0);
        for range in ranges.iter().filter_map(Value::f64) {
            self.all += 1;
            if range.is_nan() {
                self.not_numbers += 1;
            } else if range == 0.0 {
                self.zeros += 1;
            } else if range >= range_max {
                self.beyond += 1;
            } else if let Some(bin) = self.bins.get_mut(((range_max - range) * BINS) as usize) {
                *bin += 1;
            }
        }
    }

    /// The sign; `None` if it is the usual one, or none is seen.
    pub(super) fn sign(&self) -> Option<NoReturnSign> {
        let enough = (self.all / SEEN).max(10);
        if self.beyond >= enough {
            return None;
        }
        let sums: Vec<usize> = self.bins.windows(WIDTH).map(|bins| bins.iter().sum()).collect();
        let (first, most) =
            sums.iter().copied().enumerate().max_by_key(|(at, sum)| (*sum, Reverse(*at)))?;
        let others = sums.iter().enumerate().filter(|(at, _)| at.abs_diff(first) >= WIDTH);
        let of_walls = others.map(|(_, sum)| *sum).max().unwrap_or(0);
        if most >= enough && of_walls * SHARE <= most {
            let bins = self.bins.get(first..first + WIDTH).unwrap_or_default();
            let last = bins.iter().rposition(|bin| *bin * SHARE * 2 > most).unwrap_or(0);
            return Some(NoReturnSign::From(self.range_max - (first + last + 1) as f64 / BINS));
        }
        let sign = if self.zeros >= self.not_numbers {
            NoReturnSign::Zero
        } else {
            NoReturnSign::NotANumber
        };
        (self.zeros.max(self.not_numbers) >= enough).then_some(sign)
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
        let mut histogram = RangeHistogram {
            all: 10_000,
            zeros,
            not_numbers,
            beyond,
            range_max: 50.0,
            bins: vec![0; 1000],
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
        let walls: Vec<_> = (0..100).map(|bin| (bin, 9)).collect();
        assert_eq!(sign(0, 0, 0, &walls), None);
        assert_eq!(sign(0, 60, 5, &[]), Some(NoReturnSign::Zero));
        assert_eq!(sign(0, 5, 60, &[]), Some(NoReturnSign::NotANumber));
        // Far below the range that the driver states, with few walls beyond.
        assert!(from(42.5)(sign(0, 0, 0, &[(749, 80), (300, 12)])));
        // Few of them are errors, and infinite ranges are the usual sign.
        assert_eq!(sign(0, 10, 10, &[(4, 10)]), None);
        assert_eq!(sign(60, 600, 0, &[(4, 80)]), None);
    }
}
