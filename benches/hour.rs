//! Benchmark of `toposlam conform` on logs of a laser scanner: `cargo bench -p toposlam --bench hour`. A robot drives
//! through a random building for a quarter of an hour and for an hour; it takes scans of 720 readings at 40 Hz. The
//! program runs on one thread. `--test` leaves out the hour.

#![allow(clippy::unwrap_used, reason = "a benchmark may panic")]

use std::{
    env,
    fs::{self, File},
    io::BufWriter,
    path::{Path, PathBuf},
    process::{Command, Stdio},
    sync::Arc,
};

use nalgebra::Point2;
use nix::sys::{
    resource::{UsageWho, getrusage},
    time::{TimeVal, TimeValLike},
};
use toposlam_logs::{
    messages,
    record::{Event, EventId, EventKind, Frame, RunObserver},
    recorder::Recorder,
};
use toposlam_model::{
    counts::grouped,
    driving::{odometry::Odometry, pose::Pose, scene::wrapped},
};
use toposlam_simulator::{
    LaserScanner, ScannerParams,
    evaluation::laser::{
        corridor_world::{BuildingKind, CorridorWorld},
        walk::{LaserWalk, WalkStep},
    },
};

const SEED: u64 = 1;
const HERTZ: u32 = 40;
/// The numbers of scans: those of a quarter of an hour and of an hour.
const SCANS: [u32; 2] = [36_000, 144_000];
/// A walk that passes so many places takes longer than an hour.
const PLACES: usize = 200;

fn main() {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let is_test = env::args().any(|word| word == "--test");
    for &scans in if is_test { &SCANS[..1] } else { &SCANS } {
        let log = folder.join(format!("{scans}-scans.mcap"));
        write_log(&log, scans);
        let before = used_time();
        let judged = Command::new(env!("CARGO_BIN_EXE_toposlam"))
            .args(["conform", "--events", "laser", "--driver", "anyone", "--marker", "none"])
            .arg(&log)
            .env("RAYON_NUM_THREADS", "1")
            .stdout(Stdio::null())
            .status()
            .unwrap();
        // 3: what the last door led to is not known.
        assert!(matches!(judged.code(), Some(0 | 3)), "{judged}");
        let seconds = (used_time() - before).num_milliseconds() as f64 / 1e3;
        // The largest of all programs so far: the longest log comes last.
        let peak = getrusage(UsageWho::RUSAGE_CHILDREN).unwrap().max_rss() as f64 / 1e3;
        let size = fs::metadata(&log).unwrap().len() as f64 / 1e6;
        println!(
            "{} scans ({size:.0} MB): {seconds:.1} s of processor time, {peak:.0} MB of memory",
            grouped(u128::from(scans))
        );
        fs::remove_file(log).unwrap();
    }
}

/// The processor time of all programs that have ended.
fn used_time() -> TimeVal {
    let usage = getrusage(UsageWho::RUSAGE_CHILDREN).unwrap();
    usage.user_time() + usage.system_time()
}

/// Writes the log of a robot that walks through a building at random.
fn write_log(path: &Path, scans: u32) {
    let world = CorridorWorld::random(BuildingKind::Mixed, SEED);
    let walk = LaserWalk::random(&world, PLACES, 0.0, SEED);
    let params = ScannerParams { angular_step: 0.5, ..ScannerParams::DEFAULT };
    let scanner = LaserScanner::new(&world.plan, &params, SEED);
    let out = BufWriter::new(File::create(path).unwrap());
    let mut recorder = Recorder::new(out, &messages::Run::default(), None).unwrap();
    let mut steps = walk.steps.windows(2).peekable();
    for number in 0..scans {
        let taken = f64::from(number) / f64::from(HERTZ);
        while steps.next_if(|step| step[1].time < taken).is_some() {}
        let (truth, odometry) = between(steps.peek().unwrap(), taken);
        let id = u64::from(number);
        let scan = Some(Arc::new(scanner.scan(truth, id, taken).unwrap()));
        let frame = Frame { id, taken, odometry, scan, ..Frame::default() };
        for kind in [EventKind::Odometry(odometry), EventKind::Frame(frame)] {
            let time = (taken * 1e9) as u64;
            recorder.event(&Event { id: EventId(id), time, truth: Some(truth), kind });
        }
    }
    recorder.finish().unwrap();
}

/// Where a robot is at a time between two steps, and its odometry there.
fn between(steps: &[WalkStep], time: f64) -> (Pose, Odometry) {
    let (from, to) = (&steps[0], &steps[1]);
    let share = (time - from.time) / (to.time - from.time);
    let position = |from, to| Point2::from(from).lerp(&Point2::from(to), share).into();
    let heading = |from: f64, to: f64| wrapped(from + share * wrapped(to - from));
    let pose = Pose {
        position: position(from.pose.position, to.pose.position),
        heading: heading(from.pose.heading, to.pose.heading),
    };
    let odometry = Odometry {
        position: position(from.odometry.position, to.odometry.position),
        heading: heading(from.odometry.heading, to.odometry.heading),
    };
    (pose, odometry)
}
