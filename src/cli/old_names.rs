//! Commands and options that have another name now. An old command works for one release, with a remark that
//! says its new name. The error for an old option says the new one.

use std::ffi::OsString;

use clap::{Arg, ArgAction, Command, builder::UnknownArgumentValueParser};

use super::CliError;

/// The old commands and the new ones. An option of a new one is a default: it may be given.
const COMMANDS: [(&str, &[&str]); 5] = [
    ("merge", &["check", "--add"]),
    ("calibrate", &["camera", "calibrate"]),
    ("train", &["camera", "train"]),
    ("render", &["draw", "--pose=start"]),
    ("replay", &["conform", "--rerun"]),
];

/// The commands that are gone, and what takes their place.
const GONE: [(&str, &str); 4] = [
    (
        "evaluate",
        "it is a program: `cargo run --release -p toposlam-simulator --bin evaluate` in the sources",
    ),
    ("paper", "see docs/paper.md"),
    ("completions", "run `cargo run --example manual -- DIR` in the sources"),
    ("man", "run `cargo run --example manual -- DIR` in the sources"),
];

/// The arguments with the new name of their command.
pub(super) struct RenamedArguments {
    pub(super) arguments: Vec<OsString>,
    /// Says the new name, if there is one.
    pub(super) remark: Option<String>,
}

/// Replaces an old command, the first argument that is not an option.
///
/// # Errors
/// Returns an error if the command is gone.
pub(super) fn with_new_command(mut arguments: Vec<OsString>) -> Result<RenamedArguments, CliError> {
    let is_value = |before: &OsString| before == "--color";
    let at = (1..arguments.len()).find(|&index| {
        !arguments[index].to_string_lossy().starts_with('-') && !is_value(&arguments[index - 1])
    });
    let name = at.and_then(|at| arguments[at].to_str()).unwrap_or_default();
    if let Some((name, instead)) = GONE.iter().find(|(old, _)| *old == name) {
        return Err(CliError::at(*name, format!("this command is gone; {instead}")));
    }
    let renamed = COMMANDS.iter().find(|(old, _)| *old == name);
    let (Some(at), Some((old, new))) = (at, renamed) else {
        return Ok(RenamedArguments { arguments, remark: None });
    };
    let remark = format!("`{old}` is now `{}`", new.join(" "));
    let name_of = |word: &str| word.split('=').next().unwrap_or_default().to_owned();
    let is_given = |word: &&str| {
        arguments.iter().any(|given| given.to_str().map(name_of) == Some(name_of(word)))
    };
    let words: Vec<_> = new.iter().filter(|word| !is_given(word)).map(OsString::from).collect();
    arguments.splice(at..=at, words);
    Ok(RenamedArguments { arguments, remark: Some(remark) })
}

/// An option that was renamed.
struct RenamedOption {
    verb: &'static [&'static str],
    old: &'static str,
    new: &'static str,
    action: ArgAction,
}

const fn renamed(
    verb: &'static [&'static str],
    old: &'static str,
    new: &'static str,
) -> RenamedOption {
    RenamedOption { verb, old, new, action: ArgAction::Set }
}

const OPTIONS: [RenamedOption; 6] = [
    renamed(&["check"], "max-edges", "--edges 1..=N"),
    renamed(&["counterexample"], "edges", "--max-edges"),
    renamed(&["counterexample"], "out", "--out-dir"),
    renamed(&["conform"], "edges", "--max-edges"),
    renamed(&["camera", "calibrate"], "start", "--initial"),
    renamed(&["simulate"], "picture-time", "--image-time"),
];

/// The command line with the old names.
pub(super) fn with_old_options(command: Command) -> Command {
    OPTIONS.iter().fold(command, |command, renamed| add(command, renamed, renamed.verb))
}

fn add(command: Command, renamed: &RenamedOption, verb: &[&str]) -> Command {
    let Some((first, rest)) = verb.split_first() else {
        let error = UnknownArgumentValueParser::suggest_arg(renamed.new);
        let old = Arg::new(renamed.old).long(renamed.old).hide(true);
        return command
            .arg(old.value_name("VALUE").action(renamed.action.clone()).value_parser(error));
    };
    command.mut_subcommand(first, |command| add(command, renamed, rest))
}
