//! The laser scanner of a live robot, and what it last saw ahead.

use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use toposlam_logs::Mount;
use toposlam_model::driving::odometry::Odometry;
use toposlam_vision::laser::scan::{Reading, Scan};

use super::{
    messages::{Nanoseconds, SECOND, ScanReading, Stamped},
    topic::Subscription,
};
use crate::{
    robot::RobotError,
    superscout::{CLEARANCE, RADIUS},
};

/// Readings this close to straight ahead look where the robot goes, in radians.
const AHEAD: f64 = 0.1;

/// The topic of a scanner.
pub(crate) struct ScanTopic {
    pub(crate) scans: Subscription<Stamped<ScanReading>>,
    /// The scanner's frame, unless any is accepted.
    pub(crate) frame: Option<String>,
    /// Where the scanner is on the robot.
    pub(crate) mount: Mount,
}

/// A scanner, and its last scan.
pub(super) struct Scanner {
    topic: ScanTopic,
    last: Option<LastScan>,
}

struct LastScan {
    stamp: Nanoseconds,
    arrived: Instant,
    scan: Arc<Scan>,
}

impl Scanner {
    pub(super) fn new(topic: ScanTopic) -> Self {
        Self { topic, last: None }
    }

    /// Waits for a scan whose stamp is accepted.
    pub(super) fn wait<W>(
        &mut self,
        patience: Duration,
        stop: fn() -> bool,
        mut accepted: impl FnMut(Nanoseconds) -> Option<W>,
    ) -> Result<(W, Arc<Scan>), RobotError> {
        let (topic, last) = (&self.topic, &mut self.last);
        let mut other = None;
        let found = topic.scans.wait(patience, stop, |message| {
            let seen = topic.read(message, Instant::now(), &mut other)?;
            let accepted = accepted(seen.stamp)?;
            let scan = seen.scan.clone();
            *last = Some(seen);
            Some((accepted, scan))
        });
        found.map_err(|error| match (error, other) {
            (RobotError::Silent { .. }, Some(frame)) => topic.other_frame(frame),
            (error, _) => error,
        })
    }

    /// Takes the last scan, if one has come since.
    ///
    /// # Errors
    /// Returns an error if the last one came longer ago than this.
    pub(super) fn update(&mut self, patience: Duration) -> Result<(), RobotError> {
        let (mut other, mut back) = (None, 0);
        if let Some((message, arrived)) = self.topic.scans.take_timed() {
            let seen = self.topic.read(message, arrived, &mut other);
            // A scan that comes again, or late, is no news.
            if let (Some(seen), Some(last)) = (&seen, &self.last) {
                back = last.stamp.saturating_sub(seen.stamp);
            }
            let is_news =
                |seen: &LastScan| self.last.as_ref().is_none_or(|last| last.stamp < seen.stamp);
            if let Some(seen) = seen.filter(is_news) {
                self.last = Some(seen);
            }
        }
        let topic = &self.topic.scans;
        match (&self.last, other) {
            (Some(last), _) if last.arrived.elapsed() <= patience => Ok(()),
            (_, Some(frame)) => Err(self.topic.other_frame(frame)),
            (_, None) if back > 0 => Err(went_back(topic.topic(), back)),
            (_, None) => Err(topic.silent(patience)),
        }
    }

    /// The stamp of the last scan.
    pub(super) fn stamp(&self) -> Option<Nanoseconds> {
        self.last.as_ref().map(|last| last.stamp)
    }

    /// How far the robot may go ahead, in metres, by the last scan: up to the clearance before what is in the way of its
    /// circle. It is 0 without a scan, and if the scanner does not look there.
    pub(super) fn room(&self, then: &Odometry, now: &Odometry) -> f64 {
        self.last.as_ref().map_or(0.0, |last| room(&last.scan, then, now))
    }
}

impl ScanTopic {
    /// The scan of a message. If it is of another frame, that is noted.
    fn read(
        &self,
        Stamped { stamp, content }: Stamped<ScanReading>,
        arrived: Instant,
        other: &mut Option<String>,
    ) -> Option<LastScan> {
        if self.frame.as_ref().is_some_and(|frame| *frame != content.frame) {
            *other = Some(content.frame);
            return None;
        }
        let scan = Arc::new(content.scan(&self.mount)?);
        Some(LastScan { stamp, arrived, scan })
    }

    fn other_frame(&self, theirs: String) -> RobotError {
        let ours = self.frame.clone().unwrap_or_default();
        RobotError::OtherFrame { topic: self.scans.topic().to_owned(), theirs, ours }
    }
}

/// The room ahead of a robot that is now here, by a scan that it took then.
fn room(scan: &Scan, then: &Odometry, now: &Odometry) -> f64 {
    let mut room = f64::INFINITY;
    let mut looks_ahead = false;
    for (bearing, reading) in scan.readings() {
        let turned = now.seen(then.whither(bearing)).abs();
        looks_ahead |= turned <= AHEAD && reading != Reading::Invalid;
        let Reading::Hit(range) = reading else { continue };
        let point = scan.point(bearing, range);
        if point.coords.norm() < RADIUS {
            // It is the robot.
            continue;
        }
        let there = then.moved(point.y.atan2(point.x), point.coords.norm());
        let (far, direction) =
            (there.distance(now), now.seen(direction(&now.position, &there.position)));
        let (sine, cosine) = direction.sin_cos();
        let (ahead, aside) = (far * cosine, far * sine);
        if ahead > 0.0 && aside.abs() < RADIUS {
            room = room.min(ahead - (RADIUS * RADIUS - aside * aside).sqrt() - CLEARANCE);
        }
    }
    if looks_ahead { room.max(0.0) } else { 0.0 }
}

/// The error that stamps are this much before the last ones.
pub(super) fn went_back(topic: &str, by: Nanoseconds) -> RobotError {
    RobotError::ClockWentBack { topic: topic.to_owned(), seconds: by as f64 / SECOND as f64 }
}

/// The direction from a point to another, in radians.
fn direction(from: &[f64; 2], to: &[f64; 2]) -> f64 {
    (to[1] - from[1]).atan2(to[0] - from[0])
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, TAU};

    use toposlam_vision::laser::scan::ScanGeometry;

    use super::*;

    /// A scan of 360 degrees with a surface at one bearing, in degrees, and nothing elsewhere.
    fn scan(degrees: usize, range: f32, missing: std::ops::Range<usize>) -> Scan {
        let geometry = ScanGeometry {
            angle_min: 0.0,
            angle_increment: TAU / 360.0,
            range_min: 0.1,
            range_max: 20.0,
        };
        let mut ranges = vec![f32::INFINITY; 360];
        ranges[degrees] = range;
        ranges[missing].fill(f32::NAN);
        Scan::new(geometry, ranges, Mount::centre().robot_from_scanner).unwrap()
    }

    #[test]
    fn there_is_room_up_to_what_is_in_the_way_of_the_robots_circle() {
        let here = Odometry::default();
        let room = |scan: &Scan| room(scan, &here, &here);
        assert!((room(&scan(0, 1.0, 0..0)) - (1.0 - RADIUS - CLEARANCE)).abs() < 1e-6);
        // 11 degrees aside at 1 m is 0.19 m beside the way, 12 degrees is 0.208 m.
        assert!(room(&scan(11, 1.0, 0..0)) < 0.75);
        assert_eq!(room(&scan(12, 1.0, 0..0)), f64::INFINITY);
        // What is behind, and the robot itself, are not in the way.
        assert_eq!(room(&scan(180, 0.3, 0..0)), f64::INFINITY);
        assert_eq!(room(&scan(0, 0.15, 0..0)), f64::INFINITY);
        // It is too close already.
        assert_eq!(room(&scan(0, 0.3, 0..0)), 0.0);
    }

    #[test]
    fn there_is_no_room_where_the_laser_does_not_look() {
        let here = Odometry::default();
        let blind = scan(90, 1.0, 0..45);
        let sees = scan(90, 1.0, 1..45);
        let turned = Odometry { heading: -FRAC_PI_2, ..here };
        assert_eq!(room(&sees, &here, &here), f64::INFINITY);
        let blind = Scan::new(
            blind.geometry(),
            blind
                .ranges()
                .iter()
                .enumerate()
                .map(|(at, range)| if at > 300 { f32::NAN } else { *range })
                .collect(),
            blind.robot_from_scanner(),
        )
        .unwrap();
        assert_eq!(room(&blind, &here, &here), 0.0);
        assert_eq!(room(&blind, &here, &turned), f64::INFINITY);
    }

    #[test]
    fn a_scan_counts_from_where_it_was_taken() {
        let then = Odometry { position: [3.0, 1.0], heading: FRAC_PI_2 };
        let ahead = scan(0, 1.5, 0..0);
        let gone = then.moved(0.0, 0.5);
        assert!((room(&ahead, &then, &gone) - (1.0 - RADIUS - CLEARANCE)).abs() < 1e-6);
        // It has turned away from the surface, and towards it.
        assert_eq!(room(&ahead, &then, &then.moved(FRAC_PI_2, 0.0)), f64::INFINITY);
        let aside = scan(90, 1.0, 0..0);
        assert!(room(&aside, &then, &then.moved(FRAC_PI_2, 0.0)) < 0.6);
    }
}
