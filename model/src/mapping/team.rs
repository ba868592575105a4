//! Mapping with other robots, as Bender and Slonim (1994) have two; here the graphs are undirected, and the robots know
//! at once what each of them perceives.
//!
//! The other robots are scouts. Each goes to an unexplored edge through the known map, and over it, and stands at its
//! unknown end. The explorer then looks for them at the known places. Where it meets one, that robot's heading shows the
//! dart by which it came in. Robots without a front are for worlds without loops and parallel edges: the scout goes back
//! to the known end, and the explorer tries the unexplored darts until it is there, too.

mod rounds;

use super::{
    Contradiction, CostOrder, Explorer, ExplorerInfo, InvalidStep, MapDart, MapWalk, Mapped,
    MappingError, MappingEvent, MovableEvent, ObservedWorld, StepPurpose, map_walk::has_walk,
    movable_markers::handle,
};
use crate::{
    aid::{AidAction, AidKind, team::Team},
    clone_in_place::clone_in_place,
    embedded_graph::{Dart, Vertex},
    injected_flaw::InjectedFlaw,
    percept::{Door, OtherRobot, Percept, Sighting, TeamView},
};
use rounds::Rounds;

/// The state of a run with a team: the explorer's walk, where the scouts are, and the ends that they have reached.
#[derive(Debug)]
pub struct TeamRun {
    team: Team,
    walk: MapWalk,
    scouts: Vec<Scout>,
    /// The edges of this round, in the order in which they were followed.
    ends: Vec<UnknownEnd>,
    /// The known vertices that were not searched yet. The next one is the last.
    candidates: Vec<Vertex>,
    back_links: Vec<Dart>,
    rounds: Rounds,
}

clone_in_place!(TeamRun { team, walk, scouts, ends, candidates, back_links, rounds });

has_walk!(TeamRun);

#[derive(Clone, Copy, Debug)]
struct Scout {
    /// The dart of the map by which it came in; while it stands at an unknown end, the known end of that edge.
    pose: Dart,
    /// The end of this round at which it stands.
    end: Option<usize>,
}

/// The unknown end of an edge of the map, where a scout stands.
#[derive(Clone, Debug)]
struct UnknownEnd {
    edge: Dart,
    scout: usize,
    degree: u32,
    place: Place,
}

#[derive(Clone, Debug)]
enum Place {
    /// For each known vertex, whether it may be the place.
    Sought(Vec<bool>),
    /// It is the place of the earlier end of this round with this number, whose scout came in by the dart this many doors
    /// clockwise of this one's, if that is seen.
    With(usize, Option<Door>),
    Known(Vertex),
    /// The edge leads to this dart.
    At(Dart),
}

impl Default for TeamRun {
    fn default() -> Self {
        Self::with(Team::of(2, true))
    }
}

impl TeamRun {
    /// A state ready for a run with this team.
    pub fn with(team: Team) -> Self {
        Self {
            team,
            walk: MapWalk::default(),
            scouts: Vec::new(),
            ends: Vec::new(),
            candidates: Vec::new(),
            back_links: Vec::new(),
            rounds: Rounds::default(),
        }
    }

    /// The synchronous rounds so far, in each of which every robot makes at most one move.
    pub fn rounds(&self) -> u64 {
        self.rounds.so_far()
    }
}

/// Mapping with scouts. The default choice is the edge nearest to the scout whose turn it is.
impl Explorer for TeamRun {
    type Aid = AidKind;
    type Choice = Dart;

    fn info(&self) -> ExplorerInfo {
        ExplorerInfo {
            option: self.aid().name(),
            title: "Mapping with scouts",
            in_words: "mapping with scouts",
            order: CostOrder::EdgesVertices,
        }
    }

    fn aid(&self) -> AidKind {
        AidKind::Team(self.team)
    }

    fn limit_darts(&mut self, max_darts: usize) {
        self.walk.set_bound(max_darts);
    }

    fn begin<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        self.walk.clear();
        self.ends.clear();
        self.candidates.clear();
        self.back_links.clear();
        let scouts = usize::from(self.team.robots()) - 1;
        self.rounds = Rounds::of(scouts);
        self.scouts.clear();
        self.scouts.resize(scouts, Scout { pose: super::FACING, end: None });
        let percept = world.percept().map_err(MappingError::World)?;
        if percept.degree == 0 {
            return Err(Contradiction::StartWithoutMarker { perceived: percept }.into());
        }
        self.walk.begin(percept, world)?;
        if percept != self.expected(self.walk.robot, percept) {
            return Err(Contradiction::StartWithoutMarker { perceived: percept }.into());
        }
        Ok(())
    }

    fn choose(&mut self) -> Result<Option<Dart>, InvalidStep> {
        let from = self.scouts.iter().find(|scout| scout.end.is_none()).map(|scout| scout.pose);
        let Self { walk, ends, .. } = self;
        let is_ahead = |dart: Dart| ends.iter().all(|end| !end.has(dart));
        Ok(from.and_then(|from| walk.nearest_unexplored_from(from, is_ahead)))
    }

    fn choices(&mut self) -> Result<Vec<Dart>, InvalidStep> {
        let is_ahead = |dart: &Dart| self.ends.iter().all(|end| !end.has(*dart));
        Ok(self.map().unexplored().filter(is_ahead).collect())
    }

    /// A scout follows an edge. When all stand at unknown ends, or no other edge is left, the explorer looks for them.
    fn step<W: ObservedWorld>(&mut self, edge: Dart, world: &mut W) -> Mapped<W> {
        self.scout(edge, world)?;
        if self.choose()?.is_none() {
            self.search(world)?;
            self.add_new_places(world)?;
            self.close_loops(world)?;
            self.ends.clear();
            self.rounds.all_know();
        }
        Ok(())
    }

    fn map_walk(&self) -> Option<&MapWalk> {
        Some(&self.walk)
    }

    fn purpose(&self, edge: Option<Dart>) -> StepPurpose {
        edge.map_or(StepPurpose::Done, |edge| StepPurpose::Explore(MapDart::new(self.map(), edge)))
    }

    /// With headings `3 n (n - 1) / 2 - 2 (n - 1) + (m - n + 1) (3 n - 2)`; without, `6 n - 7` for each loop. With two
    /// scouts, n more for each loop, whose edge can be followed from both ends.
    ///
    /// Let `k` vertices be known. A scout goes to the known end and over the edge: at most `k` moves. The explorer looks
    /// for it along a depth-first walk of a tree: at most `2 (k - 1)`. So a new place takes at most `3 k - 2`, and closing a
    /// loop `3 n - 2`. Without heading, the scout goes back over the edge, the explorer goes to the place, in
    /// `n - 1` moves at most, if it has looked for others since, and tries at most `n - 2` darts; that takes
    /// `2 (n - 2) - 1`.
    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        let (m, n) = (edges as u64, vertices as u64);
        let before = n.saturating_sub(1);
        let new = (n.saturating_mul(before).saturating_mul(3) / 2).saturating_sub(2 * before);
        let closed = if self.team.shows_heading() {
            n.saturating_mul(3).saturating_sub(2)
        } else {
            n.saturating_mul(6).saturating_sub(7)
        };
        let again = if self.team.robots() > 2 { n } else { 0 };
        let loops = (m + 1).saturating_sub(n);
        new.saturating_add(loops.saturating_mul(closed.saturating_add(again)))
    }
}

impl TeamRun {
    /// Sends a scout through the map and over an edge to its unknown end.
    fn scout<W: ObservedWorld>(&mut self, edge: Dart, world: &mut W) -> Mapped<W> {
        let is_open = self.map().is_unexplored(edge);
        let scout = self.scouts.iter().position(|scout| scout.end.is_none());
        let (Some(scout), true) = (scout, is_open && self.ends.iter().all(|end| !end.has(edge)))
        else {
            return Err(InvalidStep::NotUnexplored(edge).into());
        };
        let known_end = self.map().vertex(edge);
        for dart in self.walk.way_between(self.scouts[scout].pose, known_end, Vec::new()) {
            let door = self.map().door(self.scouts[scout].pose, dart);
            let Some(next) = self.map().opposite(dart) else { break };
            let percept = self.send(scout, door, world)?;
            self.scouts[scout].pose = next;
            self.compare(percept)?;
        }
        let door = self.map().door(self.scouts[scout].pose, edge);
        let percept = self.send(scout, door, world)?;
        self.scouts[scout] = Scout { pose: edge, end: Some(self.ends.len()) };
        let (degree, place) = self.place_seen(edge, scout, percept)?;
        let candidates = match &place {
            Place::Sought(may_be) => may_be.iter().filter(|may_be| **may_be).count(),
            _ => 1,
        };
        let at_end = Percept { degree, sighting: percept.sighting };
        self.report(MovableEvent::Arrived { edge, percept: at_end, candidates }, world);
        self.ends.push(UnknownEnd { edge, scout, degree, place });
        self.compare(percept)?;
        if candidates == 0 || InjectedFlaw::EveryPlaceIsNew.is_present() {
            self.add_place(self.ends.len() - 1, world)?;
            self.ends.pop();
        }
        Ok(())
    }

    /// Sends a scout through a door, and returns what the explorer perceives then.
    fn send<W: ObservedWorld>(
        &mut self,
        scout: usize,
        door: Door,
        world: &mut W,
    ) -> Mapped<W, Percept> {
        let action = AidAction::Send { robot: scout as u8 + 2, door };
        handle(action, world)?;
        self.walk.set_moves(self.walk.moves() + 1);
        self.rounds.sent(scout);
        self.report(MovableEvent::Did(action), world);
        world.percept().map_err(MappingError::World)
    }

    /// What is known at once of the place where a scout has come in, and its degree.
    fn place_seen(
        &self,
        edge: Dart,
        scout: usize,
        percept: Percept,
    ) -> Result<(u32, Place), Contradiction> {
        let impossible = Contradiction::Impossible { perceived: percept };
        let Sighting::Team(TeamView(seen)) = percept.sighting else { return Err(impossible) };
        let robot = self.walk.robot;
        let at = |pose: Dart, door: Door| {
            let dart = self.turned(pose, door);
            let is_free = self.map().is_unexplored(dart) && dart != edge;
            is_free.then_some(Place::At(dart)).ok_or(impossible)
        };
        let degree = |dart| self.map().degree(self.map().vertex(dart));
        // Another scout is seen there, this many doors clockwise.
        let with = |other: usize, door: Option<Door>| match (self.scouts[other], door) {
            (Scout { end: Some(end), .. }, _) => {
                Ok((self.ends[end].degree, Place::With(end, door)))
            }
            (Scout { pose, end: None }, Some(door)) => {
                Ok((degree(pose), at(pose, door.inverse(degree(pose)))?))
            }
            (Scout { pose, end: None }, None) => {
                Ok((degree(pose), Place::Known(self.map().vertex(pose))))
            }
        };
        match (seen[scout], scout, seen[1]) {
            (OtherRobot::HereAlong(door), ..) => Ok((degree(robot), at(robot, door)?)),
            (OtherRobot::Here, ..) => Ok((degree(robot), Place::Known(self.map().vertex(robot)))),
            // The third robot came in by the dart so many doors clockwise of the second one's.
            (OtherRobot::WithSecondAlong(door), ..) => {
                let second = self.scouts[0];
                match second.end {
                    Some(end) => {
                        let degree = self.ends[end].degree;
                        Ok((degree, Place::With(end, Some(door.inverse(degree)))))
                    }
                    None => Ok((degree(second.pose), at(second.pose, door)?)),
                }
            }
            (OtherRobot::WithSecond, ..) => with(0, None),
            (OtherRobot::Elsewhere { .. }, 0, OtherRobot::WithSecondAlong(door)) => {
                with(1, Some(door))
            }
            (OtherRobot::Elsewhere { .. }, 0, OtherRobot::WithSecond) => with(1, None),
            (OtherRobot::Elsewhere { degree }, ..) => {
                Ok((degree, Place::Sought(self.may_be(edge, degree))))
            }
            (OtherRobot::Absent, ..) => Err(impossible),
        }
    }

    /// The dart so many doors clockwise of another.
    fn turned(&self, dart: Dart, door: Door) -> Dart {
        let map = self.map();
        let vertex = map.vertex(dart);
        let index = (map.index(dart) + door.0) % map.degree(vertex);
        map.dart(vertex, index).unwrap_or(dart)
    }

    /// For each known vertex, whether it can be the unknown end of an edge. It looks like it, and has an unexplored dart,
    /// besides this one. Without headings, in a world without loops and parallel edges, it is neither the known end nor
    /// joined to it. Where the explorer stands it would see the scout.
    fn may_be(&self, edge: Dart, degree: u32) -> Vec<bool> {
        let map = self.map();
        let known_end = map.vertex(edge);
        let can_be = |vertex| {
            let besides = u32::from(vertex == known_end);
            map.degree(vertex) == degree && map.unexplored_count_at(vertex) > besides
        };
        let mut may_be: Vec<_> = map.vertices().map(can_be).collect();
        may_be[map.vertex(self.walk.robot).at()] = false;
        if !self.team.shows_heading() {
            may_be[known_end.at()] = false;
            for far in map.darts_of(known_end).filter_map(|dart| map.opposite(dart)) {
                may_be[map.vertex(far).at()] = false;
            }
        }
        for scout in self.scouts.iter().filter(|scout| scout.end.is_none()) {
            may_be[map.vertex(scout.pose).at()] = false;
        }
        may_be
    }

    /// The explorer looks for the scouts at all known vertices where they can stand, in the order in which a depth-first
    /// walk of the shortest paths from it meets them.
    fn search<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        let here = self.map().vertex(self.walk.robot);
        let Self { walk: MapWalk { map, from_robot, .. }, candidates, .. } = self;
        candidates.clear();
        from_robot.grow_from(map, here);
        from_robot.grow_whole(map);
        from_robot.preorder(map, candidates);
        candidates.reverse();
        while let Some(candidate) = self.candidates.last().copied() {
            if !self.ends.iter().any(|end| end.may_be(candidate)) {
                self.candidates.pop();
                continue;
            }
            let way = self.walk.way_to(candidate);
            for &dart in &way {
                let Some((next, perceived)) = self.walk.leave_by(dart, world)? else { break };
                self.rounds.explorer_moved();
                if self.arrive(next, perceived, world)? {
                    break;
                }
            }
            self.walk.way = way;
            if InjectedFlaw::OneCandidateSearched.is_present() {
                break;
            }
        }
        Ok(())
    }

    /// The explorer has come in by a dart of the map. Returns whether it has met scouts that it was looking for.
    fn arrive<W: ObservedWorld>(
        &mut self,
        pose: Dart,
        perceived: Percept,
        world: &mut W,
    ) -> Mapped<W, bool> {
        let vertex = self.map().vertex(pose);
        let Sighting::Team(TeamView(seen)) = perceived.sighting else {
            return Err(Contradiction::Impossible { perceived }.into());
        };
        if perceived.degree != self.map().degree(vertex) {
            let expected = Percept { degree: self.map().degree(vertex), ..perceived };
            self.walk.arrive(pose, expected, perceived)?;
        }
        self.walk.robot = pose;
        let (mut found, mut was_candidate) = (false, false);
        for at in 0..self.ends.len() {
            let UnknownEnd { edge, scout, .. } = self.ends[at];
            if !self.ends[at].may_be(vertex) {
                continue;
            }
            self.rounds.waited_for(scout);
            let place = match seen[scout] {
                OtherRobot::Here => Some(Place::Known(vertex)),
                OtherRobot::HereAlong(door) => {
                    let dart = self.turned(pose, door);
                    if dart == edge || !self.map().is_unexplored(dart) {
                        return Err(Contradiction::Impossible { perceived }.into());
                    }
                    Some(Place::At(dart))
                }
                _ => None,
            };
            match place {
                Some(place) => {
                    self.ends[at].place = place;
                    found = true;
                }
                None => was_candidate |= self.ends[at].exclude(vertex),
            }
        }
        self.compare(perceived)?;
        if found {
            self.report(MovableEvent::Found { vertex }, world);
        } else if was_candidate {
            self.report(MovableEvent::NotAt { vertex }, world);
        }
        Ok(found)
    }

    /// The scouts that were not found stand at new places.
    fn add_new_places<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        for at in 0..self.ends.len() {
            if matches!(self.ends[at].place, Place::Sought(_)) {
                self.report(MovableEvent::NotFound, world);
                self.add_place(at, world)?;
            }
        }
        Ok(())
    }

    fn add_place<W: ObservedWorld>(&mut self, at: usize, world: &mut W) -> Mapped<W> {
        let UnknownEnd { edge, scout, degree, .. } = self.ends[at];
        let vertex = self.walk.add_place_behind(edge, degree, world)?;
        let pose = self.map().first_dart(vertex);
        self.scouts[scout] = Scout { pose, end: None };
        self.ends[at].place = Place::At(pose);
        Ok(())
    }

    /// Closes the loops of this round.
    fn close_loops<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        for at in 0..self.ends.len() {
            let UnknownEnd { edge, scout, .. } = self.ends[at];
            // It may lead to a new place, or be the other end of an edge before it.
            let known = self.map().opposite(edge);
            let other = match (known, self.place_of(at)) {
                (Some(other), _) | (None, Some(Place::At(other))) => other,
                (None, Some(Place::Known(vertex))) => self.validate_back_link(at, vertex, world)?,
                (None, _) => return Err(InvalidStep::NoEdge.into()),
            };
            if self.scouts[scout].end == Some(at) {
                self.scouts[scout] = Scout { pose: other, end: None };
            }
            if known.is_none() {
                self.walk.edge = Some(edge);
                self.walk.close_loop(other, world)?;
            }
        }
        Ok(())
    }

    /// Where an end of this round is, after all scouts were found or have added their places.
    fn place_of(&self, at: usize) -> Option<Place> {
        let Place::With(earlier, along) = self.ends.get(at)?.place else {
            return Some(self.ends[at].place.clone());
        };
        match (&self.ends.get(earlier)?.place, along) {
            (Place::At(dart), Some(door)) => {
                let degree = self.map().degree(self.map().vertex(*dart));
                Some(Place::At(self.turned(*dart, door.inverse(degree))))
            }
            (Place::At(dart), None) => Some(Place::Known(self.map().vertex(*dart))),
            (place, _) => Some(place.clone()),
        }
    }

    /// Back-link validation: which unexplored dart of the known vertex is the other end of the edge? The scout goes
    /// back to the known end, and the explorer tries the darts until it meets the scout there.
    fn validate_back_link<W: ObservedWorld>(
        &mut self,
        at: usize,
        vertex: Vertex,
        world: &mut W,
    ) -> Mapped<W, Dart> {
        let UnknownEnd { edge, scout, .. } = self.ends[at];
        let marked = self.map().vertex(edge);
        self.back_links.clear();
        self.back_links.extend(self.walk.map.unexplored_at(vertex).rev());
        match self.back_links[..] {
            [only] => return Ok(only),
            [.., first] if InjectedFlaw::FirstDartIsIt.is_present() => return Ok(first),
            _ => {}
        }
        self.rounds.all_know();
        let percept = self.send(scout, Door::BACK, world)?;
        self.scouts[scout] = Scout { pose: edge, end: None };
        self.compare(percept)?;
        let way = self.walk.way_to(vertex);
        for &dart in &way {
            let Some((next, perceived)) = self.walk.leave_by(dart, world)? else { break };
            self.rounds.explorer_moved();
            self.arrive(next, perceived, world)?;
        }
        self.walk.way = way;
        while let Some(dart) = self.back_links.pop() {
            let door = self.map().door(self.walk.robot, dart);
            let percept = self.walk.go(door, world)?;
            self.rounds.explorer_moved();
            self.rounds.waited_for(scout);
            let Sighting::Team(TeamView(seen)) = percept.sighting else { break };
            if seen[scout] == OtherRobot::Here {
                self.arrive(edge, percept, world)?;
                self.report(MovableEvent::Behind { dart }, world);
                return Ok(dart);
            }
            let back = self.walk.go(Door::BACK, world)?;
            self.rounds.explorer_moved();
            self.arrive(dart, back, world)?;
            self.report(MovableEvent::NotBehind { dart, percept }, world);
        }
        Err(Contradiction::NoBackLink { vertex, marked }.into())
    }

    /// What the explorer perceives must agree with where the robots are.
    fn compare(&self, perceived: Percept) -> Result<(), Contradiction> {
        let pose = self.walk.robot;
        let expected = self.expected(pose, perceived);
        let (vertex, index) = (self.map().vertex(pose), self.map().index(pose));
        let agrees = expected == perceived;
        agrees.then_some(()).ok_or(Contradiction::KnownPlace { vertex, index, expected, perceived })
    }

    /// The percept expected of the explorer at a dart. Of scouts whose places are not known, it is what is perceived.
    fn expected(&self, pose: Dart, perceived: Percept) -> Percept {
        let map = self.map();
        let vertex = map.vertex(pose);
        let Sighting::Team(TeamView(mut seen)) = perceived.sighting else {
            return Percept {
                degree: map.degree(vertex),
                sighting: Sighting::Team(TeamView::default()),
            };
        };
        let along = |from: Dart, to: Dart| self.team.shows_heading().then(|| map.door(from, to));
        let dart = |scout: &Scout| match scout.end {
            None => Some(scout.pose),
            Some(end) => match self.ends.get(end)?.place {
                Place::At(dart) => Some(dart),
                _ => None,
            },
        };
        let darts: Vec<_> = self.scouts.iter().map(dart).collect();
        for (at, shown) in seen.iter_mut().enumerate() {
            let Some(&place) = darts.get(at) else {
                *shown = OtherRobot::Absent;
                continue;
            };
            let Some(dart) = place else { continue };
            let there = map.vertex(dart);
            *shown = if there == vertex {
                along(pose, dart).map_or(OtherRobot::Here, OtherRobot::HereAlong)
            } else {
                match (at, darts[0]) {
                    (1, Some(second)) if map.vertex(second) == there => along(second, dart)
                        .map_or(OtherRobot::WithSecond, OtherRobot::WithSecondAlong),
                    // The second robot may be there, too.
                    (1, None) if *shown != OtherRobot::Absent => continue,
                    _ => OtherRobot::Elsewhere { degree: map.degree(there) },
                }
            };
        }
        Percept { degree: map.degree(vertex), sighting: Sighting::Team(TeamView(seen)) }
    }

    fn report(&self, event: MovableEvent, world: &mut impl ObservedWorld) {
        world.event(&self.walk, MappingEvent::Movable(event));
    }
}

impl UnknownEnd {
    /// Whether a dart is an end of its edge.
    fn has(&self, dart: Dart) -> bool {
        dart == self.edge || matches!(self.place, Place::At(other) if other == dart)
    }

    fn may_be(&self, vertex: Vertex) -> bool {
        matches!(&self.place, Place::Sought(may_be) if may_be.get(vertex.at()) == Some(&true))
    }

    /// It is not this vertex. Returns whether it could be.
    fn exclude(&mut self, vertex: Vertex) -> bool {
        match &mut self.place {
            Place::Sought(may_be) => may_be.get_mut(vertex.at()).is_some_and(std::mem::take),
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests;
