//! Whole runs that failed: the log and the world of each, and a line with its seed, its number and the reason.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use toposlam_logs::{messages, world_hash};
use toposlam_model::{
    embedded_graph::Dart,
    floor_plan::FloorPlan,
    format::{named_world::NamedWorld, world_file},
};
use toposlam_terminal::{CliError, json::print_line, output, text::counted};

/// Where runs that gave up or were wrong are written.
#[derive(clap::Args)]
pub(super) struct FailedOption {
    /// Write the runs that gave up or were wrong to this folder: the log and the world of each, and failed.jsonl
    /// with its seed, its number and the reason
    #[arg(long, value_name = "DIR")]
    failed: Option<PathBuf>,
}

/// The folder, and the lines about the runs that are in it.
pub(super) struct FailedRuns<'f> {
    folder: &'f Path,
    lines: Vec<u8>,
    count: usize,
}

/// A run that failed.
pub(super) struct FailedSimulation {
    pub(super) seed: u64,
    pub(super) number: u64,
    pub(super) verdict: &'static str,
    pub(super) reason: String,
    /// The world, and where the robot started in it.
    pub(super) world: NamedWorld,
    pub(super) start: Dart,
    /// The seed of the robot and its building.
    pub(super) robot_seed: u64,
    /// The calibration of the camera and the colours of the building, if there are images.
    pub(super) vision: Option<[String; 2]>,
    /// The command that repeats the run, for the name of a world file.
    pub(super) command: Box<dyn Fn(&str) -> String>,
    /// How the robot maps, as a log records it.
    pub(super) settings: String,
}

impl FailedOption {
    /// Makes the folder, if one is wanted.
    pub(super) fn begin(&self) -> Result<Option<FailedRuns<'_>>, CliError> {
        let Some(folder) = &self.failed else { return Ok(None) };
        output::make_folder(folder)?;
        Ok(Some(FailedRuns { folder, lines: Vec::new(), count: 0 }))
    }
}

impl FailedRuns<'_> {
    /// Writes a run. Its log is made with a head.
    pub(super) fn add(
        &mut self,
        run: &FailedSimulation,
        log: impl FnOnce(messages::Run) -> Result<Vec<u8>, CliError>,
    ) -> Result<(), CliError> {
        let name = format!("run-{:04}", run.number);
        let files = ["toml", "mcap"].map(|kind| format!("{name}.{kind}"));
        let [world_name, log_name] = &files;
        let [world_path, log_path] = files.each_ref().map(|file| self.folder.join(file));
        let command = (run.command)(&world_path.to_string_lossy());
        let [calibration, colours] = run.vision.clone().unwrap_or_default();
        let head = messages::Run {
            stamp: messages::Stamp::default(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            world: run.world.name.clone(),
            world_hash: world_hash(&run.world.graph, run.start),
            start: run.world.start_text(run.start),
            marker: "directional".to_owned(),
            seed: run.robot_seed,
            calibration,
            colours,
            command: command.clone(),
            algorithm: run.settings.clone(),
        };
        output::write_whole(&world_path, world_file::to_toml(&run.world).as_bytes())?;
        output::write_whole(&log_path, &log(head)?)?;
        let line: Value = json!({
            "seed": run.seed, "run": run.number, "verdict": run.verdict, "reason": run.reason,
            "log": log_name, "world": world_name, "command": command,
        });
        self.count += 1;
        print_line(&mut self.lines, "failed", &line)
    }

    /// Writes the lines. Returns what was written, in words.
    pub(super) fn finish(self) -> Result<String, CliError> {
        output::write_whole(&self.folder.join("failed.jsonl"), &self.lines)?;
        Ok(format!("{} in {}", counted(self.count, "failed run"), self.folder.display()))
    }
}

/// A floor plan as a world that starts at a dart.
pub(super) fn plan_world(
    name: &str,
    about: &str,
    plan: &FloorPlan,
    start: Option<Dart>,
) -> NamedWorld {
    let names = plan.junctions().iter().map(|junction| junction.name.clone()).collect();
    let world = NamedWorld::numbered(name, about, plan.graph().clone(), start);
    NamedWorld { vertex_names: names, plan: Some(plan.clone()), ..world }
}
