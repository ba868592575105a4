//! Commands and options that have another name now. An old command works for one release, with a remark that
//! says its new name. The error for an old option says the new one.

use std::ffi::OsString;

use clap::{Arg, Command, builder::UnknownArgumentValueParser};

use super::CliError;

/// The old commands and the new ones. An option of a new one is a default: it may be given.
const COMMANDS: [(&str, &[&str]); 5] = [
    ("merge", &["check", "--add"]),
    ("calibrate", &["camera", "calibrate"]),
    ("train", &["camera", "train"]),
    ("render", &["draw", "--pose=start"]),
    ("replay", &["conform", "--rerun"]),
];

/// The old options and the new ones, which take the same values.
const RENAMED: [(&str, &str); 4] = [
    ("--mapping", "--topics"),
    ("--write-mapping", "--write-topics"),
    ("--junit", "--report"),
    ("--sarif", "--report"),
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
    /// Each says a new name.
    pub(super) remarks: Vec<String>,
}

/// Replaces old options, and an old command, the first argument that is not an option.
///
/// # Errors
/// Returns an error if the command is gone.
pub(super) fn with_new_names(mut arguments: Vec<OsString>) -> Result<RenamedArguments, CliError> {
    let mut remarks = Vec::new();
    for argument in &mut arguments {
        let text = argument.to_string_lossy();
        let (name, value) = text.split_at(text.find('=').unwrap_or(text.len()));
        if let Some((old, new)) = RENAMED.iter().find(|(old, _)| *old == name) {
            remarks.push(format!("`{old}` is now `{new}`"));
            *argument = format!("{new}{value}").into();
        }
    }
    let at =
        (1..arguments.len()).find(|&index| !arguments[index].to_string_lossy().starts_with('-'));
    let name = at.and_then(|at| arguments[at].to_str()).unwrap_or_default();
    if let Some((name, instead)) = GONE.iter().find(|(old, _)| *old == name) {
        return Err(CliError::at(*name, format!("this command is gone; {instead}")));
    }
    let renamed = COMMANDS.iter().find(|(old, _)| *old == name);
    if let (Some(at), Some((old, new))) = (at, renamed) {
        remarks.push(format!("`{old}` is now `{}`", new.join(" ")));
        let name_of = |word: &str| word.split('=').next().unwrap_or_default().to_owned();
        let is_given = |word: &str| {
            let is_same = |given: &OsString| given.to_str().map(name_of) == Some(name_of(word));
            word.starts_with('-') && arguments.iter().any(is_same)
        };
        let words: Vec<_> = new.iter().filter(|word| !is_given(word)).map(OsString::from).collect();
        arguments.splice(at..=at, words);
    }
    Ok(RenamedArguments { arguments, remarks })
}

/// The options that have another name, or none: the command, the old name, and what to write.
const OPTIONS: [(&[&str], &str, &str); 50] = [
    (&[], "color", "the variables NO_COLOR and CLICOLOR_FORCE decide on colours"),
    (&["check"], "max-states", "--choices all=N"),
    (&["check"], "probes", "--estimate=N"),
    (&["check"], "timeout", "--limit Ns"),
    (&["check"], "max-moves", "--limit Nmoves"),
    (&["check"], "restarts", "--limit Nrestarts"),
    (&["explore"], "max-states", "--choices all=N"),
    (&["explore"], "summary", "--story=summary"),
    (&["explore"], "svg", "--map FILE.svg"),
    (&["explore"], "full", "the story has the first candidates of each round"),
    (&["explore"], "doors", "--json"),
    (&["draw"], "format", "--out"),
    (&["draw"], "with-marker", "--marker directional"),
    (&["play"], "random", "without a world file, the world is random"),
    (&["proofs"], "engine", "`--choices` alone finds the engine"),
    (&["sense"], "out", "redirect standard output"),
    (&["camera", "train"], "stripe-width", "--stripe floor=METRES"),
    (&["draw"], "effects", "--effect none"),
    (&["simulate"], "effects", "--effect none"),
    (&["sense"], "corners", "`corners = true` below `[corner]` in the file of --laser-params"),
    (&["simulate"], "retry-blocked", "--blocked retry"),
    (&["simulate"], "allow-blocked", "--blocked allow"),
    (&["drive"], "retry-blocked", "--blocked retry"),
    (&["drive"], "allow-blocked", "--blocked allow"),
    (&["simulate"], "max-moves", "--budget Nmoves"),
    (&["simulate"], "max-minutes", "--budget Nmin"),
    (&["simulate"], "battery-per-metre", "--budget Nm"),
    (&["simulate"], "max-darts", "--budget Ndarts"),
    (&["drive"], "max-darts", "--budget Ndarts"),
    (&["drive"], "max-moves", "--budget Nmoves"),
    (&["drive"], "max-minutes", "--budget Nmin"),
    (&["drive"], "battery-per-metre", "--budget Nm"),
    (&["check"], "max-edges", "--edges 1..=N"),
    (&["counterexample"], "edges", "--max-edges"),
    (&["counterexample"], "out", "--out-dir"),
    (&["conform"], "edges", "--max-edges"),
    (&["camera", "calibrate"], "start", "--initial"),
    (&["camera", "calibrate"], "mirror-radius", "--initial"),
    (&["camera", "calibrate"], "mirror-distance", "--initial"),
    (&["camera", "calibrate"], "camera-height", "--initial"),
    (&["camera", "calibrate"], "ahead", "--initial"),
    (&["camera", "calibrate"], "seen-from", "--initial"),
    (&["drive"], "image-topic", "--topic images=TOPIC"),
    (&["drive"], "scan-topic", "--topic scans=TOPIC"),
    (&["drive"], "marker-topic", "--topic marker=TOPIC"),
    (&["drive"], "odom-topic", "--topic odometry=TOPIC"),
    (&["drive"], "cmd-vel-topic", "--topic wheels=TOPIC"),
    (&["drive"], "plan", "`toposlam conform --world` checks the log"),
    (&["simulate"], "frames", "the images are in the file of --log"),
    (&["camera", "train"], "folds", "there are 5 parts"),
];

/// The command line with the old names. The error for one says the new one.
pub(super) fn with_old_options(command: Command) -> Command {
    OPTIONS.iter().fold(command, |command, (verb, old, new)| add(command, verb, old, new))
}

fn add(command: Command, verb: &[&str], old: &'static str, new: &'static str) -> Command {
    let Some((first, rest)) = verb.split_first() else {
        let error = match new.strip_prefix("--") {
            Some(_) => UnknownArgumentValueParser::suggest_arg(new),
            None => UnknownArgumentValueParser::suggest(new),
        };
        let option = Arg::new(old).long(old).hide(true).value_name("VALUE").global(verb.is_empty());
        // An old flag has no value.
        return command.arg(option.num_args(0..=1).default_missing_value("").value_parser(error));
    };
    command.mut_subcommand(first, |command| add(command, rest, old, new))
}
