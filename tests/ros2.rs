//! A robot behind the topics of ROS 2, over DDS: `toposlam drive --ros2` drives the simulated one of `toposlam simulate
//! --ros2`, and Cyclone DDS, another implementation, listens and publishes. Sections 2.5 and 6.
//!
//! Everything is on loopback, in a network of its own where there are rights for it. Where the Python package cyclonedds or
//! Fast DDS is not installed the tests that need it are skipped, with a message, unless `TOPOSLAM_ROS` is `required`.

#![cfg(all(feature = "ros2", unix))]
#![allow(clippy::unwrap_used, reason = "a test may panic")]

#[path = "ros1/camera_files.rs"]
mod camera_files;
#[path = "ros2/fastdds.rs"]
mod fastdds;
#[path = "ros2/faults.rs"]
mod faults;
#[path = "ros2/network.rs"]
mod network;
#[allow(dead_code, reason = "other programs use the rest")]
mod output;
mod process;

use std::{
    env, fs,
    net::{Ipv4Addr, TcpListener},
    path::{Path, PathBuf},
    process::{Command, Stdio},
    sync::{Arc, LazyLock},
    thread::sleep,
    time::{Duration, Instant},
};

use mcap::MessageStream;
use network::OwnNetwork;
use output::{stderr, stdout};
use process::{Process, until};

/// How many times faster the simulated time is than the real time.
const SPEED: &str = "12";

/// Cyclone DDS finds no others than those on loopback, by asking them one by one.
const CYCLONE: &str = "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\" \
     multicast=\"false\"/></Interfaces></General><Discovery><ParticipantIndex>auto</ParticipantIndex>\
     <Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery></Domain></CycloneDDS>";

/// Whether Python has Cyclone DDS. It must, if `TOPOSLAM_ROS` is `required`.
fn has_cyclone() -> bool {
    static HAS: LazyLock<bool> = LazyLock::new(|| {
        let has = Command::new("python3").args(["-c", "import cyclonedds"]).output().unwrap();
        if !has.status.success() {
            assert_ne!(env::var("TOPOSLAM_ROS").as_deref(), Ok("required"), "{}", stderr(&has));
            eprintln!("skipped: the Python package cyclonedds is not installed");
        }
        has.status.success()
    });
    *HAS
}

/// A folder and a domain for a test.
struct Stage {
    folder: PathBuf,
    domain: u16,
    /// Where its programs run, if not in the network of the machine.
    network: Option<Arc<OwnNetwork>>,
    /// A port of the domain, which DDS does not use. No other test has the domain meanwhile, of this run or another one.
    _port: TcpListener,
}

impl Stage {
    /// In a network of its own where there are rights, so that no other program is in its domain.
    fn new(name: &str) -> Self {
        Self::within(OwnNetwork::new(name).ok().map(Arc::new), name)
    }

    /// One of several at a time in the same network.
    fn beside(&self, name: &str) -> Self {
        Self::within(self.network.clone(), name)
    }

    fn within(network: Option<Arc<OwnNetwork>>, name: &str) -> Self {
        let free = (20..=100).find_map(|domain| {
            let port = TcpListener::bind((Ipv4Addr::LOCALHOST, 7400 + 250 * domain)).ok()?;
            Some((domain, port))
        });
        let (domain, port) = free.unwrap();
        let folder = output::folder(&format!("ros2-{name}"));
        Self { folder, domain, network, _port: port }
    }

    /// A program in the network of this test.
    fn command(&self, program: &str) -> Command {
        match &self.network {
            Some(network) => network.command(program),
            None => Command::new(program),
        }
    }

    fn path(&self, name: &str) -> String {
        self.folder.join(name).display().to_string()
    }

    fn toposlam(&self, arguments: &[&str]) -> Command {
        let mut command = self.command(env!("CARGO_BIN_EXE_toposlam"));
        command.current_dir(env!("CARGO_MANIFEST_DIR")).args(arguments).stdin(Stdio::null());
        command.env("ROS_DOMAIN_ID", self.domain.to_string());
        command
    }

    fn out(&self, arguments: &[&str]) -> String {
        let output = self.toposlam(arguments).output().unwrap();
        assert!(output.status.success(), "{arguments:?}: {}", stderr(&output));
        stdout(&output)
    }

    /// A simulated robot with a laser scanner in a building without clutter.
    fn simulate(&self, more: &[&str]) -> Process {
        fs::write(self.folder.join("plain.toml"), "furniture = 0\ndoors = 0\npeople = 0\n")
            .unwrap();
        let plain = self.path("plain.toml");
        let simulate = ["simulate", "worlds/shape-6.toml", "--seed", "3", "--ros2"];
        let seen = ["--speed", SPEED, "--sensor", "laser", "--scanner", &plain];
        let output = fs::File::create(self.folder.join("robot")).unwrap();
        let arguments = [&simulate[..], &seen, more].concat();
        Process::start(self.toposlam(&arguments).stdout(output))
    }

    fn drive(&self, more: &[&str]) -> Process {
        let [log, map] = [self.path("run.mcap"), self.path("map.toml")];
        let drive =
            ["drive", "--ros2", "--sensor", "laser", "--log", &log, "--map", &map, "--json"];
        let mut command = self.toposlam(&[&drive[..], more].concat());
        Process::start(command.stdout(Stdio::piped()).stderr(Stdio::piped()))
    }

    /// A program in Python that uses Cyclone DDS; `None` where that is not installed.
    fn python(&self, script: &str, arguments: &[&str], output: &str) -> Option<Process> {
        if !has_cyclone() {
            return None;
        }
        let mut command = self.script(script, arguments);
        Some(Process::start(command.stdout(fs::File::create(self.folder.join(output)).unwrap())))
    }

    fn peer(&self, verb: &str, what: &str) -> Option<Process> {
        self.python("peer.py", &[verb, what], "peer")
    }

    /// A script of Cyclone DDS.
    fn script(&self, name: &str, arguments: &[&str]) -> Command {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/ros2").join(name);
        let mut command = self.command("python3");
        command.arg(script).args(arguments).stdin(Stdio::null());
        command.env("ROS_DOMAIN_ID", self.domain.to_string()).env("CYCLONEDDS_URI", CYCLONE);
        command
    }

    /// The lines of a file that begin with a word.
    fn lines(&self, file: &str, word: &str) -> Vec<String> {
        let text = fs::read_to_string(self.folder.join(file)).unwrap_or_default();
        text.lines().filter(|line| line.starts_with(word)).map(str::to_owned).collect()
    }

    /// The last message of the log.
    fn end(&self) -> String {
        let log = fs::read(self.folder.join("run.mcap")).unwrap();
        let last = MessageStream::new(&log).unwrap().map(Result::unwrap).last().unwrap();
        assert_eq!(last.channel.topic, "/toposlam/end");
        String::from_utf8_lossy(&last.data).into_owned()
    }
}

/// To a robot in a network of corridors long-8 is two junctions with three corridors between them.
#[test]
fn corridors_are_mapped_by_laser_over_dds() {
    let stage = Stage::new("corridors");
    let simulate = ["simulate", "worlds/laser/long-8.toml", "--ros2", "--sensor", "laser"];
    let robot = ["--corridors", "--noise", "0.1", "--seed", "1", "--speed", SPEED];
    let command = &mut stage.toposlam(&[&simulate[..], &robot].concat());
    let robot = Process::start(command.stdout(Stdio::null()));
    let output = stage.drive(&["--corridors", "--patience", "20"]).ends_within(600);
    assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
    let map = stage.path("map.toml");
    let compared = stage.out(&["compare", "worlds/theta-plane.toml", &map, "--json"]);
    assert!(compared.contains("\"isomorphic\":true"), "{compared}");
    let log = stage.path("run.mcap");
    let judged = stage.out(&["conform", &log, "--world", "worlds/theta-plane.toml"]);
    assert!(judged.contains("conforms"), "{judged}");
    drop(robot);
}

/// The robot reads one of the types of commands; the driver finds out which.
#[test]
fn the_whole_of_shape_6_is_mapped_by_laser_over_dds() {
    let stage = Stage::new("mapped");
    let listener = stage.peer("listen", &stage.path("received"));
    let robot = stage.simulate(&[]);
    let begun = Instant::now();
    // Other tests run beside this one.
    let output = stage.drive(&["--patience", "20"]).ends_within(600);
    eprintln!("mapped in {:.0} s", begun.elapsed().as_secs_f64());
    assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
    let compared =
        stage.out(&["compare", "worlds/shape-6.toml", &stage.path("map.toml"), "--json"]);
    assert!(compared.contains("\"isomorphic\":true"), "{compared}");
    assert!(compared.contains("\"distinguishable\":false"), "{compared}");
    assert!(stage.end().contains("mapped\0"), "{}", stage.end());
    let judged = stage.out(&["conform", &stage.path("run.mcap"), "--world", "worlds/shape-6.toml"]);
    assert!(judged.contains("conforms"), "{judged}");
    robot.signal("-INT");
    assert!(robot.ends_within(20).status.success());
    if listener.is_some() {
        // Cyclone DDS has read the same topics; it writes the last message soon.
        sleep(Duration::from_secs(1));
        assert!(stage.lines("received", "/odom ").len() > 1000);
        assert!(stage.lines("received", "/scan 360 base_link").len() > 50);
        let wheels = stage.lines("received", "/cmd_vel");
        let speeds = |line: &String| -> Vec<f64> {
            line.split(' ').skip(1).map(|word| word.parse().unwrap()).collect()
        };
        assert_eq!(wheels.last().map(speeds), Some(vec![0.0, 0.0]));
        for wheels in wheels.iter().map(speeds) {
            assert!(wheels[0].abs() <= 0.2 + 1e-9 && wheels[1].abs() <= 0.3491, "{wheels:?}");
        }
    }
}

#[test]
fn a_robot_in_a_namespace_that_reads_stamped_commands_moves_and_stands_after_ctrl_c() {
    let stage = Stage::new("stamped");
    let space = ["--namespace", "robot1"];
    let listen = ["listen", &stage.path("received"), "/robot1", "TwistStamped"];
    let listener = stage.python("peer.py", &listen, "peer");
    let robot = stage.simulate(&[&space[..], &["--cmd-vel-type", "TwistStamped"]].concat());
    let drive = stage.drive(&[&space[..], &["--patience", "20"]].concat());
    until("the run begins", 60, || stage.folder.join("run.mcap").exists());
    // Time for a few moves.
    sleep(Duration::from_secs(5));
    drive.signal("-INT");
    // A second interrupt changes nothing.
    drive.signal("-INT");
    let output = drive.ends_within(30);
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    assert!(stage.end().contains("stopped\0"), "{}", stage.end());
    if listener.is_some() {
        let commands = stage.lines("received", "/cmd_vel");
        assert!(commands.iter().any(|line| line != STOP), "it moved: {commands:?}");
        assert_eq!(commands.last().map(String::as_str), Some(STOP));
        let odometry = || stage.lines("received", "/odom");
        let stood = odometry();
        sleep(Duration::from_secs(1));
        let stands = odometry();
        assert!(stands.len() > stood.len() && stands.last() == stood.last(), "it stands");
    }
    drop(robot);
}

/// A stop, as `peer.py` writes it.
const STOP: &str = "/cmd_vel 0.0 0.0";

#[test]
fn a_silent_robot_is_given_up() {
    let stage = Stage::new("silent");
    let robot = stage.simulate(&[]);
    let drive = stage.drive(&[]);
    until("the run begins", 60, || stage.folder.join("run.mcap").exists());
    sleep(Duration::from_secs(3));
    // Its process is suspended; no connection is closed.
    robot.signal("-STOP");
    let output = drive.ends_within(60);
    robot.signal("-CONT");
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let end = stage.end();
    assert!(end.contains("gave-up\0") && end.contains("no message on /odom"), "{end}");
}

#[test]
fn what_is_missing_or_of_another_type_is_said() {
    let stage = Stage::new("wrong");
    let refused = |stage: &Stage, more: &[&str]| {
        let output = stage.drive(more).ends_within(60);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        stderr(&output)
    };
    let nobody = format!("nobody publishes /odom in domain {}; waited for 10 s", stage.domain);
    let said = refused(&stage, &[]);
    assert!(said.contains(&nobody), "{said}");
    for (verb, what, expected) in [
        (
            "publish",
            "twist-type",
            "/scan of the robot is geometry_msgs/msg/Twist; this program needs sensor_msgs/msg/LaserScan",
        ),
        (
            "publish",
            "xcdr2",
            "/scan of the robot is sensor_msgs/msg/LaserScan in the encoding XCDR2",
        ),
        (
            "publish",
            "no-frame",
            "the scanner's frame `laser` is not connected to the robot: no transform",
        ),
        (
            "publish",
            "other-marker",
            "/marker of the robot is geometry_msgs/msg/Twist; this program needs geometry_msgs/msg/PoseStamped",
        ),
        ("publish", "plain", "nobody reads /cmd_vel"),
        (
            "read",
            "both",
            "/cmd_vel of the robot is geometry_msgs/msg/Twist and geometry_msgs/msg/TwistStamped; this program needs one of them; select it with --cmd-vel-type",
        ),
    ] {
        let Some(peer) = stage.peer(verb, what) else { return };
        let said = refused(&stage, &[]);
        assert!(said.contains(expected), "{what}: {said}");
        drop(peer);
    }
    let Some(_peer) = stage.peer("read", "Twist") else { return };
    let said = refused(&stage, &["--cmd-vel-type", "TwistStamped"]);
    let expected = "/cmd_vel of the robot is geometry_msgs/msg/Twist; this program needs geometry_msgs/msg/TwistStamped";
    assert!(said.contains(expected), "{said}");
}

/// The odometry of one would be taken for that of the other.
#[test]
fn of_two_robots_on_the_same_topics_none_is_driven() {
    let stage = Stage::new("two");
    let robots = [(); 2].map(|()| {
        let robot = stage.simulate(&[]);
        until("a robot is there", 30, || stage.lines("robot", "A simulated robot").len() == 1);
        robot
    });
    let output = stage.drive(&[]).ends_within(60);
    drop(robots);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    let expected = "/odom of the robot is published by 2 nodes; this program needs one";
    assert!(stderr(&output).contains(expected), "{}", stderr(&output));
}

#[test]
fn a_second_robot_that_comes_later_ends_the_run() {
    let stage = Stage::new("later");
    let Some(_commands) = stage.peer("listen", &stage.path("received")) else { return };
    let robot = stage.simulate(&[]);
    let drive = stage.drive(&["--patience", "20"]);
    until("the run begins", 60, || stage.folder.join("run.mcap").exists());
    let second = stage.python("peer.py", &["publish", "plain"], "second");
    let output = drive.ends_within(60);
    drop((robot, second));
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stage.end().contains("two nodes publish on /"), "{}", stage.end());
    assert_eq!(stage.lines("received", "/cmd_vel").pop().as_deref(), Some(STOP));
}

/// The robot is one of Cyclone DDS that does not move.
#[test]
fn the_type_of_commands_is_the_one_that_the_robot_reads_and_no_other_is_sent() {
    for twist in ["Twist", "TwistStamped"] {
        let stage = Stage::new(twist);
        let Some(peer) = stage.peer("read", twist) else { return };
        let output = stage.drive(&["--patience", "1"]).ends_within(120);
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
        drop(peer);
        let read = stage.lines("peer", "Twist");
        assert!(!read.is_empty() && read.iter().all(|kind| kind == twist), "{read:?}");
    }
}

#[test]
fn tests_at_a_time_have_different_domains() {
    let (one, other) = (Stage::new("one-domain"), Stage::new("other-domain"));
    assert_ne!(one.domain, other.domain);
}

/// It is refused before a robot is looked for.
#[test]
fn bends_are_no_vertices_in_corridors_and_corners_are_vertices_in_hallways() {
    let stage = Stage::new("corners");
    let params = stage.path("params.toml");
    let refused = |options: &[&str], text: &str| {
        fs::write(&params, text).unwrap();
        let drive = ["drive", "--ros2", "--sensor", "laser", "--laser-params", &params];
        let mut command = stage.toposlam(&[&drive[..], options].concat());
        let output = command.env("ROS_DOMAIN_ID", "233").output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        stderr(&output)
    };
    let expected = "--laser-params: corner.corners is true, but a robot in corridors takes no bend for a vertex; set it to false";
    let (corners, none) = ("[corner]\ncorners = true\n", "[corner]\ncorners = false\n");
    let corridors = ["--corridors"];
    assert!(refused(&corridors, corners).contains(expected));
    assert!(refused(&corridors, none).contains("ROS_DOMAIN_ID"));
    let expected = "--laser-params: corner.corners is false, but a robot in hallways takes corners for vertices; set it to true, or add --corridors";
    assert!(refused(&[], none).contains(expected));
    assert!(refused(&[], corners).contains("ROS_DOMAIN_ID"));
}

#[test]
fn a_domain_is_a_number_that_has_ports() {
    let stage = Stage::new("domain");
    for domain in ["233", "-1", "one"] {
        let mut command = stage.toposlam(&["drive", "--ros2", "--sensor", "laser"]);
        let output = command.env("ROS_DOMAIN_ID", domain).output().unwrap();
        let expected = format!("ROS_DOMAIN_ID: expected a number from 0 to 232, found {domain}");
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(&expected), "{}", stderr(&output));
    }
}

/// What `services.py` prints when it calls a service.
fn call(stage: &Stage, service: &str) -> String {
    let output = stage.script("services.py", &["call", service]).output().unwrap();
    assert!(output.status.success(), "{service}: {}", stderr(&output));
    stdout(&output)
}

/// Cyclone DDS lists the node in both forms, sees the run, and calls the services as its clients in ROS 2 do.
#[test]
fn others_see_a_run_pause_it_and_abort_it() {
    for (distro, gid) in [("humble", "24"), ("jazzy", "16")] {
        let stage = Stage::new(distro);
        let Some(_odometry) = stage.peer("listen", &stage.path("received")) else { return };
        let mut watch = stage.script("services.py", &["watch", &stage.path("seen")]);
        let _watch = Process::start(watch.env("GID", gid));
        let robot = stage.simulate(&[]);
        let drive = stage.drive(&["--patience", "20", "--ros-distro", distro]);
        let is_seen = |word: &str, part: &str| {
            stage.lines("seen", word).iter().any(|line| line.contains(part))
        };
        until("the robot leaves", 60, || is_seen("/state 0", "by door 0 [moves=1 vertices=1"));
        assert_eq!(call(&stage, "pause"), "True the stop command is sent\n");
        // The wheels brake.
        sleep(Duration::from_millis(500));
        let odometry = || stage.lines("received", "/odom").last().cloned();
        let stood = odometry();
        sleep(Duration::from_secs(1));
        assert_eq!((odometry(), stood.is_some()), (stood, true));
        assert_eq!(call(&stage, "pause"), "False the run is paused already\n");
        assert!(is_seen("/state 1", "paused; driving to the next junction by door 0"));
        assert_eq!(call(&stage, "resume"), "True the run goes on\n");
        assert_eq!(call(&stage, "resume"), "False the run is not paused\n");
        until("the next junction is known", 60, || is_seen("/markers", "numbers:9:0:0:1"));
        // A run that waits ends, too.
        assert_eq!(call(&stage, "pause"), "True the stop command is sent\n");
        assert_eq!(call(&stage, "abort"), "True the run ends\n");
        let output = drive.ends_within(30);
        assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
        assert!(stage.end().contains("stopped\0"), "{}", stage.end());
        until("the end is seen", 5, || is_seen("/state 0", ": run: stopped ["));
        // Two vertices of degrees 2 and 3; the robot came in at the second.
        assert!(is_seen("/map 1 ", "[2, 3] [2, -1, 0, -1, -1] 2"));
        let markers = stage.lines("seen", "/markers");
        let expected =
            "['odom'] :7:3:0: vertices:7:0:2: edges:5:0:2: numbers:9:0:0:0 numbers:9:0:0:1";
        assert!(markers.last().unwrap().contains(expected), "{markers:?}");
        let nodes = stage.lines("seen", &format!("/nodes {gid} /:toposlam_"));
        // Odometry, scans, two kinds of transforms, the marker and three services; wheels, state, map, markers and three
        // services. The identity of each begins as that of its participant.
        assert!(nodes.last().unwrap().ends_with(" 8 7 True"), "{nodes:?}");
        drop(robot);
    }
}

#[test]
fn a_bumper_ends_a_run_and_a_low_battery_is_a_warning() {
    let stage = Stage::new("bump");
    let Some(_commands) = stage.peer("listen", &stage.path("received")) else { return };
    let publish = |what| Process::start(&mut stage.script("services.py", &["publish", what]));
    let watch = &mut stage.script("services.py", &["watch", &stage.path("seen")]);
    let _watch = Process::start(watch);
    let _sensors = ["battery", "other-cliff"].map(publish);
    let robot = stage.simulate(&[]);
    let drive = stage.drive(&["--patience", "20"]);
    let is_seen =
        |word: &str, part: &str| stage.lines("seen", word).iter().any(|line| line.contains(part));
    let warnings = "by door 0; the battery is low; /events/cliff is not read: its type is rosgraph_msgs/msg/Clock";
    until("the robot leaves", 60, || is_seen("/state 1", warnings));
    assert!(is_seen("/state 1", "battery=8 %"));
    // Without --ros-distro the node is in no list.
    assert_eq!(stage.lines("seen", "/nodes").len(), 0);
    let _bump = publish("bump");
    let output = drive.ends_within(30);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let cause = "the robot reports on /hazard_detection that the bumper is pressed";
    assert!(stage.end().contains(cause), "{}", stage.end());
    until("the end is seen", 5, || is_seen("/state 2", cause));
    let last = stage.lines("received", "/cmd_vel").pop();
    assert_eq!(last.as_deref(), Some(STOP));
    drop(robot);
}

#[test]
fn commands_have_the_time_of_the_simulation_if_it_is_asked_for() {
    let stage = Stage::new("clock");
    let Some(_robot) = stage.peer("read", "TwistStamped") else { return };
    let output = stage.drive(&["--sim-time", "--patience", "1"]).ends_within(60);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(stderr(&output).contains("nobody publishes /clock"), "{}", stderr(&output));
    let start = |verb, what| Process::start(&mut stage.script("services.py", &[verb, what]));
    let _clock = start("publish", "clock");
    let _stamps = start("stamps", &stage.path("stamps"));
    let output = stage.drive(&["--sim-time", "--patience", "1"]).ends_within(60);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let stamps = stage.lines("stamps", "/cmd_vel");
    assert!(!stamps.is_empty() && stamps.iter().all(|line| line == "/cmd_vel 77 5"), "{stamps:?}");
}

/// The launch file makes commands that this program takes. Its domain has no ports, so none finds a robot.
#[test]
fn the_options_of_each_robot_in_the_package_are_options_of_this_program() {
    let stage = Stage::new("package");
    let package = Path::new(env!("CARGO_MANIFEST_DIR")).join("ros2");
    let printed = stage.script("package.py", &[&package.display().to_string()]).output().unwrap();
    if stderr(&printed) == "no yaml\n" {
        assert_ne!(env::var("TOPOSLAM_ROS").as_deref(), Ok("required"));
        eprintln!("skipped: the Python package yaml is not installed");
        return;
    }
    let commands = stdout(&printed);
    assert_eq!(commands.lines().count(), 6, "{commands}{}", stderr(&printed));
    for (number, line) in commands.lines().enumerate() {
        assert_eq!(line.contains("\"--corridors\""), number % 2 == 0, "{line}");
        let words: Vec<String> = serde_json::from_str(line).unwrap();
        let words: Vec<_> = words[1..].iter().map(String::as_str).collect();
        let output = stage.toposlam(&words).env("ROS_DOMAIN_ID", "233").output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{line}");
        let expected = "ROS_DOMAIN_ID: expected a number from 0 to 232, found 233";
        assert!(stderr(&output).contains(expected), "{line}: {}", stderr(&output));
    }
}

/// These images have another size than those of the calibrated camera.
#[test]
fn a_camera_may_publish_pixels() {
    let stage = Stage::new("pixels");
    let Some(_robot) = stage.peer("read", "Twist") else { return };
    camera_files::write_camera_files(&stage.folder);
    let _images = Process::start(&mut stage.script("services.py", &["publish", "pixels"]));
    let paths = ["camera.toml", "colours.toml", "run.mcap"].map(|name| stage.path(name));
    let [camera, colours, log] = paths.each_ref().map(String::as_str);
    let files = ["--calibration", camera, "--colours", colours, "--log", log];
    let drive = ["drive", "--ros2", "--topic", "images=/camera/pixels"];
    let output = stage.toposlam(&[&drive[..], &files].concat()).output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}{}", stdout(&output), stderr(&output));
    let cause = "the image has 160 x 120 pixels; those of the calibrated camera have 640 x 480";
    assert!(stage.end().contains(cause), "{}", stage.end());
}
