//! What can be wrong with a run of an explorer that is another program.

use thiserror::Error;
use toposlam_model::aid::RefusedAction;

use crate::cli::text::counted;

/// What is wrong with a run. Its message is a clause without a subject: the explorer.
#[derive(Clone, Debug, PartialEq, Error)]
pub(in crate::cli) enum ExplorerFault {
    #[error("wrote `{line}`, which is not JSON: {cause}")]
    NotJson { line: String, cause: String },
    #[error("wrote `{line}`, which is not an answer: {cause}")]
    NotAnAnswer { line: String, cause: String },
    #[error("wrote a line of more than {limit} bytes")]
    LineTooLong { limit: u64 },
    #[error(
        "wrote more than one line for one percept; the second begins with `{line}`. Other output belongs on \
         standard error, which is not read as an answer"
    )]
    ExtraLine { line: String },
    /// The process ended, or closed its standard output.
    #[error("{}", match status {
        Some(status) => format!("ended with {status}"),
        None => "closed its standard output".to_owned(),
    })]
    Ended { status: Option<String>, failed: bool },
    #[error("{}", refusal(refused))]
    RefusedAction { refused: RefusedAction },
    #[error("gave up: {reason}")]
    GaveUp { reason: String },
    #[error("returned a map in which an edge is missing: dart {dart} leads nowhere")]
    MissingEdge { dart: String },
    #[error("returned a map that is not an embedded graph: {cause}")]
    InvalidMap { cause: String },
    #[error("returned a map that is not isomorphic to the world{difference}")]
    WrongMap {
        /// A shortest walk with different percepts in the map and in the world; empty if none was searched.
        difference: String,
    },
    #[error("returned the pose {believed}; the robot came in by dart {truly} of the map")]
    WrongPose { believed: String, truly: String },
    /// It returned a right map after a walk that does not determine the world.
    #[error(
        "guessed: its map is right, but there is another world in which it makes the same walk, and returns the same \
         map"
    )]
    Guessed,
    #[error(
        "did not read a percept and answer it within {seconds} s; does it write a line for each percept, and flush \
         its output?"
    )]
    TimedOut { seconds: f64 },
    #[error("was stopped after {}", counted(*limit as usize, "move"))]
    OutOfMoves { limit: u64 },
}

fn refusal(refused: &RefusedAction) -> String {
    match refused {
        RefusedAction::NoSuchDoor { door, degree } => {
            let doors = counted(*degree as usize, "door");
            format!("took door {} at a vertex with {doors}, 0 to {}", door.0, degree - 1)
        }
        RefusedAction::NothingToPickUp => "picked up a marker where there is none".to_owned(),
        RefusedAction::NothingToDrop => "dropped a marker that the robot does not carry".to_owned(),
        RefusedAction::StringTooShort => "went farther than its string is long".to_owned(),
        RefusedAction::NotOfThisAid { action } => {
            format!("asked for {action}, which a robot with this marking aid cannot do")
        }
        RefusedAction::NoWorldLeft | RefusedAction::TooManyDoors { .. } => refused.to_string(),
        RefusedAction::OutOfMoves { bound } => {
            format!("made more than {}", counted(*bound as usize, "move"))
        }
    }
}

const MAX_MOVES: &str = "max-moves";

impl ExplorerFault {
    /// The name of a guess.
    pub(in crate::cli) const GUESSED: &str = "guessed";

    /// Its name in `--json` and in the table of causes.
    pub(in crate::cli) fn name(&self) -> &'static str {
        match self {
            Self::NotJson { .. } => "not-json",
            Self::NotAnAnswer { .. } => "not-an-answer",
            Self::LineTooLong { .. } => "line-too-long",
            Self::ExtraLine { .. } => "extra-line",
            Self::Ended { failed: true, .. } => "crashed",
            Self::Ended { .. } => "ended",
            Self::RefusedAction { refused } => match refused {
                RefusedAction::NoSuchDoor { .. } | RefusedAction::NoWorldLeft => "no-such-door",
                RefusedAction::NothingToPickUp | RefusedAction::NothingToDrop => "no-such-marker",
                RefusedAction::StringTooShort
                | RefusedAction::TooManyDoors { .. }
                | RefusedAction::NotOfThisAid { .. } => "not-possible",
                RefusedAction::OutOfMoves { .. } => MAX_MOVES,
            },
            Self::GaveUp { .. } => "gave-up",
            Self::MissingEdge { .. } => "missing-edge",
            Self::InvalidMap { .. } => "invalid-map",
            Self::WrongMap { .. } => "wrong-map",
            Self::WrongPose { .. } => "wrong-pose",
            Self::Guessed => Self::GUESSED,
            Self::TimedOut { .. } => "timeout",
            Self::OutOfMoves { .. } => MAX_MOVES,
        }
    }

    /// Whether a limit was reached. Then it is not known whether the explorer would have mapped the start.
    pub(in crate::cli) fn is_limit(&self) -> bool {
        matches!(self, Self::TimedOut { .. }) || self.name() == MAX_MOVES
    }

    /// Whether the run ended without the explorer's last answer, so that the process cannot begin another.
    pub(in crate::cli) fn ends_process(&self) -> bool {
        !matches!(
            self,
            Self::GaveUp { .. }
                | Self::MissingEdge { .. }
                | Self::InvalidMap { .. }
                | Self::WrongMap { .. }
                | Self::WrongPose { .. }
                | Self::Guessed
        )
    }
}
