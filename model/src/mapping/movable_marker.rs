//! Mapping with a single movable marker, in worlds without loops and parallel edges. Section 2.3,
//! after the paper's reference 8: Dudek, Jenkin, Milios and Wilkes, "Robotic exploration as graph
//! construction" (1991).
//!
//! Place validation finds out whether the place just reached is new. If it is not, back-link
//! validation finds the edge by which it was entered.

use super::{
    Contradiction, CostOrder, Explorer, ExplorerInfo, InvalidStep, MapDart, MapWalk, Mapped,
    MappingError, MappingEvent, MovableEvent, ObservedWorld, PartialMap, StepPurpose,
    map_walk::has_walk,
};
use crate::{
    aid::{
        AidAction,
        markers::{MOVABLE, MovableMarkers},
    },
    clone_in_place::clone_in_place,
    embedded_graph::{Dart, Vertex},
    percept::{Door, Percept, Sighting},
    world::World,
};

/// The state of a run with a movable marker: the robot's walk, and the candidates.
#[derive(Debug, Default)]
pub struct MovableMarkerRun {
    walk: MapWalk,
    /// The known vertices that the unknown end may be and that were not searched yet. The next one is
    /// the last.
    candidates: Vec<Vertex>,
    /// For each known vertex, whether it is a candidate.
    is_candidate: Vec<bool>,
    /// The unexplored darts that may be the other end of the edge and were not tried yet. The next one
    /// is the last.
    back_links: Vec<Dart>,
}

clone_in_place!(MovableMarkerRun { walk, candidates, is_candidate, back_links });

has_walk!(MovableMarkerRun);

/// The movable marker algorithm, for worlds without loops and parallel edges. At its start the robot stands where
/// the marker lies; at its end it carries the marker. The default choice is the nearest edge.
///
/// With loops or parallel edges one movable marker does not suffice: the map is then wrong, or the
/// run ends with an error.
impl Explorer for MovableMarkerRun {
    type Aid = MovableMarkers;
    type Choice = Dart;

    const INFO: ExplorerInfo = ExplorerInfo {
        option: "movable",
        title: "Place and back-link validation",
        in_words: "place and back-link validation",
        order: CostOrder::EdgesVertices,
    };

    fn aid(&self) -> MovableMarkers {
        MOVABLE
    }

    fn limit_darts(&mut self, max_darts: usize) {
        self.walk.set_bound(max_darts);
    }

    /// The robot picks the marker up at v0; S is v0; U is its edges.
    fn begin<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        self.walk.clear();
        self.candidates.clear();
        self.back_links.clear();
        let percept = world.percept().map_err(MappingError::World)?;
        if percept.degree == 0 || percept.sighting != Sighting::Lying(1) {
            return Err(Contradiction::StartWithoutMarker { perceived: percept }.into());
        }
        self.walk.begin(percept, world)?;
        self.pick_up(world)
    }

    fn choose(&mut self) -> Result<Option<Dart>, InvalidStep> {
        Ok(self.walk.nearest_unexplored())
    }

    fn choices(&mut self) -> Result<Vec<Dart>, InvalidStep> {
        Ok(self.map().unexplored().collect())
    }

    fn approach<W: ObservedWorld>(&mut self, edge: Dart, world: &mut W) -> Mapped<W> {
        self.travel_to(self.map().vertex(edge), world)
    }

    /// While U is not empty: an unexplored edge e = (vk, vu) is removed from it.
    fn step<W: ObservedWorld>(&mut self, edge: Dart, world: &mut W) -> Mapped<W> {
        // Carry the marker through S to the known end vk, and over e to the unknown end vu.
        self.carry_over(edge, world)?;
        match self.validate_place(world)? {
            // vu is a known vertex: a loop was closed.
            Some(vertex) => {
                let back_link = self.validate_back_link(edge, vertex, world)?;
                self.walk.close_loop(back_link, world)?;
            }
            // vu is a new place.
            None => {
                self.walk.add_place(Door::BACK, world)?;
            }
        }
        Ok(())
    }

    fn map_walk(&self) -> Option<&MapWalk> {
        Some(&self.walk)
    }

    fn purpose(&self, edge: Option<Dart>) -> StepPurpose {
        edge.map_or(StepPurpose::Done, |edge| StepPurpose::Explore(MapDart::new(self.map(), edge)))
    }

    /// `3 n (n - 1) / 2 + (m - n + 1) (6 n - 7)`, which is less than `6 m n`.
    ///
    /// Each of the m edges is explored once, and the world is simple. Let `k` vertices be known. The
    /// robot goes to the known end and over the edge: at most `k` moves. A search goes back over the
    /// edge, along no more than a closed depth-first walk of a tree of the `k` vertices, and so takes
    /// at most `1 + 2 (k - 1)` moves until the robot is at the known end again, whether the marker
    /// was found on the way or not.
    ///
    /// * The place is new: once more over the edge. That is at most `3 k` moves, and happens once for
    ///   each `k` from 1 to `n - 1`: `3 n (n - 1) / 2`.
    /// * It is known, `m - n + 1` times: the robot carries the marker to the known end, which ends
    ///   the closed walk, and returns to the place in at most `n - 1` moves. The place has at least
    ///   one explored dart, and is neither the known end nor joined to it by another edge; so the
    ///   darts to try lead to at most `n - 2` vertices, one of them the known end. The last costs a
    ///   move, each before it two: at most `2 (n - 2) - 1`. That is
    ///   `n + 1 + 2 (n - 1) + (n - 1) + 2 (n - 2) - 1 = 6 n - 7` together.
    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        let (m, n) = (edges as u64, vertices as u64);
        let new = n.saturating_mul(n.saturating_sub(1)).saturating_mul(3) / 2;
        let loops = (m + 1).saturating_sub(n);
        new.saturating_add(loops.saturating_mul(n.saturating_mul(6).saturating_sub(7)))
    }
}

fn marked(place: Percept) -> Percept {
    Percept { sighting: Sighting::Lying(1), ..place }
}

/// Does an action with the marker.
fn handle<W: World>(action: AidAction, world: &mut W) -> Mapped<W> {
    let handler = world.handler().ok_or(InvalidStep::NoMovableMarker)?;
    handler.handle(action).map_err(MappingError::World)
}

impl MovableMarkerRun {
    /// Place validation: which known vertex is the unknown end of the edge? There the robot and the marker then are.
    /// If it is a new place, the robot is there and carries the marker.
    // paper: movable.place, movable.new, movable.known
    fn validate_place<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W, Option<Vertex>> {
        // No known vertex can be vu: it is new.
        if self.candidates.is_empty() {
            return Ok(None);
        }
        // Drop the marker at vu, and go back over e to vk.
        self.drop_marker(world)?;
        self.go_back(world)?;
        // Search S for it: every known vertex that can be vu.
        while let Some(candidate) = self.next_candidate() {
            // Found at a vertex of S: this is vu.
            if let Some(vertex) = self.look_for_marker(candidate, world)? {
                return Ok(Some(vertex));
            }
        }
        // Not found: vu is new. Go there again, for the marker.
        self.return_to_marker(world)?;
        self.pick_up(world)?;
        Ok(None)
    }

    /// Back-link validation: which unexplored dart of the known vertex is the other end of `edge`?
    /// The robot is at the vertex where the marker lies. Afterwards it carries the marker.
    // paper: movable.back-link
    fn validate_back_link<W: ObservedWorld>(
        &mut self,
        edge: Dart,
        vertex: Vertex,
        world: &mut W,
    ) -> Mapped<W, Dart> {
        self.pick_up(world)?;
        // An only unexplored dart of the vertex needs no validation.
        self.back_links.clear();
        self.back_links.extend(self.walk.map.unexplored_at(vertex).rev());
        if let [only] = self.back_links[..] {
            return Ok(only);
        }
        // Carry the marker to vk, drop it there, and return without it.
        let marked = self.map().vertex(edge);
        self.travel_to(marked, world)?;
        self.drop_marker(world)?;
        self.travel_to(vertex, world)?;
        // Try the unexplored darts one by one, in the order of indices, until the marker lies behind one.
        while let Some(dart) = self.back_links.pop() {
            if self.try_back_link(dart, world)? {
                self.pick_up(world)?;
                return Ok(dart);
            }
        }
        Err(Contradiction::NoBackLink { vertex, marked }.into())
    }

    /// Carries the marker through the known map to the known end of an unexplored edge, and over it
    /// to its unknown end; and lists the candidates: the known vertices that this may be.
    fn carry_over<W: ObservedWorld>(&mut self, edge: Dart, world: &mut W) -> Mapped<W> {
        self.walk.explore(edge, PartialMap::unmarked, world)?;
        let percept = self.walk.arrival;
        if percept.sighting != Sighting::Nothing {
            let (vertex, index) = (self.map().vertex(edge), self.map().index(edge));
            return Err(Contradiction::SecondMarker { vertex, index, perceived: percept }.into());
        }
        self.list_candidates(self.map().vertex(edge));
        let candidates = self.candidates.len();
        self.report(MovableEvent::Arrived { edge, percept, candidates }, world);
        Ok(())
    }

    /// The candidates: they look like the unknown end and have an unexplored dart; and, since the
    /// world has no loops and no parallel edges, they are neither the known end nor joined to it.
    /// In the order in which a depth-first walk of the shortest paths from the known end meets them.
    fn list_candidates(&mut self, known_end: Vertex) {
        let Self { walk: MapWalk { map, arrival, from_robot, .. }, .. } = self;
        let looks_like_it = |vertex| map.degree(vertex) == arrival.degree;
        self.is_candidate.clear();
        self.is_candidate
            .extend(map.vertices().map(|vertex| looks_like_it(vertex) && map.is_frontier(vertex)));
        self.is_candidate[known_end.at()] = false;
        for far in map.darts_of(known_end).filter_map(|dart| map.opposite(dart)) {
            self.is_candidate[map.vertex(far).at()] = false;
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

    /// Removes the next candidate that the robot has not passed yet.
    fn next_candidate(&mut self) -> Option<Vertex> {
        while let Some(candidate) = self.candidates.pop() {
            if self.may_be(candidate) {
                return Some(candidate);
            }
        }
        None
    }

    fn may_be(&self, vertex: Vertex) -> bool {
        self.is_candidate.get(vertex.at()) == Some(&true)
    }

    fn drop_marker<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        handle(AidAction::Drop, world)?;
        self.report(MovableEvent::Dropped, world);
        Ok(())
    }

    fn pick_up<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        handle(AidAction::PickUp, world)?;
        self.report(MovableEvent::PickedUp, world);
        Ok(())
    }

    fn go_back<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        let edge = self.walk.edge.ok_or(InvalidStep::NoEdge)?;
        let perceived = self.walk.go(Door::BACK, world)?;
        self.walk.arrive(edge, self.map().unmarked(edge), perceived)?;
        Ok(())
    }

    /// Goes through the known map to a candidate. If the marker lies at a candidate on the way, the
    /// robot stops there, and that vertex is returned.
    fn look_for_marker<W: ObservedWorld>(
        &mut self,
        candidate: Vertex,
        world: &mut W,
    ) -> Mapped<W, Option<Vertex>> {
        let way = self.walk.way_to(candidate);
        for &dart in &way {
            let Some((next, perceived)) = self.walk.leave_by(dart, world)? else { break };
            let (vertex, expected) = (self.map().vertex(next), self.map().unmarked(next));
            if self.may_be(vertex) && perceived == marked(expected) {
                self.walk.robot = next;
                self.report(MovableEvent::Found { vertex }, world);
                return Ok(Some(vertex));
            }
            self.walk.arrive(next, expected, perceived)?;
            if self.may_be(vertex) {
                self.is_candidate[vertex.at()] = false;
                self.report(MovableEvent::NotAt { vertex }, world);
            }
        }
        self.walk.way = way;
        Ok(None)
    }

    /// Goes through the known map to the known end of the edge, and over it to the unknown end,
    /// where the marker was left.
    fn return_to_marker<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        let edge = self.walk.edge.ok_or(InvalidStep::NoEdge)?;
        self.report(MovableEvent::NotFound, world);
        let expected = marked(self.walk.arrival);
        self.walk.go_over(edge, PartialMap::unmarked, world)?;
        let perceived = self.walk.arrival;
        if perceived != expected {
            return Err(Contradiction::WayBack { expected, perceived }.into());
        }
        Ok(())
    }

    /// Goes through the known map to a vertex, past no marker.
    fn travel_to<W: ObservedWorld>(&mut self, vertex: Vertex, world: &mut W) -> Mapped<W> {
        self.walk.travel_to(vertex, PartialMap::unmarked, world)
    }

    /// Follows an unexplored dart of the robot's vertex. Returns whether the marker is behind it: then the robot is
    /// there; otherwise it is back.
    fn try_back_link<W: ObservedWorld>(&mut self, dart: Dart, world: &mut W) -> Mapped<W, bool> {
        let door = self.map().door(self.walk.robot, dart);
        let percept = self.walk.go(door, world)?;
        match self.walk.edge {
            Some(edge) if percept.sighting != Sighting::Nothing => {
                self.walk.arrive(edge, marked(self.map().unmarked(edge)), percept)?;
                self.report(MovableEvent::Behind { dart }, world);
                Ok(true)
            }
            _ => {
                let back = self.walk.go(Door::BACK, world)?;
                self.walk.arrive(dart, self.map().unmarked(dart), back)?;
                self.report(MovableEvent::NotBehind { dart, percept }, world);
                Ok(false)
            }
        }
    }

    fn report(&self, event: MovableEvent, world: &mut impl ObservedWorld) {
        world.event(&self.walk, MappingEvent::Movable(event));
    }
}

#[cfg(test)]
mod tests;
