//! What is claimed and what shows it, `docs/assurance.md`: the table of `tests/assurance.toml`. Every command exists, and fails
//! if its claim is false.

use std::{collections::BTreeSet, env, fmt::Write as _, fs, path::PathBuf, process::Command};

use serde::Deserialize;

use crate::{output::names_in, printed, read, repository};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    part: Vec<Part>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Part {
    title: String,
    claim: Vec<Claim>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Claim {
    #[serde(rename = "claim")]
    text: String,
    engine: Engine,
    /// For what it is shown, and against which oracle.
    bound: String,
    command: String,
    /// The processor time of the command, if it was measured.
    seconds: Option<f64>,
}

/// What shows a claim.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Engine {
    /// A proof in Coq, without axioms.
    Coq,
    /// The checker of proofs of verdicts, which is proved in Coq.
    VerifiedChecker,
    /// Every case within the bound.
    Exhaustive,
    /// Symbolic execution of the compiled harness.
    Symbolic,
    /// Cases from seeds, or some that were chosen.
    Random,
    /// A rate in simulated runs.
    Measured,
}

impl Engine {
    fn name(self) -> &'static str {
        match self {
            Self::Coq => "Coq",
            Self::VerifiedChecker => "verified checker",
            Self::Exhaustive => "exhaustive",
            Self::Symbolic => "symbolic",
            Self::Random => "random",
            Self::Measured => "measured",
        }
    }
}

fn table() -> Vec<Part> {
    let table: Table = toml::from_str(&read("tests/assurance.toml")).unwrap();
    table.part
}

/// The introduction of the page, up to its first part; what comes behind the parts.
fn frame(page: &str) -> (&str, &str) {
    let (introduction, rest) = page.split_once("\n## ").unwrap();
    let coverage = rest.find("\n## What the tests do not run").map_or("", |at| &rest[at..]);
    (introduction, coverage)
}

fn page(found: &str, parts: &[Part]) -> String {
    let (introduction, coverage) = frame(found);
    let mut page = introduction.to_owned();
    for Part { title, claim } in parts {
        let _ = write!(page, "\n## {title}\n\n| claim | engine | bound | command | seconds |\n");
        page += "| --- | --- | --- | --- | --- |\n";
        for Claim { text, engine, bound, command, seconds } in claim {
            let command = command.replace('|', "\\|");
            let seconds = seconds.map_or_else(String::new, |seconds| {
                if seconds < 9.95 { format!("{seconds:.1}") } else { format!("{seconds:.0}") }
            });
            let engine = engine.name();
            let _ = writeln!(page, "| {text} | {engine} | {bound} | `{command}` | {seconds} |");
        }
    }
    page + coverage
}

#[test]
fn the_page_shows_the_table() {
    let found = read("docs/assurance.md").replace("\r\n", "\n");
    let page = page(&found, &table());
    if env::var_os("TOPOSLAM_ACCEPT").is_some_and(|value| value == "1") {
        return fs::write(repository("docs/assurance.md"), &page).unwrap();
    }
    let differ = found.lines().zip(page.lines()).find(|(one, other)| one != other);
    assert!(found == page, "docs/assurance.md is out of date; set TOPOSLAM_ACCEPT=1: {differ:#?}");
}

/// The folder of a package.
fn folder(package: Option<&str>) -> &str {
    package.map_or("", |package| package.strip_prefix("toposlam-").unwrap())
}

/// The text of all Rust files in a folder, and the names of the modules there.
fn add_modules(path: &str, text: &mut String, modules: &mut BTreeSet<String>) {
    let names = if repository(path).is_dir() { names_in(&repository(path)) } else { Vec::new() };
    for name in names {
        let inner = format!("{path}/{name}");
        if repository(&inner).is_dir() {
            modules.insert(name);
            add_modules(&inner, text, modules);
        } else if let Some(module) = name.strip_suffix(".rs") {
            modules.insert(module.to_owned());
            *text += &read(&inner);
        }
    }
}

#[test]
fn each_command_names_what_exists() {
    let lemmas = printed(crate::program().args(["proofs"]));
    let theorems = read("proofs/coq/README.md");
    for Claim { text: claim, command, .. } in table().iter().flat_map(|part| &part.claim) {
        let words: Vec<&str> = command.split_whitespace().collect();
        match &words[..] {
            ["cargo", "test", options @ ..] => {
                let after = |name: &str| {
                    let at = options.iter().position(|word| *word == name)?;
                    options.get(at + 1).copied()
                };
                let (mut text, mut modules) = (String::new(), BTreeSet::new());
                for part in ["src", "tests"] {
                    let path = format!("{}/{part}", folder(after("-p")));
                    add_modules(path.trim_start_matches('/'), &mut text, &mut modules);
                }
                let test = after("--test").filter(|test| *test != "all");
                assert!(test.is_none_or(|test| modules.contains(test)), "{command}");
                let filter = after("--lib").or(after("all")).filter(|word| !word.starts_with('-'));
                for name in filter.iter().flat_map(|filter| filter.split_terminator("::")) {
                    assert!(modules.contains(name) || text.contains(name), "{command}: {name}");
                }
            }
            ["toposlam", "proofs", runs @ ..] => {
                let names = runs.iter().filter(|word| **word != "--run" && **word != "all");
                names.for_each(|name| assert!(lemmas.contains(name), "{command}"));
            }
            [program, ..] if program.contains('/') => {
                assert!(repository(program).exists(), "{command}");
            }
            [program, ..] => {
                let known = ["toposlam", "evaluate", "cargo", "for"];
                assert!(known.contains(program), "{command}");
            }
            [] => panic!("{claim}: no command"),
        }
        if command == "proofs/coq/check" {
            let names = claim.split('`').skip(1).step_by(2).filter(|name| name.contains('_'));
            names.for_each(|name| assert!(theorems.contains(name), "{name}"));
        }
    }
}

/// Runs every command, with the programs in `target/release`, and measures it.
#[test]
#[ignore = "it takes an hour: `.ci/run --all`"]
fn each_command_shows_its_claim() {
    let target =
        env::var_os("CARGO_TARGET_DIR").map_or_else(|| repository("target"), PathBuf::from);
    let others = env::var_os("PATH").unwrap();
    let folders = [target.join("release")].into_iter().chain(env::split_paths(&others));
    let path = env::join_paths(folders).unwrap();
    // What is skipped shows nothing.
    let required = ["COQ", "PYTHON", "PYTHON_LOGS", "SYMBOLIC"]
        .map(|what| (format!("TOPOSLAM_{what}"), "required"));
    let bash = |script: &str| {
        let mut bash = Command::new("bash");
        bash.args(["-euo", "pipefail", "-c", script])
            .current_dir(repository(""))
            .env("PATH", &path)
            .envs(required.clone());
        bash.output().unwrap()
    };
    let is_accepted = env::var_os("TOPOSLAM_ACCEPT").is_some_and(|value| value == "1");
    let parts = table();
    // Some show several claims.
    let commands: BTreeSet<&str> =
        parts.iter().flat_map(|part| &part.claim).map(|claim| &*claim.command).collect();
    let mut failed = Vec::new();
    for command in commands {
        if command.starts_with("cargo +nightly") {
            println!("skipped: {command}: libFuzzer needs a nightly compiler");
            continue;
        }
        if command.starts_with("cargo test") {
            let (build, _) = command.split_once(" -- ").unwrap_or((command, ""));
            bash(&format!("{build} --no-run"));
        }
        let output = bash(&format!("TIMEFORMAT='%U %S'; time {{ {command}; }}"));
        let stderr = String::from_utf8_lossy(&output.stderr);
        if !output.status.success() {
            failed.push(format!("{command}: {stderr}"));
            continue;
        }
        let times = stderr.lines().last().unwrap().split(' ').map(str::parse::<f64>);
        let seconds: f64 = times.map(Result::unwrap).sum();
        println!("{seconds:.1} s: {command}");
        if is_accepted {
            let text = with_seconds(&read("tests/assurance.toml"), command, seconds);
            fs::write(repository("tests/assurance.toml"), text).unwrap();
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

/// The table with the seconds of a command behind each line that has it.
fn with_seconds(table: &str, command: &str, seconds: f64) -> String {
    let command = format!("command = {}", toml::Value::from(command));
    let mut text = String::new();
    let mut is_behind = false;
    for line in table.lines() {
        if !(is_behind && line.starts_with("seconds = ")) {
            text += line;
            text.push('\n');
        }
        is_behind = line == command;
        if is_behind {
            let _ = writeln!(text, "seconds = {seconds:.1}");
        }
    }
    text
}
