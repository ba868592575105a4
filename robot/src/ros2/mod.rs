//! A SuperScout behind the topics of ROS 2, over DDS. Section 2.5. The robot and its driver find each other in a domain.
//!
//! Unless [`RobotDomain::network`] is set, only robots on this machine are found.

mod graph;
mod markers;
mod messages;
mod node;
mod run_topics;
mod safety;
mod service;
mod status;
mod wheels;

use std::{
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicU64, Ordering},
    },
    thread::sleep,
    time::{Duration, Instant},
};

use toposlam_logs::{
    FrameTree, Mount,
    message::Message,
    recorder,
    standard::{
        ClockMessage, CompressedImage, FileBytes, LaserScanMessage, OdometryMessage, PoseStamped,
        RawImage, TFMessage,
    },
};
use toposlam_model::driving::scene::MarkerView;
use toposlam_vision::laser::scan::Scan;

use self::{
    messages::{CLOCK, FrameReader},
    node::{DdsNode, OtherSide, Writer},
    safety::SafetyWatch,
    service::TriggerResponse,
    status::{PublishedState, STATE, STATE_TYPE},
    wheels::{PauseRefusal, StampClock, Standstill, WheelsTopic},
};
use crate::{
    live::{
        Connection, FIRST, LiveRobot, LiveSensor, Nanoseconds, Reckoning, RobotTopics, ScanTopic,
        SensorTopics, ServedRobot,
        messages::{ScanReading, Stamped},
        topic::Subscription,
    },
    robot::RobotError,
    superscout::WheelSpeeds,
};

pub use graph::RosDistro;
pub use messages::WheelsType;
pub use node::RobotDomain;
pub use run_topics::RunTopics;

const ODOMETRY: &str = <OdometryMessage as Message>::TYPE;
const SCAN: &str = <LaserScanMessage<&[f32]> as Message>::TYPE;
const MARKER: &str = <PoseStamped as Message>::TYPE;
/// The types of images: files, and pixels.
const IMAGES: [&str; 2] =
    [<CompressedImage<FileBytes> as Message>::TYPE, <RawImage<FileBytes> as Message>::TYPE];
/// All nodes of a domain have found each other within this time, on one machine.
const ALL_FOUND: Duration = Duration::from_secs(3);
/// Static transforms are sent to late nodes within this time.
const TRANSFORMS: Duration = Duration::from_secs(6);

/// How a robot is driven.
#[derive(Clone, Copy, Debug)]
pub struct DriveSettings {
    pub sensor: LiveSensor,
    /// The type of the commands to the wheels, if the robot reads two.
    pub wheels_type: Option<WheelsType>,
    /// Whether commands have the time of `/clock`, and not that of the system.
    pub sim_time: bool,
    /// The longest time without odometry, and without an image if one is expected.
    pub patience: Duration,
    /// If it returns true, the robot stops and does nothing more.
    pub stop: fn() -> bool,
    /// Called when somebody aborts the run: from then on, `stop` returns true.
    pub abort: fn(),
}

/// The robot behind topics, as soon as odometry and an image, or a scan, have come, and what publishes its run. Transforms say
/// where its scanner is.
///
/// # Errors
/// Returns an error if there is no robot, if a topic has another type, or if the scanner's place is not known.
pub fn connect(
    domain: &RobotDomain,
    topics: &RobotTopics,
    settings: &DriveSettings,
) -> Result<(LiveRobot, RunTopics), RobotError> {
    let begun = Instant::now();
    let DriveSettings { sensor, wheels_type, sim_time, patience, stop, abort } = *settings;
    let node = Arc::new(DdsNode::new(domain)?);
    let published = |topic: &str, kinds: &[&'static str]| {
        node.type_of(topic, OtherSide::Publishes, kinds, FIRST, stop)
    };
    published(&topics.odometry, &[ODOMETRY])?;
    let odometry = node.subscribe(&topics.odometry, ODOMETRY, messages::read_odometry)?;
    let (sensor, sensed) = match sensor {
        LiveSensor::Camera => {
            let kind = published(&topics.images, &IMAGES)?;
            let read =
                if kind == IMAGES[1] { messages::read_raw_image } else { messages::read_image };
            let images = node.subscribe(&topics.images, kind, read)?;
            (SensorTopics::Camera(images), vec![(&topics.images, kind)])
        }
        LiveSensor::Laser => {
            published(&topics.scans, &[SCAN])?;
            let scans = node.subscribe(&topics.scans, SCAN, messages::read_scan)?;
            let (frame, mount) = scanner_mount(&node, &scans, stop)?;
            published(&topics.marker, &[MARKER])?;
            let markers = node.subscribe(&topics.marker, MARKER, messages::read_marker)?;
            let scans = ScanTopic { scans, frame: Some(frame), mount };
            let sensed = vec![(&topics.scans, SCAN), (&topics.marker, MARKER)];
            (SensorTopics::Laser { scans, markers }, sensed)
        }
    };
    let clock = if sim_time { simulated_clock(&node, stop)? } else { StampClock::System };
    // Another robot on these topics may have been found later.
    sleep(ALL_FOUND.saturating_sub(begun.elapsed()));
    for (topic, kind) in [&[(&topics.odometry, ODOMETRY)], &sensed[..]].concat() {
        published(topic, &[kind])?;
    }
    let wheels_type = wheels_type_of(&node, &topics.wheels, wheels_type, stop)?;
    let writer = node.advertise(&topics.wheels, wheels_type.type_name())?;
    let state = node.advertise_last(STATE, STATE_TYPE)?;
    let state = Arc::new(PublishedState::new(state, clock.clone()));
    let standstill = Standstill::default();
    let wheels = Arc::new(WheelsTopic { wheels_type, writer, clock, stop, standstill });
    let run = RunTopics::new(&node, state.clone())?;
    serve(&node, &wheels, &state, abort)?;
    let watch = SafetyWatch::new(node.clone(), wheels.clone(), state)?;
    let wheels = Box::new(wheels);
    // The thread ends before the node is dropped.
    let connection = Connection { wheels, odometry, sensor, node: Box::new((watch, node)) };
    Ok((LiveRobot::new(connection, patience, stop)?, run))
}

/// The time of `/clock`, as soon as there is one.
fn simulated_clock(node: &DdsNode, stop: fn() -> bool) -> Result<StampClock, RobotError> {
    let kind = <ClockMessage as Message>::TYPE;
    node.type_of(CLOCK, OtherSide::Publishes, &[kind], FIRST, stop)?;
    let last = Arc::new(AtomicU64::new(0));
    let time = last.clone();
    let began = node.subscribe(CLOCK, kind, move |body| {
        let now = messages::read_clock(body)?;
        time.store(now, Ordering::Relaxed);
        Some(())
    })?;
    began.wait(FIRST, stop, Some)?;
    Ok(StampClock::Simulated(last))
}

/// Answers the services by which others pause, resume and abort a run.
fn serve(
    node: &DdsNode,
    wheels: &Arc<WheelsTopic>,
    state: &Arc<PublishedState>,
    abort: fn(),
) -> Result<(), RobotError> {
    let (wheels_of, state_of) = (wheels.clone(), state.clone());
    node.serve("/toposlam/pause", move || {
        let paused = wheels_of.pause();
        let is_paused = matches!(paused, Ok(()) | Err(PauseRefusal::NotSent));
        state_of.change(|state| state.is_paused |= is_paused);
        let message = paused.map_or_else(PauseRefusal::message, |()| "the stop command is sent");
        TriggerResponse { success: paused.is_ok(), message }
    })?;
    let (wheels_of, state_of) = (wheels.clone(), state.clone());
    node.serve("/toposlam/resume", move || {
        let success = wheels_of.resume();
        state_of.change(|state| state.is_paused &= !success);
        let message = if success { "the run goes on" } else { "the run is not paused" };
        TriggerResponse { success, message }
    })?;
    node.serve("/toposlam/abort", move || {
        abort();
        TriggerResponse { success: true, message: "the run ends" }
    })
}

/// The type of the commands that the robot reads; if it reads both, the given one.
fn wheels_type_of(
    node: &DdsNode,
    topic: &str,
    given: Option<WheelsType>,
    stop: fn() -> bool,
) -> Result<WheelsType, RobotError> {
    let kinds = given.map_or(WheelsType::ALL.to_vec(), |given| vec![given]);
    let known: Vec<_> = kinds.iter().map(|kind| kind.type_name()).collect();
    match (node.type_of(topic, OtherSide::Reads, &known, FIRST, stop), given) {
        (Ok(found), _) => {
            let kind = kinds.into_iter().find(|kind| kind.type_name() == found);
            Ok(kind.unwrap_or(WheelsType::Twist))
        }
        (Err(RobotError::OtherType { theirs, .. }), Some(given))
            if theirs.split(" and ").any(|kind| kind == given.type_name()) =>
        {
            Ok(given)
        }
        (Err(RobotError::OtherType { topic, theirs, .. }), None) if theirs.contains(" and ") => {
            let ours = "one of them; select it with --cmd-vel-type".to_owned();
            Err(RobotError::OtherType { topic, theirs, ours })
        }
        (Err(error), _) => Err(error),
    }
}

/// The frame of the scanner of a topic, and where it is on the robot, by its transforms.
fn scanner_mount(
    node: &DdsNode,
    scans: &Subscription<Stamped<ScanReading>>,
    stop: fn() -> bool,
) -> Result<(String, Mount), RobotError> {
    let frames = Arc::new(Mutex::new(FrameTree::default()));
    for (topic, stays) in [(recorder::TF_STATIC, true), (recorder::TF, false)] {
        // When the scanner's place is known, no more transforms are kept.
        let (frames, reader) = (Arc::downgrade(&frames), FrameReader::new());
        node.listen(topic, <TFMessage as Message>::TYPE, stays, move |message| {
            let Some(frames) = frames.upgrade() else { return };
            let mut frames = frames.lock().unwrap_or_else(PoisonError::into_inner);
            // What cannot be read is not the transform of this scanner.
            let _ = message.and_then(|body| reader.add(&body, &mut frames));
        })?;
    }
    let frame = scans.wait(FIRST, stop, |scan| Some(scan.content.frame))?;
    let until = Instant::now() + TRANSFORMS;
    loop {
        if stop() {
            return Err(RobotError::Stopped);
        }
        let found = frames.lock().unwrap_or_else(PoisonError::into_inner).scanner_mount(&frame);
        let no_mount = |cause: String| RobotError::NoMount { frame: frame.clone(), cause };
        match found {
            Ok(Some(mount)) => return Ok((frame, mount)),
            Err(cause) => return Err(no_mount(cause)),
            Ok(None) if Instant::now() > until => {
                let cause = format!(
                    "no transform of {} or {} leads from it to base_link, base_footprint or base; \
                     publish one with static_transform_publisher",
                    recorder::TF_STATIC,
                    recorder::TF
                );
                return Err(no_mount(cause));
            }
            Ok(None) => sleep(Duration::from_millis(20)),
        }
    }
}

/// The topics of a simulated robot. `/clock` has its time.
pub struct DomainTopics {
    commands: Subscription<WheelSpeeds>,
    odometry: Writer,
    frames: Writer,
    images: Writer,
    scans: Writer,
    markers: Writer,
    clock: Writer,
    // The last field: it is dropped after its writers.
    _node: DdsNode,
}

impl DomainTopics {
    /// # Errors
    /// Returns an error if DDS cannot be used.
    pub fn new(
        domain: &RobotDomain,
        topics: &RobotTopics,
        wheels_type: WheelsType,
    ) -> Result<Self, RobotError> {
        let node = DdsNode::new(domain)?;
        let read = move |body: &messages::EncodedBody| wheels_type.read(body);
        Ok(Self {
            commands: node.subscribe(&topics.wheels, wheels_type.type_name(), read)?,
            odometry: node.advertise(&topics.odometry, <OdometryMessage as Message>::TYPE)?,
            frames: node.advertise(recorder::TF, <TFMessage as Message>::TYPE)?,
            images: node
                .advertise(&topics.images, <CompressedImage<FileBytes> as Message>::TYPE)?,
            scans: node.advertise(&topics.scans, <LaserScanMessage<&[f32]> as Message>::TYPE)?,
            markers: node.advertise(&topics.marker, <PoseStamped as Message>::TYPE)?,
            clock: node.advertise(CLOCK, <ClockMessage as Message>::TYPE)?,
            _node: node,
        })
    }
}

impl ServedRobot for DomainTopics {
    fn command(&self) -> Option<WheelSpeeds> {
        self.commands.take()
    }

    fn odometry(&self, _: u32, reckoning: &Reckoning) -> Result<(), RobotError> {
        self.clock.publish(messages::clock(reckoning.stamp))?;
        self.odometry.publish(messages::odometry(reckoning))?;
        self.frames.publish(messages::frames(reckoning))
    }

    fn image(&self, _: u32, stamp: Nanoseconds, file: &[u8]) -> Result<(), RobotError> {
        self.images.publish(messages::image(stamp, file))
    }

    fn scan(&self, _: u32, stamp: Nanoseconds, scan: &Scan) -> Result<(), RobotError> {
        self.scans.publish(messages::scan(stamp, scan))
    }

    fn marker(&self, _: u32, stamp: Nanoseconds, seen: &MarkerView) -> Result<(), RobotError> {
        self.markers.publish(messages::marker(stamp, seen))
    }
}
