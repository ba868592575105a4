//! Writes the log of a run as it goes on. Sections 5 and 6.

use std::{collections::BTreeMap, io::Write};

use image::codecs::jpeg::JpegEncoder;
use toposlam_vision::{annotate, camera::Camera};

use super::{
    encode,
    message::Message,
    messages::{self, ProjectMessage, Stamp},
    standard::{CompressedImage, LaserScanMessage, OdometryMessage, TFMessage, Twist},
    writer::{LogWriteError, LogWriter},
};
use crate::record::{Event, EventKind, Frame, RunObserver, nanoseconds};

/// The topic of the images that were used, as the camera gave them.
pub const IMAGE: &str = "/camera/image/compressed";
/// The topic of the same images with the scene drawn over them.
pub const ANNOTATED: &str = "/camera/annotated/compressed";
/// The topic of the scans of the laser scanner.
pub const SCAN: &str = "/scan";
/// The topic on which a live robot's detector reports the marker. A log has the marker in its scenes.
pub const MARKER: &str = "/marker";
/// The topic of the commands of the wheels.
pub const CMD_VEL: &str = "/cmd_vel";
/// The topic of odometry.
pub const ODOM: &str = "/odom";
/// The topic of odometry as a transform.
pub const TF: &str = "/tf";
/// The name of the note with the content of the message [`Run`](messages::Run).
pub const NOTE: &str = "toposlam";

/// The quality of annotated images.
const QUALITY: u8 = 85;

/// Writes the events of a run.
///
/// An error stops the run, and [`Recorder::finish`] returns it. Times are the robot's, and never go back.
/// A message is written at the time of its event; its stamp is the time that it is about, for an image
/// the time when it was taken.
pub struct Recorder<W: Write> {
    out: LogWriter<W>,
    /// The first error.
    error: Option<LogWriteError>,
    camera: Option<Camera>,
    /// The time of the last event, in nanoseconds.
    now: u64,
    /// The last command of the wheels.
    twist: Twist,
}

impl<W: Write> Recorder<W> {
    /// Begins a log with its head. Images are also written annotated if their camera is known.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    pub fn new(out: W, run: &messages::Run, camera: Option<Camera>) -> Result<Self, LogWriteError> {
        let mut out = LogWriter::new(out)?;
        out.note(NOTE, &entries(run))?;
        out.write(messages::Run::TOPIC, 0, run)?;
        out.flush()?;
        Ok(Self { out, error: None, camera, now: 0, twist: Twist::default() })
    }

    /// Closes the log.
    ///
    /// # Errors
    /// Returns an error if the log could not be written, now or before.
    pub fn finish(self) -> Result<(), LogWriteError> {
        match self.error {
            Some(error) => Err(error),
            None => self.out.finish().map(|_| ()),
        }
    }

    /// Writes a message now.
    fn write<M: Message>(&mut self, topic: &str, message: &M) {
        if self.error.is_none() {
            self.error = self.out.write(topic, self.now, message).err();
        }
    }

    /// Writes a message of the project now.
    fn write_own<M: ProjectMessage>(&mut self, message: &M) {
        self.write(M::TOPIC, message);
    }

    fn frame(&mut self, frame: &Frame) {
        let taken = Stamp::of(nanoseconds(frame.taken));
        if let Some(file) = frame.image.as_ref().and_then(|image| image.file()) {
            self.write(IMAGE, &CompressedImage::new(taken, file));
            if let Some(annotated) = self.annotated(frame) {
                self.write(ANNOTATED, &CompressedImage::new(taken, &annotated));
            }
        }
        if let Some(scan) = &frame.scan {
            self.write(SCAN, &LaserScanMessage::new(taken, scan));
        }
        if let Some(scene) = &frame.scene {
            self.write_own(&encode::scene(taken, scene));
        }
    }

    /// The image with the scene drawn over it, as a JPEG file.
    fn annotated(&self, frame: &Frame) -> Option<Vec<u8>> {
        let image = frame.image.as_ref()?.pixels().ok()?;
        let drawn = annotate::over(image, self.camera.as_ref()?, frame.scene.as_ref()?);
        let mut bytes = Vec::new();
        drawn.write_with_encoder(JpegEncoder::new_with_quality(&mut bytes, QUALITY)).ok()?;
        Some(bytes)
    }
}

impl<W: Write> RunObserver for Recorder<W> {
    fn event(&mut self, event: &Event) {
        self.now = self.now.max(event.time);
        let stamp = Stamp::of(self.now);
        match &event.kind {
            EventKind::Frame(frame) => self.frame(frame),
            EventKind::Command { state, command } => {
                if let Some(command) = command {
                    self.write_own(&encode::command(stamp, *state, *command));
                }
            }
            EventKind::LookAround { .. } => {}
            EventKind::Door { number, door } => {
                self.write_own(&encode::door(stamp, *number, *door));
            }
            EventKind::Arrival(arrival) => self.write_own(&encode::arrival(stamp, arrival)),
            EventKind::Hypothesis { moves, event } => {
                if let Some(step) = encode::hypothesis(stamp, *moves, *event) {
                    self.write_own(&step);
                }
            }
            EventKind::Map(map) => self.write_own(&encode::map(stamp, map)),
            EventKind::Motion { forward, turn } => {
                let twist = Twist::new(*forward, *turn);
                // A robot that stands is not commanded again to stand.
                if twist != Twist::default() || self.twist != twist {
                    self.write(CMD_VEL, &twist);
                }
                self.twist = twist;
            }
            EventKind::Odometry(odometry) => {
                let stamp = Stamp::of(event.time);
                let odometry = OdometryMessage::new(stamp, odometry, self.twist);
                self.write(ODOM, &odometry);
                self.write(TF, &TFMessage { transforms: &[odometry.transform()] });
            }
            EventKind::End(end) => self.write_own(&encode::end(stamp, end)),
        }
    }

    fn stop(&self) -> bool {
        self.error.is_some()
    }
}

/// The head of a log, as a note.
fn entries(run: &messages::Run) -> BTreeMap<String, String> {
    let entries = [
        ("version", run.version.clone()),
        ("world", run.world.clone()),
        ("world_hash", run.world_hash.clone()),
        ("start", run.start.clone()),
        ("marker", run.marker.clone()),
        ("seed", run.seed.to_string()),
        ("calibration", run.calibration.clone()),
        ("colours", run.colours.clone()),
        ("command", run.command.clone()),
        ("algorithm", run.algorithm.clone()),
    ];
    entries.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
}

#[cfg(test)]
mod tests {
    use std::io;

    use image::{ImageFormat, RgbImage};
    use mcap::MessageStream;
    use toposlam_model::{
        driving::scene::Scene,
        mapping::{DirectionalAlgorithm, MappingError, MappingMethod},
    };

    use super::*;
    use crate::{
        evaluation::{plans, run_sampler::starts_of},
        explorer::{ExplorerError, RobotExplorer},
        record::{CameraImage, DECODED, FrameSensor, NoSensor, SensingError},
        robot::{Robot, RobotError, TimedOdometry},
        run::{Run, run},
        run_settings::RunSettings,
        simulator::{FaultKind, RobotFault, SimulatedRobot, SimulationConfig},
    };

    /// A run on shape 6, perhaps with a fault, and its log.
    fn logged(fault: Option<RobotFault>, check: impl Fn(&Run)) -> Vec<u8> {
        let (_, plan) = plans().unwrap().into_iter().find(|(name, _)| name == "shape-6").unwrap();
        let facing = starts_of(&plan)[0];
        let mut setting = SimulationConfig::at_start(plan.clone(), facing, 5);
        (setting.keeps_track, setting.faults) = (true, fault.into_iter().collect());
        let mut log = Vec::new();
        let head = messages::Run { world: "shape-6".to_owned(), ..messages::Run::default() };
        let mut recorder = Recorder::new(&mut log, &head, None).unwrap();
        let (robot, algorithm) = (setting.by_scene(), DirectionalAlgorithm::Algorithm1);
        check(&run(
            &plan,
            facing,
            robot,
            NoSensor,
            &mut recorder,
            &RunSettings::new(algorithm, 200),
        ));
        recorder.finish().unwrap();
        log
    }

    /// Topic, time and body of each message.
    fn messages(log: &[u8]) -> Vec<(String, u64, Vec<u8>)> {
        let messages = MessageStream::new(log).unwrap().map(Result::unwrap);
        messages.map(|m| (m.channel.topic.clone(), m.log_time, m.data.to_vec())).collect()
    }

    fn number(body: &[u8], at: usize) -> f64 {
        f64::from_le_bytes(body[4 + at..12 + at].try_into().unwrap())
    }

    #[test]
    fn a_log_has_the_run_from_head_to_end_in_the_order_of_time() {
        let images = std::cell::Cell::new(0);
        let log = messages(&logged(None, |run| {
            assert_eq!((run.mapping.moves(), run.explore_moves), (8, 8));
            images.set(run.frames as usize);
        }));
        let count = |topic: &str| log.iter().filter(|(found, ..)| found == topic).count();
        assert_eq!((&*log[0].0, &*log[log.len() - 1].0), ("/toposlam/run", "/toposlam/end"));
        assert!(log.is_sorted_by_key(|(_, time, _)| *time));
        assert_eq!((count("/toposlam/door"), count("/toposlam/percept")), (8, 9));
        // The start, and six edges.
        assert_eq!(count("/toposlam/map"), 7);
        assert_eq!((count(IMAGE), count(ANNOTATED)), (0, 0));
        assert_eq!(count("/toposlam/scene"), images.get());
        // All but the last image of each way are answered with a command.
        assert_eq!(count("/toposlam/scene"), count("/toposlam/command") + 9);
        assert_eq!(count(ODOM), count(TF));
    }

    #[test]
    fn each_motion_ends_with_a_stop_and_the_robot_stands_where_a_image_is_taken() {
        let log = messages(&logged(None, |_| {}));
        // The body of a twist: x ahead first, the turn about z last.
        let mut standing = true;
        let mut stops = 0;
        for (topic, _, body) in &log {
            match topic.as_str() {
                CMD_VEL => {
                    let stop = number(body, 0) == 0.0 && number(body, 40) == 0.0;
                    assert!(!(stop && standing), "it stood already");
                    stops += u32::from(stop);
                    standing = stop;
                }
                "/toposlam/scene" | "/toposlam/end" => assert!(standing),
                _ => {}
            }
        }
        assert!(stops > 60, "{stops}");
    }

    #[test]
    fn the_end_of_a_log_has_the_reason_why_the_robot_gave_up() {
        let blocked = RobotFault::at(FaultKind::Blocked, 20);
        let log = messages(&logged(Some(blocked), |run| assert!(run.error.is_some())));
        let (topic, _, body) = &log[log.len() - 1];
        let text = String::from_utf8_lossy(body);
        assert!(topic == "/toposlam/end" && text.contains("gave-up\0"), "{text}");
        assert!(text.contains("3 commands in a row were not carried out"), "{text}");
    }

    /// A simulated robot without a camera image, to which the test adds one.
    struct WithImages(SimulatedRobot);

    impl Robot for WithImages {
        fn capture(&mut self) -> Result<Frame, RobotError> {
            let frame = self.0.capture()?;
            let mut file = io::Cursor::new(Vec::new());
            let colour = image::Rgb([frame.id as u8; 3]);
            RgbImage::from_pixel(64, 48, colour).write_to(&mut file, ImageFormat::Png).unwrap();
            Ok(Frame { image: Some(CameraImage::encoded(file.into_inner())), ..frame })
        }

        fn turn(&mut self, angle: f64) -> Result<(), RobotError> {
            self.0.turn(angle)
        }

        fn forward(&mut self, distance: f64) -> Result<(), RobotError> {
            self.0.forward(distance)
        }

        fn odometry(&self) -> TimedOdometry {
            self.0.odometry()
        }
    }

    /// Needs the pixels of each frame, as sensing and the page of a run do.
    #[derive(Default)]
    struct Pixels(u64);

    impl FrameSensor for Pixels {
        fn scene(&mut self, frame: &Frame) -> Result<Scene, SensingError> {
            frame.image.as_ref().unwrap().pixels()?;
            NoSensor.scene(frame)
        }
    }

    impl RunObserver for Pixels {
        fn event(&mut self, event: &Event) {
            if let EventKind::Frame(frame) = &event.kind {
                frame.image.as_ref().unwrap().pixels().unwrap();
                self.0 += 1;
            }
        }
    }

    #[test]
    fn a_frame_is_decoded_once_for_sensing_the_log_and_the_page() {
        let (_, plan) = plans().unwrap().into_iter().find(|(name, _)| name == "shape-6").unwrap();
        let facing = starts_of(&plan)[0];
        let robot = WithImages(SimulationConfig::at_start(plan, facing, 5).by_scene());
        let camera = Some(Camera::superscout().sized([64, 48]));
        let mut log = Vec::new();
        let mut recorder = Recorder::new(&mut log, &messages::Run::default(), camera).unwrap();
        let mut page = Pixels::default();
        let decoded = DECODED.get();
        let mut explorer = RobotExplorer::new(robot, Pixels::default(), (&mut recorder, &mut page));
        let (_, mapped) = explorer.map(&RunSettings::new(MappingMethod::default(), 200));
        mapped.unwrap();
        assert!(page.0 > 60, "{}", page.0);
        assert_eq!(DECODED.get() - decoded, page.0);
        recorder.finish().unwrap();
        let annotated = messages(&log).iter().filter(|(topic, ..)| topic == ANNOTATED).count();
        assert_eq!(annotated as u64, page.0);
    }

    #[test]
    fn a_full_disk_stops_the_run() {
        struct Full;
        impl Write for Full {
            fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
                // The head of a log is small.
                if bytes.len() > 2000 {
                    Err(io::ErrorKind::StorageFull.into())
                } else {
                    Ok(bytes.len())
                }
            }

            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let (_, plan) = plans().unwrap().swap_remove(2);
        let facing = starts_of(&plan)[0];
        let mut setting = SimulationConfig::at_start(plan.clone(), facing, 5);
        setting.keeps_track = true;
        let mut recorder = Recorder::new(Full, &messages::Run::default(), None).unwrap();
        let (robot, algorithm) = (setting.by_scene(), DirectionalAlgorithm::Algorithm1);
        let run =
            run(&plan, facing, robot, NoSensor, &mut recorder, &RunSettings::new(algorithm, 200));
        assert!(recorder.stop());
        let stopped = Some(MappingError::World(ExplorerError::Stopped { moves: 1 }));
        assert_eq!(run.error, stopped);
        assert!(recorder.finish().is_err());
    }
}
