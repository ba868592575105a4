//! `toposlam completions SHELL`.

use std::io::Write;

use clap::CommandFactory;
use clap_complete::Shell;

use super::{Failure, Outcome};

/// Print shell completions
#[derive(clap::Args)]
#[command(
    after_help = "Example:\n  toposlam completions bash > \\\n    ~/.local/share/bash-completion/completions/toposlam"
)]
pub(super) struct CompletionsArguments {
    /// The shell
    shell: Shell,
}

impl CompletionsArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, Failure> {
        let mut script = Vec::new();
        clap_complete::generate(
            self.shell,
            &mut super::CommandLine::command(),
            "toposlam",
            &mut script,
        );
        out.write_all(&script)?;
        Ok(Outcome::Holds)
    }
}
