//! What is kept of a simulated run while it goes on: pictures, calls, maps, the story; and the
//! recording on which it is computed again.

use std::{
    cell::RefCell,
    io::{self, Write},
    path::PathBuf,
    rc::Rc,
    sync::Arc,
};

use image::{RgbImage, codecs::jpeg::JpegEncoder, imageops::FilterType};
use toposlam::journal::{Call, Journal, Round};
use toposlam_model::{
    driving::{
        algorithm2::{Standing, Step},
        scene::Scene,
    },
    embedded_graph::Dart,
    enumerate::Watch,
    floor_plan::FloorPlan,
    mapping::{self, Journey, MappingEvent, PartialMap},
    percept::Door,
};
use toposlam_robot::{
    explorer::{self, Observer},
    log::recorder::Photograph,
    pose::Pose,
    recording::Recording,
    run::Run,
    simulator::{SimulatedCamera, SimulatedRobot, ToldScene},
};
use toposlam_vision::{annotate, camera, image_file::ImageFile};

use super::{Failure, Story, log::Recorder};
use crate::cli::{picture_file, progress::Progress, scene::in_words};

/// What is kept.
#[derive(Debug, Default)]
pub(super) struct Chronicle {
    rounds: Vec<Round>,
    /// After how many pictures the robot stood where.
    calls: Vec<(usize, Pose)>,
    /// The story so far; its last line may not be whole.
    story: String,
    maps: Vec<PartialMap>,
}

impl Chronicle {
    pub(super) fn journal(
        self,
        name: &str,
        plan: Arc<FloorPlan>,
        facing: Dart,
        run: &Run,
        ending: String,
    ) -> Journal {
        let arrivals = run.specification.arrivals();
        let calls = self.calls.into_iter().zip(arrivals).map(|((rounds, pose), arrival)| Call {
            rounds,
            pose,
            percept: arrival.perceived,
            conforms: arrival.conforms(),
        });
        Journal {
            name: name.to_owned(),
            plan,
            facing,
            rounds: self.rounds,
            calls: calls.collect(),
            story: self.story.lines().map(str::to_owned).collect(),
            maps: self.maps,
            ending,
        }
    }
}

/// What becomes of the annotated pictures.
pub(super) enum Pictures {
    /// There are none, or nobody wants them.
    None,
    /// Small ones are kept.
    Small { camera: camera::Camera },
    /// They are written to a folder, and small ones are kept.
    Files { camera: camera::Camera, folder: PathBuf },
}

/// Small pictures are so wide, in pixels,
const SMALL: u32 = 400;
/// of this quality.
const QUALITY: u8 = 60;

/// What a camera gives, as a person can look at it.
pub(super) trait Shown: Sized + Clone {
    /// It, with what sensing told drawn over it; `None` where there is no image.
    fn annotated(&self, camera: &camera::Camera, scene: &Scene) -> Option<RgbImage>;
}

impl Shown for Vec<u8> {
    fn annotated(&self, camera: &camera::Camera, scene: &Scene) -> Option<RgbImage> {
        let image = ImageFile::open(self).ok()?.image().ok()?;
        Some(annotate::over(&image, camera, scene))
    }
}

impl Shown for ToldScene {
    fn annotated(&self, _: &camera::Camera, _: &Scene) -> Option<RgbImage> {
        None
    }
}

/// Watches the robot.
pub(super) struct Watching<V> {
    chronicle: Rc<RefCell<Chronicle>>,
    pictures: Pictures,
    progress: Progress,
    recording: Recording<V>,
    log: Option<Recorder>,
    /// The first picture that could not be written.
    failure: Option<Failure>,
}

impl<V> Watching<V> {
    pub(super) fn new(
        chronicle: Rc<RefCell<Chronicle>>,
        pictures: Pictures,
        progress: Progress,
        log: Option<Recorder>,
    ) -> Self {
        let recording = Recording::default();
        Self { chronicle, pictures, progress, recording, log, failure: None }
    }

    /// What was recorded.
    pub(super) fn finish(self) -> Result<Recording<V>, Failure> {
        self.progress.finish();
        self.failure.map_or(Ok(self.recording), Err)
    }
}

impl<V: Shown> Watching<V> {
    /// A small annotated picture, after a large one was written where that is wanted.
    fn picture(&mut self, number: usize, view: &V, scene: &Scene) -> Option<Vec<u8>> {
        let (camera, folder) = match &self.pictures {
            Pictures::None => return None,
            Pictures::Small { camera } => (camera, None),
            Pictures::Files { camera, folder } => (camera, Some(folder)),
        };
        let image = view.annotated(camera, scene)?;
        if let (Some(folder), None) = (folder, &self.failure) {
            let file = folder.join(format!("{number:05}.jpg"));
            self.failure = picture_file::write(&file, &image).err();
        }
        let height = SMALL * image.height() / image.width().max(1);
        let small = image::imageops::resize(&image, SMALL, height, FilterType::Triangle);
        let mut bytes = Vec::new();
        small.write_with_encoder(JpegEncoder::new_with_quality(&mut bytes, QUALITY)).ok()?;
        Some(bytes)
    }
}

impl<C: SimulatedCamera> Observer<SimulatedRobot<C>> for Watching<C::View>
where
    C::View: Shown + Photograph,
{
    fn round(&mut self, robot: &SimulatedRobot<C>, round: &explorer::Round<C::View>) {
        self.recording.round(robot, round);
        self.log.round(robot, round);
        self.progress.part_done(1);
        let number = self.recording.len();
        let picture = self.picture(number, &round.picture.view, round.scene);
        let mut chronicle = self.chronicle.borrow_mut();
        let round = Round {
            time: round.picture.taken,
            pose: robot.pose(),
            moves: round.moves,
            state: round.state,
            scene: in_words(round.scene),
            command: match round.step {
                Ok(Step::Go(command)) => Some(*command),
                Ok(Step::Arrived(_)) | Err(_) => None,
            },
            picture,
            story: chronicle.story.lines().count(),
            maps: chronicle.maps.len(),
        };
        chronicle.rounds.push(round);
    }

    fn leaving(&mut self, robot: &SimulatedRobot<C>, door: Door) {
        self.log.leaving(robot, door);
    }

    fn arrived(&mut self, robot: &SimulatedRobot<C>, door: Option<Door>, at: &Standing) {
        self.log.arrived(robot, door, at);
        let mut chronicle = self.chronicle.borrow_mut();
        let rounds = chronicle.rounds.len();
        chronicle.calls.push((rounds, robot.pose()));
    }

    fn stop(&self) -> bool {
        let failed = self.log.as_ref().is_some_and(Recorder::failed);
        failed || self.failure.is_some() || self.progress.stop()
    }
}

/// Where the story goes: onto the terminal, and into the chronicle.
pub(super) struct Lines<'o> {
    out: Option<&'o mut dyn Write>,
    chronicle: Rc<RefCell<Chronicle>>,
}

impl<'o> Lines<'o> {
    pub(super) fn new(out: Option<&'o mut dyn Write>, chronicle: Rc<RefCell<Chronicle>>) -> Self {
        Self { out, chronicle }
    }
}

impl Write for Lines<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.chronicle.borrow_mut().story += &String::from_utf8_lossy(bytes);
        if let Some(out) = &mut self.out {
            out.write_all(bytes)?;
            // A person follows the run.
            if bytes.ends_with(b"\n") {
                out.flush()?;
            }
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.as_mut().map_or(Ok(()), Write::flush)
    }
}

/// Tells the story of Algorithm 1, logs it, and keeps the map whenever it has grown.
pub(super) struct Telling<'o, 'l> {
    story: Story<'l, Lines<'o>>,
    chronicle: Rc<RefCell<Chronicle>>,
    log: Option<Recorder>,
}

impl<'o, 'l> Telling<'o, 'l> {
    pub(super) fn new(
        story: Story<'l, Lines<'o>>,
        chronicle: Rc<RefCell<Chronicle>>,
        log: Option<Recorder>,
    ) -> Self {
        Self { story, chronicle, log }
    }

    pub(super) fn finish(self) -> io::Result<()> {
        self.story.finish()
    }
}

impl<W: ?Sized> mapping::Observer<W> for Telling<'_, '_> {
    fn event(&mut self, world: &mut W, journey: &Journey, event: MappingEvent) {
        self.story.event(world, journey, event);
        if let Some(log) = &mut self.log {
            log.event(world, journey, event);
        }
        let grown = matches!(
            event,
            MappingEvent::Started { .. }
                | MappingEvent::LoopClosed { .. }
                | MappingEvent::VertexAdded { .. }
        );
        if grown {
            self.chronicle.borrow_mut().maps.push(journey.map().clone());
        }
    }
}
