//! `toposlam completions SHELL`.

use std::io::Write;

use clap::CommandFactory;
use clap_complete::Shell;

use super::{CliError, Outcome, exit_codes::help_end};

/// Print shell completions
#[derive(clap::Args)]
#[command(after_help = help_end(
    "Example:\n  toposlam completions bash > \\\n    ~/.local/share/bash-completion/completions/toposlam",
    &[(0, "the script is printed"), (2, "bad usage")],
))]
pub(super) struct CompletionsArguments {
    /// The shell
    shell: Shell,
}

impl CompletionsArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
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
