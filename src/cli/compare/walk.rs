//! A walk that somebody wants to see, in two worlds at once.

use std::{io::Write, str::FromStr};

use serde_json::{Value, json};
use toposlam_model::{
    percept::Percept,
    world::{Action, UnknownAction},
};

use super::{
    Failure,
    robots::{Robots, actions_json},
};

/// Actions as the command line tells them.
#[derive(Clone, Debug)]
pub(super) struct Actions(Vec<Action>);

impl FromStr for Actions {
    type Err = UnknownAction;

    fn from_str(text: &str) -> Result<Self, UnknownAction> {
        let words = text.split(',').map(str::trim).filter(|_| !text.trim().is_empty());
        words.map(Action::from_str).collect::<Result<_, _>>().map(Self)
    }
}

/// A walk as it was walked: the percepts at the start and after each action.
pub(super) struct Walked<'w> {
    names: [&'w str; 2],
    actions: Vec<Action>,
    percepts: Vec<[Percept; 2]>,
}

impl<'w> Robots<'w> {
    /// Both robots do the same.
    pub(super) fn walk(&self, Actions(actions): &Actions) -> Result<Walked<'w>, Failure> {
        let names = self.names();
        let mut robots = self.begun();
        let mut percepts = Vec::new();
        for step in 0..=actions.len() {
            let mut perceived = Vec::new();
            for (robot, letter) in robots.iter_mut().zip(["A", "B"]) {
                if let Some(last) = step.checked_sub(1) {
                    let place = || format!("--walk: action {step} in {letter}");
                    robot.act(actions[last]).map_err(|error| Failure::at(place(), error))?;
                }
                perceived.push(robot.sensed());
            }
            percepts.push([perceived[0], perceived[1]]);
        }
        Ok(Walked { names, actions: actions.clone(), percepts })
    }
}

impl Walked<'_> {
    pub(super) fn json(&self) -> Value {
        let percept = |percept: &Percept| json!({ "degree": percept.degree, "sighting": percept.sighting.to_string() });
        let pair = |[one, other]: &[Percept; 2]| [percept(one), percept(other)];
        json!({
            "actions": actions_json(&self.actions),
            "percepts": self.percepts.iter().map(pair).collect::<Vec<_>>(),
        })
    }

    pub(super) fn tell(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let actions =
            std::iter::once("start".to_owned()).chain(self.actions.iter().map(ToString::to_string));
        let rows: Vec<_> = actions
            .zip(&self.percepts)
            .map(|(action, [one, other])| [action, one.to_string(), other.to_string()])
            .collect();
        let width = |column: usize, name: &str| {
            let texts = rows.iter().map(|row| row[column].chars().count());
            texts.chain([name.chars().count()]).max().unwrap_or_default()
        };
        let (first, second) = (width(0, "door"), width(1, self.names[0]));
        writeln!(out, "\n  {:first$}  {:second$}  {}", "door", self.names[0], self.names[1])?;
        for [action, one, other] in &rows {
            let differs = if one == other { "" } else { "  <- differs" };
            writeln!(out, "  {action:first$}  {one:second$}  {other}{differs}")?;
        }
        Ok(())
    }
}
