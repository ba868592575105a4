//! A run is written as it goes: what the robot sees, does and perceives, and what Algorithm 1 makes of
//! it. Sections 5 and 6.

use std::{cell::RefCell, collections::BTreeMap, io::Write, rc::Rc};

use image::codecs::jpeg::JpegEncoder;
use toposlam_model::{
    driving::{
        algorithm2::{Standing, Step},
        scene,
    },
    mapping::{self, Journey, MappingError, MappingEvent},
    percept::Door,
};
use toposlam_vision::{annotate, camera::Camera, image_file::ImageFile};

use super::{
    encode,
    message::Message,
    messages::{self, End, ProjectMessage, Stamp},
    standard::{CompressedImage, Odometry, TFMessage, Twist},
    writer::{LogWriteError, LogWriter},
};
use crate::{
    explorer::{ExplorerError, Observer, Round},
    robot::{Reckoned, Robot, Sample},
    simulator::ToldScene,
};

/// The topic of the pictures that were used, as the camera gave them.
pub const IMAGE: &str = "/camera/image/compressed";
/// The topic of the same with the scene drawn over them.
pub const ANNOTATED: &str = "/camera/annotated/compressed";
/// The topic of what the wheels were told.
pub const CMD_VEL: &str = "/cmd_vel";
/// The topic of where the robot is by its wheels.
pub const ODOM: &str = "/odom";
/// The topic of the same as a frame in another.
pub const TF: &str = "/tf";
/// The name of the note that holds what the message [`Run`](messages::Run) does.
pub const NOTE: &str = "toposlam";

/// The quality of annotated pictures.
const QUALITY: u8 = 85;

/// What a camera gives, as a log can hold it.
pub trait Photograph {
    /// The file of the photograph; `None` where it is none.
    fn file(&self) -> Option<&[u8]>;
}

impl Photograph for Vec<u8> {
    fn file(&self) -> Option<&[u8]> {
        Some(self)
    }
}

impl Photograph for ToldScene {
    fn file(&self) -> Option<&[u8]> {
        None
    }
}

/// Writes a run. It watches the robot and the mapping; its clones write the same log.
///
/// An error ends the run, and is told at [`Recorder::end`]. Times are the robot's, and never go back:
/// a message is written at the time when it came about, and its stamp is when that was so of which it
/// tells (a picture's, when it was taken).
pub struct Recorder<W: Write>(Rc<RefCell<Log<W>>>);

impl<W: Write> Clone for Recorder<W> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<W: Write> Recorder<W> {
    /// Begins a log with its head; pictures are annotated where their camera is known.
    ///
    /// # Errors
    /// Where the file does not take it.
    pub fn new(out: W, run: &messages::Run, camera: Option<Camera>) -> Result<Self, LogWriteError> {
        let mut out = LogWriter::new(out)?;
        out.note(NOTE, entries(run))?;
        out.write(messages::Run::TOPIC, 0, run)?;
        out.flush()?;
        let told = Sample { speed: 0.0, turning: 0.0, reckoned: Reckoned::default() };
        let log = Log { out: Some(out), error: None, camera, now: 0, moves: 0, samples: 0, told };
        Ok(Self(Rc::new(RefCell::new(log))))
    }

    /// Whether the log cannot be written.
    #[must_use]
    pub fn failed(&self) -> bool {
        self.0.borrow().error.is_some()
    }

    /// Ends the log, after so many moves; an error is why the run ended before the map was complete.
    /// Afterwards nothing is written any more.
    ///
    /// # Errors
    /// Where the log could not be written, now or before.
    pub fn end<R: Robot>(
        &self,
        robot: &R,
        moves: u64,
        error: Option<&MappingError<ExplorerError>>,
    ) -> Result<(), LogWriteError> {
        let mut log = self.0.borrow_mut();
        log.catch_up(robot);
        let (ending, cause) = match error {
            None => ("mapped", String::new()),
            Some(MappingError::World(ExplorerError::Stopped { .. })) => ("stopped", String::new()),
            Some(error) => ("gave-up", error.to_string()),
        };
        let (stamp, ending) = (log.stamp(), ending.to_owned());
        log.tell(&End { stamp, moves: encode::count(moves), ending, cause });
        match (log.error.take(), log.out.take()) {
            (Some(error), _) => Err(error),
            (None, Some(out)) => out.finish().map(|_| ()),
            (None, None) => Ok(()),
        }
    }
}

impl<W: Write, R: Robot<View: Photograph>> Observer<R> for Recorder<W> {
    fn round(&mut self, robot: &R, round: &Round<R::View>) {
        let mut log = self.0.borrow_mut();
        log.catch_up(robot);
        let taken = Stamp::of(encode::nanoseconds(round.picture.taken));
        if let Some(file) = round.picture.view.file() {
            log.say(IMAGE, &CompressedImage::new(taken, file));
            if let Some(annotated) = log.annotated(file, round.scene) {
                log.say(ANNOTATED, &CompressedImage::new(taken, &annotated));
            }
        }
        log.tell(&encode::scene(taken, round.scene));
        if let Ok(Step::Go(command)) = round.step {
            let stamp = log.stamp();
            log.tell(&encode::command(stamp, round.state, *command));
        }
    }

    fn leaving(&mut self, robot: &R, door: Door) {
        let mut log = self.0.borrow_mut();
        log.catch_up(robot);
        log.moves += 1;
        let (stamp, moves) = (log.stamp(), encode::count(log.moves));
        log.tell(&messages::Door { stamp, r#move: moves, door: door.0 });
    }

    fn arrived(&mut self, robot: &R, _: Option<Door>, at: &Standing) {
        let mut log = self.0.borrow_mut();
        log.catch_up(robot);
        let percept = encode::percept(log.stamp(), log.moves, at);
        log.tell(&percept);
    }

    fn stop(&self) -> bool {
        self.failed()
    }
}

impl<W: Write, X: ?Sized> mapping::Observer<X> for Recorder<W> {
    fn event(&mut self, _: &mut X, journey: &Journey, event: MappingEvent) {
        let mut log = self.0.borrow_mut();
        let stamp = log.stamp();
        if let Some(step) = encode::hypothesis(stamp, journey, event) {
            log.tell(&step);
        }
        if let Some(map) = encode::map(stamp, journey, event) {
            log.tell(&map);
        }
    }
}

/// What the clones share.
struct Log<W: Write> {
    /// Gone when the log has ended.
    out: Option<LogWriter<W>>,
    /// The first.
    error: Option<LogWriteError>,
    camera: Option<Camera>,
    /// The robot's time, in nanoseconds.
    now: u64,
    /// How many moves were begun.
    moves: u64,
    /// So much of the robot's track is written,
    samples: usize,
    /// up to here.
    told: Sample,
}

impl<W: Write> Log<W> {
    /// Writes a message now.
    fn say<M: Message>(&mut self, topic: &str, message: &M) {
        if let (None, Some(out)) = (&self.error, &mut self.out) {
            self.error = out.write(topic, self.now, message).err();
        }
    }

    /// Writes a message of the project now.
    fn tell<M: ProjectMessage>(&mut self, message: &M) {
        self.say(M::TOPIC, message);
    }

    fn stamp(&self) -> Stamp {
        Stamp::of(self.now)
    }

    /// It is as late as this.
    fn at(&mut self, seconds: f64) {
        self.now = self.now.max(encode::nanoseconds(seconds));
    }

    /// Writes what the wheels did since something was last written.
    fn catch_up<R: Robot>(&mut self, robot: &R) {
        let track = robot.track();
        for sample in track.get(self.samples..).unwrap_or_default() {
            self.sample(sample);
        }
        self.samples = track.len();
        self.at(robot.odometry().time);
    }

    /// What the wheels were told is written at the time of the sample before, when they were told so; a
    /// robot that stands is not told again to stand.
    fn sample(&mut self, sample: &Sample) {
        let twist = Twist::new(sample.speed, sample.turning);
        self.at(self.told.reckoned.time);
        if twist != Twist::default() || Twist::new(self.told.speed, self.told.turning) != twist {
            self.say(CMD_VEL, &twist);
        }
        self.at(sample.reckoned.time);
        let stamp = Stamp::of(encode::nanoseconds(sample.reckoned.time));
        let odometry = Odometry::new(stamp, &sample.reckoned.odometry, twist);
        self.say(ODOM, &odometry);
        self.say(TF, &TFMessage { transforms: &[odometry.transform()] });
        self.told = *sample;
    }

    /// A picture with its scene drawn over it, as a JPEG file.
    fn annotated(&self, file: &[u8], scene: &scene::Scene) -> Option<Vec<u8>> {
        let image = ImageFile::open(file).ok()?.image().ok()?;
        let drawn = annotate::over(&image, self.camera.as_ref()?, scene);
        let mut bytes = Vec::new();
        drawn.write_with_encoder(JpegEncoder::new_with_quality(&mut bytes, QUALITY)).ok()?;
        Some(bytes)
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
    ];
    entries.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
}

#[cfg(test)]
mod tests {
    use std::io;

    use mcap::MessageStream;

    use super::*;
    use crate::{
        evaluation::{plans, run_sampler::starts_of},
        explorer::Told,
        log::shared_buffer::SharedBuffer,
        run::{Run, run},
        simulator::{FaultKind, RobotFault, SimulationConfig},
    };

    /// A run on shape 6, where something may go wrong, and its log.
    fn logged(fault: Option<RobotFault>, judge: impl Fn(&Run)) -> Vec<u8> {
        let (_, plan) = plans().unwrap().into_iter().find(|(name, _)| name == "shape-6").unwrap();
        let facing = starts_of(&plan)[0];
        let mut setting = SimulationConfig::at_start(plan.clone(), facing, 5);
        (setting.keeps_track, setting.faults) = (true, fault.into_iter().collect());
        let file = SharedBuffer::default();
        let head = messages::Run { world: "shape-6".to_owned(), ..messages::Run::default() };
        let recorder = Recorder::new(file.clone(), &head, None).unwrap();
        let (run, robot, _) = run(
            &plan,
            facing,
            setting.by_scene(),
            Told,
            recorder.clone(),
            &mut recorder.clone(),
            200,
        );
        recorder.end(&robot, run.exploration.moves(), run.error.as_ref()).unwrap();
        judge(&run);
        file.0.borrow().clone()
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
    fn a_run_is_told_from_its_head_to_its_end_in_the_order_of_time() {
        let pictures = std::cell::Cell::new(0);
        let told = messages(&logged(None, |run| {
            assert_eq!((run.exploration.moves(), run.explore_moves), (8, 8));
            pictures.set(run.pictures as usize);
        }));
        let count = |topic: &str| told.iter().filter(|(found, ..)| found == topic).count();
        assert_eq!((&*told[0].0, &*told[told.len() - 1].0), ("/toposlam/run", "/toposlam/end"));
        assert!(told.is_sorted_by_key(|(_, time, _)| *time));
        assert_eq!((count("/toposlam/door"), count("/toposlam/percept")), (8, 9));
        // The start, and six edges.
        assert_eq!(count("/toposlam/map"), 7);
        assert_eq!((count(IMAGE), count(ANNOTATED)), (0, 0));
        assert_eq!(count("/toposlam/scene"), pictures.get());
        // All but the last picture of each way are answered with a command.
        assert_eq!(count("/toposlam/scene"), count("/toposlam/command") + 9);
        assert_eq!(count(ODOM), count(TF));
    }

    #[test]
    fn each_motion_ends_with_a_stop_and_the_robot_stands_where_a_picture_is_taken() {
        let told = messages(&logged(None, |_| {}));
        // The body of a twist: x ahead first, the turn about z last.
        let mut standing = true;
        let mut stops = 0;
        for (topic, _, body) in &told {
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
    fn a_run_that_is_given_up_says_so_at_its_end() {
        let blocked = RobotFault::at(FaultKind::Blocked, 20);
        let told = messages(&logged(Some(blocked), |run| assert!(run.error.is_some())));
        let (topic, _, body) = &told[told.len() - 1];
        let text = String::from_utf8_lossy(body);
        assert!(topic == "/toposlam/end" && text.contains("gave-up\0"), "{text}");
        assert!(text.contains("3 commands in a row were not carried out"), "{text}");
    }

    #[test]
    fn a_full_disk_ends_the_run() {
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
        let recorder = Recorder::new(Full, &messages::Run::default(), None).unwrap();
        let (run, robot, _) =
            run(&plan, facing, setting.by_scene(), Told, recorder.clone(), &mut (), 200);
        assert!(recorder.failed());
        let stopped = Some(MappingError::World(ExplorerError::Stopped { moves: 1 }));
        assert_eq!(run.error, stopped);
        assert!(recorder.end(&robot, 1, run.error.as_ref()).is_err());
    }
}
