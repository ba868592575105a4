//! What is kept of a simulated run for its page and its picture: frames, arrivals, maps and the story.

use std::{io::Write, path::PathBuf, sync::Arc};

use image::{codecs::jpeg::JpegEncoder, imageops::FilterType};
use toposlam_logs::record::{Event, EventKind, Frame, RunObserver};
use toposlam_model::{
    driving::{
        algorithm2::{Command, PathState},
        pose::Pose,
    },
    embedded_graph::Dart,
    enumerate::Watch,
    floor_plan::FloorPlan,
    mapping::{MapWalk, MappingEvent, PartialMap},
    percept::Door,
};
use toposlam_simulator::run::Run;
use toposlam_vision::{annotate, camera::Camera};

use super::CliError;
use crate::{
    cli::{picture_file, progress::Progress, scene::in_words},
    run_page_data::{PageArrival, PageFrame, RunPageData},
    story::{PrintedStory, StoryLine},
};

/// Observes a simulated run, and keeps what its page and its picture show.
pub(super) struct RunCapture<'o> {
    story: PrintedStory<&'o mut dyn Write>,
    progress: Progress,
    images: KeptImages,
    rounds: Vec<PageFrame>,
    /// The number of frames before each arrival, and the door taken before it.
    arrivals: Vec<(usize, Option<Door>)>,
    /// The latest door.
    door: Option<Door>,
    maps: Vec<PartialMap>,
    /// The lines of the story.
    lines: Vec<String>,
    moves: u64,
    /// The error of the first image that could not be written.
    failure: Option<CliError>,
}

/// Which annotated images are kept.
pub(super) enum KeptImages {
    /// None.
    None,
    /// Small ones.
    Small { camera: Camera },
    /// Small ones, and large ones in a folder.
    Files { camera: Camera, folder: PathBuf },
}

/// The width of small images, in pixels.
const SMALL: u32 = 400;
/// The JPEG quality of small images.
const QUALITY: u8 = 60;

impl<'o> RunCapture<'o> {
    pub(super) fn new(
        mut story: PrintedStory<&'o mut dyn Write>,
        progress: Progress,
        images: KeptImages,
    ) -> Self {
        let lines = story.print().iter().map(StoryLine::to_string).collect();
        Self {
            story,
            progress,
            images,
            rounds: Vec::new(),
            arrivals: Vec::new(),
            door: None,
            maps: Vec::new(),
            lines,
            moves: 0,
            failure: None,
        }
    }

    /// What was kept. The ending is still empty.
    ///
    /// # Errors
    /// Returns an error if the story or an image could not be written.
    pub(super) fn finish(
        self,
        name: &str,
        plan: &Arc<FloorPlan>,
        facing: Dart,
        run: &Run,
    ) -> Result<RunPageData, CliError> {
        self.progress.finish();
        self.story.finish()?;
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        let calls = self.arrivals.into_iter().zip(run.monitor.arrivals());
        let calls = calls.map(|((rounds, door), arrival)| PageArrival {
            rounds,
            pose: arrival.pose,
            door,
            percept: arrival.perceived,
            conforms: arrival.conforms(),
        });
        Ok(RunPageData {
            name: name.to_owned(),
            plan: plan.clone(),
            facing,
            rounds: self.rounds,
            calls: calls.collect(),
            story: self.lines,
            maps: self.maps,
            ending: String::new(),
        })
    }

    fn frame(&mut self, frame: &Frame, pose: Pose) {
        self.progress.part_done(1);
        let round = PageFrame {
            time: frame.taken,
            pose,
            moves: self.moves,
            state: PathState::Unknown,
            scene: frame.scene.as_ref().map(in_words).unwrap_or_default(),
            command: None,
            image: self.annotated(frame),
            story: self.lines.len(),
            maps: self.maps.len(),
        };
        self.rounds.push(round);
    }

    /// A small annotated image. A large one is written first if there is a folder for it.
    fn annotated(&mut self, frame: &Frame) -> Option<Vec<u8>> {
        let (camera, folder) = match &self.images {
            KeptImages::None => return None,
            KeptImages::Small { camera } => (camera, None),
            KeptImages::Files { camera, folder } => (camera, Some(folder)),
        };
        let image = frame.image.as_ref()?.pixels().ok()?;
        let image = annotate::over(image, camera, frame.scene.as_ref()?);
        if let (Some(folder), None) = (folder, &self.failure) {
            let file = folder.join(format!("{:05}.jpg", self.rounds.len() + 1));
            self.failure = picture_file::write(&file, &image).err();
        }
        let height = SMALL * image.height() / image.width().max(1);
        let small = image::imageops::resize(&image, SMALL, height, FilterType::Triangle);
        let mut bytes = Vec::new();
        small.write_with_encoder(JpegEncoder::new_with_quality(&mut bytes, QUALITY)).ok()?;
        Some(bytes)
    }
}

impl RunObserver for RunCapture<'_> {
    fn event(&mut self, event: &Event) {
        match &event.kind {
            EventKind::Frame(frame) => {
                if let Some(pose) = event.truth {
                    self.frame(frame, pose);
                }
            }
            EventKind::Command { state, command } => {
                if let Some(last) = self.rounds.last_mut() {
                    (last.state, last.command) = (*state, *command);
                }
            }
            EventKind::LookAround { turn } => {
                if let Some(last) = self.rounds.last_mut() {
                    last.command = Some(Command { turn: *turn, forward: 0.0 });
                }
            }
            EventKind::Door { door, .. } => {
                self.moves += 1;
                self.door = Some(*door);
            }
            EventKind::Arrival(_) => self.arrivals.push((self.rounds.len(), self.door)),
            _ => {}
        }
    }

    fn mapping(&mut self, journey: &MapWalk, event: MappingEvent) {
        let lines = self.story.add(journey, event);
        self.lines.extend(lines.iter().map(StoryLine::to_string));
        if event.grows_map() {
            self.maps.push(journey.map().clone());
        }
    }

    fn stop(&self) -> bool {
        self.failure.is_some() || self.progress.stop()
    }
}
