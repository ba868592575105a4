//! What is kept of a simulated run for its page and its picture: frames, arrivals, maps and the story.

use std::{path::PathBuf, sync::Arc};

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
    mapping::{Journey, MappingEvent, Observer, PartialMap},
    percept::Door,
};
use toposlam_simulator::run::Run;
use toposlam_vision::{annotate, camera::Camera};

use super::{CliError, Story};
use crate::{
    cli::{picture_file, progress::Progress, scene::in_words, story_lines::StoryLines},
    run_page_data::{PageArrival, PageFrame, RunPageData},
};

/// Observes a simulated run, and keeps what its page and its picture show.
pub(super) struct RunCapture<'o> {
    story: Story<StoryLines<'o>>,
    progress: Progress,
    images: KeptImages,
    rounds: Vec<PageFrame>,
    /// The number of frames before each arrival, and the door taken before it.
    arrivals: Vec<(usize, Option<Door>)>,
    /// The latest door.
    door: Option<Door>,
    maps: Vec<PartialMap>,
    /// The story up to the last frame.
    unwrapped: UnwrappedStory,
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
        story: Story<StoryLines<'o>>,
        progress: Progress,
        images: KeptImages,
    ) -> Self {
        Self {
            story,
            progress,
            images,
            rounds: Vec::new(),
            arrivals: Vec::new(),
            door: None,
            maps: Vec::new(),
            unwrapped: UnwrappedStory::default(),
            moves: 0,
            failure: None,
        }
    }

    /// What was kept. The ending is still empty.
    ///
    /// # Errors
    /// Returns an error if the story or an image could not be written.
    pub(super) fn finish(
        mut self,
        name: &str,
        plan: &Arc<FloorPlan>,
        facing: Dart,
        run: &Run,
    ) -> Result<RunPageData, CliError> {
        self.progress.finish();
        let story = self.story.finish()?.into_text();
        self.unwrapped.read(&story);
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
            story: self.unwrapped.lines,
            maps: self.maps,
            ending: String::new(),
        })
    }

    fn frame(&mut self, frame: &Frame, pose: Pose) {
        self.progress.part_done(1);
        self.unwrapped.read(self.story.out().text());
        let round = PageFrame {
            time: frame.taken,
            pose,
            moves: self.moves,
            state: PathState::Unknown,
            scene: frame.scene.as_ref().map(in_words).unwrap_or_default(),
            command: None,
            image: self.annotated(frame),
            story: self.unwrapped.lines.len(),
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

/// The lines of a story before they were wrapped for a terminal: a page wraps them itself. The story is read
/// while it grows, each line once.
#[derive(Default)]
struct UnwrappedStory {
    lines: Vec<String>,
    /// The number of bytes that were read.
    read: usize,
}

impl UnwrappedStory {
    /// Reads the whole lines that a story has since it was last read.
    fn read(&mut self, story: &str) {
        let new = story.get(self.read..).unwrap_or_default();
        let Some((whole, _)) = new.rsplit_once('\n') else { return };
        whole.split('\n').for_each(|line| self.push(line));
        self.read += whole.len() + 1;
    }

    fn push(&mut self, line: &str) {
        /// The indent of a line that continues the one before, at least.
        const CONTINUES: &str = "    ";
        match self.lines.last_mut() {
            // A paragraph is not indented: each of its lines but the last ends within a sentence.
            Some(last)
                if line.starts_with(CONTINUES)
                    || !(last.is_empty()
                        || line.is_empty()
                        || line.starts_with(' ')
                        || last.ends_with(['.', ':'])) =>
            {
                last.push(' ');
                last.push_str(line.trim_start());
            }
            _ => self.lines.push(line.to_owned()),
        }
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

    fn mapping(&mut self, journey: &Journey, event: MappingEvent) {
        self.story.event(&mut (), journey, event);
        if event.grows_map() {
            self.maps.push(journey.map().clone());
        }
    }

    fn stop(&self) -> bool {
        self.failure.is_some() || self.progress.stop()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_story_for_a_page_is_not_wrapped() {
        let story = "World w. The robot starts at a, with its back to the door to\nb.\nIt senses 2 doors.\n\n\
                     Round 1: the robot takes v0.0 (1 move) and\n         senses 1 door.\n  \
                     Candidate v1.1: rejected, sensed 3\n    doors (2 moves).\n  Known: 2 vertices.\n";
        // However much of it is there when it is read.
        for step in [1, 40, story.len()] {
            let mut read = UnwrappedStory::default();
            for end in (0..story.len()).step_by(step).chain([story.len()]) {
                read.read(&story[..end]);
            }
            assert_eq!(
                read.lines,
                [
                    "World w. The robot starts at a, with its back to the door to b.",
                    "It senses 2 doors.",
                    "",
                    "Round 1: the robot takes v0.0 (1 move) and senses 1 door.",
                    "  Candidate v1.1: rejected, sensed 3 doors (2 moves).",
                    "  Known: 2 vertices.",
                ]
            );
        }
    }
}
