//! `toposlam man [COMMAND]`: manual pages.

use std::{
    io::{self, Write},
    path::{Path, PathBuf},
};

use clap::{Command, CommandFactory};
use clap_mangen::Man;

use super::{
    CliError, Outcome,
    exit_codes::{self, help_end},
    output,
    version::VERSION,
};

/// Print a manual page, or write the pages of all commands
#[derive(clap::Args)]
#[command(after_help = help_end(
    "\
Examples:
  toposlam man check | man -l -
  toposlam man evaluate vision
  toposlam man --out-dir ~/.local/share/man/man1",
    &[(0, "the pages are printed or written"), (2, "bad usage")],
))]
pub(super) struct ManArguments {
    /// The command, such as check or evaluate vision [default: toposlam itself]
    #[arg(value_name = "COMMAND", num_args = 0..=2, conflicts_with = "out_dir")]
    command: Vec<String>,
    /// Folder to which all pages are written, as toposlam.1, toposlam-check.1, ...
    #[arg(short, long, value_name = "DIR")]
    out_dir: Option<PathBuf>,
}

impl ManArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        let mut root = super::CommandLine::command().disable_help_subcommand(true);
        root.build();
        if let Some(folder) = &self.out_dir {
            output::make_folder(folder)?;
            write_pages(folder, &root)?;
            return Ok(Outcome::Holds);
        }
        let mut command = &root;
        for name in &self.command {
            command = command.find_subcommand(name).ok_or_else(|| {
                let known: Vec<_> = parts(command).map(Command::get_name).collect();
                let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
                let cause = format!("there is no command `{name}`; there are: {known}");
                CliError::at(page_name(command), cause)
            })?;
        }
        out.write_all(&page(command)?)?;
        Ok(Outcome::Holds)
    }
}

/// Writes the pages of a command and of its subcommands.
fn write_pages(folder: &Path, command: &Command) -> Result<(), CliError> {
    output::write_whole(&folder.join(format!("{}.1", page_name(command))), &page(command)?)?;
    parts(command).try_for_each(|command| write_pages(folder, command))
}

/// The commands of a command, without `help`.
fn parts(command: &Command) -> impl Iterator<Item = &Command> {
    command.get_subcommands().filter(|part| part.get_name() != "help")
}

/// The name of a page, such as `toposlam-check`.
fn page_name(command: &Command) -> &str {
    command.get_display_name().unwrap_or(command.get_name())
}

/// A page in the language of `man`.
fn page(command: &Command) -> Result<Vec<u8>, CliError> {
    let mut page = Vec::new();
    render(command, &mut page).map_err(|error| CliError::at(page_name(command), error))?;
    Ok(page)
}

fn render(command: &Command, page: &mut Vec<u8>) -> io::Result<()> {
    let man = Man::new(command.clone()).source(format!("toposlam {VERSION}")).manual("toposlam");
    man.render_title(page)?;
    man.render_name_section(page)?;
    man.render_synopsis_section(page)?;
    man.render_description_section(page)?;
    man.render_options_section(page)?;
    if command.has_subcommands() {
        man.render_subcommands_section(page)?;
    }
    let end = command.get_after_help().map(ToString::to_string).unwrap_or_default();
    let (notes, codes) = end.split_once(exit_codes::TITLE).unwrap_or((&end, ""));
    for (title, text) in [("NOTES", notes), ("\"EXIT STATUS\"", codes)] {
        writeln!(page, ".SH {title}\n.nf\n{}\n.fi", verbatim(text.trim_matches('\n')))?;
    }
    Ok(())
}

/// A text that `man` shows as it is.
fn verbatim(text: &str) -> String {
    let text = text.replace('\\', "\\e").replace('-', "\\-");
    let lines = text.lines().map(|line| match line.chars().next() {
        Some('.' | '\'') => format!("\\&{line}"),
        _ => line.to_owned(),
    });
    lines.collect::<Vec<_>>().join("\n")
}
