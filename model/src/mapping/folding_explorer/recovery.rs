//! Recovery: the folding explorer goes on after a contradiction, after a wrong map that an audit has found, and
//! after the robot got lost.
//!
//! All percepts since the start are kept as *pieces*, walks that begin or end at the marker. The robot begins
//! another walk where it stands, and goes on until it sees the marker. On the way it tries the places that it
//! knows: those that agree with the walk, the nearest to the marker first. Then it folds the pieces again. If
//! they contradict each other, it leaves out as few as it can: all in the order from the newest to the oldest,
//! but for one suspect, which comes last; the suspect is the piece without which most others agree. With what is
//! left, the folding explorer goes on.
//!
//! If the map becomes too large, it starts over without earlier pieces.
//!
//! This makes no map that is not right: a map is complete when the folded trail of the pieces that are left
//! is, and an [audit] does not depend on any earlier percept.

use std::{collections::VecDeque, mem};

use super::{FoldingExploration, ways::Ways};
use crate::{
    embedded_graph::Dart,
    folding::{FoldedTrail, TrailError},
    mapping::{
        Contradiction, FACING, InvalidStep, Journey, MappingError, MappingEvent, Observer, audit,
    },
    percept::{Door, Percept, Sighting},
    world::World,
};

/// A world in which a robot that got lost can go on.
pub trait Relocate: World {
    /// Goes to any junction after an error, if that is possible. Afterwards the percept is that of the
    /// junction, and door 0 is the way by which the robot has come there.
    ///
    /// # Errors
    /// Returns an error, usually the same, if the robot cannot go on.
    fn relocate(&mut self, error: Self::Error) -> Result<(), Self::Error>;
}

/// How much a robot does for a right map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecoveryConfig {
    /// The number of audits of a complete map.
    pub audits: u32,
    /// The robot gives up after this many recoveries.
    pub most_recoveries: u32,
}

impl Default for RecoveryConfig {
    /// One audit, and at most 32 recoveries.
    fn default() -> Self {
        Self { audits: 1, most_recoveries: 32 }
    }
}

/// A map that is complete, and what it took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecoveredMap {
    /// The robot's pose in the map.
    pub pose: Dart,
    /// All moves, with those of recoveries and audits. What a robot that got lost drives until it comes to a
    /// junction is no move.
    pub moves: u64,
    /// The moves of audits.
    pub audit_moves: u64,
    /// The number of recoveries.
    pub recoveries: u32,
}

/// Percepts and the doors between them.
#[derive(Clone, Debug, Default)]
struct Piece {
    percepts: Vec<Percept>,
    doors: Vec<Door>,
}

impl Piece {
    /// Adds the walk to a trail, as another visit of the same world.
    fn fold_into(&self, trail: &mut FoldedTrail) -> Result<(), TrailError> {
        let mut percepts = self.percepts.iter();
        let Some(&first) = percepts.next() else { return Ok(()) };
        trail.begin_walk(first)?;
        for (&door, &percept) in self.doors.iter().zip(percepts) {
            trail.step(door, percept)?;
        }
        Ok(())
    }
}

fn sees_marker(percept: &Percept) -> bool {
    matches!(percept.sighting, Sighting::Pointing(_))
}

/// A world whose percepts and doors are kept.
struct Remembering<'w, W> {
    world: &'w mut W,
    /// The walk since the robot last began one.
    walk: Piece,
    moves: u64,
}

impl<W: World> World for Remembering<'_, W> {
    type Error = W::Error;

    fn percept(&mut self) -> Result<Percept, W::Error> {
        let percept = self.world.percept()?;
        if self.walk.percepts.len() == self.walk.doors.len() {
            self.walk.percepts.push(percept);
        }
        Ok(percept)
    }

    fn traverse(&mut self, door: Door) -> Result<(), W::Error> {
        self.world.traverse(door)?;
        self.moves += 1;
        if !self.walk.percepts.is_empty() {
            self.walk.doors.push(door);
        }
        Ok(())
    }
}

impl<W> Remembering<'_, W> {
    /// Ends the walk, and splits it where the marker was seen.
    fn end_walk(&mut self) -> Vec<Piece> {
        let Piece { percepts, doors } = mem::take(&mut self.walk);
        let mut pieces = Vec::new();
        let mut piece = Piece::default();
        let mut doors = doors.into_iter();
        for percept in percepts {
            piece.percepts.push(percept);
            if sees_marker(&percept) && piece.percepts.len() > 1 {
                pieces.push(mem::take(&mut piece));
                piece.percepts.push(percept);
            }
            piece.doors.extend(doors.next());
        }
        // The robot may have taken a door, and not have perceived what is behind it.
        piece.doors.truncate(piece.percepts.len().saturating_sub(1));
        pieces.push(piece);
        // A walk without the marker says nothing about the world with the marker.
        pieces.retain(|piece| piece.percepts.iter().any(sees_marker) && !piece.doors.is_empty());
        pieces
    }
}

/// An observer of the world behind the memory.
struct Through<'o, O>(&'o mut O);

impl<W, O: Observer<W>> Observer<Remembering<'_, W>> for Through<'_, O> {
    fn event(&mut self, world: &mut Remembering<'_, W>, journey: &Journey, event: MappingEvent) {
        self.0.event(world.world, journey, event);
    }
}

/// Folds as many pieces as agree, and returns the trail and their number. The suspect comes last.
fn fold_newest_first(pieces: &[Piece], suspect: Option<usize>) -> (FoldedTrail, usize) {
    let others = (0..pieces.len()).rev().filter(|&at| Some(at) != suspect);
    let mut trail = FoldedTrail::default();
    let mut kept = 0;
    for at in others.chain(suspect) {
        let mut more = trail.clone();
        if pieces[at].fold_into(&mut more).is_ok() {
            trail = more;
            kept += 1;
        }
    }
    (trail, kept)
}

/// Folds the largest set of pieces that agree, of those that are found with each piece as the suspect. Of sets
/// of the same size it is the one with the newest suspect. The `sure` newest pieces are no suspects.
fn fold_most(pieces: &[Piece], sure: usize) -> FoldedTrail {
    let suspects = (0..pieces.len().saturating_sub(sure)).rev().map(Some);
    let mut best = (FoldedTrail::default(), 0);
    for suspect in suspects.chain([None]) {
        let folded = fold_newest_first(pieces, suspect);
        if folded.1 > best.1 {
            best = folded;
        }
        if best.1 == pieces.len() {
            break;
        }
    }
    best.0
}

impl FoldingExploration {
    /// Goes on with a trail of earlier walks, with the robot where the marker lies. `seen` is its percept.
    fn resume<W: World>(
        &mut self,
        trail: FoldedTrail,
        seen: Percept,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        let moves = self.journey.moves();
        self.clear();
        self.journey.set_moves(moves);
        self.trail = trail;
        let Some(marker) = self.trail.marker() else { return Err(InvalidStep::NoPlan.into()) };
        let Percept { degree, sighting } = seen;
        let start = Percept { degree, sighting: Sighting::Pointing(Door::BACK) };
        self.journey.begin(start, world, observer)?;
        if let Sighting::Pointing(door) = sighting {
            self.trail.stand_at(self.trail.behind(marker, door.inverse(degree)));
        }
        self.put_in_map(marker);
        self.find_robot();
        self.settle(world, observer)?;
        while let Some(step) = self.next_step() {
            self.make_step(step, world, observer)?;
        }
        if self.is_complete() { Ok(()) } else { Err(InvalidStep::NoPlan.into()) }
    }

    /// Walks until the marker is seen, and returns the percept there.
    fn find_marker<W: World>(
        &mut self,
        known: FoldedTrail,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<Percept, MappingError<W::Error>> {
        let mut percept = world.percept().map_err(MappingError::World)?;
        let mut search = MarkerWalk::new(known);
        let mut step = search.trail.begin_walk(percept);
        let most = LEAST_SEARCH + MOVES_A_DART * search.known as u64;
        let begun = self.journey.moves();
        while !sees_marker(&percept) {
            step?;
            if self.journey.moves() - begun >= most {
                return Err(Contradiction::NoMarker.into());
            }
            let Some(door) = search.next_door() else {
                return Err(Contradiction::NoMarker.into());
            };
            percept = self.journey.go(door, world, observer)?;
            step = search.trail.step(door, percept);
        }
        Ok(percept)
    }
}

/// The robot gives up the search for the marker after so many moves, and so many more for each dart that it
/// knows: perhaps it is cut off from the marker.
const LEAST_SEARCH: u64 = 400;
const MOVES_A_DART: u64 = 20;

/// A walk of a robot that does not know where it is, to the marker.
struct MarkerWalk {
    /// What is known, and the walk.
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

/// After this many refuted suppositions for each open dart, the robot takes the next open dart. If it never
/// did, it could suppose for ever.
const SUPPOSITIONS: usize = 4;

impl MarkerWalk {
    fn new(known: FoldedTrail) -> Self {
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

    /// The door to take: to the marker, if the robot is where that is nearest, of all known poses that agree
    /// with the walk. If there is none, or too many were refuted, to the open dart of the walk that is nearest
    /// to its beginning: so the robot comes to every place in the end. `None` if there is none either.
    fn next_door(&mut self) -> Option<Door> {
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
        let depths = self.depths();
        let open = self.trail.open_darts().filter(|dart| dart.at() >= self.known);
        let near = open.min_by_key(|&dart| {
            (depths[self.trail.vertex(dart)], self.ways.moves_to(&self.trail, dart))
        })?;
        self.ways.darts_to(&self.trail, near, &mut self.way);
        self.way.push(near);
        self.way.reverse();
        Some(())
    }

    /// The moves from the beginning of the walk to each vertex of it.
    fn depths(&self) -> Vec<usize> {
        let start = self.trail.root_of(Dart(self.known as u32));
        let mut depths = vec![usize::MAX; self.trail.trail_vertex_count()];
        depths[self.trail.vertex(start)] = 0;
        let mut queue = VecDeque::from([start]);
        while let Some(dart) = queue.pop_front() {
            let depth = depths[self.trail.vertex(dart)] + 1;
            self.trail.for_each_neighbour(dart, |entry, vertex| {
                if depths[vertex] == usize::MAX {
                    depths[vertex] = depth;
                    queue.push_back(entry);
                }
            });
        }
        depths
    }
}

/// Maps a world with the folding explorer, and recovers after contradictions and errors. At its start the robot
/// stands at the marked vertex, with its back to the facing door. Afterwards `exploration` holds the map.
///
/// # Errors
/// Returns an error if the world cannot go on, at the bound, or after too many recoveries.
pub fn map_with_recovery<W: Relocate>(
    world: &mut W,
    exploration: &mut FoldingExploration,
    config: RecoveryConfig,
    observer: &mut impl Observer<W>,
) -> Result<RecoveredMap, MappingError<W::Error>> {
    let mut world = Remembering { world, walk: Piece::default(), moves: 0 };
    let mut observer = Through(observer);
    let mut pieces: Vec<Piece> = Vec::new();
    let mut audit_moves = 0;
    let mut recoveries = 0;
    let mut was_found = true;
    let mut ended = super::map_by_folding(&mut world, exploration, &mut observer);
    loop {
        if ended.is_ok() {
            let before = world.moves;
            let audited = audited(&mut world, exploration, config.audits);
            audit_moves += world.moves - before;
            match audited {
                Ok(pose) => {
                    return Ok(RecoveredMap { pose, moves: world.moves, audit_moves, recoveries });
                }
                Err(error) => ended = Err(error),
            }
        }
        let Err(error) = ended else { continue };
        if recoveries == config.most_recoveries {
            return Err(error);
        }
        recoveries += 1;
        pieces.extend(world.end_walk());
        if matches!(error, MappingError::Bound { .. }) {
            // The robot found ever more places, and nothing that it could compare.
            pieces.clear();
        }
        match error {
            // The percept that contradicts the others may be the false one, so the walk begins at the
            // next place.
            MappingError::Contradiction(_) | MappingError::Bound { .. } => {
                match world.world.traverse(Door::BACK) {
                    Ok(()) => world.moves += 1,
                    Err(error) => world.world.relocate(error).map_err(MappingError::World)?,
                }
            }
            MappingError::World(error) => {
                world.world.relocate(error).map_err(MappingError::World)?;
            }
            error @ MappingError::InvalidStep(_) => return Err(error),
        }
        let known = fold_most(&pieces, 0);
        let found = exploration.find_marker(known, &mut world, &mut observer);
        // Two searches in vain, one after the other, do not come from one false percept.
        if let Err(error @ MappingError::Contradiction(Contradiction::NoMarker)) = found {
            if !was_found {
                return Err(error);
            }
            was_found = false;
            ended = Err(error);
            continue;
        }
        was_found = true;
        ended = match found {
            Ok(seen) => {
                pieces.extend(world.end_walk());
                world.walk.percepts.push(seen);
                let trail = match fold_most(&pieces, 1) {
                    trail if trail.marker().is_some() => trail,
                    _ => FoldedTrail::new(seen)?,
                };
                exploration.resume(trail, seen, &mut world, &mut observer)
            }
            Err(error) => Err(error),
        };
    }
}

/// Audits a complete map, and returns the robot's pose in it.
fn audited<W: World>(
    world: &mut W,
    exploration: &FoldingExploration,
    audits: u32,
) -> Result<Dart, MappingError<W::Error>> {
    let mut pose = exploration.robot();
    let Some(map) = exploration.map().complete() else { return Err(InvalidStep::NoPlan.into()) };
    for _ in 0..audits {
        pose = audit(world, map, FACING, pose)?.pose;
    }
    Ok(pose)
}
