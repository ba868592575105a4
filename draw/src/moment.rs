//! Moments and times as text: dates, seconds and the display of a clock.

pub use toposlam_model::counts::grouped;

const YEAR: u64 = 365 * 24 * 3600;

/// A time in nanoseconds: a date if it can be one, otherwise seconds.
///
/// A date counts from 1970, in UTC. A clock that starts with the computer shows less than a year.
pub fn moment(nanoseconds: u64) -> String {
    let (seconds, milliseconds) = (nanoseconds / 1_000_000_000, nanoseconds / 1_000_000 % 1000);
    if seconds < YEAR {
        return format!("{}.{milliseconds:03} s", grouped(seconds.into()));
    }
    let (days, second) = (seconds / 86_400, seconds % 86_400);
    let [year, month, day] = date(days);
    let (hour, minute, second) = (second / 3600, second / 60 % 60, second % 60);
    format!("{year}-{month:02}-{day:02} {hour:02}:{minute:02}:{second:02}.{milliseconds:03} UTC")
}

/// Seconds since the first message of a log; a date if a message carries one and the log does not.
pub fn since_start(seconds: f64) -> String {
    if is_date(seconds) {
        return moment((seconds * 1e9) as u64);
    }
    format!("{} s", tenths(seconds))
}

/// The same as minutes and seconds, with hours if there are any.
pub(crate) fn clock(seconds: f64) -> String {
    if is_date(seconds) {
        return moment((seconds * 1e9) as u64);
    }
    let tenths = (seconds * 10.0).round().max(0.0) as u64;
    let (minutes, rest) = (tenths / 600, format!("{:02}.{}", tenths / 10 % 60, tenths % 10));
    if minutes < 60 {
        format!("{minutes}:{rest}")
    } else {
        format!("{}:{:02}:{rest}", grouped((minutes / 60).into()), minutes % 60)
    }
}

fn is_date(seconds: f64) -> bool {
    seconds >= YEAR as f64
}

/// A number with one decimal, and a comma between thousands, as in `1,127.8`.
pub fn tenths(number: f64) -> String {
    let tenths = (number * 10.0).round().max(0.0) as u64;
    format!("{}.{}", grouped((tenths / 10).into()), tenths % 10)
}

/// The year, month and day of the Gregorian calendar, a number of days after 1970-01-01.
fn date(days: u64) -> [u64; 3] {
    let is_leap = |year: u64| {
        year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400))
    };
    let (mut year, mut rest) = (1970, days);
    while rest >= 365 + u64::from(is_leap(year)) {
        rest -= 365 + u64::from(is_leap(year));
        year += 1;
    }
    let february = 28 + u64::from(is_leap(year));
    let mut month = 1;
    for length in [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30] {
        if rest < length {
            break;
        }
        rest -= length;
        month += 1;
    }
    [year, month, rest + 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_since_1970_is_a_date_and_a_time_since_power_on_is_seconds() {
        for (seconds, text) in [
            (0, "0.000 s"),
            (1, "1.000 s"),
            (86_400, "86,400.000 s"),
            // By `date -u -d @SECONDS`.
            (951_782_400, "2000-02-29 00:00:00.000 UTC"),
            (1_700_000_000, "2023-11-14 22:13:20.000 UTC"),
            (1_735_689_599, "2024-12-31 23:59:59.000 UTC"),
            (4_107_542_400, "2100-03-01 00:00:00.000 UTC"),
        ] {
            assert_eq!(moment(seconds * 1_000_000_000), text);
        }
        assert_eq!(moment(1_034_567_890), "1.034 s");
        assert_eq!(moment(u64::MAX), "2554-07-21 23:34:33.709 UTC");
    }

    #[test]
    fn a_stamp_of_another_clock_than_the_log_is_a_date() {
        assert_eq!(since_start(76.24), "76.2 s");
        assert_eq!(since_start(12_345.0), "12,345.0 s");
        assert_eq!(since_start(1.7e9), "2023-11-14 22:13:20.000 UTC");
    }

    #[test]
    fn a_clock_shows_minutes_and_then_hours() {
        assert_eq!(
            [0.0, 59.96, 61.25, 754.3, 3599.94, 3725.0].map(clock),
            ["0:00.0", "1:00.0", "1:01.3", "12:34.3", "59:59.9", "1:02:05.0"]
        );
        assert_eq!(clock(1.7e9), "2023-11-14 22:13:20.000 UTC");
    }
}
