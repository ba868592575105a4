//! The laser scanner of a live robot, and what it last saw ahead.

use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use nalgebra::Point2;
use toposlam_logs::Mount;
use toposlam_model::driving::{odometry::Odometry, scene::wrapped};
use toposlam_vision::laser::scan::{Reading, Scan};

use super::{
    messages::{Nanoseconds, ScanReading, Stamped},
    stamps::StampFaults,
    topic::Subscription,
};
use crate::{
    robot::RobotError,
    superscout::{CLEARANCE, RADIUS},
};

/// Readings this close to straight ahead look where the robot goes, in radians.
const AHEAD: f64 = 0.1;
/// The robot itself is at most this far beside where the first scan showed it, in radians.
const BODY_ANGLE: f64 = 0.05;

/// The topic of a scanner.
pub(crate) struct ScanTopic {
    pub(crate) scans: Subscription<Stamped<ScanReading>>,
    /// The scanner's frame, unless any is accepted.
    pub(crate) frame: Option<String>,
    /// Where the scanner is on the robot.
    pub(crate) mount: Mount,
}

/// A scanner, and what it saw.
pub(super) struct Scanner {
    topic: ScanTopic,
    seen: SeenScans,
}

#[derive(Default)]
struct SeenScans {
    last: Option<LastScan>,
    body: Body,
    /// Whether any scan looked ahead.
    has_view: bool,
    /// What is wrong with the messages since the last scan,
    stamps: StampFaults,
    fault: Option<RobotError>,
}

struct LastScan {
    stamp: Nanoseconds,
    arrived: Instant,
    scan: Arc<Scan>,
}

impl Scanner {
    pub(super) fn new(topic: ScanTopic) -> Self {
        Self { topic, seen: SeenScans::default() }
    }

    /// Waits for a new scan whose stamp is accepted. `check_clock` returns an error if a stamp is of another clock.
    pub(super) fn wait<W>(
        &mut self,
        patience: Duration,
        stop: fn() -> bool,
        check_clock: impl Fn(&str, Nanoseconds) -> Result<(), RobotError>,
        mut accepted: impl FnMut(Nanoseconds) -> Option<W>,
    ) -> Result<(W, Arc<Scan>), RobotError> {
        let Self { topic, seen } = self;
        let found = topic.scans.wait(patience, stop, |message| {
            let last = seen.add(topic, message, Instant::now(), &check_clock)?;
            Some((accepted(last.stamp)?, last.scan.clone()))
        });
        found.map_err(|error| self.seen.explain(error))
    }

    /// Takes the last scan, if one has come since.
    ///
    /// # Errors
    /// Returns an error if the last one came longer ago than this.
    pub(super) fn update(
        &mut self,
        patience: Duration,
        check_clock: impl Fn(&str, Nanoseconds) -> Result<(), RobotError>,
    ) -> Result<(), RobotError> {
        let Self { topic, seen } = self;
        topic.scans.check_source()?;
        if let Some((message, arrived)) = topic.scans.take_timed() {
            seen.add(topic, message, arrived, &check_clock);
        }
        match &seen.last {
            Some(last) if last.arrived.elapsed() <= patience => Ok(()),
            _ => Err(seen.explain(topic.scans.silent(patience))),
        }
    }

    /// The stamp of the last scan.
    pub(super) fn stamp(&self) -> Option<Nanoseconds> {
        self.seen.last.as_ref().map(|last| last.stamp)
    }

    /// How far the robot may go ahead, in metres, by the last scan: up to the clearance before what is in the way of its
    /// circle. It is 0 without a scan, and if the scanner does not look there.
    pub(super) fn room(&self, then: &Odometry, now: &Odometry) -> f64 {
        let SeenScans { last, body, .. } = &self.seen;
        last.as_ref().and_then(|last| view(&last.scan, body, then, now)).unwrap_or(0.0)
    }

    /// # Errors
    /// Returns an error if no scan ever looked ahead: the robot would never go anywhere.
    pub(super) fn check_view(&self) -> Result<(), RobotError> {
        if self.seen.has_view {
            return Ok(());
        }
        Err(RobotError::NothingAhead { topic: self.topic.scans.topic().to_owned() })
    }
}

impl ScanTopic {
    /// # Errors
    /// Returns an error if this is no scan of this scanner.
    fn scan(&self, content: ScanReading) -> Result<Scan, RobotError> {
        let topic = || self.scans.topic().to_owned();
        if let Some(frame) = self.frame.as_ref().filter(|frame| **frame != content.frame) {
            let ours = format!("that of the first scan, `{frame}`");
            return Err(RobotError::OtherFrame { topic: topic(), theirs: content.frame, ours });
        }
        let scan = content.scan(&self.mount);
        scan.map_err(|cause| RobotError::NoScan { topic: topic(), cause })
    }
}

impl SeenScans {
    /// Adds a message, and returns its scan if it is one of this scanner, later than the last one, and of the clock of
    /// odometry.
    fn add(
        &mut self,
        topic: &ScanTopic,
        Stamped { stamp, content }: Stamped<ScanReading>,
        arrived: Instant,
        check_clock: impl Fn(&str, Nanoseconds) -> Result<(), RobotError>,
    ) -> Option<&LastScan> {
        if let Some(last) = &self.last
            && !self.stamps.is_later(last.stamp, stamp)
        {
            return None;
        }
        let checked = check_clock(topic.scans.topic(), stamp).and_then(|()| topic.scan(content));
        let scan = checked.map_err(|fault| self.fault = Some(fault)).ok()?;
        self.fault = None;
        if self.last.is_none() {
            self.body = Body::new(&scan);
        }
        let here = Odometry::default();
        self.has_view = self.has_view || view(&scan, &self.body, &here, &here).is_some();
        Some(self.last.insert(LastScan { stamp, arrived, scan: Arc::new(scan) }))
    }

    /// An error, or its cause if that is in the messages.
    fn explain(&self, error: RobotError) -> RobotError {
        match (error, &self.fault) {
            (RobotError::Silent { .. }, Some(fault)) => fault.clone(),
            (error, _) => self.stamps.explain(error),
        }
    }
}

/// The directions from the scanner in which the first scan shows the robot itself: surfaces in its circle. Later ones
/// elsewhere in the circle are obstacles.
#[derive(Default)]
struct Body(Vec<f64>);

impl Body {
    fn new(scan: &Scan) -> Self {
        let all = scan.readings().zip(scan.ranges());
        let near = all.filter_map(|((bearing, reading), &range)| {
            let point = scan.point(bearing, surface(scan, reading, range.into())?);
            (point.coords.norm() < RADIUS).then_some(bearing)
        });
        Self(near.collect())
    }

    fn is_at(&self, bearing: f64) -> bool {
        self.0.iter().any(|seen| wrapped(seen - bearing).abs() <= BODY_ANGLE)
    }
}

/// The range of the surface that a reading shows, in metres; `None` if it shows none. One that is too near to be measured
/// is an obstacle, too.
fn surface(scan: &Scan, reading: Reading, range: f64) -> Option<f64> {
    let least = scan.geometry().range_min;
    match reading {
        Reading::Hit(range) => Some(range),
        Reading::Invalid if range == f64::NEG_INFINITY => Some(least.max(0.0)),
        Reading::Invalid if range > 0.0 => Some(range),
        Reading::NoReturn | Reading::Invalid => None,
    }
}

/// Whether a range of 0 means that there is no surface. Some drivers write it instead of infinity, which they never use.
fn is_zero_free(scan: &Scan) -> bool {
    scan.ranges().iter().all(|range| range.is_finite() || range.is_nan())
}

/// The room ahead of a robot that is now here, by a scan that it took then; `None` if the scan does not show most of what is
/// straight ahead.
///
/// A range of 0 shows that there is no surface only if a surface too near for the scanner would be in the robot's circle.
/// What is not a number shows nothing, and neither does the robot itself.
fn view(scan: &Scan, body: &Body, then: &Odometry, now: &Odometry) -> Option<f64> {
    let zero_is_free = is_zero_free(scan);
    let least = scan.geometry().range_min;
    let mut room = f64::INFINITY;
    let (mut shown, mut hidden) = (0_u32, 0_u32);
    for ((bearing, reading), &range) in scan.readings().zip(scan.ranges()) {
        let hit = surface(scan, reading, range.into()).map(|range| scan.point(bearing, range));
        let is_body = hit.is_some_and(|point| point.coords.norm() < RADIUS) && body.is_at(bearing);
        let is_free = reading == Reading::NoReturn
            || range == 0.0 && zero_is_free && scan.point(bearing, least).coords.norm() < RADIUS;
        if now.seen(then.whither(bearing)).abs() <= AHEAD {
            let counter =
                if !is_body && (hit.is_some() || is_free) { &mut shown } else { &mut hidden };
            *counter += 1;
        }
        if let Some(point) = hit.filter(|_| !is_body) {
            room = room.min(room_before(&point, then, now));
        }
    }
    (shown > 0 && shown >= hidden).then(|| room.max(0.0))
}

/// How far the robot may go ahead before a point that it saw then, in the robot's frame; infinite if the point is not in the
/// way of its circle.
fn room_before(point: &Point2<f64>, then: &Odometry, now: &Odometry) -> f64 {
    let there = then.moved(point.y.atan2(point.x), point.coords.norm());
    let far = there.distance(now);
    let (sine, cosine) = now.seen(direction(&now.position, &there.position)).sin_cos();
    let (ahead, aside) = (far * cosine, far * sine);
    if ahead > 0.0 && aside.abs() < RADIUS {
        ahead - (RADIUS * RADIUS - aside * aside).sqrt() - CLEARANCE
    } else {
        f64::INFINITY
    }
}

/// The direction from a point to another, in radians.
fn direction(from: &[f64; 2], to: &[f64; 2]) -> f64 {
    (to[1] - from[1]).atan2(to[0] - from[0])
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, TAU};

    use toposlam_vision::laser::scan::{ScanError, ScanGeometry};

    use super::*;
    use crate::live::{
        messages::SECOND,
        topic::{Inbox, subscription},
    };

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

    /// The same with other limits and ranges.
    fn all_round(range_min: f64, range: impl Fn(usize) -> f32) -> Scan {
        let geometry = ScanGeometry { range_min, ..scan(0, 1.0, 0..0).geometry() };
        let ranges = (0..360).map(range).collect();
        Scan::new(geometry, ranges, Mount::centre().robot_from_scanner).unwrap()
    }

    fn room(scan: &Scan, then: &Odometry, now: &Odometry) -> f64 {
        view(scan, &Body::default(), then, now).unwrap_or(0.0)
    }

    fn view_from_here(scan: &Scan) -> Option<f64> {
        view(scan, &Body::default(), &Odometry::default(), &Odometry::default())
    }

    #[test]
    fn there_is_room_up_to_what_is_in_the_way_of_the_robots_circle() {
        let room = |scan: &Scan| view_from_here(scan).unwrap();
        assert!((room(&scan(0, 1.0, 0..0)) - (1.0 - RADIUS - CLEARANCE)).abs() < 1e-6);
        // 11 degrees aside at 1 m is 0.19 m beside the way, 12 degrees is 0.208 m.
        assert!(room(&scan(11, 1.0, 0..0)) < 0.75);
        assert_eq!(room(&scan(12, 1.0, 0..0)), f64::INFINITY);
        // What is behind is not in the way.
        assert_eq!(room(&scan(180, 0.3, 0..0)), f64::INFINITY);
        // It is too close already.
        assert_eq!(room(&scan(0, 0.3, 0..0)), 0.0);
    }

    #[test]
    fn what_is_in_the_robots_circle_from_the_first_scan_on_is_the_robot_and_what_comes_later_is_not()
     {
        let here = Odometry::default();
        let body = Body::new(&scan(20, 0.15, 0..0));
        let room = |degrees, range| view(&scan(degrees, range, 0..0), &body, &here, &here);
        assert_eq!(room(20, 0.15), Some(f64::INFINITY));
        assert_eq!(room(22, 0.16), Some(f64::INFINITY));
        assert_eq!(room(30, 0.15), Some(0.0));
        assert_eq!(room(0, 0.15), Some(0.0));
        // Nearer than the scanner can measure, and so near that it gives no range.
        assert_eq!(room(0, 0.05), Some(0.0));
        assert_eq!(room(0, f32::NEG_INFINITY), Some(0.0));
        // Outside of the circle it is an obstacle in that direction, too.
        assert!(room(20, 0.4).unwrap() < 0.1);
        // A robot that hides most of what is ahead of it.
        let wide = |degrees| if (356..=360).contains(&degrees) || degrees < 3 { 0.15 } else { 5.0 };
        let wide = all_round(0.1, wide);
        assert_eq!(view(&wide, &Body::new(&wide), &here, &here), None);
    }

    #[test]
    fn a_range_of_0_is_free_only_if_nothing_can_be_too_near_for_the_scanner() {
        let corridor = |degrees: usize| if degrees.abs_diff(180) < 100 { 2.0 } else { 0.0 };
        assert_eq!(view_from_here(&all_round(0.12, corridor)), Some(f64::INFINITY));
        assert_eq!(view_from_here(&all_round(0.3, corridor)), None);
        // This driver has another range for what is far.
        let faulty = |degrees| if degrees == 90 { f32::INFINITY } else { corridor(degrees) };
        assert_eq!(view_from_here(&all_round(0.12, faulty)), None);
        let obstacle = |degrees| if degrees == 2 { 1.0 } else { corridor(degrees) };
        assert!(view_from_here(&all_round(0.12, obstacle)).unwrap() < 0.7);
    }

    #[test]
    fn there_is_a_view_if_most_of_what_is_ahead_is_no_invalid_reading() {
        // The readings from 5 degrees to the right to 5 degrees to the left.
        assert_eq!(view_from_here(&scan(90, 1.0, 0..5)), Some(f64::INFINITY));
        assert_eq!(view_from_here(&scan(90, 1.0, 0..6)), None);
        let here = Odometry::default();
        let turned = Odometry { heading: -FRAC_PI_2, ..here };
        assert_eq!(room(&scan(90, 1.0, 0..6), &here, &turned), f64::INFINITY);
        assert_eq!(view_from_here(&all_round(0.1, |_| f32::NAN)), None);
    }

    fn message(tenths: u64, frame: &str, ranges: Vec<f32>) -> Stamped<ScanReading> {
        let geometry = scan(0, 1.0, 0..0).geometry();
        let content = ScanReading { frame: frame.to_owned(), geometry, ranges };
        Stamped { stamp: tenths * SECOND / 10, content }
    }

    /// Its first scan came at 1 s.
    fn scanner() -> (Inbox<Stamped<ScanReading>>, Scanner) {
        let (inbox, scans) = subscription("/scan");
        let frame = Some("laser".to_owned());
        let mut scanner = Scanner::new(ScanTopic { scans, frame, mount: Mount::centre() });
        inbox.add(Some(message(10, "laser", vec![3.0; 360])));
        scanner.update(PATIENCE, |_, _| Ok(())).unwrap();
        (inbox, scanner)
    }

    const PATIENCE: Duration = Duration::from_millis(50);

    fn room_ahead(scanner: &Scanner) -> f64 {
        scanner.room(&Odometry::default(), &Odometry::default())
    }

    /// A scan that is taken before the end of a motion does not show the place where it ended, but what is ahead.
    #[test]
    fn the_newest_scan_counts_although_another_one_is_wanted() {
        let (inbox, mut scanner) = scanner();
        let mut wait = |inbox: &Inbox<_>, tenths, range| {
            inbox.add(Some(message(tenths, "laser", vec![range; 360])));
            let never = |_| None::<()>;
            let waited = scanner.wait(PATIENCE, || false, |_, _| Ok(()), never);
            assert!(waited.is_err());
            room_ahead(&scanner)
        };
        assert!(wait(&inbox, 11, 1.0) < 0.6);
        // This one is older.
        assert!(wait(&inbox, 9, 5.0) < 0.6);
    }

    #[test]
    fn an_error_of_a_scanner_names_what_is_wrong_with_its_messages() {
        let topic = || "/scan".to_owned();
        let error = |messages: &[Stamped<ScanReading>]| {
            let (inbox, mut scanner) = scanner();
            let clock = |topic: &str, stamp| match stamp {
                900_000_000_000 => Err(RobotError::Closed { topic: topic.to_owned() }),
                _ => Ok(()),
            };
            std::thread::sleep(2 * PATIENCE);
            for message in messages {
                inbox.add(Some(message.clone()));
                let _ = scanner.update(PATIENCE, clock);
            }
            scanner.update(PATIENCE, clock).unwrap_err()
        };
        let ours = "that of the first scan, `laser`".to_owned();
        let other = RobotError::OtherFrame { topic: topic(), theirs: "camera".to_owned(), ours };
        assert_eq!(error(&[message(11, "camera", vec![1.0; 360])]), other);
        let none = RobotError::NoScan { topic: topic(), cause: ScanError::NoReadings };
        assert_eq!(error(&[message(11, "laser", vec![])]), none);
        let same = [(); 5].map(|()| message(10, "laser", vec![1.0; 360]));
        assert_eq!(error(&same), RobotError::SameStamp { topic: topic() });
        let back = RobotError::ClockWentBack { topic: topic(), seconds: 0.5 };
        assert_eq!(error(&[message(5, "laser", vec![1.0; 360])]), back);
        let clock = message(9000, "laser", vec![1.0; 360]);
        assert_eq!(error(&[clock]), RobotError::Closed { topic: topic() });
        assert!(matches!(error(&[]), RobotError::Silent { .. }));
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
