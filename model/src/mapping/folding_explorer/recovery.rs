//! Recovery: the folding explorer goes on after a contradiction, after a wrong map that an audit has found, after
//! the robot got lost, and from the walks of an earlier run.
//!
//! All percepts since the start are kept as walks that begin or end at the marker. The robot begins another
//! walk where it stands, and goes on until it sees the marker. Then it folds the walks again. If they contradict each
//! other, it leaves out as few as it can. With what is left, the folding explorer goes on. If the map becomes too large,
//! it starts over without earlier walks. This makes no map that is not right: a map is complete when the folded trail
//! of the walks that are left is, and an [audit](crate::mapping::audit) does not depend on any earlier percept.

use std::mem;

use super::{
    FoldingRun,
    marker_walk::MarkerWalk,
    walks::{ArrivalMeasurement, EarlierWalk, EarlierWalks, sees_marker},
};
use crate::{
    aid::Aid,
    embedded_graph::Dart,
    folding::{ArrivalSenses, FoldedTrail},
    mapping::{
        Contradiction, Explorer, FACING, InvalidStep, MapWalk, Mapped, MappingError, MappingEvent,
        ObservedWorld, SafeguardEvent,
        audit::{AuditMove, audit_times, try_doors},
        explore,
    },
    measurement::{MeasurementCheck, MeasurementNoise},
    percept::{Door, Percept, Sighting},
    world::{GraphWorld, World},
};

/// A world in which a robot that got lost can go on.
pub trait Relocate: World {
    /// Goes to any junction after an error, if that is possible. Afterwards the percept is that of the
    /// junction, and door 0 is the way by which the robot has come there. By default it is not possible.
    ///
    /// # Errors
    /// Returns an error, usually the same, if the robot cannot go on.
    fn relocate(&mut self, error: Self::Error) -> Result<(), Self::Error> {
        Err(error)
    }

    /// What the robot has measured on the way to where it is. It is never used to make a map.
    fn measured(&self) -> ArrivalMeasurement {
        ArrivalMeasurement::default()
    }

    /// Whether the robot stands before an obstacle, where its hallway is a dead end.
    fn is_blocked(&self) -> bool {
        false
    }
}

impl<A: Aid> Relocate for GraphWorld<'_, A> {}

/// How much a robot does for a right map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecoveryConfig {
    pub audits: u32,
    pub most_recoveries: u32,
    /// Whether it tries the doors that are blocked once more at the end.
    pub retries_blocked: bool,
    /// The uncertainty of what it measures; `None` if it does not compare measurements.
    pub noise: Option<MeasurementNoise>,
}

impl Default for RecoveryConfig {
    /// One audit, and at most 32 recoveries. Blocked doors are not tried again, and measurements not compared.
    fn default() -> Self {
        Self { audits: 1, most_recoveries: 32, retries_blocked: false, noise: None }
    }
}

/// A map that is complete, and what it took.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MappedWorld {
    pub pose: Dart,
    /// All moves, with those of recoveries and audits. What a robot that got lost drives until it comes to a
    /// junction is no move.
    pub moves: u64,
    /// The moves of audits, with those that found a mistake.
    pub audit_moves: u64,
    /// The number of percepts in each audit of this map. All agreed with it.
    pub audited_percepts: Vec<u64>,
    pub recoveries: u32,
    /// The darts of the map whose hallways are blocked: they lead to dead ends that are obstacles. The
    /// last audit has seen them.
    pub blocked: Vec<Dart>,
}

/// A world whose percepts and doors are kept.
struct Remembering<'w, W> {
    world: &'w mut W,
    /// The walk since the robot last began one.
    walk: EarlierWalk,
    /// What was measured on the way to each of its percepts.
    measured: Vec<ArrivalMeasurement>,
    moves: u64,
}

impl<W: Relocate> World for Remembering<'_, W> {
    type Error = W::Error;

    fn percept(&mut self) -> Result<Percept, W::Error> {
        let percept = self.world.percept()?;
        if self.walk.perceive(percept, self.world.is_blocked()) {
            self.measured.push(self.world.measured());
        }
        Ok(percept)
    }

    fn traverse(&mut self, door: Door) -> Result<(), W::Error> {
        self.world.traverse(door)?;
        self.moves += 1;
        self.walk.leave(door);
        Ok(())
    }

    fn senses(&mut self) -> ArrivalSenses {
        self.world.senses()
    }
}

impl<W: Relocate + ObservedWorld> ObservedWorld for Remembering<'_, W> {
    fn event(&mut self, walk: &MapWalk, event: MappingEvent) {
        self.world.event(walk, event);
    }
}

impl FoldingRun {
    /// Goes on with a trail of earlier walks, with the robot where the marker lies. `seen` is its percept.
    fn resume<W: ObservedWorld>(
        &mut self,
        (trail, event): (FoldedTrail, SafeguardEvent),
        seen: Percept,
        world: &mut W,
    ) -> Mapped<W> {
        let moves = self.walk.moves();
        self.clear();
        self.walk.set_moves(moves);
        self.trail = trail;
        let marker = self.trail.marker().ok_or(InvalidStep::NoPlan)?;
        let Percept { degree, sighting } = seen;
        self.walk.check_bound(degree)?;
        self.walk.map.add_vertex(degree);
        if let Sighting::Pointing(door) = sighting {
            self.trail.stand_at(self.trail.behind(marker, door.inverse(degree)));
        }
        self.put_in_map(marker);
        self.find_robot();
        world.event(&self.walk, MappingEvent::Safeguard(event));
        self.settle(world)?;
        while let Some(choice) = self.choose()? {
            self.step(choice, world)?;
        }
        Ok(())
    }

    fn find_marker<W: ObservedWorld>(
        &mut self,
        known: FoldedTrail,
        world: &mut W,
    ) -> Mapped<W, Percept> {
        let mut percept = world.percept().map_err(MappingError::World)?;
        let mut search = MarkerWalk::new(known);
        let mut step = search.begin(percept);
        let begun = self.walk.moves();
        while !sees_marker(&percept) {
            step?;
            if self.walk.moves() - begun >= search.most_moves() {
                return Err(Contradiction::NoMarker.into());
            }
            let door = search.next_door().ok_or(Contradiction::NoMarker)?;
            percept = self.walk.go(door, world)?;
            step = search.step(door, percept);
        }
        Ok(percept)
    }
}

/// Maps a world with the folding explorer, and recovers after contradictions and errors. Without earlier walks the
/// robot stands at the marked vertex at its start, with its back to the facing door. With them it may stand anywhere:
/// it looks for the marker, and goes on with what those walks have shown. Afterwards `exploration` holds the map.
///
/// It is an error if the world cannot go on, at the bound, or after too many recoveries.
pub(crate) fn map_with_recovery<W: Relocate + ObservedWorld>(
    world: &mut W,
    exploration: &mut FoldingRun,
    config: RecoveryConfig,
    earlier: &[EarlierWalk],
) -> Mapped<W, MappedWorld> {
    let mut walks = EarlierWalks::default();
    for walk in earlier {
        walks.add(walk.clone());
    }
    let mut recovery = Recovery {
        world: Remembering { world, walk: EarlierWalk::default(), measured: Vec::new(), moves: 0 },
        exploration,
        config,
        walks,
        has_failed: false,
        has_retried: false,
        mapped: MappedWorld {
            pose: FACING,
            moves: 0,
            audit_moves: 0,
            audited_percepts: Vec::new(),
            recoveries: 0,
            blocked: Vec::new(),
        },
    };
    let mut ended = if earlier.is_empty() {
        explore(recovery.exploration, &mut recovery.world)
    } else {
        recovery.recover_from_here()
    };
    loop {
        match ended.and_then(|()| recovery.check_map()) {
            Ok((pose, blocked)) => {
                let moves = recovery.world.moves;
                return Ok(MappedWorld { pose, moves, blocked, ..recovery.mapped });
            }
            Err(error) if recovery.mapped.recoveries == config.most_recoveries => {
                return Err(error);
            }
            Err(error) => ended = recovery.recover(error),
        }
    }
}

struct Recovery<'w, 'e, W> {
    world: Remembering<'w, W>,
    exploration: &'e mut FoldingRun,
    config: RecoveryConfig,
    walks: EarlierWalks,
    /// Whether the last search, for a junction or for the marker, was without success.
    has_failed: bool,
    has_retried: bool,
    /// What it took so far.
    mapped: MappedWorld,
}

impl<W: Relocate + ObservedWorld> Recovery<'_, '_, W> {
    fn report(&mut self, event: SafeguardEvent) {
        self.world.event(&self.exploration.walk, MappingEvent::Safeguard(event));
    }

    fn keep_walk(&mut self) {
        self.world.measured.clear();
        self.walks.add(mem::take(&mut self.world.walk));
    }

    /// Leaves the place of a contradiction, looks for the marker and goes on with the walks that agree.
    fn recover(&mut self, error: MappingError<W::Error>) -> Mapped<W> {
        self.mapped.recoveries += 1;
        self.keep_walk();
        match error {
            MappingError::Contradiction(contradiction) => {
                self.report(SafeguardEvent::Contradicted(contradiction));
                self.leave_place()?;
            }
            MappingError::Bound { bound } => {
                // The robot found ever more places, and nothing that it could compare.
                self.walks.forget();
                self.report(SafeguardEvent::TooLarge { bound });
                self.leave_place()?;
            }
            MappingError::World(error) => {
                self.relocate(error)?;
                self.report(SafeguardEvent::Relocated);
            }
            error @ (MappingError::InvalidStep(_) | MappingError::GaveUp(_)) => return Err(error),
        }
        self.recover_from_here()
    }

    /// The percept that contradicts the others may be the false one, so the next walk begins at the next place.
    fn leave_place(&mut self) -> Mapped<W> {
        match self.world.world.traverse(Door::BACK) {
            Ok(()) => self.world.moves += 1,
            Err(error) => self.relocate(error)?,
        }
        Ok(())
    }

    fn relocate(&mut self, error: W::Error) -> Mapped<W> {
        let relocated = self.world.world.relocate(error);
        relocated.map_err(|error| self.failed(MappingError::World(error)))
    }

    /// The robot does not find a junction, or the marker. Two searches without success, one after the other, do
    /// not come from one mistake, so the second is the last.
    fn failed(&mut self, error: MappingError<W::Error>) -> MappingError<W::Error> {
        if mem::replace(&mut self.has_failed, true) {
            self.mapped.recoveries = self.config.most_recoveries;
        }
        error
    }

    /// Looks for the marker, and goes on with the walks that agree. The next walk begins at the marker.
    fn recover_from_here(&mut self) -> Mapped<W> {
        let (known, _) = self.walks.fold_most(&FoldedTrail::default(), 0);
        let seen = match self.exploration.find_marker(known, &mut self.world) {
            Err(error @ MappingError::Contradiction(Contradiction::NoMarker)) => {
                return Err(self.failed(error));
            }
            found => found?,
        };
        self.has_failed = false;
        self.keep_walk();
        self.world.walk = EarlierWalk::new(seen, [], false);
        self.world.measured.push(ArrivalMeasurement::default());
        let folded = self.walks.fold_most(&FoldedTrail::default(), 1);
        let degree = folded.0.marker().map(|marker| folded.0.degree(marker));
        // If the robot sees the marker where it begins to look, no walk ends with what it sees.
        let (trail, kept) = if degree == Some(seen.degree) {
            folded
        } else {
            self.walks.fold_most(&FoldedTrail::new(seen)?, 0)
        };
        let event = SafeguardEvent::MarkerFound { kept, walks: self.walks.len() };
        self.exploration.resume((trail, event), seen, &mut self.world)
    }

    /// Audits a complete map, and tries its blocked doors. Returns the robot's pose in it, and the darts of the
    /// blocked doors.
    fn check_map(&mut self) -> Mapped<W, (Dart, Vec<Dart>)> {
        let before = self.world.moves;
        let audited = self.audit_map();
        self.mapped.audit_moves += self.world.moves - before;
        let (pose, blocked) = audited?;
        self.compare_measurements()?;
        if !self.config.retries_blocked || self.has_retried || blocked.is_empty() {
            return Ok((pose, blocked));
        }
        self.has_retried = true;
        self.report(SafeguardEvent::BlockedRetried { doors: blocked.len() });
        let map = self.exploration.map().complete().ok_or(InvalidStep::NoPlan)?;
        match try_doors(&mut self.world, map, pose, &blocked) {
            Ok(pose) => Ok((pose, blocked)),
            Err(MappingError::Contradiction(_)) if !self.world.world.is_blocked() => {
                // A hallway is free now. What was seen while it was blocked is of another world.
                self.keep_walk();
                self.walks.forget_blocked();
                Err(Contradiction::Unblocked.into())
            }
            Err(error) => Err(error),
        }
    }

    /// Compares what was measured since the robot last began a walk. All percepts of it agree with the map.
    fn compare_measurements(&mut self) -> Mapped<W> {
        let (Some(noise), Some(map)) = (self.config.noise, self.exploration.map().complete())
        else {
            return Ok(());
        };
        let Remembering { walk, measured, .. } = &self.world;
        let check = MeasurementCheck::new(&walk.visits(measured, map, FACING), &noise);
        if check.contradictions.is_empty() { Ok(()) } else { Err(Contradiction::Moved.into()) }
    }

    fn audit_map(&mut self) -> Mapped<W, (Dart, Vec<Dart>)> {
        let mut blocked = Vec::new();
        let walk = &self.exploration.walk;
        let map = walk.map().complete().ok_or(InvalidStep::NoPlan)?;
        let note = |world: &mut Remembering<W>, made: AuditMove| {
            // The last audit counts.
            if made.number == 1 {
                blocked.clear();
            }
            let dart = map.opposite(made.pose);
            if world.world.is_blocked() && !blocked.contains(&dart) {
                blocked.push(dart);
            }
        };
        let pose;
        (pose, self.mapped.audited_percepts) =
            audit_times(self.config.audits, &mut self.world, walk, note)?;
        blocked.sort_unstable();
        Ok((pose, blocked))
    }
}
