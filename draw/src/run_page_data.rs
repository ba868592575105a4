//! What the page and the picture of a simulated run show: every frame, every junction at which the robot
//! arrived, and every step of the mapping algorithm. Section 6, Figure 11.

use std::sync::Arc;

use toposlam_model::{
    aid::AidKind,
    driving::{
        algorithm2::{Command, PathState},
        pose::Pose,
        scene::Scene,
    },
    embedded_graph::Dart,
    floor_plan::FloorPlan,
    format::named_world::NamedWorld,
    mapping::{MapWalk, MappingEvent, PartialMap},
    percept::{Door, Percept},
};

/// A run, as its page and its picture show it.
#[derive(Clone, Debug)]
pub struct RunPageData {
    pub world: NamedWorld,
    pub plan: Arc<FloorPlan>,
    /// The dart along which the marker lies at first. At the start the robot has its back to its hallway.
    pub facing: Dart,
    pub aid: AidKind,
    pub rounds: Vec<PageFrame>,
    /// The junctions that the robot came to, in order; the start first.
    pub calls: Vec<PageArrival>,
    pub steps: Vec<MappingStep>,
    /// How the run ended, in a sentence.
    pub ending: String,
}

impl RunPageData {
    /// Whether the robot drove by scenes, and so by Algorithm 2.
    pub(crate) fn has_scenes(&self) -> bool {
        self.rounds.iter().any(|round| round.scene.is_some())
    }

    /// The map whenever it grew, up to a number of steps.
    pub(crate) fn maps(&self, steps: usize) -> impl Iterator<Item = &PartialMap> {
        let steps = self.steps.iter().take(steps);
        steps.filter(|step| step.event.grows_map()).map(|step| step.walk.map())
    }
}

/// A step of the mapping algorithm, and its state after it.
#[derive(Clone, Debug)]
pub struct MappingStep {
    pub walk: MapWalk,
    pub event: MappingEvent,
}

/// A frame, and the robot's answer to it.
#[derive(Clone, Debug)]
pub struct PageFrame {
    /// When it was taken, in seconds of simulated time.
    pub time: f64,
    /// The robot's true pose.
    pub pose: Pose,
    /// The number of moves begun before it.
    pub moves: u64,
    /// The state of Algorithm 2 after it, if the run has scenes.
    pub state: PathState,
    /// `None` by a laser scanner.
    pub scene: Option<Scene>,
    /// What the robot did; `None` if a path ended.
    pub command: Option<Command>,
    /// The annotated image as a small JPEG file, if one was rendered.
    pub image: Option<Vec<u8>>,
    /// The number of steps of the mapping algorithm before it.
    pub steps: usize,
    /// If the marking aid moves: at which dart the marker lies, or the other robot stands; `None` if the robot carries it.
    pub aid: Option<Dart>,
}

/// What the robot perceived at a junction.
#[derive(Clone, Debug)]
pub struct PageArrival {
    /// The number of frames before it.
    pub rounds: usize,
    /// The robot's true pose.
    pub pose: Pose,
    /// The door by which it left the junction before; `None` at the start.
    pub door: Option<Door>,
    pub percept: Percept,
    /// Whether the robot was where it should be and perceived what it should.
    pub conforms: bool,
}
