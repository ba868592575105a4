//! The odometry at the times of laser scans: interpolated between the readings before and after a scan. The times are
//! stamps; the messages may be recorded a few seconds later.

use std::{collections::VecDeque, sync::Arc};

use serde::Serialize;
use toposlam_logs::record::EventId;
use toposlam_model::driving::{odometry::Odometry, scene::wrapped};
use toposlam_vision::laser::scan::Scan;

use super::{
    events::EventSource,
    message_clock::{MANY, PAUSE},
};

/// A scan, and the odometry at its time.
#[derive(Clone, Debug)]
pub(super) struct PlacedScan {
    pub source: EventSource,
    /// In nanoseconds.
    pub stamp: u64,
    pub scan: Arc<Scan>,
    pub odometry: Odometry,
}

impl PlacedScan {
    /// Its message, and where it was taken.
    pub(super) fn pose(&self) -> (EventId, Odometry) {
        (self.source.id, self.odometry)
    }
}

/// Readings farther apart than this, in nanoseconds, have a gap in between.
const GAP: u64 = 1_000_000_000;
/// A message is recorded at most this late, in nanoseconds.
const HISTORY: u64 = 5_000_000_000;
/// Nearly every message is recorded a little late, in nanoseconds.
const LATENCY: u64 = 100_000_000;
/// Messages are at most so late that later ones come before them, in nanoseconds. A clock that goes back by more
/// was set.
const LATE: u64 = 1_000_000_000;
/// More scans do not wait for the first odometry.
const WAITING: usize = 50;
/// More scans do not wait, and more odometry is not kept.
const MOST_WAITING: usize = 2000;

/// The odometry of the last seconds, and scans that wait for the next one.
#[derive(Clone, Debug, Default)]
pub(super) struct ScanOdometry {
    /// In the order of their stamps.
    history: VecDeque<(u64, Odometry)>,
    /// Whether odometry came before that in the history.
    has_earlier: bool,
    /// The stamp of the last odometry in the log that is not off the clock.
    last: Option<u64>,
    /// The last odometry in the log, if its stamps are far from those before.
    off_clock: Vec<(u64, Odometry)>,
    /// In the order of their stamps. Without one, a scan has another clock than the odometry.
    waiting: VecDeque<(Option<u64>, PlacedScan)>,
    /// The number of scans that waited in vain.
    without_odometry: u64,
    /// The largest stamp of a scan so far.
    last_scan: u64,
    counts: StampCounts,
    order: ScanOrder,
}

/// The number of messages that the order of the log would place wrongly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct StampCounts {
    /// Scans that were recorded after later odometry.
    pub late_scans: u64,
    /// Odometry that was recorded after later scans.
    pub late_odometry: u64,
    /// Scans whose stamps are far from those of the odometry; the order of the log places them.
    pub other_clock: u64,
}

impl ScanOdometry {
    /// Takes the next odometry in the log, with its stamp. Returns scans with the odometry at their times, in the
    /// order of their stamps.
    pub(super) fn odometry(&mut self, time: u64, odometry: Odometry) -> Vec<PlacedScan> {
        let placed = self.add_odometry(time, odometry);
        self.order.add(placed)
    }

    /// Takes the next scan in the log, with the last odometry before it. Returns scans with the odometry at their
    /// times, in the order of their stamps.
    pub(super) fn scan(&mut self, scan: PlacedScan) -> Vec<PlacedScan> {
        let placed = self.add_scan(scan);
        self.order.add(placed)
    }

    fn add_odometry(&mut self, time: u64, odometry: Odometry) -> Vec<PlacedScan> {
        let last = self.last.unwrap_or(time);
        if time.saturating_add(LATE) < last || time > last.saturating_add(PAUSE) {
            // A wrong stamp, unless there are many: then the clock was set.
            self.off_clock.push((time, odometry));
            if self.off_clock.len() < MANY {
                return Vec::new();
            }
            self.history = std::mem::take(&mut self.off_clock).into();
            self.history.make_contiguous().sort_by_key(|(time, _)| *time);
            (self.last, self.has_earlier, self.last_scan) = (Some(time), true, 0);
            return self.waiting.drain(..).map(|(_, scan)| scan).collect();
        }
        self.off_clock.clear();
        self.last = Some(time);
        let mut placed = Vec::new();
        self.counts.late_odometry += u64::from(is_late(time, self.last_scan));
        let place = self.history.partition_point(|(other, _)| *other <= time);
        self.history.insert(place, (time, odometry));
        for (waiting, _) in &mut self.waiting {
            // It would have waited for seconds.
            if waiting.is_some_and(|waiting| waiting > time.saturating_add(HISTORY)) {
                *waiting = None;
                self.counts.other_clock += 1;
            }
        }
        placed.extend(self.placed());
        let newest = self.newest().unwrap_or(time);
        let is_old = |(time, _): &(u64, Odometry)| time.saturating_add(HISTORY) < newest;
        while self.history.len() > MOST_WAITING
            || self.history.len() > 2 && self.history.front().is_some_and(is_old)
        {
            self.has_earlier = true;
            self.history.pop_front();
        }
        placed
    }

    fn add_scan(&mut self, scan: PlacedScan) -> Vec<PlacedScan> {
        let time = scan.stamp;
        if let Some((_, odometry)) = self.history.iter().rfind(|(other, _)| *other == time) {
            self.last_scan = self.last_scan.max(time);
            return vec![PlacedScan { odometry: *odometry, ..scan }];
        }
        let newest = self.newest();
        self.last_scan = self.last_scan.max(time);
        if newest.is_some_and(|newest| time.saturating_add(HISTORY) < newest) {
            self.counts.other_clock += 1;
            self.waiting.push_back((None, scan));
        } else {
            self.counts.late_scans += u64::from(is_late(time, newest.unwrap_or(0)));
            let is_before =
                |(other, _): &(Option<u64>, PlacedScan)| other.is_none_or(|other| other <= time);
            let place = self.waiting.iter().rposition(is_before).map_or(0, |before| before + 1);
            self.waiting.insert(place, (Some(time), scan));
        }
        let mut placed = self.placed();
        let most = if newest.is_some() { MOST_WAITING } else { WAITING };
        if self.waiting.len() > most
            && let Some((_, oldest)) = self.waiting.pop_front()
        {
            // Without any odometry the oldest scans are of no use.
            match newest {
                None => self.without_odometry += 1,
                Some(_) => placed.push(oldest),
            }
        }
        placed
    }

    /// The waiting scans for which no more odometry is expected, with the odometry at their times.
    fn placed(&mut self) -> Vec<PlacedScan> {
        let Some(newest) = self.newest() else { return Vec::new() };
        let is_known = |(time, _): &(Option<u64>, PlacedScan)| {
            time.is_none_or(|time| time.saturating_add(LATE) < newest)
        };
        let known = self.waiting.iter().take_while(|waiting| is_known(waiting)).count();
        let known: Vec<_> = self.waiting.drain(..known).collect();
        let place = |(time, scan): (Option<u64>, PlacedScan)| {
            let odometry = time.and_then(|time| self.at(time)).unwrap_or(scan.odometry);
            PlacedScan { odometry, ..scan }
        };
        known.into_iter().map(place).collect()
    }

    fn newest(&self) -> Option<u64> {
        self.history.back().map(|(time, _)| *time)
    }

    /// The odometry at a time: interpolated, or else the last one before it. Of several at that time the last
    /// counts. `None` if it is not in the history.
    fn at(&self, time: u64) -> Option<Odometry> {
        let after = self.history.partition_point(|(other, _)| *other <= time);
        let Some(before) = after.checked_sub(1).and_then(|before| self.history.get(before)) else {
            return self.history.front().map(|(_, first)| *first).filter(|_| !self.has_earlier);
        };
        match self.history.get(after) {
            Some(next) if before.0 < time && next.0 - before.0 <= GAP => {
                Some(interpolated(*before, *next, time))
            }
            _ => Some(before.1),
        }
    }

    /// The number of scans that are of no use: they came too long before the first odometry.
    pub(super) fn without_odometry(&self) -> u64 {
        self.without_odometry
    }

    /// The number of messages that the order of the log would place wrongly.
    pub(super) fn counts(&self) -> StampCounts {
        self.counts
    }

    /// The scans that still wait, those after the last odometry among them. `None` if there was no odometry.
    pub(super) fn finish(self) -> Option<impl Iterator<Item = PlacedScan>> {
        self.history.back()?;
        let place = |(time, scan): &(Option<u64>, PlacedScan)| {
            let odometry = time.and_then(|time| self.at(time)).unwrap_or(scan.odometry);
            PlacedScan { odometry, ..scan.clone() }
        };
        let placed: Vec<_> = self.waiting.iter().map(place).collect();
        let mut order = self.order;
        let placed = order.add(placed);
        Some(placed.into_iter().chain(order.finish()))
    }
}

/// Puts scans in the order of their stamps.
#[derive(Clone, Debug, Default)]
pub(super) struct ScanOrder {
    waiting: VecDeque<PlacedScan>,
    latest: u64,
}

impl ScanOrder {
    /// The largest number of scans that wait for an earlier one.
    const MOST: usize = 64;

    /// Adds scans. Returns those before which no scan is expected.
    pub(super) fn add(&mut self, scans: Vec<PlacedScan>) -> Vec<PlacedScan> {
        let mut released = Vec::new();
        for scan in scans {
            if self.latest.abs_diff(scan.stamp) > HISTORY {
                // It has another clock, or it begins.
                released.extend(self.waiting.drain(..));
                self.latest = scan.stamp;
            }
            self.latest = self.latest.max(scan.stamp);
            let is_before = |other: &PlacedScan| other.stamp <= scan.stamp;
            let place = self.waiting.iter().rposition(is_before).map_or(0, |before| before + 1);
            self.waiting.insert(place, scan);
            let due = self.latest.saturating_sub(LATE);
            let due = self.waiting.partition_point(|waiting| waiting.stamp <= due);
            let due = due.max(self.waiting.len().saturating_sub(Self::MOST));
            released.extend(self.waiting.drain(..due));
        }
        released
    }

    /// The scans that still wait.
    pub(super) fn finish(self) -> Vec<PlacedScan> {
        self.waiting.into()
    }
}

/// Whether a message was recorded clearly after another one with a later stamp.
fn is_late(time: u64, other: u64) -> bool {
    (LATENCY..=HISTORY).contains(&other.saturating_sub(time))
}

/// The odometry at a time between two different readings.
pub(super) fn interpolated(
    (begin, from): (u64, Odometry),
    (end, to): (u64, Odometry),
    time: u64,
) -> Odometry {
    let part = (time - begin) as f64 / (end - begin) as f64;
    let turned = wrapped(to.heading - from.heading);
    let position =
        [0, 1].map(|axis| from.position[axis] + part * (to.position[axis] - from.position[axis]));
    Odometry { position, heading: wrapped(from.heading + part * turned) }
}

#[cfg(test)]
mod tests {
    use toposlam_vision::laser::scan::ScanGeometry;

    use super::*;

    const SECOND: u64 = 1_000_000_000;

    fn at(x: f64) -> Odometry {
        Odometry { position: [x, 0.0], heading: 0.0 }
    }

    /// A scan that has the odometry -1 before it in the log.
    fn scan(stamp: u64) -> PlacedScan {
        let geometry =
            ScanGeometry { angle_min: 0.0, angle_increment: 1.0, range_min: 0.1, range_max: 9.0 };
        let scan = Scan::new(geometry, vec![1.0], nalgebra::Isometry2::identity()).unwrap();
        PlacedScan {
            source: EventSource::default(),
            stamp,
            scan: Arc::new(scan),
            odometry: at(-1.0),
        }
    }

    fn places(scans: &[PlacedScan]) -> Vec<f64> {
        scans.iter().map(|scan| scan.odometry.position[0]).collect()
    }

    #[test]
    fn a_scan_between_two_readings_is_between_two_places_unless_the_clock_jumps() {
        for (time, next, expected) in [
            (10 * SECOND + SECOND / 4, 10 * SECOND + SECOND / 2, 1.5),
            (4_294_970_000 * SECOND, 11 * SECOND, -1.0),
            // After a gap.
            (12 * SECOND, 60 * SECOND, 1.0),
        ] {
            let mut placing = ScanOdometry::default();
            assert!(placing.add_odometry(10 * SECOND, at(1.0)).is_empty());
            assert!(placing.add_scan(scan(time)).is_empty());
            let mut placed = placing.add_odometry(next, at(2.0));
            // A scan with the time of the last reading does not wait.
            assert_eq!(places(&placing.add_scan(scan(next))), [2.0]);
            placed.extend(placing.finish().unwrap());
            assert_eq!(places(&placed), [expected]);
        }
    }

    /// Ten readings and scans a second, each recorded so late after its stamp, in milliseconds. The robot drives a
    /// metre in a second.
    fn recorded(odometry_late: impl Fn(u64) -> u64, scan_late: impl Fn(u64) -> u64) -> Vec<f64> {
        const TENTH: u64 = SECOND / 10;
        let mut messages: Vec<(u64, u64, bool)> = (0..100)
            .flat_map(|step| {
                let [odometry, scan] =
                    [10 * SECOND + step * TENTH, 10 * SECOND + step * TENTH + TENTH / 2];
                let late = |milliseconds: u64| milliseconds * 1_000_000;
                [
                    (odometry + late(odometry_late(step)), odometry, false),
                    (scan + late(scan_late(step)), scan, true),
                ]
            })
            .collect();
        messages.sort_unstable();
        let mut placing = ScanOdometry::default();
        let mut placed = Vec::new();
        for (_, stamp, is_scan) in messages {
            placed.extend(if is_scan {
                placing.scan(scan(stamp))
            } else {
                placing.odometry(stamp, at((stamp - 10 * SECOND) as f64 / SECOND as f64))
            });
        }
        placed.extend(placing.finish().unwrap());
        placed.iter().map(|scan| scan.odometry.position[0]).collect()
    }

    #[test]
    fn messages_are_placed_by_their_stamps_however_late_they_are_recorded() {
        let prompt = recorded(|_| 0, |_| 0);
        for (step, place) in prompt.iter().take(99).enumerate() {
            assert!((place - (0.05 + step as f64 / 10.0)).abs() < 1e-9, "{prompt:?}");
        }
        let jitter = |step: u64| step * 37 % 290;
        for late in [
            recorded(|_| 0, |_| 200),
            recorded(|_| 300, |_| 0),
            recorded(jitter, |_| 0),
            recorded(|_| 0, jitter),
            recorded(jitter, |step| jitter(step + 5)),
            recorded(|_| 0, |_| 3000),
        ] {
            assert_eq!(late.len(), prompt.len());
            let off = late.iter().zip(&prompt).map(|(late, prompt)| (late - prompt).abs());
            assert!(off.into_iter().all(|off| off < 1e-9), "{late:?}");
        }
    }

    #[test]
    fn odometry_with_a_wrong_stamp_is_skipped_and_a_clock_that_was_set_begins_again() {
        let mut placing = ScanOdometry::default();
        placing.add_odometry(100 * SECOND, at(1.0));
        assert!(placing.add_scan(scan(100 * SECOND + 5)).is_empty());
        for wrong in [50, 9_000_000] {
            assert!(placing.add_odometry(wrong * SECOND, at(9.0)).is_empty());
        }
        assert!(placing.add_odometry(100 * SECOND + 10, at(2.0)).is_empty());
        assert_eq!(places(&placing.add_odometry(102 * SECOND, at(3.0))), [1.5]);
        assert!(placing.add_scan(scan(101 * SECOND)).is_empty());
        for step in 1..MANY as u64 {
            assert!(placing.add_odometry(step * SECOND / 2, at(step as f64)).is_empty());
        }
        // What waited is where the log has it, and what comes is by the new clock.
        assert_eq!(places(&placing.add_odometry(5 * SECOND, at(10.0))), [-1.0]);
        assert!(placing.add_scan(scan(5 * SECOND - SECOND / 4)).is_empty());
        assert_eq!(places(&placing.add_odometry(6 * SECOND, at(11.0))), [9.5]);
        // Scans of another clock do not wait for long.
        for _ in 0..3 {
            assert!(placing.add_scan(scan(9000 * SECOND)).is_empty());
        }
        assert_eq!(places(&placing.add_odometry(7 * SECOND, at(4.0))), [-1.0; 3]);
        assert_eq!(placing.counts().other_clock, 3);
    }

    /// After odometry at these times, in seconds, each with its time as the place: the places of a scan at a time, and the counts.
    fn placed_after(times: &[f64], scan_at: f64) -> (Vec<f64>, StampCounts) {
        let nanoseconds = |time: f64| (time * SECOND as f64).round() as u64;
        let mut placing = ScanOdometry::default();
        for &time in times {
            assert!(placing.add_odometry(nanoseconds(time), at(time)).is_empty());
        }
        let mut placed = placing.add_scan(scan(nanoseconds(scan_at)));
        let counts = placing.counts();
        placed.extend(placing.finish().unwrap());
        (places(&placed), counts)
    }

    #[test]
    fn the_history_of_odometry_reaches_back_five_seconds_and_two_readings() {
        let place = |times: &[f64], scan_at| placed_after(times, scan_at).0[0];
        // Before all odometry a scan is where the robot was first, ...
        assert_eq!(place(&[20.0, 20.5], 19.0), 20.0);
        // ... and before what is left of it, where the log has it.
        assert_eq!(place(&[10.0, 20.0, 20.5], 17.0), -1.0);
        assert_eq!(place(&[15.5, 20.0, 20.5], 17.0), 15.5);
        assert_eq!(place(&[10.0, 20.0], 17.0), 10.0);
        // A second back is late, more is another clock; so is more than an hour forwards.
        for (times, scan_at, kept) in [
            ([100.0, 99.0], 99.0, true),
            ([100.0, 98.9], 98.9, false),
            ([100.0, 3700.0], 3700.0, true),
            ([100.0, 3700.1], 3700.1, false),
        ] {
            assert_eq!(place(&times, scan_at) == scan_at, kept, "{times:?}");
        }
    }

    #[test]
    fn late_messages_and_those_of_another_clock_are_counted() {
        let counts = |times: &[f64], scan_at| {
            let StampCounts { late_scans, other_clock, .. } = placed_after(times, scan_at).1;
            (late_scans, other_clock)
        };
        assert_eq!(counts(&[10.0, 10.2], 10.15), (0, 0));
        assert_eq!(counts(&[10.0, 10.2], 10.1), (1, 0));
        assert_eq!(counts(&[10.0, 20.0], 15.0), (1, 0));
        assert_eq!(counts(&[10.0, 20.0], 14.9), (0, 1));
        let late_odometry = |scan_at: u64, time: u64| {
            let mut placing = ScanOdometry::default();
            placing.add_odometry(SECOND, at(1.0));
            placing.add_scan(scan(scan_at));
            let placed = placing.add_odometry(time, at(2.0));
            (placing.counts().late_odometry, placing.counts().other_clock, placed.len())
        };
        assert_eq!(late_odometry(2 * SECOND, 2 * SECOND - LATENCY), (1, 0, 0));
        assert_eq!(late_odometry(2 * SECOND, 2 * SECOND - LATENCY + 1), (0, 0, 0));
        // A scan waits for five seconds.
        assert_eq!(late_odometry(2 * SECOND + HISTORY, 2 * SECOND), (1, 0, 0));
        assert_eq!(late_odometry(2 * SECOND + HISTORY + 1, 2 * SECOND), (0, 1, 1));
    }

    #[test]
    fn scans_are_released_in_order_once_no_earlier_one_is_expected() {
        let mut order = ScanOrder::default();
        let mut add = |milliseconds: &[u64]| {
            let scans = milliseconds.iter().map(|time| scan(time * 1_000_000)).collect();
            order.add(scans).iter().map(|scan| scan.stamp / 1_000_000).collect::<Vec<_>>()
        };
        assert!(add(&[10_000, 10_200, 10_100]).is_empty());
        assert_eq!(add(&[11_100]), [10_000, 10_100]);
        // Five seconds are a pause, more are another clock.
        assert_eq!(add(&[16_100]), [10_200, 11_100]);
        assert_eq!(add(&[11_100]), [11_100]);
        assert_eq!(add(&[900_000]), [16_100]);
        assert_eq!(add(&[16_000]), [900_000]);
        assert_eq!(order.finish().len(), 1);
    }

    #[test]
    fn without_odometry_no_scan_has_a_place() {
        let mut placing = ScanOdometry::default();
        assert!((0..200).all(|time| placing.add_scan(scan(time)).is_empty()));
        assert_eq!(placing.without_odometry(), 150);
        assert!(placing.finish().is_none());
    }
}
