//! Prints the story of a robot's run while it goes on, and keeps what its page and its picture show.

use std::{
    io::{self, IsTerminal, Write},
    sync::Arc,
};

use image::{codecs::jpeg::JpegEncoder, imageops::FilterType};
use toposlam_logs::record::{Event, EventKind, Frame, RunObserver};
use toposlam_model::{
    aid::{Action, AidKind},
    driving::{algorithm2::PathState, pose::Pose},
    embedded_graph::Dart,
    enumerate::Watch,
    floor_plan::FloorPlan,
    format::named_world::NamedWorld,
    mapping::{MapWalk, MappingEvent},
    percept::Door,
    proof::WalkRecorder,
    world::GraphWorld,
};
use toposlam_simulator::run::Run;
use toposlam_vision::{annotate, camera::Camera};

use super::CliError;
use crate::{
    cli::progress::Progress,
    run_page_data::{MappingStep, PageArrival, PageFrame, RunPageData},
    story::{PrintedStory, Story},
};

/// Observes a run. Of a live robot it keeps no frames: their true poses are not known.
pub(super) struct RunCapture<'o> {
    story: PrintedStory<&'o mut dyn Write>,
    progress: Progress,
    /// The camera, if annotated images are kept.
    camera: Option<Camera>,
    rounds: Vec<PageFrame>,
    /// The number of frames before each arrival, and the door taken before it.
    arrivals: Vec<(usize, Option<Door>)>,
    door: Option<Door>,
    steps: Vec<MappingStep>,
    moves: u64,
    /// What the robot did, each with the number of frames before it.
    actions: Vec<(usize, Action)>,
    walk: WalkRecorder,
}

/// The width of kept images, in pixels.
const WIDTH: u32 = 400;
/// Their JPEG quality.
const QUALITY: u8 = 60;

impl<'o> RunCapture<'o> {
    /// The story begins with this head. With an output it is printed: on a terminal it shows how far the run is.
    pub(super) fn new(
        head: String,
        out: Option<&'o mut dyn Write>,
        frame_kind: &'static str,
        camera: Option<Camera>,
    ) -> Result<Self, CliError> {
        let is_shown = out.is_some() && io::stdout().is_terminal();
        let progress = Progress::endless("exploring", frame_kind)?;
        let progress = if is_shown { progress.hidden() } else { progress };
        let mut story = PrintedStory::new(Story::with_head(head), out);
        story.print();
        Ok(Self {
            story,
            progress,
            camera,
            rounds: Vec::new(),
            arrivals: Vec::new(),
            door: None,
            steps: Vec::new(),
            moves: 0,
            actions: Vec::new(),
            walk: WalkRecorder::default(),
        })
    }

    /// Ends the story, and returns the robot's walk.
    pub(super) fn finish(self) -> Result<WalkRecorder, CliError> {
        self.progress.finish();
        self.story.finish()?;
        Ok(self.walk)
    }

    /// What the page of the run shows. Its ending is still empty.
    pub(super) fn page_data(
        &mut self,
        world: &NamedWorld,
        plan: &Arc<FloorPlan>,
        facing: Dart,
        run: &Run,
    ) -> RunPageData {
        let arrivals = std::mem::take(&mut self.arrivals);
        let calls = arrivals.into_iter().zip(run.monitor.arrivals());
        let calls = calls.map(|((rounds, door), arrival)| PageArrival {
            rounds,
            pose: arrival.pose,
            door,
            percept: arrival.perceived,
            conforms: arrival.conforms(),
        });
        let aid = run.method.algorithm().aid();
        self.place_aid(GraphWorld::with_aid(plan.graph(), aid, facing));
        RunPageData {
            world: world.clone(),
            plan: plan.clone(),
            facing,
            aid,
            calls: calls.collect(),
            rounds: std::mem::take(&mut self.rounds),
            steps: std::mem::take(&mut self.steps),
            ending: String::new(),
        }
    }

    /// Where the marking aid was at each frame, if it moves.
    fn place_aid(&mut self, mut world: GraphWorld<AidKind>) {
        if !world.aid().moves() {
            return;
        }
        let mut actions = std::mem::take(&mut self.actions).into_iter().peekable();
        for (number, round) in self.rounds.iter_mut().enumerate() {
            while let Some((_, action)) = actions.next_if(|(frames, _)| *frames <= number) {
                // What is not possible is reported as a divergence.
                let _ = world.act(action);
            }
            round.aid = world.state().placed.first().copied().flatten();
        }
    }

    fn frame(&mut self, frame: &Frame, pose: Pose) {
        let round = PageFrame {
            time: frame.taken,
            pose,
            moves: self.moves,
            state: PathState::Unknown,
            scene: frame.scene.clone(),
            command: None,
            image: self.annotated(frame),
            steps: self.steps.len(),
            aid: None,
        };
        self.rounds.push(round);
    }

    fn act(&mut self, action: Action) {
        self.moves += action.moves();
        self.actions.push((self.rounds.len(), action));
    }

    /// A small annotated image as a JPEG file.
    fn annotated(&self, frame: &Frame) -> Option<Vec<u8>> {
        let image = frame.image.as_ref()?.pixels().ok()?;
        let image = annotate::over(image, self.camera.as_ref()?, frame.scene.as_ref()?);
        let height = WIDTH * image.height() / image.width().max(1);
        let small = image::imageops::resize(&image, WIDTH, height, FilterType::Triangle);
        let mut bytes = Vec::new();
        small.write_with_encoder(JpegEncoder::new_with_quality(&mut bytes, QUALITY)).ok()?;
        Some(bytes)
    }
}

impl RunObserver for RunCapture<'_> {
    fn event(&mut self, event: &Event) {
        match &event.kind {
            EventKind::Frame(frame) => {
                self.progress.part_done(1);
                if let Some(pose) = event.truth {
                    self.frame(frame, pose);
                }
            }
            EventKind::Command { state, command } => {
                if let Some(last) = self.rounds.last_mut() {
                    (last.state, last.command) = (*state, *command);
                }
            }
            EventKind::Door { door, .. } => {
                self.act(Action::Take(*door));
                self.door = Some(*door);
            }
            EventKind::Action { action, .. } => self.act(Action::Do(*action)),
            EventKind::Arrival(_) => self.arrivals.push((self.rounds.len(), self.door)),
            _ => {}
        }
    }

    fn mapping(&mut self, journey: &MapWalk, event: MappingEvent) {
        self.walk.event(event);
        self.story.add(journey, event);
        self.steps.push(MappingStep { walk: journey.clone(), event });
    }

    fn stop(&self) -> bool {
        self.progress.stop()
    }
}
