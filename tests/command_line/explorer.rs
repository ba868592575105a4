//! `check --explorer`: an explorer in any language, its processes, and the examples of docs/protocol.md. Failures and
//! limits are in `tests/facts/explorer.txt`.

use std::{
    env, fs,
    process::{Command, Stdio},
    sync::LazyLock,
};

use serde_json::{Value, json};

use super::{Scratch, folder, has, numbers, objects, read_world, stderr, stdout};
use crate::{output::Schema, process::until, read, repository};

/// Whether a program is installed. Without it a test prints a message and is skipped, unless
/// `TOPOSLAM_EXPLORERS=required`.
fn is_installed(program: &str) -> bool {
    let found = Command::new(program).arg("--version").output().is_ok_and(|o| o.status.success());
    let required = env::var("TOPOSLAM_EXPLORERS").is_ok_and(|wish| wish == "required");
    assert!(found || !required, "there is no {program}");
    if !found {
        eprintln!("skipped: there is no {program}");
    }
    found
}

impl Scratch {
    /// A shell script as the command of an explorer.
    fn script(&self, text: &str) -> String {
        let file = format!("{}.sh", self.written().len());
        self.write(&file, text);
        format!("sh {file}")
    }

    /// The objects that a check prints, which ends with this exit code.
    fn check(&self, explorer: &str, options: &str, code: i32) -> Vec<Value> {
        self.lines(&format!("check --explorer \"{explorer}\" {options}"), code)
    }
}

/// The explorer in C that maps every world, compiled once.
fn compiled() -> Option<&'static str> {
    static PROGRAM: LazyLock<Option<String>> = LazyLock::new(|| compile("explorer"));
    PROGRAM.as_deref()
}

/// An example in C, compiled.
fn compile(name: &str) -> Option<String> {
    if !is_installed("cc") {
        return None;
    }
    let program = folder(&format!("{name}_in_c")).join(name);
    let source = repository(&format!("docs/protocol/{name}.c"));
    let options = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-O1", "-o"];
    let output = Command::new("cc").args(options).arg(&program).arg(source).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    Some(program.to_str().unwrap().to_owned())
}

/// The commands of the examples whose language is installed.
fn examples() -> Vec<String> {
    let python = is_installed("python3").then(|| "python3 docs/protocol/explorer.py".to_owned());
    python.into_iter().chain(compiled().map(str::to_owned)).collect()
}

#[test]
fn the_examples_map_every_start_with_up_to_4_edges() {
    let scratch = Scratch::new("explorer_examples");
    for explorer in examples() {
        let lines = scratch.check(&explorer, "--edges 1..=4", 0);
        assert_eq!(numbers(&lines, "worlds"), [2, 5, 20, 107]);
        assert_eq!(numbers(&lines, "mapped"), [2, 10, 74, 706]);
        // By the second implementation in Python.
        assert_eq!(numbers(&lines, "certificate_total"), [2, 22, 266, 3625]);
        for (line, edges) in lines.iter().zip([1.0, 2.0, 3.0, 4.0]) {
            let ratio = line["ratio"].as_f64().unwrap();
            assert!((1.0..=edges).contains(&ratio) && line["holds"] == true, "{line}");
        }
        let from = "--from worlds/petersen.toml";
        let lines = scratch.check(&explorer, &format!("{from} --worst worst.toml"), 0);
        let of_algorithm = scratch.last(&format!("check {from}"), 0);
        for key in ["starts", "mapped", "certificate_total"] {
            assert_eq!(lines[0][key], of_algorithm[key], "{lines:?}");
        }
        assert_eq!(read_world(&scratch.path("worst.toml")).graph.edge_count(), 15);
    }
    // Of the simple worlds with up to 3 edges, each chain has one start at an end; both ends are alike.
    let Some(hallway) = compile("hallway") else { return };
    let lines = scratch.check(&hallway, "--class simple --edges 1..=3 --keep-going", 1);
    assert_eq!(numbers(&lines, "starts"), [1, 2, 6]);
    assert_eq!(numbers(&lines, "mapped"), [1; 3]);
    assert!(lines.iter().skip(1).all(|line| line["failure"]["cause"] == "gave-up"), "{lines:?}");
}

#[test]
fn the_page_of_the_protocol_describes_each_cause() {
    let page = read("docs/protocol.md");
    let schema: Value = serde_json::from_str(&read("docs/schema/check.json")).unwrap();
    let causes = schema["$defs"]["unmapped"]["properties"]["cause"]["enum"].as_array().unwrap();
    for cause in causes {
        let cell = format!("| `{}` |", cause.as_str().unwrap());
        assert!(page.contains(&cell), "{cell}");
    }
}

#[test]
fn the_lines_of_a_conversation_fit_their_schemas() {
    let scratch = Scratch::new("explorer_lines");
    for (number, explorer) in examples().iter().enumerate() {
        let [read, written] = ["read", "written"].map(|name| format!("{name}-{number}"));
        let text = format!("tee -a {read} | {explorer} | tee -a {written}\n");
        scratch.check(&scratch.script(&text), "--edges 1..=2", 0);
        for (file, schema) in [(read, "explorer/percept"), (written, "explorer/answer")] {
            let (text, schema) = (scratch.text(&file), Schema::read(schema));
            assert_eq!(text.lines().count(), 1 + 1 + 1 + 1 + 22 + 7 + 10, "{text}");
            for line in text.lines() {
                assert_eq!(schema.misfit(&serde_json::from_str(line).unwrap()), None, "{line}");
            }
        }
    }
    for wrong in [
        json!({ "door": -1 }),
        json!({ "door": 1, "give_up": "" }),
        json!({ "map": [[[1]]], "pose": [0, 0] }),
    ] {
        assert!(Schema::read("explorer/answer").misfit(&wrong).is_some(), "{wrong}");
    }
}

/// Whether a process of this machine runs that is not a zombie.
#[cfg(target_os = "linux")]
fn is_running(process: &str) -> bool {
    let state = fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    !(state.is_empty() || state.contains(") Z "))
}

/// What an explorer started is ended with it, also if the explorer ends by itself.
#[cfg(target_os = "linux")]
#[test]
fn no_process_outlives_an_explorer_that_ended() {
    let scratch = Scratch::new("explorer_left");
    let wrap = "sleep 600 > /dev/null 2>&1 &\necho $! >> left\nexit 1\n";
    let lines = scratch.check(&scratch.script(wrap), "--edges 1", 1);
    assert_eq!(lines[0]["failed"], 2);
    let started = scratch.text("left");
    assert_eq!(started.lines().count(), 2);
    for process in started.lines() {
        // A process ends some time after the signal.
        until("the process ends", 20, || !is_running(process));
    }
}

/// One explorer answers faster than the check looks whether it has to stop; the other one starts a process and does
/// not read.
#[cfg(target_os = "linux")]
#[test]
fn ctrl_c_stops_at_once_and_leaves_no_process() {
    let fast = "while read line; do : > begun; echo '{\"door\":0}'; done\n";
    let waiting = "sleep 600 &\necho $! >> left; : > begun; sleep 600\n";
    for (number, (text, signals)) in [(fast, 1), (waiting, 1), (waiting, 2)].iter().enumerate() {
        let scratch = Scratch::new(&format!("explorer_ctrl_c_{number}"));
        let explorer = scratch.script(text);
        let options = "--json --edges 3 --limit 600s --limit 1000000000moves";
        let mut command = scratch.command(&format!("check {options} --explorer '{explorer}'"));
        let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        until("the explorer begins", 20, || scratch.path("begun").exists());
        for _ in 0..*signals {
            // The second signal may come too late.
            let _ = Command::new("kill").args(["-INT", &child.id().to_string()]).output();
        }
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
        if *signals == 1 {
            let fields = json!({ "interrupted": true, "holds": false, "failed": 0 });
            has(&objects(&stdout(&output))[0], &fields, text);
        }
        if *text == waiting {
            let left = scratch.text("left");
            until("its processes end", 20, || !left.lines().any(is_running));
        }
    }
}
