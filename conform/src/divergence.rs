//! Divergences: why a run does not conform, and the class of the fault.

use std::{f64::consts::FRAC_PI_6, fmt};

use serde::{Serialize, Serializer};
use thiserror::Error;
use toposlam_model::{
    aid::{AidKind, Places},
    counts::counted,
    mapping::MappingAlgorithm,
    marker::Directional,
    measurement::ContradictoryMeasurement,
    trace::{Departure, Misfit, TraceEvent, TraceEventKind, TraceOrderError},
};

use super::{events::UndecidedCause, impossible::Impossibility};

/// The first event that the specification does not allow.
#[derive(Clone, Debug, PartialEq)]
pub struct Divergence {
    /// The index of the event; the number of events if one is missing at the end.
    pub event: usize,
    pub cause: DivergenceCause,
    pub fault: FaultClass,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum FaultClass {
    /// A wrong percept.
    Perception,
    /// The robot did not drive as commanded.
    Motion,
    /// A door that the algorithm does not take, or a wrong map.
    Algorithm,
    /// The log contradicts itself.
    Log,
}

impl Serialize for FaultClass {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.name().serialize(serializer)
    }
}

impl FaultClass {
    pub const ALL: [Self; 4] = [Self::Perception, Self::Motion, Self::Algorithm, Self::Log];

    pub fn name(self) -> &'static str {
        match self {
            Self::Perception => "perception",
            Self::Motion => "motion",
            Self::Algorithm => "algorithm",
            Self::Log => "log",
        }
    }
}

impl fmt::Display for FaultClass {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        out.pad(self.name())
    }
}

/// Odometry contradicts a direction if they differ by more than this, in radians.
pub(super) const OFF: f64 = FRAC_PI_6;

#[derive(Clone, Debug, PartialEq, Error)]
pub enum DivergenceCause {
    #[error("{0}")]
    NotInTurn(TraceOrderError),
    #[error("its move number is {expected}, and the log records {recorded}")]
    Number { expected: u32, recorded: u32 },
    /// Its degree is not its number of directions with a door.
    #[error("its degree is {degree}, but it has {}", counted(*.doors as usize, "door"))]
    Form { degree: u32, doors: u32 },
    /// The robot drove off this angle, in radians, from the recorded door, or from any door.
    #[error("the robot drove off {:.0} degrees from the door", .off.to_degrees())]
    LeftBetweenDoors { off: f64 },
    /// In radians.
    #[error("by odometry the robot came from a direction {:.0} degrees off the entry door", .off.to_degrees())]
    Entry { off: f64 },
    #[error("the robot turned back before it reached a junction")]
    TurnedBack,
    /// The robot turned back, as it may, and perceived another number of doors than before at the junction that it
    /// had left, or its marker elsewhere.
    #[error(
        "the robot turned back and entered the junction that it had left{}",
        if before == now {
            ", and the marker is elsewhere".to_owned()
        } else {
            format!(": {}, now {now}", counted(*before as usize, "door"))
        }
    )]
    Return { before: u32, now: u32 },
    /// A measurement contradicts earlier ones: the robot was moved by hand, or it slipped, between two events, or
    /// it perceived another shape of a junction at them.
    #[error("{}", contradictory(between, earlier, measurement))]
    Measurement {
        /// The indices of these events.
        between: [usize; 2],
        /// The indices of the events between which the hallway was last measured before; for a closed walk
        /// and a shape, the same two.
        earlier: [usize; 2],
        measurement: ContradictoryMeasurement,
    },
    /// The robot was at a junction that could not be recognised.
    #[error("{}", match .0 {
        UndecidedCause::Unclear => "the robot was at a junction that was not seen clearly",
        UndecidedCause::UnseenArm => {
            "the robot was at a junction that may have an arm that its scanner did not look into"
        }
        UndecidedCause::UnseenWay => {
            "the robot drove in a direction in which its scanner did not look, so junctions there are not seen"
        }
    })]
    Undecided(UndecidedCause),
    #[error("{}", match .0.candidates.len() {
        1 => "it does not fit the known world".to_owned(),
        poses => format!("it fits none of the {poses} candidate poses in the known world"),
    })]
    World(Misfit<Places>),
    #[error("the known world fits no choice of what was driven or seen to end up to here")]
    Driven,
    #[error("no world of any size explains the log up to here: {why}")]
    NoWorld { event: TraceEvent, why: Impossibility },
    #[error("{}", departed(.0))]
    Algorithm(Departure),
    #[error("the log records that the map is complete; {unexplored} edge ends are unexplored")]
    Unfinished { unexplored: u32 },
    #[error("the recorded map is not the map of {}", .algorithm.in_words())]
    Map { algorithm: MappingAlgorithm },
    /// The map of the algorithm.
    #[error("the map is not the known world")]
    WrongMap,
    #[error("the log records that {recorded} moves were made; it has {made}")]
    Moves { made: usize, recorded: u64 },
}

impl DivergenceCause {
    /// The class of the fault, as far as the event itself shows it.
    pub fn fault(&self) -> FaultClass {
        self.name_and_fault().1
    }

    /// Its name in quirk files and reports.
    pub fn name(&self) -> &'static str {
        self.name_and_fault().0
    }

    fn name_and_fault(&self) -> (&'static str, FaultClass) {
        use FaultClass::{Algorithm, Log, Motion, Perception};
        let by_kind = |event: &TraceEvent, percept, door, action| match event.kind {
            TraceEventKind::Percept(_) => (percept, Perception),
            TraceEventKind::Door(_) => (door, Algorithm),
            TraceEventKind::Action(_) => (action, Algorithm),
        };
        match self {
            Self::NotInTurn(_) => ("not-in-turn", Log),
            Self::Number { .. } => ("number", Log),
            Self::Form { .. } => ("form", Log),
            Self::LeftBetweenDoors { .. } => ("aside", Motion),
            Self::Entry { .. } => ("entry", Perception),
            Self::TurnedBack => ("turned-back", Motion),
            Self::Measurement { measurement: ContradictoryMeasurement::Shape, .. } => {
                ("shape", Perception)
            }
            Self::Measurement { .. } => ("moved", Motion),
            Self::Return { .. } => ("return", Perception),
            Self::Undecided(_) => ("undecided", Perception),
            Self::Driven => ("driven", Perception),
            Self::World(misfit) => {
                by_kind(&misfit.event, "percept", "no-such-door", "impossible-action")
            }
            Self::NoWorld { event, .. } => by_kind(event, "no-world", "no-world", "no-world"),
            Self::Algorithm(departure) => {
                by_kind(&departure.event, "contradiction", "door", "action")
            }
            Self::Unfinished { .. } => ("unfinished", Algorithm),
            Self::Map { .. } => ("map", Algorithm),
            Self::WrongMap => ("wrong-map", Algorithm),
            Self::Moves { .. } => ("moves", Log),
        }
    }
}

/// The names of all causes.
pub(super) const NAMES: [&str; 22] = [
    "not-in-turn",
    "number",
    "form",
    "aside",
    "entry",
    "turned-back",
    "moved",
    "shape",
    "return",
    "undecided",
    "driven",
    "percept",
    "no-such-door",
    "impossible-action",
    "no-world",
    "contradiction",
    "door",
    "action",
    "unfinished",
    "map",
    "wrong-map",
    "moves",
];

/// Why no run of an algorithm has an event.
fn departed(departure: &Departure) -> String {
    let algorithm = departure.algorithm.in_words();
    match (departure.event.kind, departure.algorithm) {
        (TraceEventKind::Percept(_), _) if departure.event.id == 0 => {
            let aid = departure.algorithm.aid();
            if aid == AidKind::Fixed(Directional) {
                "a run begins where the marker lies, directed along the entry door".to_owned()
            } else {
                format!("a run begins where the robot has all of its marking aid, `{}`", aid.name())
            }
        }
        (TraceEventKind::Percept(_), _) => {
            "this percept contradicts the percepts before it".to_owned()
        }
        (TraceEventKind::Door(_), MappingAlgorithm::Algorithm1) => {
            "no run of Algorithm 1 takes this door here".to_owned()
        }
        (TraceEventKind::Door(_), _) => format!("{algorithm} does not take this door here"),
        (TraceEventKind::Action(_), _) => format!("{algorithm} does not do this here"),
    }
}

/// A measurement between two events that contradicts the measurements between two earlier ones.
fn contradictory(
    between: &[usize; 2],
    earlier: &[usize; 2],
    measurement: &ContradictoryMeasurement,
) -> String {
    let [[from, to], [first, last]] = [between, earlier].map(|events| events.map(|at| at + 1));
    let moved = format!("moved by hand or slipped between events {from} and {to}: {measurement}");
    match measurement {
        ContradictoryMeasurement::Shape => {
            format!("the junction has another shape than at event {from}")
        }
        ContradictoryMeasurement::Length { .. } | ContradictoryMeasurement::Turn { .. } => {
            format!("{moved} between events {first} and {last}")
        }
        _ => moved,
    }
}
