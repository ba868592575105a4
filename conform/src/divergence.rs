//! Divergences: why a run does not conform, and the class of the fault.

use std::{f64::consts::FRAC_PI_6, fmt};

use serde::Serialize;
use toposlam_model::{
    counts::counted,
    mapping::MappingAlgorithm,
    measurement::ContradictoryMeasurement,
    trace::{Departure, Misfit, TraceEvent, TraceEventKind, TraceOrderError},
};

use super::{events::UndecidedCause, impossible::Impossibility};

/// The first event that the specification does not allow.
#[derive(Clone, Debug, PartialEq)]
pub struct Divergence {
    /// The index of the event; the number of events if one is missing at the end.
    pub event: usize,
    /// Why it is not allowed.
    pub cause: DivergenceCause,
    /// The class of the fault.
    pub fault: FaultClass,
}

/// The class of a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
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

impl FaultClass {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Perception, Self::Motion, Self::Algorithm, Self::Log];

    /// Its name.
    #[must_use]
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

/// Why an event is not allowed.
#[derive(Clone, Debug, PartialEq)]
pub enum DivergenceCause {
    /// Percepts and doors do not alternate.
    NotInTurn(TraceOrderError),
    /// Its number of moves is wrong.
    Number {
        /// The number of moves.
        expected: u32,
        /// The recorded number.
        recorded: u32,
    },
    /// Its degree is not its number of doors.
    Form {
        /// The degree.
        degree: u32,
        /// The number of directions with a door.
        doors: u32,
    },
    /// The robot did not drive in the direction of the recorded door, or of any door.
    Aside {
        /// The angle between them, in radians.
        off: f64,
    },
    /// The entry door is not in the direction that the robot came from by odometry.
    Entry {
        /// The angle between them, in radians.
        off: f64,
    },
    /// The robot turned back in a hallway.
    TurnedBack,
    /// The robot turned back, as it may, and perceived the junction that it had left otherwise than before.
    Return {
        /// The number of doors before.
        before: u32,
        /// The number of doors after it.
        now: u32,
    },
    /// A measurement contradicts earlier ones: the robot was moved by hand, or it slipped, between two events, or
    /// it perceived another shape of a junction at them.
    Measurement {
        /// The indices of these events.
        between: [usize; 2],
        /// The indices of the events between which the hallway was last measured before; for a closed walk
        /// and a shape, the same two.
        earlier: [usize; 2],
        /// What contradicts the earlier measurements.
        measurement: ContradictoryMeasurement,
    },
    /// The robot was at a junction that could not be recognised.
    Undecided(UndecidedCause),
    /// It does not fit the known world.
    World(Misfit),
    /// No world of any size explains it together with all before it.
    NoWorld {
        /// The event.
        event: TraceEvent,
        /// Why there is none.
        why: Impossibility,
    },
    /// No run of the algorithm has it.
    Algorithm(Departure),
    /// The log says that the map is complete, and it is not.
    Unfinished {
        /// The number of unexplored edge ends.
        unexplored: u32,
    },
    /// The recorded map is not the map of the algorithm.
    Map {
        /// The algorithm.
        algorithm: MappingAlgorithm,
    },
    /// The map of the algorithm is not the known world.
    WrongMap,
    /// The recorded number of moves is wrong.
    Moves {
        /// The number of moves in the log.
        made: usize,
        /// The recorded number.
        recorded: u64,
    },
}

impl DivergenceCause {
    /// The class of the fault, as far as the event itself shows it.
    #[must_use]
    pub fn fault(&self) -> FaultClass {
        match self {
            Self::NotInTurn(_) | Self::Number { .. } | Self::Form { .. } | Self::Moves { .. } => {
                FaultClass::Log
            }
            Self::Measurement { measurement: ContradictoryMeasurement::Shape, .. } => {
                FaultClass::Perception
            }
            Self::Aside { .. } | Self::TurnedBack | Self::Measurement { .. } => FaultClass::Motion,
            Self::Return { .. } | Self::Entry { .. } | Self::Undecided(_) => FaultClass::Perception,
            Self::Unfinished { .. } | Self::Map { .. } | Self::WrongMap => FaultClass::Algorithm,
            Self::World(Misfit { event, .. })
            | Self::Algorithm(Departure { event, .. })
            | Self::NoWorld { event, .. } => match event.kind {
                TraceEventKind::Percept(_) => FaultClass::Perception,
                TraceEventKind::Door(_) => FaultClass::Algorithm,
            },
        }
    }

    /// Its name in quirk files and reports.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::NotInTurn(_) => "not-in-turn",
            Self::Number { .. } => "number",
            Self::Form { .. } => "form",
            Self::Aside { .. } => "aside",
            Self::Entry { .. } => "entry",
            Self::TurnedBack => "turned-back",
            Self::Measurement { measurement: ContradictoryMeasurement::Shape, .. } => "shape",
            Self::Measurement { .. } => "moved",
            Self::Return { .. } => "return",
            Self::Undecided(_) => "undecided",
            Self::World(misfit) => match misfit.event.kind {
                TraceEventKind::Percept(_) => "percept",
                TraceEventKind::Door(_) => "no-such-door",
            },
            Self::NoWorld { .. } => "no-world",
            Self::Algorithm(departure) => match departure.event.kind {
                TraceEventKind::Percept(_) => "contradiction",
                TraceEventKind::Door(_) => "door",
            },
            Self::Unfinished { .. } => "unfinished",
            Self::Map { .. } => "map",
            Self::WrongMap => "wrong-map",
            Self::Moves { .. } => "moves",
        }
    }
}

/// The names of all causes.
pub(super) const NAMES: [&str; 19] = [
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
    "percept",
    "no-such-door",
    "no-world",
    "contradiction",
    "door",
    "unfinished",
    "map",
    "wrong-map",
    "moves",
];

impl fmt::Display for DivergenceCause {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let degrees = |off: f64| format!("{:.0} degrees", off.to_degrees());
        match self {
            Self::NotInTurn(not) => write!(out, "{not}"),
            Self::Number { expected, recorded } => {
                write!(out, "its move number is {expected}, and the log records {recorded}")
            }
            Self::Form { degree, doors } => {
                let doors = counted(*doors as usize, "door");
                write!(out, "its degree is {degree}, but it has {doors}")
            }
            Self::Aside { off } => {
                write!(out, "the robot drove off {} from the door", degrees(*off))
            }
            Self::Entry { off } => write!(
                out,
                "by odometry the robot came from a direction {} off the entry door",
                degrees(*off)
            ),
            Self::TurnedBack => {
                write!(out, "the robot turned back before it reached a junction")
            }
            Self::Measurement { between, earlier, measurement } => {
                let [between, earlier] = [between, earlier].map(|events| events.map(|at| at + 1));
                contradictory(out, between, earlier, measurement)
            }
            Self::Return { before, now } if before == now => {
                write!(
                    out,
                    "the robot turned back and entered the junction that it had left, and the marker is elsewhere"
                )
            }
            Self::Return { before, now } => write!(
                out,
                "the robot turned back and entered the junction that it had left: {}, now {now}",
                counted(*before as usize, "door")
            ),
            Self::Undecided(UndecidedCause::Unclear) => {
                write!(out, "the robot was at a junction that was not seen clearly")
            }
            Self::Undecided(UndecidedCause::UnseenArm) => {
                write!(
                    out,
                    "the robot was at a junction that may have an arm that its scanner did not look into"
                )
            }
            Self::Undecided(UndecidedCause::UnseenWay) => {
                write!(
                    out,
                    "the robot drove in a direction in which its scanner did not look, so junctions there are not seen"
                )
            }
            Self::World(misfit) => match misfit.candidates.len() {
                1 => write!(out, "it does not fit the known world"),
                poses => {
                    write!(out, "it fits none of the {poses} candidate poses in the known world")
                }
            },
            Self::NoWorld { why, .. } => {
                write!(out, "no world of any size explains the log up to here: {why}")
            }
            Self::Algorithm(departure) => {
                out.write_str(match (departure.event.kind, departure.algorithm) {
                    (TraceEventKind::Percept(_), _) if departure.event.id == 0 => {
                        "a run begins where the marker lies, directed along the entry door"
                    }
                    (TraceEventKind::Percept(_), _) => {
                        "this percept contradicts the percepts before it"
                    }
                    (TraceEventKind::Door(_), MappingAlgorithm::Algorithm1) => {
                        "no run of Algorithm 1 takes this door here"
                    }
                    (TraceEventKind::Door(_), _) => {
                        "the folding explorer does not take this door here"
                    }
                })
            }
            Self::Unfinished { unexplored } => {
                write!(
                    out,
                    "the log records that the map is complete; {unexplored} edge ends are unexplored"
                )
            }
            Self::Map { algorithm } => {
                write!(out, "the recorded map is not the map of {}", algorithm.in_words())
            }
            Self::WrongMap => write!(out, "the map is not the known world"),
            Self::Moves { made, recorded } => {
                write!(out, "the log records that {recorded} moves were made; it has {made}")
            }
        }
    }
}

/// A measurement between two events that contradicts the measurements between two earlier ones.
fn contradictory(
    out: &mut fmt::Formatter,
    [from, to]: [usize; 2],
    [first, last]: [usize; 2],
    measurement: &ContradictoryMeasurement,
) -> fmt::Result {
    if *measurement == ContradictoryMeasurement::Shape {
        return write!(out, "the junction has another shape than at event {from}");
    }
    write!(out, "moved by hand or slipped between events {from} and {to}: {measurement}")?;
    match measurement {
        ContradictoryMeasurement::Length { .. } | ContradictoryMeasurement::Turn { .. } => {
            write!(out, " between events {first} and {last}")
        }
        _ => Ok(()),
    }
}
