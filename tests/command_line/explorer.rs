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

use super::{folder, objects, read_world, run, stderr, stdout, stdout_of};
use crate::schema::misfit;

/// Whether a program is installed. Without it a test prints a message and is skipped, unless
/// `TOPOSLAM_EXPLORERS=required`.
fn has(program: &str) -> bool {
    let found = Command::new(program).arg("--version").output().is_ok_and(|o| o.status.success());
    let required = env::var("TOPOSLAM_EXPLORERS").is_ok_and(|wish| wish == "required");
    assert!(found || !required, "there is no {program}");
    if !found {
        eprintln!("skipped: there is no {program}");
    }
    found
}

/// A shell script as the command of an explorer.
fn script(folder: &Path, name: &str, text: &str) -> String {
    let file = folder.join(name).with_extension("sh");
    fs::write(&file, text).unwrap();
    format!("sh {}", file.display())
}

/// An explorer that always answers the same.
fn always(folder: &Path, name: &str, answer: &str) -> String {
    script(folder, name, &format!("while read line; do echo '{answer}'; done\n"))
}

/// The exit code and the lines of a check.
fn check(explorer: &str, options: &[&str]) -> (i32, Vec<Value>) {
    let output = run([&["check", "--json", "--explorer", explorer], options].concat());
    assert_ne!(output.status.code(), Some(2), "{}", stderr(&output));
    (output.status.code().unwrap(), objects(&stdout(&output)))
}

/// The explorer in C that maps every world, compiled once.
fn compiled() -> Option<&'static str> {
    static PROGRAM: LazyLock<Option<String>> = LazyLock::new(|| compile("explorer"));
    PROGRAM.as_deref()
}

/// An example in C, compiled.
fn compile(name: &str) -> Option<String> {
    if !has("cc") {
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
    let python = has("python3").then(|| "python3 docs/protocol/explorer.py".to_owned());
    python.into_iter().chain(compiled().map(str::to_owned)).collect()
}

#[test]
fn the_examples_map_every_start_with_up_to_4_edges() {
    for explorer in examples() {
        let (code, lines) = check(&explorer, &["--edges", "1..=4"]);
        assert_eq!(code, 0, "{lines:?}");
        let numbers = |key: &str| -> Vec<_> {
            lines.iter().map(|line| line[key].as_u64().unwrap()).collect()
        };
        assert_eq!(numbers("worlds"), [2, 5, 20, 107]);
        assert_eq!(numbers("mapped"), [2, 10, 74, 706]);
        // By the second implementation in Python.
        assert_eq!(numbers("certificate_total"), [2, 22, 266, 3625]);
        for (line, edges) in lines.iter().zip([1.0, 2.0, 3.0, 4.0]) {
            let ratio = line["ratio"].as_f64().unwrap();
            assert!(ratio >= 1.0 && ratio <= edges, "{line}");
            assert_eq!(line["holds"], true);
        }
    }
}

#[test]
fn the_examples_map_the_worlds_of_the_repository_and_write_the_worst_start() {
    let folder = folder("explorer_worlds");
    for (number, explorer) in examples().iter().enumerate() {
        let worst = folder.join(format!("{number}.toml"));
        let from = ["--from", "worlds/petersen.toml", "--worst", worst.to_str().unwrap()];
        let (code, lines) = check(explorer, &from);
        let of_algorithm = &objects(&stdout_of([&["check", "--json"], &from[..2]].concat()))[0];
        for key in ["starts", "mapped", "certificate_total"] {
            assert_eq!((code, &lines[0][key]), (0, &of_algorithm[key]), "{lines:?}");
        }
        assert_eq!(read_world(&worst).graph.edge_count(), 15);
    }
}

/// Of the simple worlds with up to 3 edges, each chain has one start at an end; both ends are alike.
#[test]
fn the_shortest_example_maps_chains_from_their_ends() {
    let Some(hallway) = compile("hallway") else { return };
    let options = ["--class", "simple", "--edges", "1..=3", "--keep-going"];
    let (code, lines) = check(&hallway, &options);
    assert_eq!(code, 1, "{lines:?}");
    let numbers = |key: &str| -> Vec<_> { lines.iter().map(|line| line[key].as_u64()).collect() };
    assert_eq!(numbers("starts"), [1, 2, 6].map(Some));
    assert_eq!(numbers("mapped"), [Some(1); 3]);
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
    let folder = folder("explorer_lines");
    for (number, explorer) in examples().iter().enumerate() {
        let [read, written] =
            ["read", "written"].map(|name| folder.join(format!("{name}-{number}")));
        let text =
            format!("tee -a {} | {explorer} | tee -a {}\n", read.display(), written.display());
        let (code, _) = check(&script(&folder, "tee", &text), &["--edges", "1..=2"]);
        assert_eq!(code, 0);
        for (file, schema) in [(read, "explorer/percept"), (written, "explorer/answer")] {
            let text = fs::read_to_string(&file).unwrap();
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
    let folder = folder("explorer_failures");
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
        let (code, lines) = check(&always(&folder, cause, answer), &["--edges", "1..=2"]);
        assert_eq!((code, lines.len()), (1, 1), "{cause}: {lines:?}");
        let (line, failure) = (&lines[0], &lines[0]["failure"]);
        assert_eq!(failure["cause"], cause, "{line}");
        assert_eq!(failure["message"], format!("The explorer {message}"), "{line}");
        assert_eq!((&failure["moves"], &line["failed"]), (&json!(0), &json!(2)), "{line}");
        assert_eq!(failure["world"]["doors"], json!({"v0": ["e0", "e0"]}), "{line}");
        assert_eq!((&line["holds"], &line["limit"]), (&json!(false), &Value::Null));
    }
    // The step: the second move of the only start with a chain is wrong.
    let chain = "read line; echo '{\"door\":0}'; read line; echo '{\"door\":1}'; read line\n\
                 echo '{\"door\":1}'; read line\n";
    let from = ["--from", "worlds/chain-5.toml"];
    let (_, lines) = check(&script(&folder, "chain", chain), &from);
    let failure = &lines[0]["failure"];
    assert_eq!(failure["cause"], "ended");
    assert_eq!(failure["message"], "The explorer ended with exit code 0");
    assert_eq!((&failure["moves"], &failure["last_actions"]), (&json!(3), &json!([0, 1, 1])));
}

/// From an end of a chain with two edges, the explorer goes to the middle and back: as many moves as the
/// certificate has. It never sees the other end.
#[test]
fn a_walk_that_is_long_enough_may_still_be_a_guess() {
    let folder = folder("explorer_guess");
    let text = "while read line; do case $line in\n\
                *'\"degree\":1'*) echo '{\"door\":0}'; read line; echo '{\"door\":0}'; read line\n\
                echo '{\"map\":[[[1,0]],[[0,0],[2,0]],[[1,1]]],\"pose\":[0,0]}';;\n\
                *) echo '{\"give_up\":\"\"}';; esac; done\n";
    let options = ["--class", "simple", "--edges", "2"];
    let (code, lines) = check(&script(&folder, "back", text), &options);
    assert_eq!((code, &lines[0]["mapped"]), (1, &json!(0)), "{lines:?}");
    assert_eq!(lines[0]["causes"], json!({"gave-up": 1, "guessed": 1}));
    // With an undirected marker it is not known whether it is one.
    let options = [&options[..], &["--marker", "undirected"]].concat();
    let (_, lines) = check(&script(&folder, "back", text), &options);
    assert_eq!(lines[0]["causes"], json!({"gave-up": 1}), "{lines:?}");
}

#[cfg(unix)]
#[test]
fn a_crash_is_reported_with_the_end_of_the_standard_error() {
    let folder = folder("explorer_crash");
    let crash = script(&folder, "exit", "read line; echo 'list index out of range' >&2; exit 3\n");
    let (code, lines) = check(&crash, &["--edges", "1"]);
    let failure = &lines[0]["failure"];
    assert_eq!((code, &failure["cause"]), (1, &json!("crashed")));
    assert_eq!(failure["message"], "The explorer ended with exit code 3");
    assert_eq!(failure["stderr"], "list index out of range");
    let text = stdout(&run(["check", "--edges", "1", "--explorer", &crash]));
    assert!(text.contains("standard error:\n    list index out of range\n"), "{text}");
    assert!(text.contains("\nfacing = \"e0:1\"\n") && text.contains("causes: crashed 2"), "{text}");
    let killed = script(&folder, "signal", "read line; kill -SEGV $$\n");
    let (_, lines) = check(&killed, &["--edges", "1"]);
    assert_eq!(lines[0]["failure"]["message"], "The explorer ended with signal SIGSEGV");
    let long = script(&folder, "long", "read line; exec yes | tr -d '\\n'\n");
    let (code, lines) = check(&long, &["--edges", "1"]);
    assert_eq!((code, &lines[0]["failure"]["cause"]), (1, &json!("line-too-long")));
}

/// A limit that was reached is no failure.
#[test]
fn a_time_out_and_too_many_moves_are_not_known() {
    let folder = folder("explorer_limits");
    let slow = script(&folder, "slow", "read line; sleep 600\n");
    let (code, lines) = check(&slow, &["--edges", "1..=2", "--timeout", "0.2", "--restarts", "1"]);
    let line = &lines[0];
    assert_eq!((code, lines.len(), &line["holds"]), (3, 1, &json!(false)), "{line}");
    assert_eq!(
        (&line["failed"], &line["unknown"], &line["starts"]),
        (&json!(0), &json!(1), &json!(1))
    );
    assert_eq!((&line["failure"], &line["stopped"]), (&Value::Null, &json!(true)));
    assert_eq!(
        line["limit"]["message"],
        "The explorer did not read a percept and answer it within 0.2 s"
    );
    let around = always(&folder, "around", "{\"door\":0}");
    let (code, lines) = check(&around, &["--edges", "1", "--max-moves", "5000"]);
    let (line, limit) = (&lines[0], &lines[0]["limit"]);
    assert_eq!(
        (code, &limit["cause"], &line["unknown"]),
        (3, &json!("max-moves"), &json!(2)),
        "{line}"
    );
    assert_eq!((&limit["moves"], &limit["last_actions"]), (&json!(5000), &json!(vec![0; 20])));
    // A failure on another start is one.
    let mixed = "while read line; do case $line in *2*) sleep 600;; *) echo hello;; esac; done\n";
    let mixed = script(&folder, "mixed", mixed);
    let (code, lines) = check(&mixed, &["--edges", "1", "--timeout", "2"]);
    assert_eq!((code, &lines[0]["failed"], &lines[0]["unknown"]), (1, &json!(1), &json!(1)));
    assert_eq!(lines[0]["causes"], json!({"not-json": 1, "timeout": 1}));
    let text = stdout(&run(["check", "--edges", "1", "--explorer", &around, "--max-moves", "9"]));
    assert!(text.contains("\nincomplete: 0 of 2 starts mapped correctly"), "{text}");
    let words: Vec<_> = text.split_whitespace().collect();
    let words = words.join(" ");
    assert!(words.contains(" After 9 moves, it did not end within 9 moves. "), "{text}");
}

/// A line that no percept asked for is not taken for the answer to the next percept.
#[cfg(unix)]
#[test]
fn two_lines_for_one_percept_are_a_failure() {
    let folder = folder("explorer_extra_lines");
    let twice = |name: &str, one: &str, other: &str| {
        let text = format!("while read line; do printf '%s\\n%s\\n' '{one}' '{other}'; done\n");
        script(&folder, name, &text)
    };
    let two = twice("two", "{\"door\":0}", "{\"door\":0}");
    let done = twice("done", "{\"map\":[[[1,0]],[[0,0]]],\"pose\":[0,0]}", "done");
    for explorer in [two, done, "yes '{\"door\":0}'".to_owned()] {
        let (code, lines) = check(&explorer, &["--edges", "1"]);
        assert_eq!((code, &lines[0]["causes"]), (1, &json!({"extra-line": 2})), "{explorer}");
    }
}

/// Starts are left out only if there are more.
#[cfg(unix)]
#[test]
fn the_last_start_of_a_size_is_not_followed_by_others() {
    let folder = folder("explorer_last");
    let crash = script(&folder, "exit", "read line; exit 3\n");
    // 2 edges have 10 starts.
    for (restarts, starts) in [("9", 9), ("10", 10)] {
        let (_, lines) = check(&crash, &["--edges", "2", "--restarts", restarts]);
        let line = &lines[0];
        assert_eq!((&line["starts"], &line["stopped"]), (&json!(starts), &json!(starts < 10)));
    }
}

/// Its answers come faster than the check looks whether it has to stop.
#[cfg(unix)]
#[test]
fn ctrl_c_stops_a_fast_explorer_and_prints_the_results() {
    let folder = folder("explorer_fast");
    let begun = folder.join("begun");
    let text =
        format!("while read line; do : > {}; echo '{{\"door\":0}}'; done\n", begun.display());
    let explorer = script(&folder, "fast", &text);
    let mut command = super::toposlam();
    command.args(["check", "--json", "--edges", "1", "--max-moves", "1000000000"]);
    let command = command.args(["--explorer", &explorer]);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    while !begun.exists() {
        thread::sleep(Duration::from_millis(5));
    }
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(killed.success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    assert_eq!(objects(&stdout(&output))[0]["interrupted"], true);
}

/// What an explorer started is ended with it, also if the explorer ends by itself.
#[cfg(unix)]
#[test]
fn no_process_outlives_an_explorer_that_ended() {
    let folder = folder("explorer_left");
    let left = folder.join("left");
    let text = format!("sleep 600 > /dev/null 2>&1 &\necho $! >> {}\nexit 1\n", left.display());
    let (code, lines) = check(&script(&folder, "wrap", &text), &["--edges", "1"]);
    assert_eq!((code, &lines[0]["failed"]), (1, &json!(2)));
    let started = fs::read_to_string(&left).unwrap();
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

/// With every marker the certificate is unknown, so a map at once can be right.
#[test]
fn a_start_that_was_mapped_without_a_move_can_be_the_worst() {
    let folder = folder("explorer_no_move");
    let explorer = always(&folder, "at_once", "{\"map\":[[[1,0]],[[0,0]]],\"pose\":[0,0]}");
    let worst = folder.join("worst.toml");
    let options = ["--marker", "undirected", "--class", "simple", "--edges", "1", "--worst"];
    let options = [&options[..], &[worst.to_str().unwrap()]].concat();
    let (code, lines) = check(&explorer, &options);
    assert_eq!((code, &lines[0]["mapped"], &lines[0]["moves_max"]), (0, &json!(1), &json!(0)));
    assert!(worst.exists());
}

/// The explorer remembers its earlier runs, and ends its process on every 50th.
#[test]
fn the_result_does_not_depend_on_the_number_of_processes() {
    let folder = folder("explorer_processes");
    let text = "n=0\nwhile read line; do n=$((n + 1))\n\
                if [ $((n % 50)) = 0 ]; then echo '{\"door\":99}'; else echo '{\"give_up\":\"no\"}'; fi\n\
                done\n";
    let explorer = script(&folder, "some", text);
    let printed = |threads: &str, restarts: &str| {
        let options = ["--edges", "3..=4", "--keep-going", "--threads", threads];
        let options = [&options[..], &["--restarts", restarts]].concat();
        let (code, lines) = check(&explorer, &options);
        assert_eq!(code, 1);
        lines
    };
    for restarts in ["7", "1000"] {
        let one = printed("1", restarts);
        assert_eq!(one, printed("4", restarts));
        assert_eq!(one[0]["causes"], json!({"gave-up": 73, "no-such-door": 1}));
        assert_eq!(one[1]["stopped"], restarts == "7", "{}", one[1]);
        let ended = one[1]["causes"]["no-such-door"].as_u64().unwrap();
        // Of three batches with 256 and a few starts, the first two have five such runs each.
        assert_eq!(ended, if restarts == "7" { 7 } else { 13 });
        let all = one[1]["starts"] == 706;
        assert_eq!(all, restarts == "1000", "{}", one[1]);
    }
}

#[test]
fn the_first_start_that_was_not_mapped_is_written() {
    let folder = folder("explorer_written");
    let explorer = always(&folder, "wrong", "{\"map\":[[[1,0]],[[0,0]]],\"pose\":[0,0]}");
    for ending in ["toml", "json", "svg", "png", "dot"] {
        let file = folder.join("failed").with_extension(ending);
        let options = ["--edges", "1", "--class", "simple", "--failed", file.to_str().unwrap()];
        let (code, lines) = check(&explorer, &options);
        assert_eq!((code, &lines[0]["failure"]["cause"]), (1, &json!("guessed")));
        assert!(fs::metadata(&file).unwrap().len() > 50);
    }
    let world = read_world(&folder.join("failed.toml"));
    assert_eq!((world.graph.edge_count(), world.graph.vertex_count()), (1, 2));
    let file = folder.join("failed.toml");
    stdout_of(["explore", file.to_str().unwrap()]);
}

/// A robot with each kind of marker perceives it at the start.
#[test]
fn an_explorer_may_have_any_kind_of_marker() {
    let folder = folder("explorer_markers");
    let explorer = script(
        &folder,
        "tell",
        "while read line; do echo \"{\\\"give_up\\\":\\\"$(echo $line | tr -d '\\\"')\\\"}\"; done\n",
    );
    let seen = [
        ("none", "null"),
        ("undirected", "1"),
        ("directional", "0"),
        ("undirected-edge", "passed"),
        ("directed-edge", "against"),
        ("two-identical", "2"),
        ("two-distinct", "both"),
        ("movable", "1"),
    ];
    for (marker, seen) in seen {
        let options = ["--edges", "1", "--class", "multigraph", "--marker", marker];
        let (_, lines) = check(&explorer, &options);
        let message = format!("The explorer gave up: {{percept:{{degree:2,marker:{seen}}}}}");
        assert_eq!(lines[0]["failure"]["message"], message, "{marker}");
        assert_eq!(lines[0].get("ratio").is_some(), marker == "directional");
    }
    // The movable marker is carried over the edge, and the robot comes back for nothing.
    let text = "while read a; do echo '{\"action\":\"pick-up\"}'; read b; echo '{\"door\":0}'; read c\n\
                echo '{\"action\":\"drop\"}'; read d\n\
                echo \"{\\\"give_up\\\":\\\"$(echo $a$b$c$d | tr -cd '01nul,')\\\"}\"; done\n";
    let explorer = script(&folder, "carry", text);
    let (_, lines) = check(&explorer, &["--edges", "1", "--marker", "movable"]);
    let message = &lines[0]["failure"]["message"];
    assert_eq!(message, "The explorer gave up: 1,11,null1,null1,1", "{}", lines[0]);
    assert_eq!(lines[0]["failure"]["last_actions"], json!(["pick-up", 0, "drop"]));
}

#[test]
fn bad_usage_of_an_explorer_is_an_error() {
    let cases: [(&[&str], &str); 9] = [
        (&["--explorer", "./missing-explorer"], "./missing-explorer cannot be started: "),
        (&["--explorer", ""], "--explorer: `` names no program"),
        (&["--explorer", "sh 'x"], "has a quote that is not closed"),
        (&["--explorer", "cat", "--algorithm", "folding"], "cannot be used with"),
        (&["--explorer", "cat", "--shard", "1/2"], "cannot be used with"),
        (&["--explorer", "cat", "--timeout", "0"], "write a number of seconds above 0"),
        (&["--explorer", "cat", "--failed", "x.bmp"], "the name must end in .toml"),
        (&["--timeout", "3"], "--explorer <COMMAND>"),
        (&["--marker", "undirected"], "no algorithm maps with `undirected`"),
    ];
    for (options, cause) in cases {
        let output = run([&["check", "--edges", "1"], options].concat());
        assert_eq!(output.status.code(), Some(2), "{options:?}");
        assert!(stderr(&output).contains(cause), "{options:?}: {}", stderr(&output));
    }
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
    let folder = folder("explorer_ctrl_c");
    let time = format!("{}", 1_000_000 + std::process::id());
    // The process starts another one, which does not read.
    let explorer = script(&folder, "wait", &format!("sleep {time}\nsleep {time}\n"));
    let wait_for = |wish: bool| {
        let begun = Instant::now();
        while is_running(&time) != wish {
            assert!(begun.elapsed() < Duration::from_secs(20), "running: {}", !wish);
            thread::sleep(Duration::from_millis(10));
        }
    };
    for signals in [1, 2] {
        let mut command = super::toposlam();
        command.args([
            "check",
            "--json",
            "--edges",
            "3",
            "--timeout",
            "600",
            "--explorer",
            &explorer,
        ]);
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
            let lines = objects(&stdout(&output));
            assert_eq!(
                (&lines[0]["interrupted"], &lines[0]["holds"]),
                (&json!(true), &json!(false))
            );
            assert_eq!((&lines[0]["failed"], &lines[0]["unknown"]), (&json!(0), &json!(0)));
        }
    }
}
