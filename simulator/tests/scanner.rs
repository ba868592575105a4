//! A simulated robot with a laser scanner: what it measures, how it drives by it, and its logs.

use std::{fs, path::Path, sync::Arc};

use toposlam_conform::{Evidence, ExtractConfig, extract};
use toposlam_logs::{reader::Log, topic_map::TopicMap};
use toposlam_model::{
    embedded_graph::Dart, floor_plan::FloorPlan, format::world_file, mapping::MappingAlgorithm,
};
use toposlam_robot::{
    any_explorer::RobotSensor,
    recording::Recording,
    run_settings::{LaserVertices, RunSettings},
};
use toposlam_simulator::{
    NamedPlan, RobotEquipment, ScannerParams, SimulatedRobot, SimulationConfig,
    evaluation::{run_sampler::RunSampler, sampling::sample, traversals::TraversalSampler},
    plans,
    random_plan::random_plan,
    run::{RunOutcome, offline, run},
    sample_verdict::SampleVerdict,
};

use crate::{laser, recorded::recorded};

/// How a robot in hallways senses.
fn by_laser() -> RobotSensor {
    LaserVertices::OF_HALLWAYS.params().into()
}

/// The verdicts on traversals by laser in these plans.
fn traversals(plans: Vec<NamedPlan>, seed: u64, params: ScannerParams) -> Vec<SampleVerdict> {
    let traversals = TraversalSampler::new(plans, seed, 1.0);
    let equipment = RobotEquipment::Laser(params);
    let judged = sample(0..150, &(), |number| traversals.traversal(number, &equipment, &()));
    judged.iter().map(|made| made.outcome.verdict()).collect()
}

/// The plans of `worlds/` and random ones.
fn with_random(count: u64) -> Vec<NamedPlan> {
    let random = (0..count).map(|seed| (format!("{seed}"), Arc::new(random_plan(seed).unwrap())));
    plans().unwrap().into_iter().chain(random).collect()
}

#[test]
fn doors_are_taken_by_laser_as_the_specification_says() {
    let verdicts = traversals(with_random(6), 5, ScannerParams::PLAIN);
    assert_eq!(verdicts, [SampleVerdict::Right; 150]);
}

#[test]
fn among_furniture_doors_and_people_a_robot_gives_up_when_it_fails() {
    let verdicts = traversals(plans().unwrap(), 6, ScannerParams::default());
    let count = |is| verdicts.iter().filter(|&&verdict| verdict == is).count();
    assert_eq!(count(SampleVerdict::Wrong), 0);
    assert!(count(SampleVerdict::Undecided) <= 15, "{} of 150", count(SampleVerdict::Undecided));
}

#[test]
#[ignore = "a long sweep, for `.ci/run --all`"]
fn buildings_are_mapped_by_laser_also_if_the_scanner_does_not_see_all_round() {
    let [algorithm1, folding] = [MappingAlgorithm::Algorithm1, MappingAlgorithm::Folding];
    for (plans, seed, algorithm, field_of_view) in [
        (plans().unwrap(), 3, algorithm1, 360.0),
        (plans().unwrap(), 3, folding, 360.0),
        (with_random(3), 1, folding, 180.0),
        (with_random(3), 1, folding, 240.0),
        (with_random(3), 1, folding, 270.0),
    ] {
        let equipment =
            RobotEquipment::Laser(ScannerParams { field_of_view, ..ScannerParams::PLAIN });
        let count = plans.len() as u64;
        let runs = RunSampler::new(plans, 1, 0, seed, 1.0, algorithm);
        for run in sample(0..count, &(), |number| runs.run(number, &equipment, &())) {
            let what = format!("{} with {field_of_view} degrees", run.case.plan_name);
            assert_eq!(run.ending, RunOutcome::Right, "{what}");
            assert_eq!(run.moves[0], run.moves[1], "{what}");
        }
    }
}

#[test]
fn a_run_by_laser_is_repeated_from_its_recording() {
    let plan = long_8();
    let params = ScannerParams { field_of_view: 180.0, ..ScannerParams::PLAIN };
    let robot = SimulationConfig::at_start(plan.clone(), Dart(0), 3).by_laser(&params);
    let sensor = by_laser();
    let settings = RunSettings::new(MappingAlgorithm::Folding, 200);
    let mut recording = Recording::default();
    let run = run(&plan, Dart(0), robot, sensor.clone(), &mut recording, &settings);
    assert_eq!(run.outcome(), RunOutcome::Right);
    assert_eq!(recording.frames.len() as u64, run.frames);
    let mut repeated = Recording::default();
    let again = offline(&recording, sensor, &mut repeated, &settings).unwrap();
    assert_eq!(again.map(), run.mapping.map());
    assert_eq!(again.moves(), run.mapping.moves());
    assert_eq!(repeated.frames.len(), recording.frames.len(), "other frames");
}

/// A floor plan whose hallways are long enough for arms: shape 8, 16 m a hallway.
fn long_8() -> Arc<FloorPlan> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../worlds/laser/long-8.toml");
    Arc::new(world_file::read(&fs::read(file).unwrap()).unwrap().plan.unwrap())
}

/// The log of a run through the plan.
fn logged(robot: impl Fn(&SimulationConfig) -> SimulatedRobot, sensor: RobotSensor) -> Log {
    let mut config = SimulationConfig::at_start(long_8(), Dart(0), 2);
    // The heading drifts by up to about 1.5 degrees in 10 m.
    (config.keeps_track, config.noise) = (true, 0.1);
    let settings = RunSettings::new(MappingAlgorithm::Algorithm1, 200);
    let (run, log) = recorded(&config, robot(&config), sensor, &settings);
    assert_eq!(run.outcome(), RunOutcome::Right);
    Log::of_bytes(log).unwrap()
}

/// The degree of each junction with at least three doors, and the door taken.
fn visits_in(log: &Log, evidence: Evidence) -> Vec<(u32, Option<u32>)> {
    let mapping = TopicMap::from_log(log).unwrap();
    let config = ExtractConfig { marked: true, ..ExtractConfig::new(evidence) };
    let run = extract(log, &mapping, &config, &()).unwrap();
    assert!(run.scans > 0 || evidence != Evidence::Laser);
    let visits = laser::visits(&run.events).into_iter();
    visits
        .filter_map(|(degree, door)| Some((degree.filter(|&degree| degree >= 3)?, door)))
        .collect()
}

/// Checks that the evidence in a log shows the visits that the log records.
fn shows(log: &Log, evidence: &[Evidence]) {
    let recorded = visits_in(log, Evidence::Recorded);
    assert!(recorded.len() >= 4, "{recorded:?}");
    for &evidence in evidence {
        assert_eq!(visits_in(log, evidence), recorded, "{evidence:?}");
    }
}

#[test]
fn the_scans_of_a_run_show_the_visits_that_it_records() {
    // Among furniture and people some visits are missed: `evaluate laser` measures how many.
    let sensor = by_laser();
    let robot = |config: &SimulationConfig| config.by_laser(&ScannerParams::PLAIN);
    shows(&logged(robot, sensor), &[Evidence::Laser]);
    let params = ScannerParams::default();
    let robot = |config: &SimulationConfig| config.by_scene().with_scanner(config.scanner(&params));
    let both = [Evidence::Scenes, Evidence::Laser];
    shows(&logged(robot, RobotSensor::Scenes), &both);
}

#[test]
#[ignore = "a long sweep, for `.ci/run --all`"]
fn the_scans_of_half_a_circle_show_the_visits_that_a_run_records() {
    let params = ScannerParams { field_of_view: 180.0, ..ScannerParams::PLAIN };
    let robot = |config: &SimulationConfig| config.by_laser(&params);
    let log = logged(robot, by_laser());
    shows(&log, &[Evidence::Laser]);
}
