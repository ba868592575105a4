//! What can be wrong with a floor plan. Section 2.4.

use thiserror::Error;

use crate::embedded_graph::ListError;

/// Why junctions and hallways are not a floor plan; names the culprits.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum FloorPlanError {
    #[error("the hallway width is {width}; it must be a positive number of metres")]
    HallwayWidth { width: f64 },
    #[error(
        "junction `{junction}` is at ({}, {}); both must be finite numbers of metres",
        .position[0], .position[1]
    )]
    Position { junction: String, position: [f64; 2] },
    #[error("junction `{junction}` is listed twice")]
    JunctionTwice { junction: String },
    #[error(
        "junctions `{one}` and `{other}` are {distance:.2} m apart; \
         it must be two hallway widths, {least:.2} m"
    )]
    TooClose { one: String, other: String, distance: f64, least: f64 },
    #[error("there is no junction `{junction}`{similar}")]
    UnknownJunction { number: usize, junction: String, similar: String },
    #[error("the hallway from `{junction}` to `{junction}` has no length")]
    NoLength { junction: String },
    #[error("hallway `{from}` - `{to}` runs neither north-south nor east-west")]
    NotAlongAxis { from: String, to: String },
    #[error("hallway `{from}` - `{to}` is listed twice")]
    HallwayTwice { from: String, to: String },
    #[error("hallways `{junction}` - `{one}` and `{junction}` - `{other}` overlap")]
    SameDirection { junction: String, one: String, other: String },
    #[error("junction `{junction}` has {doors}; it must be a dead end, an L or a T")]
    NotAKind { junction: String, doors: &'static str },
    #[error("junction `{junction}` lies on hallway `{from}` - `{to}`, which does not end there")]
    OnHallway { junction: String, from: String, to: String },
    #[error("hallways `{}` - `{}` and `{}` - `{}` cross", .one[0], .one[1], .other[0], .other[1])]
    Cross { one: [String; 2], other: [String; 2] },
    #[error(
        "the floors of hallways `{}` - `{}` and `{}` - `{}` overlap or touch",
        .one[0], .one[1], .other[0], .other[1]
    )]
    FloorsMeet { one: [String; 2], other: [String; 2] },
    #[error(transparent)]
    Graph(#[from] ListError),
}
