//! What can be wrong with a floor plan. Section 2.4.

use thiserror::Error;

use crate::{embedded_graph::ListError, similar::SimilarName};

/// Why junctions and hallways are not a floor plan; names the culprits.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum FloorPlanError {
    /// The width of the hallways is no length.
    #[error("the hallway width is {width}; it must be a positive number of metres")]
    HallwayWidth {
        /// What was given.
        width: f64,
    },
    /// A junction is nowhere.
    #[error(
        "junction `{junction}` is at ({}, {}); both must be finite numbers of metres",
        .position[0], .position[1]
    )]
    Position {
        /// The junction.
        junction: String,
        /// What was given.
        position: [f64; 2],
    },
    /// Two junctions have the same name.
    #[error("junction `{junction}` is listed twice")]
    JunctionTwice {
        /// The junction.
        junction: String,
    },
    /// Two junctions are too close to each other.
    #[error(
        "junctions `{one}` and `{other}` are {distance:.2} m apart; \
         it must be two hallway widths, {least:.2} m"
    )]
    TooClose {
        /// The one junction.
        one: String,
        /// The other.
        other: String,
        /// How far apart they are, in metres.
        distance: f64,
        /// How far apart they must be.
        least: f64,
    },
    /// A hallway ends at a junction that is not there.
    #[error("there is no junction `{junction}`{similar}")]
    UnknownJunction {
        /// The hallway's index in the list of hallways.
        number: usize,
        /// The name that is no junction.
        junction: String,
        /// A junction with a similar name.
        similar: SimilarName,
    },
    /// A hallway ends where it begins.
    #[error("the hallway from `{junction}` to `{junction}` has no length")]
    NoLength {
        /// The junction.
        junction: String,
    },
    /// A hallway is askew.
    #[error("hallway `{from}` - `{to}` runs neither north-south nor east-west")]
    NotAlongAxis {
        /// Where it begins.
        from: String,
        /// Where it ends.
        to: String,
    },
    /// Two hallways lie between the same junctions.
    #[error("hallway `{from}` - `{to}` is listed twice")]
    HallwayTwice {
        /// Where it begins.
        from: String,
        /// Where it ends.
        to: String,
    },
    /// Two hallways lie on each other from a junction on.
    #[error("hallways `{junction}` - `{one}` and `{junction}` - `{other}` overlap")]
    SameDirection {
        /// The junction at which both begin.
        junction: String,
        /// Where the one ends.
        one: String,
        /// Where the other ends.
        other: String,
    },
    /// A junction without a hallway.
    #[error("junction `{junction}` has no door; it must be a dead end, an L or a T")]
    NoDoor {
        /// The junction.
        junction: String,
    },
    /// A junction in the middle of a straight hallway.
    #[error(
        "junction `{junction}` has two doors opposite each other; \
         it must be a dead end, an L or a T"
    )]
    StraightThrough {
        /// The junction.
        junction: String,
    },
    /// A crossing.
    #[error("junction `{junction}` has four doors; it must be a dead end, an L or a T")]
    FourDoors {
        /// The junction.
        junction: String,
    },
    /// A junction stands in a hallway that passes by.
    #[error("junction `{junction}` lies on hallway `{from}` - `{to}`, which does not end there")]
    OnHallway {
        /// The junction.
        junction: String,
        /// Where the hallway begins.
        from: String,
        /// Where it ends.
        to: String,
    },
    /// The middles of two hallways cross.
    #[error("hallways `{}` - `{}` and `{}` - `{}` cross", .one[0], .one[1], .other[0], .other[1])]
    Cross {
        /// The ends of the one.
        one: [String; 2],
        /// The ends of the other.
        other: [String; 2],
    },
    /// The floors of two hallways meet elsewhere than at a shared junction.
    #[error(
        "the floors of hallways `{}` - `{}` and `{}` - `{}` overlap or touch",
        .one[0], .one[1], .other[0], .other[1]
    )]
    FloorsMeet {
        /// The ends of the one.
        one: [String; 2],
        /// The ends of the other.
        other: [String; 2],
    },
    /// The plan is not connected, or has no hallway.
    #[error(transparent)]
    Graph(#[from] ListError),
}
