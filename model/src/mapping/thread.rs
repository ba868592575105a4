//! Mapping with a string as long as it takes, as Ariadne's thread; the paper's introduction names strings among marking
//! aids.
//!
//! The robot walks depth first, and the string runs along its way from the start. When every edge of a place is explored
//! the robot winds the string in, so the string passes every place with unexplored edges. A place without string is
//! new. At a known one, the doors through which the string runs show where that is; if several places look so, the robot
//! drops the string's end there and follows the string until one is left.

use super::{
    Contradiction, CostOrder, Explorer, ExplorerInfo, InvalidStep, MapWalk, Mapped, MappingError,
    MappingEvent, MovableEvent, ObservedWorld, PartialMap, StepPurpose, map_walk::has_walk,
    movable_markers::handle, partial_map::START,
};
use crate::{
    aid::{AidAction, AidKind, string::LaidString},
    clone_in_place::clone_in_place,
    embedded_graph::{Dart, Vertex},
    injected_flaw::InjectedFlaw,
    percept::{Door, DoorSet, Percept, Sighting, StringView},
};

/// The state of a run with a string: the robot's walk, and the way of the string.
#[derive(Debug, Default)]
pub struct ThreadRun {
    walk: MapWalk,
    /// The darts by which the string leaves each vertex on its way.
    way: Vec<Dart>,
    /// The longest way so far, in edges.
    longest: usize,
    hypotheses: Vec<Hypothesis>,
}

clone_in_place!(ThreadRun { walk, way, longest, hypotheses });

has_walk!(ThreadRun);

/// The edge that was just followed leads to this unexplored dart.
#[derive(Clone, Copy, Debug)]
struct Hypothesis {
    other: Dart,
    /// The dart by which the robot came in last.
    pose: Dart,
}

/// Where the string runs: over the way, whose last edge leads to a dart that the map may not know.
#[derive(Clone, Copy)]
struct Laid<'s> {
    map: &'s PartialMap,
    way: &'s [Dart],
    last: Option<Dart>,
    is_held: bool,
}

/// Depth-first mapping with a string. The default choice is the first unexplored dart of the last place on the string's
/// way that has one.
impl Explorer for ThreadRun {
    type Aid = AidKind;
    type Choice = Dart;

    fn info(&self) -> ExplorerInfo {
        ExplorerInfo {
            option: "string",
            title: "Depth-first with a string",
            in_words: "depth-first mapping with a string",
            order: CostOrder::EdgesVertices,
        }
    }

    fn aid(&self) -> AidKind {
        AidKind::String(LaidString::of_any_length())
    }

    fn limit_darts(&mut self, max_darts: usize) {
        self.walk.set_bound(max_darts);
    }

    fn begin<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        self.walk.clear();
        self.way.clear();
        self.longest = 0;
        self.hypotheses.clear();
        let percept = world.percept().map_err(MappingError::World)?;
        let fixed = StringView { fixed_end: true, ..StringView::default() };
        if percept.degree == 0 || percept.sighting != Sighting::String(fixed) {
            return Err(Contradiction::StartWithoutMarker { perceived: percept }.into());
        }
        self.walk.begin(percept, world)?;
        Ok(())
    }

    fn choose(&mut self) -> Result<Option<Dart>, InvalidStep> {
        Ok(self.last_frontier().and_then(|vertex| self.map().unexplored_at(vertex).next()))
    }

    fn add_choices(&mut self, choices: &mut Vec<Dart>) -> Result<(), InvalidStep> {
        let vertex = self.last_frontier();
        choices.extend(vertex.into_iter().flat_map(|vertex| self.map().unexplored_at(vertex)));
        Ok(())
    }

    /// Winds the string in, up to the known end of the edge.
    fn approach<W: ObservedWorld>(&mut self, edge: Dart, world: &mut W) -> Mapped<W> {
        let vertex = self.map().vertex(edge);
        while self.map().vertex(self.walk.robot) != vertex {
            let Some(last) = self.way.pop() else { break };
            let by = self.map().opposite(last).ok_or(InvalidStep::NoEdge)?;
            let Some((next, perceived)) = self.walk.leave_by(by, world)? else { break };
            let expected = self.laid(None, true).percept(next);
            self.walk.arrive(next, expected, perceived)?;
        }
        Ok(())
    }

    fn step<W: ObservedWorld>(&mut self, edge: Dart, world: &mut W) -> Mapped<W> {
        let is_open = self.map().is_unexplored(edge);
        if !is_open || self.last_frontier() != Some(self.map().vertex(edge)) {
            return Err(InvalidStep::NotUnexplored(edge).into());
        }
        self.approach(edge, world)?;
        let percept = self.walk.go(self.map().door(self.walk.robot, edge), world)?;
        self.walk.edge = Some(edge);
        self.walk.arrival = percept;
        self.way.push(edge);
        self.longest = self.longest.max(self.way.len());
        self.list_hypotheses(edge, percept);
        let candidates = self.hypotheses.len();
        self.report(MovableEvent::Arrived { edge, percept, candidates }, world);
        if percept.sighting == new_place() || InjectedFlaw::EveryPlaceIsNew.is_present() {
            self.walk.arrival.sighting = Sighting::Nothing;
            self.walk.add_place(Door::BACK, world)?;
            return Ok(());
        }
        self.close_loop(edge, world)
    }

    fn map_walk(&self) -> Option<&MapWalk> {
        Some(&self.walk)
    }

    fn purpose(&self, edge: Option<Dart>) -> StepPurpose {
        self.walk.purpose(edge)
    }

    /// `2 (n - 1) + 2 n (m - n + 1)`. The string is never longer than n edges.
    ///
    /// Each of the n - 1 edges that lead to a new place is walked there and back. Each other edge leads from the last place
    /// of the way to a place on it, and is walked there and back. To know that place, the robot follows the
    /// string from there to its fixed end, and returns: at most `2 (n - 1)` moves; or the other way round, over the
    /// edge, until it is there again: at most `n`.
    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        let (m, n) = (edges as u64, vertices as u64);
        let loops = (m + 1).saturating_sub(n);
        let new = n.saturating_sub(1).saturating_mul(2);
        new.saturating_add(loops.saturating_mul(n.saturating_mul(2)))
    }
}

/// What is seen of the string at a new place.
fn new_place() -> Sighting {
    let mut doors = DoorSet::default();
    doors.insert(Door::BACK);
    Sighting::String(StringView { doors, hand: Some(Door::BACK), ..StringView::default() })
}

impl ThreadRun {
    /// The edges that the string was long at most.
    pub fn longest_way(&self) -> usize {
        self.longest
    }

    fn laid(&self, last: Option<Dart>, is_held: bool) -> Laid<'_> {
        Laid { map: self.map(), way: &self.way, last, is_held }
    }

    /// The vertices on the way of the string, from the robot's to the start.
    fn way_back(&self) -> impl Iterator<Item = Vertex> {
        let map = self.map();
        let ends = self.way.iter().rev().filter_map(|dart| map.opposite(*dart));
        ends.map(|dart| map.vertex(dart)).chain((map.vertex_count() > 0).then_some(START))
    }

    /// The last vertex on the way of the string with an unexplored dart.
    fn last_frontier(&self) -> Option<Vertex> {
        self.way_back().find(|vertex| self.map().is_frontier(*vertex))
    }

    /// The unexplored darts to which the edge can lead: what is seen of the string there is what the robot sees.
    fn list_hypotheses(&mut self, edge: Dart, percept: Percept) {
        let mut found = std::mem::take(&mut self.hypotheses);
        found.clear();
        for vertex in self.way_back() {
            let darts = self.map().unexplored_at(vertex).filter(|dart| *dart != edge);
            let fits = |dart: &Dart| self.laid(Some(*dart), true).percept(*dart) == percept;
            found.extend(darts.filter(fits).map(|dart| Hypothesis { other: dart, pose: dart }));
        }
        self.hypotheses = found;
    }

    /// The edge leads to a known place. The robot finds out which, and returns over the edge, unless all is explored.
    fn close_loop<W: ObservedWorld>(&mut self, edge: Dart, world: &mut W) -> Mapped<W> {
        let is_known = self.hypotheses.len() == 1;
        if !is_known && !InjectedFlaw::OneHypothesisExamined.is_present() {
            self.handle(AidAction::Drop, world)?;
            self.follow_string(edge, world)?;
        }
        let (vertex, index) = (self.map().vertex(edge), self.map().index(edge));
        let perceived = self.walk.arrival;
        let contradiction = Contradiction::Marker { vertex, index, perceived };
        let &Hypothesis { other, pose } = self.hypotheses.first().ok_or(contradiction)?;
        self.walk.close_loop(other, world)?;
        self.walk.robot = pose;
        if self.map().unexplored_is_empty() {
            return Ok(());
        }
        if !is_known {
            let way = self.walk.way_to(self.map().vertex(other));
            for &dart in &way {
                let Some((next, perceived)) = self.walk.leave_by(dart, world)? else { break };
                let expected = self.laid(None, false).percept(next);
                self.walk.arrive(next, expected, perceived)?;
            }
            self.walk.way = way;
            self.handle(AidAction::PickUp, world)?;
        }
        self.approach_over(other, world)
    }

    /// Winds the string in over the last edge of its way, from the dart to which that leads.
    fn approach_over<W: ObservedWorld>(&mut self, by: Dart, world: &mut W) -> Mapped<W> {
        self.way.pop();
        if let Some((next, perceived)) = self.walk.leave_by(by, world)? {
            let expected = self.laid(None, true).percept(next);
            self.walk.arrive(next, expected, perceived)?;
        }
        Ok(())
    }

    /// Follows the string from where its end was dropped until one hypothesis is left. At the latest this is so at an end
    /// of the string: the distance to it differs from place to place.
    fn follow_string<W: ObservedWorld>(&mut self, edge: Dart, world: &mut W) -> Mapped<W> {
        let mut seen = self.walk.arrival;
        while self.hypotheses.len() > 1 {
            let Sighting::String(view) = seen.sighting else { break };
            let Some(door) = view.doors.doors().find(|door| *door != Door::BACK) else { break };
            let percept = self.walk.go(door, world)?;
            let (map, way) = (self.walk.map(), &self.way);
            self.hypotheses.retain_mut(|Hypothesis { other, pose }| {
                let index = (map.index(*pose) + door.0) % map.degree(map.vertex(*pose));
                let by = map.dart(map.vertex(*pose), index);
                let next = match by {
                    Some(by) if by == edge => Some(*other),
                    Some(by) if by == *other => Some(edge),
                    by => by.and_then(|by| map.opposite(by)),
                };
                let Some(next) = next else { return false };
                *pose = next;
                let laid = Laid { map, way, last: Some(*other), is_held: false };
                laid.percept(next) == percept
            });
            seen = percept;
        }
        Ok(())
    }

    fn handle<W: ObservedWorld>(&self, action: AidAction, world: &mut W) -> Mapped<W> {
        handle(action, world)?;
        self.report(MovableEvent::Did(action), world);
        Ok(())
    }

    fn report(&self, event: MovableEvent, world: &mut impl ObservedWorld) {
        world.event(&self.walk, MappingEvent::Movable(event));
    }
}

impl Laid<'_> {
    /// The dart to which the last edge of the way leads.
    fn end(&self) -> Option<Dart> {
        self.last.or_else(|| self.way.last().and_then(|dart| self.map.opposite(*dart)))
    }

    /// The percept expected of a robot that comes in by a dart.
    fn percept(&self, pose: Dart) -> Percept {
        let vertex = self.map.vertex(pose);
        let degree = self.map.degree(vertex);
        let mut doors = DoorSet::default();
        let fars = self.way.iter().filter_map(|dart| self.map.opposite(*dart));
        let runs = self.way.iter().copied().chain(fars).chain(self.last);
        for dart in runs.filter(|dart| self.map.vertex(*dart) == vertex) {
            doors.insert(self.map.door(pose, dart));
        }
        let end = self.end();
        let is_here = |dart: &Dart| self.map.vertex(*dart) == vertex;
        let hand = end.filter(|_| self.is_held).filter(is_here);
        let view = StringView {
            doors,
            fixed_end: vertex == START,
            free_end: !self.is_held && end.as_ref().is_some_and(is_here),
            hand: hand.map(|dart| self.map.door(pose, dart)),
        };
        let sighting =
            if view == StringView::default() { Sighting::Nothing } else { Sighting::String(view) };
        Percept { degree, sighting }
    }
}

#[cfg(test)]
mod tests;
