//! Recorded runs, mapped again off-line.

use toposlam_logs::{
    messages::Run,
    reader::Log,
    record::NoSensor,
    recorder::Recorder,
    topic_map::{Role, TopicMap},
};
use toposlam_model::mapping::{MapWalk, MappingAlgorithm, MappingError};
use toposlam_robot::{
    replay::{Agreement, ReplayError, replay},
    run_settings::RunSettings,
};
use toposlam_simulator::{SimulationConfig, plans, run::run, starts_of};

fn recorded(seed: u64, algorithm: MappingAlgorithm) -> (Log, MapWalk) {
    recorded_in("shape-6", seed, algorithm)
}

fn recorded_in(world: &str, seed: u64, algorithm: MappingAlgorithm) -> (Log, MapWalk) {
    let (_, plan) = plans().unwrap().into_iter().find(|(name, _)| name == world).unwrap();
    let facing = starts_of(&plan)[0];
    let mut setting = SimulationConfig::at_start(plan.clone(), facing, seed);
    setting.keeps_track = true;
    let mut log = Vec::new();
    let mut recorder = Recorder::new(&mut log, &Run::default(), None).unwrap();
    let robot = setting.by_scene();
    let run = run(&plan, facing, robot, NoSensor, &mut recorder, &RunSettings::new(algorithm, 200));
    recorder.finish().unwrap();
    (Log::of_bytes(log).unwrap(), run.mapping)
}

// paper: exp.off-line
#[test]
fn a_replay_reproduces_the_map_and_all_results() {
    for seed in 0..4 {
        let algorithm =
            [MappingAlgorithm::Algorithm1, MappingAlgorithm::Folding][seed as usize % 2];
        let (log, mapping) = recorded(seed, algorithm);
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
    let [algorithm1, folding] = [MappingAlgorithm::Algorithm1, MappingAlgorithm::Folding];
    let (log, _) = recorded_in("building-12", 0, algorithm1);
    let replay =
        replay(&log, &TopicMap::unambiguous(&log), None, &RunSettings::new(folding, 200)).unwrap();
    assert_eq!(replay.comparison.difference.unwrap().what, "door");
}

#[test]
fn a_map_at_the_dart_bound_is_not_compared_with_the_recorded_one() {
    let (log, _) = recorded(0, MappingAlgorithm::Algorithm1);
    let mapping = TopicMap::unambiguous(&log);
    let replay =
        replay(&log, &mapping, None, &RunSettings::new(MappingAlgorithm::Algorithm1, 4)).unwrap();
    assert!(matches!(replay.error, Some(MappingError::Bound { .. })));
    let to = replay.comparison;
    assert!(!to.doors.is_whole());
    assert_eq!((to.map, to.difference), (None, None));
}

#[test]
fn a_log_without_commands_is_not_replayed() {
    let (log, _) = recorded(0, MappingAlgorithm::Algorithm1);
    let mapping = TopicMap::unambiguous(&log).only(&[Role::Scene, Role::Odometry]);
    let replay = replay(&log, &mapping, None, &RunSettings::new(MappingAlgorithm::Algorithm1, 200));
    assert!(matches!(replay, Err(ReplayError::Nothing)));
}
