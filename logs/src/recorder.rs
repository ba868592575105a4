//! Writes the log of a run as it goes on. Sections 5 and 6.

use std::{collections::BTreeMap, io::Write};

use image::codecs::jpeg::JpegEncoder;
use serde_json::Value;
use toposlam_vision::{annotate, camera::Camera};

use super::{
    encode,
    message::Message,
    messages::{self, ProjectMessage, Stamp},
    standard::{
        CompressedImage, LaserScanMessage, OdometryMessage, TFMessage, TransformStamped, Twist,
    },
    writer::{LogWriteError, LogWriter},
};
use crate::record::{Event, EventKind, Frame, RunObserver, nanoseconds};

/// The topic of the images that were used, as the camera gave them.
pub const IMAGE: &str = "/camera/image/compressed";
/// The topic of the same images with the scene drawn over them.
pub const ANNOTATED: &str = "/camera/annotated/compressed";
pub const SCAN: &str = "/scan";
/// The topic on which a live robot's detector reports the marker. A log has the marker in its scenes.
pub const MARKER: &str = "/marker";
pub const CMD_VEL: &str = "/cmd_vel";
pub const ODOM: &str = "/odom";
pub const TF: &str = "/tf";
pub const TF_STATIC: &str = "/tf_static";
/// The name of the note with the content of the message [`Run`](messages::Run).
pub const NOTE: &str = "toposlam";

const QUALITY: u8 = 85;

/// Writes the events of a run.
///
/// An error stops the run, and [`Recorder::finish`] returns it. Times are the robot's, and never go back.
/// A message is written at the time of its event; its stamp is the time that it is about, for an image
/// the time when it was taken.
pub struct Recorder<W: Write> {
    out: LogWriter<W>,
    error: Option<LogWriteError>,
    camera: Option<Camera>,
    /// The time of the last event, in nanoseconds.
    now: u64,
    twist: Twist,
    /// Whether the frame of a scanner that is not in the robot's centre is in the log.
    has_scanner_frame: bool,
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
        let (now, twist) = (0, Twist::default());
        Ok(Self { out, error: None, camera, now, twist, has_scanner_frame: false })
    }

    /// Closes the log, and returns what it was written to.
    ///
    /// # Errors
    /// Returns an error if the log could not be written, now or before.
    pub fn finish(self) -> Result<W, LogWriteError> {
        match self.error {
            Some(error) => Err(error),
            None => self.out.finish(),
        }
    }

    fn write<M: Message>(&mut self, topic: &str, message: &M) {
        if self.error.is_none() {
            self.error = self.out.write(topic, self.now, message).err();
        }
    }

    fn write_own<M: ProjectMessage>(&mut self, message: &M) {
        self.write(M::TOPIC, message);
    }

    fn frame(&mut self, frame: &Frame) {
        let taken = Stamp::from_nanoseconds(nanoseconds(frame.taken));
        if let Some(file) = frame.image.as_ref().and_then(|image| image.file()) {
            self.write(IMAGE, &CompressedImage::new(taken, file));
            if let Some(annotated) = self.annotated(frame) {
                self.write(ANNOTATED, &CompressedImage::new(taken, &annotated));
            }
        }
        if let Some(scan) = &frame.scan {
            if let Some(mount) = TransformStamped::of_scanner(taken, scan)
                && !std::mem::replace(&mut self.has_scanner_frame, true)
            {
                self.write(TF_STATIC, &TFMessage { transforms: &[mount] });
            }
            self.write(SCAN, &LaserScanMessage::new(taken, scan));
        }
        if let Some(scene) = &frame.scene {
            self.write_own(&encode::scene(taken, scene));
        }
    }

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
        let stamp = Stamp::from_nanoseconds(self.now);
        match &event.kind {
            EventKind::Frame(frame) => self.frame(frame),
            EventKind::Command { state, command } => {
                if let Some(command) = command {
                    self.write_own(&encode::command(stamp, *state, *command));
                }
            }
            EventKind::Door { number, door } => {
                self.write_own(&encode::door(stamp, *number, *door));
            }
            EventKind::Action { number, action } => {
                self.write_own(&encode::action(stamp, *number, *action));
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
                let stamp = Stamp::from_nanoseconds(event.time);
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

/// The fields of a head as texts, without its stamp.
fn entries(run: &messages::Run) -> BTreeMap<String, String> {
    let Ok(Value::Object(fields)) = serde_json::to_value(run) else { return BTreeMap::new() };
    let fields = fields.into_iter().filter(|(name, _)| name != "stamp");
    let entry = |(name, value): (String, Value)| match value {
        Value::String(text) => (name, text),
        number => (name, number.to_string()),
    };
    fields.map(entry).collect()
}
