//! `check --explorer`: an explorer in any language, its failures and limits, and the examples of
//! docs/protocol.md.

use std::{
    env, fs,
    path::Path,
    process::{Command, Stdio},
    sync::LazyLock,
    thread,
    time::{Duration, Instant},
};

use serde_json::{Value, json};

use super::{Scratch, folder, has, numbers, objects, read_world, stderr, stdout};
use crate::schema::misfit;

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

    /// An explorer that always answers the same.
    fn always(&self, answer: &str) -> String {
        self.script(&format!("while read line; do echo '{answer}'; done\n"))
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
    let source = format!("docs/protocol/{name}.c");
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join(source);
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
}

/// Of the simple worlds with up to 3 edges, each chain has one start at an end; both ends are alike.
#[test]
fn the_shortest_example_maps_chains_from_their_ends() {
    let Some(hallway) = compile("hallway") else { return };
    let options = "--class simple --edges 1..=3 --keep-going";
    let lines = Scratch::new("explorer_hallway").check(&hallway, options, 1);
    assert_eq!(numbers(&lines, "starts"), [1, 2, 6]);
    assert_eq!(numbers(&lines, "mapped"), [1; 3]);
    assert!(lines.iter().skip(1).all(|line| line["failure"]["cause"] == "gave-up"), "{lines:?}");
}

/// The page shows the examples as they are.
#[test]
fn the_page_of_the_protocol_shows_its_examples() {
    let read = |path: &str| {
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs").join(path)).unwrap()
    };
    let page = read("protocol.md");
    for (language, file) in [("python", "protocol/explorer.py"), ("c", "protocol/hallway.c")] {
        let block = format!("```{language}\n{}```\n", read(file));
        assert!(page.contains(&block), "{file} is not in docs/protocol.md");
    }
    // Each cause is described.
    let schema: Value = serde_json::from_str(&read("schema/check.json")).unwrap();
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
            let text = scratch.text(&file);
            assert_eq!(text.lines().count(), 1 + 1 + 1 + 1 + 22 + 7 + 10, "{text}");
            for line in text.lines() {
                let line: Value = serde_json::from_str(line).unwrap();
                assert_eq!(misfit(schema, &line), None, "{line}");
            }
        }
    }
    for wrong in
        ["{\"door\":-1}", "{\"door\":1,\"give_up\":\"\"}", "{\"map\":[[[1]]],\"pose\":[0,0]}"]
    {
        let line: Value = serde_json::from_str(wrong).unwrap();
        assert!(misfit("explorer/answer", &line).is_some(), "{wrong}");
    }
}

/// Each way to fail has its own cause. The first start is a loop at a vertex with 2 doors, the second an
/// edge with a vertex at each end.
#[test]
fn each_failure_has_its_cause_its_start_and_its_step() {
    let scratch = Scratch::new("explorer_failures");
    let answers = [
        ("no-such-door", "{\"door\":7}", "took door 7 at a vertex with 2 doors, 0 to 1"),
        (
            "no-such-marker",
            "{\"action\":\"drop\"}",
            "dropped a marker that the robot does not carry",
        ),
        ("not-json", "hello", "wrote `hello`, which is not JSON: expected value at column 1"),
        (
            "not-an-answer",
            "{\"door\":\"1\"}",
            "wrote `{\"door\":\"1\"}`, which is not an answer: \"1\" is not the number of a door",
        ),
        ("gave-up", "{\"give_up\":\"I am lost\"}", "gave up: I am lost"),
        (
            "missing-edge",
            "{\"map\":[[[1,0],null],[[0,0]]],\"pose\":[0,0]}",
            "returned a map in which an edge is missing: dart v0.1 leads nowhere",
        ),
        (
            "invalid-map",
            "{\"map\":[[[0,0]]],\"pose\":[0,0]}",
            "returned a map that is not an embedded graph: dart v0.0 leads to itself",
        ),
        (
            "wrong-map",
            "{\"map\":[[[1,0],[1,1]],[[0,0],[0,1]]],\"pose\":[0,0]}",
            "returned a map that is not isomorphic to the world; from the start by 0, the map has 2 \
             doors, and the world 2 doors, marker along door 1",
        ),
        (
            "wrong-pose",
            "{\"map\":[[[0,1],[0,0]]],\"pose\":[0,1]}",
            "returned the pose v0.1; the robot came in by dart v0.0 of the map",
        ),
        (
            "guessed",
            "{\"map\":[[[0,1],[0,0]]],\"pose\":[0,0]}",
            "guessed: it returned the right map after 0 moves, but there is another world in which it \
             makes the same walk, and returns the same map",
        ),
    ];
    for (cause, answer, message) in answers {
        let lines = scratch.check(&scratch.always(answer), "--edges 1..=2", 1);
        has(
            &lines.into(),
            &json!([{
                "failure.cause": cause, "failure.message": format!("The explorer {message}"),
                "failure.moves": 0, "failure.world.doors": {"v0": ["e0", "e0"]}, "failed": 2,
                "holds": false, "limit": null,
            }]),
            cause,
        );
    }
    // The step: the second move of the only start with a chain is wrong.
    let chain = "read line; echo '{\"door\":0}'; read line; echo '{\"door\":1}'; read line\n\
                 echo '{\"door\":1}'; read line\n";
    let lines = scratch.check(&scratch.script(chain), "--from worlds/chain-5.toml", 1);
    has(
        &lines[0]["failure"],
        &json!({
            "cause": "ended", "message": "The explorer ended with exit code 0", "moves": 3,
            "last_actions": [0, 1, 1],
        }),
        chain,
    );
}

/// From an end of a chain with two edges, the explorer goes to the middle and back: as many moves as the
/// certificate has. It never sees the other end.
#[test]
fn a_walk_that_is_long_enough_may_still_be_a_guess() {
    let scratch = Scratch::new("explorer_guess");
    let text = "while read line; do case $line in\n\
                *'\"degree\":1'*) echo '{\"door\":0}'; read line; echo '{\"door\":0}'; read line\n\
                echo '{\"map\":[[[1,0]],[[0,0],[2,0]],[[1,1]]],\"pose\":[0,0]}';;\n\
                *) echo '{\"give_up\":\"\"}';; esac; done\n";
    let back = scratch.script(text);
    let options = "--class simple --edges 2";
    let lines = scratch.check(&back, options, 1);
    has(&lines[0], &json!({ "mapped": 0, "causes": {"gave-up": 1, "guessed": 1} }), text);
    // With an undirected marker it is not known whether it is one.
    let lines = scratch.check(&back, &format!("{options} --marker undirected"), 1);
    assert_eq!(lines[0]["causes"], json!({"gave-up": 1}), "{lines:?}");
}

#[cfg(unix)]
#[test]
fn a_crash_is_reported_with_the_end_of_the_standard_error() {
    let scratch = Scratch::new("explorer_crash");
    for (text, message) in [
        ("read line; echo 'list index out of range' >&2; exit 3\n", "exit code 3"),
        ("read line; kill -SEGV $$\n", "signal SIGSEGV"),
    ] {
        let lines = scratch.check(&scratch.script(text), "--edges 1", 1);
        let message = format!("The explorer ended with {message}");
        has(&lines[0]["failure"], &json!({ "cause": "crashed", "message": message }), text);
        let found = &lines[0]["failure"]["stderr"];
        assert!(!text.contains("list") || found == "list index out of range", "{found}");
    }
    let long = scratch.script("read line; exec yes | tr -d '\\n'\n");
    let lines = scratch.check(&long, "--edges 1", 1);
    assert_eq!(lines[0]["failure"]["cause"], "line-too-long");
}

/// A limit that was reached is no failure.
#[test]
fn a_time_out_and_too_many_moves_are_not_known() {
    let scratch = Scratch::new("explorer_limits");
    let slow = scratch.script("read line; sleep 600\n");
    let lines = scratch.check(&slow, "--edges 1..=2 --timeout 0.2 --restarts 1", 3);
    has(
        &lines.into(),
        &json!([{
            "holds": false, "failed": 0, "unknown": 1, "starts": 1, "failure": null, "stopped": true,
            "limit.message": "The explorer did not read a percept and answer it within 0.2 s",
        }]),
        &slow,
    );
    let around = scratch.always("{\"door\":0}");
    let lines = scratch.check(&around, "--edges 1 --max-moves 5000", 3);
    has(
        &lines[0],
        &json!({
            "unknown": 2, "limit.cause": "max-moves", "limit.moves": 5000,
            "limit.last_actions": vec![0; 20],
        }),
        &around,
    );
    // A failure on another start is one.
    let mixed = "while read line; do case $line in *2*) sleep 600;; *) echo hello;; esac; done\n";
    let lines = scratch.check(&scratch.script(mixed), "--edges 1 --timeout 2", 1);
    has(
        &lines[0],
        &json!({
            "failed": 1, "unknown": 1, "causes": {"not-json": 1, "timeout": 1},
        }),
        mixed,
    );
}

/// A line that no percept asked for is not taken for the answer to the next percept.
#[cfg(unix)]
#[test]
fn two_lines_for_one_percept_are_a_failure() {
    let scratch = Scratch::new("explorer_extra_lines");
    let twice = |one: &str, other: &str| {
        let print = format!("printf '%s\\n%s\\n' '{one}' '{other}'");
        scratch.script(&format!("while read line; do {print}; done\n"))
    };
    let two = twice("{\"door\":0}", "{\"door\":0}");
    let done = twice("{\"map\":[[[1,0]],[[0,0]]],\"pose\":[0,0]}", "done");
    for explorer in [two, done, scratch.script("yes '{\"door\":0}'")] {
        let lines = scratch.check(&explorer, "--edges 1", 1);
        assert_eq!(lines[0]["causes"], json!({"extra-line": 2}), "{explorer}");
    }
}

/// Starts are left out only if there are more.
#[cfg(unix)]
#[test]
fn the_last_start_of_a_size_is_not_followed_by_others() {
    let scratch = Scratch::new("explorer_last");
    let crash = scratch.script("read line; exit 3\n");
    // 2 edges have 10 starts.
    for restarts in [9, 10] {
        let lines = scratch.check(&crash, &format!("--edges 2 --restarts {restarts}"), 1);
        has(&lines[0], &json!({ "starts": restarts, "stopped": restarts < 10 }), &crash);
    }
}

/// Its answers come faster than the check looks whether it has to stop.
#[cfg(unix)]
#[test]
fn ctrl_c_stops_a_fast_explorer_and_prints_the_results() {
    let scratch = Scratch::new("explorer_fast");
    let fast = scratch.script("while read line; do : > begun; echo '{\"door\":0}'; done\n");
    let line = format!("check --json --edges 1 --max-moves 1000000000 --explorer '{fast}'");
    let mut command = scratch.command(&line);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    while !scratch.path("begun").exists() {
        thread::sleep(Duration::from_millis(5));
    }
    super::interrupt(&child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    assert_eq!(objects(&stdout(&output))[0]["interrupted"], true);
}

/// What an explorer started is ended with it, also if the explorer ends by itself.
#[cfg(unix)]
#[test]
fn no_process_outlives_an_explorer_that_ended() {
    let scratch = Scratch::new("explorer_left");
    let wrap = "sleep 600 > /dev/null 2>&1 &\necho $! >> left\nexit 1\n";
    let lines = scratch.check(&scratch.script(wrap), "--edges 1", 1);
    assert_eq!(lines[0]["failed"], 2);
    let started = scratch.text("left");
    assert_eq!(started.lines().count(), 2);
    for process in started.lines() {
        let is_running = || {
            let state = fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
            !(state.is_empty() || state.contains(") Z "))
        };
        // A process ends some time after the signal.
        let begun = Instant::now();
        while is_running() && begun.elapsed() < Duration::from_secs(20) {
            thread::sleep(Duration::from_millis(5));
        }
        assert!(!is_running(), "{process}");
    }
}

/// The explorer remembers its earlier runs, and ends its process on every 50th.
#[test]
fn the_result_does_not_depend_on_the_number_of_processes() {
    let scratch = Scratch::new("explorer_processes");
    let text = "n=0\nwhile read line; do n=$((n + 1))\n\
                if [ $((n % 50)) = 0 ]; then echo '{\"door\":99}'; else echo '{\"give_up\":\"no\"}'; fi\n\
                done\n";
    let some = scratch.script(text);
    // Of three batches with 256 and a few starts, the first two have five such runs each.
    for (restarts, ended) in [(7, 7), (1000, 13)] {
        let [one, four] = [1, 4].map(|threads| {
            let options = format!("--keep-going --threads {threads} --restarts {restarts}");
            scratch.check(&some, &format!("--edges 3..=4 {options}"), 1)
        });
        assert_eq!(one, four);
        has(
            &one.clone().into(),
            &json!([
                { "causes": {"gave-up": 73, "no-such-door": 1} },
                { "stopped": restarts == 7, "causes.no-such-door": ended },
            ]),
            text,
        );
        assert_eq!(one[1]["starts"] == 706, restarts == 1000, "{}", one[1]);
    }
}

#[test]
fn the_first_start_that_was_not_mapped_is_printed_and_the_worst_is_written() {
    let scratch = Scratch::new("explorer_written");
    let at_once = scratch.always("{\"map\":[[[1,0]],[[0,0]]],\"pose\":[0,0]}");
    let options = "--edges 1 --class simple";
    let lines = scratch.check(&at_once, options, 1);
    assert_eq!(lines[0]["failure"]["cause"], "guessed");
    scratch.write("failed.json", lines[0]["failure"]["world"].to_string());
    let world = read_world(&scratch.path("failed.json"));
    assert_eq!((world.graph.edge_count(), world.graph.vertex_count()), (1, 2));
    scratch.out("explore failed.json", 0);
    // With an undirected marker the certificate is unknown, so a map at once can be right, and the worst.
    let undirected = format!("{options} --marker undirected --worst worst.toml");
    let lines = scratch.check(&at_once, &undirected, 0);
    has(&lines[0], &json!({ "mapped": 1, "moves_max": 0 }), &undirected);
    assert!(scratch.path("worst.toml").exists());
}

/// A robot with each kind of marker perceives it at the start.
#[test]
fn an_explorer_may_have_any_kind_of_marker() {
    let scratch = Scratch::new("explorer_markers");
    let tell = scratch.script(
        "while read line; do echo \"{\\\"give_up\\\":\\\"$(echo $line | tr -d '\\\"')\\\"}\"; done\n",
    );
    for (marker, seen) in [
        ("none", "null"),
        ("undirected", "1"),
        ("directional", "0"),
        ("undirected-edge", "passed"),
        ("directed-edge", "against"),
        ("two-identical", "2"),
        ("two-distinct", "both"),
        ("movable", "1"),
    ] {
        let options = format!("--edges 1 --class multigraph --marker {marker}");
        let lines = scratch.check(&tell, &options, 1);
        let message = format!("The explorer gave up: {{percept:{{degree:2,marker:{seen}}}}}");
        assert_eq!(lines[0]["failure"]["message"], message, "{marker}");
        assert_eq!(lines[0].get("ratio").is_some(), marker == "directional");
    }
    // The movable marker is carried over the edge, and the robot comes back for nothing.
    let text = "while read a; do echo '{\"action\":\"pick-up\"}'; read b; echo '{\"door\":0}'; read c\n\
                echo '{\"action\":\"drop\"}'; read d\n\
                echo \"{\\\"give_up\\\":\\\"$(echo $a$b$c$d | tr -cd '01nul,')\\\"}\"; done\n";
    let lines = scratch.check(&scratch.script(text), "--edges 1 --marker movable", 1);
    has(
        &lines[0]["failure"],
        &json!({
            "message": "The explorer gave up: 1,11,null1,null1,1", "last_actions": ["pick-up", 0, "drop"],
        }),
        text,
    );
}

/// Whether a process on this machine has this argument.
#[cfg(target_os = "linux")]
fn is_running(argument: &str) -> bool {
    let processes = fs::read_dir("/proc").unwrap().map(|entry| entry.unwrap().path());
    let arguments = processes.filter_map(|process| fs::read(process.join("cmdline")).ok());
    arguments
        .map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
        .any(|text| text.split('\0').any(|word| word == argument))
}

#[cfg(target_os = "linux")]
#[test]
fn ctrl_c_stops_at_once_and_leaves_no_process() {
    let scratch = Scratch::new("explorer_ctrl_c");
    let time = format!("{}", 1_000_000 + std::process::id());
    // The process starts another one, which does not read.
    let wait = scratch.script(&format!("sleep {time}\nsleep {time}\n"));
    let wait_for = |wish: bool| {
        let begun = Instant::now();
        while is_running(&time) != wish {
            assert!(begun.elapsed() < Duration::from_secs(20), "running: {}", !wish);
            thread::sleep(Duration::from_millis(10));
        }
    };
    for signals in [1, 2] {
        let line = format!("check --json --edges 3 --timeout 600 --explorer '{wait}'");
        let mut command = scratch.command(&line);
        let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        wait_for(true);
        for _ in 0..signals {
            let mut kill = Command::new("kill");
            // The second signal may come too late.
            let _ = kill.args(["-INT", &child.id().to_string()]).output().unwrap();
        }
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
        wait_for(false);
        if signals == 1 {
            has(
                &objects(&stdout(&output))[0],
                &json!({
                    "interrupted": true, "holds": false, "failed": 0, "unknown": 0,
                }),
                "Ctrl-C",
            );
        }
    }
}
