//! The robot's walk: the part of the state, and the steps, that the mapping algorithms share. Section 2.3.

use std::mem;

use super::{
    Contradiction, FACING, InvalidStep, MapDart, MappingError, MappingEvent, PartialMap, Relocate,
    StepPurpose, folding_explorer::ArrivalMeasurement, partial_map::START, tree::BreadthFirstTree,
};
use crate::{
    aid::Aid,
    clone_in_place::clone_in_place,
    embedded_graph::{Dart, MAX_EDGES, Vertex},
    folding::ArrivalSenses,
    percept::{Door, Percept, Sighting, TwoMarkersView},
    world::{AidHandler, GraphWorld, SensingWorld, World},
};

/// The default bound on known darts. A run in a world with more than 8,000 edges, or with infinitely
/// many, ends with an error.
pub const DEFAULT_DART_BOUND: usize = 1 << 14;

/// The result of steps in a world.
pub type Mapped<W, T = ()> = Result<T, MappingError<<W as World>::Error>>;

/// Observes a run in a world `W`.
///
/// It also gets the world, so that an observer inside the world needs no shared ownership.
pub trait Observer<W: ?Sized> {
    /// Called after each event. The walk is as it is afterwards, except that at
    /// [`MappingEvent::Moved`] the robot's pose in the map is still that before the move.
    fn event(&mut self, world: &mut W, walk: &MapWalk, event: MappingEvent);
}

impl<W: ?Sized, F: FnMut(&mut W, &MapWalk, MappingEvent)> Observer<W> for F {
    fn event(&mut self, world: &mut W, walk: &MapWalk, event: MappingEvent) {
        self(world, walk, event);
    }
}

/// Ignores every event.
impl<W: ?Sized> Observer<W> for () {
    #[inline]
    fn event(&mut self, _: &mut W, _: &MapWalk, _: MappingEvent) {}
}

/// A world in which explorers run. It gets the events of the run, and ignores them by default.
pub trait ObservedWorld: World {
    /// See [`Observer::event`].
    #[inline]
    fn event(&mut self, _walk: &MapWalk, _event: MappingEvent) {}
}

impl<A: Aid> ObservedWorld for GraphWorld<'_, A> {}

impl<W: ObservedWorld, S: FnMut(&W) -> ArrivalSenses> ObservedWorld for SensingWorld<W, S> {
    fn event(&mut self, walk: &MapWalk, event: MappingEvent) {
        self.world_mut().event(walk, event);
    }
}

/// A world with an observer.
#[derive(Debug)]
pub struct Observed<'a, W, O> {
    world: &'a mut W,
    observer: &'a mut O,
}

impl<'a, W: World, O: Observer<W>> Observed<'a, W, O> {
    pub fn new(world: &'a mut W, observer: &'a mut O) -> Self {
        Self { world, observer }
    }
}

impl<W: World, O: Observer<W>> World for Observed<'_, W, O> {
    type Error = W::Error;

    #[inline]
    fn percept(&mut self) -> Result<Percept, W::Error> {
        self.world.percept()
    }

    #[inline]
    fn traverse(&mut self, door: Door) -> Result<(), W::Error> {
        self.world.traverse(door)
    }

    fn handler(&mut self) -> Option<&mut dyn AidHandler<Error = W::Error>> {
        self.world.handler()
    }

    fn senses(&mut self) -> ArrivalSenses {
        self.world.senses()
    }
}

impl<W: World, O: Observer<W>> ObservedWorld for Observed<'_, W, O> {
    #[inline]
    fn event(&mut self, walk: &MapWalk, event: MappingEvent) {
        self.observer.event(self.world, walk, event);
    }
}

impl<W: Relocate, O: Observer<W>> Relocate for Observed<'_, W, O> {
    fn relocate(&mut self, error: W::Error) -> Result<(), W::Error> {
        self.world.relocate(error)
    }

    fn measured(&self) -> ArrivalMeasurement {
        self.world.measured()
    }

    fn is_blocked(&self) -> bool {
        self.world.is_blocked()
    }
}

/// The robot's map, its pose in the map and its moves.
#[derive(Debug)]
pub struct MapWalk {
    bound: usize,
    moves: u64,
    pub(super) map: PartialMap,
    /// The dart of the map by which the robot came in; if its place is not known, the last known pose.
    pub(super) robot: Dart,
    /// The known end of the edge that is being explored; none between two rounds.
    pub(super) edge: Option<Dart>,
    pub(super) arrival: Percept,
    /// The tree of the map from the start vertex; none after a change of the map that it does not survive.
    pub(super) from_start: BreadthFirstTree,
    /// Scratch: the tree of the map from another vertex.
    pub(super) from_robot: BreadthFirstTree,
    /// Scratch: the darts on the way to somewhere known.
    pub(super) way: Vec<Dart>,
}

clone_in_place!(MapWalk {
    bound,
    moves,
    map,
    robot,
    edge,
    arrival,
    from_start;
    scratch from_robot, way
});

pub(super) const NO_PERCEPT: Percept = Percept { degree: 0, sighting: Sighting::Nothing };

impl Default for MapWalk {
    fn default() -> Self {
        Self::new(DEFAULT_DART_BOUND)
    }
}

impl MapWalk {
    pub(super) fn new(bound: usize) -> Self {
        Self {
            bound: bound.min(2 * MAX_EDGES),
            moves: 0,
            map: PartialMap::new(),
            robot: FACING,
            edge: None,
            arrival: NO_PERCEPT,
            from_start: BreadthFirstTree::default(),
            from_robot: BreadthFirstTree::default(),
            way: Vec::new(),
        }
    }

    pub(super) fn set_bound(&mut self, bound: usize) {
        self.bound = bound.min(2 * MAX_EDGES);
    }

    /// The map S, with the unexplored edges U.
    #[inline]
    pub fn map(&self) -> &PartialMap {
        &self.map
    }

    /// The robot's pose in the map: the dart by which it came in. If its place is not known, the last
    /// known pose.
    // paper: alg1.located
    #[inline]
    pub fn robot(&self) -> Dart {
        self.robot
    }

    /// The moves made so far.
    // paper: cost.moves, cost.lower-bound
    #[inline]
    pub fn moves(&self) -> u64 {
        self.moves
    }

    pub(super) fn set_moves(&mut self, moves: u64) {
        self.moves = moves;
    }

    pub(super) fn clear(&mut self) {
        self.moves = 0;
        self.map.clear();
        self.robot = FACING;
        self.edge = None;
        self.from_start.clear();
        self.from_robot.clear();
    }

    /// S is the start vertex, and U is its edges.
    pub(super) fn begin<W: ObservedWorld>(
        &mut self,
        percept: Percept,
        world: &mut W,
    ) -> Mapped<W, Vertex> {
        self.check_bound(percept.degree)?;
        let start = self.map.add_vertex(percept.degree);
        world.event(self, MappingEvent::Started { percept });
        Ok(start)
    }

    /// The default choice of line 5: the unexplored dart that is fewest hops from the robot; then of the vertex
    /// discovered first; then with the lowest index. `None` if everything is explored.
    // paper: cost.cycle, cost.chain
    pub(super) fn nearest_unexplored(&mut self) -> Option<Dart> {
        self.nearest_unexplored_from(self.robot, |_| true)
    }

    /// Of the unexplored darts that are open, the one that is fewest hops from a pose, as in
    /// [`nearest_unexplored`](Self::nearest_unexplored).
    pub(super) fn nearest_unexplored_from(
        &mut self,
        pose: Dart,
        is_open: impl Fn(Dart) -> bool,
    ) -> Option<Dart> {
        if self.map.unexplored_is_empty() {
            return None;
        }
        let here = self.map.vertex(pose);
        // Often it is at the robot's own vertex, and no tree is needed.
        let is_here = |dart: &Dart| self.map.vertex(*dart) == here;
        if let Some(dart) = self.map.unexplored().filter(is_here).find(|dart| is_open(*dart)) {
            return Some(dart);
        }
        let (map, tree) = self.tree_from(here);
        tree.nearest_unexplored(map, is_open)
    }

    /// The map, and its tree from a vertex.
    fn tree_from(&mut self, root: Vertex) -> (&PartialMap, &BreadthFirstTree) {
        let Self { map, from_start, from_robot, .. } = self;
        let tree = if root == START { from_start } else { from_robot };
        tree.grow_from_unless_rooted(map, root);
        (map, tree)
    }

    /// Goes through the known map to the known end of an unexplored edge, and follows it to its
    /// unknown end.
    #[inline]
    pub(super) fn explore<W: ObservedWorld>(
        &mut self,
        edge: Dart,
        expected: impl Fn(&PartialMap, Dart) -> Percept,
        world: &mut W,
    ) -> Mapped<W> {
        if let Some(explored) = self.edge {
            return Err(InvalidStep::EdgeInProgress(explored).into());
        }
        if !self.map.is_unexplored(edge) {
            return Err(InvalidStep::NotUnexplored(edge).into());
        }
        self.go_over(edge, expected, world)
    }

    /// Goes to the known end of the edge that is being explored or is to be, and over it.
    #[inline]
    pub(super) fn go_over<W: ObservedWorld>(
        &mut self,
        edge: Dart,
        expected: impl Fn(&PartialMap, Dart) -> Percept,
        world: &mut W,
    ) -> Mapped<W> {
        self.travel_to(self.map.vertex(edge), expected, world)?;
        self.arrival = self.go(self.map.door(self.robot, edge), world)?;
        self.edge = Some(edge);
        Ok(())
    }

    /// Goes through the known map to a vertex; each place on the way must be as expected.
    #[inline]
    pub(super) fn travel_to<W: ObservedWorld>(
        &mut self,
        target: Vertex,
        expected: impl Fn(&PartialMap, Dart) -> Percept,
        world: &mut W,
    ) -> Mapped<W> {
        // Often the robot is there. Only this part is inlined.
        if self.map.vertex(self.robot) == target {
            return Ok(());
        }
        self.travel(target, expected, world)
    }

    #[inline(never)]
    fn travel<W: ObservedWorld>(
        &mut self,
        target: Vertex,
        expected: impl Fn(&PartialMap, Dart) -> Percept,
        world: &mut W,
    ) -> Mapped<W> {
        let way = self.way_to(target);
        for &dart in &way {
            let Some((next, perceived)) = self.leave_by(dart, world)? else { break };
            self.arrive(next, expected(&self.map, next), perceived)?;
        }
        self.way = way;
        Ok(())
    }

    /// The known vertices in the preorder of a tree of shortest paths from the robot: in this order a depth-first walk
    /// meets them.
    pub(super) fn write_preorder(&mut self, order: &mut Vec<Vertex>) {
        self.from_robot.grow_from(&self.map, self.map.vertex(self.robot));
        self.from_robot.preorder(&self.map, order);
    }

    /// The purpose of a step that explores an edge; without one, of the end of the run.
    pub(super) fn purpose(&self, edge: Option<Dart>) -> StepPurpose {
        edge.map_or(StepPurpose::Complete, |edge| {
            StepPurpose::Follow(MapDart::new(&self.map, edge))
        })
    }

    /// The darts of a shortest path from the robot's vertex to a known one.
    pub(super) fn way_to(&mut self, target: Vertex) -> Vec<Dart> {
        let way = mem::take(&mut self.way);
        self.way_between(self.robot, target, way)
    }

    /// The darts of a shortest path from the vertex of a pose to a known one, written over another one.
    pub(super) fn way_between(
        &mut self,
        pose: Dart,
        target: Vertex,
        mut way: Vec<Dart>,
    ) -> Vec<Dart> {
        way.clear();
        let here = self.map.vertex(pose);
        if here != target {
            let (map, tree) = self.tree_from(here);
            tree.path_from_root(map, target, &mut way);
        }
        way
    }

    /// Leaves by an explored dart of the map, and returns the pose behind it and the percept there;
    /// `None`, without a move, if the dart is not explored.
    #[inline]
    pub(super) fn leave_by<W: ObservedWorld>(
        &mut self,
        dart: Dart,
        world: &mut W,
    ) -> Mapped<W, Option<(Dart, Percept)>> {
        let Some(next) = self.map.opposite(dart) else { return Ok(None) };
        Ok(Some((next, self.go(self.map.door(self.robot, dart), world)?)))
    }

    /// The robot has come in by a dart of the map, if the percept is the expected one.
    #[inline]
    pub(super) fn arrive(
        &mut self,
        pose: Dart,
        expected: Percept,
        perceived: Percept,
    ) -> Result<(), Contradiction> {
        if perceived != expected {
            let (vertex, index) = (self.map.vertex(pose), self.map.index(pose));
            return Err(Contradiction::KnownPlace { vertex, index, expected, perceived });
        }
        self.robot = pose;
        Ok(())
    }

    // A check makes billions of moves: a call, with its result in memory, would be most of one.
    #[expect(clippy::inline_always, reason = "see above")]
    #[inline(always)]
    pub(super) fn go<W: ObservedWorld>(&mut self, door: Door, world: &mut W) -> Mapped<W, Percept> {
        world.traverse(door).map_err(MappingError::World)?;
        self.moves += 1;
        let percept = world.percept().map_err(MappingError::World)?;
        let possible = match percept.sighting {
            Sighting::Pointing(door)
            | Sighting::TwoMarkers(TwoMarkersView { along: Some(door), .. }) => {
                door.0 < percept.degree
            }
            _ => percept.degree > 0,
        };
        world.event(self, MappingEvent::Moved { door, percept });
        if possible {
            Ok(percept)
        } else {
            Err(Contradiction::Impossible { perceived: percept }.into())
        }
    }

    /// The edge that is being explored leads to a known vertex, by another unexplored dart. Returns
    /// its known end.
    pub(super) fn close_loop(
        &mut self,
        other: Dart,
        world: &mut impl ObservedWorld,
    ) -> Result<Dart, InvalidStep> {
        let edge = self.edge.ok_or(InvalidStep::NoEdge)?;
        if edge == other || !self.map.is_unexplored(other) {
            return Err(InvalidStep::NotUnexplored(other));
        }
        self.edge = None;
        self.from_robot.clear();
        self.map.join(edge, other);
        if self.from_start.is_grown() && !self.from_start.stays_with(&self.map, edge, other) {
            self.from_start.clear();
        }
        world.event(self, MappingEvent::LoopClosed { edge, other });
        Ok(edge)
    }

    /// The edge that is being explored leads to a new vertex, whose other edges are unexplored. The
    /// robot is still there. `entry` is the door by which it came in last, counted from the dart by
    /// which it first came in.
    pub(super) fn add_place<W: ObservedWorld>(
        &mut self,
        entry: Door,
        world: &mut W,
    ) -> Mapped<W, Vertex> {
        let edge = self.edge.ok_or(InvalidStep::NoEdge)?;
        let vertex = self.add_vertex(edge, self.arrival.degree)?;
        self.edge = None;
        self.robot = Dart(self.map.first_dart(vertex).0 + entry.0);
        world.event(self, MappingEvent::VertexAdded { edge, vertex });
        Ok(vertex)
    }

    /// An unexplored edge leads to a new vertex. The robot is elsewhere.
    pub(super) fn add_place_behind<W: ObservedWorld>(
        &mut self,
        edge: Dart,
        degree: u32,
        world: &mut W,
    ) -> Mapped<W, Vertex> {
        let vertex = self.add_vertex(edge, degree)?;
        world.event(self, MappingEvent::VertexAdded { edge, vertex });
        Ok(vertex)
    }

    fn add_vertex<E>(&mut self, edge: Dart, degree: u32) -> Result<Vertex, MappingError<E>> {
        self.check_bound(degree)?;
        self.from_robot.clear();
        let vertex = self.map.add_vertex(degree);
        self.map.join(edge, self.map.first_dart(vertex));
        if self.from_start.is_grown() {
            self.from_start.add_leaf(&self.map, vertex);
        }
        Ok(vertex)
    }

    pub(super) fn check_bound<E>(&self, degree: u32) -> Result<(), MappingError<E>> {
        let bound = self.bound;
        if self.map.dart_count().saturating_add(degree as usize) > bound {
            return Err(MappingError::Bound { bound });
        }
        Ok(())
    }
}

/// What the states of all runs have: the walk, as parts of it and by itself.
macro_rules! has_walk {
    ($run:ident) => {
        impl From<$run> for $crate::mapping::MapWalk {
            fn from(run: $run) -> Self {
                run.walk
            }
        }

        impl $run {
            /// A state ready for a run that may come to know at most `bound` darts.
            pub fn new(bound: usize) -> Self {
                Self { walk: $crate::mapping::MapWalk::new(bound), ..Self::default() }
            }

            /// The robot's walk: its map, its pose in the map and its moves.
            #[inline]
            pub fn walk(&self) -> &$crate::mapping::MapWalk {
                &self.walk
            }

            #[inline]
            pub fn map(&self) -> &$crate::mapping::PartialMap {
                self.walk.map()
            }

            #[inline]
            pub fn robot(&self) -> $crate::embedded_graph::Dart {
                self.walk.robot()
            }

            #[inline]
            pub fn moves(&self) -> u64 {
                self.walk.moves()
            }
        }
    };
}

pub(super) use has_walk;
