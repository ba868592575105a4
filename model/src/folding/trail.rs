//! The folded trail of a walk: the vertices that the robot has visited, folded as far as is proved.

use super::{
    ArrivalSenses, ContradictionReason, LengthInterval, MAX_DARTS, TrailError,
    arrow::{Arrow, Sense},
    classes::{DartClasses, OPEN},
};
use crate::{
    clone_in_place::clone_in_place,
    direction::Direction,
    embedded_graph::Dart,
    injected_flaw::InjectedFlaw,
    percept::{Door, Percept, Sighting},
};

/// The folded trail of a walk.
///
/// The darts of all trail vertices are numbered in the order of the walk, those of a vertex clockwise
/// from the one by which the robot first came in. Trail vertices that are proved to be one vertex form
/// a class, which is represented by the darts of one of them, its root.
#[derive(Debug, Default)]
pub struct FoldedTrail {
    pub(super) classes: DartClasses,
    /// The dart along which the directional marker points.
    marker: Option<Dart>,
    pub(super) arrow: Arrow,
    /// The dart by which the robot has come in.
    pub(super) pose: u32,
    pub(super) moves: usize,
}

clone_in_place!(FoldedTrail { classes, marker, arrow, pose, moves });

impl FoldedTrail {
    /// Begins another walk. Memory is kept.
    pub(crate) fn restart(&mut self, percept: Percept) -> Result<(), TrailError> {
        self.classes.clear();
        (self.marker, self.arrow, self.pose, self.moves) = (None, Arrow::default(), 0, 0);
        self.add_vertex(percept)?;
        self.identify_marker(percept)
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

    /// Another walk begins, of a robot that may be anywhere in the same world. It is joined to the earlier
    /// ones when the marker is seen.
    pub(crate) fn begin_walk(&mut self, percept: Percept) -> Result<(), TrailError> {
        self.moves += usize::from(self.classes.trail_vertex_count() > 0);
        self.pose = self.add_vertex(percept)?;
        self.identify_marker(percept)
    }

    /// The robot stands at a place that it knows, and has come in by this dart.
    pub(crate) fn stand_at(&mut self, pose: Dart) {
        self.pose = self.classes.find(pose.0);
    }

    pub(super) fn check_door(&self, door: Door) -> Result<(), ContradictionReason> {
        let degree = self.classes.degree(self.pose);
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
        let leaving = self.classes.find(self.classes.turned(self.pose, door.0));
        match self.classes.opposite(leaving) {
            OPEN => {
                let entry = self.add_vertex(percept)?;
                self.classes.join(leaving, entry);
                self.pose = entry;
                self.identify_marker(percept)?;
            }
            pose => {
                self.pose = pose;
                self.classes.compare(pose, percept, self.moves)?;
                self.compare_arrow(percept)?;
            }
        }
        Ok(())
    }

    /// The robot left by a door, turned back on the edge behind it, and sees where it came from again. A mark on that
    /// edge is not looked for.
    ///
    /// # Errors
    /// Returns an error if no world of any size explains the walk. The trail is then of no more use.
    pub(crate) fn come_back(&mut self, door: Door, percept: Percept) -> Result<(), TrailError> {
        self.check_door(door)?;
        self.moves += 1;
        self.pose = self.classes.find(self.classes.turned(self.pose, door.0));
        Ok(self.classes.compare(self.pose, percept, self.moves)?)
    }

    /// What the robot senses besides its percept where it is: it is compared with what it sensed there and on the edge behind
    /// it before, and is used in later unions. It is called after the start or a [step](Self::step), or not.
    ///
    /// # Errors
    /// Returns an error if no world of any size explains this. The trail is then of no more use.
    #[inline]
    pub fn sense(&mut self, senses: ArrivalSenses) -> Result<(), ContradictionReason> {
        if senses == ArrivalSenses::default() {
            return Ok(());
        }
        self.classes.sense(self.classes.find(self.pose), senses, self.moves)
    }

    /// The length of a dart's edge, as far as it was measured.
    pub fn length(&self, dart: Dart) -> LengthInterval {
        self.classes.length(self.classes.find(dart.0))
    }

    /// The direction of a dart, if it was seen with a compass.
    pub fn direction(&self, dart: Dart) -> Option<Direction> {
        self.classes.direction(self.classes.find(dart.0))
    }

    /// Whether what was sensed besides percepts, of two darts alone, allows that they are one.
    #[inline]
    pub(crate) fn senses_agree(&self, one: Dart, other: Dart) -> bool {
        self.classes.senses_agree(one.0, other.0)
    }

    /// All sightings of the directional marker are one pose. The robot has come in by the first dart of a new
    /// vertex.
    #[inline]
    fn identify_marker(&mut self, percept: Percept) -> Result<(), TrailError> {
        match percept.sighting {
            Sighting::PassedAlong => return self.pass_arrow(Sense::Along),
            Sighting::PassedAgainst => return self.pass_arrow(Sense::Against),
            _ => self.compare_arrow(percept)?,
        }
        if let (Sighting::Pointing(Door(door)), Some(marker)) = (percept.sighting, self.marker)
            && marker.0 != self.pose + door
            && !InjectedFlaw::SightingNotUnited.is_present()
        {
            self.classes.unite(marker.0, self.pose + door)?;
            self.classes.flatten();
        }
        Ok(())
    }

    fn pass_arrow(&mut self, sense: Sense) -> Result<(), TrailError> {
        self.arrow.pass(sense, (self.pose, self.moves), &mut self.classes)
    }

    #[inline]
    fn compare_arrow(&self, percept: Percept) -> Result<(), ContradictionReason> {
        self.arrow.compare(percept, (self.pose, self.moves), &self.classes)
    }

    /// What a robot with this pose saw at its place before, if it came there along edges that it knew. That
    /// is so after a [step](Self::step) that failed, too.
    pub(crate) fn seen_before(&self) -> Option<Percept> {
        self.classes.seen_before(self.pose, self.moves)
    }

    /// Identifies two darts, and all that follows.
    ///
    /// # Errors
    /// Returns an error if no world of any size has them as one dart. Nothing is then changed.
    pub fn unite(&mut self, one: Dart, other: Dart) -> Result<(), ContradictionReason> {
        let united = self
            .classes
            .unite(one.0, other.0)
            .and_then(|()| self.arrow.check(self.moves, &self.classes));
        if united.is_err() {
            self.classes.undo();
        }
        united
    }

    /// Identifies two darts, computes something, and undoes the identification. Vertices with
    /// numbers are distinct.
    ///
    /// # Errors
    /// Returns an error if no world of any size has them as one dart.
    pub fn with_united<T>(
        &mut self,
        one: Dart,
        other: Dart,
        compute: impl FnOnce(&Self) -> T,
    ) -> Result<T, ContradictionReason> {
        let united = self
            .classes
            .suppose(one.0, other.0)
            .and_then(|()| self.arrow.check(self.moves, &self.classes));
        let computed = united.map(|()| compute(&*self));
        self.classes.undo();
        computed
    }

    /// Visits the darts that were open before the latest [union](Self::unite) and are not open after it,
    /// with their [opposites](Self::opposite) after it.
    #[inline]
    pub(crate) fn for_each_closed_dart(&self, mut visit: impl FnMut(Dart, Dart)) {
        self.classes.for_each_identified(|dart| {
            if let Some(opposite) = self.opposite(Dart(dart)) {
                visit(Dart(dart), opposite);
            }
        });
    }

    /// Gives numbers to the darts of a vertex, clockwise from a pose. Later unions keep them. Two
    /// vertices with numbers must be proved to be distinct.
    pub(crate) fn set_numbers(&mut self, pose: Dart, first: u32) {
        self.classes.set_numbers(self.classes.find(pose.0), first);
    }

    /// The number of a dart, if its vertex has [numbers](Self::set_numbers).
    #[inline]
    pub(crate) fn number(&self, dart: Dart) -> Option<u32> {
        self.classes.number(dart.0)
    }

    #[inline]
    pub fn moves(&self) -> usize {
        self.moves
    }

    /// The robot's pose at the start, as a dart of a root. There is one if anything was perceived.
    pub fn start(&self) -> Dart {
        self.root_of(Dart(0))
    }

    /// The robot's pose: the dart by which it came in, as a dart of a root.
    #[inline]
    pub fn pose(&self) -> Dart {
        Dart(self.classes.find(self.pose))
    }

    /// The dart along which the marker, or an arrow on an edge, points, as a dart of a root. If the arrow was only
    /// seen where its edge ends, and the edge was not traversed, there is none.
    pub fn marker(&self) -> Option<Dart> {
        let [tail, _] = self.arrow.ends(&self.classes);
        self.marker.map(|dart| self.root_of(dart)).or(tail)
    }

    /// The number of trail vertices, folded or not.
    pub fn trail_vertex_count(&self) -> usize {
        self.classes.trail_vertex_count()
    }

    /// The number of vertices: places that are not proved to be one.
    pub fn vertex_count(&self) -> usize {
        self.classes.count
    }

    /// The number of darts of all trail vertices, folded or not.
    pub fn dart_count(&self) -> usize {
        self.classes.dart_count()
    }

    /// The number of open darts: ends of edges that were never traversed.
    #[inline]
    pub fn open_count(&self) -> usize {
        self.classes.open
    }

    /// For each vertex, in the order of the first visits, the dart by which the robot first came in. The doors
    /// are those of the walk.
    pub fn first_entries(&self, doors: &[Door]) -> Vec<Dart> {
        let mut entries = Vec::new();
        let mut seen = vec![false; self.trail_vertex_count()];
        let mut next = (self.vertex_count() > 0).then(|| self.start());
        let mut doors = doors.iter();
        while let Some(pose) = next {
            if !std::mem::replace(&mut seen[self.vertex(pose)], true) {
                entries.push(pose);
            }
            next = doors.next().and_then(|&door| self.opposite(self.behind(pose, door)));
        }
        entries
    }

    /// The folded trail as it is seen from the robot: vertices are numbered breadth first. Two walks with one form have
    /// the same future.
    pub fn seen_from_robot(&self) -> Vec<u32> {
        let mut number = vec![None; self.trail_vertex_count()];
        number[self.vertex(self.pose())] = Some(0);
        let mut entries = vec![self.pose()];
        let mut form = Vec::new();
        let mut next = 0;
        while let Some(&entry) = entries.get(next) {
            next += 1;
            form.push(self.degree(entry));
            for dart in (0..self.degree(entry)).map(|door| self.behind(entry, Door(door))) {
                if self.marker() == Some(dart) {
                    form.push(u32::MAX - 1);
                }
                let Some(far) = self.opposite(dart) else {
                    form.push(u32::MAX);
                    continue;
                };
                let vertex = *number[self.vertex(far)].get_or_insert_with(|| {
                    entries.push(far);
                    entries.len() - 1
                });
                form.extend([vertex as u32, self.door(entries[vertex], far).0]);
            }
        }
        form
    }

    /// The open darts, as darts of roots.
    pub fn open_darts(&self) -> impl Iterator<Item = Dart> + '_ {
        let darts = self.vertices().flat_map(|first| self.darts_around(first));
        darts.filter(|&dart| self.opposite(dart).is_none())
    }

    /// Whether no edge is a loop and no two edges join the same vertices.
    pub fn is_simple(&self) -> bool {
        let mut seen_from = vec![OPEN; self.trail_vertex_count()];
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
    pub fn is_complete(&self) -> bool {
        self.open_count() == 0 && self.marker().is_some()
    }

    /// Whether a marker that lies at a vertex was seen, or may lie where the robot has not been, behind an open dart.
    pub fn may_hold_marker(&self) -> bool {
        let is_seen = |first| self.sighting(first) != Sighting::Nothing;
        self.open_count() > 0 || self.vertices().any(is_seen)
    }

    /// The dart of a root that stands for a dart.
    #[inline]
    pub fn root_of(&self, dart: Dart) -> Dart {
        Dart(self.classes.find(dart.0))
    }

    /// Visits the other ends of the edges at a dart's vertex, clockwise from the first of the root, as
    /// darts of roots with the numbers of their vertices.
    #[inline]
    pub(crate) fn for_each_neighbour(&self, dart: Dart, mut visit: impl FnMut(Dart, usize)) {
        for dart in self.darts_around(dart) {
            let far = self.classes.opposite(dart.0);
            if far != OPEN {
                visit(Dart(far), self.classes.owner(far) as usize);
            }
        }
    }

    /// The other end of a dart's edge, as a dart of a root; `None` if the dart is open.
    #[inline]
    pub fn opposite(&self, dart: Dart) -> Option<Dart> {
        match self.classes.opposite(self.classes.find(dart.0)) {
            OPEN => None,
            opposite => Some(Dart(opposite)),
        }
    }

    /// The darts of a dart's vertex, clockwise from the first of the root.
    #[inline]
    pub fn darts_around(&self, dart: Dart) -> impl Iterator<Item = Dart> + use<> {
        self.classes.darts_of(self.classes.owner(self.classes.find(dart.0))).map(Dart)
    }

    /// The dart behind a door, for a robot with this pose; doors are counted modulo the degree.
    #[inline]
    pub fn behind(&self, pose: Dart, door: Door) -> Dart {
        Dart(self.classes.turned(self.classes.find(pose.0), door.0))
    }

    /// The door that leads to a dart, for a robot with this pose at the same vertex.
    #[inline]
    pub fn door(&self, pose: Dart, dart: Dart) -> Door {
        self.classes.door(self.classes.find(pose.0), self.classes.find(dart.0))
    }

    /// The number of the root of a dart's vertex, below [`trail_vertex_count`](Self::trail_vertex_count).
    #[inline]
    pub fn vertex(&self, dart: Dart) -> usize {
        self.classes.owner(self.classes.find(dart.0)) as usize
    }

    /// The number of the trail vertex at which a dart was seen, folded or not.
    #[inline]
    pub(crate) fn trail_vertex(&self, dart: Dart) -> usize {
        self.classes.owner(dart.0) as usize
    }

    #[inline]
    pub fn degree(&self, dart: Dart) -> u32 {
        self.classes.degree(dart.0)
    }

    /// What was seen at a dart's vertex, by a robot that came in by the first dart of the root.
    #[inline]
    pub(super) fn sighting(&self, dart: Dart) -> Sighting {
        self.classes.percept(self.classes.find(dart.0)).sighting
    }

    /// The roots' first darts, one for each vertex, in the order of the first visits of the roots.
    pub fn vertices(&self) -> impl Iterator<Item = Dart> + '_ {
        self.classes.roots().map(|root| Dart(self.classes.first(root)))
    }

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
        if degree as usize > MAX_DARTS - self.classes.dart_count() {
            return Err(TrailError::TooManyDarts);
        }
        let first = self.classes.add_vertex(percept, self.moves);
        if self.marker.is_none()
            && let Sighting::Pointing(Door(door)) = sighting
        {
            self.marker = Some(Dart(first + door));
        }
        Ok(first)
    }
}
