//! The clock of a log of lines.
//!
//! Lines stand in the order of time, up to a second. A line whose time is more than a second before that
//! of the latest line, or more than an hour after it, is off the clock: it is skipped. If many such lines
//! stand together, the clock has jumped.

use super::Format;

/// The largest step back, in nanoseconds: a line may be written late.
const LATE: u64 = 1_000_000_000;
/// The largest step ahead, in nanoseconds.
const PAUSE: u64 = 3_600_000_000_000;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock {
    is_free: bool,
    /// The latest time, in nanoseconds.
    latest: Option<u64>,
    off: u32,
    pub(super) off_total: u64,
    /// The time of the last line, in seconds.
    last: f64,
}

impl Clock {
    /// The number of lines off the clock after which it has jumped.
    pub(super) const MOST_OFF: u32 = 10;

    /// The clock before the first line. Events need not have times; their order is that of the file.
    pub(super) fn new(format: Format) -> Self {
        let is_free = format == Format::Events;
        Self { is_free, latest: None, off: 0, off_total: 0, last: 0.0 }
    }

    /// The time of a line in nanoseconds, by its time in seconds; `None` if it is off the clock.
    pub(super) fn tick(&mut self, seconds: Option<f64>) -> Option<u64> {
        let latest = self.latest.unwrap_or_default();
        let Some(seconds) = seconds else { return Some(latest) };
        self.last = seconds;
        let nanoseconds = seconds * 1e9;
        let time = (0.0..1.8e19).contains(&nanoseconds).then(|| nanoseconds.round() as u64);
        let time = match time {
            Some(time) if self.is_free => Some(time.max(latest)),
            Some(time) if self.latest.is_none() => Some(time),
            Some(time) if time + LATE >= latest && time <= latest.saturating_add(PAUSE) => {
                Some(time)
            }
            _ => None,
        };
        if let Some(time) = time {
            self.latest = Some(time.max(latest));
            self.off = 0;
        } else {
            self.off += 1;
            self.off_total += 1;
        }
        time
    }

    /// The time before a jump and after it, in seconds, if the clock has jumped.
    pub(super) fn jump(&self) -> Option<[f64; 2]> {
        let from = self.latest.unwrap_or_default() as f64 / 1e9;
        (self.off >= Self::MOST_OFF).then_some([from, self.last])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_off_the_clock_is_skipped_and_a_late_one_is_not() {
        let mut clock = Clock::new(Format::Carmen);
        let mut times = |seconds| clock.tick(Some(seconds));
        assert_eq!(times(100.0), Some(100_000_000_000));
        assert_eq!(times(99.5), Some(99_500_000_000));
        for wrong in [0.0, -1.0, 98.9, 4_294_970_000.0, f64::NAN, f64::INFINITY, 1e300] {
            assert_eq!(times(wrong), None, "{wrong}");
            assert_eq!(times(100.0), Some(100_000_000_000));
        }
        assert_eq!(times(3700.0), Some(3_700_000_000_000));
        assert_eq!((clock.off_total, clock.jump()), (7, None));
    }
}
