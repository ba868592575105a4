//! Benchmark of whole runs: `cargo bench -p toposlam-simulator --bench runs`.

#![allow(clippy::unwrap_used, reason = "a benchmark may panic")]

use std::sync::Arc;

use divan::Bencher;
use toposlam_logs::record::NoSensor;
use toposlam_model::{
    floor_plan::FloorPlan,
    mapping::MappingAlgorithm::{self, Algorithm1, Folding},
};
use toposlam_robot::{recording::Recording, run_settings::RunSettings};
use toposlam_simulator::{
    BuildingLook, Effects, LOOKS, LearnedSensors, SimulationConfig, plan_named,
    random_plan::random_plan_with,
    run::{RunOutcome, offline, run},
    starts_of,
};
use toposlam_vision::camera::Camera;

fn main() {
    divan::main();
}

fn config(plan: Arc<FloorPlan>) -> SimulationConfig {
    let facing = starts_of(&plan)[0];
    SimulationConfig::at_start(plan, facing, 1)
}

fn settings(algorithm: MappingAlgorithm) -> RunSettings {
    RunSettings::new(algorithm, 1000)
}

/// A whole run without images.
#[divan::bench(consts = [25, 100], args = [Algorithm1, Folding], sample_count = 10)]
fn by_scene<const JUNCTIONS: usize>(bencher: Bencher, algorithm: MappingAlgorithm) {
    let config = config(Arc::new(random_plan_with(1, JUNCTIONS).unwrap()));
    let (plan, settings) = (&config.plan, settings(algorithm));
    bencher.bench(|| {
        let run = run(plan, config.marker, config.by_scene(), NoSensor, (), &settings);
        assert_eq!(run.outcome(), RunOutcome::Right);
    });
}

/// Maps shape 6 by rendered images of 1280 x 960.
fn recorded(sensors: &LearnedSensors, look: &'static BuildingLook, effects: &Effects) -> Recording {
    let config = config(plan_named("shape-6").unwrap());
    let robot = config.with_images(sensors.rig(), look, effects);
    let (sensor, mut recording) = (sensors.sensor(look), Recording::default());
    let (plan, settings) = (&config.plan, settings(Algorithm1));
    let run = run(plan, config.marker, robot, sensor, &mut recording, &settings);
    assert_eq!(run.outcome(), RunOutcome::Right);
    recording
}

fn sensors() -> (LearnedSensors, &'static BuildingLook) {
    let (camera, look) = (Camera::superscout().sized([1280, 960]), &LOOKS[0]);
    (LearnedSensors::new(&camera, &[look], &()).unwrap(), look)
}

#[divan::bench(sample_count = 2)]
fn shape_6_with_images(bencher: Bencher) {
    let (sensors, look) = sensors();
    bencher.bench(|| recorded(&sensors, look, &Effects::plain()));
}

/// The same images off-line: decoding, sensing and the algorithm.
#[divan::bench(sample_count = 10)]
fn shape_6_off_line(bencher: Bencher) {
    let (sensors, look) = sensors();
    let recording = recorded(&sensors, look, &Effects { jpeg_loss: 10.0, ..Effects::plain() });
    let settings = settings(Algorithm1);
    bencher
        .with_inputs(|| sensors.sensor(look))
        .bench_local_values(|sensor| offline(&recording, sensor, (), &settings).unwrap());
}
