//! The walk of a robot that does not know where it is, to the marker.

use super::ways::Ways;
use crate::{
    embedded_graph::Dart,
    folding::{FoldedTrail, TrailError},
    percept::{Door, Percept},
};

/// The moves after which the robot gives up the search for the marker, and those that are added for each dart
/// that it knows: perhaps it is cut off from the marker.
const LEAST_SEARCH: u64 = 400;
const MOVES_A_DART: u64 = 20;

/// A walk of a robot that does not know where it is, to the marker.
pub(super) struct MarkerWalk {
    trail: FoldedTrail,
    /// The number of darts of what is known. The darts of the walk are later ones.
    known: usize,
    /// The darts by which it leaves on its way to an open dart and over it, the last one first.
    way: Vec<Dart>,
    /// The moves that are left to the marker, if the robot is where it supposes.
    left: Option<usize>,
    /// The suppositions that were refuted, and the open darts that were taken instead.
    refuted: usize,
    explored: usize,
    ways: Ways,
}

/// After this many refuted assumptions for each open dart, the robot takes the next open dart. Otherwise it
/// could go on for ever with wrong assumptions.
const SUPPOSITIONS: usize = 4;

impl MarkerWalk {
    pub(super) fn new(known: FoldedTrail) -> Self {
        Self {
            known: known.dart_count(),
            trail: known,
            way: Vec::new(),
            left: None,
            refuted: 0,
            explored: 0,
            ways: Ways::default(),
        }
    }

    pub(super) fn begin(&mut self, percept: Percept) -> Result<(), TrailError> {
        self.trail.begin_walk(percept)
    }

    pub(super) fn step(&mut self, door: Door, percept: Percept) -> Result<(), TrailError> {
        self.trail.step(door, percept)
    }

    pub(super) fn most_moves(&self) -> u64 {
        LEAST_SEARCH + MOVES_A_DART * self.known as u64
    }

    /// The door to take: to the marker, if the robot is where that is nearest, of all known poses that agree
    /// with the walk. If there is none, or too many were refuted, to the open dart of the walk that is nearest
    /// to its beginning: so the robot comes to every place in the end. `None` if there is none either.
    pub(super) fn next_door(&mut self) -> Option<Door> {
        if self.way.is_empty() {
            let supposed = self.nearest_marker();
            let moves = supposed.map(|(moves, _)| moves);
            if self.left.is_some_and(|left| moves.is_none_or(|moves| moves > left)) {
                self.refuted += 1;
            }
            let patient = self.refuted <= SUPPOSITIONS * (self.explored + 1);
            self.left = moves.filter(|_| patient).map(|moves| moves - 1);
            if let Some((_, door)) = supposed.filter(|_| patient) {
                return Some(door);
            }
            self.explored += 1;
            self.find_way_to_open()?;
        }
        let dart = self.way.pop()?;
        Some(self.trail.door(self.trail.pose(), dart))
    }

    /// The fewest moves to the marker, over all known poses that agree with the walk, and the first door.
    fn nearest_marker(&mut self) -> Option<(usize, Door)> {
        let pose = self.trail.pose();
        let vertices: Vec<Dart> = self.trail.vertices().collect();
        let darts = vertices.iter().flat_map(|&first| self.trail.darts_around(first));
        let known: Vec<Dart> = darts.filter(|dart| dart.at() < self.known).collect();
        let mut nearest: Option<(usize, Door)> = None;
        let mut darts = Vec::new();
        for supposed in known {
            let ways = &mut self.ways;
            let way = self.trail.with_united(pose, supposed, |trail| {
                ways.clear();
                ways.find(trail);
                ways.darts_to(trail, trail.marker()?, &mut darts);
                Some((darts.len(), trail.door(trail.pose(), *darts.first()?)))
            });
            if let Ok(Some(way)) = way
                && nearest.is_none_or(|(moves, _)| way.0 < moves)
            {
                nearest = Some(way);
            }
        }
        nearest
    }

    fn find_way_to_open(&mut self) -> Option<()> {
        self.ways.clear();
        self.ways.find(&self.trail);
        let mut from_start = Ways::default();
        from_start.find_from(&self.trail, self.trail.root_of(Dart(self.known as u32)));
        let open = self.trail.open_darts().filter(|dart| dart.at() >= self.known);
        let near = open.min_by_key(|&dart| {
            (from_start.moves_to(&self.trail, dart), self.ways.moves_to(&self.trail, dart))
        })?;
        self.ways.darts_to(&self.trail, near, &mut self.way);
        self.way.push(near);
        self.way.reverse();
        Some(())
    }
}
