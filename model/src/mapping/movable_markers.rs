//! Mapping with markers that the robot carries. Section 2.3, after the paper's reference 8: Dudek, Jenkin, Milios and
//! Wilkes, "Robotic exploration as graph construction" (1991), and with several markers after "Using multiple markers in
//! graph exploration" (1989).
//!
//! Place validation finds out whether the place just reached is new. If it is not, back-link validation finds the edge by
//! which it was entered. With several markers, several places are marked before one search for all of them. A
//! directional marker shows both at once: it points along the dart by which the place was entered.

mod carried;

use super::{
    Contradiction, CostOrder, Explorer, ExplorerInfo, InvalidStep, MapWalk, Mapped, MappingError,
    MappingEvent, MovableEvent, ObservedWorld, StepPurpose, candidates::Candidates,
    map_walk::has_walk,
};
use crate::{
    aid::{AidAction, AidKind, markers::MOVABLE},
    clone_in_place::clone_in_place,
    embedded_graph::{Dart, Vertex},
    injected_flaw::InjectedFlaw,
    percept::{Door, Percept, Sighting},
    world::World,
};
use carried::{CarriedMarkers, Marks};

/// The state of a run with movable markers: the robot's walk, and the ends of edges that it has marked.
#[derive(Debug)]
pub struct MovableMarkerRun {
    aid: AidKind,
    walk: MapWalk,
    carried: CarriedMarkers,
    /// The edges of this round, in the order in which they were followed.
    ends: Vec<UnknownEnd>,
    /// No markers are left that distinguish the next place from those of this round.
    is_full: bool,
    /// The known vertices that an unknown end may be and that were not searched yet. The next one is the last.
    candidates: Vec<Vertex>,
    /// The unexplored darts that may be the other end of the edge and were not tried yet. The next one
    /// is the last.
    back_links: Vec<Dart>,
}

clone_in_place!(MovableMarkerRun { aid, walk, carried, ends, is_full, candidates, back_links });

has_walk!(MovableMarkerRun);

/// The unknown end of an edge of the map.
#[derive(Clone, Debug)]
struct UnknownEnd {
    edge: Dart,
    degree: u32,
    place: EndPlace,
}

#[derive(Clone, Debug)]
enum EndPlace {
    /// Markers lie there.
    Marked(Marks, Candidates),
    /// It is the place of another end of this round, with this number.
    SameAs(usize),
    Known(Vertex),
    /// The edge leads to this dart.
    At(Dart),
}

impl Default for MovableMarkerRun {
    fn default() -> Self {
        Self::with(AidKind::Markers(MOVABLE))
    }
}

impl MovableMarkerRun {
    /// A state ready for a run with one or several undirected markers, or with a directional one.
    pub(crate) fn with(aid: AidKind) -> Self {
        Self {
            aid,
            walk: MapWalk::default(),
            carried: CarriedMarkers::none(),
            ends: Vec::new(),
            is_full: false,
            candidates: Vec::new(),
            back_links: Vec::new(),
        }
    }
}

/// The movable marker algorithm. Undirected markers are for worlds without loops and parallel edges. At its start the
/// robot stands where the markers lie; at its end it carries them. The default choice is the nearest edge.
///
/// With loops or parallel edges undirected markers do not suffice: the map is then wrong, or the run ends with an
/// error.
impl Explorer for MovableMarkerRun {
    type Aid = AidKind;
    type Choice = Dart;

    fn info(&self) -> ExplorerInfo {
        if self.points() {
            ExplorerInfo {
                option: self.aid.name(),
                title: "Place validation",
                in_words: "place validation",
                order: CostOrder::EdgesVertices,
            }
        } else {
            ExplorerInfo {
                option: self.aid.name(),
                title: "Place and back-link validation",
                in_words: "place and back-link validation",
                order: CostOrder::EdgesVertices,
            }
        }
    }

    fn aid(&self) -> AidKind {
        self.aid
    }

    fn limit_darts(&mut self, max_darts: usize) {
        self.walk.set_bound(max_darts);
    }

    /// The robot picks the markers up at v0; S is v0; U is its edges.
    fn begin<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        self.walk.clear();
        self.carried = CarriedMarkers::none();
        self.ends.clear();
        self.is_full = false;
        self.candidates.clear();
        self.back_links.clear();
        let percept = world.percept().map_err(MappingError::World)?;
        let all = CarriedMarkers::all(self.aid);
        if percept.degree == 0 || Some(percept.sighting) != all.lying(Door::BACK) {
            return Err(Contradiction::StartWithoutMarker { perceived: percept }.into());
        }
        self.walk.begin(percept, world)?;
        for marks in all.each() {
            self.pick_up(marks, world)?;
        }
        Ok(())
    }

    fn choose(&mut self) -> Result<Option<Dart>, InvalidStep> {
        let Self { walk, ends, .. } = self;
        Ok(walk.nearest_unexplored_from(walk.robot, |dart: Dart| {
            ends.iter().all(|end| end.edge != dart)
        }))
    }

    fn add_choices(&mut self, choices: &mut Vec<Dart>) -> Result<(), InvalidStep> {
        let is_ahead = |dart: &Dart| self.ends.iter().all(|end| end.edge != *dart);
        choices.extend(self.map().unexplored().filter(is_ahead));
        Ok(())
    }

    fn approach<W: ObservedWorld>(&mut self, edge: Dart, world: &mut W) -> Mapped<W> {
        self.travel_to(self.map().vertex(edge), world)
    }

    /// While U is not empty: an unexplored edge e = (vk, vu) is removed from it. When the markers are used up, or no
    /// other edge is left, the robot looks for the markers.
    fn step<W: ObservedWorld>(&mut self, edge: Dart, world: &mut W) -> Mapped<W> {
        self.mark_end(edge, world)?;
        let is_begun = !self.ends.is_empty();
        if is_begun && (self.is_full || self.carried.is_none() || self.choose()?.is_none()) {
            self.search(world)?;
            self.fetch(world)?;
            self.close_loops(world)?;
            self.ends.clear();
            self.is_full = false;
        }
        Ok(())
    }

    fn map_walk(&self) -> Option<&MapWalk> {
        Some(&self.walk)
    }

    fn purpose(&self, edge: Option<Dart>) -> StepPurpose {
        self.walk.purpose(edge)
    }

    /// With undirected markers `3 n (n - 1) / 2 + (m - n + 1) (6 n - 7)`, which is less than `6 m n`; with a directional
    /// one `3 n (n - 1) / 2 + (m - n + 1) (3 n - 1)`. With several, `(m - n + 1) (n + 1)` more; and with several that look
    /// alike, `m (n + 1)` more.
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
    ///   `n + 1 + 2 (n - 1) + (n - 1) + 2 (n - 2) - 1 = 6 n - 7` together. A directional marker that is found shows the
    ///   dart, and the loop is closed after `n + 1 + 2 (n - 1)` moves.
    ///
    /// With b ends marked in a round, each edge takes at most `k + 1` moves there and back, `2 (k - 1) / b` of one search,
    /// and `k` to fetch markers, or `2 (k - 1)` to bring one to the known end and return: no more than with one. But an
    /// edge that closes a loop can be followed from both ends in a round, `n + 1` moves more. Where a place looks like one
    /// that is marked alike, the robot goes back in vain, at most once in a round.
    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        let (m, n) = (edges as u64, vertices as u64);
        let all = CarriedMarkers::all(self.aid);
        let new = n.saturating_mul(n.saturating_sub(1)).saturating_mul(3) / 2;
        let closed = if self.points() {
            n.saturating_mul(3).saturating_sub(1)
        } else {
            n.saturating_mul(6).saturating_sub(7)
        };
        let again = if all.each().count() > 1 { n + 1 } else { 0 };
        let loops = (m + 1).saturating_sub(n).saturating_mul(closed.saturating_add(again));
        let in_vain = if all.may_look_alike() { m.saturating_mul(n + 1) } else { 0 };
        new.saturating_add(loops).saturating_add(in_vain)
    }
}

/// Does an action with the aid.
pub(super) fn handle<W: World>(action: AidAction, world: &mut W) -> Mapped<W> {
    let handler = world.handler().ok_or(InvalidStep::NoMovableMarker)?;
    handler.handle(action).map_err(MappingError::World)
}

impl MovableMarkerRun {
    /// Whether a marker shows the dart by which its place was entered.
    fn points(&self) -> bool {
        matches!(self.aid, AidKind::Pointer(_))
    }

    /// The robot carries markers over an edge to its unknown end. If no known vertex can be that, it is new.
    /// Otherwise the robot leaves markers there, and comes back.
    fn mark_end<W: ObservedWorld>(&mut self, edge: Dart, world: &mut W) -> Mapped<W> {
        if self.ends.iter().any(|end| end.edge == edge)
            || (self.ends.is_empty() && !self.map().is_unexplored(edge))
        {
            return Err(InvalidStep::NotUnexplored(edge).into());
        }
        self.travel_to(self.map().vertex(edge), world)?;
        // On the way there, it may have become the other end of another edge of this round.
        if !self.map().is_unexplored(edge) {
            return Ok(());
        }
        let door = self.map().door(self.walk.robot, edge);
        let percept = self.walk.go(door, world)?;
        self.walk.edge = Some(edge);
        self.walk.arrival = percept;
        let degree = percept.degree;
        if percept.sighting != Sighting::Nothing {
            let (vertex, index) = (self.map().vertex(edge), self.map().index(edge));
            let same = self.ends.iter().position(|end| end.looks_like(percept));
            let same =
                same.ok_or(Contradiction::SecondMarker { vertex, index, perceived: percept })?;
            self.report(MovableEvent::Arrived { edge, percept, candidates: 1 }, world);
            return self
                .leave_end(UnknownEnd { edge, degree, place: EndPlace::SameAs(same) }, world);
        }
        let places = self.candidates_of(edge, degree);
        let candidates = places.count();
        self.report(MovableEvent::Arrived { edge, percept, candidates }, world);
        if candidates == 0 || InjectedFlaw::EveryPlaceIsNew.is_present() {
            self.walk.add_place(Door::BACK, world)?;
            return Ok(());
        }
        let lying = self.ends.iter().filter_map(|end| match &end.place {
            EndPlace::Marked(marks, _) if end.degree == degree => Some(*marks),
            _ => None,
        });
        let Some(marks) = self.carried.marks_besides(lying) else {
            self.is_full = true;
            return self.go_back(world);
        };
        self.drop(marks, world)?;
        self.leave_end(UnknownEnd { edge, degree, place: EndPlace::Marked(marks, places) }, world)
    }

    fn leave_end<W: ObservedWorld>(&mut self, end: UnknownEnd, world: &mut W) -> Mapped<W> {
        self.ends.push(end);
        self.go_back(world)
    }

    fn candidates_of(&self, edge: Dart, degree: u32) -> Candidates {
        let places = Candidates::of_end(self.map(), edge, degree);
        if self.points() { places } else { places.in_simple_world(self.map(), edge) }
    }

    /// Place validation: looks for the markers at all known vertices where they can lie, in the order in which a
    /// depth-first walk of the shortest paths from the robot meets them.
    // paper: movable.place, movable.known
    fn search<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        self.candidates.clear();
        if self.ends.iter().any(|end| matches!(end.place, EndPlace::Marked(..))) {
            self.walk.write_preorder(&mut self.candidates);
            self.candidates.reverse();
        }
        while let Some(candidate) = self.next_candidate() {
            self.look_for_markers(candidate, world)?;
            if InjectedFlaw::OneCandidateSearched.is_present() {
                break;
            }
        }
        Ok(())
    }

    /// The next candidate that the robot has not passed yet.
    fn next_candidate(&mut self) -> Option<Vertex> {
        while let Some(candidate) = self.candidates.last().copied() {
            if self.is_candidate(candidate) {
                return Some(candidate);
            }
            self.candidates.pop();
        }
        None
    }

    /// Goes through the known map to a candidate, as long as it is one.
    fn look_for_markers<W: ObservedWorld>(
        &mut self,
        candidate: Vertex,
        world: &mut W,
    ) -> Mapped<W> {
        let way = self.walk.way_to(candidate);
        for &dart in &way {
            let Some((next, perceived)) = self.walk.leave_by(dart, world)? else { break };
            self.arrive(next, perceived, world)?;
            if !self.is_candidate(candidate) {
                break;
            }
        }
        self.walk.way = way;
        Ok(())
    }

    /// Whether a known vertex may be the place of markers that are looked for.
    fn is_candidate(&self, vertex: Vertex) -> bool {
        self.ends.iter().any(|end| end.may_be(vertex))
    }

    /// The robot has come in by a dart of the map. If markers are found there, it picks them up.
    fn arrive<W: ObservedWorld>(
        &mut self,
        pose: Dart,
        perceived: Percept,
        world: &mut W,
    ) -> Mapped<W> {
        let (vertex, expected) = (self.map().vertex(pose), self.map().unmarked(pose));
        let found =
            self.ends.iter().position(|end| end.may_be(vertex) && end.looks_like(perceived));
        let Some(found) = found else {
            self.walk.arrive(pose, expected, perceived)?;
            let mut was_candidate = false;
            for end in &mut self.ends {
                was_candidate |= end.exclude(vertex);
            }
            if was_candidate {
                self.report(MovableEvent::NotAt { vertex }, world);
            }
            return Ok(());
        };
        self.walk.robot = pose;
        self.report(MovableEvent::Found { vertex }, world);
        let edge = self.ends[found].edge;
        let (place, other) = if let Sighting::Pointing(door) = perceived.sighting {
            let index = self.map().index(pose);
            let wrong = Contradiction::KnownPlace { vertex, index, expected, perceived };
            let dart = self.map().dart(vertex, (index + door.0) % expected.degree);
            let is_free = |dart: &Dart| *dart != edge && self.map().is_unexplored(*dart);
            let dart = dart.filter(is_free).ok_or(wrong)?;
            (EndPlace::At(dart), Some(dart))
        } else {
            // An only unexplored dart of the vertex needs no validation.
            let mut darts = self.map().unexplored_at(vertex);
            let only = darts.next().filter(|_| darts.next().is_none());
            (EndPlace::Known(vertex), only)
        };
        if let EndPlace::Marked(marks, _) = std::mem::replace(&mut self.ends[found].place, place) {
            self.pick_up(marks, world)?;
        }
        if let Some(other) = other {
            self.walk.edge = Some(edge);
            self.walk.close_loop(other, world)?;
        }
        for end in &mut self.ends {
            end.exclude(vertex);
        }
        Ok(())
    }

    /// The markers that were not found are at new places. The robot goes there again, for the markers.
    // paper: movable.new
    fn fetch<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        while let Some(next) = self.nearest_marked() {
            let UnknownEnd { edge, degree, .. } = self.ends[next];
            let EndPlace::Marked(marks, _) = self.ends[next].place else { break };
            self.report(MovableEvent::NotFound, world);
            if InjectedFlaw::LeftBehind.is_present() {
                self.walk.edge = Some(edge);
                self.walk.arrival = Percept { degree, sighting: Sighting::Nothing };
                let vertex = self.walk.add_place(Door::BACK, world)?;
                self.ends[next].place = EndPlace::Known(vertex);
                continue;
            }
            self.travel_to(self.map().vertex(edge), world)?;
            let door = self.map().door(self.walk.robot, edge);
            let perceived = self.walk.go(door, world)?;
            let expected = Percept { degree, sighting: marks.lying(Door::BACK) };
            if perceived != expected {
                return Err(Contradiction::WayBack { expected, perceived }.into());
            }
            self.walk.edge = Some(edge);
            self.walk.arrival = Percept { sighting: Sighting::Nothing, ..expected };
            if !InjectedFlaw::MarkerLeftBehind.is_present() {
                self.pick_up(marks, world)?;
            }
            let vertex = self.walk.add_place(Door::BACK, world)?;
            self.ends[next].place = EndPlace::Known(vertex);
        }
        Ok(())
    }

    /// Of the ends where markers lie, the one whose known end is nearest.
    fn nearest_marked(&mut self) -> Option<usize> {
        let here = self.map().vertex(self.walk.robot);
        let Self { walk: MapWalk { map, from_robot, .. }, ends, .. } = self;
        let marked = |(_, end): &(usize, &UnknownEnd)| matches!(end.place, EndPlace::Marked(..));
        let mut marked = ends.iter().enumerate().filter(marked);
        let first = marked.next()?;
        let Some(second) = marked.next() else { return Some(first.0) };
        from_robot.grow_from(map, here);
        let hops =
            |(_, end): &(usize, &UnknownEnd)| (from_robot.hops(map.vertex(end.edge)), end.edge);
        [first, second].into_iter().chain(marked).min_by_key(hops).map(|(at, _)| at)
    }

    /// Closes the loops of this round, with back-link validation.
    fn close_loops<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        for at in 0..self.ends.len() {
            let edge = self.ends[at].edge;
            // It may be the other end of an edge before it.
            if !self.map().is_unexplored(edge) {
                continue;
            }
            let other = match self.place_of(at) {
                Some(EndPlace::At(dart)) => dart,
                Some(EndPlace::Known(vertex)) => self.validate_back_link(edge, vertex, world)?,
                _ => return Err(InvalidStep::NoEdge.into()),
            };
            self.walk.edge = Some(edge);
            self.walk.close_loop(other, world)?;
        }
        Ok(())
    }

    /// Where an end of this round is, after all markers were found or fetched.
    fn place_of(&self, end: usize) -> Option<EndPlace> {
        match &self.ends.get(end)?.place {
            EndPlace::SameAs(earlier) if *earlier < end => match self.place_of(*earlier)? {
                EndPlace::At(dart) => Some(EndPlace::Known(self.map().vertex(dart))),
                place => Some(place),
            },
            place => Some(place.clone()),
        }
    }

    /// Back-link validation: which unexplored dart of the known vertex is the other end of `edge`? The robot carries
    /// all markers.
    // paper: movable.back-link
    fn validate_back_link<W: ObservedWorld>(
        &mut self,
        edge: Dart,
        vertex: Vertex,
        world: &mut W,
    ) -> Mapped<W, Dart> {
        // An only unexplored dart of the vertex needs no validation.
        self.back_links.clear();
        self.back_links.extend(self.walk.map.unexplored_at(vertex).rev());
        let no_back_link = Contradiction::NoBackLink { vertex, marked: self.map().vertex(edge) };
        match self.back_links[..] {
            [only] => return Ok(only),
            [.., first] if InjectedFlaw::FirstDartIsIt.is_present() => return Ok(first),
            _ => {}
        }
        // Carry a marker to vk, drop it there, and return without it.
        let marks = self.carried.marks_besides(std::iter::empty()).ok_or(no_back_link)?;
        if InjectedFlaw::NotCarried.is_present() {
            self.drop(marks, world)?;
        } else {
            self.travel_to(self.map().vertex(edge), world)?;
            self.drop(marks, world)?;
            self.travel_to(vertex, world)?;
        }
        // Try the unexplored darts one by one, in the order of indices, until the marker lies behind one.
        while let Some(dart) = self.back_links.pop() {
            if self.try_back_link(dart, edge, world)?
                || InjectedFlaw::RejectedIsConfirmed.is_present()
            {
                self.pick_up(marks, world)?;
                return Ok(dart);
            }
        }
        Err(no_back_link.into())
    }

    /// Follows an unexplored dart of the robot's vertex. Returns whether the marker at the known end of `edge` is behind
    /// it: then the robot is there; otherwise it is back.
    fn try_back_link<W: ObservedWorld>(
        &mut self,
        dart: Dart,
        edge: Dart,
        world: &mut W,
    ) -> Mapped<W, bool> {
        let door = self.map().door(self.walk.robot, dart);
        let percept = self.walk.go(door, world)?;
        if percept.sighting != Sighting::Nothing {
            let expected = Percept { sighting: percept.sighting, ..self.map().unmarked(edge) };
            self.walk.arrive(edge, expected, percept)?;
            self.report(MovableEvent::Behind { dart }, world);
            return Ok(true);
        }
        let back = self.walk.go(Door::BACK, world)?;
        self.walk.arrive(dart, self.map().unmarked(dart), back)?;
        self.report(MovableEvent::NotBehind { dart, percept }, world);
        Ok(false)
    }

    fn drop<W: ObservedWorld>(&mut self, marks: Marks, world: &mut W) -> Mapped<W> {
        for action in marks.drops() {
            handle(action, world)?;
            self.report(MovableEvent::Did(action), world);
        }
        self.carried.remove(marks);
        Ok(())
    }

    fn pick_up<W: ObservedWorld>(&mut self, marks: Marks, world: &mut W) -> Mapped<W> {
        for action in marks.pick_ups() {
            handle(action, world)?;
            self.report(MovableEvent::Did(action), world);
        }
        self.carried.add(marks);
        Ok(())
    }

    /// Goes back over the edge that was just followed.
    fn go_back<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        let edge = self.walk.edge.take().ok_or(InvalidStep::NoEdge)?;
        let perceived = self.walk.go(Door::BACK, world)?;
        self.arrive(edge, perceived, world)
    }

    /// Goes through the known map to a vertex. Markers that are found on the way are picked up.
    fn travel_to<W: ObservedWorld>(&mut self, vertex: Vertex, world: &mut W) -> Mapped<W> {
        let way = self.walk.way_to(vertex);
        for &dart in &way {
            let Some((next, perceived)) = self.walk.leave_by(dart, world)? else { break };
            self.arrive(next, perceived, world)?;
        }
        self.walk.way = way;
        Ok(())
    }

    fn report(&self, event: MovableEvent, world: &mut impl ObservedWorld) {
        world.event(&self.walk, MappingEvent::Movable(event));
    }
}

impl UnknownEnd {
    /// Whether its markers lie at a place that looks like this.
    fn looks_like(&self, place: Percept) -> bool {
        match &self.place {
            EndPlace::Marked(marks, _) => {
                self.degree == place.degree && marks.are_seen(place.sighting)
            }
            _ => false,
        }
    }

    fn may_be(&self, vertex: Vertex) -> bool {
        matches!(&self.place, EndPlace::Marked(_, places) if places.contains(vertex))
    }

    /// It is not this vertex. Returns whether it could be.
    fn exclude(&mut self, vertex: Vertex) -> bool {
        match &mut self.place {
            EndPlace::Marked(_, places) => places.exclude(vertex),
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests;
