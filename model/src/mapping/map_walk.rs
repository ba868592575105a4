//! The robot's journey: the part of the state, and the steps, that the mapping algorithms share.
//! Section 2.3.

use std::mem;

use super::{
    Choices, Contradiction, FACING, InvalidStep, MappingError, MappingEvent, PartialMap,
    tree::BreadthFirstTree,
};
use crate::{
    clone_in_place::clone_in_place,
    embedded_graph::{Dart, MAX_EDGES, Vertex},
    percept::{Door, Percept, Sighting},
    world::World,
};

/// The default bound on known darts. A run in a world with more than 8,000 edges, or with infinitely
/// many, ends with an error.
pub const DEFAULT_DART_BOUND: usize = 1 << 14;

/// Observes a run in a world `W`.
///
/// It also gets the world, so that an observer inside the world needs no shared ownership.
pub trait Observer<W: ?Sized> {
    /// Called after each event. The journey is as it is afterwards, except that at
    /// [`MappingEvent::Moved`] the robot's pose in the map is still that before the move.
    fn event(&mut self, world: &mut W, journey: &MapWalk, event: MappingEvent);
}

/// Ignores every event.
impl<W: ?Sized> Observer<W> for () {
    #[inline]
    fn event(&mut self, _: &mut W, _: &MapWalk, _: MappingEvent) {}
}

impl<W: ?Sized, F: FnMut(&mut W, &MapWalk, MappingEvent)> Observer<W> for F {
    fn event(&mut self, world: &mut W, journey: &MapWalk, event: MappingEvent) {
        self(world, journey, event);
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
    /// The percept at its unknown end.
    pub(super) arrival: Percept,
    /// A tree of the map that is grown again when it does not fit.
    pub(super) from_robot: BreadthFirstTree,
    /// Scratch: the darts on the way to somewhere known.
    pub(super) way: Vec<Dart>,
}

clone_in_place!(MapWalk { bound, moves, map, robot, edge, arrival; scratch from_robot, way });

pub(super) const NO_PERCEPT: Percept = Percept { degree: 0, sighting: Sighting::Nothing };

impl MapWalk {
    /// A journey with at most `bound` known darts.
    pub(super) fn new(bound: usize) -> Self {
        Self {
            bound: bound.min(2 * MAX_EDGES),
            moves: 0,
            map: PartialMap::new(),
            robot: FACING,
            edge: None,
            arrival: NO_PERCEPT,
            from_robot: BreadthFirstTree::default(),
            way: Vec::new(),
        }
    }

    pub(super) fn set_bound(&mut self, bound: usize) {
        self.bound = bound.min(2 * MAX_EDGES);
    }

    /// The map S, with the unexplored edges U.
    #[inline]
    #[must_use]
    pub fn map(&self) -> &PartialMap {
        &self.map
    }

    /// The robot's pose in the map: the dart by which it came in. If its place is not known, the last
    /// known pose.
    // paper: alg1.located
    #[inline]
    #[must_use]
    pub fn robot(&self) -> Dart {
        self.robot
    }

    /// The moves made so far.
    // paper: cost.moves, cost.lower-bound
    #[inline]
    #[must_use]
    pub fn moves(&self) -> u64 {
        self.moves
    }

    /// Counts on from earlier moves.
    pub(super) fn set_moves(&mut self, moves: u64) {
        self.moves = moves;
    }

    /// Forgets an earlier run.
    pub(super) fn clear(&mut self) {
        self.moves = 0;
        self.map.clear();
        self.robot = FACING;
        self.edge = None;
        self.from_robot.clear();
    }

    /// S is the start vertex, and U is its edges.
    pub(super) fn begin<W: World>(
        &mut self,
        percept: Percept,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<Vertex, MappingError<W::Error>> {
        self.check_bound(percept.degree)?;
        let start = self.map.add_vertex(percept.degree);
        observer.event(world, self, MappingEvent::Started { percept });
        Ok(start)
    }

    /// Makes the choice of line 5; `None` if everything is explored.
    pub(super) fn choose_edge(&mut self, choices: &mut impl Choices) -> Option<Dart> {
        if self.map.unexplored_is_empty() {
            return None;
        }
        let here = self.map.vertex(self.robot);
        // Often it is at the robot's own vertex, and no tree is needed.
        let nearest = if self.map.is_frontier(here) {
            self.map.unexplored_at(here).next()?
        } else {
            self.from_robot.grow_from(&self.map, here);
            self.from_robot.nearest_unexplored(&self.map)?
        };
        Some(choices.next_edge(&self.map, self.robot, nearest))
    }

    /// Goes through the known map to the known end of an unexplored edge, and follows it to its
    /// unknown end.
    #[inline]
    pub(super) fn explore<W: World>(
        &mut self,
        edge: Dart,
        expected: impl Fn(&PartialMap, Dart) -> Percept,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        if let Some(explored) = self.edge {
            return Err(InvalidStep::EdgeInProgress(explored).into());
        }
        if !self.map.is_unexplored(edge) {
            return Err(InvalidStep::NotUnexplored(edge).into());
        }
        self.go_over(edge, expected, world, observer)
    }

    /// Goes to the known end of the edge that is being explored or is to be, and over it.
    #[inline]
    pub(super) fn go_over<W: World>(
        &mut self,
        edge: Dart,
        expected: impl Fn(&PartialMap, Dart) -> Percept,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        self.travel_to(self.map.vertex(edge), expected, world, observer)?;
        self.arrival = self.go(self.map.door(self.robot, edge), world, observer)?;
        self.edge = Some(edge);
        Ok(())
    }

    /// Goes through the known map to a vertex; each place on the way must be as expected.
    #[inline]
    pub(super) fn travel_to<W: World>(
        &mut self,
        target: Vertex,
        expected: impl Fn(&PartialMap, Dart) -> Percept,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        let way = self.way_to(target)?;
        for &dart in &way {
            let Some((next, perceived)) = self.leave_by(dart, world, observer)? else {
                break;
            };
            self.arrive(next, expected(&self.map, next), perceived)?;
        }
        self.way = way;
        Ok(())
    }

    /// The darts of a shortest path from the robot's vertex to a known one.
    pub(super) fn way_to(&mut self, target: Vertex) -> Result<Vec<Dart>, InvalidStep> {
        if target.at() >= self.map.vertex_count() {
            return Err(InvalidStep::UnknownVertex(target));
        }
        let mut way = mem::take(&mut self.way);
        if self.map.vertex(self.robot) == target {
            way.clear();
            return Ok(way);
        }
        self.from_robot.grow_from_unless_rooted(&self.map, self.map.vertex(self.robot));
        self.from_robot.path_from_root(&self.map, target, &mut way);
        Ok(way)
    }

    /// Leaves by an explored dart of the map, and returns the pose behind it and the percept there;
    /// `None`, without a move, if the dart is not explored.
    #[inline]
    pub(super) fn leave_by<W: World>(
        &mut self,
        dart: Dart,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<Option<(Dart, Percept)>, MappingError<W::Error>> {
        let Some(next) = self.map.opposite(dart) else { return Ok(None) };
        let perceived = self.go(self.map.door(self.robot, dart), world, observer)?;
        Ok(Some((next, perceived)))
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

    /// Makes one move, and returns the percept after it.
    // A check makes billions of moves: a call, with its result in memory, would be most of one.
    #[expect(clippy::inline_always, reason = "see above")]
    #[inline(always)]
    pub(super) fn go<W: World>(
        &mut self,
        door: Door,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<Percept, MappingError<W::Error>> {
        world.traverse(door).map_err(MappingError::World)?;
        self.moves += 1;
        let percept = world.percept().map_err(MappingError::World)?;
        let possible = match percept.sighting {
            Sighting::Pointing(door) => door.0 < percept.degree,
            _ => percept.degree > 0,
        };
        observer.event(world, self, MappingEvent::Moved { door, percept });
        if possible {
            Ok(percept)
        } else {
            Err(Contradiction::Impossible { perceived: percept }.into())
        }
    }

    /// The edge that is being explored leads to a known vertex, by another unexplored dart. Returns
    /// its known end.
    pub(super) fn close_loop<W: ?Sized>(
        &mut self,
        other: Dart,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<Dart, InvalidStep> {
        let edge = self.edge.ok_or(InvalidStep::NoEdge)?;
        if edge == other {
            return Err(InvalidStep::SameDart(edge));
        }
        if !self.map.is_unexplored(other) {
            return Err(InvalidStep::NotUnexplored(other));
        }
        self.edge = None;
        self.from_robot.clear();
        self.map.join(edge, other);
        observer.event(world, self, MappingEvent::LoopClosed { edge, other });
        Ok(edge)
    }

    /// The edge that is being explored leads to a new vertex, whose other edges are unexplored. The
    /// robot is still there. `entry` is the door by which it came in last, counted from the dart by
    /// which it first came in.
    pub(super) fn add_place<W: World>(
        &mut self,
        entry: Door,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<Vertex, MappingError<W::Error>> {
        let edge = self.edge.ok_or(InvalidStep::NoEdge)?;
        self.check_bound(self.arrival.degree)?;
        self.edge = None;
        self.from_robot.clear();
        let vertex = self.map.add_vertex(self.arrival.degree);
        let first = self.map.first_dart(vertex);
        self.map.join(edge, first);
        self.robot = Dart(first.0 + entry.0);
        observer.event(world, self, MappingEvent::VertexAdded { edge, vertex });
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

/// What the states of all runs have: the journey, as parts of it and by itself.
macro_rules! has_walk {
    ($run:ident) => {
        impl Default for $run {
            fn default() -> Self {
                Self::new($crate::mapping::DEFAULT_DART_BOUND)
            }
        }

        impl From<$run> for $crate::mapping::MapWalk {
            fn from(run: $run) -> Self {
                run.journey
            }
        }

        impl $run {
            /// Sets the bound on the darts of the map for later runs.
            pub fn set_bound(&mut self, bound: usize) {
                self.journey.set_bound(bound);
            }

            /// The robot's journey: its map, its pose in the map and its moves.
            #[inline]
            #[must_use]
            pub fn walk(&self) -> &$crate::mapping::MapWalk {
                &self.journey
            }

            /// The map S, with the unexplored edges U.
            #[inline]
            #[must_use]
            pub fn map(&self) -> &$crate::mapping::PartialMap {
                self.journey.map()
            }

            /// The robot's pose in the map: the dart by which it came in. Where its place is not known, the last known
            /// pose.
            #[inline]
            #[must_use]
            pub fn robot(&self) -> $crate::embedded_graph::Dart {
                self.journey.robot()
            }

            /// The moves made so far.
            #[inline]
            #[must_use]
            pub fn moves(&self) -> u64 {
                self.journey.moves()
            }
        }
    };
}

pub(super) use has_walk;
