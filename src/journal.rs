//! What happened in a run of a simulated robot, as a person looks at it: every picture with what the
//! robot made of it, every junction that it called, the map as it grew, and the story of Algorithm 1.
//! Section 6, Figure 11.

use std::sync::Arc;

use toposlam_model::{
    driving::algorithm2::{Command, PathState},
    embedded_graph::Dart,
    floor_plan::FloorPlan,
    mapping::PartialMap,
    percept::Percept,
};
use toposlam_robot::pose::Pose;

/// A run.
#[derive(Clone, Debug)]
pub struct Journal {
    /// The plan's name.
    pub name: String,
    /// The plan.
    pub plan: Arc<FloorPlan>,
    /// The dart along which the marker lies; the robot begins with its back to its hallway.
    pub facing: Dart,
    /// Every picture, in order.
    pub rounds: Vec<Round>,
    /// Every junction that the robot came to, in order; the start first.
    pub calls: Vec<Call>,
    /// The story of Algorithm 1, line by line.
    pub story: Vec<String>,
    /// The map whenever it grew, in order.
    pub maps: Vec<PartialMap>,
    /// How the run ended, in a sentence.
    pub ending: String,
}

/// A picture, and what the robot made of it.
#[derive(Clone, Debug)]
pub struct Round {
    /// When it was taken, in seconds of the simulated time.
    pub time: f64,
    /// Where the robot really was.
    pub pose: Pose,
    /// How many moves were made or begun by then.
    pub moves: u64,
    /// What the robot was about after it.
    pub state: PathState,
    /// What sensing told, in words.
    pub scene: String,
    /// What the robot did then; `None` where a path ended or was given up.
    pub command: Option<Command>,
    /// The annotated picture, small, as the bytes of a JPEG file; `None` where none was rendered.
    pub picture: Option<Vec<u8>>,
    /// So many lines of the story were told by then.
    pub story: usize,
    /// So many maps were made by then.
    pub maps: usize,
}

/// What the robot made of a junction to which it came.
#[derive(Clone, Debug)]
pub struct Call {
    /// After so many pictures.
    pub rounds: usize,
    /// Where the robot really was.
    pub pose: Pose,
    /// What it perceived.
    pub percept: Percept,
    /// Whether it was where it should be and perceived what it should.
    pub conforms: bool,
}
