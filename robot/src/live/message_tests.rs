//! What a robot does if its messages are wrong. Another thread sends them, a hundred times a second.

use std::{
    f64::consts::TAU,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
        mpsc::{Receiver, RecvTimeoutError, Sender, channel},
    },
    thread,
    time::{Duration, Instant},
};

use toposlam_logs::Mount;
use toposlam_model::driving::{odometry::Odometry, scene::MarkerView};
use toposlam_vision::laser::scan::ScanGeometry;

use super::{
    Connection, Nanoseconds, Reckoning, SECOND, SensorTopics, Wheels,
    messages::{MarkerReading, ScanReading, Stamped},
    robot::LiveRobot,
    scanner::ScanTopic,
    topic::{Inbox, subscription},
};
use crate::{
    robot::{Robot, RobotError},
    superscout::{SPEED, TURN_RATE, WheelSpeeds},
};

const PATIENCE: Duration = Duration::from_millis(500);
const INTERVAL: Duration = Duration::from_millis(10);
/// The robot is switched on at this time.
const BEGIN: Nanoseconds = 100 * SECOND;

/// What is sent at a time, which is that of the robot.
type SendMessages = fn(&Topics, Nanoseconds);

struct Topics {
    odometry: Inbox<Reckoning>,
    scans: Inbox<Stamped<ScanReading>>,
    markers: Inbox<Stamped<MarkerReading>>,
}

impl Topics {
    fn send_odometry(&self, stamp: Nanoseconds, x: f64) {
        let at = Odometry { position: [x, 0.0], heading: 0.0 };
        self.odometry.add(Some(Reckoning { stamp, at, wheels: WheelSpeeds::STOP }));
    }

    fn send_scan(&self, stamp: Nanoseconds, range: f32) {
        let geometry = ScanGeometry {
            angle_min: 0.0,
            angle_increment: TAU / 360.0,
            range_min: 0.1,
            range_max: 20.0,
        };
        let content = ScanReading { frame: "laser".to_owned(), geometry, ranges: vec![range; 360] };
        self.scans.add(Some(Stamped { stamp, content }));
    }

    fn send_marker(&self, stamp: Nanoseconds, frame: &str) {
        let marker = MarkerView { position: [1.0, 0.0], axis: 0.0, door: None };
        let content = MarkerReading { frame: frame.to_owned(), marker };
        self.markers.add(Some(Stamped { stamp, content }));
    }

    /// What a robot sends that stands 3 m from everything.
    fn send_all(&self, now: Nanoseconds) {
        self.send_all_at(now, 0.0);
    }

    fn send_all_at(&self, now: Nanoseconds, x: f64) {
        self.send_odometry(now, x);
        self.send_scan(now, 3.0);
    }
}

/// The commands to the wheels. A pause lasts until the next look for it.
#[derive(Clone, Default)]
struct RecordedWheels {
    sent: Arc<Mutex<Vec<WheelSpeeds>>>,
    is_paused: Arc<AtomicBool>,
}

impl RecordedWheels {
    fn all(&self) -> Vec<WheelSpeeds> {
        self.sent.lock().unwrap().clone()
    }

    fn last(&self) -> Option<WheelSpeeds> {
        self.all().last().copied()
    }
}

impl Wheels for RecordedWheels {
    fn wait(&self) -> Result<bool, RobotError> {
        Ok(self.is_paused.swap(false, Ordering::Relaxed))
    }

    fn is_interrupted(&self) -> bool {
        self.is_paused.load(Ordering::Relaxed)
    }

    fn command(&self, wheels: WheelSpeeds) -> Result<bool, RobotError> {
        let is_sent = wheels == WheelSpeeds::STOP || !self.is_interrupted();
        if is_sent {
            self.sent.lock().unwrap().push(wheels);
        }
        Ok(is_sent)
    }
}

/// A thread that sends messages.
struct Driver {
    next: Sender<SendMessages>,
    wheels: RecordedWheels,
}

impl Driver {
    /// A robot that sends this, and its driver.
    fn new(send: SendMessages) -> (Result<LiveRobot, RobotError>, Self) {
        let (odometry, odometry_read) = subscription("/odom");
        let (scans, scans_read) = subscription("/scan");
        let (markers, markers_read) = subscription("/marker");
        let (next, changes) = channel();
        let topics = Topics { odometry, scans, markers };
        thread::spawn(move || send_until_dropped(&topics, send, &changes));
        let wheels = RecordedWheels::default();
        let scans = ScanTopic {
            scans: scans_read,
            frame: Some("laser".to_owned()),
            mount: Mount::centre(),
        };
        let connection = Connection {
            wheels: Box::new(wheels.clone()),
            odometry: odometry_read,
            sensor: SensorTopics::Laser { scans, markers: markers_read },
            node: Box::new(()),
        };
        (LiveRobot::within(PATIENCE, connection, PATIENCE, || false), Self { next, wheels })
    }

    /// A robot whose driver begins well and then sends this.
    fn after(send: SendMessages) -> (LiveRobot, Self) {
        let (robot, driver) = Self::new(Topics::send_all);
        driver.next.send(send).unwrap();
        thread::sleep(2 * INTERVAL);
        (robot.unwrap(), driver)
    }
}

fn send_until_dropped(topics: &Topics, mut send: SendMessages, changes: &Receiver<SendMessages>) {
    let begun = Instant::now();
    loop {
        let since = u64::try_from(begun.elapsed().as_nanos()).unwrap();
        send(topics, BEGIN + since);
        match changes.recv_timeout(INTERVAL) {
            Ok(other) => send = other,
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return,
        }
    }
}

/// The error of a capture while this is sent, before which everything was right.
fn capture_error(send: SendMessages) -> RobotError {
    let (mut robot, _driver) = Driver::after(send);
    robot.capture().unwrap_err()
}

#[test]
fn a_marker_is_seen_or_not_if_its_messages_are_of_the_robots_frame_and_clock() {
    let (mut robot, driver) = Driver::after(Topics::send_all);
    assert_eq!(robot.capture().unwrap().marker, None);
    let seen: SendMessages = |topics, now| {
        topics.send_marker(now, "/robot1/base_footprint");
        topics.send_all(now);
    };
    driver.next.send(seen).unwrap();
    thread::sleep(3 * INTERVAL);
    assert_eq!(robot.capture().unwrap().marker.unwrap().position, [1.0, 0.0]);
    let error = capture_error(|topics, now| {
        topics.send_marker(now, "camera_optical");
        topics.send_all(now);
    });
    let other = "the messages on /marker are in the frame `camera_optical`; this program needs that of the robot: base_link, base_footprint or base";
    assert_eq!(error.to_string(), other);
    let error = capture_error(|topics, now| {
        topics.markers.add(None);
        topics.send_all(now);
    });
    assert!(matches!(error, RobotError::Unreadable { .. }), "{error}");
    for send in [
        (|topics, now| {
            topics.send_marker(now - 5 * SECOND, "base_link");
            topics.send_all(now);
        }) as SendMessages,
        |topics, now| {
            topics.send_marker(now + 5 * SECOND, "base_link");
            topics.send_all(now);
        },
    ] {
        let error = capture_error(send);
        assert!(error.to_string().contains("on /marker and on /odom differ by 5.0 s"), "{error}");
    }
}

/// A message that nobody read since an earlier junction is no error.
#[test]
fn a_marker_that_was_seen_long_ago_is_not_seen_now() {
    let (mut robot, driver) = Driver::after(|topics, now| {
        topics.send_marker(now, "base_link");
        topics.send_all(now);
    });
    driver.next.send(Topics::send_all).unwrap();
    robot.forward(0.1).unwrap();
    thread::sleep(PATIENCE);
    robot.forward(0.1).unwrap();
    assert_eq!(robot.capture().unwrap().marker, None);
}

#[test]
fn scans_and_odometry_need_one_clock_at_the_beginning_and_later() {
    let differ = "the stamps on /scan and on /odom differ by 9.0 s";
    let late: SendMessages = |topics, now| {
        topics.send_odometry(now, 0.0);
        topics.send_scan(now - 9 * SECOND, 3.0);
    };
    let early: SendMessages = |topics, now| {
        topics.send_odometry(now, 0.0);
        topics.send_scan(now + 9 * SECOND, 3.0);
    };
    assert_eq!(capture_error(early).to_string(), differ);
    let (mut robot, driver) = Driver::after(early);
    assert_eq!((0..9).find_map(|_| robot.forward(0.5).err()).unwrap().to_string(), differ);
    assert_eq!(driver.wheels.last(), Some(WheelSpeeds::STOP));
    let (robot, _driver) = Driver::new(late);
    assert_eq!(robot.err().unwrap().to_string(), differ);
}

#[test]
fn a_driver_that_sets_no_stamps_is_named() {
    let (robot, _driver) = Driver::new(|topics, now| {
        topics.send_odometry(0, 0.0);
        topics.send_scan(now, 3.0);
    });
    assert_eq!(robot.err(), Some(RobotError::SameStamp { topic: "/odom".to_owned() }));
}

#[cfg(feature = "ros2")]
#[test]
fn with_a_second_source_of_a_topic_the_wheels_are_stopped() {
    let sends: [SendMessages; 2] = [
        |topics, now| {
            topics.send_all(now);
            topics.odometry.record_two_sources();
        },
        |topics, now| {
            topics.send_all(now);
            topics.scans.record_two_sources();
        },
    ];
    for (send, topic) in sends.into_iter().zip(["/odom", "/scan"]) {
        let (mut robot, driver) = Driver::after(Topics::send_all);
        driver.next.send(send).unwrap();
        thread::sleep(3 * INTERVAL);
        let error = robot.forward(0.5).unwrap_err();
        assert_eq!(error, RobotError::TwoSources { topic: topic.to_owned() });
        drop(robot);
        // The stop command is repeated for a second, some times.
        let sent = driver.wheels.all();
        assert!(sent.iter().all(|wheels| *wheels == WheelSpeeds::STOP), "it does not move");
        assert!((1..100).contains(&sent.len()), "{}", sent.len());
    }
}

#[test]
fn odometry_that_jumps_ends_a_motion_and_stops_the_wheels() {
    let (mut robot, driver) = Driver::after(Topics::send_all);
    driver.next.send(|topics, now| topics.send_all_at(now, 7.0)).unwrap();
    let error = robot.forward(0.5).unwrap_err();
    assert!(matches!(error, RobotError::OdometryJumped { metres, .. } if metres > 6.9), "{error}");
    assert_eq!(driver.wheels.last(), Some(WheelSpeeds::STOP));
    // While it stands, too.
    let error = capture_error(|topics, now| topics.send_all_at(now, -7.0));
    assert!(matches!(error, RobotError::OdometryJumped { .. }), "{error}");
}

/// A message may be lost or late: the robot may have gone on in this time.
#[test]
fn odometry_goes_on_after_a_gap_where_the_robot_can_be() {
    let (mut robot, driver) = Driver::after(Topics::send_all);
    driver.next.send(|_, _| {}).unwrap();
    thread::sleep(PATIENCE / 2);
    driver.next.send(|topics, now| topics.send_all_at(now, 0.15)).unwrap();
    thread::sleep(2 * INTERVAL);
    robot.capture().unwrap();
    assert_eq!(robot.odometry().odometry.position, [0.15, 0.0]);
}

#[test]
fn scans_that_never_show_what_is_ahead_are_an_error_before_a_motion() {
    let (robot, driver) = Driver::new(|topics, now| {
        topics.send_odometry(now, 0.0);
        topics.send_scan(now, f32::NAN);
    });
    let error = robot.unwrap().forward(0.5).unwrap_err();
    assert_eq!(error, RobotError::NothingAhead { topic: "/scan".to_owned() });
    assert!(driver.wheels.all().iter().all(|sent| *sent == WheelSpeeds::STOP));
}

/// The parts of its greatest speed that are commanded in a motion with a pause.
fn commanded(motion: fn(&mut LiveRobot), part: fn(&WheelSpeeds) -> f64) -> Vec<f64> {
    let (mut robot, driver) = Driver::after(Topics::send_all);
    let wheels = driver.wheels.clone();
    let pauses = thread::spawn(move || {
        thread::sleep(Duration::from_millis(1100));
        wheels.is_paused.store(true, Ordering::Relaxed);
    });
    motion(&mut robot);
    pauses.join().unwrap();
    driver.wheels.all().iter().map(part).collect()
}

#[test]
fn a_run_that_goes_on_after_a_pause_speeds_up_again_from_a_standstill() {
    let ahead = commanded(|robot| robot.forward(0.5).unwrap(), |wheels| wheels.speed() / SPEED);
    let turn = commanded(|robot| robot.turn(2.0).unwrap(), |wheels| wheels.turn_rate() / TURN_RATE);
    for parts in [ahead, turn] {
        let paused = parts.iter().position(|part| *part == 0.0).unwrap();
        assert!(parts[paused - 1] > 0.9, "{parts:?}");
        assert!((0.1..0.6).contains(&parts[paused + 1]), "{parts:?}");
    }
}
