//! What the page and the picture of a simulated run show: every frame, every junction at which the robot
//! arrived, the map as it grew, and the story of the mapping algorithm. It is made from the events of the run,
//! and has its true poses and texts. Section 6, Figure 11.

use std::sync::Arc;

use toposlam_model::{
    driving::{
        algorithm2::{Command, PathState},
        pose::Pose,
    },
    embedded_graph::Dart,
    floor_plan::FloorPlan,
    mapping::PartialMap,
    percept::{Door, Percept},
};

/// A run, as its page and its picture show it.
#[derive(Clone, Debug)]
pub struct RunPageData {
    /// The plan's name.
    pub name: String,
    /// The plan.
    pub plan: Arc<FloorPlan>,
    /// The dart along which the marker lies. At the start the robot has its back to its hallway.
    pub facing: Dart,
    /// The frames, in order.
    pub rounds: Vec<PageFrame>,
    /// The junctions that the robot came to, in order; the start first.
    pub calls: Vec<PageArrival>,
    /// The story of the mapping algorithm, line by line.
    pub story: Vec<String>,
    /// The map whenever it grew, in order.
    pub maps: Vec<PartialMap>,
    /// How the run ended, in a sentence.
    pub ending: String,
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
    /// The state of Algorithm 2 after it.
    pub state: PathState,
    /// The scene, in words.
    pub scene: String,
    /// What the robot did; `None` if a path ended.
    pub command: Option<Command>,
    /// The annotated image as a small JPEG file, if one was rendered.
    pub image: Option<Vec<u8>>,
    /// The number of lines of the story before it.
    pub story: usize,
    /// The number of maps before it.
    pub maps: usize,
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
    /// The percept.
    pub percept: Percept,
    /// Whether the robot was where it should be and perceived what it should.
    pub conforms: bool,
}
