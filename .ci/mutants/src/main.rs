//! Mutation testing: is there a small change of the code that no test detects? All mutants of a package are compiled
//! into one program, of which an environment variable selects one.

mod build;
mod site;
mod switched;
mod tests;

use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write as _;
use std::process::{Command, ExitCode};

use build::Mutant;
use tests::Outcome;

const HELP: &str = "\
Usage: .ci/mutants/run PACKAGE [TEXT]... [--since BASE] [--test TEXT] [--jobs J]
                       [--list]

Makes one small change after another in a package, and runs the tests that reach
it. A test that fails, or that does not end, has caught the mutant.

  PACKAGE       model, conform (with the tests of its command), or a part of
                vision: laser, visits (with the tests of conformance), or vision
                for the rest
  TEXT          only the mutants whose names contain one of these texts, such as
                vision/src/laser/
  --since BASE  only the mutants in files that have changed since commit BASE
  --test TEXT   only the tests whose names contain this text, or one of several
  --jobs J      mutants tested at the same time (default: 2)
  --list        print the mutants, and run nothing

.ci/mutants/PACKAGE.txt lists mutants that no test can detect, each group below
a line with the reason. They are run, too.

Exit codes: 0 all mutants are caught or listed, 1 some survive, or are listed
and caught, 2 bad usage, or tests that fail without a mutant.
";

/// A package under test, or a part of one.
struct Package {
    name: &'static str,
    /// Its folder.
    folder: &'static str,
    /// Whether a file belongs to it.
    has: fn(&str) -> bool,
    /// The tests, as arguments of `cargo test`.
    tests: &'static [&'static str],
    /// Tests with these texts in their names are left out.
    without: &'static [&'static str],
    /// Of the tests of the whole program, those whose names begin so run.
    of_program: &'static [&'static str],
}

/// The bodies of fuzz targets are tests.
fn is_fuzzing(file: &str) -> bool {
    file.contains("/src/fuzz")
}

const LASER: &str = "vision/src/laser/";
const VISITS: &str = "vision/src/visits/";

const PACKAGES: &[Package] = &[
    Package {
        name: "model",
        folder: "model",
        has: |_| true,
        tests: &["-p", "toposlam-model", "--lib", "--test", "all"],
        // Larger worlds catch nothing that smaller ones do not.
        without: &["costs::the_table_of_every_small_start_is_true"],
        of_program: &[],
    },
    Package {
        name: "laser",
        folder: "vision",
        has: |file| file.starts_with(LASER),
        tests: &["-p", "toposlam-vision", "--lib"],
        without: &[],
        of_program: &[],
    },
    Package {
        name: "vision",
        folder: "vision",
        has: |file| !file.starts_with(LASER) && !file.starts_with(VISITS) && !is_fuzzing(file),
        tests: &["-p", "toposlam-vision", "--lib", "--test", "all"],
        without: &[],
        of_program: &[],
    },
    Package {
        name: "visits",
        folder: "vision",
        has: |file| file.starts_with(VISITS),
        tests: &["-p", "toposlam-vision", "-p", "toposlam-conform", "--lib"],
        without: &[],
        of_program: &[],
    },
    Package {
        name: "conform",
        folder: "conform",
        has: |file| !is_fuzzing(file),
        tests: &[
            "-p",
            "toposlam-conform",
            "-p",
            "toposlam",
            "--lib",
            "--test",
            "all",
            "--test",
            "snapshots",
        ],
        without: &[],
        // Reports are printed by the command.
        of_program: &[
            "command_line::ci_report::",
            "command_line::conform::",
            "command_line::facts::conform",
            "command_line::facts::lines",
            "command_line::facts::names",
            "command_line::facts::options",
            "command_line::facts::walks",
            "command_line::laser::the_vertices_of_a_run",
            "command_line::sense::if_no_image",
            "conform",
            "verdicts::verdicts_about_logs",
        ],
    },
];

struct Options {
    package: &'static Package,
    texts: Vec<String>,
    since: Option<String>,
    /// Tests with none of these texts in their names are left out, if there are some.
    tests: Vec<String>,
    jobs: usize,
    only_lists: bool,
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.iter().any(|argument| argument == "-h" || argument == "--help") {
        print!("{HELP}");
        return ExitCode::SUCCESS;
    }
    match options(&arguments).and_then(|options| examine(&options)) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}

fn options(arguments: &[String]) -> Result<Options, Box<dyn Error>> {
    let (mut package, mut texts, mut since, mut tests, mut jobs, mut only_lists) =
        (None, Vec::new(), None, Vec::new(), 2, false);
    let mut arguments = arguments.iter();
    while let Some(argument) = arguments.next() {
        match &**argument {
            "--since" => since = Some(arguments.next().ok_or("--since needs a commit")?.clone()),
            "--test" => tests.push(arguments.next().ok_or("--test needs a text")?.clone()),
            "--jobs" => jobs = arguments.next().ok_or("--jobs needs a number")?.parse()?,
            "--list" => only_lists = true,
            option if option.starts_with('-') => {
                return Err(format!("unknown option {option}; see --help").into());
            }
            name if package.is_none() => {
                let known = PACKAGES.iter().find(|package| package.name == name);
                package = Some(known.ok_or_else(|| format!("unknown package {name}; see --help"))?);
            }
            text => texts.push(text.to_owned()),
        }
    }
    Ok(Options {
        package: package.ok_or("which package? see --help")?,
        texts,
        since,
        tests,
        jobs,
        only_lists,
    })
}

/// Whether all selected mutants are caught or rightly listed.
fn examine(options: &Options) -> Result<bool, Box<dyn Error>> {
    let package = options.package;
    let listed = listed(package.name)?;
    let touched = options.since.as_deref().map(touched).transpose()?;
    let is_selected = |mutant: &Mutant| {
        let name = mutant.name();
        (options.texts.is_empty() || options.texts.iter().any(|text| name.contains(text)))
            && touched.as_ref().is_none_or(|files| files.contains(&mutant.file))
    };
    let mutants = build::mutants(package)?;
    for name in &listed {
        if !mutants.iter().any(|mutant| mutant.name() == *name) {
            return Err(format!("no mutant has this listed name: {name}").into());
        }
    }
    let selected: Vec<usize> =
        (0..mutants.len()).filter(|&mutant| is_selected(&mutants[mutant])).collect();
    if options.only_lists {
        selected.iter().for_each(|&mutant| println!("{}", mutants[mutant].name()));
        return Ok(true);
    }
    let built = build::build(package, &selected)?;
    let compiled: Vec<usize> =
        selected.iter().copied().filter(|&mutant| built.mutants[mutant].compiles).collect();
    eprintln!("{} mutants, of which {} compile", selected.len(), compiled.len());
    let tests = tests::record(&built.programs, options)?;
    let is_done = |done: usize, mutant: usize, outcome: Outcome| {
        let mutant = &built.mutants[mutant];
        if outcome.survives() && !listed.contains(&mutant.name()) {
            eprintln!("{}:{}: {}", mutant.file, mutant.line, mutant.change);
        }
        if done.is_multiple_of(100) {
            eprintln!("{done} of {}", compiled.len());
        }
    };
    let outcomes = tests::run(&built.programs, &tests, &compiled, options.jobs, is_done);

    let mut rows: BTreeMap<String, [usize; 6]> = BTreeMap::new();
    let (mut survivors, mut wrongly_listed) = (String::new(), String::new());
    let outcomes: BTreeMap<usize, Outcome> = compiled.into_iter().zip(outcomes).collect();
    for mutant in selected {
        let outcome = outcomes.get(&mutant);
        let mutant = &built.mutants[mutant];
        let is_listed = listed.contains(&mutant.name());
        let is_caught = outcome.is_some_and(|outcome| !outcome.survives());
        let column = match outcome {
            None => 3,
            Some(Outcome::Caught) => 1,
            Some(Outcome::DidNotEnd) => 2,
            Some(_) if is_listed => 4,
            Some(_) => 5,
        };
        let folder = mutant.file.split('/').nth(2).unwrap_or_default();
        let row = rows.entry(format!("{}/src/{folder}", package.folder)).or_default();
        row[0] += 1;
        row[column] += 1;
        if is_listed && is_caught {
            writeln!(wrongly_listed, "{}", mutant.name())?;
        } else if column == 5 {
            let reached =
                if outcome == Some(&Outcome::NotReached) { "not reached" } else { "survived" };
            writeln!(survivors, "{reached} {}:{}: {}", mutant.file, mutant.line, mutant.change)?;
        }
    }
    print!("{survivors}");
    if !wrongly_listed.is_empty() {
        println!("\nListed, and caught:\n{wrongly_listed}");
    }
    println!("\n| files | mutants | caught | did not end | do not compile | listed | survive |");
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    let total = rows
        .values()
        .fold([0; 6], |total, row| std::array::from_fn(|index| total[index] + row[index]));
    for (files, counts) in
        rows.iter().map(|(files, counts)| (&**files, counts)).chain([("all", &total)])
    {
        println!("| {files} | {} |", counts.map(|count| count.to_string()).join(" | "));
    }
    Ok(survivors.is_empty() && wrongly_listed.is_empty())
}

/// The names in the list of equivalent mutants.
fn listed(package: &str) -> Result<Vec<String>, Box<dyn Error>> {
    let text = std::fs::read_to_string(format!(".ci/mutants/{package}.txt"))?;
    let lines = text.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
    Ok(lines.map(str::to_owned).collect())
}

/// The files that have changed since a commit.
fn touched(base: &str) -> Result<Vec<String>, Box<dyn Error>> {
    let output =
        Command::new("git").args(["diff", "--name-only", "--merge-base", base]).output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    Ok(String::from_utf8(output.stdout)?.lines().map(str::to_owned).collect())
}
