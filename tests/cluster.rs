//! Several processes that share a check or a search over TCP, on this machine: the result is that of one
//! process, and if one ends the others end with a message.

#![cfg(all(feature = "cluster", unix))]
#![allow(clippy::unwrap_used, reason = "a test may panic")]

#[path = "schema/validator.rs"]
mod validator;

use std::{
    fs,
    io::Write,
    net::{Ipv4Addr, TcpListener, TcpStream},
    path::{Path, PathBuf},
    process::{Child, Command, Output, Stdio},
    thread::sleep,
    time::{Duration, Instant},
};

use serde_json::Value;

/// A process that ends with the test.
struct Process(Option<Child>);

/// What a process printed, and how it ended.
struct Ended {
    code: Option<i32>,
    out: String,
    error: String,
}

impl From<Output> for Ended {
    fn from(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).unwrap();
        let (out, error) = (text(output.stdout), text(output.stderr));
        assert!(!error.contains("panicked"), "{error}");
        Self { code: output.status.code(), out, error }
    }
}

impl Process {
    fn start(arguments: &[String]) -> Self {
        Self(Some(toposlam(arguments).spawn().unwrap()))
    }

    fn signal(&self, name: &str) {
        let id = self.0.as_ref().unwrap().id().to_string();
        assert!(Command::new("kill").args([name, &id]).status().unwrap().success());
    }

    fn is_running(&mut self) -> bool {
        self.0.as_mut().unwrap().try_wait().unwrap().is_none()
    }

    /// Waits for its end.
    fn ends(mut self) -> Ended {
        self.0.take().unwrap().wait_with_output().unwrap().into()
    }

    /// Its end, which must be within some seconds.
    fn ends_within(mut self, seconds: u64) -> Ended {
        until("the process ends", seconds, || !self.is_running());
        self.ends()
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        if let Some(mut child) = self.0.take() {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

fn toposlam(arguments: &[String]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_toposlam"));
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn until(what: &str, seconds: u64, mut holds: impl FnMut() -> bool) {
    let until = Instant::now() + Duration::from_secs(seconds);
    while !holds() {
        assert!(Instant::now() < until, "not within {seconds} s: {what}");
        sleep(Duration::from_millis(10));
    }
}

/// A folder for a test, with a file of hosts that nobody uses yet.
struct Stage {
    folder: PathBuf,
    processes: usize,
}

impl Stage {
    fn new(name: &str, processes: usize) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cluster").join(name);
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        let mut stage = Self { folder, processes: 0 };
        stage.use_processes(processes);
        stage
    }

    /// Writes a file of hosts with other ports.
    fn use_processes(&mut self, processes: usize) {
        let bind = |_| TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
        let free: Vec<_> = (0..processes).map(bind).collect();
        let addresses = free.iter().map(|free| format!("{}\n", free.local_addr().unwrap()));
        fs::write(self.folder.join("hosts.txt"), addresses.collect::<String>()).unwrap();
        self.processes = processes;
    }

    fn path(&self, name: &str) -> String {
        self.folder.join(name).display().to_string()
    }

    fn address(&self, process: usize) -> String {
        let hosts = fs::read_to_string(self.folder.join("hosts.txt")).unwrap();
        hosts.lines().nth(process).unwrap().to_owned()
    }

    /// The arguments of a process with one thread.
    fn arguments(&self, command: &str, process: usize) -> Vec<String> {
        let own = [
            "--threads".to_owned(),
            "1".to_owned(),
            "--hosts".to_owned(),
            self.path("hosts.txt"),
            "--process".to_owned(),
            process.to_string(),
        ];
        words(command).into_iter().chain(own).collect()
    }

    fn start(&self, command: &str) -> Vec<Process> {
        let start = |process| Process::start(&self.arguments(command, process));
        (0..self.processes).map(start).collect()
    }

    /// Runs all processes to their end.
    fn run(&self, command: &str) -> Vec<Ended> {
        self.start(command).into_iter().map(Process::ends).collect()
    }
}

fn words(command: &str) -> Vec<String> {
    command.split(' ').map(str::to_owned).collect()
}

fn alone(command: &str) -> Ended {
    toposlam(&words(command)).output().unwrap().into()
}

/// The lines of a kind.
fn lines_of<'t>(text: &'t str, kind: &str) -> Vec<&'t str> {
    let kind = format!("{{\"schema\":1,\"kind\":\"{kind}\",");
    text.lines().filter(|line| line.starts_with(&kind)).collect()
}

/// Whether three processes print what one prints, and end as it does.
fn is_that_of_one_process(stage: &Stage, command: &str) {
    let one = alone(command);
    for json in ["", " --json"] {
        let command = format!("{command}{json}");
        let ended = stage.run(&command);
        let one = alone(&command);
        let expected: Vec<_> = one.out.lines().collect();
        let mut printed: Vec<_> = ended[0].out.lines().collect();
        let threads = lines_of(&ended[0].out, "threads");
        printed.retain(|line| !threads.contains(line));
        assert_eq!(printed, expected, "{command}");
        for Ended { code, error, .. } in &ended {
            assert_eq!(*code, one.code, "{command}: {error}");
        }
        for Ended { out, .. } in &ended[1..] {
            assert_eq!(out, "", "{command}");
        }
    }
    assert!(!one.out.is_empty());
}

#[test]
fn three_processes_check_what_one_checks() {
    let stage = Stage::new("check", 3);
    for command in [
        "check --edges 1..=5",
        "check --class simple --edges 7 --algorithm folding",
        "check --class corridor --edges 1..=6 --marker movable",
        "check --class planar --edges 6",
    ] {
        is_that_of_one_process(&stage, command);
    }
}

#[test]
fn three_processes_find_the_pairs_that_one_finds() {
    let stage = Stage::new("search", 3);
    for command in [
        "counterexample --class multigraph --max-edges 4 --all",
        "counterexample --class corridor --max-edges 8 --marker undirected --marker movable",
        "counterexample --max-edges 5 --expect none",
        "counterexample --max-edges 6 --marker directional --expect none",
    ] {
        is_that_of_one_process(&stage, command);
    }
    // Only process 0 writes files.
    let folders = ["worlds-0", "worlds-1"].map(|name| stage.path(name));
    let search = |process: usize| {
        let find = format!("counterexample --marker undirected --out-dir {}", folders[process]);
        Process::start(&stage.arguments(&find, process))
    };
    let third = Process::start(&stage.arguments("counterexample --marker undirected", 2));
    for process in [search(0), search(1), third] {
        assert_eq!(process.ends().code, Some(0));
    }
    assert_eq!(fs::read_dir(&folders[0]).unwrap().count(), 2);
    assert!(!Path::new(&folders[1]).exists());
}

#[test]
fn each_thread_reports_its_tasks_and_its_time() {
    let stage = Stage::new("threads", 2);
    let schema = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/schema/cluster.json");
    let schema: Value = serde_json::from_slice(&fs::read(schema).unwrap()).unwrap();
    let ended = stage.run("check --edges 5..=6 --json");
    let lines = lines_of(&ended[0].out, "threads");
    assert_eq!(lines.len(), 2, "{}", ended[0].out);
    for line in lines {
        let line: Value = serde_json::from_str(line).unwrap();
        assert_eq!(validator::problem(&schema, &line), None, "{line}");
        let threads = line["threads"].as_array().unwrap();
        let place = |thread: &Value| (thread["process"].clone(), thread["thread"].clone());
        let places: Vec<_> = threads.iter().map(place).collect();
        assert_eq!(places, [(0.into(), 0.into()), (1.into(), 0.into())], "{line}");
        let all = |name: &str| threads.iter().map(|t| t[name].as_f64().unwrap()).sum::<f64>();
        assert!(all("tasks") > 10.0 && all("busy_seconds") > 0.0, "{line}");
        assert!(threads.iter().all(|t| t["idle_seconds"].as_f64().unwrap() >= 0.0), "{line}");
    }
    assert!(ended[0].error.contains("5 edges, process 1: "), "{}", ended[0].error);
}

/// Several seconds of work.
const LONG: &str = "check --algorithm folding --edges 7";

#[test]
fn a_check_goes_on_with_two_processes_after_one_of_three_was_killed() {
    let mut stage = Stage::new("killed", 3);
    let command = format!("{LONG} --json --journal {}", stage.path("journal"));
    let journal = stage.folder.join("journal/7-edges.journal");
    let recorded = || fs::read_to_string(&journal).map_or(0, |text| text.lines().count());
    let mut processes = stage.start(&command);
    until("some units are recorded", 60, || recorded() > 100);
    processes[2].signal("-KILL");
    let killed = Instant::now();
    let _ = processes.remove(2);
    for (number, process) in processes.into_iter().enumerate() {
        let ended = process.ends_within(5);
        assert_eq!((ended.code, &*ended.out), (Some(3), ""), "{number}: {}", ended.error);
        assert!(ended.error.contains(" is lost: the work is not finished"), "{}", ended.error);
        assert!(ended.error.contains("with the same --journal"), "{}", ended.error);
        let last = ended.error.lines().filter(|line| line.contains("lost")).count();
        assert_eq!(last, 1, "{}", ended.error);
    }
    assert!(killed.elapsed() < Duration::from_secs(5));
    let before = recorded();

    // A journal that is corrupt, or of another check, is refused.
    stage.use_processes(2);
    let right = fs::read_to_string(&journal).unwrap();
    fs::write(&journal, right.replacen("\"starts\":", "\"starts\":1", 1)).unwrap();
    let refused = stage.run(&command);
    assert_eq!(refused[0].code, Some(2), "{}", refused[0].error);
    assert!(refused[0].error.contains("line 2: the journal is corrupt"), "{}", refused[0].error);
    assert_eq!(refused[1].code, Some(3), "{}", refused[1].error);
    fs::write(&journal, right).unwrap();
    let foreign = stage.run(&command.replace("--algorithm folding", "--algorithm algorithm1"));
    assert!(foreign[0].error.contains("this is the journal of another check"));
    assert_eq!([foreign[0].code, foreign[1].code], [Some(2), Some(3)]);

    stage.use_processes(2);
    let ended = stage.run(&command);
    assert_eq!(ended[0].code, Some(0), "{}", ended[0].error);
    let finished = format!("{} units of the work finished before", before - 1);
    assert!(ended[0].error.contains(&finished), "{before}: {}", ended[0].error);
    let one = alone(&format!("{LONG} --json"));
    assert_eq!(lines_of(&ended[0].out, "size"), lines_of(&one.out, "size"));
    // One process reads the same journal.
    assert_eq!(alone(&command).out, one.out);
}

#[test]
fn without_process_0_the_others_end() {
    let stage = Stage::new("first", 2);
    let mut processes = stage.start(LONG);
    sleep(Duration::from_millis(500));
    processes[0].signal("-KILL");
    let ended = processes.remove(1).ends_within(5);
    assert_eq!(ended.code, Some(3), "{}", ended.error);
    let message = format!("the connection to process 0 ({}) is lost", stage.address(0));
    assert!(ended.error.contains(&message), "{}", ended.error);
}

#[test]
fn ctrl_c_ends_all_processes_and_process_0_prints_what_it_has() {
    for interrupted in 0..2 {
        let stage = Stage::new(&format!("interrupted-{interrupted}"), 2);
        let processes = stage.start(&LONG.replace("--edges 7", "--edges 3..=7"));
        sleep(Duration::from_millis(700));
        processes[interrupted].signal("-INT");
        let ended: Vec<_> = processes.into_iter().map(|process| process.ends_within(5)).collect();
        let codes: Vec<_> = ended.iter().map(|ended| ended.code).collect();
        assert_eq!(codes, [Some(3), Some(3)], "{} {}", ended[0].error, ended[1].error);
        let out = &ended[0].out;
        assert!(out.contains("    3         20            74       0"), "{out}");
        assert_eq!(out.contains("interrupted"), interrupted == 0, "{out}");
        assert!(ended[1 - interrupted].error.contains("is lost"), "{}", ended[1].error);
    }
}

#[test]
fn processes_that_do_other_work_are_refused() {
    let stage = Stage::new("other", 2);
    let first = Process::start(&stage.arguments("check --edges 4", 0));
    let second = Process::start(&stage.arguments("check --edges 5", 1));
    let [first, second] = [first.ends_within(20), second.ends_within(20)];
    assert_eq!([first.code, second.code], [Some(2), Some(2)], "{} {}", first.error, second.error);
    let expected = "does other work: the number of edges is 5..=5 there, and 4..=4 here";
    assert!(first.error.contains(expected), "{}", first.error);
}

#[test]
fn a_process_waits_for_the_others_and_ignores_strangers() {
    let stage = Stage::new("stranger", 2);
    let first = Process::start(&stage.arguments("check --edges 3", 0));
    let mut stranger = None;
    until("process 0 listens", 20, || {
        stranger = TcpStream::connect(stage.address(0)).ok();
        stranger.is_some()
    });
    stranger.unwrap().write_all(b"GET / HTTP/1.1\r\n\r\n").unwrap();
    sleep(Duration::from_millis(200));
    let second = Process::start(&stage.arguments("check --edges 3", 1));
    let ended = first.ends_within(30);
    assert_eq!(ended.code, Some(0), "{}", ended.error);
    assert_eq!(second.ends_within(30).code, Some(0));
    // Ctrl-C ends the wait.
    let waiting = Process::start(&stage.arguments("check --edges 3", 1));
    sleep(Duration::from_millis(300));
    waiting.signal("-INT");
    assert_eq!(waiting.ends_within(5).code, Some(3));
}

#[test]
fn bad_hosts_are_refused() {
    let stage = Stage::new("hosts", 2);
    let refused = |process: &str, hosts: &str| {
        let path = stage.path("hosts.txt");
        fs::write(&path, hosts).unwrap();
        let ended = alone(&format!("check --edges 2 --hosts {path} --process {process}"));
        assert_eq!(ended.code, Some(2), "{}", ended.error);
        ended.error
    };
    assert!(refused("0", "127.0.0.1\n").contains("line 1: `127.0.0.1` is not an address"));
    assert!(refused("2", "a:1\nb:1\n").contains("--process: "));
    assert!(refused("0", "").contains("there is no address"));
    // Not an address of this machine.
    assert!(refused("0", "192.0.2.1:7700\nb:1\n").contains("cannot listen at this address"));
    let ended = alone("check --edges 2 --process 1");
    assert_eq!(ended.code, Some(2), "{}", ended.error);
    for other in ["--shard 1/2", "--choices all", "--estimate", "--from worlds/petersen.toml"] {
        let ended = alone(&format!("check --hosts hosts.txt --process 0 {other}"));
        assert_eq!(ended.code, Some(2), "{other}: {}", ended.error);
        assert!(ended.error.contains("cannot be used with"), "{other}: {}", ended.error);
    }
}
