//! Why no world explains visits: each choice of their alternatives contradicts itself. Beyond the paper.

use std::mem;

use super::{
    NotProved, UnionStep, WalkContradiction,
    folded_walk::{Folding, turned},
};
use crate::{
    folding::MAX_DARTS,
    marker::MarkerKind,
    percept::{Door, Percept},
    visits::{ChosenAlternative, VisitAlternative, VisitSet, VisitWay},
};

/// A line of a proof that goes through all choices of visits, depth first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChoiceLine {
    /// What is chosen of the next visit.
    Choose(ChosenAlternative),
    Step(UnionStep),
    /// The walk of what is chosen contradicts itself.
    Contradiction(WalkContradiction),
    /// The robot has turned back to a vertex with another percept.
    BackElsewhere,
}

/// The largest number of lines of such a proof.
const MOST_LINES: usize = 200_000;
/// The largest number of visits in such a proof, for the memory.
const MOST_VISITS: usize = 1000;

/// Shows that no choice of visits up to `last` fits any world with this marker. Returns the visits that contradict each
/// other, up to this one, with the lines of the proof.
pub(super) fn impossible_visits(
    visits: &[VisitSet],
    last: usize,
    marker: MarkerKind,
) -> Result<(Vec<VisitSet>, Vec<ChoiceLine>), NotProved> {
    let visits: Vec<_> =
        visits.iter().take(last.saturating_add(1)).map(VisitSet::with_existing_doors).collect();
    let mut count = 1;
    loop {
        let first = visits.len().saturating_sub(count);
        let later = &visits[first..];
        match refute(later, marker) {
            Ok(lines) => return Ok((later.to_vec(), lines)),
            Err(why) if first == 0 => return Err(why),
            // Earlier visits are needed, too.
            Err(_) => count *= 2,
        }
    }
}

/// What can be chosen of a visit: a vertex with its percept, and the door by which the robot left, or none.
type Choice = (ChosenAlternative, Option<(Percept, Door)>);

/// The choices that are left of a visit, the last one first, and the walk of what is chosen before.
struct Branch {
    choices: Vec<Choice>,
    walk: ChosenWalk,
}

/// All choices of visits, each with its contradiction.
fn refute(visits: &[VisitSet], marker: MarkerKind) -> Result<Vec<ChoiceLine>, NotProved> {
    let alternatives = visits.iter().flat_map(VisitSet::alternatives).flatten();
    let darts: u64 = alternatives.map(|one| u64::from(one.percept.degree)).sum();
    if darts > MAX_DARTS as u64 {
        return Err(NotProved::TooManyDarts);
    }
    if visits.len() > MOST_VISITS {
        return Err(NotProved::TooManyChoices);
    }
    let Some(choices) = choices_of(visits, 0) else { return Err(NotProved::PossibleInSomeWorld) };
    let mut branches = vec![Branch { choices, walk: ChosenWalk::new(marker) }];
    let mut lines = Vec::new();
    while let Some(branch) = branches.last_mut() {
        let Some((chosen, vertex)) = branch.choices.pop() else {
            branches.pop();
            continue;
        };
        let is_last_choice = branch.choices.is_empty();
        let mut walk = if is_last_choice {
            mem::replace(&mut branch.walk, ChosenWalk::new(marker))
        } else {
            branch.walk.clone()
        };
        let visit = branches.len();
        lines.push(ChoiceLine::Choose(chosen));
        let contradiction = walk.visit(visits[visit - 1].way(), vertex).err();
        lines.extend(walk.folding.steps.drain(..).map(ChoiceLine::Step));
        lines.extend(contradiction);
        if lines.len() > MOST_LINES {
            return Err(NotProved::TooManyChoices);
        }
        if contradiction.is_none() {
            let Some(choices) = choices_of(visits, visit) else {
                return Err(NotProved::PossibleInSomeWorld);
            };
            branches.push(Branch { choices, walk });
        }
    }
    Ok(lines)
}

/// From the last choice to the first; `None` if there is no such visit.
fn choices_of(visits: &[VisitSet], visit: usize) -> Option<Vec<Choice>> {
    let alternatives = visits.get(visit)?.alternatives();
    let is_last = visit + 1 == visits.len();
    let mut choices = Vec::new();
    for (number, alternative) in alternatives.iter().enumerate() {
        let chosen = ChosenAlternative { number, door: None };
        match *alternative {
            None => choices.push((chosen, None)),
            Some(VisitAlternative { percept, door: None }) if !is_last => {
                let doors = (0..percept.degree).map(Door);
                choices.extend(doors.map(|door| {
                    (ChosenAlternative { door: Some(door), ..chosen }, Some((percept, door)))
                }));
            }
            // Behind the last visit no door is taken.
            Some(VisitAlternative { percept, door }) => {
                choices.push((chosen, Some((percept, door.unwrap_or(Door::BACK)))));
            }
        }
    }
    choices.reverse();
    Some(choices)
}

/// The walk of what is chosen of some visits.
#[derive(Clone)]
struct ChosenWalk {
    folding: Folding,
    /// The door by which the robot left the last vertex.
    left_by: Door,
    /// Whether it has turned back to this vertex.
    comes_back: bool,
}

impl ChosenWalk {
    fn new(marker: MarkerKind) -> Self {
        Self { folding: Folding::new(marker), left_by: Door::BACK, comes_back: false }
    }

    /// The robot visits a vertex, with a percept and the door by which it leaves, or none.
    fn visit(&mut self, way: VisitWay, vertex: Option<(Percept, Door)>) -> Result<(), ChoiceLine> {
        let Some((percept, door)) = vertex else {
            self.comes_back ^= way == VisitWay::Back;
            return Ok(());
        };
        let last = self.folding.last_percept();
        match last {
            Some(last) if self.comes_back => {
                let seen = last.seen_from(self.left_by);
                let is_same = if self.folding.marks_edges() {
                    seen.degree == percept.degree
                } else {
                    seen == percept
                };
                if !is_same {
                    return Err(ChoiceLine::BackElsewhere);
                }
                self.left_by = Door(turned(self.left_by.0, door.0, percept.degree));
            }
            _ => {
                let arrived = self.folding.arrive(last.map(|_| self.left_by), percept);
                arrived.map_err(ChoiceLine::Contradiction)?;
                self.left_by = door;
            }
        }
        self.comes_back = false;
        if self.folding.lacks_marker() && self.folding.open_count() == 0 {
            return Err(ChoiceLine::Contradiction(WalkContradiction::Unmarked));
        }
        Ok(())
    }
}
