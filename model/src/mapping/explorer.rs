//! Explorers: everything that maps a world, as one trait.
//!
//! An [`Explorer`] is the state of a run. It waits for one of its open [choices](Explorer::choices), and
//! [makes the step](Explorer::step) of that choice in an [`ObservedWorld`]. The *drivers* run it: [`explore`] straight
//! through, the checks of [`check`](crate::check) on every start, the matches of [`trace`](crate::trace) along a
//! recorded run, and robots with a [`MappingMethod`](super::MappingMethod). A driver clones an explorer to try more
//! than one choice, or to repeat a step in another world.

use std::{borrow::Cow, fmt};

use super::{
    ExploredMap, FACING, Flaw, InvalidStep, MapWalk, Mapped, ObservedWorld, PartialMap, StepPurpose,
};
use crate::{
    aid::Aid,
    embedded_graph::{Dart, Vertex},
};

/// An explorer: the state of a run that maps a world.
///
/// What it does must depend on its state, the percepts and the refusals alone. An explorer that makes its whole
/// run in [`begin`](Self::begin) has no steps. Short steps share more in a check of
/// [shared prefixes](crate::check::SharedPrefixCheck): at best, a step takes one door whose other end is not known, as its
/// first move after [`approach`](Self::approach). `clone_from` is called for each run there; an implementation that
/// reuses memory is faster.
///
/// Steps return an error if the world does, if it contradicts itself, if the choice is not open, or at the limit of
/// darts. The state then holds what is known so far.
#[expect(clippy::missing_errors_doc, reason = "see above")]
pub trait Explorer: Clone {
    /// The marking aid with which it maps.
    type Aid: Aid + Clone;

    type Choice: Copy + fmt::Debug + PartialEq;

    /// Its names, and the order of its cost.
    fn info(&self) -> ExplorerInfo {
        ExplorerInfo {
            option: "explorer",
            title: "Explorer",
            in_words: "the explorer",
            order: CostOrder::EdgesSquaredVertices,
        }
    }

    fn aid(&self) -> Self::Aid;

    /// Limits the darts that later runs may come to know. Beyond that they end with
    /// [`MappingError::Bound`](super::MappingError::Bound).
    fn limit_darts(&mut self, _max_darts: usize) {}

    /// Begins a run in another world. At its start the robot stands where the marker is placed, with its
    /// back to the facing door.
    fn begin<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W>;

    /// The default choice; `None` if the run has ended, and the map is complete. By default there is none. It is an
    /// error if the map is not complete, and no choice is open.
    fn choose(&mut self) -> Result<Option<Self::Choice>, InvalidStep> {
        Ok(None)
    }

    /// Adds the choices with which the run can go on.
    fn add_choices(&mut self, choices: &mut Vec<Self::Choice>) -> Result<(), InvalidStep> {
        choices.extend(self.choose()?);
        Ok(())
    }

    /// The choices with which the run can go on.
    fn choices(&mut self) -> Result<Vec<Self::Choice>, InvalidStep> {
        let mut choices = Vec::new();
        self.add_choices(&mut choices)?;
        Ok(choices)
    }

    /// Makes the first moves of a step, in the known part of the world. [`step`](Self::step) then makes the others.
    fn approach<W: ObservedWorld>(&mut self, _choice: Self::Choice, _world: &mut W) -> Mapped<W> {
        Ok(())
    }

    fn step<W: ObservedWorld>(&mut self, _choice: Self::Choice, _world: &mut W) -> Mapped<W> {
        Err(InvalidStep::NoPlan.into())
    }

    /// The robot's map, its pose in the map and its moves, if it keeps them in this form.
    fn map_walk(&self) -> Option<&MapWalk> {
        None
    }

    /// The map at the end of a run; a flaw if it is not complete.
    fn explored(&self) -> Result<ExploredMap<'_>, Flaw> {
        let walk = self.map_walk().ok_or(Flaw::Unfinished { unexplored: 0 })?;
        let unexplored = walk.map().unexplored_count();
        let graph = walk.map().complete().ok_or(Flaw::Unfinished { unexplored })?;
        Ok(ExploredMap { graph: Cow::Borrowed(graph), facing: FACING, pose: walk.robot() })
    }

    /// Writes numbers that distinguish its state from others of the same start and level, and returns the level; `None` if
    /// states are not compared.
    fn write_key(&self, _key: &mut Vec<u32>) -> Option<StateLevel> {
        None
    }

    /// The purpose of the step of a choice; without one, of the end of the run.
    fn purpose(&self, choice: Option<Self::Choice>) -> StepPurpose {
        if choice.is_some() { StepPurpose::GoOn } else { StepPurpose::Done }
    }

    /// The most moves that it may make in a world of this size. In a check, further moves are refused.
    fn move_bound(&self, _edges: usize, _vertices: usize) -> u64 {
        1_000_000
    }
}

/// Where a run waits for a choice. Equal states of one level are followed once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StateLevel {
    /// The key is the map, numbered by discovery, and the robot's vertex in it.
    BetweenRounds,
    /// The key is the hypotheses that are left.
    WithinRound,
}

impl StateLevel {
    pub(crate) fn between_rounds(map: &PartialMap, robot: Vertex, key: &mut Vec<u32>) -> Self {
        key.clear();
        key.push(robot.0);
        for vertex in map.vertices() {
            key.push(map.degree(vertex));
            key.extend(map.opposites_of(vertex).map(|dart| dart.0));
        }
        Self::BetweenRounds
    }

    pub(crate) fn within_round(hypotheses: &[Dart], key: &mut Vec<u32>) -> Self {
        key.clear();
        key.extend(hypotheses.iter().map(|hypothesis| hypothesis.0));
        Self::WithinRound
    }
}

/// The names of an explorer, and the order of its cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExplorerInfo {
    /// Its name in options and logs.
    pub option: &'static str,
    /// Its name in reports.
    pub title: &'static str,
    /// Its name in a sentence.
    pub in_words: &'static str,
    pub order: CostOrder,
}

crate::words! {
    /// The order of a cost in the numbers of edges, `m`, and vertices, `n`.
    CostOrder {
        EdgesVertices = "m n",
        EdgesSquaredVertices = "m^2 n",
    }
}

impl CostOrder {
    /// Its value for a world of this size.
    pub fn value(self, edges: f64, vertices: f64) -> f64 {
        match self {
            Self::EdgesVertices => edges * vertices,
            Self::EdgesSquaredVertices => edges * edges * vertices,
        }
    }
}

/// Maps a world with the default choices. At its start the robot stands where the marker is placed, with its back
/// to the facing door. Afterwards the explorer holds the map, the robot's pose in it and the number of moves.
///
/// # Errors
/// See [`Explorer`].
pub fn explore<E: Explorer, W: ObservedWorld>(explorer: &mut E, world: &mut W) -> Mapped<W> {
    explore_with(explorer, world, E::choose)
}

/// Does the same as [`explore`], with other choices.
///
/// # Errors
/// See [`Explorer`].
pub fn explore_with<E: Explorer, W: ObservedWorld>(
    explorer: &mut E,
    world: &mut W,
    mut choose: impl FnMut(&mut E) -> Result<Option<E::Choice>, InvalidStep>,
) -> Mapped<W> {
    explorer.begin(world)?;
    while let Some(choice) = choose(explorer)? {
        explorer.step(choice, world)?;
    }
    Ok(())
}
