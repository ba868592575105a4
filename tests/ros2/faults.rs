//! `toposlam drive --ros2` and a robot that Cyclone DDS publishes: other code, another language, its own clock. Its
//! messages are lost, late and wrong, and it does not do what it should.

use std::{process::Command, thread::sleep, time::Duration};

use super::{
    Stage,
    output::{stderr, stdout},
    process::{Process, until},
};

const PLAN: &str = "worlds/laser/long-8.toml";

/// How many times faster the robot's time is than the real time.
const FAST: &str = "16";

/// A command that the robot got, and the real time in seconds since the last good odometry or scan before it.
struct RobotCommand {
    speed: f64,
    turning: f64,
    gap: f64,
}

impl RobotCommand {
    fn moves(&self) -> bool {
        self.speed != 0.0 || self.turning != 0.0
    }
}

impl Stage {
    /// The robot of another program; `None` where it cannot run.
    fn robot(&self, more: &[&str], output: &str) -> Option<Process> {
        self.robot_in(PLAN, more, output)
    }

    fn robot_in(&self, plan: &str, more: &[&str], output: &str) -> Option<Process> {
        let plan = format!("{}/{plan}", env!("CARGO_MANIFEST_DIR"));
        self.python("robot.py", &[&[plan.as_str()], more].concat(), output)
    }

    /// Waits until it publishes.
    fn ready(&self, output: &str) {
        until("the robot is there", 200, || !self.lines(output, "begin").is_empty());
    }

    /// The commands that it got, by what it printed.
    fn commands(&self, output: &str) -> Vec<RobotCommand> {
        let lines = self.lines(output, "command ");
        let numbers = lines.iter().map(|line| {
            line.split(' ').skip(1).map(|word| word.parse().unwrap()).collect::<Vec<f64>>()
        });
        numbers.map(|n| RobotCommand { speed: n[1], turning: n[2], gap: n[3] }).collect()
    }

    /// Checks what holds whatever happens, and that the last command is to stop.
    fn check_commands(&self, output: &str, patience: f64) {
        let commands = self.check_motions(output, patience);
        let name = self.folder.display();
        assert!(commands.last().is_some_and(|last| !last.moves()), "{name}: it does not stand");
    }

    /// Checks what holds whatever happens: no motion is commanded later than this after the last good message, and no speed
    /// is reached in one step.
    fn check_motions(&self, output: &str, patience: f64) -> Vec<RobotCommand> {
        let commands = self.commands(output);
        let name = self.folder.display();
        for command in commands.iter().filter(|command| command.moves()) {
            assert!(command.gap <= patience, "{name}: a motion after {} s", command.gap);
        }
        for pair in commands.windows(2) {
            let stops = pair[0].moves() && !pair[1].moves();
            // The wheels are stopped a little later: the time of a message on a busy machine.
            assert!(
                !stops || pair[1].gap <= patience + 0.6,
                "{name}: no stop for {} s",
                pair[1].gap
            );
            let [before, after] = [pair[0].speed, pair[1].speed];
            assert!(after - before <= 0.16, "{name}: from {before} to {after} m/s in one step");
        }
        commands
    }

    /// The way that the robot went, and its least distance from a wall, in metres.
    fn went(&self, output: &str) -> [f64; 2] {
        let lines = self.lines(output, "end ");
        let numbers: Vec<f64> =
            lines[0].split(' ').skip(1).map(|word| word.parse().unwrap()).collect();
        assert!(numbers[3].abs() < 0.01, "it does not stand: {numbers:?}");
        [numbers[1], numbers[2]]
    }
}

/// Messages are lost, late, doubled and in the wrong order, and the robot's computer restarts. No packet leaves the machine,
/// though it has a network.
#[test]
fn a_robot_of_another_program_maps_its_building_although_messages_fail() {
    let stage = Stage::new("other-robot");
    let state = stage.path("state");
    let robot = ["--speed", FAST, "--scans", "5", "--state", &state];
    let faults =
        ["lost@50+150", "late@250+100", "doubled@400+50", "reordered@500+50", "silent@600+10"];
    let faults: Vec<&str> = faults.iter().flat_map(|fault| ["--fault", fault]).collect();
    let Some(first) = stage.robot(&[&robot[..], &faults].concat(), "first") else { return };
    stage.ready("first");
    let drive = stage.drive(&["--patience", "5"]);
    until("the robot is on its way", 400, || stage.commands("first").len() > 1500);
    first.signal("-KILL");
    first.ends();
    let second = stage.robot(&robot, "second").unwrap();
    let output = drive.ends_within(600);
    second.signal("-INT");
    assert!(second.ends_within(20).status.success());
    assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
    assert_eq!(stage.network.as_ref().map_or(0, |network| network.sent()), 0, "packets leave");
    // The first one has the faults, and is switched off in a motion or between two.
    stage.check_motions("first", 5.5);
    stage.check_commands("second", 5.5);
    assert!(stage.went("second")[1] > 0.5, "it stays away from walls");
    let map = stage.path("map.toml");
    let compared = stage.out(&["compare", PLAN, &map, "--json"]);
    assert!(compared.contains("\"isomorphic\":true"), "{compared}");
    assert!(compared.contains("\"distinguishable\":false"), "{compared}");
    let log = stage.path("run.mcap");
    let judged = stage.out(&["conform", &log, "--world", PLAN]);
    assert!(judged.contains("conforms"), "{judged}");
    // PyPI's rosbags reads every message.
    let script = "import sys, pathlib\nfrom rosbags.highlevel import AnyReader\n\
         with AnyReader([pathlib.Path(sys.argv[1])]) as log:\n    \
         print(sum(log.deserialize(raw, c.msgtype) is not None for c, _, raw in log.messages()))";
    let read = Command::new("python3").args(["-c", script, &log]).output().unwrap();
    assert!(stdout(&read).trim().parse::<u32>().unwrap() > 1000, "{}", stderr(&read));
}

/// Messages are lost, and the robot's computer restarts in the middle.
#[test]
fn the_corridors_of_a_real_building_are_mapped_by_a_robot_of_another_program() {
    let stage = Stage::new("real-corridors");
    let state = stage.path("state");
    let robot = ["--corridors", "--speed", FAST, "--scans", "5", "--state", &state];
    let plan = "worlds/laser/seattle.toml";
    let faulty = [&robot[..], &["--fault", "lost@50+150"]].concat();
    let Some(first) = stage.robot_in(plan, &faulty, "first") else { return };
    stage.ready("first");
    let drive = stage.drive(&["--corridors", "--patience", "5"]);
    until("the robot is on its way", 400, || stage.commands("first").len() > 1500);
    first.signal("-KILL");
    first.ends();
    let second = stage.robot_in(plan, &robot, "second").unwrap();
    let output = drive.ends_within(600);
    second.signal("-INT");
    assert!(second.ends_within(20).status.success());
    assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
    let world = "worlds/real/seattle.toml";
    let compared = stage.out(&["compare", world, &stage.path("map.toml"), "--json"]);
    assert!(compared.contains("\"isomorphic\":true"), "{compared}");
    let judged = stage.out(&["conform", &stage.path("run.mcap"), "--world", world]);
    assert!(judged.contains("conforms"), "{judged}");
}

/// A run that has a fault, and how it ends.
struct FaultyRun {
    name: &'static str,
    fault: &'static str,
    /// What the end of the log says; the run goes on otherwise.
    end: Option<&'static str>,
}

/// The longest time without a message in seconds, and as an option.
const PATIENCE: (f64, &str) = (2.0, "2");

#[test]
fn after_a_fault_the_robot_stands_and_the_log_says_why_and_a_short_one_does_not_end_the_run() {
    let ends = |name, fault, end| FaultyRun { name, fault, end: Some(end) };
    let goes_on = |name, fault| FaultyRun { name, fault, end: None };
    let runs = [
        ends("silent", "silent@2+10", "no message on /odom for 2 s"),
        ends("no-scans", "no-scans@2+99", "no message on /scan for 2 s"),
        ends("wrong-frame", "wrong-frame@2+99", "the messages on /scan are in the frame `camera`"),
        ends("nan", "nan@2+99", "have another type, or numbers that are not finite"),
        ends("back", "back@2+99", "went back by"),
        ends("stuck", "stuck@0+99", "the robot does not move"),
        goes_on("short", "silent@2+1"),
        goes_on("forward", "forward@2+9999"),
    ];
    check_faults("faults", &runs);
}

#[test]
fn after_messages_that_cannot_be_right_the_robot_stands_and_the_log_says_why() {
    let ends = |name, fault, end| FaultyRun { name, fault, end: Some(end) };
    let runs = [
        ends("jump", "jump@2+99", "the odometry on /odom jumped: it went 5.0"),
        ends("frozen", "frozen@2+99", "all messages on /odom have the same stamp"),
        ends("scan-clock", "scan-clock@2+99", "the stamps on /scan and on /odom differ by "),
    ];
    check_faults("wrong-messages", &runs);
}

/// Drives robots with these faults at the same time.
fn check_faults(name: &str, runs: &[FaultyRun]) {
    let stage = Stage::new(name);
    let robots = runs.iter().map(|run| {
        let stage = stage.beside(run.name);
        let robot = stage.robot(&["--fault", run.fault], "robot")?;
        Some((run, stage, robot))
    });
    let Some(robots) = robots.collect::<Option<Vec<_>>>() else { return };
    let drives = robots.into_iter().map(|(run, stage, robot)| {
        stage.ready("robot");
        let drive = stage.drive(&["--patience", PATIENCE.1]);
        (run, stage, robot, drive)
    });
    let started: Vec<_> = drives.collect();
    for (run, stage, robot, drive) in started {
        let name = run.name;
        if run.end.is_none() {
            until("the run goes on", 200, || stage.commands("robot").len() > 80);
            drive.signal("-TERM");
        }
        let output = drive.ends_within(200);
        robot.signal("-INT");
        assert!(robot.ends_within(20).status.success(), "{name}");
        let code = if run.end.is_some() { 1 } else { 3 };
        assert_eq!(output.status.code(), Some(code), "{name}: {}", stderr(&output));
        let end = run.end.unwrap_or("stopped\0");
        assert!(stage.end().contains(end), "{name}: {}", stage.end());
        // One period, and the time of a message.
        stage.check_commands("robot", PATIENCE.0 + 0.4);
        assert!(stage.went("robot")[0] > 0.02, "{name}");
    }
}

/// It is 0.8 m ahead when the robot sees it, which is as wide as the SuperScout.
#[test]
fn the_robot_stops_before_an_obstacle_that_appears_while_it_moves() {
    let stage = Stage::new("obstacle");
    let Some(robot) = stage.robot(&["--fault", "obstacle@2+99"], "robot") else { return };
    stage.ready("robot");
    let drive = stage.drive(&[]);
    until("the obstacle appears", 200, || !stage.lines("robot", "obstacle").is_empty());
    sleep(Duration::from_secs(12));
    drive.signal("-INT");
    drive.ends_within(30);
    robot.signal("-INT");
    assert!(robot.ends_within(20).status.success());
    let [way, nearest] = stage.went("robot");
    stage.check_commands("robot", 2.4);
    // The robot's circle has a radius of 0.205 m, and keeps a clearance of 0.2 m.
    assert!(way > 0.1 && (0.36..0.6).contains(&nearest), "{way} m, {nearest} m");
}

/// A program that is killed cannot stop the wheels. The robot's own watchdog must do that.
#[test]
fn the_watchdog_of_the_base_stops_it_when_the_program_is_killed() {
    let stage = Stage::new("killed");
    let Some(robot) = stage.robot(&[], "robot") else { return };
    stage.ready("robot");
    let drive = stage.drive(&[]);
    let goes = || stage.commands("robot").last().is_some_and(|last| last.speed > 0.1);
    until("the robot goes ahead", 200, goes);
    drive.signal("-KILL");
    drive.ends();
    let commands = stage.commands("robot");
    assert!(commands.last().unwrap().moves(), "the last command is a motion");
    sleep(Duration::from_secs(2));
    robot.signal("-INT");
    assert!(robot.ends_within(20).status.success());
    // It stands at the end.
    stage.went("robot");
}
