//! The tests that reach a mutant, run with it.

use std::collections::HashSet;
use std::error::Error;
use std::fs;
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use crate::{Options, build::TestProgram};

pub struct Test {
    program: usize,
    name: String,
    time: Duration,
    reached: HashSet<usize>,
}

/// Tests that take longer without a mutant are left out: they are sweeps over larger worlds.
const LONGEST: Duration = Duration::from_secs(30);

#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    Caught,
    /// A test did not end in several times its usual time.
    DidNotEnd,
    /// All tests that reach it pass.
    Survived,
    NotReached,
}

impl Outcome {
    pub fn survives(self) -> bool {
        matches!(self, Self::Survived | Self::NotReached)
    }
}

/// Runs each test alone without a mutant, and records its time and the mutants that it reaches.
///
/// # Errors
///
/// Returns an error if a test fails.
pub fn record(
    programs: &[TestProgram],
    Options { package, tests: texts, jobs, .. }: &Options,
) -> Result<Vec<Test>, Box<dyn Error>> {
    let mut tests = Vec::new();
    for (program, at) in programs.iter().enumerate() {
        let list = |arguments: &[&str]| -> Result<Vec<String>, Box<dyn Error>> {
            let output =
                at.command().args(["--list", "--format", "terse"]).args(arguments).output()?;
            let lines = String::from_utf8(output.stdout)?;
            Ok(lines
                .lines()
                .filter_map(|line| Some(line.strip_suffix(": test")?.to_owned()))
                .collect())
        };
        let ignored = list(&["--ignored"])?;
        let runs = |name: &String| {
            !ignored.contains(name)
                && (texts.is_empty() || texts.iter().any(|text| name.contains(text)))
                && !package.without.iter().any(|left_out| name.contains(left_out))
                && (!at.is_of_program
                    || package.of_program.iter().any(|start| name.starts_with(start)))
        };
        for name in list(&[])? {
            if runs(&name) {
                tests.push(Test { program, name, time: Duration::ZERO, reached: HashSet::new() });
            }
        }
    }
    if tests.is_empty() {
        return Err("there are no tests".into());
    }
    let recorded = in_parallel(*jobs, tests.len(), |index| {
        let test = &tests[index];
        let file = std::env::current_dir()
            .expect("exists")
            .join(format!("target/mutants/reached-{index}"));
        let _ = fs::remove_file(&file);
        let begin = Instant::now();
        let mut command = programs[test.program].silent_command();
        command.args(["--exact", &test.name]).env("MUTANTS_REACHED", &file);
        let passed = passes(&mut command, LONGEST);
        let reached = fs::read_to_string(&file).unwrap_or_default();
        let _ = fs::remove_file(&file);
        let reached =
            reached.lines().filter_map(|line| line.parse().ok()).collect::<HashSet<usize>>();
        (passed, begin.elapsed(), reached)
    });
    for (test, (passed, time, reached)) in tests.iter_mut().zip(recorded) {
        match passed {
            Some(true) => (test.time, test.reached) = (time, reached),
            Some(false) => {
                return Err(format!("without a mutant, this test fails: {}", test.name).into());
            }
            None => eprintln!("left out, because it takes long: {}", test.name),
        }
    }
    tests.sort_by_key(|test| test.time);
    Ok(tests)
}

/// The outcome of each of these mutants: fast tests first, and no further after one that fails. Each is passed to a
/// function, with the number of those that are done.
pub fn run(
    programs: &[TestProgram],
    tests: &[Test],
    mutants: &[usize],
    jobs: usize,
    is_done: impl Fn(usize, usize, Outcome) + Sync,
) -> Vec<Outcome> {
    let done = AtomicUsize::new(0);
    in_parallel(jobs, mutants.len(), |index| {
        let reaching: Vec<&Test> =
            tests.iter().filter(|test| test.reached.contains(&mutants[index])).collect();
        let outcome = run_one(programs, &reaching, mutants[index]);
        is_done(done.fetch_add(1, Ordering::Relaxed) + 1, mutants[index], outcome);
        outcome
    })
}

fn run_one(programs: &[TestProgram], reaching: &[&Test], mutant: usize) -> Outcome {
    if reaching.is_empty() {
        return Outcome::NotReached;
    }
    let (mut rest, mut budget) = (reaching, Duration::from_millis(200));
    while !rest.is_empty() {
        let mut total = Duration::ZERO;
        let within = rest.iter().take_while(|test| {
            total += test.time;
            total <= budget
        });
        let (batch, later) = rest.split_at(within.count().max(1));
        for (program, at) in programs.iter().enumerate() {
            let of_program: Vec<_> = batch.iter().filter(|test| test.program == program).collect();
            if of_program.is_empty() {
                continue;
            }
            let usual: Duration = of_program.iter().map(|test| test.time).sum();
            let mut command = at.silent_command();
            command
                .arg("--exact")
                .args(["--test-threads", "1"])
                .args(of_program.iter().map(|test| &test.name));
            match passes(
                command.env("MUTANT", mutant.to_string()),
                usual * 5 + Duration::from_secs(5),
            ) {
                Some(true) => {}
                Some(false) => return Outcome::Caught,
                None => return Outcome::DidNotEnd,
            }
        }
        (rest, budget) = (later, budget * 3);
    }
    Outcome::Survived
}

/// Whether a command succeeds; nothing if it does not end in time.
fn passes(command: &mut Command, limit: Duration) -> Option<bool> {
    let Ok(mut child) = command.spawn() else { return Some(false) };
    let begin = Instant::now();
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return Some(status.success()),
            Ok(None) if begin.elapsed() < limit => thread::sleep(Duration::from_millis(2)),
            _ => {
                let _ = child.kill();
                let _ = child.wait();
                return None;
            }
        }
    }
}

impl TestProgram {
    fn command(&self) -> Command {
        let mut command = Command::new(&self.path);
        command
            .current_dir(&self.folder)
            .env("CARGO_MANIFEST_DIR", &self.folder)
            // The random cases are the same in every run.
            .env("PROPTEST_RNG_SEED", "1")
            .env("PROPTEST_DISABLE_FAILURE_PERSISTENCE", "true")
            .stdin(Stdio::null());
        command
    }

    fn silent_command(&self) -> Command {
        let mut command = self.command();
        command.stdout(Stdio::null()).stderr(Stdio::null());
        command
    }
}

/// The results of all indices below `count`, in order.
fn in_parallel<T: Send>(jobs: usize, count: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let next = AtomicUsize::new(0);
    let results = Mutex::new(Vec::new());
    thread::scope(|scope| {
        for _ in 0..jobs {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if index >= count {
                        break;
                    }
                    let result = work(index);
                    results.lock().expect("no thread panics").push((index, result));
                }
            });
        }
    });
    let mut results = results.into_inner().expect("no thread panics");
    results.sort_by_key(|(index, _)| *index);
    results.into_iter().map(|(_, result)| result).collect()
}
