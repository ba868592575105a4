//! Why a run does not conform, and whose fault that is.

use std::{f64::consts::FRAC_PI_6, fmt};

use toposlam_model::trace::{Departure, Misfit, TraceEventKind, TraceOrderError};

/// Where a run first does something that the specification does not.
#[derive(Clone, Debug, PartialEq)]
pub struct Divergence {
    /// Which event, from 0; the number of events where one is missing at the end.
    pub event: usize,
    /// Why it does not fit.
    pub cause: DivergenceCause,
    /// Whose fault that is.
    pub culprit: FaultClass,
}

/// Whose fault a divergence is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum FaultClass {
    /// The robot perceived what is not so.
    Perception,
    /// The robot did not go where it was told to go.
    Motion,
    /// The robot was told to go where Algorithm 1 does not go, or its map is wrong.
    Algorithm,
    /// The log does not agree with itself.
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

/// Off by more than this, in radians, odometry contradicts a direction.
pub(super) const OFF: f64 = FRAC_PI_6;

/// Why an event does not fit.
#[derive(Clone, Debug, PartialEq)]
pub enum DivergenceCause {
    /// Percepts and doors do not take turns.
    NotInTurn(TraceOrderError),
    /// Its number is not that of its place.
    Number {
        /// How many moves there were.
        expected: u32,
        /// How many it says.
        told: u32,
    },
    /// It has as many doors as its percept has not.
    Form {
        /// The number of doors that were told.
        degree: u32,
        /// The number of directions in which there is one.
        doors: u32,
    },
    /// The robot drove in another direction than that of the door that it is said to have taken, or of
    /// any.
    Aside {
        /// By how much, in radians.
        off: f64,
    },
    /// The entry door is not where odometry says that the robot came from.
    Entry {
        /// By how much it is off, in radians.
        off: f64,
    },
    /// The robot turned back in a hallway.
    TurnedBack,
    /// The robot was at a junction that its pictures did not tell.
    Undecided,
    /// In the known world this is not so.
    World(Misfit),
    /// No world is so.
    NoWorld {
        /// Worlds with so many edges were tried.
        edges: usize,
    },
    /// Algorithm 1 does not do this.
    Algorithm(Departure),
    /// The log says that the map is complete; Algorithm 1 would go on.
    Unfinished {
        /// So many edge ends are not explored.
        unexplored: u32,
    },
    /// The map in the log is not the one that Algorithm 1 makes.
    Map,
    /// The map that Algorithm 1 makes is not that of the known world.
    WrongMap,
    /// The log says another number of moves than it has.
    Moves {
        /// How many it has.
        made: usize,
        /// How many it says.
        told: u64,
    },
}

impl DivergenceCause {
    /// Whose fault it is, as far as the event itself tells.
    #[must_use]
    pub fn culprit(&self) -> FaultClass {
        match self {
            Self::NotInTurn(_) | Self::Number { .. } | Self::Form { .. } | Self::Moves { .. } => {
                FaultClass::Log
            }
            Self::Aside { .. } | Self::TurnedBack => FaultClass::Motion,
            Self::Entry { .. } | Self::Undecided | Self::NoWorld { .. } => FaultClass::Perception,
            Self::Unfinished { .. } | Self::Map | Self::WrongMap => FaultClass::Algorithm,
            Self::World(Misfit { event, .. }) | Self::Algorithm(Departure { event, .. }) => {
                match event.kind {
                    TraceEventKind::Percept(_) => FaultClass::Perception,
                    TraceEventKind::Door(_) => FaultClass::Algorithm,
                }
            }
        }
    }

    /// A word for it, by which a quirk can be told.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::NotInTurn(_) => "not-in-turn",
            Self::Number { .. } => "number",
            Self::Form { .. } => "form",
            Self::Aside { .. } => "aside",
            Self::Entry { .. } => "entry",
            Self::TurnedBack => "turned-back",
            Self::Undecided => "undecided",
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
            Self::Map => "map",
            Self::WrongMap => "wrong-map",
            Self::Moves { .. } => "moves",
        }
    }
}

/// Every name that a cause has.
pub(super) const NAMES: [&str; 16] = [
    "not-in-turn",
    "number",
    "form",
    "aside",
    "entry",
    "turned-back",
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
            Self::Number { expected, told } => {
                write!(
                    out,
                    "the log tells it as that of move {told}; it is that of move {expected}"
                )
            }
            Self::Form { degree, doors } => {
                write!(out, "its degree is {degree}, but it has doors in {doors} directions")
            }
            Self::Aside { off } => {
                write!(out, "the robot drove off {} from the door", degrees(*off))
            }
            Self::Entry { off } => write!(
                out,
                "the entry door is {} from where the robot came by odometry",
                degrees(*off)
            ),
            Self::TurnedBack => {
                write!(out, "the robot turned back without having been at a junction")
            }
            Self::Undecided => {
                write!(out, "the robot was at a junction of which its pictures do not tell")
            }
            Self::World(misfit) => match misfit.candidates.len() {
                1 => write!(out, "in the known world this is not so"),
                poses => {
                    write!(out, "at none of the {poses} poses left in the known world this is so")
                }
            },
            Self::NoWorld { edges } => {
                write!(out, "no world with at most {edges} edges explains the log up to here")
            }
            Self::Algorithm(departure) => out.write_str(match departure.event.kind {
                TraceEventKind::Percept(_) => {
                    "what is perceived contradicts what was perceived before"
                }
                TraceEventKind::Door(_) => "no run of Algorithm 1 takes this door here",
            }),
            Self::Unfinished { unexplored } => {
                write!(
                    out,
                    "the run is said to be complete, with {unexplored} edge ends unexplored"
                )
            }
            Self::Map => write!(out, "the map in the log is not the one that Algorithm 1 makes"),
            Self::WrongMap => write!(out, "the map is not that of the known world"),
            Self::Moves { made, told } => {
                write!(out, "the log says that {told} moves were made; it has {made}")
            }
        }
    }
}
