//! One walk in two worlds at once.

use std::{fmt, io::Write, str::FromStr};

use serde_json::{Value, json};
use toposlam_model::{
    ambiguity::PlacedRobot,
    percept::Percept,
    world::{Action, RefusedAction, UnknownAction},
};

use super::{
    CliError,
    robot_comparison::{RobotComparison, actions_json},
};
use crate::cli::{
    json::percept_json,
    text::{print_hanging, print_rows},
};

/// Actions, separated by commas.
#[derive(Clone, Debug)]
pub(super) struct ActionList(Vec<Action>);

impl FromStr for ActionList {
    type Err = UnknownAction;

    fn from_str(text: &str) -> Result<Self, UnknownAction> {
        let words = text.split(',').map(str::trim).filter(|_| !text.trim().is_empty());
        words.map(Action::from_str).collect::<Result<_, _>>().map(Self)
    }
}

/// A walk with its percepts: at the start and after each action.
pub(super) struct JointWalk<'w> {
    names: [&'w str; 2],
    /// Where the robots start.
    starts: [String; 2],
    actions: Vec<Action>,
    percepts: Vec<[Percept; 2]>,
    /// Why they stopped, if only one of them could go on.
    stopped: Option<Stop>,
}

/// Why one of two robots cannot go on.
struct Stop {
    /// `A` or `B`.
    world: &'static str,
    cause: RefusedAction,
}

impl fmt::Display for Stop {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        write!(out, "{}, in {}", self.cause, self.world)
    }
}

impl<'w> RobotComparison<'w> {
    /// Both robots walk as far as both can.
    ///
    /// # Errors
    /// Returns an error if neither robot can do an action.
    pub(super) fn walk(&self, ActionList(actions): &ActionList) -> Result<JointWalk<'w>, CliError> {
        let mut robots = self.placed_robots();
        let mut walk = JointWalk {
            names: self.names(),
            starts: self.starts_text(),
            actions: Vec::new(),
            percepts: vec![robots.each_ref().map(PlacedRobot::sensed)],
            stopped: None,
        };
        for (&action, number) in actions.iter().zip(1..) {
            let acted = robots.each_mut().map(|robot| robot.act(action));
            match acted {
                [Ok(()), Ok(())] => {}
                [Err(error), Err(_)] => {
                    return Err(CliError::at(format!("--walk: action {number}"), error));
                }
                [Err(cause), Ok(())] => walk.stopped = Some(Stop { world: "A", cause }),
                [Ok(()), Err(cause)] => walk.stopped = Some(Stop { world: "B", cause }),
            }
            if walk.stopped.is_some() {
                break;
            }
            walk.actions.push(action);
            walk.percepts.push(robots.each_ref().map(PlacedRobot::sensed));
        }
        Ok(walk)
    }
}

impl JointWalk<'_> {
    pub(super) fn json(&self) -> Value {
        let pair = |pair: &[Percept; 2]| pair.map(percept_json);
        json!({
            "starts": self.starts,
            "actions": actions_json(&self.actions),
            "percepts": self.percepts.iter().map(pair).collect::<Vec<_>>(),
            "stopped": self.stopped.as_ref().map(ToString::to_string),
            "stopped_in": self.stopped.as_ref().map(|stop| stop.world),
        })
    }

    pub(super) fn print(&self, out: &mut dyn Write) -> Result<(), CliError> {
        let heads: Vec<_> = self
            .names
            .iter()
            .zip(&self.starts)
            .map(|(name, start)| format!("{name} from {start}"))
            .collect();
        let actions =
            std::iter::once("start".to_owned()).chain(self.actions.iter().map(ToString::to_string));
        let rows: Vec<_> = actions
            .zip(&self.percepts)
            .map(|(action, [one, other])| {
                let differs = if one == other { "" } else { "<- differs" };
                [action, one.to_string(), other.to_string(), differs.to_owned()]
            })
            .collect();
        writeln!(out)?;
        print_rows(out, ["action", &heads[0], &heads[1], ""], &rows)?;
        if let Some(why) = &self.stopped {
            print_hanging(out, "  stopped: ", &why.to_string())?;
        }
        Ok(())
    }
}
