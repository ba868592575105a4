//! The messages of the project: events are encoded here, and decoded.
//!
//! What a message does not have is -1 or [`UNKNOWN`] there, and `None` everywhere else.

use toposlam_model::{
    aid::{AidAction, UnknownAction},
    driving::{
        algorithm2::{self, PathState},
        scene::{
            self, CentreLine, HallwayStatus, HallwayView, JunctionView, MarkerView, Place, Reason,
            Unclear,
        },
        visit::JunctionShape,
    },
    embedded_graph::{Dart, Vertex},
    mapping::{FoldingEvent, MappingEvent, SafeguardEvent},
    percept::{self, Sighting, UnknownSighting},
};

use super::messages::{Action, Command, Door, End, Hypothesis, Map, Percept, Scene, Stamp};
use crate::record::{Arrival, EventKind, MapRecord, RunEnd, RunEnding};

const NONE: i32 = -1;
/// Stands for an unknown number of moves in a message.
const UNKNOWN: u32 = u32::MAX;

fn number(number: u32) -> i32 {
    i32::try_from(number).unwrap_or(i32::MAX)
}

fn count(count: u64) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

pub fn scene(stamp: Stamp, scene: &scene::Scene) -> Scene {
    let mut message = Scene { stamp, marker_door: NONE, ..Scene::default() };
    match &scene.place {
        Place::Hallway(hallway) => {
            "hallway".clone_into(&mut message.place);
            message.status = match hallway.status {
                HallwayStatus::Clear => "clear".to_owned(),
                HallwayStatus::Unclear(why) => why.to_string(),
            };
            (message.heading, message.left, message.right) =
                (hallway.heading, hallway.left, hallway.right);
            message.confidence = hallway.confidence;
        }
        Place::Junction(junction) => {
            "junction".clone_into(&mut message.place);
            message.doors = junction.doors.iter().map(|door| door.direction).collect();
            message.turning_point = junction.turning_point;
            message.confidence = junction.confidence;
        }
        Place::Unknown(reason) => {
            "unknown".clone_into(&mut message.place);
            message.reason = reason.to_string();
        }
    }
    if let Some(marker) = &scene.marker {
        message.marker = true;
        (message.marker_position, message.marker_axis) = (marker.position, marker.axis);
        message.marker_door = marker.door.map_or(NONE, |door| number(door.0));
    }
    message
}

/// The scene of a message; `None` if the message has an unknown word.
pub(super) fn scene_of(message: &Scene) -> Option<scene::Scene> {
    let place = match message.place.as_str() {
        "hallway" => Place::Hallway(HallwayView {
            heading: message.heading,
            left: message.left,
            right: message.right,
            status: match message.status.as_str() {
                "clear" => HallwayStatus::Clear,
                why => {
                    HallwayStatus::Unclear(UNCLEAR.into_iter().find(|one| one.to_string() == why)?)
                }
            },
            confidence: message.confidence,
        }),
        "junction" => {
            let through = message.turning_point;
            let line = |&direction| CentreLine { through, direction };
            Place::Junction(JunctionView {
                doors: message.doors.iter().map(line).collect(),
                turning_point: through,
                confidence: message.confidence,
            })
        }
        "unknown" => {
            Place::Unknown(Reason::ALL.into_iter().find(|one| one.to_string() == message.reason)?)
        }
        _ => return None,
    };
    let marker = message.marker.then(|| MarkerView {
        position: message.marker_position,
        axis: message.marker_axis,
        door: u32::try_from(message.marker_door).ok().map(percept::Door),
    });
    Some(scene::Scene { place, marker })
}

/// The words of states; any other state is [`PathState::Unknown`], `unknown`.
const STATES: [(PathState, &str); 3] = [
    (PathState::Leaving, "leaving"),
    (PathState::Hallway, "hallway"),
    (PathState::Junction, "junction"),
];
const UNCLEAR: [Unclear; 3] =
    [Unclear::ClustersAhead, Unclear::SizesDiffer, Unclear::ClusterBehind];

pub(super) fn command(stamp: Stamp, state: PathState, command: algorithm2::Command) -> Command {
    let word = STATES.into_iter().find(|(known, _)| *known == state);
    let state = word.map_or("unknown", |(_, word)| word);
    let algorithm2::Command { turn, forward } = command;
    Command { stamp, state: state.to_owned(), turn, forward }
}

/// The command in a message. A state that is not known is [`PathState::Unknown`].
pub(super) fn command_of(command: &Command) -> EventKind {
    let state = STATES.into_iter().find(|(_, word)| *word == command.state);
    let state = state.map_or(PathState::Unknown, |(state, _)| state);
    let Command { turn, forward, .. } = *command;
    EventKind::Command { state, command: Some(algorithm2::Command { turn, forward }) }
}

pub fn arrival(stamp: Stamp, arrival: &Arrival) -> Percept {
    let Arrival { number: moves, degree, sighting, shape, entry } = arrival;
    let (marker, words) = match sighting {
        None | Some(Sighting::Nothing) => (NONE, String::new()),
        Some(Sighting::Pointing(door)) => (number(door.0), String::new()),
        Some(other) => (NONE, other.to_string()),
    };
    Percept {
        stamp,
        r#move: moves.unwrap_or(UNKNOWN),
        degree: *degree,
        marker,
        form: shape.map_or([false; 4], |shape| shape.0),
        entry: entry.unwrap_or(f64::NAN),
        sighting: words,
    }
}

/// The arrival in a message; an error if its marker points along a negative door, or its words are no sighting.
pub(super) fn arrival_of(message: &Percept) -> Result<Arrival, String> {
    let sighting = match &*message.sighting {
        "" => sighting_of(message.marker.into())?,
        words => sighting_in(words)?,
    };
    Ok(Arrival {
        number: known(message.r#move),
        degree: message.degree,
        sighting: Some(sighting),
        shape: message.form.contains(&true).then_some(JunctionShape(message.form)),
        entry: message.entry.is_finite().then_some(message.entry),
    })
}

/// The sighting of a marker that points along a door; -1: of none. An error if there is no door with this number.
pub(super) fn sighting_of(marker: i64) -> Result<Sighting, String> {
    if marker == i64::from(NONE) {
        return Ok(Sighting::Nothing);
    }
    let door = u32::try_from(marker).map(|door| Sighting::Pointing(percept::Door(door)));
    door.map_err(|_| format!("its marker is {marker}, which is not a door and not -1, no marker"))
}

/// The sighting that words describe. An error if they do not.
pub(super) fn sighting_in(words: &str) -> Result<Sighting, String> {
    words.parse().map_err(|unknown: UnknownSighting| unknown.to_string())
}

pub(super) fn seen(is_seen: bool) -> Sighting {
    if is_seen { Sighting::Lying(1) } else { Sighting::Nothing }
}

pub fn door(stamp: Stamp, number: Option<u32>, door: percept::Door) -> Door {
    Door { stamp, r#move: number.unwrap_or(UNKNOWN), door: door.0 }
}

pub(super) fn door_of(message: &Door) -> EventKind {
    EventKind::Door { number: known(message.r#move), door: percept::Door(message.door) }
}

/// What the robot did with its marking aid after so many moves.
pub fn action(stamp: Stamp, number: Option<u32>, action: AidAction) -> Action {
    Action { stamp, r#move: number.unwrap_or(UNKNOWN), action: action.to_string() }
}

pub(super) fn action_of(message: &Action) -> Result<EventKind, String> {
    let action = message.action.parse().map_err(|error: UnknownAction| error.to_string())?;
    Ok(EventKind::Action { number: known(message.r#move), action })
}

fn known(number: u32) -> Option<u32> {
    (number != UNKNOWN).then_some(number)
}

/// A step of the mapping algorithm after so many moves; a move has its [`Percept`] instead.
pub(super) fn hypothesis(stamp: Stamp, moves: u64, event: MappingEvent) -> Option<Hypothesis> {
    let step = |step: &str, dart: Option<Dart>| Hypothesis {
        stamp,
        r#move: count(moves),
        step: step.to_owned(),
        dart: dart.map_or(NONE, |Dart(dart)| number(dart)),
        other: NONE,
        ..Hypothesis::default()
    };
    let about = |name: &str, edge: Dart, hypothesis| Hypothesis {
        other: number(edge.0),
        ..step(name, Some(hypothesis))
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
        MappingEvent::Folding(event) => match event {
            FoldingEvent::Explored { edge, .. } => step("explored", Some(edge)),
            FoldingEvent::Testing { edge, hypothesis, cost } => {
                Hypothesis { followed: count(cost as u64), ..about("testing", edge, hypothesis) }
            }
            FoldingEvent::Refuted { edge, hypothesis, .. } => about("refuted", edge, hypothesis),
            FoldingEvent::Confirmed { edge, hypothesis } => about("confirmed", edge, hypothesis),
            FoldingEvent::Folded { after, .. } => {
                Hypothesis { other: i32::try_from(after).unwrap_or(NONE), ..step("folded", None) }
            }
        },
        MappingEvent::Safeguard(event) => match event {
            SafeguardEvent::AuditBegun => step("audit-begun", None),
            SafeguardEvent::AuditPassed { moves } => {
                Hypothesis { followed: count(moves), ..step("audit-passed", None) }
            }
            SafeguardEvent::Contradicted(_) => step("contradicted", None),
            SafeguardEvent::TooLarge { .. } => step("too-large", None),
            SafeguardEvent::Relocated => step("relocated", None),
            SafeguardEvent::MarkerFound { kept, walks } => Hypothesis {
                hypotheses: count(walks as u64),
                contradicted: count((walks - kept) as u64),
                ..step("marker-found", None)
            },
            SafeguardEvent::BlockedRetried { .. } => step("blocked-retried", None),
        },
        MappingEvent::Moved { .. } | MappingEvent::Movable(_) => return None,
    })
}

pub fn map(stamp: Stamp, map: &MapRecord) -> Map {
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

pub(super) fn map_of(map: &Map) -> MapRecord {
    MapRecord {
        moves: map.r#move.into(),
        degrees: map.degrees.clone(),
        opposite: map.opposite.iter().map(|&far| u32::try_from(far).ok().map(Dart)).collect(),
        robot: Dart(map.robot),
    }
}

pub(super) fn end(stamp: Stamp, end: &RunEnd) -> End {
    let (ending, cause) = match &end.ending {
        RunEnding::Mapped => ("mapped", ""),
        RunEnding::Stopped => ("stopped", ""),
        RunEnding::GaveUp(cause) => ("gave-up", cause.as_str()),
        RunEnding::OutOfBudget(cause) => ("out-of-budget", cause.as_str()),
    };
    End { stamp, moves: count(end.moves), ending: ending.to_owned(), cause: cause.to_owned() }
}

/// The end in a message; `None` if it is not known how the run ended.
pub(super) fn end_of(message: End) -> Option<RunEnd> {
    let ending = match message.ending.as_str() {
        "mapped" => RunEnding::Mapped,
        "stopped" => RunEnding::Stopped,
        "gave-up" => RunEnding::GaveUp(message.cause),
        "out-of-budget" => RunEnding::OutOfBudget(message.cause),
        _ => return None,
    };
    Some(RunEnd { moves: message.moves.into(), ending })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_action_is_read_as_it_was_written() {
        for done in [AidAction::PickUp, AidAction::Send { robot: 2, door: percept::Door(1) }] {
            for number in [None, Some(4)] {
                let message = action(Stamp::default(), number, done);
                assert_eq!(action_of(&message), Ok(EventKind::Action { number, action: done }));
            }
        }
        let wrong = Action { action: "lift".to_owned(), ..Action::default() };
        assert!(action_of(&wrong).unwrap_err().starts_with("`lift` is not an action"));
    }

    #[test]
    fn what_is_seen_of_any_marking_aid_is_read_as_it_was_written() {
        for words in [
            "no marker",
            "marker along door 2",
            "marker",
            "2 markers",
            "first and third marker",
            "past the mark, against its arrow",
            "string through doors 0 and 1, from the hand through door 0, fixed end",
            "robot 2 here along door 1, robot 3 elsewhere at 1 door",
        ] {
            let sighting = Some(words.parse().unwrap());
            let seen = Arrival { number: Some(3), degree: 3, sighting, shape: None, entry: None };
            let message = arrival(Stamp::default(), &seen);
            assert_eq!(arrival_of(&message), Ok(seen), "{words}");
        }
        let wrong = Percept { sighting: "north".to_owned(), ..Percept::default() };
        assert!(arrival_of(&wrong).unwrap_err().starts_with("`north` is not what a robot sees"));
    }

    #[test]
    fn a_scene_is_read_as_it_was_written() {
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
        let places = places.chain(Reason::ALL.map(Place::Unknown));
        let places = places.chain([hallway(HallwayStatus::Clear), Place::Junction(junction)]);
        let marker = |door| MarkerView { position: [0.4, 0.0], axis: 0.2, door };
        for place in places {
            for marker in [None, Some(marker(None)), Some(marker(Some(percept::Door(1))))] {
                let seen = scene::Scene { place: place.clone(), marker };
                assert_eq!(scene_of(&scene(Stamp::default(), &seen)), Some(seen));
            }
        }
        assert_eq!(scene_of(&Scene::default()), None);
    }
}
