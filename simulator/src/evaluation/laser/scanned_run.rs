//! A whole run by laser: a robot maps a random building by its scans alone. Corners are no vertices.

use std::{borrow::Cow, sync::Arc};

use nalgebra::Isometry2;
use rand::seq::IndexedRandom;
use toposlam_model::{
    check::judge_map,
    embedded_graph::Dart,
    enumerate::Watch,
    isomorphism::Candidate,
    mapping::{ExploredMap, FACING, MappingError, MappingMethod},
};
use toposlam_vision::visits::Visits;

use super::{
    super::parallel::made_in_turn,
    corridor_pilot::CorridorPilot,
    corridor_world::CorridorWorld,
    judged_walk::WalkSampler,
    laser_robot::{LaserRobot, PerceptTally, ScanFailure},
    smoothed_world::SmoothedWorld,
    walk::WalkDriver,
};
use crate::{LaserScanner, ScannedBuilding};

/// A whole run.
#[derive(Clone, Debug, PartialEq)]
pub struct ScannedRun {
    /// Its number among the runs of the seed.
    pub number: u64,
    /// The number of moves, with those of recoveries and audits, if the map is complete.
    pub moves: u64,
    /// The length of the way, in metres.
    pub way: f64,
    /// The number of recoveries, if the map is complete.
    pub recoveries: u32,
    /// What the robot derived on its way.
    pub tally: PerceptTally,
    /// How it ended.
    pub outcome: ScannedOutcome,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ScannedOutcome {
    /// The map and the pose are right.
    Right,
    /// The robot gave up, for this reason.
    GaveUp(String),
    /// The map or the pose is wrong, and the robot did not notice.
    Wrong(String),
}

impl ScannedOutcome {
    /// Its name.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::GaveUp(_) => "gave up",
            Self::Wrong(_) => "wrong",
        }
    }
}

/// The robot begins this far from its first junction, or in the middle of the corridor, in metres.
const BEFORE: f64 = 9.0;
/// The robot gives up if it knows more than twice the darts of the building and this many.
const SPARE_DARTS: usize = 20;

impl WalkSampler {
    /// Makes whole runs by their numbers on all threads. If the watch stops, some are missing.
    #[must_use]
    pub fn runs(
        &self,
        numbers: std::ops::Range<u64>,
        method: MappingMethod,
        watch: &dyn Watch,
    ) -> Vec<ScannedRun> {
        made_in_turn(numbers, watch, Some, |number| self.run(number, method, watch))
    }

    /// Makes the whole run with this number; `None` if the watch stops.
    fn run(&self, number: u64, method: MappingMethod, watch: &dyn Watch) -> Option<ScannedRun> {
        let seed = self.run_seed(number);
        let world = CorridorWorld::random(self.buildings, seed);
        let smoothed = SmoothedWorld::of(&world)?;
        let params = self.scanner_of(number);
        let building = Arc::new(ScannedBuilding::new(&world.plan, &params, seed));
        let mut driver = WalkDriver::new(self.drift, seed);
        let graph = &smoothed.graph;
        let starts: Vec<Dart> =
            graph.darts().filter(|dart| graph.degree_around(*dart) >= 3).collect();
        let &facing = starts.choose(&mut driver.chance)?;
        let [start, behind] = smoothed.first_corridor(facing).map(|place| world.places[place]);
        let off = [0, 1].map(|axis| behind[axis] - start[axis]);
        let share = (BEFORE / off[0].hypot(off[1])).min(0.5);
        driver.begin_at([0, 1].map(|axis| start[axis] + share * off[axis]));
        let mut robot = LaserRobot {
            world: &world,
            smoothed: &smoothed,
            pilot: CorridorPilot::new(&world),
            scanner: LaserScanner::new(building, &params, seed),
            visits: Visits::by_laser(self.sensing),
            driver,
            params: self.sensing,
            facing,
            watch,
            sensed: 0,
            odometry_from_map: Isometry2::identity(),
            seen: Vec::new(),
            left: None,
            looked: None,
            is_at_opening: false,
            here: None,
            tally: PerceptTally::default(),
        };
        let begun = robot.drive((-off[1]).atan2(-off[0]));
        if begun == Err(ScanFailure::Stopped) {
            return None;
        }
        let bound = 2 * graph.dart_count() + SPARE_DARTS;
        let (mapping, mapped) = method.map_world(&mut robot, bound, &[], &mut ());
        let (moves, recoveries, outcome) = match mapped {
            Err(MappingError::World(ScanFailure::Stopped)) => return None,
            Err(error) => (mapping.moves(), 0, ScannedOutcome::GaveUp(error.to_string())),
            Ok(mapped) => {
                // A robot at no junction is not at its pose in the map.
                let truly = robot.truth().unwrap_or(Dart(u32::MAX));
                let outcome = mapping.map().complete().map_or_else(
                    || ScannedOutcome::GaveUp("the map is not complete".to_owned()),
                    |map| {
                        let graph = Cow::Borrowed(map);
                        let map = ExploredMap { graph, facing: FACING, pose: mapped.pose };
                        let mut candidate = Candidate::default();
                        let world = (&smoothed.graph, facing);
                        let flaw = judge_map(&map, world, truly, &mut candidate).err();
                        flaw.map_or(ScannedOutcome::Right, |flaw| {
                            ScannedOutcome::Wrong(flaw.to_string())
                        })
                    },
                );
                (mapped.moves, mapped.recoveries, outcome)
            }
        };
        let (way, tally) = (robot.driver.way, robot.tally);
        Some(ScannedRun { number, moves, way, recoveries, tally, outcome })
    }
}

#[cfg(test)]
mod tests {
    use toposlam_model::mapping::{MappingAlgorithm, RecoveryConfig};
    use toposlam_vision::laser::params::LaserParams;

    use super::{super::corridor_world::BuildingKind, *};
    use crate::ScannerParams;

    fn sampler(buildings: BuildingKind, seed: u64) -> WalkSampler {
        let (scanner, sensing) = (None, LaserParams::default());
        let drift = 1_f64.to_radians() / 10.0;
        WalkSampler { seed, buildings, places: 12, drift, scanner, sensing }
    }

    fn folding() -> MappingMethod {
        MappingMethod::from(MappingAlgorithm::Folding)
    }

    #[test]
    fn with_plain_walls_every_map_is_right_and_with_a_full_circle_every_percept() {
        for buildings in [BuildingKind::Mixed, BuildingKind::Diagonal] {
            for field_of_view in [180.0, 360.0] {
                let scanner = Some(ScannerParams { field_of_view, ..ScannerParams::PLAIN });
                let sampler = WalkSampler { scanner, ..sampler(buildings, 1) };
                for run in sampler.runs(0..2, folding(), &()) {
                    assert_eq!(run.outcome, ScannedOutcome::Right, "{run:?}");
                    let PerceptTally { percepts, wrong, passed } = run.tally;
                    // A scanner that sees half of a circle may pass a junction unnoticed.
                    let passed = if field_of_view == 360.0 { passed } else { 0 };
                    assert_eq!((percepts, wrong, passed), (run.moves + 1, 0, 0), "{run:?}");
                }
            }
        }
    }

    #[test]
    fn a_robot_that_recovers_ends_right_after_percepts_that_are_wrong() {
        let recovering = MappingMethod::Recovering(RecoveryConfig::default());
        let sampler = sampler(BuildingKind::Diagonal, RECOVERED.0);
        let run = |method| sampler.runs(RECOVERED.1..RECOVERED.1 + 1, method, &()).remove(0);
        let without = run(folding());
        assert!(matches!(without.outcome, ScannedOutcome::GaveUp(_)), "{without:?}");
        let with = run(recovering);
        assert_eq!(with.outcome, ScannedOutcome::Right, "{with:?}");
        assert!(with.recoveries > 0, "{with:?}");
    }

    /// The seed and the number of a run in which what the robot derives contradicts itself.
    const RECOVERED: (u64, u64) = (4, 3);
}
