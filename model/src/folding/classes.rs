//! Classes of darts: a union-find structure in which one union forces others, and which can undo them.

use std::ops::Range;

use super::{
    ContradictionReason,
    senses::{ArrivalSenses, LengthInterval, SensedTrail},
};
use crate::clone_in_place::clone_in_place;
use crate::direction::Direction;
use crate::injected_flaw::InjectedFlaw;
use crate::percept::{Door, Percept, Sighting};

/// A dart whose opposite is not known.
pub(super) const OPEN: u32 = u32::MAX;

/// A dart of a vertex without numbers.
const NO_NUMBER: u32 = u32::MAX;

/// Trail vertices, and which of them are proved to be one.
///
/// A class of trail vertices is represented by the darts of its root. If two poses are one, their
/// vertices are one, and so are the vertices behind the same doors.
#[derive(Debug, Default)]
pub(super) struct DartClasses {
    vertices: Vec<TrailVertex>,
    darts: Vec<TrailDart>,
    sensed: SensedTrail,
    /// The number of classes.
    pub(super) count: usize,
    /// The number of open darts of roots.
    pub(super) open: usize,
    changes: Vec<Change>,
    /// The number of changes before the latest union.
    before_union: usize,
    pairs: Vec<(u32, u32)>,
}

clone_in_place!(DartClasses {
    vertices, darts, sensed, count, open, changes, before_union; scratch pairs
});

/// A vertex for each percept at a place that was not known.
#[derive(Clone, Copy, Debug)]
struct TrailVertex {
    first: u32,
    /// The number of trail vertices in its class, if it is a root.
    size: u32,
    /// What was seen at it, for a robot that came in by its first dart.
    percept: Percept,
    /// The number of moves before it was seen.
    visit: usize,
}

#[derive(Clone, Copy, Debug)]
struct TrailDart {
    owner: u32,
    /// The same dart of a larger class. A dart of a root is its own parent.
    parent: u32,
    /// If its vertex is a root, its opposite, as any dart of its class; or [`OPEN`].
    opposite: u32,
    /// If its vertex is a root, the number that the user has given to it; or [`NO_NUMBER`].
    number: u32,
}

impl TrailVertex {
    fn darts(&self) -> Range<u32> {
        self.first..self.first + self.percept.degree
    }
}

#[derive(Clone, Copy, Debug)]
enum Change {
    /// A root became the child of another root.
    Child { child: u32, root: u32 },
    /// The darts of a root had no numbers.
    Numbers { root: u32 },
    /// The opposite of a dart was open.
    Opposite { dart: u32 },
    /// The number of open darts was another.
    Open { before: usize },
    /// The length of the edge of a root's dart was another.
    Length { dart: u32, before: LengthInterval },
    /// The directions at a root were not known.
    View { root: u32 },
}

/// Whether two vertices with numbers are distinct.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Numbered {
    /// They are, so that a union of them is a contradiction at once.
    Distinct,
    /// That follows from the union, or does not.
    Ignored,
}

impl DartClasses {
    pub(super) fn clear(&mut self) {
        self.vertices.clear();
        self.darts.clear();
        self.sensed.clear();
        self.changes.clear();
        (self.count, self.open, self.before_union) = (0, 0, 0);
    }

    /// Adds a vertex with open darts, a class of its own, and returns its first dart.
    pub(super) fn add_vertex(&mut self, percept: Percept, visit: usize) -> u32 {
        let (owner, first) = (self.vertices.len() as u32, self.darts.len() as u32);
        let vertex = TrailVertex { first, size: 1, percept, visit };
        let new = |parent| TrailDart { owner, parent, opposite: OPEN, number: NO_NUMBER };
        self.darts.extend(vertex.darts().map(new));
        self.vertices.push(vertex);
        self.count += 1;
        self.open += percept.degree as usize;
        first
    }

    /// Makes two open darts of roots the ends of an edge. This is not undone.
    pub(super) fn join(&mut self, one: u32, other: u32) {
        self.darts[one as usize].opposite = other;
        self.darts[other as usize].opposite = one;
        self.open -= 2;
    }

    /// Gives numbers to the darts of a root, clockwise from one of them. Vertices with numbers have to
    /// be distinct.
    pub(super) fn set_numbers(&mut self, pose: u32, mut number: u32) {
        for door in 0..self.degree(pose) {
            let dart = self.turned(pose, door);
            self.darts[dart as usize].number = number;
            number += 1;
        }
    }

    #[inline]
    pub(super) fn number(&self, dart: u32) -> Option<u32> {
        let number = self.darts[self.find(dart) as usize].number;
        (number != NO_NUMBER).then_some(number)
    }

    pub(super) fn trail_vertex_count(&self) -> usize {
        self.vertices.len()
    }

    pub(super) fn dart_count(&self) -> usize {
        self.darts.len()
    }

    /// The dart of a root that stands for a dart.
    #[inline]
    pub(super) fn find(&self, dart: u32) -> u32 {
        let mut dart = dart;
        loop {
            let parent = self.darts[dart as usize].parent;
            if parent == dart {
                return dart;
            }
            dart = parent;
        }
    }

    /// The opposite of a dart of a root, as a dart of a root; or [`OPEN`].
    #[inline]
    pub(super) fn opposite(&self, root: u32) -> u32 {
        match self.darts[root as usize].opposite {
            OPEN => OPEN,
            opposite => self.find(opposite),
        }
    }

    #[inline]
    pub(super) fn is_open(&self, root: u32) -> bool {
        self.darts[root as usize].opposite == OPEN
    }

    #[inline]
    pub(super) fn next_around(&self, dart: u32) -> u32 {
        let darts = self.vertex(dart).darts();
        if dart + 1 == darts.end { darts.start } else { dart + 1 }
    }

    #[inline]
    pub(super) fn owner(&self, dart: u32) -> u32 {
        self.darts[dart as usize].owner
    }

    #[inline]
    fn vertex(&self, dart: u32) -> &TrailVertex {
        &self.vertices[self.owner(dart) as usize]
    }

    #[inline]
    pub(super) fn first(&self, vertex: u32) -> u32 {
        self.vertices[vertex as usize].first
    }

    /// What was seen at a dart's trail vertex, from this pose, if that was before a number of moves.
    pub(super) fn seen_before(&self, pose: u32, moves: usize) -> Option<Percept> {
        let &TrailVertex { first, percept, visit, .. } =
            self.vertices.get(self.darts.get(pose as usize)?.owner as usize)?;
        (visit < moves).then(|| percept.seen_from(Door(pose - first)))
    }

    /// What was seen at a dart's trail vertex, by a robot that came in by its first dart.
    #[inline]
    pub(super) fn percept(&self, dart: u32) -> Percept {
        self.vertex(dart).percept
    }

    pub(super) fn visit(&self, dart: u32) -> usize {
        self.vertex(dart).visit
    }

    #[inline]
    pub(super) fn degree(&self, dart: u32) -> u32 {
        self.percept(dart).degree
    }

    pub(super) fn darts_of(&self, vertex: u32) -> Range<u32> {
        self.vertices[vertex as usize].darts()
    }

    /// The roots, in the order of their first visits.
    pub(super) fn roots(&self) -> impl Iterator<Item = u32> + '_ {
        let is_root = |first: u32| self.darts[first as usize].parent == first;
        let roots = (0..).zip(&self.vertices).filter(move |(_, vertex)| is_root(vertex.first));
        roots.map(|(root, _)| root)
    }

    /// The dart at the same trail vertex that stands some places further clockwise.
    #[inline]
    pub(super) fn turned(&self, dart: u32, places: u32) -> u32 {
        let &TrailVertex { first, percept: Percept { degree, .. }, .. } = self.vertex(dart);
        let places = if places < degree { places } else { places % degree };
        let index = dart - first;
        // No sum of an index and places, which may overflow.
        first + if index < degree - places { index + places } else { index - (degree - places) }
    }

    #[inline]
    pub(super) fn door(&self, from: u32, to: u32) -> Door {
        let &TrailVertex { first, percept, .. } = self.vertex(from);
        Door::between(from - first, to.wrapping_sub(first), percept.degree)
    }

    /// Compares a percept with what was perceived at a vertex before, for a robot with this pose.
    pub(super) fn compare(
        &self,
        pose: u32,
        percept: Percept,
        moves: usize,
    ) -> Result<(), ContradictionReason> {
        let &TrailVertex { first, percept: before, visit, .. } = self.vertex(pose);
        let visits = [visit, moves];
        if before.degree != percept.degree {
            let degrees = [before.degree, percept.degree];
            return Err(ContradictionReason::Degree { visits, degrees });
        }
        compare_sightings(before.seen_from(Door(pose - first)), percept, visits)
    }

    /// Compares what a robot senses with this pose, a dart of a root, with what was sensed before, and keeps both. The length
    /// is that of the pose's edge; of an open one it is not kept. This is not undone.
    pub(super) fn sense(
        &mut self,
        pose: u32,
        senses: ArrivalSenses,
        moves: usize,
    ) -> Result<(), ContradictionReason> {
        let &TrailVertex { first, percept: Percept { degree, .. }, visit, .. } = self.vertex(pose);
        let visits = [visit, moves];
        if let Some(now) = senses.view(degree) {
            match self.view(pose) {
                Some(before) => compare_sightings(before, now, visits)?,
                None => self.sensed.set_view(self.owner(pose), pose - first, now),
            }
        }
        if let (Some(now), far) = (senses.length, self.opposite(pose))
            && far != OPEN
        {
            let length = common_length(self.sensed.length(pose), now, visits)?;
            self.sensed.set_length(pose, length);
            self.sensed.set_length(far, length);
        }
        Ok(())
    }

    /// The length of the edge of a dart of a root.
    pub(super) fn length(&self, root: u32) -> LengthInterval {
        self.sensed.length(root)
    }

    /// The direction of a dart of a root, if it was seen.
    pub(super) fn direction(&self, root: u32) -> Option<Direction> {
        match self.view(root)?.sighting {
            Sighting::Compass(view) => view.directions().next(),
            _ => None,
        }
    }

    /// The directions at the vertex of a dart, for a robot with this pose, as a percept; `None` if they were not seen.
    fn view(&self, dart: u32) -> Option<Percept> {
        let index = dart - self.vertex(dart).first;
        let view = self.sensed.view(self.owner(dart), self.degree(dart))?;
        Some(view.seen_from(Door(index)))
    }

    /// Whether what was sensed of two darts, by itself, allows that they are one: the lengths of their edges, and the directions
    /// at their vertices.
    #[inline]
    pub(super) fn senses_agree(&self, one: u32, other: u32) -> bool {
        self.sensed.is_empty() || self.compare_senses(self.find(one), self.find(other)).is_ok()
    }

    /// The length of the edge of two darts that are one, if what was sensed of them allows that. They are darts of roots, or the
    /// second is of one that has become a child.
    fn compare_senses(&self, one: u32, other: u32) -> Result<LengthInterval, ContradictionReason> {
        let visits = [one, other].map(|dart| self.visit(dart));
        if let (Some(one), Some(other)) = (self.view(one), self.view(other)) {
            compare_sightings(one, other, visits)?;
        }
        common_length(self.sensed.length(one), self.sensed.length(other), visits)
    }

    /// Identifies two darts, and all that follows.
    ///
    /// # Errors
    /// Returns an error if no world of any size has them as one dart. Only [`undo`](Self::undo) is then
    /// possible.
    pub(super) fn unite(&mut self, one: u32, other: u32) -> Result<(), ContradictionReason> {
        self.close(one, other, Numbered::Ignored)
    }

    /// [`unite`](Self::unite) for vertices with numbers that are distinct.
    pub(super) fn suppose(&mut self, one: u32, other: u32) -> Result<(), ContradictionReason> {
        self.close(one, other, Numbered::Distinct)
    }

    pub(super) fn change_count(&self) -> usize {
        self.changes.len()
    }

    pub(super) fn undo(&mut self) {
        self.undo_to(self.before_union);
    }

    /// Undoes the latest unions, so that this many changes are left.
    pub(super) fn undo_to(&mut self, count: usize) {
        let Self { changes, vertices, darts, .. } = self;
        while changes.len() > count
            && let Some(change) = changes.pop()
        {
            match change {
                Change::Child { child, root } => {
                    let &TrailVertex { first, size, percept, .. } = &vertices[child as usize];
                    let darts = darts[first as usize..].iter_mut().zip(first..);
                    for (dart, number) in darts.take(percept.degree as usize) {
                        dart.parent = number;
                    }
                    vertices[root as usize].size -= size;
                    self.count += 1;
                }
                Change::Numbers { root } => {
                    let &TrailVertex { first, percept, .. } = &vertices[root as usize];
                    let darts = darts[first as usize..].iter_mut();
                    for dart in darts.take(percept.degree as usize) {
                        dart.number = NO_NUMBER;
                    }
                }
                Change::Opposite { dart } => darts[dart as usize].opposite = OPEN,
                Change::Open { before } => self.open = before,
                Change::Length { .. } if InjectedFlaw::LengthNotRestored.is_present() => {}
                Change::Length { dart, before } => self.sensed.set_length(dart, before),
                Change::View { root } => self.sensed.clear_view(root),
            }
        }
    }

    /// Visits the open darts of roots that the latest union identified with other darts, as they were
    /// numbered before it, if they are not open any more or were identified with a dart of a larger class.
    #[inline]
    pub(super) fn for_each_identified(&self, mut visit: impl FnMut(u32)) {
        for change in &self.changes[self.before_union..] {
            match *change {
                Change::Child { child, .. } => {
                    let darts = self.darts_of(child);
                    darts
                        .filter(|&dart| self.darts[dart as usize].opposite == OPEN)
                        .for_each(&mut visit);
                }
                Change::Opposite { dart } => visit(dart),
                Change::Numbers { .. }
                | Change::Open { .. }
                | Change::Length { .. }
                | Change::View { .. } => {}
            }
        }
    }

    /// Makes each trail vertex a root or the child of one. The unions so far cannot be undone any more.
    pub(super) fn flatten(&mut self) {
        self.before_union = 0;
        if self.changes.is_empty() {
            return;
        }
        self.changes.clear();
        for vertex in 0..self.vertices.len() {
            let TrailVertex { first, .. } = self.vertices[vertex];
            let parent = self.darts[first as usize].parent;
            if self.darts[parent as usize].parent != parent {
                for dart in self.vertices[vertex].darts() {
                    self.darts[dart as usize].parent = self.find(dart);
                }
            }
        }
    }

    fn close(
        &mut self,
        one: u32,
        other: u32,
        numbered: Numbered,
    ) -> Result<(), ContradictionReason> {
        self.before_union = self.changes.len();
        self.changes.push(Change::Open { before: self.open });
        self.pairs.clear();
        let mut next = Some((one, other));
        while let Some((one, other)) = next {
            let (one, other) = (self.find(one), self.find(other));
            if one != other {
                self.merge(one, other, numbered)?;
            }
            next = self.pairs.pop();
        }
        Ok(())
    }

    #[inline]
    fn merge(
        &mut self,
        one: u32,
        other: u32,
        numbered: Numbered,
    ) -> Result<(), ContradictionReason> {
        let (mut root, mut child) = (self.owner(one), self.owner(other));
        let (mut at_root, mut at_child) = (one, other);
        let (mut large, mut small) =
            (&self.vertices[root as usize], &self.vertices[child as usize]);
        if root == child {
            return Err(ContradictionReason::Rotation { visit: large.visit });
        }
        if large.size < small.size {
            (root, child, at_root, at_child) = (child, root, at_child, at_root);
            (large, small) = (small, large);
        }
        let visits = || [large.visit, small.visit];
        let degree = large.percept.degree;
        if degree != small.percept.degree {
            let degrees = [degree, small.percept.degree];
            return Err(ContradictionReason::Degree { visits: visits(), degrees });
        }
        let numbers = [at_root, at_child].map(|dart| self.darts[dart as usize].number != NO_NUMBER);
        if numbers == [true; 2] && numbered == Numbered::Distinct {
            return Err(ContradictionReason::Distinct { visits: visits() });
        }
        // The child's first dart, at the root.
        let (at, from) = (large.first, small.first);
        let Door(turn) = Door::between(at_child - from, at_root - at, degree);
        let [before, now] = [large, small].map(|vertex| vertex.percept);
        if (before.sighting, now.sighting) != (Sighting::Nothing, Sighting::Nothing) {
            compare_sightings(before.seen_from(Door(turn)), now, visits())?;
        }
        self.vertices[root as usize].size += small.size;
        self.count -= 1;
        self.changes.push(Change::Child { child, root });
        if numbers == [false, true] {
            self.changes.push(Change::Numbers { root });
            for door in 0..degree {
                let to = self.turned(at + turn, door);
                self.darts[to as usize].number = self.darts[(from + door) as usize].number;
            }
        }
        let mut to = at + turn;
        for from in from..from + degree {
            let dart = &mut self.darts[from as usize];
            dart.parent = to;
            match dart.opposite {
                // No dart is the opposite of an open one. So the dart does not become its own.
                OPEN => self.open -= 1,
                far => match self.darts[to as usize].opposite {
                    OPEN => {
                        self.darts[to as usize].opposite = far;
                        self.open -= 1;
                        self.changes.push(Change::Opposite { dart: to });
                    }
                    near if self.find(near) == to => {
                        let visit = self.vertices[root as usize].visit;
                        return Err(ContradictionReason::OwnOpposite { visit });
                    }
                    _ if InjectedFlaw::ForcedNotUnited.is_present() => {}
                    near => self.pairs.push((far, near)),
                },
            }
            to = if to + 1 == at + degree { at } else { to + 1 };
        }
        if self.sensed.is_empty() { Ok(()) } else { self.merge_senses((at, from), turn) }
    }

    /// What was sensed of a child is true of its root. `first` are the first darts of both; that of the child is so many places
    /// clockwise from that of the root.
    fn merge_senses(&mut self, first: (u32, u32), turn: u32) -> Result<(), ContradictionReason> {
        let (at, from) = first;
        let degree = self.degree(at);
        for door in 0..degree {
            let (to, from) = (self.turned(at, turn + door), from + door);
            let (before, length) = (self.sensed.length(to), self.compare_senses(to, from)?);
            if length != before {
                self.changes.push(Change::Length { dart: to, before });
                self.sensed.set_length(to, length);
            }
        }
        let [root, child] = [at, from].map(|dart| self.owner(dart));
        if let (None, Some(view)) =
            (self.sensed.view(root, degree), self.sensed.view(child, degree))
        {
            self.changes.push(Change::View { root });
            self.sensed.set_view(root, turn, view);
        }
        Ok(())
    }
}

/// The length of an edge that has two lengths.
fn common_length(
    before: LengthInterval,
    now: LengthInterval,
    visits: [usize; 2],
) -> Result<LengthInterval, ContradictionReason> {
    let common = before.intersection(now);
    let common = common.or(InjectedFlaw::LengthsNotCompared.is_present().then_some(before));
    common.ok_or(ContradictionReason::Length { visits, lengths: [before, now] })
}

/// Compares what is seen at one vertex, for one pose. A mark on an edge is not at a vertex.
fn compare_sightings(
    before: Percept,
    now: Percept,
    visits: [usize; 2],
) -> Result<(), ContradictionReason> {
    use Sighting::{Nothing, Passed, PassedAgainst, PassedAlong};
    let [before, now] = [before.sighting, now.sighting].map(|sighting| match sighting {
        Passed | PassedAlong | PassedAgainst => Nothing,
        at_vertex => at_vertex,
    });
    let sightings = [before, now];
    if before == now || InjectedFlaw::SightingsNotCompared.is_present() {
        Ok(())
    } else {
        Err(ContradictionReason::Marker { visits, sightings })
    }
}
