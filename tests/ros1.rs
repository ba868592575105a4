//! A robot behind a real master of ROS 1: `toposlam drive` drives the simulated one of `toposlam simulate
//! --ros`, and ROS's own client library listens. Sections 2.5 and 6.
//!
//! Everything is on loopback. Where ROS 1 is not installed the tests are skipped, with a message, unless
//! `TOPOSLAM_ROS` is `required`.

#![cfg(all(feature = "ros1", unix))]
#![allow(clippy::unwrap_used, reason = "a test may panic")]

#[path = "ros1/camera_files.rs"]
mod camera_files;
#[allow(dead_code, reason = "other programs use the rest")]
mod output;
mod process;

use std::{
    env,
    ffi::OsStr,
    fs,
    net::{Ipv4Addr, TcpListener, TcpStream},
    path::{Path, PathBuf},
    process::{Command, Stdio},
    sync::{Mutex, MutexGuard, PoisonError},
    thread::sleep,
    time::{Duration, Instant},
};

use mcap::MessageStream;
use process::Process;

/// ROS's client library is installed in the system's Python.
const PYTHON: &str = "/usr/bin/python3";
/// How many times faster the simulated time is than the real time.
const SPEED: &str = "8";

/// A master, a listener, a simulated robot, and the folder for their files.
struct Stage {
    // Dropped in this order.
    robot: Process,
    _listener: Process,
    _master: Process,
    address: String,
    folder: PathBuf,
    sensor: &'static str,
    _alone: MutexGuard<'static, ()>,
}

/// Two robots at a time would be too slow.
static ALONE: Mutex<()> = Mutex::new(());

fn toposlam(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_toposlam"));
    command.current_dir(env!("CARGO_MANIFEST_DIR")).args(arguments);
    command.env("ROS_IP", "127.0.0.1").stdin(Stdio::null());
    command
}

fn stdout_of(arguments: &[&str]) -> String {
    let output = toposlam(arguments).output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {error}");
    String::from_utf8(output.stdout).unwrap()
}

fn until(what: &str, holds: impl FnMut() -> bool) {
    process::until(what, 60, holds);
}

/// Whether ROS 1 is here.
fn has_ros() -> bool {
    let paths = env::var_os("PATH").unwrap_or_default();
    let here = env::split_paths(&paths).any(|folder| folder.join("roscore").is_file());
    if !here {
        assert_ne!(env::var("TOPOSLAM_ROS").as_deref(), Ok("required"), "there is no roscore");
        eprintln!("skipped: there is no roscore");
    }
    here
}

impl Stage {
    /// A robot with a camera; `None` where ROS 1 is not installed.
    fn new(name: &str) -> Option<Self> {
        Self::with_sensor(name, "camera")
    }

    fn with_sensor(name: &str, sensor: &'static str) -> Option<Self> {
        if !has_ros() {
            return None;
        }
        let alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
        let folder = output::folder(&format!("ros1-{name}"));
        let path = |name: &str| folder.join(name).display().to_string();
        let port =
            TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap().local_addr().unwrap().port();
        let address = format!("http://127.0.0.1:{port}");
        let ros = |program: &str, arguments: &[&OsStr]| {
            let mut command = Command::new(program);
            command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null());
            command.stderr(Stdio::null()).env("ROS_MASTER_URI", &address);
            command.env("ROS_IP", "127.0.0.1").env("ROS_HOME", &folder);
            Process::start(&mut command)
        };
        let master = ros("roscore", &["-p".as_ref(), port.to_string().as_ref()]);
        until("the master", || TcpStream::connect((Ipv4Addr::LOCALHOST, port)).is_ok());
        let listener = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/ros1/listener.py");
        let listener = ros(PYTHON, &[listener.as_ref(), path("received").as_ref()]);
        if sensor == "camera" {
            camera_files::write_camera_files(&folder);
        }
        let [camera, colours] = [path("camera.toml"), path("colours.toml")];
        let simulate = ["simulate", "worlds/shape-6.toml", "--seed", "3", "--ros", &address];
        fs::write(folder.join("plain.toml"), "furniture = 0\ndoors = 0\npeople = 0\n").unwrap();
        let plain = path("plain.toml");
        let seen = match sensor {
            "camera" => ["--speed", SPEED, "--calibration", &camera, "--colours", &colours],
            _ => ["--speed", SPEED, "--sensor", sensor, "--scanner", &plain],
        };
        let output = fs::File::create(folder.join("robot")).unwrap();
        let robot = Process::start(toposlam(&[&simulate[..], &seen].concat()).stdout(output));
        let stage = Self {
            robot,
            _listener: listener,
            _master: master,
            address,
            folder,
            sensor,
            _alone: alone,
        };
        until("odometry", || stage.received("/odom"));
        match sensor {
            "camera" => until("images", || stage.received("/camera")),
            _ => until("scans", || stage.received("/scan 360")),
        }
        Some(stage)
    }

    fn path(&self, name: &str) -> String {
        self.folder.join(name).display().to_string()
    }

    fn lines(&self, topic: &str) -> Vec<String> {
        let received = fs::read_to_string(self.folder.join("received")).unwrap_or_default();
        received.lines().filter(|line| line.starts_with(topic)).map(str::to_owned).collect()
    }

    fn received(&self, topic: &str) -> bool {
        !self.lines(topic).is_empty()
    }

    /// The commands to the wheels: speed ahead and turning speed.
    fn wheels(&self) -> Vec<[f64; 2]> {
        let number = |word: Option<&str>| word.unwrap().parse().unwrap();
        let lines = self.lines("/cmd_vel").into_iter().map(|line| {
            let mut words = line.split(' ').skip(1);
            [number(words.next()), number(words.next())]
        });
        lines.collect()
    }

    fn moves(&self) -> bool {
        self.wheels().last().is_some_and(|wheels| wheels.iter().any(|speed| speed.abs() > 0.0))
    }

    /// Starts `toposlam drive`.
    fn drive(&self, patience: &str) -> Process {
        let [camera, colours] = [self.path("camera.toml"), self.path("colours.toml")];
        let [log, map] = [self.path("run.mcap"), self.path("map.toml")];
        let drive = ["drive", "--ros", &self.address, "--sensor", self.sensor];
        let drive = [&drive[..], &["--patience", patience]].concat();
        let seen: &[&str] = match self.sensor {
            "camera" => &["--calibration", &camera, "--colours", &colours],
            _ => &[],
        };
        let written = ["--log", &log, "--map", &map, "--json"];
        let output = fs::File::create(self.folder.join("output")).unwrap();
        Process::start(toposlam(&[&drive[..], seen, &written].concat()).stdout(output))
    }

    /// The last message of the log.
    fn end(&self) -> String {
        let log = fs::read(self.folder.join("run.mcap")).unwrap();
        let last = MessageStream::new(&log).unwrap().map(Result::unwrap).last().unwrap();
        assert_eq!(last.channel.topic, "/toposlam/end");
        String::from_utf8_lossy(&last.data).into_owned()
    }

    /// The robot never exceeds its speed limit, and its last command is to stop.
    fn was_safe(&self) {
        // The listener writes the last message soon.
        sleep(Duration::from_secs(1));
        let wheels = self.wheels();
        assert!(!wheels.is_empty() && !self.moves());
        for [speed, turning] in wheels {
            assert!(speed.abs() <= 0.2 + 1e-9 && turning.abs() <= 0.3491, "{speed} {turning}");
        }
    }
}

#[test]
fn a_robot_that_has_only_a_laser_scanner_maps_shape_6_through_ros() {
    if let Some(stage) = Stage::with_sensor("scanned", "laser") {
        maps_shape_6(stage);
    }
}

// paper: hardware.ros
#[test]
fn the_whole_of_shape_6_is_mapped_through_ros() {
    if let Some(stage) = Stage::new("mapped") {
        maps_shape_6(stage);
    }
}

fn maps_shape_6(stage: Stage) {
    let begun = Instant::now();
    // Other tests run beside this one: images may take their time.
    let status = stage.drive("20").ends_within(600).status;
    eprintln!("mapped in {:.0} s", begun.elapsed().as_secs_f64());
    let output = fs::read_to_string(stage.folder.join("output")).unwrap();
    assert_eq!(status.code(), Some(0), "{output}");
    let compared =
        stdout_of(&["compare", "worlds/shape-6.toml", &stage.path("map.toml"), "--json"]);
    assert!(compared.contains("\"isomorphic\":true"), "{compared}");
    assert!(compared.contains("\"distinguishable\":false"), "{compared}");
    assert!(stage.end().contains("mapped\0"), "{}", stage.end());
    let judged = stdout_of(&["conform", &stage.path("run.mcap"), "--world", "worlds/shape-6.toml"]);
    assert!(judged.contains("conforms"), "{judged}");
    stage.was_safe();
    stage.robot.signal("-INT");
    assert!(stage.robot.ends_within(20).status.success());
    eprintln!("{output}{}", fs::read_to_string(stage.folder.join("robot")).unwrap());
}

#[test]
fn after_ctrl_c_the_robot_stands() {
    let Some(stage) = Stage::new("stopped") else { return };
    let drive = stage.drive("2");
    until("the robot moves", || stage.moves());
    drive.signal("-INT");
    // A second interrupt changes nothing.
    drive.signal("-INT");
    assert_eq!(drive.ends_within(10).status.code(), Some(3));
    stage.was_safe();
    assert!(stage.end().contains("stopped\0"), "{}", stage.end());
}

#[test]
fn a_silent_robot_is_commanded_to_stop() {
    let Some(stage) = Stage::new("silent") else { return };
    let drive = stage.drive("2");
    until("the robot moves", || stage.moves());
    // Its process is suspended; no connection is closed.
    stage.robot.signal("-STOP");
    let status = drive.ends_within(30).status;
    stage.robot.signal("-CONT");
    assert_eq!(status.code(), Some(1));
    stage.was_safe();
    let end = stage.end();
    assert!(end.contains("gave-up\0") && end.contains("no message on /odom"), "{end}");
}
