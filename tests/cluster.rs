//! Several processes that share a check or a search over TCP, on this machine: the result is that of one
//! process, and if one ends the others end with a message.

#![cfg(all(feature = "cluster", unix))]
#![allow(clippy::unwrap_used, reason = "a test may panic")]

#[allow(dead_code, reason = "other programs use the rest")]
mod output;
mod process;

use std::{
    fs,
    io::Write,
    net::{Ipv4Addr, TcpListener, TcpStream},
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
    thread::sleep,
    time::Duration,
};

use output::{Schema, json_lines, stderr, stdout};
use process::{Process, until};
use toposlam_model::counts::grouped;

/// How a process ended, what it printed, and its messages.
type Ended = (Option<i32>, String, String);

fn ended(output: &Output) -> Ended {
    assert!(!stderr(output).contains("panicked"), "{}", stderr(output));
    (output.status.code(), stdout(output), stderr(output))
}

fn toposlam(command: &str) -> Command {
    let mut toposlam = Command::new(env!("CARGO_BIN_EXE_toposlam"));
    toposlam.args(command.split(' ')).stdin(Stdio::null());
    toposlam.stdout(Stdio::piped()).stderr(Stdio::piped());
    toposlam
}

fn alone(command: &str) -> Ended {
    ended(&toposlam(command).output().unwrap())
}

/// A folder for a test, with a file of hosts that nobody uses yet.
struct Stage {
    folder: PathBuf,
    processes: usize,
}

impl Stage {
    fn new(name: &str, processes: usize) -> Self {
        let mut stage = Self { folder: output::folder(&format!("cluster-{name}")), processes: 0 };
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

    /// One process with one thread.
    fn command(&self, command: &str, process: usize) -> Command {
        let hosts = self.path("hosts.txt");
        toposlam(&format!("{command} --threads 1 --hosts {hosts} --process {process}"))
    }

    fn start_one(&self, command: &str, process: usize) -> Process {
        Process::start(&mut self.command(command, process))
    }

    fn start(&self, command: &str) -> Vec<Process> {
        (0..self.processes).map(|process| self.start_one(command, process)).collect()
    }

    /// Runs all processes to their end.
    fn run(&self, command: &str) -> Vec<Ended> {
        self.start(command).into_iter().map(|process| ended(&process.ends())).collect()
    }
}

fn lines_of<'t>(text: &'t str, kind: &str) -> Vec<&'t str> {
    let kind = format!("{{\"schema\":1,\"kind\":\"{kind}\",");
    text.lines().filter(|line| line.starts_with(&kind)).collect()
}

#[test]
fn three_processes_print_what_one_prints_and_end_as_it_does() {
    let stage = Stage::new("same", 3);
    for command in [
        "check --edges 1..=5",
        "check --class simple --edges 7 --algorithm folding",
        "check --class corridor --edges 1..=6 --marker movable",
        "check --class planar --edges 6",
        "counterexample --class multigraph --max-edges 4 --all",
        "counterexample --class corridor --max-edges 8 --marker undirected --marker movable",
        "counterexample --max-edges 5 --expect none",
        "counterexample --max-edges 6 --marker directional --expect none",
    ] {
        for command in [command, &format!("{command} --json")] {
            let one = alone(command);
            let all = stage.run(command);
            let mut printed: Vec<_> = all[0].1.lines().collect();
            let threads = lines_of(&all[0].1, "threads");
            printed.retain(|line| !threads.contains(line));
            assert_eq!(printed, one.1.lines().collect::<Vec<_>>(), "{command}");
            assert!(!one.1.is_empty());
            assert!(all.iter().all(|(code, ..)| *code == one.0), "{command}: {all:?}");
            assert!(all[1..].iter().all(|(_, out, _)| out.is_empty()), "{command}: {all:?}");
        }
    }
    // Only process 0 writes files.
    let search = |process| {
        let folder = stage.path(&format!("worlds-{process}"));
        stage.start_one(&format!("counterexample --marker undirected --out-dir {folder}"), process)
    };
    let third = stage.start_one("counterexample --marker undirected", 2);
    for process in [search(0), search(1), third] {
        assert_eq!(process.ends().status.code(), Some(0));
    }
    assert_eq!(fs::read_dir(stage.path("worlds-0")).unwrap().count(), 2);
    assert!(!stage.folder.join("worlds-1").exists());
}

#[test]
fn each_thread_reports_its_tasks_and_its_time() {
    let stage = Stage::new("threads", 2);
    let schema = Schema::read("cluster");
    let (_, out, error) = &stage.run("check --edges 5..=6 --json")[0];
    let lines = json_lines(&(lines_of(out, "threads").join("\n") + "\n"));
    assert_eq!(lines.len(), 2, "{out}");
    for line in lines {
        assert_eq!(schema.misfit(&line), None, "{line}");
        let threads = line["threads"].as_array().unwrap();
        let places: Vec<_> = threads.iter().map(|t| (&t["process"], &t["thread"])).collect();
        assert_eq!(places, [(&0.into(), &0.into()), (&1.into(), &0.into())], "{line}");
        let all = |name: &str| threads.iter().map(|t| t[name].as_f64().unwrap()).sum::<f64>();
        assert!(all("tasks") > 10.0 && all("busy_seconds") > 0.0, "{line}");
        assert!(threads.iter().all(|t| t["idle_seconds"].as_f64() >= Some(0.0)), "{line}");
    }
    assert!(error.contains("5 edges, process 1: "), "{error}");
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
    let killed = stage.address(2);
    processes[2].signal("-KILL");
    let _ = processes.remove(2);
    for process in processes {
        let (code, out, error) = ended(&process.ends_within(30));
        assert_eq!((code, &*out), (Some(3), ""), "{error}");
        let message = format!("process 2 ({killed}) is lost: the work is not finished");
        assert!(error.contains(&message), "{error}");
        assert!(error.contains("with the same --journal"), "{error}");
        assert_eq!(error.lines().filter(|line| line.contains("lost")).count(), 1, "{error}");
    }
    let before = recorded();

    // A journal that is corrupt, or of another check, is refused.
    let right = fs::read_to_string(&journal).unwrap();
    let corrupt = right.replacen("\"starts\":", "\"starts\":1", 1);
    let foreign = command.replace("--algorithm folding", "--algorithm algorithm1");
    for (text, command, cause) in [
        (&corrupt, &command, "line 2: the journal is corrupt"),
        (&right, &foreign, "this is the journal of another check"),
    ] {
        stage.use_processes(2);
        fs::write(&journal, text).unwrap();
        let refused = stage.run(command);
        assert_eq!([refused[0].0, refused[1].0], [Some(2), Some(3)], "{refused:?}");
        assert!(refused[0].2.contains(cause), "{}", refused[0].2);
    }

    stage.use_processes(2);
    let (code, out, error) = &stage.run(&command)[0];
    assert_eq!(*code, Some(0), "{error}");
    let finished = format!("{} units of the work finished before", grouped(before as u128 - 1));
    assert!(error.contains(&finished), "{before}: {error}");
    let one = alone(&format!("{LONG} --json")).1;
    assert_eq!(lines_of(out, "size"), lines_of(&one, "size"));
    // One process reads the same journal.
    assert_eq!(alone(&command).1, one);
}

#[test]
fn if_a_process_ends_the_others_end_and_process_0_prints_what_it_has() {
    let stage = Stage::new("first", 2);
    let journal = stage.path("journal");
    let mut processes = stage.start(&format!("{LONG} --journal {journal}"));
    let journal = Path::new(&journal).join("7-edges.journal");
    let recorded = || fs::read_to_string(&journal).map_or(0, |text| text.lines().count());
    until("some units are recorded", 60, || recorded() > 10);
    processes[0].signal("-KILL");
    let (code, _, error) = ended(&processes.remove(1).ends_within(30));
    let message = format!("the connection to process 0 ({}) is lost", stage.address(0));
    assert!(code == Some(3) && error.contains(&message), "{error}");
    // As soon as a size is printed, the work of the next one is listed; later, it is done.
    for (interrupted, later) in [(0, 0), (1, 0), (0, 500), (1, 500)] {
        let stage = Stage::new(&format!("interrupted-{interrupted}-{later}"), 2);
        let command = LONG.replace("--edges 7", "--edges 3..=7");
        let path = stage.folder.join("out");
        let mut first = stage.command(&command, 0);
        let first = Process::start(first.stdout(fs::File::create(&path).unwrap()));
        let processes = [first, stage.start_one(&command, 1)];
        let printed = || fs::read_to_string(&path).unwrap();
        let six = "    6      9,436       110,410       0";
        until("six edges are checked", 60, || printed().contains(six));
        sleep(Duration::from_millis(later));
        processes[interrupted].signal("-INT");
        let all = processes.map(|process| ended(&process.ends_within(30)));
        assert_eq!([all[0].0, all[1].0], [Some(3), Some(3)], "{all:?}");
        assert_eq!(printed().contains("interrupted"), interrupted == 0, "{}", printed());
        assert!(all[1 - interrupted].2.contains("is lost"), "{all:?}");
    }
}

#[test]
fn processes_that_do_other_work_are_refused() {
    let stage = Stage::new("other", 2);
    let both = [stage.start_one("check --edges 4", 0), stage.start_one("check --edges 5", 1)];
    let [first, second] = both.map(|process| ended(&process.ends_within(20)));
    assert_eq!([first.0, second.0], [Some(2), Some(2)], "{first:?} {second:?}");
    let expected = "does other work: the number of edges is 5..=5 there, and 4..=4 here";
    assert!(first.2.contains(expected), "{first:?}");
}

#[test]
fn a_process_waits_for_the_others_and_ignores_strangers() {
    let stage = Stage::new("stranger", 2);
    let first = stage.start_one("check --edges 3", 0);
    let call = |process| {
        let mut stranger = None;
        until("a process listens", 20, || {
            stranger = TcpStream::connect(stage.address(process)).ok();
            stranger.is_some()
        });
        stranger.unwrap()
    };
    let mut stranger = call(0);
    stranger.write_all(b"GET / HTTP/1.1\r\n\r\n").unwrap();
    sleep(Duration::from_millis(200));
    for process in [stage.start_one("check --edges 3", 1), first] {
        let (code, _, error) = ended(&process.ends_within(30));
        assert_eq!(code, Some(0), "{error}");
    }
    // Ctrl-C ends the wait.
    let waiting = stage.start_one("check --edges 3", 1);
    drop(call(1));
    waiting.signal("-INT");
    assert_eq!(waiting.ends_within(30).status.code(), Some(3));
}

#[test]
fn bad_hosts_and_options_are_refused() {
    let stage = Stage::new("hosts", 2);
    let path = stage.path("hosts.txt");
    for (hosts, options, cause) in [
        ("127.0.0.1\n", "--process 0", "line 1: `127.0.0.1` is not an address"),
        ("a:1\nb:1\n", "--process 2", "--process: "),
        ("", "--process 0", "there is no address"),
        // Not an address of this machine.
        ("192.0.2.1:7700\nb:1\n", "--process 0", "cannot listen at this address"),
        ("", "--process 0 --shard 1/2", "cannot be used with"),
        ("", "--process 0 --choices all", "cannot be used with"),
        ("", "--process 0 --estimate", "cannot be used with"),
        ("", "--process 0 --from worlds/petersen.toml", "cannot be used with"),
    ] {
        fs::write(&path, hosts).unwrap();
        let (code, _, error) = alone(&format!("check --hosts {path} {options}"));
        assert!(code == Some(2) && error.contains(cause), "{options}: {error}");
    }
    assert_eq!(alone("check --edges 2 --process 1").0, Some(2));
}
