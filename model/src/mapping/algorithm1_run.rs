//! The state of Algorithm 1, and the small steps that it consists of. Section 2.3.
//!
//! It is a plain value. To try every choice, clone it together with the world where the run waits
//! for one: at line 4 or at line 8. Memory is reused from run to run.

use std::{cmp::Reverse, mem};

use super::{
    Choices, Contradiction, InvalidStep, MapWalk, MappingChoice, MappingError, MappingEvent,
    Observer, PartialMap,
    map_walk::{NO_PERCEPT, has_walk},
    partial_map::START,
    tree::BreadthFirstTree,
};
use crate::{
    clone_in_place::clone_in_place,
    embedded_graph::Dart,
    percept::{Door, Percept, Sighting, retrace},
    world::World,
};

/// The state of a run of Algorithm 1: the robot's journey, and the hypotheses about its place.
#[derive(Debug)]
pub struct Algorithm1Run {
    journey: MapWalk,
    current: CurrentVertex,
    /// H, from the farthest to the nearest.
    hypotheses: Vec<Dart>,
    /// Within a step: the percept at each vertex since the path began, and the door taken there.
    trail: Vec<(Percept, Door)>,
    /// The tree of the map from the marker; none after a change of the map that it does not survive.
    to_marker: BreadthFirstTree,
}

clone_in_place!(Algorithm1Run { journey, current, hypotheses, to_marker; scratch trail });

/// The robot at its vertex.
#[derive(Clone, Copy, Debug)]
struct CurrentVertex {
    /// Its percept, with doors counted from its reference dart.
    percept: Percept,
    /// The door, counted from the reference dart, by which it really came in. It differs from
    /// [`Door::BACK`] after a rejected hypothesis.
    entry: Door,
}

has_walk!(Algorithm1Run);

impl Algorithm1Run {
    /// A state ready for a run that may come to know at most `bound` darts.
    #[must_use]
    pub fn new(bound: usize) -> Self {
        Self {
            journey: MapWalk::new(bound),
            current: CurrentVertex { percept: NO_PERCEPT, entry: Door::BACK },
            hypotheses: Vec::new(),
            trail: Vec::new(),
            to_marker: BreadthFirstTree::default(),
        }
    }

    /// At line 8: the hypotheses that are left, each the unexplored dart by which the robot would
    /// have come in, from the farthest from the marker to the nearest.
    #[must_use]
    pub fn hypotheses(&self) -> &[Dart] {
        &self.hypotheses
    }

    /// Lines 1 to 3: the directional marker lies at v0, S is v0, and U is its edges.
    ///
    /// # Errors
    /// Returns an error if the world does, if the marker is not seen as required, or at the bound.
    // paper: alg1.1, alg1.2, alg1.3
    pub(super) fn find_start<W: World>(
        &mut self,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        self.journey.clear();
        self.set_percept(NO_PERCEPT);
        self.hypotheses.clear();
        self.trail.clear();
        self.to_marker.clear();
        let percept = world.percept().map_err(MappingError::World)?;
        if percept.degree == 0 || percept.sighting != Sighting::Pointing(Door::BACK) {
            return Err(Contradiction::Start { perceived: percept }.into());
        }
        let start = self.journey.begin(percept, world, observer)?;
        self.set_percept(percept);
        self.to_marker.grow_from(self.journey.map(), start);
        Ok(())
    }

    /// Whether the run waits at line 8, for a hypothesis, and not at line 4, for an edge.
    #[must_use]
    pub fn is_at_line_8(&self) -> bool {
        self.journey.edge.is_some()
    }

    /// The open choices: the run waits for one of them. There is none when the map is complete.
    pub fn open_choices(&self) -> impl DoubleEndedIterator<Item = MappingChoice> + use<> {
        let edges =
            if self.is_at_line_8() { Vec::new() } else { self.map().unexplored().collect() };
        let hypotheses = 0..if self.is_at_line_8() { self.hypotheses.len() } else { 0 };
        let edges = edges.into_iter().map(MappingChoice::Edge);
        edges.chain(hypotheses.map(MappingChoice::Hypothesis))
    }

    /// Lines 4 and 8: the choice to go on with; `None` when the map is complete.
    // paper: alg1.5
    #[inline]
    pub fn choose_with(&mut self, choices: &mut impl Choices) -> Option<MappingChoice> {
        if !self.is_at_line_8() {
            return self.journey.choose_edge(choices).map(MappingChoice::Edge);
        }
        if self.hypotheses.is_empty() {
            return None;
        }
        let chosen = choices.next_hypothesis(self.journey.map(), &self.hypotheses);
        Some(MappingChoice::Hypothesis(chosen))
    }

    /// The first part of line 6: goes through the known map to the known end of an unexplored edge. To
    /// [`explore`](Self::explore) it then takes one move.
    ///
    /// # Errors
    /// Returns an error if the world does, or if a known place is not as it was.
    pub fn go_to_known_end<W: World>(
        &mut self,
        edge: Dart,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        let known_end = self.map().vertex(edge);
        self.journey.travel_to(known_end, PartialMap::expected, world, observer)
    }

    /// Lines 6 and 7: goes through the known map to the known end of an unexplored edge, follows it
    /// to its unknown end, and lists the hypotheses about that: each unexplored dart by which the
    /// robot may have come in, except those that its percept contradicts at once.
    ///
    /// # Errors
    /// Returns an error if the world does, if a known place is not as it was, if the marker appears
    /// where it cannot be, or if the edge is not unexplored.
    // paper: alg1.6, alg1.7
    pub fn explore<W: World>(
        &mut self,
        edge: Dart,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        self.clear_trail();
        self.journey.explore(edge, PartialMap::expected, world, observer)?;
        let percept = self.journey.arrival;
        self.set_percept(percept);
        self.list_hypotheses(edge)?;
        let hypotheses = self.hypotheses.len();
        let contradicted = self.map().unexplored_count() as usize - 1 - hypotheses;
        let event = MappingEvent::Arrived { edge, percept, contradicted, hypotheses };
        observer.event(world, &self.journey, event);
        Ok(())
    }

    // paper: alg1.hypotheses
    fn list_hypotheses(&mut self, edge: Dart) -> Result<(), Contradiction> {
        let Self { journey: MapWalk { map, arrival, .. }, hypotheses, .. } = self;
        hypotheses.clear();
        let marked = arrival.sighting != Sighting::Nothing;
        // The unexplored darts that were not looked at yet, besides the edge itself.
        let mut left = map.unexplored_count() - 1;
        for vertex in map.vertices().rev() {
            if left == 0 {
                break;
            }
            let here = map.unexplored_count_at(vertex);
            if here == 0 {
                continue;
            }
            left -= here - u32::from(map.vertex(edge) == vertex);
            if map.degree(vertex) == arrival.degree && (vertex == START) == marked {
                for dart in map.unexplored_at(vertex).rev() {
                    // Without a marker, all darts of a vertex look alike.
                    if dart != edge && (!marked || map.expected(dart) == *arrival) {
                        hypotheses.push(dart);
                    }
                }
            }
        }
        if hypotheses.is_empty() {
            let (vertex, index) = (map.vertex(edge), map.index(edge));
            let perceived = *arrival;
            return match perceived.sighting {
                Sighting::Nothing => Ok(()),
                _ => Err(Contradiction::Marker { vertex, index, perceived }),
            };
        }
        if !self.to_marker.is_grown() {
            self.to_marker.grow_from(map, START);
            self.to_marker.grow_whole(map);
        }
        if hypotheses.len() > 1 {
            let hops = |dart: Dart| self.to_marker.hops(map.vertex(dart));
            hypotheses.sort_unstable_by_key(|&dart| Reverse((hops(dart), dart)));
        }
        Ok(())
    }

    /// Line 9: removes a hypothesis from H.
    ///
    /// # Errors
    /// Returns an error if H has no hypothesis of this index.
    // paper: alg1.8, alg1.9
    pub fn remove_hypothesis(&mut self, index: usize) -> Result<Dart, InvalidStep> {
        let left = self.hypotheses.len();
        if index >= left {
            return Err(InvalidStep::NoHypothesis { index, left });
        }
        Ok(self.hypotheses.remove(index))
    }

    /// Line 10, one step at a time: the door towards the marker for a robot that came in by the
    /// dart `pose` of the map, and the pose behind it; `None` at the marked vertex.
    // paper: alg1.10
    #[inline]
    #[must_use]
    pub fn toward_marker(&self, pose: Dart) -> Option<(Door, Dart)> {
        self.to_marker.toward_root(self.map(), pose)
    }

    /// Begins a path that can be retraced.
    #[inline]
    pub fn clear_trail(&mut self) {
        self.trail.clear();
    }

    /// Makes one move, and returns the percept after it.
    ///
    /// # Errors
    /// Returns an error if the world does, or if no vertex has the percept.
    #[inline]
    pub fn go_through<W: World>(
        &mut self,
        door: Door,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<Percept, MappingError<W::Error>> {
        let CurrentVertex { percept, entry } = self.current;
        self.trail.push((percept, door));
        let door = door.seen_from(entry, percept.degree);
        let perceived = self.journey.go(door, world, observer)?;
        self.set_percept(perceived);
        Ok(perceived)
    }

    /// Line 15: goes back along the path since [`clear_trail`](Self::clear_trail), and counts doors there
    /// as before.
    ///
    /// # Errors
    /// Returns an error if the world does, or if a place on the way back is not as it was on the way
    /// out.
    // paper: alg1.15
    pub fn retrace<W: World>(
        &mut self,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        let trail = mem::take(&mut self.trail);
        let doors = retrace(trail.iter().map(|&(percept, door)| (door, percept.degree)));
        for (back, &(percept, door)) in doors.zip(trail.iter().rev()) {
            let perceived = self.journey.go(back, world, observer)?;
            let expected = percept.seen_from(door);
            if perceived != expected {
                return Err(Contradiction::WayBack { expected, perceived }.into());
            }
        }
        if let Some(&(percept, entry)) = trail.first() {
            self.current = CurrentVertex { percept, entry };
        }
        self.trail = trail;
        Ok(())
    }

    /// Lines 16 and 17: a path was followed to its end, and the robot knows that it has come to the
    /// marker by the dart `pose`.
    pub fn arrive_at_marker(&mut self, pose: Dart) {
        self.journey.robot = pose;
        self.set_percept(self.current.percept);
    }

    /// The robot has come in, with this percept.
    #[inline]
    fn set_percept(&mut self, percept: Percept) {
        self.current = CurrentVertex { percept, entry: Door::BACK };
    }

    /// Lines 18 to 20: the edge leads to the known vertex of the hypothesis.
    ///
    /// # Errors
    /// Returns an error if no edge is being explored, or the hypothesis is not another unexplored
    /// dart.
    // paper: alg1.18, alg1.19, alg1.20
    pub fn close_loop<W: ?Sized>(
        &mut self,
        hypothesis: Dart,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), InvalidStep> {
        let edge = self.journey.close_loop(hypothesis, world, observer)?;
        let is_grown = self.to_marker.is_grown();
        if is_grown && !self.to_marker.stays_with(self.journey.map(), edge, hypothesis) {
            self.to_marker.clear();
        }
        self.hypotheses.clear();
        Ok(())
    }

    /// Lines 21 to 23: the edge leads to a new vertex, whose other edges are unexplored. The robot
    /// is still there.
    ///
    /// # Errors
    /// Returns an error if no edge is being explored, or at the bound.
    // paper: alg1.21, alg1.22, alg1.23
    pub fn add_place<W: World>(
        &mut self,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        // The robot may have come back by another dart than it first came in by.
        let entry = self.current.entry;
        let vertex = self.journey.add_place(entry, world, observer)?;
        if self.to_marker.is_grown() {
            self.to_marker.add_leaf(self.journey.map(), vertex);
        }
        self.set_percept(self.map().expected(self.robot()));
        self.hypotheses.clear();
        Ok(())
    }
}
