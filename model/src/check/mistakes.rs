//! What one mistake does to a run: every start, every percept, every way in which it can be false, and every
//! place to which the robot can be carried.

use std::{borrow::Cow, fmt, ops::ControlFlow};

use super::judge_map;
use crate::{
    aid::{RefusedAction, State},
    counts::counted,
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{
        Class, Each, EnumeratedGraph, Enumeration, EnumerationPart, SizeError, Watch, in_parts,
    },
    isomorphism::Candidate,
    mapping::{ExploredMap, FACING, Flaw, MappingError, MappingMethod, Relocate},
    percept::{Door, Percept, Sighting},
    world::{GraphWorld, World},
};

crate::words! {
    MistakeKind {
        /// The number of doors is wrong.
        Degree = "wrong degree",
        /// The marker is seen where it does not lie.
        MarkerInvented = "marker invented",
        /// The marker is not seen where it lies.
        MarkerMissed = "marker missed",
        /// The marker is seen where it lies, but along another door.
        MarkerTurned = "marker turned",
        /// The robot is carried to another place, or turned, and does not feel it. All percepts are true.
        Carried = "robot carried",
    }
}

impl MistakeKind {
    /// The mistakes of this kind at a place, with degrees up to twice the number of edges.
    fn mistakes(self, graph: &EmbeddedGraph, pose: Dart, truth: Percept) -> Vec<MistakeEffect> {
        let Percept { degree, sighting } = truth;
        let degrees = 1..=graph.dart_count() as u32;
        let see = |degree, sighting| MistakeEffect::Perceived(Percept { degree, sighting });
        let point = |door| see(degree, Sighting::Pointing(Door(door)));
        match (self, sighting) {
            // A junction with too few doors does not have the one along which the marker points.
            (Self::Degree, _) => degrees
                .filter(|&other| other != degree)
                .filter(|&other| !matches!(sighting, Sighting::Pointing(door) if door.0 >= other))
                .map(|other| see(other, sighting))
                .collect(),
            (Self::MarkerTurned, Sighting::Pointing(door)) => {
                (0..degree).filter(|&other| other != door.0).map(point).collect()
            }
            (Self::MarkerMissed, Sighting::Pointing(_)) => vec![see(degree, Sighting::Nothing)],
            (Self::MarkerInvented, Sighting::Nothing) => (0..degree).map(point).collect(),
            (Self::Carried, _) => {
                graph.darts().filter(|&other| other != pose).map(MistakeEffect::Carried).collect()
            }
            _ => Vec::new(),
        }
    }
}

/// What happens instead of what should.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MistakeEffect {
    Perceived(Percept),
    /// The robot is then at this dart of the world, as if it had come in by it.
    Carried(Dart),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mistake {
    /// It happens when the robot has made this number of moves, before it perceives its place.
    pub moves: u64,
    pub truth: Percept,
    pub effect: MistakeEffect,
}

/// What happens, in words: `after 2 moves, 3 doors is perceived instead of 2 doors`.
impl fmt::Display for Mistake {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let Self { moves, truth, effect } = self;
        write!(out, "after {}, ", counted(*moves as usize, "move"))?;
        match effect {
            MistakeEffect::Perceived(percept) => {
                write!(out, "the robot perceives \"{percept}\" instead of \"{truth}\"")
            }
            MistakeEffect::Carried(dart) => {
                write!(out, "the robot is carried to the vertex of dart {}, entered by it", dart.0)
            }
        }
    }
}

/// A world in which one thing goes wrong. Without a mistake, it keeps each visit.
struct FaultyWorld<'g> {
    world: GraphWorld<'g>,
    mistake: Option<Mistake>,
    visits: Vec<(Dart, Percept)>,
}

impl<'g> FaultyWorld<'g> {
    fn new(world: GraphWorld<'g>, mistake: Option<Mistake>) -> Self {
        let mut faulty = Self { world, mistake, visits: Vec::new() };
        faulty.arrive();
        faulty
    }

    /// What happens now instead of what should.
    fn effect(&self) -> Option<MistakeEffect> {
        let mistake = self.mistake.filter(|mistake| mistake.moves == self.world.moves());
        mistake.map(|mistake| mistake.effect)
    }

    fn arrive(&mut self) {
        if let Some(MistakeEffect::Carried(pose)) = self.effect() {
            let placed = self.world.state().placed;
            self.world = self.world.clone().at(State { pose, placed });
        }
        if self.mistake.is_none() {
            self.visits.push((self.world.pose(), self.world.sensed()));
        }
    }
}

impl World for FaultyWorld<'_> {
    type Error = RefusedAction;

    fn percept(&mut self) -> Result<Percept, RefusedAction> {
        match self.effect() {
            Some(MistakeEffect::Perceived(percept)) => Ok(percept),
            _ => self.world.percept(),
        }
    }

    fn traverse(&mut self, door: Door) -> Result<(), RefusedAction> {
        self.world.traverse(door)?;
        self.arrive();
        Ok(())
    }
}

/// A robot that looks for a door that is not there stays where it is.
impl Relocate for FaultyWorld<'_> {
    fn relocate(&mut self, error: RefusedAction) -> Result<(), RefusedAction> {
        match error {
            RefusedAction::NoSuchDoor { .. } => self.traverse(Door::BACK),
            error => Err(error),
        }
    }
}

/// How runs with one mistake ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MistakeCounts {
    /// The map and the pose are right.
    pub right: u64,
    /// The robot reports a contradiction, or that a door is not there.
    pub reported: u64,
    /// The robot gives up, because its map has more than twice the darts of the world and 20.
    pub too_large: u64,
    /// The map is right, the pose is wrong, and nothing shows it to the robot.
    pub wrong_pose: u64,
    /// The map is wrong, and nothing shows it to the robot.
    pub wrong_map: u64,
    /// The moves of the right runs, beyond those of the runs without a mistake.
    pub extra_moves: i64,
}

impl MistakeCounts {
    pub fn runs(&self) -> u64 {
        self.right + self.reported + self.too_large + self.undetected()
    }

    /// The number of runs that end with a wrong map or a wrong pose.
    pub fn undetected(&self) -> u64 {
        self.wrong_pose + self.wrong_map
    }

    pub fn add(&mut self, other: Self) {
        self.right += other.right;
        self.reported += other.reported;
        self.too_large += other.too_large;
        self.wrong_pose += other.wrong_pose;
        self.wrong_map += other.wrong_map;
        self.extra_moves += other.extra_moves;
    }
}

/// A run that ends with a wrong map or a wrong pose, and nothing shows it to the robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UndetectedMistake {
    pub graph: EmbeddedGraph,
    pub facing: Dart,
    pub mistake: Mistake,
    pub flaw: Flaw,
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MistakeTally {
    pub starts: u64,
    /// For each of the [kinds](MistakeKind::ALL), how the runs ended.
    pub counts: [MistakeCounts; 5],
    /// For each of them, the first run that ends with a wrong map; if there is none, with a wrong pose.
    pub first: [Option<UndetectedMistake>; 5],
    /// The moves of all runs without a mistake.
    pub moves: u64,
    pub interrupted: bool,
}

impl MistakeTally {
    /// Adds the results of a later part of the same check, or of larger worlds.
    pub fn merge(&mut self, later: Self) {
        self.starts += later.starts;
        self.moves += later.moves;
        self.interrupted |= later.interrupted;
        for (sum, counts) in self.counts.iter_mut().zip(later.counts) {
            sum.add(counts);
        }
        for (first, other) in self.first.iter_mut().zip(later.first) {
            if let Some(other) = other {
                keep_first(first, other);
            }
        }
    }

    pub fn all(&self) -> MistakeCounts {
        let mut all = MistakeCounts::default();
        self.counts.iter().for_each(|&counts| all.add(counts));
        all
    }
}

/// A wrong map goes before a wrong pose.
fn keep_first(first: &mut Option<UndetectedMistake>, other: UndetectedMistake) {
    let is_pose = |mistake: &UndetectedMistake| matches!(mistake.flaw, Flaw::WrongPose { .. });
    if first.as_ref().is_none_or(|first| is_pose(first) && !is_pose(&other)) {
        *first = Some(other);
    }
}

/// A check of every start of every world of a class with a number of edges. From each start, an algorithm
/// runs once for each mistake that can happen.
#[derive(Clone, Copy, Debug)]
pub struct MistakeCheck {
    starts: Enumeration,
    method: MappingMethod,
}

impl MistakeCheck {
    /// A check of one way to map.
    ///
    /// # Errors
    /// Returns an error if the starts cannot be enumerated.
    pub fn new(class: Class, edges: usize, method: MappingMethod) -> Result<Self, SizeError> {
        let starts = Enumeration::new(Each::Start, class, edges)?;
        Ok(Self { starts, method })
    }

    /// Makes all runs. The result does not depend on the number of threads.
    pub fn run(&self, watch: &dyn Watch) -> MistakeTally {
        let check = |part: &EnumerationPart| {
            let mut tally = MistakeTally { interrupted: watch.stop(), ..MistakeTally::default() };
            // There are many parts, and the first start of each may take long.
            if tally.interrupted {
                return tally;
            }
            let mut runs = MistakenRuns { check: *self, candidate: Candidate::default() };
            let ended = part.for_each(&mut |found: EnumeratedGraph| {
                runs.check_start(found.graph, &mut tally);
                if watch.stop() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
            tally.interrupted = ended.is_break();
            tally
        };
        let merge = |mut sum: MistakeTally, later| {
            sum.merge(later);
            sum
        };
        let runs = |tally: &MistakeTally| tally.all().runs();
        in_parts(&self.starts.parts(), watch, MistakeTally::default, check, runs, merge)
    }
}

struct MistakenRuns {
    check: MistakeCheck,
    candidate: Candidate,
}

impl MistakenRuns {
    fn check_start(&mut self, graph: &EmbeddedGraph, tally: &mut MistakeTally) {
        let facing = Dart(0);
        tally.starts += 1;
        let visits = self.visits(graph, facing);
        // A percept is one for each number of moves.
        let least = visits.len() as u64 - 1;
        tally.moves += least;
        for (moves, &(pose, truth)) in (0..).zip(&visits) {
            for (at, kind) in MistakeKind::ALL.into_iter().enumerate() {
                for effect in kind.mistakes(graph, pose, truth) {
                    let mistake = Mistake { moves, truth, effect };
                    let counts = &mut tally.counts[at];
                    let mut world = FaultyWorld::new(GraphWorld::new(graph, facing), Some(mistake));
                    let explored = match self.map(&mut world, graph) {
                        Ok(explored) => explored,
                        Err(MappingError::Bound { .. }) => {
                            counts.too_large += 1;
                            continue;
                        }
                        Err(_) => {
                            counts.reported += 1;
                            continue;
                        }
                    };
                    let (made, pose) = (world.world.moves(), world.world.pose());
                    let judged = judge_map(&explored, (graph, facing), pose, &mut self.candidate);
                    let Err(flaw) = judged else {
                        counts.right += 1;
                        counts.extra_moves += made.cast_signed() - least.cast_signed();
                        continue;
                    };
                    match flaw {
                        Flaw::WrongPose { .. } => counts.wrong_pose += 1,
                        _ => counts.wrong_map += 1,
                    }
                    let graph = graph.clone();
                    let undetected = UndetectedMistake { graph, facing, mistake, flaw };
                    keep_first(&mut tally.first[at], undetected);
                }
            }
        }
    }

    fn visits(&mut self, graph: &EmbeddedGraph, facing: Dart) -> Vec<(Dart, Percept)> {
        let mut world = FaultyWorld::new(GraphWorld::new(graph, facing), None);
        // A flaw of a run without a mistake is found by a sweep.
        let _ = self.map(&mut world, graph);
        world.visits
    }

    fn map(
        &self,
        world: &mut FaultyWorld,
        graph: &EmbeddedGraph,
    ) -> Result<ExploredMap<'static>, MappingError<RefusedAction>> {
        let bound = 2 * graph.dart_count() + 20;
        let (walk, mapped) = self.check.method.map_world(world, bound, &[], &mut ());
        let pose = mapped?.pose;
        let map = walk.map().complete().ok_or(MappingError::Bound { bound })?;
        Ok(ExploredMap { graph: Cow::Owned(map.clone()), facing: FACING, pose })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        any_graph::StopAt,
        mapping::{MappingAlgorithm, RecoveryConfig},
    };

    fn tally(edges: usize, method: MappingMethod) -> MistakeTally {
        MistakeCheck::new(Class::Multigraph, edges, method).unwrap().run(&())
    }

    /// The worlds are an edge between two vertices and a loop. The robot perceives the marked vertex, makes one move, and
    /// perceives the other vertex, or the marked one again.
    #[test]
    fn the_mistakes_that_can_happen_with_one_edge_are_counted_by_hand() {
        let tally = tally(1, MappingAlgorithm::Algorithm1.into());
        assert_eq!((tally.starts, tally.moves), (2, 2));
        let runs = MistakeKind::ALL.into_iter().zip(tally.counts.map(|counts| counts.runs()));
        let expected = [
            // Two doors instead of one at both vertices; one instead of two where the marker points along the first.
            (MistakeKind::Degree, 3),
            // At the other vertex of the edge, along its only door.
            (MistakeKind::MarkerInvented, 1),
            (MistakeKind::MarkerMissed, 3),
            // On the loop, each time.
            (MistakeKind::MarkerTurned, 2),
            // To the other dart, at each of the four places.
            (MistakeKind::Carried, 4),
        ];
        assert_eq!(runs.collect::<Vec<_>>(), expected);
        assert_eq!(tally.all().runs(), 13);
    }

    #[test]
    fn tallies_are_added_number_by_number() {
        let counts = |from: u64| MistakeCounts {
            right: from,
            reported: from + 1,
            too_large: from + 2,
            wrong_pose: from + 3,
            wrong_map: from + 4,
            extra_moves: -7,
        };
        assert_eq!((counts(10).undetected(), counts(10).runs()), (27, 60));
        let one = MistakeTally {
            starts: 3,
            counts: [10, 20, 30, 40, 50].map(counts),
            moves: 5,
            ..MistakeTally::default()
        };
        let mut sum = one.clone();
        sum.merge(MistakeTally { interrupted: true, ..one });
        assert_eq!((sum.starts, sum.moves, sum.interrupted), (6, 10, true));
        let expected = MistakeCounts {
            right: 20,
            reported: 22,
            too_large: 24,
            wrong_pose: 26,
            wrong_map: 28,
            extra_moves: -14,
        };
        assert_eq!(sum.counts[0], expected);
        assert_eq!(sum.all().runs(), 2 * (5 * 10 + 50 + 100 + 150 + 200 + 250));
    }

    #[test]
    fn with_an_audit_no_mistake_leaves_a_wrong_map() {
        for algorithm in MappingAlgorithm::with_fixed_marker() {
            for edges in 1..=4 {
                let [with, without] =
                    [1, 0].map(|audits| tally(edges, MappingMethod::By { algorithm, audits }));
                assert_eq!(with.all().wrong_map, 0, "{algorithm}, {edges}: {:?}", with.first);
                assert!(edges == 1 || without.all().wrong_map > 0, "{algorithm}, {edges}");
                // A pose is wrong only if the robot was carried, on the audit.
                let percepts = &with.counts[..MistakeKind::ALL.len() - 1];
                assert!(percepts.iter().all(|counts| counts.wrong_pose == 0), "{algorithm}");
            }
        }
    }

    #[test]
    fn after_one_mistake_the_folding_explorer_recovers_and_maps_every_small_start() {
        for edges in 1..=3 {
            let tally = tally(edges, MappingMethod::Recovering(RecoveryConfig::default()));
            let all = tally.all();
            assert_eq!(all.right + all.wrong_pose, all.runs(), "{edges}: {all:?}");
            // The robot was carried on the last way of the audit.
            assert_eq!(all.wrong_pose, tally.counts[MistakeKind::ALL.len() - 1].wrong_pose);
        }
    }

    #[test]
    fn a_check_that_is_stopped_begins_no_start() {
        let check = MistakeCheck::new(Class::Multigraph, 5, MappingAlgorithm::Algorithm1.into());
        let tally = check.unwrap().run(&StopAt::new(1));
        assert_eq!(tally, MistakeTally { interrupted: true, ..MistakeTally::default() });
    }
}
