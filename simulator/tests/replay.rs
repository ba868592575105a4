//! Recorded runs, mapped again off-line.

use toposlam_logs::{
    reader::Log,
    topic_map::{Role, TopicMap},
};
use toposlam_model::mapping::{
    MapWalk,
    MappingAlgorithm::{self, Algorithm1, Folding},
    MappingError,
};
use toposlam_robot::{
    any_explorer::RobotSensor,
    replay::{Agreement, ReplayError, replay},
    run_settings::RunSettings,
};

use crate::recorded::{in_plan, recorded};

fn logged(world: &str, seed: u64, algorithm: MappingAlgorithm) -> (Log, MapWalk) {
    let config = in_plan(world, seed);
    let settings = RunSettings::new(algorithm, 200);
    let (run, log) = recorded(&config, config.by_scene(), RobotSensor::Scenes, &settings);
    (Log::of_bytes(log).unwrap(), run.mapping)
}

// paper: exp.off-line
#[test]
fn a_replay_reproduces_the_map_and_all_results() {
    for (seed, algorithm) in (0..).zip([Algorithm1, Folding, Algorithm1, Folding]) {
        let (log, mapping) = logged("shape-6", seed, algorithm);
        let topics = TopicMap::unambiguous(&log);
        let replay = replay(&log, &topics, None, &RunSettings::new(algorithm, 200)).unwrap();
        let to = replay.comparison;
        assert_eq!((replay.error, to.difference), (None, None));
        assert_eq!(replay.mapping.map(), mapping.map());
        assert_eq!(to.map, Some(true));
        let moves = mapping.moves();
        assert_eq!(to.doors, Agreement { agree: moves, of: moves });
        assert_eq!(to.percepts, Agreement { agree: moves + 1, of: moves + 1 });
        assert!(to.commands.is_whole() && to.commands.of > 20, "{:?}", to.commands);
    }
}

#[test]
fn another_algorithm_than_the_recorded_one_takes_another_door() {
    let (log, _) = logged("building-12", 0, Algorithm1);
    let topics = TopicMap::unambiguous(&log);
    let replay = replay(&log, &topics, None, &RunSettings::new(Folding, 200)).unwrap();
    assert_eq!(replay.comparison.difference.unwrap().what, "door");
}

#[test]
fn a_map_at_the_dart_bound_is_not_compared_with_the_recorded_one_nor_is_a_log_without_commands() {
    let (log, _) = logged("shape-6", 0, Algorithm1);
    let topics = TopicMap::unambiguous(&log);
    let bounded = replay(&log, &topics, None, &RunSettings::new(Algorithm1, 4)).unwrap();
    assert!(matches!(bounded.error, Some(MappingError::Bound { .. })));
    let to = bounded.comparison;
    assert!(!to.doors.is_whole());
    assert_eq!((to.map, to.difference), (None, None));
    let topics = topics.only(&[Role::Scene, Role::Odometry]);
    let without = replay(&log, &topics, None, &RunSettings::new(Algorithm1, 200));
    assert!(matches!(without, Err(ReplayError::Nothing)));
}
