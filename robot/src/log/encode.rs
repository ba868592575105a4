//! What sensing, driving and mapping tell, as messages.

use toposlam_model::{
    driving::{
        algorithm2::{self, PathState},
        scene::{
            self, CentreLine, HallwayStatus, HallwayView, JunctionView, MarkerView, Place, Reason,
            Unclear,
        },
    },
    embedded_graph::{Dart, Vertex},
    mapping::MappingEvent,
    percept::{Door, Sighting},
};

use super::messages::{Command, End, Hypothesis, Map, Percept, Scene, Stamp};
use crate::record::{Arrival, MapRecord, RunEnd, RunEnding};

/// Stands for none.
const NONE: i32 = -1;

/// A number of a dart, a door or a vertex.
fn number(number: u32) -> i32 {
    i32::try_from(number).unwrap_or(i32::MAX)
}

/// How many, as messages count.
pub(super) fn count(count: u64) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

/// What sensing told of a picture that was taken then.
#[must_use]
pub fn scene(stamp: Stamp, scene: &scene::Scene) -> Scene {
    let mut told = Scene { stamp, marker_door: NONE, ..Scene::default() };
    match &scene.place {
        Place::Hallway(hallway) => {
            "hallway".clone_into(&mut told.place);
            told.status = match hallway.status {
                HallwayStatus::Clear => "clear".to_owned(),
                HallwayStatus::Unclear(why) => why.to_string(),
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

/// The scene that a message tells; `None` where there is no such scene.
pub(crate) fn scene_of(told: &Scene) -> Option<scene::Scene> {
    let place = match told.place.as_str() {
        "hallway" => Place::Hallway(HallwayView {
            heading: told.heading,
            left: told.left,
            right: told.right,
            status: match told.status.as_str() {
                "clear" => HallwayStatus::Clear,
                why => {
                    HallwayStatus::Unclear(UNCLEAR.into_iter().find(|one| one.to_string() == why)?)
                }
            },
            confidence: told.confidence,
        }),
        "junction" => {
            let through = told.turning_point;
            let line = |&direction| CentreLine { through, direction };
            Place::Junction(JunctionView {
                doors: told.doors.iter().map(line).collect(),
                turning_point: through,
                confidence: told.confidence,
            })
        }
        "unknown" => {
            Place::Unknown(REASONS.into_iter().find(|one| one.to_string() == told.reason)?)
        }
        _ => return None,
    };
    let marker = told.marker.then(|| MarkerView {
        position: told.marker_position,
        axis: told.marker_axis,
        door: u32::try_from(told.marker_door).ok().map(Door),
    });
    Some(scene::Scene { place, marker })
}

const UNCLEAR: [Unclear; 3] =
    [Unclear::ClustersAhead, Unclear::SizesDiffer, Unclear::ClusterBehind];
const REASONS: [Reason; 4] =
    [Reason::NoFloor, Reason::FewWalls, Reason::NothingFits, Reason::Ambiguous];

/// What Algorithm 2 answered.
pub(super) fn command(stamp: Stamp, state: PathState, command: algorithm2::Command) -> Command {
    let state = match state {
        PathState::Leaving => "leaving",
        PathState::Hallway => "hallway",
        PathState::Junction => "junction",
        PathState::Unknown => "unknown",
    };
    let algorithm2::Command { turn, forward } = command;
    Command { stamp, state: state.to_owned(), turn, forward }
}

/// What the robot perceives after so many moves.
pub(super) fn percept(stamp: Stamp, moves: u64, arrival: &Arrival) -> Percept {
    let Arrival { percept, form, entry, .. } = arrival;
    let marker = match percept.sighting {
        Sighting::Pointing(door) => number(door.0),
        _ => NONE,
    };
    Percept {
        stamp,
        r#move: count(moves),
        degree: percept.degree,
        marker,
        form: form.map_or([false; 4], |form| form.0),
        entry: entry.unwrap_or(f64::NAN),
    }
}

/// A step of Algorithm 1 after so many moves; a move has its [`Percept`] instead.
pub(super) fn hypothesis(stamp: Stamp, moves: u64, event: MappingEvent) -> Option<Hypothesis> {
    let step = |step: &str, dart: Option<Dart>| Hypothesis {
        stamp,
        r#move: count(moves),
        step: step.to_owned(),
        dart: dart.map_or(NONE, |Dart(dart)| number(dart)),
        other: NONE,
        ..Hypothesis::default()
    };
    Some(match event {
        MappingEvent::Started { .. } => step("started", None),
        MappingEvent::Arrived { edge, contradicted, hypotheses, .. } => Hypothesis {
            contradicted: count(contradicted as u64),
            hypotheses: count(hypotheses as u64),
            ..step("arrived", Some(edge))
        },
        MappingEvent::Rejected { hypothesis, followed, .. } => {
            Hypothesis { followed, ..step("rejected", Some(hypothesis)) }
        }
        MappingEvent::Confirmed { hypothesis, followed } => {
            Hypothesis { followed, ..step("confirmed", Some(hypothesis)) }
        }
        MappingEvent::LoopClosed { edge, other: Dart(other) } => {
            Hypothesis { other: number(other), ..step("loop-closed", Some(edge)) }
        }
        MappingEvent::VertexAdded { edge, vertex: Vertex(vertex) } => {
            Hypothesis { other: number(vertex), ..step("vertex-added", Some(edge)) }
        }
        MappingEvent::Moved { .. } | MappingEvent::Movable(_) => return None,
    })
}

/// A map.
pub(super) fn map(stamp: Stamp, map: &MapRecord) -> Map {
    let MapRecord { moves, degrees, opposite, robot } = map;
    let opposite = opposite.iter().map(|dart| dart.map_or(NONE, |Dart(far)| number(far)));
    Map {
        stamp,
        r#move: count(*moves),
        degrees: degrees.clone(),
        opposite: opposite.collect(),
        robot: robot.0,
    }
}

/// The map that a message has.
pub(crate) fn map_of(map: &Map) -> MapRecord {
    MapRecord {
        moves: map.r#move.into(),
        degrees: map.degrees.clone(),
        opposite: map.opposite.iter().map(|&far| u32::try_from(far).ok().map(Dart)).collect(),
        robot: Dart(map.robot),
    }
}

/// The end of a run.
pub(super) fn end(stamp: Stamp, end: &RunEnd) -> End {
    let (ending, cause) = match &end.ending {
        RunEnding::Mapped => ("mapped", ""),
        RunEnding::Stopped => ("stopped", ""),
        RunEnding::GaveUp(cause) => ("gave-up", cause.as_str()),
    };
    End { stamp, moves: count(end.moves), ending: ending.to_owned(), cause: cause.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_that_was_told_is_the_same_scene() {
        let line = |direction| CentreLine { through: [0.5, 0.1], direction };
        let hallway = |status| {
            Place::Hallway(HallwayView {
                heading: 0.1,
                left: 0.7,
                right: 0.9,
                status,
                confidence: 0.5,
            })
        };
        let junction = JunctionView {
            doors: vec![line(3.0), line(1.4)],
            turning_point: [0.5, 0.1],
            confidence: 0.8,
        };
        let places = UNCLEAR.map(|why| hallway(HallwayStatus::Unclear(why))).into_iter();
        let places = places.chain(REASONS.map(Place::Unknown));
        let places = places.chain([hallway(HallwayStatus::Clear), Place::Junction(junction)]);
        let marker = |door| MarkerView { position: [0.4, 0.0], axis: 0.2, door };
        for place in places {
            for marker in [None, Some(marker(None)), Some(marker(Some(Door(1))))] {
                let seen = scene::Scene { place: place.clone(), marker };
                assert_eq!(scene_of(&scene(Stamp::default(), &seen)), Some(seen));
            }
        }
        assert_eq!(scene_of(&Scene::default()), None);
    }
}
