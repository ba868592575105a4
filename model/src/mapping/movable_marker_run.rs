//! The state of the movable marker algorithm, and the small steps that it consists of. Section 2.3.

use super::{
    Choices, Contradiction, InvalidStep, MapWalk, MappingError, MappingEvent, MovableEvent,
    Observer, PartialMap, ValidationResult, map_walk::has_walk,
};
use crate::{
    clone_in_place::clone_in_place,
    embedded_graph::{Dart, Vertex},
    percept::{Door, Percept, Sighting},
    world::{MarkerCarrier, World},
};

/// The state of a run with a movable marker: the robot's journey, and the candidates.
#[derive(Debug)]
pub struct MovableMarkerRun {
    journey: MapWalk,
    /// The known vertices that the unknown end may be and that were not searched yet. The next one is
    /// the last.
    candidates: Vec<Vertex>,
    /// For each known vertex, whether it is a candidate.
    is_candidate: Vec<bool>,
    /// The unexplored darts that may be the other end of the edge and were not tried yet. The next one
    /// is the last.
    back_links: Vec<Dart>,
}

clone_in_place!(MovableMarkerRun { journey, candidates, is_candidate, back_links });

/// The percept of the same place with the marker there.
fn marked(place: Percept) -> Percept {
    Percept { sighting: Sighting::Lying(1), ..place }
}

/// What carries the robot's marker.
fn carrier<W: World>(
    world: &mut W,
) -> Result<&mut dyn MarkerCarrier<Error = W::Error>, InvalidStep> {
    world.carrier().ok_or(InvalidStep::NoMovableMarker)
}

has_walk!(MovableMarkerRun);

impl MovableMarkerRun {
    /// A state for a run with at most `bound` known darts.
    #[must_use]
    pub fn new(bound: usize) -> Self {
        Self {
            journey: MapWalk::new(bound),
            candidates: Vec::new(),
            is_candidate: Vec::new(),
            back_links: Vec::new(),
        }
    }

    /// The robot picks the marker up at v0, S is v0, and U is its edges.
    ///
    /// # Errors
    /// Returns an error if the world does, if the marker is not seen as required, or at the bound.
    pub(super) fn find_start<W: World>(
        &mut self,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        self.journey.clear();
        self.candidates.clear();
        self.back_links.clear();
        let percept = world.percept().map_err(MappingError::World)?;
        if percept.degree == 0 || percept.sighting != Sighting::Lying(1) {
            return Err(Contradiction::StartWithoutMarker { perceived: percept }.into());
        }
        self.journey.begin(percept, world, observer)?;
        self.pick_up(world, observer)
    }

    /// The edge to explore next, as chosen; `None` if everything is explored.
    pub fn choose_with(&mut self, choices: &mut impl Choices) -> Option<Dart> {
        self.journey.choose_edge(choices)
    }

    /// Carries the marker through the known map to the known end of an unexplored edge, and over it
    /// to its unknown end; and lists the candidates: the known vertices that this may be.
    ///
    /// # Errors
    /// Returns an error if the world does, if a known place is not as it was, if there is a second
    /// marker, or if the edge is not unexplored.
    pub fn carry_over<W: World>(
        &mut self,
        edge: Dart,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        self.journey.explore(edge, PartialMap::unmarked, world, observer)?;
        let percept = self.journey.arrival;
        if percept.sighting != Sighting::Nothing {
            let (vertex, index) = (self.map().vertex(edge), self.map().index(edge));
            return Err(Contradiction::SecondMarker { vertex, index, perceived: percept }.into());
        }
        self.list_candidates(self.map().vertex(edge));
        let candidates = self.candidates.len();
        self.report(MovableEvent::Arrived { edge, percept, candidates }, world, observer);
        Ok(())
    }

    /// The candidates: they look like the unknown end and have an unexplored dart; and, since the
    /// world has no loops and no parallel edges, they are neither the known end nor joined to it.
    /// In the order in which a depth-first walk of the shortest paths from the known end meets them.
    fn list_candidates(&mut self, known_end: Vertex) {
        let Self { journey: MapWalk { map, arrival, from_robot, .. }, .. } = self;
        let looks_like_it = |vertex| map.degree(vertex) == arrival.degree;
        self.is_candidate.clear();
        self.is_candidate
            .extend(map.vertices().map(|vertex| looks_like_it(vertex) && map.is_frontier(vertex)));
        self.is_candidate[known_end.at()] = false;
        for neighbour in map.neighbours(known_end) {
            self.is_candidate[neighbour.at()] = false;
        }
        self.candidates.clear();
        if self.is_candidate.contains(&true) {
            from_robot.grow_from(map, known_end);
            from_robot.grow_whole(map);
            from_robot.preorder(map, &mut self.candidates);
            self.candidates.retain(|vertex| self.is_candidate[vertex.at()]);
            self.candidates.reverse();
        }
    }

    /// The candidates that were not searched yet.
    #[must_use]
    pub fn candidates(&self) -> &[Vertex] {
        &self.candidates
    }

    /// Removes the next candidate that the robot has not passed yet.
    pub fn next_candidate(&mut self) -> Option<Vertex> {
        while let Some(candidate) = self.candidates.pop() {
            if self.may_be(candidate) {
                return Some(candidate);
            }
        }
        None
    }

    /// Whether the unknown end may be this vertex.
    fn may_be(&self, vertex: Vertex) -> bool {
        self.is_candidate.get(vertex.at()) == Some(&true)
    }

    /// Drops the marker where the robot is.
    ///
    /// # Errors
    /// Returns an error if the world does.
    pub fn drop_marker<W: World>(
        &mut self,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        carrier(world)?.drop().map_err(MappingError::World)?;
        self.report(MovableEvent::Dropped, world, observer);
        Ok(())
    }

    /// Picks the marker up where the robot is.
    ///
    /// # Errors
    /// Returns an error if the world does.
    pub fn pick_up<W: World>(
        &mut self,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        carrier(world)?.pick_up().map_err(MappingError::World)?;
        self.report(MovableEvent::PickedUp, world, observer);
        Ok(())
    }

    /// Goes back from the unknown end of the edge to the known one.
    ///
    /// # Errors
    /// Returns an error if the world does, if the known end is not as it was, or if no edge is being
    /// explored.
    pub fn go_back<W: World>(
        &mut self,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        let edge = self.journey.edge.ok_or(InvalidStep::NoEdge)?;
        let perceived = self.journey.go(Door::BACK, world, observer)?;
        self.journey.arrive(edge, self.map().unmarked(edge), perceived)?;
        Ok(())
    }

    /// Goes through the known map to a candidate. If the marker lies at a candidate on the way, the
    /// robot stops there, and that vertex is returned.
    ///
    /// # Errors
    /// Returns an error if the world does, if a known place is not as it was, or if the marker lies
    /// where it cannot be.
    pub fn look_for_marker<W: World>(
        &mut self,
        candidate: Vertex,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<Option<Vertex>, MappingError<W::Error>> {
        let way = self.journey.way_to(candidate)?;
        for &dart in &way {
            let Some((next, perceived)) = self.journey.leave_by(dart, world, observer)? else {
                break;
            };
            let (vertex, expected) = (self.map().vertex(next), self.map().unmarked(next));
            if self.may_be(vertex) && perceived == marked(expected) {
                self.journey.robot = next;
                self.report(MovableEvent::Found { vertex }, world, observer);
                return Ok(Some(vertex));
            }
            self.journey.arrive(next, expected, perceived)?;
            if self.may_be(vertex) {
                self.is_candidate[vertex.at()] = false;
                self.report(MovableEvent::NotAt { vertex }, world, observer);
            }
        }
        self.journey.way = way;
        Ok(None)
    }

    /// Goes through the known map to the known end of the edge, and over it to the unknown end,
    /// where the marker was left.
    ///
    /// # Errors
    /// Returns an error if the world does, if a place is not as it was, or if no edge is being
    /// explored.
    pub fn return_to_marker<W: World>(
        &mut self,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        let edge = self.journey.edge.ok_or(InvalidStep::NoEdge)?;
        self.report(MovableEvent::NotFound, world, observer);
        let expected = marked(self.journey.arrival);
        self.journey.go_over(edge, PartialMap::unmarked, world, observer)?;
        let perceived = self.journey.arrival;
        if perceived != expected {
            return Err(Contradiction::WayBack { expected, perceived }.into());
        }
        Ok(())
    }

    /// Goes through the known map to a vertex, past no marker.
    ///
    /// # Errors
    /// Returns an error if the world does, or if a known place is not as it was.
    pub fn travel_to<W: World>(
        &mut self,
        vertex: Vertex,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        self.journey.travel_to(vertex, PartialMap::unmarked, world, observer)
    }

    /// Lists the unexplored darts of a vertex, one of which is the other end of the edge. Returns the
    /// only one, if there is only one.
    pub fn list_back_links(&mut self, vertex: Vertex) -> Option<Dart> {
        self.back_links.clear();
        self.back_links.extend(self.journey.map.unexplored_at(vertex).rev());
        match self.back_links[..] {
            [only] => Some(only),
            _ => None,
        }
    }

    /// Removes the next dart that may be the other end of the edge, in the order of indices.
    pub fn next_back_link(&mut self) -> Option<Dart> {
        self.back_links.pop()
    }

    /// Follows an unexplored dart of the robot's vertex. If it is confirmed, the marker is behind it
    /// and the robot is there; if it is rejected, the robot is back.
    ///
    /// # Errors
    /// Returns an error if the world does, if the place behind the dart cannot be, or if the vertex is
    /// not as it was.
    pub fn try_back_link<W: World>(
        &mut self,
        dart: Dart,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<ValidationResult, MappingError<W::Error>> {
        let door = self.map().door(self.journey.robot, dart);
        let percept = self.journey.go(door, world, observer)?;
        match self.journey.edge {
            Some(edge) if percept.sighting != Sighting::Nothing => {
                self.journey.arrive(edge, marked(self.map().unmarked(edge)), percept)?;
                self.report(MovableEvent::Behind { dart }, world, observer);
                Ok(ValidationResult::Confirmed)
            }
            _ => {
                let back = self.journey.go(Door::BACK, world, observer)?;
                self.journey.arrive(dart, self.map().unmarked(dart), back)?;
                self.report(MovableEvent::NotBehind { dart, percept }, world, observer);
                Ok(ValidationResult::Rejected)
            }
        }
    }

    /// The edge leads to a known vertex, by this unexplored dart of it.
    ///
    /// # Errors
    /// Returns an error if no edge is being explored, or the dart is not another unexplored one.
    pub fn close_loop<W: ?Sized>(
        &mut self,
        back_link: Dart,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), InvalidStep> {
        self.journey.close_loop(back_link, world, observer)?;
        Ok(())
    }

    /// The edge leads to a new vertex, whose other edges are unexplored. The robot is there.
    ///
    /// # Errors
    /// Returns an error if no edge is being explored, or at the bound.
    pub fn add_place<W: World>(
        &mut self,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        self.journey.add_place(Door::BACK, world, observer)?;
        Ok(())
    }

    fn report<W: ?Sized>(
        &self,
        event: MovableEvent,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) {
        observer.event(world, &self.journey, MappingEvent::Movable(event));
    }
}
