//! Classes of darts: a union-find structure in which one union forces others, and which can undo them.

use super::ContradictionReason;
use crate::percept::{Door, Percept, Sighting};

/// A dart whose opposite is not known.
pub(super) const OPEN: u32 = u32::MAX;

/// A dart of a vertex without numbers.
const NO_NUMBER: u32 = u32::MAX;

/// Trail vertices, and which of them are proved to be one.
///
/// A class of trail vertices is represented by the darts of its root. If two poses are one, their
/// vertices are one, and so are the vertices behind the same doors.
#[derive(Clone, Debug, Default)]
pub(super) struct DartClasses {
    /// The first dart of each trail vertex.
    first: Vec<u32>,
    /// The number of moves before the first visit of each trail vertex.
    visit: Vec<usize>,
    /// What was seen at each trail vertex, for a robot that came in by its first dart.
    percept: Vec<Percept>,
    /// The number of trail vertices of each root's class.
    size: Vec<u32>,
    /// The trail vertex of each dart.
    owner: Vec<u32>,
    /// The parent of each dart: the same dart of a larger class. A dart of a root is its own parent.
    parent: Vec<u32>,
    /// The opposite of each dart of a root, as any dart of its class; or [`OPEN`].
    opposite: Vec<u32>,
    /// The number that the user has given to each dart of a root; or [`NO_NUMBER`].
    number: Vec<u32>,
    /// The number of classes of trail vertices.
    count: usize,
    /// The number of open darts of roots.
    open: usize,
    /// What to undo.
    changes: Vec<Change>,
    /// The number of changes before the latest union.
    before_union: usize,
    /// Scratch: darts that have to be identified next.
    pairs: Vec<(u32, u32)>,
}

/// A change by a union.
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
        let Self { first, size, owner, parent, opposite, number, .. } = self;
        for numbers in [first, size, owner, parent, opposite, number] {
            numbers.clear();
        }
        self.visit.clear();
        self.percept.clear();
        self.changes.clear();
        (self.count, self.open, self.before_union) = (0, 0, 0);
    }

    /// Adds a vertex with open darts, a class of its own, and returns its first dart.
    pub(super) fn add_vertex(&mut self, percept: Percept, visit: usize) -> u32 {
        let (vertex, first) = (self.first.len() as u32, self.owner.len() as u32);
        let end = first + percept.degree;
        self.first.push(first);
        self.visit.push(visit);
        self.percept.push(percept);
        self.size.push(1);
        self.owner.resize(end as usize, vertex);
        self.parent.extend(first..end);
        self.opposite.resize(end as usize, OPEN);
        self.number.resize(end as usize, NO_NUMBER);
        self.count += 1;
        self.open += percept.degree as usize;
        first
    }

    /// Makes two open darts of roots the ends of an edge. This is not undone.
    pub(super) fn join(&mut self, one: u32, other: u32) {
        self.opposite[one as usize] = other;
        self.opposite[other as usize] = one;
        self.open -= 2;
    }

    /// Gives numbers to the darts of a root, clockwise from one of them. Vertices with numbers have to
    /// be distinct.
    pub(super) fn set_numbers(&mut self, pose: u32, mut number: u32) {
        for door in 0..self.degree(pose) {
            let dart = self.turned(pose, door);
            self.number[dart as usize] = number;
            number += 1;
        }
    }

    /// The number of a dart, if its class has numbers.
    #[inline]
    pub(super) fn number(&self, dart: u32) -> Option<u32> {
        let number = self.number[self.find(dart) as usize];
        (number != NO_NUMBER).then_some(number)
    }

    /// The number of classes.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// The number of open darts.
    #[inline]
    pub(super) fn open_count(&self) -> usize {
        self.open
    }

    pub(super) fn trail_vertex_count(&self) -> usize {
        self.first.len()
    }

    pub(super) fn dart_count(&self) -> usize {
        self.owner.len()
    }

    /// The dart of a root that stands for a dart.
    #[inline]
    pub(super) fn find(&self, dart: u32) -> u32 {
        let mut dart = dart;
        loop {
            let parent = self.parent[dart as usize];
            if parent == dart {
                return dart;
            }
            dart = parent;
        }
    }

    /// The opposite of a dart of a root, as a dart of a root; or [`OPEN`].
    #[inline]
    pub(super) fn opposite(&self, root: u32) -> u32 {
        match self.opposite[root as usize] {
            OPEN => OPEN,
            opposite => self.find(opposite),
        }
    }

    /// The trail vertex of a dart.
    #[inline]
    pub(super) fn owner(&self, dart: u32) -> u32 {
        self.owner[dart as usize]
    }

    /// The first dart of a trail vertex.
    #[inline]
    pub(super) fn first(&self, vertex: u32) -> u32 {
        self.first[vertex as usize]
    }

    /// The degree of a dart's vertex.
    #[inline]
    pub(super) fn degree(&self, dart: u32) -> u32 {
        self.percept[self.owner[dart as usize] as usize].degree
    }

    /// The darts of a trail vertex.
    pub(super) fn darts_of(&self, vertex: u32) -> std::ops::Range<u32> {
        let first = self.first[vertex as usize];
        first..first + self.percept[vertex as usize].degree
    }

    /// The roots, in the order of their first visits.
    pub(super) fn roots(&self) -> impl Iterator<Item = u32> + '_ {
        let firsts = self.first.iter().copied();
        (0..).zip(firsts).filter(|&(_, first)| self.parent[first as usize] == first).map(|(v, _)| v)
    }

    /// The dart at the same trail vertex that stands some places further clockwise.
    #[inline]
    pub(super) fn turned(&self, dart: u32, places: u32) -> u32 {
        let vertex = self.owner[dart as usize] as usize;
        let (first, degree) = (self.first[vertex], self.percept[vertex].degree);
        let places = if places < degree { places } else { places % degree };
        let index = dart - first;
        // No sum of an index and places, which may overflow.
        first + if index < degree - places { index + places } else { index - (degree - places) }
    }

    /// The door that leads from a dart to another at the same trail vertex.
    #[inline]
    pub(super) fn door(&self, from: u32, to: u32) -> Door {
        let vertex = self.owner[from as usize] as usize;
        let first = self.first[vertex];
        Door::between(from - first, to.wrapping_sub(first), self.percept[vertex].degree)
    }

    /// Compares a percept with what was perceived at a vertex before, for a robot with this pose.
    pub(super) fn compare(
        &self,
        pose: u32,
        percept: Percept,
        moves: usize,
    ) -> Result<(), ContradictionReason> {
        let root = self.owner[pose as usize] as usize;
        let index = pose - self.first[root];
        let (visits, before) = ([self.visit[root], moves], self.percept[root]);
        if before.degree != percept.degree {
            let degrees = [before.degree, percept.degree];
            return Err(ContradictionReason::Degree { visits, degrees });
        }
        compare_sightings(before.seen_from(Door(index)), percept, visits)
    }

    /// Identifies two darts, and all that follows.
    ///
    /// # Errors
    /// Returns an error if no world of any size has them as one dart. Only [`undo`](Self::undo) is then
    /// possible.
    pub(super) fn unite(&mut self, one: u32, other: u32) -> Result<(), ContradictionReason> {
        self.begin_union();
        self.close(one, other, Numbered::Ignored)
    }

    /// [`unite`](Self::unite) for vertices with numbers that are distinct.
    pub(super) fn suppose(&mut self, one: u32, other: u32) -> Result<(), ContradictionReason> {
        self.begin_union();
        self.close(one, other, Numbered::Distinct)
    }

    fn begin_union(&mut self) {
        self.before_union = self.changes.len();
        self.changes.push(Change::Open { before: self.open });
    }

    /// Undoes the latest union.
    pub(super) fn undo(&mut self) {
        let Self { changes, parent, first, percept, size, number, opposite, .. } = self;
        for change in changes.drain(self.before_union..).rev() {
            match change {
                Change::Child { child, root } => {
                    let darts = first[child as usize]..;
                    for dart in darts.take(percept[child as usize].degree as usize) {
                        parent[dart as usize] = dart;
                    }
                    size[root as usize] -= size[child as usize];
                    self.count += 1;
                }
                Change::Numbers { root } => {
                    let darts = first[root as usize] as usize..;
                    for dart in darts.take(percept[root as usize].degree as usize) {
                        number[dart] = NO_NUMBER;
                    }
                }
                Change::Opposite { dart } => opposite[dart as usize] = OPEN,
                Change::Open { before } => self.open = before,
            }
        }
    }

    /// The open darts of roots that the latest union identified with other darts, as they were numbered
    /// before it, if they are not open any more or were identified with a dart of a larger class.
    pub(super) fn identified(&self) -> impl Iterator<Item = u32> + '_ {
        self.changes[self.before_union..].iter().flat_map(move |change| {
            let darts = match *change {
                Change::Child { child, .. } => self.darts_of(child),
                Change::Opposite { dart } => dart..dart + 1,
                Change::Numbers { .. } | Change::Open { .. } => 0..0,
            };
            let is_child = matches!(change, Change::Child { .. });
            darts.filter(move |&dart| !is_child || self.opposite[dart as usize] == OPEN)
        })
    }

    /// Makes each trail vertex a root or the child of one. The unions so far cannot be undone any more.
    pub(super) fn flatten(&mut self) {
        self.before_union = 0;
        if self.changes.is_empty() {
            return;
        }
        self.changes.clear();
        for dart in 0..self.parent.len() {
            self.parent[dart] = self.find(dart as u32);
        }
    }

    /// Identifies two darts, and all that follows.
    fn close(
        &mut self,
        one: u32,
        other: u32,
        numbered: Numbered,
    ) -> Result<(), ContradictionReason> {
        self.pairs.clear();
        self.pairs.push((one, other));
        while let Some((one, other)) = self.pairs.pop() {
            let (one, other) = (self.find(one), self.find(other));
            if one != other {
                self.merge(one, other, numbered)?;
            }
        }
        Ok(())
    }

    /// Makes one class of two.
    fn merge(
        &mut self,
        one: u32,
        other: u32,
        numbered: Numbered,
    ) -> Result<(), ContradictionReason> {
        let (mut root, mut child) = (self.owner[one as usize], self.owner[other as usize]);
        let (mut at_root, mut at_child) = (one, other);
        if root == child {
            return Err(ContradictionReason::Rotation { visit: self.visit[root as usize] });
        }
        if self.size[root as usize] < self.size[child as usize] {
            (root, child, at_root, at_child) = (child, root, at_child, at_root);
        }
        let [before, now] = [root, child].map(|vertex| self.percept[vertex as usize]);
        let visits = || [root, child].map(|vertex| self.visit[vertex as usize]);
        let degree = before.degree;
        if degree != now.degree {
            let degrees = [degree, now.degree];
            return Err(ContradictionReason::Degree { visits: visits(), degrees });
        }
        let numbers = [at_root, at_child].map(|dart| self.number[dart as usize] != NO_NUMBER);
        if numbers == [true; 2] && numbered == Numbered::Distinct {
            return Err(ContradictionReason::Distinct { visits: visits() });
        }
        // The child's first dart, at the root.
        let (at, from) = (self.first[root as usize], self.first[child as usize]);
        let Door(turn) = Door::between(at_child - from, at_root - at, degree);
        if (before.sighting, now.sighting) != (Sighting::Nothing, Sighting::Nothing) {
            compare_sightings(before.seen_from(Door(turn)), now, visits())?;
        }
        self.size[root as usize] += self.size[child as usize];
        self.count -= 1;
        self.changes.push(Change::Child { child, root });
        let takes_numbers = numbers == [false, true];
        if takes_numbers {
            self.changes.push(Change::Numbers { root });
        }
        let mut to = at + turn;
        for from in from..from + degree {
            self.parent[from as usize] = to;
            if takes_numbers {
                self.number[to as usize] = self.number[from as usize];
            }
            to = if to + 1 == at + degree { at } else { to + 1 };
        }
        for from in from..from + degree {
            let to = self.parent[from as usize];
            match [from, to].map(|dart| self.opposite[dart as usize]) {
                [OPEN, _] => self.open -= 1,
                [far, OPEN] => {
                    self.opposite[to as usize] = far;
                    self.open -= 1;
                    self.changes.push(Change::Opposite { dart: to });
                }
                [far, near] => self.pairs.push((far, near)),
            }
            let opposite = self.opposite[to as usize];
            if opposite != OPEN && self.find(opposite) == to {
                let visit = self.visit[root as usize];
                return Err(ContradictionReason::OwnOpposite { visit });
            }
        }
        Ok(())
    }
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
    if before == now { Ok(()) } else { Err(ContradictionReason::Marker { visits, sightings }) }
}
