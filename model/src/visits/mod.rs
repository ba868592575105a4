//! Walks of which a robot's views leave several percepts possible, judged exactly. Section 2.1.
//!
//! A [`VisitSet`] is a stay at what may be a vertex, with the percepts that the views cannot exclude; one of them may be
//! that there is no vertex. A *choice* takes one alternative of each visit. A world explains the visits if it explains
//! some choice: [`states_after`] follows all choices in a known world at once, [`alternatives_left`] finds what the world
//! decides, and [`explain`] searches for a choice that some world explains. [`explain_by_algorithm`] does so if the doors
//! are those of an algorithm.
//!
//! Between vertices a robot may turn back in the corridor. That is a visit without a vertex by a robot that goes
//! [back](VisitWay::Back), or a visit that may be one.

mod by_algorithm;
mod in_some_world;
mod in_world;

pub use by_algorithm::{AlgorithmSearchBounds, explain_by_algorithm};
pub use in_some_world::{Explanation, explain};
pub use in_world::{ChosenAlternative, alternatives_left, choice_in_world, states_after};

use crate::percept::{Door, Percept};

/// A stay at what may be a vertex.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VisitSet {
    /// Sorted, each once.
    alternatives: Vec<Option<VisitAlternative>>,
    way: VisitWay,
}

/// What a robot may have perceived at a vertex, and the door by which it left.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct VisitAlternative {
    pub percept: Percept,
    /// `None` if the robot has not left: it was the last visit, or any door is possible.
    pub door: Option<Door>,
}

/// How a robot went on where there is no vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum VisitWay {
    Through,
    Back,
}

impl VisitSet {
    /// A visit with these alternatives, of which `None` is no vertex. Without any, nothing explains it.
    pub fn new(
        alternatives: impl IntoIterator<Item = Option<VisitAlternative>>,
        way: VisitWay,
    ) -> Self {
        let mut alternatives: Vec<_> = alternatives.into_iter().collect();
        alternatives.sort_unstable();
        alternatives.dedup();
        Self { alternatives, way }
    }

    /// The place in a corridor where a robot turned back.
    pub fn turned_back() -> Self {
        Self::new([None], VisitWay::Back)
    }

    /// Without the alternatives whose door does not exist: no robot has taken it.
    #[must_use]
    pub fn with_existing_doors(&self) -> Self {
        let exists = |alternative: &Option<VisitAlternative>| {
            let Some(VisitAlternative { percept, door }) = alternative else { return true };
            door.is_none_or(|door| door.0 < percept.degree)
        };
        Self::new(self.alternatives.iter().copied().filter(exists), self.way)
    }

    pub fn alternatives(&self) -> &[Option<VisitAlternative>] {
        &self.alternatives
    }

    pub fn way(&self) -> VisitWay {
        self.way
    }

    /// Whether the views leave one alternative.
    pub fn is_certain(&self) -> bool {
        self.alternatives.len() == 1
    }
}

impl VisitAlternative {
    /// The doors by which the robot may have left.
    fn doors(self) -> impl Iterator<Item = Door> {
        let doors = match self.door {
            Some(Door(door)) => door..door.saturating_add(1),
            None => 0..self.percept.degree,
        };
        doors.filter(move |&door| door < self.percept.degree).map(Door)
    }
}

#[cfg(test)]
mod tests;
