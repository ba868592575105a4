//! The options of a robot's run: how it maps, what it may spend, and from where it goes on.

use std::path::PathBuf;

use toposlam_model::mapping::{MappingMethod, RecoveryConfig};
use toposlam_robot::run_settings::{DEFAULT_MAX_DARTS, RunSettings};

use super::{
    CliError,
    budget_options::BudgetOptions,
    earlier_logs::earlier_walks_of,
    method_options::{MethodOptions, words_of},
};

/// How a robot maps, what it may spend, and from where it goes on.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct RunOptions {
    #[command(flatten)]
    method: MethodOptions,
    /// With --recover: try the blocked doors once more at the end
    #[arg(long, requires = "recover")]
    retry_blocked: bool,
    /// With --recover: a map that is complete but for blocked doors is enough for exit code 0
    #[arg(long, requires = "recover")]
    allow_blocked: bool,
    #[command(flatten)]
    budget: BudgetOptions,
    /// With --recover: go on from the log of an earlier run, .mcap, wherever the robot stands (repeatable)
    #[arg(long, value_name = "LOG", requires = "recover")]
    resume: Vec<PathBuf>,
    /// Stop if the map has more darts
    #[arg(long, value_name = "N", default_value_t = DEFAULT_MAX_DARTS)]
    max_darts: usize,
}

impl RunOptions {
    /// How the robot maps.
    ///
    /// # Errors
    /// Returns an error if Algorithm 1 is to recover.
    pub(super) fn method(&self) -> Result<MappingMethod, CliError> {
        Ok(match self.method.method()? {
            MappingMethod::Recovering(config) => MappingMethod::Recovering(RecoveryConfig {
                retries_blocked: self.retry_blocked,
                ..config
            }),
            method @ MappingMethod::By { .. } => method,
        })
    }

    /// All settings. If the world is known, the earlier logs must be of it.
    ///
    /// # Errors
    /// Returns an error if Algorithm 1 is to recover, or if the robot cannot go on from an earlier log.
    pub(super) fn settings(&self, world_hash: Option<&str>) -> Result<RunSettings, CliError> {
        Ok(RunSettings {
            budget: self.budget.budget(),
            earlier: earlier_walks_of(&self.resume, world_hash)?,
            ..RunSettings::new(self.method()?, self.max_darts)
        })
    }

    /// Whether a map may lack what is behind blocked doors.
    pub(super) fn allows_blocked(&self) -> bool {
        self.allow_blocked
    }

    /// The options that give the same settings again. They do not say whether blocked doors are allowed, which
    /// changes no run.
    ///
    /// # Errors
    /// Returns an error if Algorithm 1 is to recover.
    pub(super) fn words(&self) -> Result<Vec<String>, CliError> {
        let mut words = words_of(self.method()?);
        words.extend(self.budget.words());
        for log in &self.resume {
            words.extend(["--resume".to_owned(), log.display().to_string()]);
        }
        if self.max_darts != DEFAULT_MAX_DARTS {
            words.extend(["--max-darts".to_owned(), self.max_darts.to_string()]);
        }
        Ok(words)
    }
}
