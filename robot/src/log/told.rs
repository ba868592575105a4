//! What sensing, driving and mapping tell, as messages.

use toposlam_model::{
    driving::{
        algorithm2::{self, Standing, State},
        scene::{self, Place, Status},
    },
    embedded_graph::{Dart, Vertex},
    mapping::{Event, Journey},
    percept::Sighting,
};

use super::messages::{Command, Hypothesis, Map, Percept, Scene, Stamp};

/// Stands for none.
const NONE: i32 = -1;

/// A time, in nanoseconds since the robot was switched on.
pub(super) fn nanoseconds(seconds: f64) -> u64 {
    (seconds * 1e9).round() as u64
}

/// The same, as messages tell it.
pub(super) fn stamp(nanoseconds: u64) -> Stamp {
    const SECOND: u64 = 1_000_000_000;
    let sec = i32::try_from(nanoseconds / SECOND).unwrap_or(i32::MAX);
    Stamp { sec, nanosec: (nanoseconds % SECOND) as u32 }
}

/// A number of a dart, a door or a vertex.
fn number(number: u32) -> i32 {
    i32::try_from(number).unwrap_or(i32::MAX)
}

/// How many, as messages count.
pub(super) fn count(count: u64) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

/// What sensing told of a picture that was taken then.
pub(super) fn scene(stamp: Stamp, scene: &scene::Scene) -> Scene {
    let mut told = Scene { stamp, marker_door: NONE, ..Scene::default() };
    match &scene.place {
        Place::Hallway(hallway) => {
            "hallway".clone_into(&mut told.place);
            told.status = match hallway.status {
                Status::Clear => "clear".to_owned(),
                Status::Unclear(why) => why.to_string(),
            };
            (told.heading, told.left, told.right) = (hallway.heading, hallway.left, hallway.right);
            told.confidence = hallway.confidence;
        }
        Place::Junction(junction) => {
            "junction".clone_into(&mut told.place);
            told.doors = junction.doors.iter().map(|door| door.direction).collect();
            told.turning_point = junction.turning_point;
            told.confidence = junction.confidence;
        }
        Place::Unknown(reason) => {
            "unknown".clone_into(&mut told.place);
            told.reason = reason.to_string();
        }
    }
    if let Some(marker) = &scene.marker {
        told.marker = true;
        (told.marker_position, told.marker_axis) = (marker.position, marker.axis);
        told.marker_door = marker.door.map_or(NONE, |door| number(door.0));
    }
    told
}

/// What Algorithm 2 answered.
pub(super) fn command(stamp: Stamp, state: State, command: algorithm2::Command) -> Command {
    let state = match state {
        State::Leaving => "leaving",
        State::Hallway => "hallway",
        State::Junction => "junction",
        State::Unknown => "unknown",
    };
    let algorithm2::Command { turn, forward } = command;
    Command { stamp, state: state.to_owned(), turn, forward }
}

/// Where the robot stands.
pub(super) fn percept(stamp: Stamp, moves: u64, at: &Standing) -> Percept {
    let marker = match at.percept.sighting {
        Sighting::Pointing(door) => number(door.0),
        _ => NONE,
    };
    let degree = at.percept.degree;
    Percept { stamp, r#move: count(moves), degree, marker, form: at.form.0, entry: at.entry }
}

/// A step of Algorithm 1; moves are told by [`Percept`].
pub(super) fn hypothesis(stamp: Stamp, journey: &Journey, event: Event) -> Option<Hypothesis> {
    let told = |step: &str, dart: Option<Dart>| Hypothesis {
        stamp,
        r#move: count(journey.moves()),
        step: step.to_owned(),
        dart: dart.map_or(NONE, |Dart(dart)| number(dart)),
        other: NONE,
        ..Hypothesis::default()
    };
    Some(match event {
        Event::Started { .. } => told("started", None),
        Event::Arrived { edge, contradicted, hypotheses, .. } => Hypothesis {
            contradicted: count(contradicted as u64),
            hypotheses: count(hypotheses as u64),
            ..told("arrived", Some(edge))
        },
        Event::Rejected { hypothesis, followed, .. } => {
            Hypothesis { followed, ..told("rejected", Some(hypothesis)) }
        }
        Event::Confirmed { hypothesis, followed } => {
            Hypothesis { followed, ..told("confirmed", Some(hypothesis)) }
        }
        Event::LoopClosed { edge, other: Dart(other) } => {
            Hypothesis { other: number(other), ..told("loop-closed", Some(edge)) }
        }
        Event::VertexAdded { edge, vertex: Vertex(vertex) } => {
            Hypothesis { other: number(vertex), ..told("vertex-added", Some(edge)) }
        }
        Event::Moved { .. } | Event::Movable(_) => return None,
    })
}

/// The map, where an event made it grow.
pub(super) fn map(stamp: Stamp, journey: &Journey, event: Event) -> Option<Map> {
    let grown = matches!(
        event,
        Event::Started { .. } | Event::LoopClosed { .. } | Event::VertexAdded { .. }
    );
    let map = journey.map();
    let darts = map.vertices().flat_map(|vertex| map.darts_of(vertex));
    grown.then(|| Map {
        stamp,
        r#move: count(journey.moves()),
        degrees: map.vertices().map(|vertex| map.degree(vertex)).collect(),
        opposite: darts
            .map(|dart| map.opposite(dart).map_or(NONE, |Dart(far)| number(far)))
            .collect(),
        robot: journey.robot().0,
    })
}
