//! Options that have another name now, or in another command. The error for the one names the other.

use clap::{Arg, ArgAction, Command, builder::UnknownArgumentValueParser};

/// An option that was renamed.
struct Renamed {
    verb: &'static [&'static str],
    old: &'static str,
    new: &'static str,
    action: ArgAction,
}

const fn renamed(verb: &'static [&'static str], old: &'static str, new: &'static str) -> Renamed {
    Renamed { verb, old, new, action: ArgAction::Set }
}

const RENAMED: [Renamed; 9] = [
    renamed(&["check"], "max-edges", "--edges 1..=N"),
    renamed(&["evaluate", "mistakes"], "max-edges", "--edges 1..=N"),
    renamed(&["counterexample"], "edges", "--max-edges"),
    renamed(&["counterexample"], "out", "--out-dir"),
    renamed(&["conform"], "edges", "--max-edges"),
    renamed(&["calibrate"], "start", "--initial"),
    Renamed { action: ArgAction::SetTrue, ..renamed(&["render"], "marker", "--with-marker") },
    renamed(&["evaluate", "vision"], "out", "--out-dir"),
    renamed(&["simulate"], "picture-time", "--image-time"),
];

/// The command line with the old names.
pub(super) fn with_old_names(command: Command) -> Command {
    RENAMED.iter().fold(command, |command, renamed| add(command, renamed, renamed.verb))
}

fn add(command: Command, renamed: &Renamed, verb: &[&str]) -> Command {
    let Some((first, rest)) = verb.split_first() else {
        let error = UnknownArgumentValueParser::suggest_arg(renamed.new);
        let old = Arg::new(renamed.old).long(renamed.old).hide(true);
        return command
            .arg(old.value_name("VALUE").action(renamed.action.clone()).value_parser(error));
    };
    command.mut_subcommand(first, |command| add(command, renamed, rest))
}
