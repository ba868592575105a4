//! Algorithm 1: mapping with a single directional immovable marker. Section 2.3.
//!
//! The numbers are those of the printed lines. The state and the small steps are those of
//! [`Algorithm1Run`].

use super::{
    Algorithm1Run, Choices, CostOrder, Explorer, ExplorerInfo, InvalidStep, MapDart, MapWalk,
    MappingChoice, MappingError, MappingEvent, Nearest, Observer, StateKey, StepPurpose,
};
use crate::{
    embedded_graph::Dart,
    marker::{Directional, MarkerKind},
    world::World,
};

/// The result of the validation of a hypothesis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValidationResult {
    /// The percepts did not match; the robot is back where it was.
    Rejected,
    /// The percepts matched throughout; the robot stands at the marker.
    Confirmed,
}

/// Maps a world. At its start the robot stands at the marked vertex, with its back to the facing
/// door. Afterwards `exploration` holds the map, the robot's pose in it and the number of moves;
/// [`Algorithm1Run::map`] is then [complete](super::PartialMap::complete).
///
/// # Errors
/// Returns an error if the world does, if it contradicts itself, if a choice is not open, or if more
/// darts become known than the exploration's bound. The exploration then holds what is known so far.
// paper: alg1.return, alg1.terminates, alg1.every-world
pub fn map_world<W: World>(
    world: &mut W,
    choices: &mut impl Choices,
    exploration: &mut Algorithm1Run,
    observer: &mut impl Observer<W>,
) -> Result<(), MappingError<W::Error>> {
    // 1, 2, 3: the marker lies at v0; S is v0; U is its edges.
    exploration.begin(world, observer)?;
    // 4 to 23, from one choice to the next.
    while let Some(choice) = exploration.choose_with(choices) {
        step(exploration, choice, world, observer)?;
    }
    // S is the map.
    Ok(())
}

/// Lines 4 to 23, from one choice to the next: the step machine of Algorithm 1. The run waits for an
/// edge at line 4 and for a hypothesis at line 8.
///
/// # Errors
/// See [`map_world`].
pub fn step<W: World>(
    exploration: &mut Algorithm1Run,
    choice: MappingChoice,
    world: &mut W,
    observer: &mut impl Observer<W>,
) -> Result<(), MappingError<W::Error>> {
    step_with(exploration, choice, world, observer, try_path)
}

/// [`step`], with another function for lines 10 to 17. Tests break the algorithm with it.
///
/// # Errors
/// See [`map_world`].
// paper: alg1.4, alg1.8, alg1.17, alg1.18, alg1.21
#[inline]
pub fn step_with<W: World, O: Observer<W>>(
    exploration: &mut Algorithm1Run,
    choice: MappingChoice,
    world: &mut W,
    observer: &mut O,
    try_path: impl FnOnce(
        &mut Algorithm1Run,
        Dart,
        &mut W,
        &mut O,
    ) -> Result<ValidationResult, MappingError<W::Error>>,
) -> Result<(), MappingError<W::Error>> {
    match choice {
        // 4, 5: U is not empty; remove the unexplored edge e from it.
        MappingChoice::Edge(edge) => {
            // 6, 7: follow e to its unknown end vu; H is the hypotheses about it.
            exploration.explore(edge, world, observer)?;
        }
        // 8, 9: H is not empty; remove a hypothesis from it.
        MappingChoice::Hypothesis(index) => {
            let hypothesis = exploration.remove_hypothesis(index)?;
            // 10 to 17: if it is confirmed, no other is tried.
            if try_path(exploration, hypothesis, world, observer)? == ValidationResult::Confirmed {
                // 18, 19, 20: a loop was closed.
                exploration.close_loop(hypothesis, world, observer)?;
            }
        }
    }
    // 21, 22, 23: H is empty, and no hypothesis was confirmed: vu is a new place.
    if exploration.is_at_line_8() && exploration.hypotheses().is_empty() {
        exploration.add_place(world, observer)?;
    }
    Ok(())
}

/// Lines 10 to 17: follows the path that leads to the marker if the hypothesis is true, as long as
/// the percepts along it are as expected.
///
/// # Errors
/// Returns an error if the world does, or if it contradicts itself on the way back.
// paper: alg1.10, alg1.11, alg1.12, alg1.13, alg1.14, alg1.15, alg1.16, alg1.17, alg1.validation
pub fn try_path<W: World>(
    exploration: &mut Algorithm1Run,
    hypothesis: Dart,
    world: &mut W,
    observer: &mut impl Observer<W>,
) -> Result<ValidationResult, MappingError<W::Error>> {
    exploration.clear_trail();
    let mut pose = hypothesis;
    let mut followed = 0;
    // 10: the motions of the path to v0, and the percepts expected along it.
    while let Some((door, next)) = exploration.toward_marker(pose) {
        let expected = exploration.map().expected(next);
        // 11: try to traverse it.
        let perceived = exploration.go_through(door, world, observer)?;
        followed += 1;
        // 12, 13: the percepts do not match.
        if perceived != expected {
            // 14, 15: reject the hypothesis, and retrace the path back to vu.
            exploration.retrace(world, observer)?;
            let event = MappingEvent::Rejected { hypothesis, followed, expected, perceived };
            observer.event(world, exploration.walk(), event);
            return Ok(ValidationResult::Rejected);
        }
        pose = next;
    }
    // 16, 17: the percepts match throughout; confirm the hypothesis.
    exploration.arrive_at_marker(pose);
    observer.event(world, exploration.walk(), MappingEvent::Confirmed { hypothesis, followed });
    Ok(ValidationResult::Confirmed)
}

/// Algorithm 1. The default choices are those of [`Nearest`].
impl Explorer for Algorithm1Run {
    type Marker = MarkerKind;
    type Choice = MappingChoice;

    const INFO: ExplorerInfo = ExplorerInfo {
        option: "algorithm1",
        title: "Algorithm 1",
        in_words: "Algorithm 1",
        order: CostOrder::EdgesSquaredVertices,
    };

    fn marker(&self) -> MarkerKind {
        Directional
    }

    fn limit_darts(&mut self, max_darts: usize) {
        self.set_bound(max_darts);
    }

    /// Lines 1 to 3: the marker lies at v0; S is v0; U is its edges.
    fn begin<W: World>(
        &mut self,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        self.find_start(world, observer)
    }

    #[inline]
    fn choose(&mut self) -> Result<Option<MappingChoice>, InvalidStep> {
        Ok(self.choose_with(&mut Nearest))
    }

    fn choices(&mut self) -> Result<Vec<MappingChoice>, InvalidStep> {
        Ok(self.open_choices().collect())
    }

    /// The first part of line 6.
    #[inline]
    fn approach<W: World>(
        &mut self,
        choice: MappingChoice,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        match choice {
            MappingChoice::Edge(edge) => self.go_to_known_end(edge, world, observer),
            MappingChoice::Hypothesis(_) => Ok(()),
        }
    }

    #[inline]
    fn step<W: World>(
        &mut self,
        choice: MappingChoice,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        step(self, choice, world, observer)
    }

    fn map_walk(&self) -> Option<&MapWalk> {
        Some(self.walk())
    }

    fn state_key(&self) -> Option<StateKey> {
        Some(if self.is_at_line_8() {
            StateKey::WithinRound(self.hypotheses().to_vec())
        } else {
            StateKey::Round(self.map().clone(), self.map().vertex(self.robot()))
        })
    }

    fn purpose(&self, choice: Option<MappingChoice>) -> StepPurpose {
        let named = |dart| MapDart::new(self.map(), dart);
        match choice {
            None => StepPurpose::Done,
            Some(MappingChoice::Edge(edge)) => StepPurpose::Explore(named(edge)),
            Some(MappingChoice::Hypothesis(index)) => {
                StepPurpose::Try(named(self.hypotheses()[index]))
            }
        }
    }

    /// `m n + 2 m^2 (n - 1)`.
    // paper: cost.bound
    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        let (m, n) = (edges as u64, vertices as u64);
        let paths = m.saturating_mul(m).saturating_mul(n.saturating_sub(1).saturating_mul(2));
        m.saturating_mul(n).saturating_add(paths)
    }
}
