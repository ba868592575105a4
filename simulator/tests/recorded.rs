//! Simulated runs, and their logs.

use toposlam_logs::{messages, recorder::Recorder};
use toposlam_robot::{any_explorer::RobotSensor, run_settings::RunSettings};
use toposlam_simulator::{
    SimulatedRobot, SimulationConfig, plan_named,
    run::{Run, run},
    starts_of,
};

/// A robot at the first start of a floor plan. Its wheel speeds are recorded.
pub(crate) fn in_plan(name: &str, seed: u64) -> SimulationConfig {
    let plan = plan_named(name).unwrap();
    let facing = starts_of(&plan)[0];
    SimulationConfig { keeps_track: true, ..SimulationConfig::at_start(plan, facing, seed) }
}

/// A run, and its log.
pub(crate) fn recorded<'c>(
    config: &'c SimulationConfig,
    robot: SimulatedRobot,
    sensor: RobotSensor,
    settings: &RunSettings,
) -> (Run<'c>, Vec<u8>) {
    let mut log = Vec::new();
    let mut recorder = Recorder::new(&mut log, &messages::Run::default(), None).unwrap();
    let run = run(&config.plan, config.marker, robot, sensor, &mut recorder, settings);
    recorder.finish().unwrap();
    (run, log)
}
