//! The clock of a log of lines: the order of the lines decides, and a time can only go on.
//!
//! A line whose time is missing, goes back or is more than an hour ahead has the time of the line before it. If
//! many such lines stand together, the clock was set: the log goes on from there.

use super::Format;
use crate::line_times::{LineTime, LineTimes};

/// The largest step ahead, in nanoseconds.
const PAUSE: u64 = 3_600_000_000_000;
/// The number of lines off the clock after which it was set.
const MOST_OFF: u32 = 10;
/// The end of time, in seconds: nanoseconds fit in 64 bits.
const END: f64 = 1.8e10;

/// What a line states of its time.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TimedLine {
    /// In seconds; `None` if it need not have one.
    pub(super) time: Option<f64>,
    /// What its last digit counts, in seconds; a number of six digits is rounded.
    pub(super) resolution: f64,
    pub(super) has_scan: bool,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock {
    /// Events need not have times, and a robot may wait for days.
    is_free: bool,
    /// The latest time, in nanoseconds; `None` before the first time that is not 0.
    latest: Option<u64>,
    /// What is added to the times since the clock was set, in seconds.
    shift: f64,
    off: u32,
    /// Whether a line with time 0 came before the first other time.
    has_zero: bool,
    is_after_scan: bool,
    /// The time of the last scan, in seconds.
    last_scan: Option<f64>,
}

impl Clock {
    /// The clock before the first line.
    pub(super) fn new(format: Format) -> Self {
        Self {
            is_free: format == Format::Events,
            latest: None,
            shift: 0.0,
            off: 0,
            has_zero: false,
            is_after_scan: false,
            last_scan: None,
        }
    }

    /// The time of a line in nanoseconds, which is not before that of the line before it.
    pub(super) fn tick(&mut self, line: TimedLine, counts: &mut LineTimes) -> u64 {
        let Some(seconds) = line.time else { return self.time() };
        // An editor of logs adds the corrected odometry after each scan, with time 0.
        let is_added = self.is_after_scan && !line.has_scan && !self.is_free;
        self.is_after_scan = line.has_scan;
        let found = self.advance(seconds, line.resolution, is_added);
        if is_added {
            return self.time();
        }
        let is_repeated = line.has_scan && self.last_scan.replace(seconds) == Some(seconds);
        let found = match found {
            LineTime::Regular if line.resolution >= 1.0 => LineTime::Rounded,
            LineTime::Regular if is_repeated => LineTime::Repeated,
            found => found,
        };
        counts.add(found);
        self.time()
    }

    /// The time of the last line, in nanoseconds.
    fn time(&self) -> u64 {
        self.latest.unwrap_or_default()
    }

    fn advance(&mut self, seconds: f64, resolution: f64, is_added: bool) -> LineTime {
        if !seconds.is_finite() || seconds == 0.0 && !self.is_free {
            // A log may begin at 0.
            let is_first = !std::mem::replace(&mut self.has_zero, true) && self.latest.is_none();
            return if is_first && seconds == 0.0 { LineTime::Regular } else { LineTime::Missing };
        }
        let latest = self.time();
        if self.latest.is_none() && !is_added {
            self.shift = if (0.0..END).contains(&seconds) { 0.0 } else { -seconds };
            self.latest = Some(self.nanoseconds(seconds).unwrap_or_default());
            return LineTime::Regular;
        }
        let pause =
            if self.is_free { u64::MAX } else { PAUSE.saturating_add((2e9 * resolution) as u64) };
        let found = match self.nanoseconds(seconds) {
            Some(time) if time < latest => LineTime::Back,
            None if seconds < 0.0 => LineTime::Back,
            Some(time) if time - latest <= pause => {
                self.latest = Some(time);
                self.off = 0;
                return LineTime::Regular;
            }
            _ => LineTime::Ahead,
        };
        if !is_added {
            self.off += 1;
        }
        if self.off >= MOST_OFF && !self.is_free {
            self.shift = latest as f64 / 1e9 - seconds;
            self.off = 0;
        }
        found
    }

    /// The time in nanoseconds; `None` before the beginning of time and after its end.
    fn nanoseconds(&self, seconds: f64) -> Option<u64> {
        let shifted = seconds + self.shift;
        (0.0..END).contains(&shifted).then(|| (shifted * 1e9).round() as u64)
    }
}

/// What the last digit of a number counts. `printf` writes a number with an exponent with six digits, without
/// zeros at its end.
pub(super) fn resolution(word: &str) -> f64 {
    let (digits, exponent) = word.split_once(['e', 'E']).unwrap_or((word, "0"));
    let Ok(exponent) = exponent.parse::<i32>() else { return 0.0 };
    let decimals = digits.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let decimals = i32::try_from(decimals).unwrap_or(i32::MAX);
    let is_short = decimals == 0 && digits.len() < 6;
    match exponent {
        0 if is_short => 0.0,
        0 => 10_f64.powi(-decimals),
        _ => 10_f64.powi(exponent.saturating_sub(decimals.max(5))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The times of lines with scans, in seconds, and the counts.
    fn ticks(times: &[f64]) -> (Vec<f64>, LineTimes) {
        let (mut clock, mut counts) = (Clock::new(Format::Carmen), LineTimes::default());
        let tick = |&time: &f64| {
            let line = TimedLine { time: Some(time), resolution: 0.001, has_scan: true };
            clock.tick(line, &mut counts) as f64 / 1e9
        };
        (times.iter().map(tick).collect(), counts)
    }

    #[test]
    fn a_wrong_time_is_that_of_the_line_before_and_the_others_stay() {
        for wrong in [0.0, -1.0, 98.9, 4_294_970_000.0, f64::NAN, f64::INFINITY, 1e300] {
            let (times, counts) = ticks(&[100.0, wrong, 101.0, 3701.0]);
            assert_eq!(times, [100.0, 100.0, 101.0, 3701.0], "{wrong}");
            assert_eq!(counts.irregular(), 1, "{wrong}");
        }
        let (times, counts) = ticks(&[0.0, 0.5, 0.5, 1.0]);
        assert_eq!((times, counts.repeated), (vec![0.0, 0.5, 0.5, 1.0], 1));
    }

    #[test]
    fn a_clock_that_was_set_goes_on_from_there() {
        let back: Vec<f64> = (0..20).map(|step| -0.25 * f64::from(step)).collect();
        let (times, counts) = ticks(&back);
        assert!(times.iter().all(|time| *time == 0.0));
        assert_eq!(counts.back, 18);
        let set: Vec<f64> = (0..20).map(|step| 50.0 + f64::from(step)).collect();
        let (times, counts) = ticks(&[&[9000.0], &set[..]].concat());
        assert!(times[..11].iter().all(|time| *time == 9000.0));
        assert_eq!((times[11], times[20], counts.back), (9001.0, 9010.0, 10));
    }

    #[test]
    fn an_added_line_counts_as_nothing_and_six_digits_are_rounded() {
        let (mut clock, mut counts) = (Clock::new(Format::Carmen), LineTimes::default());
        let mut line = |word: &str, has_scan| {
            let time = word.parse().ok();
            clock.tick(TimedLine { time, resolution: resolution(word), has_scan }, &mut counts)
        };
        for (word, has_scan) in [("10.25", false), ("11.5", true), ("0", false), ("7e-86", false)] {
            line(word, has_scan);
        }
        assert_eq!((line("12.0", true), counts.irregular()), (12_000_000_000, 1));
        let expected = [("1.13486e+09", 1e4), ("1.135e+09", 1e4), ("123456", 1.0), ("11", 0.0)];
        for (word, size) in expected {
            assert!((resolution(word) - size).abs() < 1e-9, "{word}");
        }
        let rounded = ["1.13486e+09", "1.13486e+09", "1.13487e+09"];
        let (mut clock, mut counts) = (Clock::new(Format::Carmen), LineTimes::default());
        let times = rounded.map(|word| {
            let time = word.parse().ok();
            let line = TimedLine { time, resolution: resolution(word), has_scan: true };
            clock.tick(line, &mut counts) / 1_000_000_000
        });
        assert_eq!(times, [1_134_860_000, 1_134_860_000, 1_134_870_000]);
        assert_eq!((counts.rounded, counts.irregular()), (3, 3));
    }
}
