//! Mapping with other robots, as Bender and Slonim (1994) have two; here the graphs are undirected, and the robots know
//! at once what each of them perceives.
//!
//! The other robots are scouts. Each goes to an unexplored edge through the known map, and over it, and stands at its
//! unknown end. The explorer then looks for them at the known places. Where robots meet, a heading shows the dart by which
//! the scout came in. Robots without a front are for worlds without loops and parallel edges: the scout goes back
//! to the known end, and the explorer tries the unexplored darts until it is there, too.

mod meeting;
mod rounds;

use super::{
    Contradiction, CostOrder, Explorer, ExplorerInfo, FACING, InvalidStep, MapWalk, Mapped,
    MappingError, MappingEvent, MovableEvent, ObservedWorld, StepPurpose, candidates::Candidates,
    map_walk::has_walk, movable_markers::handle,
};
use crate::{
    aid::{AidAction, AidKind, team::Team},
    clone_in_place::clone_in_place,
    embedded_graph::{Dart, Vertex},
    injected_flaw::InjectedFlaw,
    percept::{Door, OtherRobot, Percept, Sighting, TeamView},
};
use meeting::{Meeting, TeamMember};
use rounds::Rounds;

/// The state of a run with a team: the explorer's walk, and where the scouts are.
#[derive(Debug)]
pub struct TeamRun {
    team: Team,
    walk: MapWalk,
    scouts: Vec<Scout>,
    /// The scout whose turn it is, if it stands at a known place.
    turn: usize,
    /// The edges of this round, in the order in which they were followed.
    followed: Vec<Dart>,
    back_links: Vec<Dart>,
    rounds: Rounds,
}

clone_in_place!(TeamRun { team, walk, scouts, turn, followed, back_links, rounds });

has_walk!(TeamRun);

#[derive(Clone, Debug)]
enum Scout {
    /// It came in by this dart of the map.
    At(Dart),
    Beyond(UnknownEnd),
}

/// The unknown end of an edge of the map, where a scout stands.
#[derive(Clone, Debug)]
struct UnknownEnd {
    edge: Dart,
    degree: u32,
    may_be: Candidates,
    /// The place, once it is known.
    place: Option<Vertex>,
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
            turn: 0,
            followed: Vec::new(),
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
        self.followed.clear();
        self.back_links.clear();
        self.turn = 0;
        let scouts = usize::from(self.team.robots()) - 1;
        self.rounds = Rounds::of(scouts);
        self.scouts.clear();
        self.scouts.resize(scouts, Scout::At(FACING));
        let percept = world.percept().map_err(MappingError::World)?;
        if percept.degree == 0 {
            return Err(Contradiction::StartWithoutMarker { perceived: percept }.into());
        }
        self.walk.begin(percept, world)?;
        if percept != self.expected(percept) {
            return Err(Contradiction::StartWithoutMarker { perceived: percept }.into());
        }
        Ok(())
    }

    fn choose(&mut self) -> Result<Option<Dart>, InvalidStep> {
        let Some((_, pose)) = self.next_scout() else { return Ok(None) };
        let Self { walk, scouts, .. } = self;
        let is_ahead = |dart: Dart| scouts.iter().all(|scout| !scout.is_beyond(dart));
        Ok(walk.nearest_unexplored_from(pose, is_ahead))
    }

    fn add_choices(&mut self, choices: &mut Vec<Dart>) -> Result<(), InvalidStep> {
        if self.next_scout().is_some() {
            let is_ahead = |dart: &Dart| self.scouts.iter().all(|scout| !scout.is_beyond(*dart));
            choices.extend(self.map().unexplored().filter(is_ahead));
        }
        Ok(())
    }

    /// A scout follows an edge. When all stand at unknown ends, or no other edge is left, the explorer looks for them.
    fn step<W: ObservedWorld>(&mut self, edge: Dart, world: &mut W) -> Mapped<W> {
        self.send_over(edge, world)?;
        if self.choose()?.is_none() {
            self.search(world)?;
            self.validate_back_links(world)?;
            self.followed.clear();
            self.turn = 0;
            self.rounds.all_know();
        }
        Ok(())
    }

    fn map_walk(&self) -> Option<&MapWalk> {
        Some(&self.walk)
    }

    fn purpose(&self, edge: Option<Dart>) -> StepPurpose {
        self.walk.purpose(edge)
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
    /// The scout whose turn it is, or the next one that stands at a known place, and its pose.
    fn next_scout(&self) -> Option<(usize, Dart)> {
        let count = self.scouts.len();
        let from_turn = (self.turn..count).chain(0..self.turn);
        from_turn.into_iter().find_map(|at| match self.scouts[at] {
            Scout::At(pose) => Some((at, pose)),
            Scout::Beyond(_) => None,
        })
    }

    /// Sends a scout through the map and over an edge to its unknown end; not over it, if that becomes known on the way.
    fn send_over<W: ObservedWorld>(&mut self, edge: Dart, world: &mut W) -> Mapped<W> {
        let is_ahead = self.scouts.iter().all(|scout| !scout.is_beyond(edge));
        let next = self.next_scout().filter(|_| is_ahead && self.map().is_unexplored(edge));
        let (scout, mut pose) = next.ok_or(InvalidStep::NotUnexplored(edge))?;
        let known_end = self.map().vertex(edge);
        for dart in self.walk.way_between(pose, known_end, Vec::new()) {
            let door = self.map().door(pose, dart);
            let Some(next) = self.map().opposite(dart) else { break };
            let percept = self.send(scout, door, world)?;
            pose = next;
            self.scouts[scout] = Scout::At(pose);
            self.notice(percept, world)?;
        }
        if !self.map().is_unexplored(edge) {
            self.turn = scout;
            return Ok(());
        }
        let door = self.map().door(pose, edge);
        let percept = self.send(scout, door, world)?;
        self.turn = (scout + 1) % self.scouts.len();
        let (degree, is_alone) = Self::seen_beyond(scout, percept)?;
        let may_be =
            if is_alone { self.candidates_of(scout, edge, degree) } else { Candidates::default() };
        let candidates = may_be.count();
        self.scouts[scout] = Scout::Beyond(UnknownEnd { edge, degree, may_be, place: None });
        self.followed.push(edge);
        let at_end = Percept { degree, sighting: percept.sighting };
        self.report(MovableEvent::Arrived { edge, percept: at_end, candidates }, world);
        if is_alone && (candidates == 0 || InjectedFlaw::EveryPlaceIsNew.is_present()) {
            self.add_place(scout, world)?;
        }
        self.notice(percept, world)
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

    /// The number of doors that a scout perceives beyond an edge, and whether no other robot is there.
    fn seen_beyond(scout: usize, percept: Percept) -> Result<(u32, bool), Contradiction> {
        let impossible = Contradiction::Impossible { perceived: percept };
        let Sighting::Team(TeamView(seen)) = percept.sighting else { return Err(impossible) };
        let with_second =
            matches!(seen[1], OtherRobot::WithSecond | OtherRobot::WithSecondAlong(_));
        match (seen[scout], seen[0]) {
            (OtherRobot::Here | OtherRobot::HereAlong(_), _) => Ok((percept.degree, false)),
            (OtherRobot::WithSecond | OtherRobot::WithSecondAlong(_), second) => match second {
                OtherRobot::Elsewhere { degree: degree @ 1.. } => Ok((degree, false)),
                _ => Err(impossible),
            },
            (OtherRobot::Elsewhere { degree: degree @ 1.. }, _) => {
                Ok((degree, !(scout == 0 && with_second)))
            }
            (OtherRobot::Elsewhere { .. } | OtherRobot::Absent, _) => Err(impossible),
        }
    }

    /// The candidates for the place of a scout. Where another robot is, that one would see the scout.
    fn candidates_of(&self, scout: usize, edge: Dart, degree: u32) -> Candidates {
        let mut places = Candidates::of_end(self.map(), edge, degree);
        if !self.team.shows_heading() {
            places = places.in_simple_world(self.map(), edge);
        }
        for vertex in self.others(scout).filter_map(|other| self.place(other)) {
            places.exclude(vertex);
        }
        places
    }

    /// The explorer, and the scouts besides this one.
    fn others(&self, scout: usize) -> impl Iterator<Item = TeamMember> + use<> {
        let scouts = (0..self.scouts.len()).filter(move |other| *other != scout);
        [TeamMember::Explorer].into_iter().chain(scouts.map(TeamMember::Scout))
    }

    /// The vertex where a robot is, if that is known: the explorer, or one of the scouts.
    fn place(&self, robot: TeamMember) -> Option<Vertex> {
        match robot {
            TeamMember::Explorer => Some(self.map().vertex(self.walk.robot)),
            TeamMember::Scout(at) => match &self.scouts[at] {
                Scout::At(pose) => Some(self.map().vertex(*pose)),
                Scout::Beyond(end) => end.place,
            },
        }
    }

    /// What follows from who is with whom, until nothing new does.
    fn notice<W: ObservedWorld>(&mut self, percept: Percept, world: &mut W) -> Mapped<W> {
        let mut is_new = true;
        while is_new {
            is_new = false;
            for scout in 0..self.scouts.len() {
                is_new |= self.notice_of(scout, percept, world)?;
            }
        }
        let pose = self.walk.robot;
        let expected = self.expected(percept);
        Ok(self.walk.arrive(pose, expected, percept)?)
    }

    /// What follows about the end of an edge where a scout stands. Returns whether its place or its dart was not known.
    fn notice_of<W: ObservedWorld>(
        &mut self,
        scout: usize,
        percept: Percept,
        world: &mut W,
    ) -> Mapped<W, bool> {
        let Scout::Beyond(UnknownEnd { edge, place: known, .. }) = self.scouts[scout] else {
            return Ok(false);
        };
        if let Some(dart) = self.map().opposite(edge) {
            self.scouts[scout] = Scout::At(dart);
            return Ok(true);
        }
        let (mut place, mut entry) = (known, None);
        for other in self.others(scout) {
            let Some(vertex) = self.place(other) else { continue };
            let meeting = Meeting::of(scout, other, percept);
            if meeting.is_apart() {
                if let Scout::Beyond(end) = &mut self.scouts[scout] {
                    end.may_be.exclude(vertex);
                }
                continue;
            }
            place = Some(vertex);
            let pose = match other {
                TeamMember::Explorer => Some(self.walk.robot),
                TeamMember::Scout(at) => self.scouts[at].pose(),
            };
            if let (Some(pose), Meeting::Turned(clockwise, back)) = (pose, meeting) {
                entry = entry.or(Some(self.turned(pose, clockwise, back)));
            }
        }
        if let (Some(vertex), None) = (place, entry) {
            let mut darts = self.map().unexplored_at(vertex).filter(|dart| *dart != edge);
            entry = darts.next().filter(|_| darts.next().is_none());
        }
        if let Scout::Beyond(end) = &mut self.scouts[scout] {
            end.place = place;
        }
        let Some(entry) = entry else { return Ok(known.is_none() && place.is_some()) };
        self.walk.edge = Some(edge);
        self.walk
            .close_loop(entry, world)
            .map_err(|_| Contradiction::Impossible { perceived: percept })?;
        self.scouts[scout] = Scout::At(entry);
        Ok(true)
    }

    /// The dart so many doors clockwise of another, and then so many counterclockwise.
    fn turned(&self, dart: Dart, clockwise: Door, back: Door) -> Dart {
        let map = self.map();
        let vertex = map.vertex(dart);
        let degree = map.degree(vertex);
        let index = map.index(dart) + clockwise.0 % degree + (degree - back.0 % degree);
        map.dart(vertex, index % degree).unwrap_or(dart)
    }

    /// The explorer looks for the scouts at all known vertices where they can stand, in the order in which a depth-first
    /// walk of the shortest paths from it meets them. The places of scouts that it does not meet are new.
    fn search<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        let mut candidates = Vec::new();
        self.walk.write_preorder(&mut candidates);
        for candidate in candidates {
            if self.is_candidate(candidate) {
                self.look_for_scouts(candidate, world)?;
            }
            if InjectedFlaw::OneCandidateSearched.is_present() {
                break;
            }
        }
        for scout in 0..self.scouts.len() {
            if matches!(&self.scouts[scout], Scout::Beyond(end) if end.place.is_none()) {
                self.report(MovableEvent::NotFound, world);
                self.add_place(scout, world)?;
            }
        }
        Ok(())
    }

    /// Whether a known vertex may be where a scout stands that is looked for.
    fn is_candidate(&self, vertex: Vertex) -> bool {
        self.scouts.iter().any(|scout| match scout {
            Scout::Beyond(end) => end.place.is_none() && end.may_be.contains(vertex),
            Scout::At(_) => false,
        })
    }

    /// Goes through the known map to a candidate, as long as it is one.
    fn look_for_scouts<W: ObservedWorld>(&mut self, candidate: Vertex, world: &mut W) -> Mapped<W> {
        let way = self.walk.way_to(candidate);
        for &dart in &way {
            self.explorer_takes(dart, world)?;
            if !self.is_candidate(candidate) {
                break;
            }
        }
        self.walk.way = way;
        Ok(())
    }

    /// The explorer takes a dart of the known map.
    fn explorer_takes<W: ObservedWorld>(&mut self, dart: Dart, world: &mut W) -> Mapped<W> {
        let Some((pose, percept)) = self.walk.leave_by(dart, world)? else { return Ok(()) };
        self.rounds.explorer_moved();
        let vertex = self.map().vertex(pose);
        let sought = |scout: &Scout| matches!(scout, Scout::Beyond(end) if end.place.is_none());
        let before: Vec<_> = self.scouts.iter().map(sought).collect();
        let was_candidate = self.is_candidate(vertex);
        for (scout, was_sought) in before.iter().enumerate() {
            if *was_sought && was_candidate {
                self.rounds.waited_for(scout);
            }
        }
        self.walk.robot = pose;
        let is_found = (0..self.scouts.len()).any(|scout| {
            before[scout] && !Meeting::of(scout, TeamMember::Explorer, percept).is_apart()
        });
        if is_found {
            self.report(MovableEvent::Found { vertex }, world);
        } else if was_candidate {
            self.report(MovableEvent::NotAt { vertex }, world);
        }
        self.notice(percept, world)
    }

    /// A scout stands at a new place.
    fn add_place<W: ObservedWorld>(&mut self, scout: usize, world: &mut W) -> Mapped<W> {
        let Scout::Beyond(UnknownEnd { edge, degree, .. }) = self.scouts[scout] else {
            return Ok(());
        };
        let vertex = self.walk.add_place_behind(edge, degree, world)?;
        self.scouts[scout] = Scout::At(self.map().first_dart(vertex));
        self.rounds.all_know();
        let percept = world.percept().map_err(MappingError::World)?;
        self.notice(percept, world)
    }

    /// Closes the loops of this round whose darts are not known, in the order in which their edges were followed.
    fn validate_back_links<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        for at in 0..self.followed.len() {
            let edge = self.followed[at];
            let scout = self.scouts.iter().position(|scout| scout.is_beyond(edge));
            if let Some(scout) = scout
                && let Some(vertex) = self.place(TeamMember::Scout(scout))
            {
                self.validate_back_link(scout, edge, vertex, world)?;
            }
        }
        Ok(())
    }

    /// Back-link validation: which unexplored dart of the known vertex is the other end of the edge? The scout goes
    /// back to the known end, and the explorer tries the darts until it meets the scout there.
    fn validate_back_link<W: ObservedWorld>(
        &mut self,
        scout: usize,
        edge: Dart,
        vertex: Vertex,
        world: &mut W,
    ) -> Mapped<W> {
        self.rounds.all_know();
        self.send(scout, Door::BACK, world)?;
        self.scouts[scout] = Scout::At(edge);
        let way = self.walk.way_to(vertex);
        for &dart in &way {
            self.explorer_takes(dart, world)?;
        }
        self.walk.way = way;
        self.back_links.clear();
        self.back_links.extend(self.walk.map.unexplored_at(vertex).rev());
        while let Some(dart) = self.back_links.pop() {
            let door = self.map().door(self.walk.robot, dart);
            let percept = self.walk.go(door, world)?;
            self.rounds.explorer_moved();
            self.rounds.waited_for(scout);
            let is_met = !Meeting::of(scout, TeamMember::Explorer, percept).is_apart();
            if is_met || InjectedFlaw::FirstDartIsIt.is_present() {
                self.walk.edge = Some(edge);
                self.walk.close_loop(dart, world)?;
                self.walk.robot = edge;
                self.report(MovableEvent::Behind { dart }, world);
                return self.notice(percept, world);
            }
            let back = self.walk.go(Door::BACK, world)?;
            self.rounds.explorer_moved();
            self.walk.robot = dart;
            self.walk.arrive(dart, self.expected(back), back)?;
            self.report(MovableEvent::NotBehind { dart, percept }, world);
        }
        Err(Contradiction::NoBackLink { vertex, marked: self.map().vertex(edge) }.into())
    }

    /// The percept expected of the explorer. Of scouts whose places are not known, it is what is perceived.
    fn expected(&self, perceived: Percept) -> Percept {
        let map = self.map();
        let pose = self.walk.robot;
        let degree = map.degree(map.vertex(pose));
        let Sighting::Team(TeamView(mut seen)) = perceived.sighting else {
            return Percept { degree, sighting: Sighting::Team(TeamView::default()) };
        };
        let along = |from: Dart, to: Dart| self.team.shows_heading().then(|| map.door(from, to));
        for (at, shown) in seen.iter_mut().enumerate() {
            let Some(scout) = self.scouts.get(at) else {
                *shown = OtherRobot::Absent;
                continue;
            };
            let Some(dart) = scout.pose() else { continue };
            let there = map.vertex(dart);
            // Whether the second robot is where the third one is; none if that is not known.
            let second = (at == 1).then(|| self.scouts[0].pose());
            *shown = if there == map.vertex(pose) {
                along(pose, dart).map_or(OtherRobot::Here, OtherRobot::HereAlong)
            } else {
                match second {
                    Some(None) => continue,
                    Some(Some(second)) if map.vertex(second) == there => along(second, dart)
                        .map_or(OtherRobot::WithSecond, OtherRobot::WithSecondAlong),
                    _ => OtherRobot::Elsewhere { degree: map.degree(there) },
                }
            };
        }
        Percept { degree, sighting: Sighting::Team(TeamView(seen)) }
    }

    fn report(&self, event: MovableEvent, world: &mut impl ObservedWorld) {
        world.event(&self.walk, MappingEvent::Movable(event));
    }
}

impl Scout {
    /// The dart by which it came in, if that is known.
    fn pose(&self) -> Option<Dart> {
        if let Self::At(pose) = self { Some(*pose) } else { None }
    }

    /// Whether it stands at the unknown end of this edge.
    fn is_beyond(&self, dart: Dart) -> bool {
        matches!(self, Self::Beyond(end) if end.edge == dart)
    }
}

#[cfg(test)]
mod tests;
