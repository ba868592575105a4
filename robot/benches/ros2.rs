//! Load of ROS 2: two robots in one domain, each with 40 scans of 720 ranges and 50 odometry messages a second, and a driver
//! each, in four processes. `cargo bench -p toposlam-robot --features ros2 --bench ros2` prints the latency from a scan to
//! the first command that it leads to, sensing included, and the processor time of a driver.

#![allow(clippy::unwrap_used, reason = "a benchmark may panic")]

use std::{
    env,
    f64::consts::TAU,
    fs,
    process::{Child, Command, Stdio},
    thread::sleep,
    time::{Duration, Instant, SystemTime, UNIX_EPOCH},
};

use nalgebra::Isometry2;
use toposlam_model::driving::{odometry::Odometry, scene::MarkerView};
use toposlam_robot::{
    live::{LiveSensor, Nanoseconds, Reckoning, RobotTopics, SECOND, ServedRobot},
    robot::Robot,
    ros2::{DomainTopics, DriveSettings, RobotDomain, WheelsType, connect},
    superscout::{WheelSpeeds, along_arc},
};
use toposlam_vision::{
    laser::{
        params::LaserParams,
        scan::{Scan, ScanGeometry},
        sensor::LaserSensor,
    },
    place::PlaceSensor,
};

const TIME: Duration = Duration::from_secs(60);
const ODOMETRY: Duration = Duration::from_millis(20);
const SCANS: Duration = Duration::from_millis(25);
const RAYS: usize = 720;
/// Interval at which a robot looks for commands.
const LOOK: Duration = Duration::from_micros(200);
/// Clock ticks a second in `/proc`, on every Linux.
const TICKS: f64 = 100.0;

fn main() {
    let words: Vec<String> = env::args().skip(1).filter(|word| word != "--bench").collect();
    match words.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["robot", name] => robot(&domain(name)),
        ["driver", name] => drive(&domain(name)),
        _ => measure(),
    }
}

fn domain(name: &str) -> RobotDomain {
    RobotDomain { number: 111, namespace: name.to_owned(), network: false, distro: None }
}

fn measure() {
    let start = |role: &str, name: &str| -> Child {
        let mut command = Command::new(env::current_exe().unwrap());
        command.args([role, name]).stdout(Stdio::piped()).spawn().unwrap()
    };
    let names = ["one", "two"];
    let robots = names.map(|name| start("robot", name));
    let drivers = names.map(|name| start("driver", name));
    let numbers = |child: Child| -> Vec<f64> {
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success());
        let text = String::from_utf8(output.stdout).unwrap();
        text.lines().map(|line| line.parse().unwrap()).collect()
    };
    let mut latencies: Vec<f64> = robots.into_iter().flat_map(numbers).collect();
    let busy: Vec<f64> = drivers.into_iter().flat_map(numbers).collect();
    latencies.sort_by(f64::total_cmp);
    let quantile = |part: f64| latencies[((latencies.len() - 1) as f64 * part).round() as usize];
    println!(
        "from scan to command, {} times: median {:.1} ms, 99 % {:.1} ms, most {:.1} ms",
        latencies.len(),
        quantile(0.5),
        quantile(0.99),
        quantile(1.0)
    );
    println!("processor time of the drivers: {busy:.1?} % of one processor");
}

/// A robot that stands in a hallway, and prints the time from the last scan to each first command, in milliseconds.
fn robot(domain: &RobotDomain) {
    let topics =
        DomainTopics::new(domain, &RobotTopics::default(), WheelsType::TwistStamped).unwrap();
    let geometry = ScanGeometry {
        angle_min: -TAU / 2.0,
        angle_increment: TAU / RAYS as f64,
        range_min: 0.1,
        range_max: 20.0,
    };
    // The walls are 1 m to the left and to the right.
    let ranges = (0..RAYS).map(|ray| {
        let bearing = geometry.angle_min + ray as f64 * geometry.angle_increment;
        (1.0 / bearing.sin().abs()) as f32
    });
    let scan = Scan::new(geometry, ranges.collect(), Isometry2::identity()).unwrap();
    let marker = MarkerView { position: [1.0, 0.0], axis: 0.0, door: None };
    let (mut at, mut wheels) = (Odometry::default(), WheelSpeeds::STOP);
    let begun = Instant::now();
    let (mut moved, mut scanned, mut reckoned) = (begun, begun, begun);
    let mut number = 0;
    // Its driver needs a moment to find it.
    while begun.elapsed() < TIME + Duration::from_secs(10) {
        let now = Instant::now();
        at = along_arc(&at, wheels, (now - moved).as_secs_f64());
        moved = now;
        if let Some(command) = topics.command() {
            if wheels == WheelSpeeds::STOP && command != WheelSpeeds::STOP {
                println!("{}", (now - scanned).as_secs_f64() * 1e3);
            }
            wheels = command;
        }
        if now - reckoned >= ODOMETRY {
            reckoned += ODOMETRY;
            topics.odometry(number, &Reckoning { stamp: stamp(), at, wheels }).unwrap();
        }
        if now - scanned >= SCANS {
            let stamp = stamp();
            topics.marker(number, stamp, &marker).unwrap();
            topics.scan(number, stamp, &scan).unwrap();
            number += 1;
            scanned = now;
        }
        sleep(LOOK);
    }
}

fn stamp() -> Nanoseconds {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap();
    now.as_secs() * SECOND + u64::from(now.subsec_nanos())
}

/// Turns a little after each scan, and prints how busy it was, in percent.
fn drive(domain: &RobotDomain) {
    let topics = RobotTopics::default();
    let settings = DriveSettings {
        sensor: LiveSensor::Laser,
        wheels_type: None,
        sim_time: false,
        patience: Duration::from_secs(2),
        stop: || false,
        abort: || {},
    };
    let (mut robot, _run) = connect(domain, &topics, &settings).unwrap();
    let mut sensor = LaserSensor::new(LaserParams::HALLWAYS);
    let (begun, busy) = (Instant::now(), processor_time());
    let mut angle = 0.1;
    while begun.elapsed() < TIME {
        let frame = robot.capture().unwrap();
        let scan = frame.scan.as_ref().unwrap();
        sensor.view(scan, &frame.odometry);
        robot.turn(angle).unwrap();
        angle = -angle;
    }
    println!("{}", (processor_time() - busy) / begun.elapsed().as_secs_f64() * 100.0);
}

/// Of this process, in seconds.
fn processor_time() -> f64 {
    let text = fs::read_to_string("/proc/self/stat").unwrap();
    let words: Vec<&str> = text.rsplit(')').next().unwrap().split_whitespace().collect();
    // The twelfth and the thirteenth after the name are the times in user and in system mode.
    [11, 12].iter().map(|&word| words[word].parse::<f64>().unwrap()).sum::<f64>() / TICKS
}
