//! One walk in two worlds at once.

use std::io::{self, Write};

use serde::Serialize;
use toposlam_model::{aid::Action, ambiguity::PlacedRobot, percept::Percept};

use super::{CliError, robot_comparison::RobotComparison};
use crate::cli::text::{print_hanging, print_rows};

/// A walk with its percepts: at the start and after each action.
#[derive(Default, Serialize)]
pub(super) struct JointWalk {
    /// Where the robots start.
    starts: [String; 2],
    actions: Vec<Action>,
    percepts: Vec<[Percept; 2]>,
    /// Why they stopped, if only one of them could go on.
    stopped: Option<String>,
    stopped_in: Option<&'static str>,
    #[serde(skip)]
    heads: [String; 2],
    #[serde(skip)]
    rows: Vec<[String; 4]>,
}

impl JointWalk {
    fn add_percepts(&mut self, action: String, robots: &[PlacedRobot; 2]) {
        let [one, other] = robots.each_ref().map(PlacedRobot::sensed);
        self.percepts.push([one, other]);
        let differs = if one == other { "" } else { "<- differs" };
        self.rows.push([action, one.to_string(), other.to_string(), differs.to_owned()]);
    }

    pub(super) fn print(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out)?;
        print_rows(out, ["action", &self.heads[0], &self.heads[1], ""], &self.rows)?;
        let stopped = self.stopped.as_ref();
        stopped.map_or(Ok(()), |why| print_hanging(out, "  stopped: ", why))
    }
}

impl RobotComparison<'_> {
    /// Both robots walk as far as both can.
    ///
    /// # Errors
    /// Returns an error if neither robot can do an action.
    pub(super) fn walk(&self, actions: &[Action]) -> Result<JointWalk, CliError> {
        let mut robots = self.placed_robots();
        let (names, starts) = (self.names(), self.starts_text());
        let heads = [0, 1].map(|side| format!("{} from {}", names[side], starts[side]));
        let mut walk = JointWalk { starts, heads, ..JointWalk::default() };
        walk.add_percepts("start".to_owned(), &robots);
        for (&action, number) in actions.iter().zip(1..) {
            let (world, cause) = match robots.each_mut().map(|robot| robot.act(action)) {
                [Ok(()), Ok(())] => {
                    walk.actions.push(action);
                    walk.add_percepts(action.to_string(), &robots);
                    continue;
                }
                [Err(error), Err(_)] => {
                    return Err(CliError::at(format!("--walk: action {number}"), error));
                }
                [Err(cause), Ok(())] => ("A", cause),
                [Ok(()), Err(cause)] => ("B", cause),
            };
            walk.stopped = Some(format!("{cause}, in {world}"));
            walk.stopped_in = Some(world);
            break;
        }
        Ok(walk)
    }
}
