//! Traversals and whole runs: small parts of long measurements.

use std::{ffi::OsStr, fs};

use toposlam_logs::{
    entries::Content,
    reader::Log,
    record::{EventKind, RunEnding},
    topic_map::TopicMap,
    world_hash,
};

use super::{folder, objects, read_world, stdout_of};

// paper: exp.simulated
#[test]
fn whole_runs_are_right_with_the_moves_of_the_specification() {
    let text = stdout_of("runs --plans 12 --starts 2 --json".split(' '));
    let lines = objects(&text);
    let last = lines.last().unwrap();
    assert_eq!((&last["kind"], &last["holds"]), (&"runs".into(), &true.into()), "{text}");
    let runs: Vec<_> = lines.iter().filter(|line| line["kind"] == "run").collect();
    assert!(runs.len() > 25 && runs.iter().all(|run| run["moves"] == run["explore_moves"]));
}

#[test]
fn whole_runs_are_right_with_the_folding_explorer_in_fewer_moves() {
    let measured =
        |options: &str| objects(&stdout_of(format!("runs --plans 5 --json{options}").split(' ')));
    let lines = measured(" --algorithm folding");
    let runs: Vec<_> = lines.iter().filter(|line| line["kind"] == "run").collect();
    assert!(runs.len() > 10 && runs.iter().all(|run| run["right"] == true));
    let last = lines.last().unwrap();
    assert_eq!(last["algorithm"], "folding");
    let total = |name: &str| runs.iter().filter_map(|run| run[name].as_u64()).sum::<u64>();
    assert_eq!(last["moves_total"], total("moves"));
    assert_eq!(last["certificate_total"], total("certificate_moves"));
    assert!(runs.iter().all(|run| run["moves"].as_u64() >= run["certificate_moves"].as_u64()));
    assert_eq!(lines, measured(""), "it is the default");
    let other = measured(" --algorithm algorithm1");
    let other = other.iter().filter_map(|line| line["moves"].as_u64()).sum::<u64>();
    assert!(total("moves") < other);
}

#[test]
#[ignore = "a long sweep, for `.ci/run --all`"]
fn runs_by_image_are_right_with_both_algorithms() {
    for algorithm in ["algorithm1", "folding"] {
        let words =
            "runs --images --look tiles --runs 1 --json --plan worlds/shape-8.toml --algorithm";
        let lines = objects(&stdout_of(words.split(' ').chain([algorithm])));
        let run = lines.iter().find(|line| line["kind"] == "run").unwrap();
        assert!(run["right"] == true && run["frames"].as_u64() > Some(10), "{run}");
        assert_eq!(run["moves"], run["explore_moves"], "{run}");
    }
}

#[test]
fn runs_that_gave_up_are_written_with_the_reason_and_the_command_that_repeats_each() {
    let written = folder("failed");
    let words = "runs --plans 6 --starts 2 --faults --json --seed 7 --failed".split(' ');
    let lines = objects(&stdout_of(words.map(OsStr::new).chain([written.as_os_str()])));
    let gave_up: Vec<_> = lines.iter().filter(|line| line["gave_up"] == true).collect();
    let failed = objects(&fs::read_to_string(written.join("failed.jsonl")).unwrap());
    assert!(gave_up.len() >= 5 && failed.len() == gave_up.len(), "{} failed", failed.len());
    for (line, run) in failed.iter().zip(gave_up) {
        assert_eq!((&line["run"], &line["seed"]), (&run["run"], &7.into()));
        assert_eq!(line["verdict"], "gave up");
        let reason = line["reason"].as_str().unwrap();
        assert_eq!(run["ending"], format!("the robot gave up: {reason}"));
        let [log, world] = ["log", "world"].map(|file| written.join(line[file].as_str().unwrap()));
        let fault = &run["faults"][0];
        let fault = format!("--fault {}@{}", fault["fault"].as_str().unwrap(), fault["picture"]);
        let command = line["command"].as_str().unwrap();
        assert!(command.contains(&fault) && command.contains(world.to_str().unwrap()), "{command}");
        let world = read_world(&world);
        let log = Log::open(&log).unwrap();
        let topics = TopicMap::from_log(&log).unwrap().bind(&log).unwrap();
        let mut entries = log.entries(&topics).map(|entry| entry.unwrap().content);
        let Some(Content::Run(head)) = entries.next() else { panic!("{line}: no head") };
        assert_eq!((&head.world, &head.command), (&world.name, &command.to_owned()));
        assert_eq!(head.world_hash, world_hash(&world.graph, world.start.unwrap()));
        let Some(Content::Event(EventKind::End(end))) = entries.last() else { panic!("{line}") };
        assert_eq!(
            (end.moves, end.ending),
            (run["moves"].as_u64().unwrap(), RunEnding::GaveUp(reason.to_owned()))
        );
    }
}
