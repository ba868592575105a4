//! The folding explorer: mapping with a directional marker, in fewer moves than Algorithm 1.
//!
//! It ends when no dart of the [folded trail](crate::folding) is open, and the folded trail is then the
//! world. The map is the *core*: places that are pairwise distinct. A *pending* place is behind an unexplored dart of
//! the map. A *hypothesis* is that a pending place is entered by a certain unexplored dart. It is alive
//! as long as the trail with the two poses united does not contradict itself.
//!
//! If the robot [senses](crate::world::World::senses) more than its percepts, a hypothesis also contradicts itself where lengths or
//! directions differ, and a test ends there. All choices are the same.
//!
//! Of open darts and pending places equally near, the one of the lowest dart of the map comes first; of tests of equal
//! cost, the one whose hypothesis is nearest to the marker, then with the nearest open dart, then with the lowest
//! hypothesis, then with the open dart that was seen first. No [`InjectedFlaw`] is present outside of tests.

mod marker_walk;
mod recovery;
mod settle;
mod steps;
mod walk;
mod walks;
mod ways;
mod with_movable;

use std::cmp::Reverse;

use super::{
    Contradiction, CostOrder, Explorer, ExplorerInfo, InvalidStep, MapDart, MapWalk, Mapped,
    MappingError, ObservedWorld, StepPurpose, map_walk::has_walk, tree::BreadthFirstTree,
};
use crate::{
    clone_in_place::clone_in_place,
    embedded_graph::Dart,
    folding::FoldedTrail,
    injected_flaw::InjectedFlaw,
    marker::DirectionalMarker,
    percept::{Door, Sighting},
};
pub(crate) use recovery::map_with_recovery;
pub use recovery::{MappedWorld, RecoveryConfig, Relocate};
use settle::Hypotheses;
pub use walks::{ArrivalMeasurement, EarlierWalk};
use ways::Ways;
pub use with_movable::{WithMovableRun, WithMovableStep};

/// What the robot does next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FoldingStep {
    /// It goes to an unexplored dart of the map that is open, and takes it.
    Explore(Dart),
    Test(HypothesisTest),
}

/// A walk that confirms a hypothesis if it ends at the marker as expected. Less is made first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct HypothesisTest {
    pub cost: usize,
    /// The moves from the place of the hypothesis to the marker, through the map.
    distance: u32,
    /// The moves to the dart that is taken. The rest of the way is through the map.
    approach: usize,
    /// The dart of the map by which the pending place is entered, if the hypothesis is true.
    pub hypothesis: Dart,
    /// The dart of the trail that is taken. It is open, unless the test is strict.
    open: Dart,
    pub edge: Dart,
    /// The dart of the map by which the robot then comes in, if the hypothesis is true.
    entry: Dart,
}

/// A pending place: the far end of an edge of the map that is not known to be a place of the map.
#[derive(Clone, Copy, Debug)]
struct Pending {
    edge: Dart,
    /// The pose behind it, a dart of the trail.
    far: Dart,
    /// Whether the place [is a leaf](FoldedTrail::is_leaf): the robot has only looked at it.
    is_leaf: bool,
}

/// The state of a run of the folding explorer. Memory is reused from run to run.
///
/// It is a plain value. To try every choice, clone it together with the world between two steps.
#[derive(Debug, Default)]
pub struct FoldingRun {
    /// Whether it only makes strict tests.
    strict: bool,
    walk: MapWalk,
    trail: FoldedTrail,
    /// Each dart of the map, as a dart of the trail.
    in_trail: Vec<Dart>,
    unexplored: Vec<Dart>,
    /// Those of them that are open.
    open: Vec<Dart>,
    pending: Vec<Pending>,
    hypotheses: Hypotheses,
    to_marker: BreadthFirstTree,
    /// Whether `to_marker` fits the present map.
    to_marker_is_current: bool,
    from_robot: Ways,
    /// Scratch: the tests of one pending place.
    tests: Vec<Reverse<HypothesisTest>>,
    /// Scratch: the darts on the way to somewhere known.
    way: Vec<Dart>,
}

clone_in_place!(FoldingRun {
    strict,
    walk,
    trail,
    in_trail,
    unexplored,
    open,
    pending,
    hypotheses,
    to_marker,
    to_marker_is_current,
    from_robot;
    scratch tests, way
});

has_walk!(FoldingRun);

impl FoldingRun {
    /// An exploration that only makes strict tests: over the edge to the place itself, and along the whole way to the
    /// marker, as Algorithm 1 does. It needs more moves.
    pub fn strict() -> Self {
        Self { strict: true, ..Self::default() }
    }

    /// Whether the map is the world.
    pub fn is_complete(&self) -> bool {
        self.trail.is_complete() && self.map().complete().is_some()
    }

    /// Begins a run after some moves that were made before.
    pub(super) fn begin_after<W: ObservedWorld>(&mut self, moves: u64, world: &mut W) -> Mapped<W> {
        self.clear();
        self.walk.set_moves(moves);
        let percept = world.percept().map_err(MappingError::World)?;
        if percept.degree == 0 || percept.sighting != Sighting::Pointing(Door::BACK) {
            return Err(Contradiction::Start { perceived: percept }.into());
        }
        self.walk.begin(percept, world)?;
        self.trail.restart(percept)?;
        self.sense(world)?;
        self.put_in_map(self.trail.pose());
        self.settle(world)
    }

    pub(crate) fn clear(&mut self) {
        self.walk.clear();
        self.in_trail.clear();
        self.unexplored.clear();
        self.open.clear();
        self.pending.clear();
        self.hypotheses.clear();
        self.from_robot.clear();
        self.to_marker_is_current = false;
    }
}

/// The folding explorer. Its default choices break every tie. The map is complete when its trail is
/// [complete](FoldedTrail::is_complete); the trail has at most [`MAX_DARTS`](crate::folding::MAX_DARTS) darts.
impl Explorer for FoldingRun {
    type Aid = DirectionalMarker;
    type Choice = FoldingStep;

    fn info(&self) -> ExplorerInfo {
        ExplorerInfo {
            option: "folding",
            title: "Folding explorer",
            in_words: "the folding explorer",
            order: CostOrder::EdgesSquaredVertices,
        }
    }

    fn aid(&self) -> DirectionalMarker {
        DirectionalMarker
    }

    fn limit_darts(&mut self, max_darts: usize) {
        self.walk.set_bound(max_darts);
    }

    fn begin<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        self.begin_after(0, world)
    }

    fn choose(&mut self) -> Result<Option<FoldingStep>, InvalidStep> {
        match self.next_step() {
            None if !self.is_complete() => Err(InvalidStep::NoPlan),
            next => Ok(next),
        }
    }

    fn add_choices(&mut self, choices: &mut Vec<FoldingStep>) -> Result<(), InvalidStep> {
        choices.extend(self.open_steps());
        Ok(())
    }

    /// Goes through the trail to the open dart that the step takes.
    fn approach<W: ObservedWorld>(&mut self, step: FoldingStep, world: &mut W) -> Mapped<W> {
        let open = match step {
            FoldingStep::Explore(edge) => self.in_trail[edge.at()],
            FoldingStep::Test(test) => test.open,
        };
        self.go_to(open, world)
    }

    fn step<W: ObservedWorld>(&mut self, step: FoldingStep, world: &mut W) -> Mapped<W> {
        match step {
            FoldingStep::Explore(edge) => self.explore(edge, world)?,
            FoldingStep::Test(test) if InjectedFlaw::NotTested.is_present() => {
                self.believe(test)?;
            }
            FoldingStep::Test(test) => self.test(test, world)?,
        }
        self.settle(world)
    }

    fn map_walk(&self) -> Option<&MapWalk> {
        Some(&self.walk)
    }

    fn purpose(&self, step: Option<FoldingStep>) -> StepPurpose {
        let named = |dart| MapDart::new(self.map(), dart);
        match step {
            None => StepPurpose::NoOpenDart,
            Some(FoldingStep::Explore(edge)) => StepPurpose::ExploreOpen(named(edge)),
            Some(FoldingStep::Test(test)) => {
                StepPurpose::Test { edge: named(test.edge), hypothesis: named(test.hypothesis) }
            }
        }
    }

    /// `6 n m^2 + 18 n m + 2 m + 2 n + 802`, as is proved in Coq: `folding_explorer_cost`.
    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        let (m, n) = (edges as u64, vertices as u64);
        let nm = n.saturating_mul(m);
        let terms = [(6, nm.saturating_mul(m)), (18, nm), (2, m), (2, n), (802, 1)];
        terms
            .into_iter()
            .fold(0, |sum, (times, term)| sum.saturating_add(term.saturating_mul(times)))
    }
}

#[cfg(test)]
mod tests;
