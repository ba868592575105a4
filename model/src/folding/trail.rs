//! A trail with undoable unions: the vertices that a walk has visited, folded as far as is proved.

use super::{ContradictionReason, MAX_DARTS, TrailError};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    percept::{Door, Percept, Sighting},
};

/// A dart whose opposite is not known.
const OPEN: u32 = u32::MAX;

/// The folded trail of a walk.
///
/// The darts of all trail vertices are numbered in the order of the walk, those of a vertex clockwise
/// from the one by which the robot first came in. Trail vertices that are proved to be one vertex form
/// a class, a tree of a union-find structure that also keeps by how much one vertex is turned against
/// the other. A class is represented by the darts of its root.
#[derive(Clone, Debug, Default)]
pub struct FoldedTrail {
    /// The first dart of each trail vertex.
    first: Vec<u32>,
    /// The number of moves before the first visit of each trail vertex.
    visit: Vec<usize>,
    /// What was seen at each trail vertex, for a robot that came in by its first dart.
    percept: Vec<Percept>,
    /// The parent of each trail vertex; a root is its own parent.
    parent: Vec<u32>,
    /// The index, at the parent, of the first dart of each trail vertex.
    turn: Vec<u32>,
    /// The number of trail vertices of each root's class.
    size: Vec<u32>,
    /// The trail vertex of each dart.
    owner: Vec<u32>,
    /// The opposite of each dart of a root, as any dart of its class; or [`OPEN`].
    opposite: Vec<u32>,
    /// The dart along which the marker points.
    marker: Option<Dart>,
    /// The dart by which the robot has come in.
    pose: u32,
    moves: usize,
    /// The number of classes.
    classes: usize,
    /// The number of open darts of roots.
    open: usize,
    /// What to undo.
    changes: Vec<Change>,
    /// The number of changes before the latest union.
    before_union: usize,
    /// Scratch: darts that have to be identified next.
    pairs: Vec<(u32, u32)>,
}

/// A folded trail as a world.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClosedTrail {
    /// The world.
    pub graph: EmbeddedGraph,
    /// The dart along which the marker points, if it was seen.
    pub marker: Option<Dart>,
    /// The dart by which the robot has come in.
    pub pose: Dart,
}

/// A change by a union.
#[derive(Clone, Copy, Debug)]
enum Change {
    /// A root became the child of another root.
    Child { child: u32, root: u32 },
    /// The opposite of a dart was open.
    Opposite { dart: u32 },
    /// The number of open darts was another.
    Open { before: usize },
}

impl FoldedTrail {
    /// Begins another walk. Memory is kept.
    ///
    /// # Errors
    /// Returns an error if no vertex has the percept, or if it has too many darts.
    pub fn restart(&mut self, percept: Percept) -> Result<(), TrailError> {
        let Self { first, visit, percept: percepts, parent, turn, size, owner, .. } = self;
        for numbers in [first, parent, turn, size, owner] {
            numbers.clear();
        }
        visit.clear();
        percepts.clear();
        self.opposite.clear();
        self.changes.clear();
        self.before_union = 0;
        (self.marker, self.pose, self.moves, self.classes, self.open) = (None, 0, 0, 0, 0);
        self.add_vertex(percept).map(|_| ())
    }

    /// The trail of a walk that begins with a percept.
    ///
    /// # Errors
    /// Returns an error if no vertex has the percept, or if it has too many darts.
    pub fn new(percept: Percept) -> Result<Self, TrailError> {
        let mut trail = Self::default();
        trail.restart(percept)?;
        Ok(trail)
    }

    /// Whether the robot's vertex has a door.
    pub(super) fn check_door(&self, door: Door) -> Result<(), ContradictionReason> {
        let degree = self.degree_at(self.pose);
        if door.0 < degree {
            Ok(())
        } else {
            Err(ContradictionReason::NoSuchDoor { door: door.0, degree })
        }
    }

    /// One move: the door taken, and the percept behind it.
    ///
    /// # Errors
    /// Returns an error if no world of any size explains the walk, or if it has too many darts. The
    /// trail is then of no more use.
    pub fn step(&mut self, door: Door, percept: Percept) -> Result<(), TrailError> {
        self.check_door(door)?;
        self.moves += 1;
        let leaving = self.find(self.turned(self.pose, door.0));
        if self.opposite[leaving as usize] == OPEN {
            let vertex = self.add_vertex(percept)?;
            let entry = self.first[vertex as usize];
            self.opposite[leaving as usize] = entry;
            self.opposite[entry as usize] = leaving;
            self.open -= 2;
            self.pose = entry;
            self.identify_marker(vertex)?;
        } else {
            self.pose = self.find(self.opposite[leaving as usize]);
            self.compare(self.pose, percept)?;
        }
        self.flatten();
        Ok(())
    }

    /// Makes each trail vertex a root or the child of one. The unions so far cannot be undone any more.
    fn flatten(&mut self) {
        self.before_union = 0;
        if self.changes.is_empty() {
            return;
        }
        self.changes.clear();
        for vertex in 0..self.parent.len() {
            let first = self.find(self.first[vertex]);
            let root = self.owner[first as usize];
            self.parent[vertex] = root;
            self.turn[vertex] = first - self.first[root as usize];
        }
    }

    /// Identifies two darts, and all that follows.
    ///
    /// # Errors
    /// Returns an error if no world of any size has them as one dart. Nothing is then changed.
    pub fn unite(&mut self, one: Dart, other: Dart) -> Result<(), ContradictionReason> {
        self.before_union = self.changes.len();
        self.changes.push(Change::Open { before: self.open });
        let united = self.close(one.0, other.0);
        if united.is_err() {
            self.undo_to(self.before_union);
        }
        united
    }

    /// Identifies two darts, computes something, and undoes the identification.
    ///
    /// # Errors
    /// Returns an error if no world of any size has them as one dart.
    pub fn with_united<T>(
        &mut self,
        one: Dart,
        other: Dart,
        compute: impl FnOnce(&Self) -> T,
    ) -> Result<T, ContradictionReason> {
        self.unite(one, other)?;
        let computed = compute(&*self);
        self.undo_to(self.before_union);
        Ok(computed)
    }

    /// The darts of all vertices that the latest [union](Self::unite) merged, as they were numbered before
    /// it. Some occur more than once.
    pub fn merged_darts(&self) -> impl Iterator<Item = Dart> + '_ {
        let merged = self.changes[self.before_union..].iter().filter_map(|change| match change {
            Change::Child { child, root } => Some([*child, *root]),
            _ => None,
        });
        merged.flatten().flat_map(|vertex| {
            let first = self.first[vertex as usize];
            (first..first + self.percept[vertex as usize].degree).map(Dart)
        })
    }

    /// The number of moves.
    #[must_use]
    pub fn moves(&self) -> usize {
        self.moves
    }

    /// The robot's pose at the start, as a dart of a root. There is one if anything was perceived.
    #[must_use]
    pub fn start(&self) -> Dart {
        Dart(self.find(0))
    }

    /// The robot's pose: the dart by which it came in, as a dart of a root.
    #[must_use]
    pub fn pose(&self) -> Dart {
        Dart(self.find(self.pose))
    }

    /// The dart along which the marker points, as a dart of a root, if it was seen.
    #[must_use]
    pub fn marker(&self) -> Option<Dart> {
        self.marker.map(|dart| Dart(self.find(dart.0)))
    }

    /// The number of trail vertices, folded or not.
    #[must_use]
    pub fn trail_vertex_count(&self) -> usize {
        self.parent.len()
    }

    /// The number of vertices: places that are not proved to be one.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.classes
    }

    /// The number of darts of all trail vertices, folded or not.
    #[must_use]
    pub fn dart_count(&self) -> usize {
        self.owner.len()
    }

    /// The number of open darts: ends of edges that were never traversed.
    #[must_use]
    pub fn open_count(&self) -> usize {
        self.open
    }

    /// For each vertex, in the order of the first visits, the dart by which the robot first came in. The doors
    /// are those of the walk.
    #[must_use]
    pub fn first_entries(&self, doors: &[Door]) -> Vec<Dart> {
        let mut entries = Vec::new();
        let mut seen = vec![false; self.parent.len()];
        let mut next = (self.classes > 0).then(|| self.start());
        let mut doors = doors.iter();
        while let Some(pose) = next {
            if !std::mem::replace(&mut seen[self.vertex(pose)], true) {
                entries.push(pose);
            }
            next = doors.next().and_then(|&door| self.opposite(self.behind(pose, door)));
        }
        entries
    }

    /// The open darts, as darts of roots.
    pub fn open_darts(&self) -> impl Iterator<Item = Dart> + '_ {
        let darts = self.vertices().flat_map(|first| self.darts_around(first));
        darts.filter(|&dart| self.opposite(dart).is_none())
    }

    /// Whether no edge is a loop and no two edges join the same vertices.
    #[must_use]
    pub fn is_simple(&self) -> bool {
        let mut seen_from = vec![OPEN; self.parent.len()];
        self.vertices().all(|first| {
            let here = self.vertex(first);
            seen_from[here] = first.0;
            let mut far = self.darts_around(first).filter_map(|dart| self.opposite(dart));
            far.all(|dart| {
                let there = self.vertex(dart);
                std::mem::replace(&mut seen_from[there], first.0) != first.0
            })
        })
    }

    /// Whether the walk determines its world: no dart is open, and the marker was seen.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.open == 0 && self.marker.is_some()
    }

    /// The dart of a root that stands for a dart.
    #[must_use]
    pub fn root_of(&self, dart: Dart) -> Dart {
        Dart(self.find(dart.0))
    }

    /// The other end of a dart's edge, as a dart of a root; `None` if the dart is open.
    #[must_use]
    pub fn opposite(&self, dart: Dart) -> Option<Dart> {
        match self.opposite[self.find(dart.0) as usize] {
            OPEN => None,
            opposite => Some(Dart(self.find(opposite))),
        }
    }

    /// The darts of a dart's vertex, clockwise from the first of the root.
    pub fn darts_around(&self, dart: Dart) -> impl Iterator<Item = Dart> + use<> {
        let root = self.owner[self.find(dart.0) as usize] as usize;
        let first = self.first[root];
        (first..first + self.percept[root].degree).map(Dart)
    }

    /// The dart behind a door, for a robot with this pose; doors are counted modulo the degree.
    #[must_use]
    pub fn behind(&self, pose: Dart, door: Door) -> Dart {
        Dart(self.turned(self.find(pose.0), door.0))
    }

    /// The door that leads to a dart, for a robot with this pose at the same vertex.
    #[must_use]
    pub fn door(&self, pose: Dart, dart: Dart) -> Door {
        let (pose, dart) = (self.find(pose.0), self.find(dart.0));
        let first = self.first[self.owner[pose as usize] as usize];
        Door::between(pose - first, dart.wrapping_sub(first), self.degree_at(pose))
    }

    /// The number of the root of a dart's vertex, below [`trail_vertex_count`](Self::trail_vertex_count).
    #[must_use]
    pub fn vertex(&self, dart: Dart) -> usize {
        self.owner[self.find(dart.0) as usize] as usize
    }

    /// The degree of a dart's vertex.
    #[must_use]
    pub fn degree(&self, dart: Dart) -> u32 {
        self.degree_at(dart.0)
    }

    /// The roots' first darts, one for each vertex, in the order of the first visits of the roots.
    pub fn vertices(&self) -> impl Iterator<Item = Dart> + '_ {
        let roots = (0..self.parent.len()).filter(|&vertex| self.parent[vertex] == vertex as u32);
        roots.map(|root| Dart(self.first[root]))
    }

    /// The folded trail as a world with a dead end behind each open dart. It explains the walk. If the
    /// trail [is complete](Self::is_complete) it is the only world that does. `None` if nothing was
    /// perceived.
    #[must_use]
    pub fn closed(&self) -> Option<ClosedTrail> {
        (self.classes > 0).then(|| self.closed_by(&[]).0)
    }

    /// The folded trail as a world in which these pairs of open darts are edges, with a dead end behind each
    /// other open dart; and the robot's pose in it at the start. At least one thing was perceived.
    pub(super) fn closed_by(&self, edges: &[(Dart, Dart)]) -> (ClosedTrail, Dart) {
        let mut joined = vec![OPEN; self.owner.len()];
        for &(one, other) in edges {
            (joined[one.at()], joined[other.at()]) = (other.0, one.0);
        }
        let mut graph = EmbeddedGraph::unfinished();
        let mut number = vec![OPEN; self.owner.len()];
        let mut next = 0;
        for dart in self.vertices().flat_map(|first| self.darts_around(first)) {
            number[dart.at()] = next;
            next += 1;
        }
        for first in self.vertices() {
            let _: Vertex = graph.add_vertex(self.degree_at(first.0));
        }
        for _ in 2 * edges.len()..self.open {
            let _: Vertex = graph.add_vertex(1);
        }
        for dart in self.vertices().flat_map(|first| self.darts_around(first)) {
            let one = Dart(number[dart.at()]);
            let new = Some(Dart(joined[dart.at()])).filter(|new| new.0 != OPEN);
            match self.opposite(dart).or(new) {
                None => {
                    graph.join(one, Dart(next));
                    next += 1;
                }
                Some(other) if dart < other => graph.join(one, Dart(number[other.at()])),
                Some(_) => {}
            }
        }
        let numbered = |dart: Dart| Dart(number[dart.at()]);
        let [start, pose] = [self.start(), self.pose()].map(numbered);
        (ClosedTrail { graph, marker: self.marker().map(numbered), pose }, start)
    }

    /// A new vertex with open darts, a class of its own.
    fn add_vertex(&mut self, percept: Percept) -> Result<u32, TrailError> {
        let Percept { degree, sighting } = percept;
        if degree == 0 {
            return Err(ContradictionReason::NoDoors.into());
        }
        if let Sighting::Pointing(Door(door)) = sighting
            && door >= degree
        {
            return Err(ContradictionReason::MarkerDoor { door, degree }.into());
        }
        if degree as usize > MAX_DARTS - self.owner.len() {
            return Err(TrailError::TooManyDarts);
        }
        let vertex = self.first.len() as u32;
        let first = self.owner.len() as u32;
        self.first.push(first);
        self.visit.push(self.moves);
        self.percept.push(percept);
        self.parent.push(vertex);
        self.turn.push(0);
        self.size.push(1);
        self.owner.resize(self.owner.len() + degree as usize, vertex);
        self.opposite.resize(self.owner.len(), OPEN);
        self.classes += 1;
        self.open += degree as usize;
        if self.marker.is_none()
            && let Sighting::Pointing(Door(door)) = sighting
        {
            self.marker = Some(Dart(first + door));
        }
        Ok(vertex)
    }

    /// All sightings of the marker are one pose.
    fn identify_marker(&mut self, vertex: u32) -> Result<(), ContradictionReason> {
        let here = self.first[vertex as usize];
        match (self.percept[vertex as usize].sighting, self.marker) {
            (Sighting::Pointing(Door(door)), Some(marker)) => self.close(marker.0, here + door),
            _ => Ok(()),
        }
    }

    /// Compares a percept with what was perceived at a vertex before, for a robot with this pose.
    fn compare(&self, pose: u32, percept: Percept) -> Result<(), ContradictionReason> {
        let root = self.owner[pose as usize] as usize;
        let index = pose - self.first[root];
        let visits = [self.visit[root], self.moves];
        let before = self.percept[root];
        if before.degree != percept.degree {
            let degrees = [before.degree, percept.degree];
            return Err(ContradictionReason::Degree { visits, degrees });
        }
        compare_sightings(before.seen_from(Door(index)), percept, visits)
    }

    /// Identifies two darts, and all that follows.
    fn close(&mut self, one: u32, other: u32) -> Result<(), ContradictionReason> {
        self.pairs.clear();
        self.pairs.push((one, other));
        while let Some((one, other)) = self.pairs.pop() {
            let (one, other) = (self.find(one), self.find(other));
            if one != other {
                self.merge(one, other)?;
            }
        }
        Ok(())
    }

    /// Makes one class of two.
    fn merge(&mut self, one: u32, other: u32) -> Result<(), ContradictionReason> {
        let (mut root, mut child) = (self.owner[one as usize], self.owner[other as usize]);
        let (mut at_root, mut at_child) = (one, other);
        if root == child {
            return Err(ContradictionReason::Rotation { visit: self.visit[root as usize] });
        }
        if self.size[root as usize] < self.size[child as usize] {
            (root, child, at_root, at_child) = (child, root, at_child, at_root);
        }
        let degree = self.percept[root as usize].degree;
        let visits = [root, child].map(|vertex| self.visit[vertex as usize]);
        let degrees = [root, child].map(|vertex| self.percept[vertex as usize].degree);
        if degrees[0] != degrees[1] {
            return Err(ContradictionReason::Degree { visits, degrees });
        }
        // The child's first dart, at the root.
        let turn = Door::between(
            at_child - self.first[child as usize],
            at_root - self.first[root as usize],
            degree,
        );
        let expected = self.percept[root as usize].seen_from(turn);
        compare_sightings(expected, self.percept[child as usize], visits)?;
        self.parent[child as usize] = root;
        self.turn[child as usize] = turn.0;
        self.size[root as usize] += self.size[child as usize];
        self.classes -= 1;
        self.changes.push(Change::Child { child, root });
        for index in 0..degree {
            let from = self.first[child as usize] + index;
            let to = self.find(from);
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
                return Err(ContradictionReason::OwnOpposite { visit: visits[0] });
            }
        }
        Ok(())
    }

    /// The number of changes by unions that can be undone.
    pub(super) fn change_count(&self) -> usize {
        self.changes.len()
    }

    /// Undoes the latest changes, so that this many are left.
    pub(super) fn undo_to(&mut self, count: usize) {
        for change in self.changes.drain(count..).rev() {
            match change {
                Change::Child { child, root } => {
                    self.parent[child as usize] = child;
                    self.turn[child as usize] = 0;
                    self.size[root as usize] -= self.size[child as usize];
                    self.classes += 1;
                }
                Change::Opposite { dart } => self.opposite[dart as usize] = OPEN,
                Change::Open { before } => self.open = before,
            }
        }
    }

    /// The dart of a root that stands for a dart.
    #[inline]
    fn find(&self, dart: u32) -> u32 {
        let mut vertex = self.owner[dart as usize] as usize;
        let mut index = dart - self.first[vertex];
        let degree = self.percept[vertex].degree;
        while self.parent[vertex] as usize != vertex {
            index += self.turn[vertex];
            index -= if index >= degree { degree } else { 0 };
            vertex = self.parent[vertex] as usize;
        }
        self.first[vertex] + index
    }

    /// The dart at the same trail vertex that stands some places further clockwise.
    fn turned(&self, dart: u32, places: u32) -> u32 {
        let vertex = self.owner[dart as usize] as usize;
        let (first, degree) = (self.first[vertex], self.percept[vertex].degree);
        // A door is below 2^32, so the sum of 64 bits does not overflow.
        first + ((u64::from(dart - first) + u64::from(places)) % u64::from(degree)) as u32
    }

    fn degree_at(&self, dart: u32) -> u32 {
        self.percept[self.owner[dart as usize] as usize].degree
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
