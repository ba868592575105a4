//! Explorers that run in steps.

use crate::{
    check::{
        Algorithm, Algorithm1, DEFAULT_MOVE_BOUND, ExploredMap, Explorer, ExplorerWorld, Flaw,
        Folding, MovableMarker, judge::explored,
    },
    clone_in_place::clone_in_place,
    embedded_graph::Dart,
    mapping::{
        Exploration, FoldingExploration, FoldingStep, InvalidStep, MappingChoice, MappingError,
        MarkerSearch, Nearest, explore_edge, step,
    },
    marker::{Directional, Marker, Movable},
    world::{MovableMarkerWorld, RefusedAction, World},
};

/// Whether a run goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepProgress {
    /// There is another step.
    GoesOn,
    /// The run has ended, and the map is there.
    Done,
}

/// An explorer whose run is a sequence of steps, and whose state can be cloned between two of them.
///
/// The [lazy sweep](super::LazySweep) clones it where the world can go on in more than one way. It repeats
/// the step in which that happens, so short steps share more: at best, a step takes one door whose other end
/// is not known, as its first move. An explorer that makes its whole run in one step shares nothing.
///
/// What it does must depend on its state, the percepts and the refusals alone. `clone_from` is called for each
/// run; an implementation that reuses memory is faster.
pub trait StepExplorer: Clone {
    /// The kind of marker with which it explores.
    type Marker: Marker;

    /// The marker with which it explores.
    fn marker(&self) -> Self::Marker;

    /// Begins a run in another world. At its start the robot stands where the marker is placed, with its
    /// back to the facing door. The world has at most `max_darts` darts.
    ///
    /// # Errors
    /// Returns the explorer's own failure, or the world's refusal of a move.
    fn begin<W: MovableMarkerWorld<Error = RefusedAction>>(
        &mut self,
        world: &mut W,
        max_darts: usize,
    ) -> Result<StepProgress, Flaw>;

    /// Makes the next step.
    ///
    /// # Errors
    /// Returns the explorer's own failure, or the world's refusal of a move.
    fn step<W: MovableMarkerWorld<Error = RefusedAction>>(
        &mut self,
        world: &mut W,
    ) -> Result<StepProgress, Flaw>;

    /// The map at the end of a run.
    ///
    /// # Errors
    /// Returns a flaw if there is none.
    fn explored(&self) -> Result<ExploredMap<'_>, Flaw>;

    /// The most moves that it may make in a world of this size.
    fn move_bound(&self, _edges: usize, _vertices: usize) -> u64 {
        DEFAULT_MOVE_BOUND
    }
}

/// A [`StepExplorer`] as an [`Explorer`], for one world after the other.
#[derive(Clone, Debug)]
pub struct Stepwise<E>(pub E);

impl<E: StepExplorer> Explorer for Stepwise<E> {
    type Marker = E::Marker;

    fn marker(&self) -> E::Marker {
        self.0.marker()
    }

    fn explore(&mut self, world: &mut ExplorerWorld<E::Marker>) -> Result<ExploredMap<'_>, Flaw> {
        let darts = world.dart_count();
        let mut progress = self.0.begin(world, darts)?;
        while progress == StepProgress::GoesOn {
            progress = self.0.step(world)?;
        }
        self.0.explored()
    }

    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        self.0.move_bound(edges, vertices)
    }
}

/// Algorithm 1 with the default choices, as a [`StepExplorer`]. Between two steps it has made its next choice, and
/// is at the known end of the edge if that is one.
#[derive(Debug)]
pub struct Algorithm1Explorer {
    exploration: Exploration,
    next: Option<MappingChoice>,
}
clone_in_place!(Algorithm1Explorer { exploration, next });

impl Default for Algorithm1Explorer {
    fn default() -> Self {
        Self { exploration: Exploration::new(0), next: None }
    }
}

impl Algorithm1Explorer {
    fn choose<W: World<Error = RefusedAction>>(
        &mut self,
        world: &mut W,
    ) -> Result<StepProgress, Flaw> {
        self.next = self.exploration.choose(&mut Nearest);
        if let Some(MappingChoice::Edge(edge)) = self.next {
            self.exploration.approach(edge, world, &mut ())?;
        }
        Ok(if self.next.is_some() { StepProgress::GoesOn } else { StepProgress::Done })
    }
}

impl StepExplorer for Algorithm1Explorer {
    type Marker = Directional;

    fn marker(&self) -> Directional {
        Directional
    }

    fn begin<W: MovableMarkerWorld<Error = RefusedAction>>(
        &mut self,
        world: &mut W,
        max_darts: usize,
    ) -> Result<StepProgress, Flaw> {
        self.exploration.set_bound(max_darts);
        self.exploration.begin(world, &mut ())?;
        self.choose(world)
    }

    #[inline]
    fn step<W: MovableMarkerWorld<Error = RefusedAction>>(
        &mut self,
        world: &mut W,
    ) -> Result<StepProgress, Flaw> {
        if let Some(choice) = self.next {
            step(&mut self.exploration, choice, world, &mut ())?;
        }
        self.choose(world)
    }

    fn explored(&self) -> Result<ExploredMap<'_>, Flaw> {
        explored(&self.exploration)
    }

    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        Algorithm1.move_bound(edges, vertices)
    }
}

/// The movable marker algorithm with the default choices, as a [`StepExplorer`]. Between two steps it is at the
/// known end of an unexplored edge.
#[derive(Debug)]
pub struct MovableMarkerExplorer {
    search: MarkerSearch,
    edge: Option<Dart>,
}
clone_in_place!(MovableMarkerExplorer { search, edge });

impl Default for MovableMarkerExplorer {
    fn default() -> Self {
        Self { search: MarkerSearch::new(0), edge: None }
    }
}

impl MovableMarkerExplorer {
    fn choose<W: MovableMarkerWorld<Error = RefusedAction>>(
        &mut self,
        world: &mut W,
    ) -> Result<StepProgress, Flaw> {
        self.edge = self.search.choose_edge(&mut Nearest);
        let Some(edge) = self.edge else { return Ok(StepProgress::Done) };
        self.search.travel_to(self.search.map().vertex(edge), world, &mut ())?;
        Ok(StepProgress::GoesOn)
    }
}

impl StepExplorer for MovableMarkerExplorer {
    type Marker = Movable;

    fn marker(&self) -> Movable {
        Movable
    }

    fn begin<W: MovableMarkerWorld<Error = RefusedAction>>(
        &mut self,
        world: &mut W,
        max_darts: usize,
    ) -> Result<StepProgress, Flaw> {
        self.search.set_bound(max_darts);
        self.search.begin(world, &mut ())?;
        self.choose(world)
    }

    fn step<W: MovableMarkerWorld<Error = RefusedAction>>(
        &mut self,
        world: &mut W,
    ) -> Result<StepProgress, Flaw> {
        if let Some(edge) = self.edge {
            explore_edge(edge, &mut self.search, world, &mut ())?;
        }
        self.choose(world)
    }

    fn explored(&self) -> Result<ExploredMap<'_>, Flaw> {
        explored(&self.search)
    }

    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        MovableMarker.move_bound(edges, vertices)
    }
}

/// The folding explorer as a [`StepExplorer`]. Between two steps it is at the open dart that it takes next.
#[derive(Debug)]
pub struct FoldingStepExplorer {
    exploration: FoldingExploration,
    next: Option<FoldingStep>,
}
clone_in_place!(FoldingStepExplorer { exploration, next });

impl Default for FoldingStepExplorer {
    fn default() -> Self {
        Self { exploration: FoldingExploration::new(0), next: None }
    }
}

impl FoldingStepExplorer {
    fn choose<W: World<Error = RefusedAction>>(
        &mut self,
        world: &mut W,
    ) -> Result<StepProgress, Flaw> {
        self.next = self.exploration.next_step();
        match self.next {
            Some(step) => {
                self.exploration.approach(step, world, &mut ())?;
                Ok(StepProgress::GoesOn)
            }
            None if self.exploration.is_complete() => Ok(StepProgress::Done),
            None => Err(MappingError::from(InvalidStep::NoPlan).into()),
        }
    }
}

impl StepExplorer for FoldingStepExplorer {
    type Marker = Directional;

    fn marker(&self) -> Directional {
        Directional
    }

    fn begin<W: MovableMarkerWorld<Error = RefusedAction>>(
        &mut self,
        world: &mut W,
        max_darts: usize,
    ) -> Result<StepProgress, Flaw> {
        self.exploration.set_bound(max_darts);
        self.exploration.begin(world, &mut ())?;
        self.choose(world)
    }

    fn step<W: MovableMarkerWorld<Error = RefusedAction>>(
        &mut self,
        world: &mut W,
    ) -> Result<StepProgress, Flaw> {
        if let Some(step) = self.next {
            self.exploration.make_step(step, world, &mut ())?;
        }
        self.choose(world)
    }

    fn explored(&self) -> Result<ExploredMap<'_>, Flaw> {
        explored(&self.exploration)
    }

    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        Folding.move_bound(edges, vertices)
    }
}
