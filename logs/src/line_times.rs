//! The times of a log of lines that are not those of a clock: the order of the lines decides instead.

use std::fmt;

use serde::Serialize;
use toposlam_model::counts::grouped;

/// The number of lines whose times are not those of a clock, by the reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct LineTimes {
    /// Lines with a time.
    #[serde(skip)]
    pub(super) all: u64,
    /// The time is 0 or not a number.
    pub missing: u64,
    /// A scan has the time of the scan before it.
    pub repeated: u64,
    pub back: u64,
    /// More than an hour ahead of the line before.
    pub ahead: u64,
    /// To a second or more.
    pub rounded: u64,
}

/// The time of one line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LineTime {
    Regular,
    Missing,
    Repeated,
    Back,
    Ahead,
    Rounded,
}

/// One line in so many may have a wrong time in a log whose times are those of a clock.
const FEW: u64 = 20;

impl LineTimes {
    pub(super) fn add(&mut self, time: LineTime) {
        self.all += 1;
        match time {
            LineTime::Regular => {}
            LineTime::Missing => self.missing += 1,
            LineTime::Repeated => self.repeated += 1,
            LineTime::Back => self.back += 1,
            LineTime::Ahead => self.ahead += 1,
            LineTime::Rounded => self.rounded += 1,
        }
    }

    /// The number of lines whose times are not those of a clock.
    pub fn irregular(&self) -> u64 {
        self.missing + self.repeated + self.back + self.ahead + self.rounded
    }

    /// Whether durations are known: only a few lines have a wrong time.
    pub fn are_known(&self) -> bool {
        self.irregular() <= self.all / FEW
    }
}

impl fmt::Display for LineTimes {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let reasons = [
            (self.missing, "without a time"),
            (self.repeated, "with the time of the scan before"),
            (self.back, "that go back"),
            (self.ahead, "more than an hour ahead"),
            (self.rounded, "rounded to seconds or more"),
        ];
        let reasons = reasons.into_iter().filter(|(count, _)| *count > 0);
        let parts: Vec<_> =
            reasons.map(|(count, what)| format!("{} {what}", grouped(count.into()))).collect();
        write!(out, "times of lines: {}; the order of the lines decides", parts.join(", "))?;
        if !self.are_known() {
            write!(out, ", and durations are not known")?;
        }
        Ok(())
    }
}
