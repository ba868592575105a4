//! The odometry at the times of laser scans: interpolated between the readings before and after a scan.

use std::{collections::VecDeque, sync::Arc};

use toposlam_model::driving::{odometry::Odometry, scene::wrapped};
use toposlam_vision::laser::scan::Scan;

use super::events::EventSource;

/// A scan, and the odometry at its time.
#[derive(Clone, Debug)]
pub(super) struct PlacedScan {
    pub source: EventSource,
    pub scan: Arc<Scan>,
    pub odometry: Odometry,
}

/// Readings farther apart than this, in nanoseconds, are not of the same clock, or have a gap in between.
const GAP: u64 = 1_000_000_000;
/// More scans do not wait.
const WAITING: usize = 50;

/// Scans that wait for the next odometry.
#[derive(Clone, Debug, Default)]
pub(super) struct ScanOdometry {
    /// The last odometry, with its time.
    last: Option<(u64, Odometry)>,
    waiting: VecDeque<(u64, PlacedScan)>,
    /// The number of scans that waited in vain.
    without_odometry: u64,
}

impl ScanOdometry {
    /// Takes the next odometry. Returns the scans that have waited for it.
    pub(super) fn odometry(&mut self, time: u64, odometry: Odometry) -> Vec<PlacedScan> {
        let before = self.last.replace((time, odometry)).unwrap_or((time, odometry));
        let same_clock = (1..=GAP).contains(&time.saturating_sub(before.0));
        let placed = |(at, scan): (u64, PlacedScan)| {
            if same_clock && (before.0..=time).contains(&at) {
                let odometry = interpolated(before, (time, odometry), at);
                PlacedScan { odometry, ..scan }
            } else {
                scan
            }
        };
        self.waiting.drain(..).map(placed).collect()
    }

    /// Takes the next scan, with the last odometry before it in the log. Returns the scans whose odometry
    /// is known.
    pub(super) fn scan(&mut self, time: u64, scan: PlacedScan) -> Option<PlacedScan> {
        if let Some((last, odometry)) = self.last
            && last == time
        {
            return Some(PlacedScan { odometry, ..scan });
        }
        self.waiting.push_back((time, scan));
        // Without any odometry the oldest scans are of no use.
        let is_late = self.waiting.len() > WAITING;
        let oldest = if is_late { self.waiting.pop_front() } else { None };
        if self.last.is_none() {
            self.without_odometry += u64::from(oldest.is_some());
            return None;
        }
        oldest.map(|(_, scan)| scan)
    }

    /// The number of scans that are of no use: they came too long before the first odometry.
    pub(super) fn without_odometry(&self) -> u64 {
        self.without_odometry
    }

    /// The scans after the last odometry. `None` if there was no odometry.
    pub(super) fn finish(self) -> Option<impl Iterator<Item = PlacedScan>> {
        self.last.map(|_| self.waiting.into_iter().map(|(_, scan)| scan))
    }
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
    fn scan() -> PlacedScan {
        let geometry =
            ScanGeometry { angle_min: 0.0, angle_increment: 1.0, range_min: 0.1, range_max: 9.0 };
        let scan = Scan::new(geometry, vec![1.0], nalgebra::Isometry2::identity()).unwrap();
        PlacedScan { source: EventSource::default(), scan: Arc::new(scan), odometry: at(-1.0) }
    }

    #[test]
    fn a_scan_between_two_readings_is_between_two_places_unless_the_clock_jumps() {
        let places = |scans: &[PlacedScan]| {
            scans.iter().map(|scan| scan.odometry.position[0]).collect::<Vec<_>>()
        };
        for (time, next, expected) in [
            (10 * SECOND + SECOND / 4, 10 * SECOND + SECOND / 2, 1.5),
            (4_294_970_000 * SECOND, 11 * SECOND, -1.0),
            // After a gap.
            (12 * SECOND, 60 * SECOND, -1.0),
        ] {
            let mut placing = ScanOdometry::default();
            assert!(placing.odometry(10 * SECOND, at(1.0)).is_empty());
            assert!(placing.scan(time, scan()).is_none());
            assert_eq!(places(&placing.odometry(next, at(2.0))), [expected]);
            // A scan with the time of the last reading does not wait.
            assert_eq!(places(placing.scan(next, scan()).as_slice()), [2.0]);
        }
    }

    #[test]
    fn without_odometry_no_scan_has_a_place() {
        let mut placing = ScanOdometry::default();
        assert!((0..200).all(|time| placing.scan(time, scan()).is_none()));
        assert_eq!(placing.without_odometry(), 150);
        assert!(placing.finish().is_none());
    }
}
