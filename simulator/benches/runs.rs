//! Benchmark of whole runs: `cargo bench -p toposlam-robot --bench runs`.

#![allow(clippy::unwrap_used, reason = "a benchmark may panic")]

use std::sync::Arc;

use divan::Bencher;
use toposlam_logs::record::NoSensor;
use toposlam_model::{
    embedded_graph::Dart,
    floor_plan::FloorPlan,
    mapping::MappingAlgorithm::{self, Algorithm1, Folding},
};
use toposlam_robot::{recording::Recording, run_settings::RunSettings};
use toposlam_simulator::{
    BuildingLook, Effects, LOOKS, LearnedSensors, SimulationConfig, plans,
    random_plan::random_plan_with,
    run::{Run, RunOutcome, offline, run},
    starts_of,
};
use toposlam_vision::camera::Camera;

const LARGE: [u32; 2] = [1280, 960];
const DARTS: usize = 1000;

fn main() {
    divan::main();
}

/// A random plan with this number of junctions, and a start in it.
fn random(junctions: usize) -> (Arc<FloorPlan>, Dart) {
    let plan = Arc::new(random_plan_with(1, junctions).unwrap());
    let facing = starts_of(&plan)[0];
    (plan, facing)
}

fn shape_6() -> (Arc<FloorPlan>, Dart) {
    let (_, plan) = plans().unwrap().into_iter().find(|(name, _)| name == "shape-6").unwrap();
    let facing = starts_of(&plan)[0];
    (plan, facing)
}

#[track_caller]
fn right(run: &Run) {
    assert_eq!(run.outcome(), RunOutcome::Right);
}

/// A whole run without images.
#[divan::bench(consts = [25, 100], args = [Algorithm1, Folding], sample_count = 10)]
fn by_scene<const JUNCTIONS: usize>(bencher: Bencher, algorithm: MappingAlgorithm) {
    let (plan, facing) = random(JUNCTIONS);
    bencher.bench(|| {
        let robot = SimulationConfig::at_start(plan.clone(), facing, 1).by_scene();
        right(&run(&plan, facing, robot, NoSensor, (), &RunSettings::new(algorithm, DARTS)));
    });
}

/// Shape 6 with rendered images of 1280 x 960.
#[divan::bench(sample_count = 2)]
fn shape_6_with_images(bencher: Bencher) {
    let (plan, facing) = shape_6();
    let (sensors, look) = sensors();
    bencher.bench(|| {
        let robot = SimulationConfig::at_start(plan.clone(), facing, 1).with_images(
            sensors.rig(),
            look,
            &Effects::plain(),
        );
        right(&run(
            &plan,
            facing,
            robot,
            sensors.sensor(look),
            (),
            &RunSettings::new(Algorithm1, DARTS),
        ));
    });
}

/// The same images off-line: decoding, sensing and both algorithms.
#[divan::bench(sample_count = 10)]
fn shape_6_off_line(bencher: Bencher) {
    let (plan, facing) = shape_6();
    let (sensors, look) = sensors();
    let effects = Effects { jpeg_loss: 10.0, ..Effects::plain() };
    let robot = SimulationConfig::at_start(plan.clone(), facing, 1).with_images(
        sensors.rig(),
        look,
        &effects,
    );
    let mut recording = Recording::default();
    right(&run(
        &plan,
        facing,
        robot,
        sensors.sensor(look),
        &mut recording,
        &RunSettings::new(Algorithm1, DARTS),
    ));
    bencher.with_inputs(|| sensors.sensor(look)).bench_local_values(|sensor| {
        offline(&recording, sensor, (), &RunSettings::new(Algorithm1, DARTS)).unwrap()
    });
}

fn sensors() -> (LearnedSensors, &'static BuildingLook) {
    let look = &LOOKS[0];
    (LearnedSensors::new(&Camera::superscout().sized(LARGE), &[look], &()).unwrap(), look)
}
