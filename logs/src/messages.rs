//! The messages of the project. `robot/msgs/toposlam_msgs` defines each of them and documents its fields;
//! the fields here have the same order.

use serde::{Deserialize, Serialize};

/// A time, in seconds and nanoseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Stamp {
    /// Whole seconds.
    pub sec: i32,
    /// The rest.
    pub nanosec: u32,
}

impl Stamp {
    /// A time in nanoseconds.
    #[must_use]
    pub fn of(nanoseconds: u64) -> Self {
        const SECOND: u64 = 1_000_000_000;
        let sec = i32::try_from(nanoseconds / SECOND).unwrap_or(i32::MAX);
        Self { sec, nanosec: (nanoseconds % SECOND) as u32 }
    }

    /// The time in nanoseconds; 0 before the beginning of time.
    #[must_use]
    pub fn nanoseconds(self) -> u64 {
        u64::try_from(self.sec).unwrap_or(0) * 1_000_000_000 + u64::from(self.nanosec)
    }
}

/// A message of the project.
pub trait ProjectMessage: Serialize {
    /// Its type, as ROS 2 names it.
    const TYPE: &'static str;
    /// Its definition, without those that it uses.
    const DEFINITION: &'static str;
    /// The topic on which it is written.
    const TOPIC: &'static str;
}

macro_rules! own {
    ($($(#[$doc:meta])* $name:ident $topic:literal { $($(#[$field_doc:meta])* $field:ident: $type:ty,)* })*) => {$(
        $(#[$doc])*
        #[derive(Clone, Debug, Default, PartialEq, Serialize)]
        pub struct $name {
            /// When it was so.
            pub stamp: Stamp,
            $($(#[$field_doc])* pub $field: $type,)*
        }

        impl ProjectMessage for $name {
            const TYPE: &'static str = concat!("toposlam_msgs/msg/", stringify!($name));
            const DEFINITION: &'static str =
                include_str!(concat!("../msgs/toposlam_msgs/msg/", stringify!($name), ".msg"));
            const TOPIC: &'static str = $topic;
        }
    )*};
}

own! {
    /// The head of a log.
    Run "/toposlam/run" {
        /// The version that wrote it.
        version: String,
        /// The name of the world, if known.
        world: String,
        /// Its hash, if known.
        world_hash: String,
        /// Where the robot starts, as `VERTEX:FACING`, if known.
        start: String,
        /// The kind of marker.
        marker: String,
        /// The seed.
        seed: u64,
        /// The camera's calibration, if there is a camera.
        calibration: String,
        /// The colours of the building, if there is a camera.
        colours: String,
        /// The command, if one made it.
        command: String,
        /// The algorithm that made the map, if known.
        algorithm: String,
    }
    /// The scene of an image.
    Scene "/toposlam/scene" {
        /// `hallway`, `junction` or `unknown`.
        place: String,
        /// Of a hallway: `clear` or why not.
        status: String,
        /// Why it is unknown.
        reason: String,
        /// The direction of a hallway.
        heading: f64,
        /// How far its left wall is.
        left: f64,
        /// How far its right wall is.
        right: f64,
        /// The directions of the doors of a junction.
        doors: Vec<f64>,
        /// Where their centre lines meet.
        turning_point: [f64; 2],
        /// From 0 to 1.
        confidence: f64,
        /// Whether the marker is seen.
        marker: bool,
        /// Its middle.
        marker_position: [f64; 2],
        /// The direction of its longer side.
        marker_axis: f64,
        /// The door along which it points; -1: none.
        marker_door: i32,
    }
    /// The command of Algorithm 2 for a scene.
    Command "/toposlam/command" {
        /// The state of Algorithm 2.
        state: String,
        /// Radians counter-clockwise.
        turn: f64,
        /// Metres.
        forward: f64,
    }
    /// The robot leaves by a door.
    Door "/toposlam/door" {
        /// Which move it is, from 1.
        r#move: u32,
        /// Clockwise from the entry door.
        door: u32,
    }
    /// The percept at a junction.
    Percept "/toposlam/percept" {
        /// The number of moves before it.
        r#move: u32,
        /// The number of doors.
        degree: u32,
        /// The door along which the marker points; -1: no marker.
        marker: i32,
        /// Which of the four directions, clockwise from the entry door, are doors.
        form: [bool; 4],
        /// The direction of the entry door in the frame of odometry.
        entry: f64,
    }
    /// A step of the mapping algorithm.
    Hypothesis "/toposlam/hypothesis" {
        /// The number of moves before it.
        r#move: u32,
        /// Which step.
        step: String,
        /// The dart that it is about; -1: none.
        dart: i32,
        /// The other end, the new vertex, the dart that leads to the place of the hypothesis, or how many
        /// vertices are left; -1: none.
        other: i32,
        /// The number of hypotheses that were rejected at once.
        contradicted: u32,
        /// The number that is left.
        hypotheses: u32,
        /// The number of moves that the path was followed.
        followed: u32,
    }
    /// The map, each time that it has grown.
    Map "/toposlam/map" {
        /// The number of moves before it.
        r#move: u32,
        /// The degree of each vertex.
        degrees: Vec<u32>,
        /// The other end of each dart; -1: unexplored.
        opposite: Vec<i32>,
        /// The dart by which the robot came in.
        robot: u32,
    }
    /// The last message of a complete log.
    End "/toposlam/end" {
        /// Moves made.
        moves: u32,
        /// `mapped`, `gave-up`, `stopped` or `out-of-budget`.
        ending: String,
        /// The reason, if it gave up or ran out of budget.
        cause: String,
    }
}
