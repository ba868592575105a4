//! `toposlam simulate --log`: what is in a log, by readers in Python that share nothing with its writer.

use std::{fs, path::Path, process::Command};

use mcap::{MessageStream, Summary, read::Options};
use serde_json::{Value, json};
use toposlam_logs::world_hash;

use super::{Scratch, has, read_world, stderr};

const SIMULATE: &str = "simulate worlds/shape-6.toml --seed 3 --log";

/// What Python reads in a log; `None`, and why, where it has no readers of logs.
fn by_python(log: &Path) -> Option<Value> {
    let python = |arguments: &[&str]| {
        let mut command = Command::new("python3");
        command.current_dir(env!("CARGO_MANIFEST_DIR")).arg("-B").args(arguments).output()
    };
    let readers = "import mcap, mcap_ros2, rosbags";
    if !python(&["-c", readers]).is_ok_and(|output| output.status.success()) {
        let required = std::env::var("TOPOSLAM_PYTHON_LOGS").is_ok_and(|value| value == "required");
        assert!(!required, "there is no python3 with rosbags, mcap and mcap-ros2-support");
        eprintln!("skipped: there is no python3 with rosbags, mcap and mcap-ros2-support");
        return None;
    }
    let output = python(&["tests/oracle/read_log.py", log.to_str().unwrap()]).unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

/// What Python must find in the log of any run on shape 6 that maps it.
fn agree(report: &Value, line: &Value) {
    assert_eq!(report["in_order"], true);
    let count = |topic: &str| report["counts"][topic].as_u64().unwrap_or_default();
    let moves = line["moves"].as_u64().unwrap();
    assert_eq!(count("/toposlam/scene"), line["frames"].as_u64().unwrap());
    assert_eq!((count("/toposlam/door"), count("/toposlam/percept")), (moves, moves + 1));
    assert_eq!((count("/toposlam/run"), count("/toposlam/end")), (1, 1));
    assert_eq!(count("/odom"), count("/tf"));
    // At least four samples a second of driving, which is most of the time.
    let seconds = line["simulated_seconds"].as_f64().unwrap();
    assert!(
        count("/odom") as f64 > 3.0 * seconds && count("/odom") > count("/cmd_vel"),
        "{report}"
    );
    assert_eq!(report["run"]["start"], line["start"]);
    assert_eq!(
        (&report["run"]["seed"], &report["run"]["marker"]),
        (&3.into(), &"directional".into())
    );
    let end = json!({"moves": moves, "ending": "mapped", "cause": ""});
    assert_eq!(report["end"], end);
    // The degrees of an L, a T, three Ls and a dead end, as the robot comes upon them.
    let degrees = json!([2, 3, 2, 2, 2, 1]);
    assert_eq!(report["map"]["degrees"], degrees);
    let opposite: Vec<usize> = serde_json::from_value(report["map"]["opposite"].clone()).unwrap();
    assert!((0..12).all(|dart| opposite[opposite[dart]] == dart), "{opposite:?}");
    let percepts = report["percepts"].as_array().unwrap();
    assert_eq!(percepts[0], json!([0, 2, 0, [true, false, false, true]]));
    assert!(percepts.iter().enumerate().all(|(moves, percept)| percept[0] == moves));
    assert!(percepts.iter().all(|percept| {
        let doors = percept[3].as_array().unwrap().iter().filter(|&door| door == true);
        percept[1] == doors.count()
    }));
    assert_eq!(report["frames"], json!(["odom", "base_link"]));
    assert_eq!(report["first_odometry"], json!([0, 0.0, 0.0]));
    let last = report["last_odometry"][0].as_f64().unwrap() / 1e9;
    assert!((last - seconds).abs() < 1e-3, "{last} {seconds}");
    let turn: Vec<f64> = serde_json::from_value(report["orientation"].clone()).unwrap();
    assert!((turn.iter().map(|part| part * part).sum::<f64>() - 1.0).abs() < 1e-9, "{turn:?}");
    assert_eq!(report["last_cmd_vel"], json!([0.0, 0.0]));
    for (kind, same) in report["standard_types_are_those_of_ros_2"].as_object().unwrap() {
        assert_eq!(same, true, "{kind}");
    }
}

// paper: exp.simulated
#[test]
fn readers_of_ros_2_find_in_a_log_what_the_run_was() {
    let scratch = Scratch::new("log");
    let line = scratch.last(&format!("{SIMULATE} one.mcap --by-scene"), 0);
    scratch.out(&format!("{SIMULATE} other.mcap --by-scene"), 0);
    assert_eq!(scratch.bytes("one.mcap"), scratch.bytes("other.mcap"), "the same bytes each time");
    if let Some(report) = by_python(&scratch.path("one.mcap")) {
        agree(&report, &line);
        let command =
            "toposlam simulate worlds/shape-6.toml --algorithm folding --by-scene --seed 3";
        has(
            &report,
            &json!({
                "images": {}, "run.calibration": "", "run.command": command,
            }),
            "one.mcap",
        );
    }
}

// paper: exp.simulated
#[test]
fn a_log_contains_the_original_images() {
    let scratch = Scratch::new("log_images");
    let line = scratch.last(&format!("{SIMULATE} run.mcap --effect none --html run.html"), 0);
    if let Some(report) = by_python(&scratch.path("run.mcap")) {
        agree(&report, &line);
        // Without effects the camera gives PNG; the first is taken at once.
        for (topic, format) in
            [("/camera/image/compressed", "png"), ("/camera/annotated/compressed", "jpeg")]
        {
            assert_eq!(report["counts"][topic], line["frames"]);
            assert_eq!(report["images"][topic], json!([format, 0, 640, 480]));
        }
        assert!(report["run"]["calibration"].as_str().unwrap().starts_with("[camera]\nkind = "));
    }
}

#[test]
fn a_log_has_its_head_in_a_chunk_of_its_own_and_the_hash_of_its_start() {
    let scratch = Scratch::new("log_head");
    scratch.out(&format!("{SIMULATE} run.mcap --by-scene"), 0);
    let file = scratch.bytes("run.mcap");
    let summary = Summary::read(&file).unwrap().unwrap();
    // The other chunks are of ten seconds each. A log whose writer was killed is read to its last whole chunk.
    assert!(summary.chunk_indexes.len() > 20);
    let head = &summary.chunk_indexes[0];
    let end = (head.chunk_start_offset + head.chunk_length) as usize;
    let read = MessageStream::new_with_options(&file[..end], Options::IgnoreEndMagic.into());
    let topics = read.unwrap().map_while(Result::ok).map(|message| message.channel.topic.clone());
    assert_eq!(topics.collect::<Vec<_>>(), ["/toposlam/run"]);
    let world = read_world(&scratch.path("worlds/shape-6.toml"));
    let metadata = mcap::read::metadata(&file, &summary.metadata_indexes[0]).unwrap().metadata;
    assert_eq!(metadata["world_hash"], world_hash(&world.graph, world.start.unwrap()));
}

#[cfg(unix)]
#[test]
fn the_log_of_an_interrupted_run_ends_with_the_interruption() {
    use std::process::Stdio;

    let scratch = Scratch::new("log_interrupted");
    let log = scratch.path("run.mcap");
    // Far too long to end by itself.
    let mut robot = scratch
        .command("simulate worlds/building-25.toml --start north-west:west-upper --log run.mcap");
    let mut robot = robot.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    // Its head is written when it sets out.
    while fs::metadata(&log).map_or(0, |file| file.len()) < 1000 {
        assert!(robot.try_wait().unwrap().is_none(), "it ended by itself");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    super::interrupt(&robot);
    assert_eq!(robot.wait().unwrap().code(), Some(3));
    let file = fs::read(&log).unwrap();
    assert!(Summary::read(&file).unwrap().is_some(), "the log is whole");
    let last = MessageStream::new(&file).unwrap().map(Result::unwrap).last().unwrap();
    assert_eq!(last.channel.topic, "/toposlam/end");
    assert!(String::from_utf8_lossy(&last.data).contains("stopped\0"));
}

/// A limit of the size of files stands for a full disk.
#[cfg(unix)]
#[test]
fn a_log_that_cannot_be_written_leaves_the_earlier_one_as_it_was() {
    let scratch = Scratch::new("log-full-disk");
    scratch.out("simulate worlds/shape-6.toml --by-scene --log run.mcap", 0);
    let [log, partial] = ["run.mcap", "run.partial.mcap"].map(|name| scratch.path(name));
    let before = fs::read(&log).unwrap();
    let program = env!("CARGO_BIN_EXE_toposlam");
    let plan = concat!(env!("CARGO_MANIFEST_DIR"), "/worlds/shape-8.toml");
    let call = format!(
        "trap '' XFSZ; ulimit -f 20; '{program}' simulate '{plan}' --by-scene --log '{}'",
        log.display()
    );
    let output = Command::new("sh").args(["-c", &call]).output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert!(error.contains("the earlier log is kept, and what was written is "), "{error}");
    assert_eq!(fs::read(&log).unwrap(), before);
    assert!(partial.is_file());
    // A complete log replaces it.
    scratch.out("simulate worlds/shape-8.toml --by-scene --log run.mcap", 0);
    assert_ne!(fs::read(&log).unwrap(), before);
    assert!(!partial.exists());
}
