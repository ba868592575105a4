//! Writes the manual page of each command and the completions of each shell into a folder:
//! `cargo run --example manual -- DIR`.

use std::{
    env, fs,
    io::{self, Write},
    path::Path,
    process::ExitCode,
};

use clap::{Command, ValueEnum};
use clap_complete::Shell;
use clap_mangen::Man;

fn main() -> ExitCode {
    let Some(folder) = env::args_os().nth(1) else {
        eprintln!("usage: cargo run --example manual -- DIR");
        return ExitCode::from(2);
    };
    match write(Path::new(&folder)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

/// Writes `man/toposlam.1`, `man/toposlam-check.1`, ..., and `completions/toposlam.bash`, ...
pub(crate) fn write(folder: &Path) -> io::Result<()> {
    let (pages, completions) = (folder.join("man"), folder.join("completions"));
    fs::create_dir_all(&pages)?;
    fs::create_dir_all(&completions)?;
    let mut root = toposlam::command().disable_help_subcommand(true);
    root.build();
    write_pages(&pages, &root)?;
    for shell in Shell::value_variants() {
        let mut script = Vec::new();
        clap_complete::generate(*shell, &mut toposlam::command(), "toposlam", &mut script);
        fs::write(completions.join(format!("toposlam.{shell}")), script)?;
    }
    Ok(())
}

/// Writes the pages of a command and of its subcommands.
fn write_pages(folder: &Path, command: &Command) -> io::Result<()> {
    let name = command.get_display_name().unwrap_or(command.get_name());
    let mut page = Vec::new();
    render(command, &mut page)?;
    fs::write(folder.join(format!("{name}.1")), page)?;
    let parts = command.get_subcommands().filter(|part| part.get_name() != "help");
    parts.into_iter().try_for_each(|command| write_pages(folder, command))
}

fn render(command: &Command, page: &mut Vec<u8>) -> io::Result<()> {
    let man = Man::new(command.clone())
        .source(concat!("toposlam ", env!("CARGO_PKG_VERSION")))
        .manual("toposlam");
    man.render_title(page)?;
    man.render_name_section(page)?;
    man.render_synopsis_section(page)?;
    man.render_description_section(page)?;
    man.render_options_section(page)?;
    if command.has_subcommands() {
        man.render_subcommands_section(page)?;
    }
    let end = command.get_after_help().map(ToString::to_string).unwrap_or_default();
    let (notes, codes) = end.split_once("Exit codes:").unwrap_or((&end, ""));
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
