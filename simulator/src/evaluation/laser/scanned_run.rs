//! A whole run by laser: a robot maps a random building by its scans alone. Corners are no vertices.

use std::{borrow::Cow, collections::BTreeSet};

use rand::{RngExt, SeedableRng, seq::IndexedRandom};
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_logs::{
    messages,
    record::{RunObserver, StoppedBy},
    recorder::Recorder,
    writer::LogWriteError,
};
use toposlam_model::{
    check::judge_map,
    counts::counted,
    driving::pose::Pose,
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Watch,
    isomorphism::{Bijection, Candidate},
    mapping::{ExploredMap, FACING, Flaw, MappingError, MappingMethod},
};
use toposlam_robot::{
    corridors::CorridorExplorer, explorer::ExplorerError, run_settings::RunSettings,
};
use toposlam_vision::geometry::angle;

use super::{
    corridor_robot::{CorridorRobot, PerceptJudge},
    corridor_world::{CorridorWorld, SmoothedWorld},
    judged_walk::WalkSampler,
};
use crate::run::RobotOutcome;

pub use super::corridor_robot::PerceptTally;

#[derive(Clone, Debug, PartialEq)]
pub struct ScannedRun {
    pub number: u64,
    /// The number of moves, with those of recoveries and audits, if the map is complete.
    pub moves: u64,
    /// The length of the way, in metres.
    pub way: f64,
    /// The number of recoveries, if the map is complete.
    pub recoveries: u32,
    /// What the robot derived on its way.
    pub tally: PerceptTally,
    pub outcome: RobotOutcome<String>,
}

/// The robot begins this far from its first junction, or in the middle of the corridor, in metres.
const BEFORE: f64 = 9.0;
/// The robot gives up if it knows more than twice the darts of the building and this many.
const SPARE_DARTS: usize = 20;

/// A building, and where the robot begins in it.
struct RunStart {
    world: CorridorWorld,
    smoothed: SmoothedWorld,
    /// Where the marker lies.
    facing: Dart,
    /// Where the robot begins, and the drift of its odometry, in radians a metre.
    pose: Pose,
    drift: f64,
}

impl WalkSampler {
    fn start(&self, number: u64) -> Option<RunStart> {
        let seed = self.run_seed(number);
        let world = CorridorWorld::random(self.buildings, seed);
        let smoothed = world.smoothed()?;
        let mut chance = Xoshiro256PlusPlus::seed_from_u64(seed);
        let drift = self.drift * chance.random_range(-1.0..=1.0);
        let graph = &smoothed.graph;
        let starts: Vec<Dart> =
            graph.darts().filter(|dart| graph.degree_around(*dart) >= 3).collect();
        let &facing = starts.choose(&mut chance)?;
        let [start, behind] = smoothed.corridors[facing.at()].map(|place| world.places[place]);
        let off = behind - start;
        let position = start + (BEFORE / off.x.hypot(off.y)).min(0.5) * off;
        let pose = Pose { position: position.into(), heading: angle(-off) };
        Some(RunStart { world, smoothed, facing, pose, drift })
    }

    /// The graph of the junctions and dead ends of a run's building, and where its marker lies.
    pub fn run_world(&self, number: u64) -> Option<(EmbeddedGraph, Dart)> {
        let RunStart { smoothed, facing, .. } = self.start(number)?;
        Some((smoothed.graph, facing))
    }

    /// How the robot of a run maps.
    pub fn run_settings(graph: &EmbeddedGraph, method: MappingMethod) -> RunSettings {
        RunSettings::new(method, 2 * graph.dart_count() + SPARE_DARTS)
    }

    /// Makes the whole run with this number; `None` if the watch stops.
    pub fn run(&self, number: u64, method: MappingMethod, watch: &dyn Watch) -> Option<ScannedRun> {
        self.observed_run(number, method, &mut StoppedBy(watch))
    }

    /// Makes the run with this number, or as much of it as an observer allows, and writes its log, which begins with this
    /// head.
    pub fn logged_run(
        &self,
        number: u64,
        method: MappingMethod,
        head: &messages::Run,
        observer: impl RunObserver,
    ) -> Result<(Option<ScannedRun>, Vec<u8>), LogWriteError> {
        let mut recorder = Recorder::new(Vec::new(), head, None)?;
        let run = self.observed_run(number, method, &mut (&mut recorder, observer));
        Ok((run, recorder.finish()?))
    }

    fn observed_run(
        &self,
        number: u64,
        method: MappingMethod,
        observer: &mut dyn RunObserver,
    ) -> Option<ScannedRun> {
        self.run_by(number, method, observer, |_, _| {}).map(|(run, _)| run)
    }

    /// The same by a robot that is changed before it begins, by its building, and the doors that are blocked.
    fn run_by(
        &self,
        number: u64,
        method: MappingMethod,
        observer: &mut dyn RunObserver,
        change: impl Fn(&CorridorWorld, &mut CorridorRobot),
    ) -> Option<(ScannedRun, usize)> {
        let RunStart { world, smoothed, facing, pose, drift } = self.start(number)?;
        let seed = self.run_seed(number);
        let scanner = self.scanner(&world, number, seed);
        let marker = smoothed.corridors[facing.at()];
        let mut robot = CorridorRobot::new(&world, scanner, pose, drift, marker, seed);
        change(&world, &mut robot);
        let mut judge = PerceptJudge::new(&world, &smoothed);
        let mut explorer =
            CorridorExplorer::new(robot, &self.sensing, (&mut judge, &mut *observer));
        let settings = Self::run_settings(&smoothed.graph, method);
        let (mapping, mapped) = explorer.map(&settings);
        let way = explorer.way();
        let (moves, recoveries) = mapped
            .as_ref()
            .map_or((mapping.moves(), 0), |mapped| (mapped.moves, mapped.recoveries));
        let blocked = mapped.as_ref().map_or(0, |mapped| mapped.blocked.len());
        let world = (&smoothed.graph, facing);
        let outcome = match (mapped, mapping.map().complete()) {
            (Err(MappingError::World(ExplorerError::Stopped { .. })), _) => return None,
            (Err(error), _) => RobotOutcome::GaveUp(error.to_string()),
            (Ok(_), None) => RobotOutcome::GaveUp("the map is not complete".to_owned()),
            (Ok(mapped), Some(map)) if blocked > 0 => {
                if is_right_but_for(&mapped.blocked, (map, mapped.pose), world, judge.truth) {
                    let doors = counted(blocked, "blocked door");
                    RobotOutcome::GaveUp(format!("the map is right but for {doors}"))
                } else {
                    RobotOutcome::Wrong(Flaw::WrongMap.to_string())
                }
            }
            (Ok(mapped), Some(map)) => {
                // A robot at no junction is not at its pose in the map.
                let truly = judge.truth.unwrap_or(Dart(u32::MAX));
                let graph = Cow::Borrowed(map);
                let map = ExploredMap { graph, facing: FACING, pose: mapped.pose };
                match judge_map(&map, world, truly, &mut Candidate::default()) {
                    Ok(_) => RobotOutcome::Right,
                    Err(flaw) => RobotOutcome::Wrong(flaw.to_string()),
                }
            }
        };
        let tally = judge.tally;
        Some((ScannedRun { number, moves, way, recoveries, tally, outcome }, blocked))
    }
}

/// Whether a map and its pose are those of a world, but for what lies behind doors that are blocked. The robot truly came in by
/// a dart of the world, if it is at a junction.
fn is_right_but_for(
    blocked: &[Dart],
    (map, pose): (&EmbeddedGraph, Dart),
    (world, facing): (&EmbeddedGraph, Dart),
    truly: Option<Dart>,
) -> bool {
    let candidate = Bijection::of_starts((map, FACING), (world, facing));
    let image = |dart: Dart| candidate.images()[dart.at()];
    // An obstacle is a dead end of the map, and may be anywhere along the edge.
    let is_seen = |dart: &Dart| !blocked.contains(&map.opposite(*dart));
    let seen: Vec<Dart> = map.darts().filter(is_seen).collect();
    let is_like_its_image = |&dart: &Dart| {
        let there = image(dart);
        image(map.opposite(dart)) == world.opposite(there)
            && map.degree_around(dart) == world.degree_around(there)
    };
    let images: BTreeSet<Dart> = seen.iter().map(|dart| image(*dart)).collect();
    let is_at_pose = !is_seen(&pose) || Some(image(pose)) == truly;
    seen.iter().all(is_like_its_image) && images.len() == seen.len() && is_at_pose
}

#[cfg(test)]
mod tests {
    use nalgebra::center;
    use toposlam_model::mapping::{MappingAlgorithm, RecoveryConfig};
    use toposlam_model::percept::Door;
    use toposlam_vision::{geometry::direction, laser::params::LaserParams};

    use super::{super::corridor_world::BuildingKind, *};
    use crate::{ConvexPolygon, ScannerParams};

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
                for run in (0..2).map(|number| sampler.run(number, folding(), &()).unwrap()) {
                    assert_eq!(run.outcome, RobotOutcome::Right, "{run:?}");
                    let PerceptTally { percepts, wrong, passed } = run.tally;
                    // A scanner that sees half of a circle may pass a junction unnoticed.
                    let passed = if field_of_view == 360.0 { passed } else { 0 };
                    assert_eq!((percepts, wrong, passed), (run.moves + 1, 0, 0), "{run:?}");
                }
            }
        }
    }

    #[test]
    fn a_robot_that_sees_3_5_m_drives_into_each_way_and_derives_every_percept_rightly() {
        for name in ["lds-01", "urg-04lx"] {
            let ScannerParams { field_of_view, angular_step, range, noise, range_noise, .. } =
                ScannerParams::named(name).unwrap();
            let scanner = ScannerParams {
                field_of_view,
                angular_step,
                range,
                noise,
                range_noise,
                ..ScannerParams::PLAIN
            };
            let sampler = WalkSampler { scanner: Some(scanner), ..sampler(BuildingKind::Mixed, 1) };
            for run in (0..2).map(|number| sampler.run(number, folding(), &()).unwrap()) {
                assert_eq!(run.outcome, RobotOutcome::Right, "{name}: {run:?}");
                assert_eq!((run.tally.percepts, run.tally.wrong), (run.moves + 1, 0), "{run:?}");
            }
        }
    }

    /// An obstacle that no scan shows, across the corridor behind the one in which the robot begins.
    #[test]
    fn what_stops_a_robot_is_no_dead_end() {
        let scanner = Some(ScannerParams::PLAIN);
        let sampler = WalkSampler { scanner, ..sampler(BuildingKind::Long, 1) };
        let RunStart { smoothed, facing, .. } = sampler.start(0).unwrap();
        let [from, to] = smoothed.corridors[smoothed.graph.behind(facing, Door(1)).at()];
        let block = |world: &CorridorWorld, robot: &mut CorridorRobot| {
            let [from, to] = [from, to].map(|place| world.places[place]);
            let middle = center(&from, &to);
            let half = [0.3, 4.0];
            robot.obstacle = Some(ConvexPolygon::rectangle(middle, half, direction(from, to)));
        };
        let (run, _) = sampler.run_by(0, folding(), &mut (), block).unwrap();
        let RobotOutcome::GaveUp(why) = &run.outcome else { panic!("{run:?}") };
        assert!(why.contains("something stops the robot"), "{why}");
        assert_eq!(run.tally.wrong, 0, "{run:?}");
        let recovering = MappingMethod::Recovering(RecoveryConfig::default());
        let (run, blocked) = sampler.run_by(0, recovering, &mut (), block).unwrap();
        assert!(blocked > 0 || matches!(run.outcome, RobotOutcome::GaveUp(_)), "{run:?}");
    }

    /// In this building some lobbies are wider than the range: from the corridor nothing is seen behind their entrance.
    #[test]
    fn a_lobby_whose_far_side_is_out_of_range_is_no_end() {
        let scanner = ScannerParams::named("lds-01");
        let sampler = WalkSampler { scanner, ..sampler(BuildingKind::Mixed, 5) };
        let recovering = MappingMethod::Recovering(RecoveryConfig::default());
        let run = sampler.run(24, recovering, &()).unwrap();
        assert_eq!((&run.outcome, run.tally.wrong), (&RobotOutcome::Right, 0), "{run:?}");
    }

    /// In these buildings corridors end at walls that are partly black: nothing comes back from there.
    #[test]
    fn a_robot_feels_for_a_black_wall_at_the_end_of_a_corridor() {
        let scanner = ScannerParams::named("lds-01");
        let sampler = WalkSampler { scanner, ..sampler(BuildingKind::Mixed, 5) };
        let recovering = MappingMethod::Recovering(RecoveryConfig::default());
        for number in [65, 133] {
            let (run, blocked) = sampler.run_by(number, recovering, &mut (), |_, _| {}).unwrap();
            assert_eq!((&run.outcome, blocked), (&RobotOutcome::Right, 0), "{run:?}");
        }
    }

    /// Three corridors from one junction to another one.
    #[test]
    fn a_map_with_blocked_doors_is_right_if_the_rest_is() {
        let corridors = |there: [&'static str; 3]| {
            let lists = [("here", vec!["e", "f", "g"]), ("there", there.to_vec())];
            EmbeddedGraph::from_edge_lists(&lists).unwrap()
        };
        let (theta, on_torus) = (corridors(["e", "g", "f"]), corridors(["e", "f", "g"]));
        let facing = Dart(0);
        for cut in [1, 2].map(Dart) {
            let (map, numbers) = theta.cut(&[cut], facing);
            let blocked: Vec<Dart> =
                [cut, theta.opposite(cut)].iter().filter_map(|dart| numbers[dart.at()]).collect();
            assert_eq!((numbers[0], blocked.len()), (Some(FACING), 2));
            let right = |world, pose, truly| {
                is_right_but_for(&blocked, (&map, pose), (world, facing), truly)
            };
            let pose = numbers[3].unwrap();
            assert!(right(&theta, pose, Some(Dart(3))));
            // Before the obstacle the robot is at no junction.
            assert!(right(&theta, map.opposite(blocked[0]), None));
            assert!(!right(&theta, pose, Some(Dart(4))) && !right(&theta, pose, None));
            assert!(!right(&on_torus, pose, Some(Dart(3))));
            let less =
                is_right_but_for(&blocked[..1], (&map, pose), (&theta, facing), Some(Dart(3)));
            assert!(!less);
        }
        // A dead end is no junction with three doors.
        let corridor = EmbeddedGraph::chain(1);
        let start = Some(facing);
        assert!(!is_right_but_for(&[facing], (&corridor, FACING), (&theta, facing), start));
        // A ring of four corridors is none of two, though each of its junctions looks as one of those.
        let (ring, four) = (EmbeddedGraph::cycle(2), EmbeddedGraph::cycle(4));
        let (map, numbers) = four.cut(&[Dart(4)], facing);
        let blocked: Vec<Dart> = [Dart(4), four.opposite(Dart(4))]
            .iter()
            .filter_map(|dart| numbers[dart.at()])
            .collect();
        assert!(is_right_but_for(&blocked, (&map, FACING), (&four, facing), start));
        assert!(!is_right_but_for(&blocked, (&map, FACING), (&ring, facing), start));
    }

    /// A scanner that does not look behind the robot, and with which it looks around beside openings. In these runs it does so
    /// beside an alcove that the last scan before shows as its way, beside the door of a room, and where it is already on its
    /// way into an alcove.
    #[test]
    fn an_alcove_beside_a_turn_is_no_dead_end_of_a_corridor() {
        let scanner = ScannerParams::named("utm-30lx");
        let sampler = WalkSampler { scanner, ..sampler(BuildingKind::Mixed, 5) };
        let recovering = MappingMethod::Recovering(RecoveryConfig::default());
        for number in [25, 35, 105] {
            let run = sampler.run(number, recovering, &()).unwrap();
            assert_eq!((&run.outcome, run.tally.wrong), (&RobotOutcome::Right, 0), "{run:?}");
        }
    }

    /// In this run what the robot derives contradicts itself.
    #[test]
    fn a_robot_that_recovers_ends_right_after_it_passed_a_junction() {
        let scanner = ScannerParams::named("urg-04lx");
        let sampler = WalkSampler { scanner, ..sampler(BuildingKind::Mixed, 5) };
        let without = sampler.run(2, folding(), &()).unwrap();
        let RobotOutcome::GaveUp(why) = &without.outcome else { panic!("{without:?}") };
        assert!(why.contains("contradicts itself") && without.tally.passed > 0, "{without:?}");
        let recovering = MappingMethod::Recovering(RecoveryConfig::default());
        let with = sampler.run(2, recovering, &()).unwrap();
        assert_eq!(with.outcome, RobotOutcome::Right, "{with:?}");
        assert!(with.recoveries > 0, "{with:?}");
    }
}
