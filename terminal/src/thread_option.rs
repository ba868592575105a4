//! The option `--threads`.

use clap::value_parser;
use toposlam_model::enumerate::{MOST_THREADS, threads};

use super::CliError;

/// The number of threads of a command. The result is the same for any number.
#[derive(clap::Args, Clone, Copy, Debug, Default)]
pub struct ThreadOption {
    #[arg(
        long,
        value_name = "N",
        value_parser = value_parser!(u16).range(1..=i64::from(MOST_THREADS)),
        help = format!("Number of threads, up to {MOST_THREADS} [default: all processors]"),
    )]
    threads: Option<u16>,
}

impl ThreadOption {
    /// Sets the number of threads, if one is given, here or by `RAYON_NUM_THREADS`.
    pub fn apply(self) -> Result<(), CliError> {
        if self.threads.is_none() && std::env::var_os("RAYON_NUM_THREADS").is_none() {
            return Ok(());
        }
        let threads = self.threads.map_or_else(threads, usize::from);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build_global().map_err(|error| CliError::at("--threads", error))
    }
}
