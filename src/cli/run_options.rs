//! The options of a robot's run, simulated or live, and its files.

use std::path::PathBuf;

use clap::{ArgMatches, Command, FromArgMatches, Id, ValueEnum, parser::ValueSource};
use toposlam_logs::{messages, recorder::Recorder, world_hash, writer::LogWriteError};
use toposlam_model::{
    embedded_graph::Dart,
    format::named_world::NamedWorld,
    mapping::{FACING, MappingMethod, RecoveryConfig},
    proof::{Proof, WalkRecorder},
};
use toposlam_robot::{
    budget::{BudgetLimit, RunBudget},
    run_settings::{DEFAULT_MAX_DARTS, RunSettings},
};
use toposlam_vision::{
    camera::{Camera, calibration},
    colour::ColourModel,
};

use super::{
    CliError, earlier_logs::earlier_walks_of, method_options::MethodOptions, output, text::quoted,
    verdict_proof::ProofOption, version,
};

/// How a robot maps, what it may spend, from where it goes on, and what is written.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct RunOptions {
    #[command(flatten)]
    method: MethodOptions,
    /// With --recover: what blocked doors mean (repeatable)
    #[arg(long, value_enum, value_name = "WHAT", value_delimiter = ',', requires = "recover")]
    blocked: Vec<BlockedDoors>,
    /// Return to the marker before this is over: moves, minutes of the robot's clock, or metres as far as the
    /// battery lasts, as in 25moves, 20min or 1000m; or stop if the map has more darts, as in 400darts
    /// (repeatable) [default: 1000darts]
    #[arg(long, value_name = "LIMIT", allow_hyphen_values = true, value_parser = limit)]
    budget: Vec<RunLimit>,
    /// With --recover: go on from the log of an earlier run, .mcap, wherever the robot stands (repeatable)
    #[arg(long, value_name = "LOG", requires = "recover")]
    resume: Vec<PathBuf>,
    /// Write a log of the run, .mcap
    #[arg(long, value_name = "FILE")]
    pub(super) log: Option<PathBuf>,
    /// Write the map: .toml, .json, .dot, or plantri's .ec; of a floor plan also .pc
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    #[command(flatten)]
    proof: ProofOption,
    /// Print one JSON object
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum BlockedDoors {
    /// They are tried once more at the end
    Retry,
    /// A map that is complete but for them is enough for exit code 0
    Allow,
}

#[derive(Clone, Copy, Debug)]
enum RunLimit {
    Budget(BudgetLimit),
    Darts(usize),
}

/// Parses a limit of a run: a number and its unit.
fn limit(text: &str) -> Result<RunLimit, String> {
    let unit = text.trim_start_matches(|letter: char| "0123456789.".contains(letter));
    let number = text.strip_suffix(unit).unwrap_or_default();
    let real = || number.parse().ok().filter(|number: &f64| *number > 0.0 && number.is_finite());
    let limit = match unit {
        "moves" => number.parse().ok().filter(|&moves| moves > 0).map(BudgetLimit::Moves),
        "min" => real().map(|minutes| BudgetLimit::Time(60.0 * minutes)),
        "m" => real().map(BudgetLimit::Way),
        "darts" => return number.parse().map(RunLimit::Darts).map_err(|error| error.to_string()),
        _ => None,
    };
    let limit = limit.map(RunLimit::Budget);
    limit.ok_or_else(|| "write a number above 0 with its unit: moves, min, m or darts".to_owned())
}

impl RunOptions {
    /// Whether a map that is complete but for blocked doors is enough.
    pub(super) fn allows_blocked(&self) -> bool {
        self.blocked.contains(&BlockedDoors::Allow)
    }

    /// What the robot does. If the world is known, the earlier logs must be of it.
    ///
    /// # Errors
    /// Returns an error if Algorithm 1 is to recover, or if the robot cannot go on from an earlier log.
    pub(super) fn settings(&self, world_hash: Option<&str>) -> Result<RunSettings, CliError> {
        let method = match self.method.method()? {
            MappingMethod::Recovering(config) => MappingMethod::Recovering(RecoveryConfig {
                retries_blocked: self.blocked.contains(&BlockedDoors::Retry),
                ..config
            }),
            method @ MappingMethod::By { .. } => method,
        };
        let (mut budget, mut max_darts) = (RunBudget::default(), DEFAULT_MAX_DARTS);
        for limit in &self.budget {
            match *limit {
                RunLimit::Budget(BudgetLimit::Moves(moves)) => budget.moves = Some(moves),
                RunLimit::Budget(BudgetLimit::Time(seconds)) => budget.seconds = Some(seconds),
                RunLimit::Budget(BudgetLimit::Way(metres)) => budget.metres = Some(metres),
                RunLimit::Darts(darts) => max_darts = darts,
            }
        }
        let earlier = earlier_walks_of(&self.resume, world_hash)?;
        Ok(RunSettings { budget, earlier, ..RunSettings::new(method, max_darts) })
    }

    /// Checks the places of the log and the map, before long work begins.
    pub(super) fn check_places(&self, is_simple: bool) -> Result<(), CliError> {
        output::check_place(&self.log, &["mcap"])?;
        self.proof.check_place()?;
        output::check_world_place(&self.map, is_simple)
    }

    /// Opens the log, if one is wanted. Its head has the world, the camera and the colours, if they are known.
    pub(super) fn recorder(
        &self,
        command: String,
        settings: &RunSettings,
        world: Option<(&NamedWorld, Dart)>,
        seed: u64,
        sensors: Option<&(Camera, ColourModel)>,
    ) -> Result<Option<Recorder<output::GrowingFile>>, CliError> {
        let Some(path) = &self.log else { return Ok(None) };
        let known = world.map(|(world, facing)| {
            let hash = world_hash(&world.graph, facing);
            (world.name.clone(), hash, world.start_text(facing))
        });
        let (world, world_hash, start) = known.unwrap_or_default();
        let run = messages::Run {
            stamp: messages::Stamp::default(),
            version: version::version().to_owned(),
            world,
            world_hash,
            start,
            marker: settings.method.algorithm().aid().name().to_owned(),
            seed,
            calibration: sensors
                .map(|(camera, _)| calibration::to_toml(camera))
                .unwrap_or_default(),
            colours: sensors.map(|(_, colours)| colours.to_toml()).unwrap_or_default(),
            command,
            algorithm: settings.recorded().to_string(),
        };
        let camera = sensors.map(|(camera, _)| camera.clone());
        let recorder = Recorder::new(output::create_growing(path)?, &run, camera);
        recorder.map(Some).map_err(|error| self.unwritten(&error))
    }

    /// Closes the log, which then replaces an earlier one.
    pub(super) fn close(&self, log: Option<Recorder<output::GrowingFile>>) -> Result<(), CliError> {
        let Some(log) = log else { return Ok(()) };
        log.finish().map_err(|error| self.unwritten(&error))?.complete()
    }

    /// The failure if the log cannot be written.
    fn unwritten(&self, error: &LogWriteError) -> CliError {
        let path = self.log.clone().unwrap_or_default();
        let partial = output::partial_path(&path);
        let kept = if partial.is_file() {
            format!("; the earlier log is kept, and what was written is {}", partial.display())
        } else {
            String::new()
        };
        CliError::in_file(&path, format!("cannot be written: {error}{kept}"))
    }

    /// Writes the map, if it is wanted and complete, and the proof that the robot's walk determines it.
    pub(super) fn write_map(
        &self,
        map: Option<&NamedWorld>,
        walk: &WalkRecorder,
    ) -> Result<(), CliError> {
        match (&self.map, map) {
            (Some(path), Some(map)) => output::write_world(path, map)?,
            (Some(_), None) => remark!("the map is not written: the run ended early"),
            (None, _) => {}
        }
        let Some(map) = map else {
            self.proof.remark(&"the run ended early");
            return Ok(());
        };
        self.proof.write(|| Ok(vec![Proof::of_map(&map.graph, FACING, walk.walk()?)?]))
    }
}

/// The options on the command line and their values, by name. It must be the first field of its arguments: the
/// others take theirs out of the matches.
#[derive(Clone, Debug)]
pub(super) struct GivenOptions(Vec<(String, Vec<String>)>);

/// The options that change no run.
const OUTPUTS: [&str; 7] = ["html", "json", "log", "map", "proof", "quiet", "svg"];
/// The options that are repeated although they are not given: their defaults may change.
const WITH_DEFAULTS: [&str; 2] = ["algorithm", "seed"];

impl GivenOptions {
    pub(super) fn has(&self, option: &str) -> bool {
        self.0.iter().any(|(name, _)| name == option)
    }

    /// The command that repeats the run, without the options for its outputs.
    pub(super) fn command(&self, head: &[&str]) -> String {
        let mut words: Vec<String> = head.iter().map(|word| (*word).to_owned()).collect();
        for (name, values) in self.0.iter().filter(|(name, _)| !OUTPUTS.contains(&&**name)) {
            match &**name {
                _ if values.is_empty() => words.push(format!("--{name}")),
                "audit" => words.extend(values.iter().map(|value| format!("--{name}={value}"))),
                _ => words
                    .extend(values.iter().flat_map(|value| [format!("--{name}"), value.clone()])),
            }
        }
        words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ")
    }
}

impl FromArgMatches for GivenOptions {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        // The names of positional arguments and of groups begin with a capital.
        let is_option = |id: &&Id| !id.as_str().starts_with(char::is_uppercase);
        let is_on_line = |id: &str| matches.value_source(id) == Some(ValueSource::CommandLine);
        // The algorithm follows from the aid.
        let has_aid = matches.ids().any(|id| id == "aid") && is_on_line("aid");
        let is_given = |id: &&Id| {
            let has_default = WITH_DEFAULTS.contains(&id.as_str());
            is_on_line(id.as_str()) || has_default && !(has_aid && *id == "algorithm")
        };
        let option = |id: &Id| {
            let is_flag = matches.try_get_one::<bool>(id.as_str()).is_ok();
            let values = matches.get_raw(id.as_str()).into_iter().flatten();
            let values = values.filter(|_| !is_flag).map(|value| value.to_string_lossy());
            (id.as_str().replace('_', "-"), values.map(Into::into).collect())
        };
        let mut options: Vec<_> =
            matches.ids().filter(is_option).filter(is_given).map(option).collect();
        options.sort();
        Ok(Self(options))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl clap::Args for GivenOptions {
    fn augment_args(command: Command) -> Command {
        command
    }

    fn augment_args_for_update(command: Command) -> Command {
        command
    }
}
