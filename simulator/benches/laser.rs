//! Benchmark of sensing with a laser scanner: `cargo bench -p toposlam-simulator --bench laser`. All run on one
//! thread, on the scans of a random walk.

#![allow(clippy::unwrap_used, reason = "a benchmark may panic")]

use divan::{Bencher, counter::ItemsCount};
use toposlam_model::driving::odometry::Odometry;
use toposlam_simulator::{
    LaserScanner, ScannerParams,
    evaluation::laser::{
        corridor_world::{BuildingKind, CorridorWorld},
        walk::{LaserWalk, WalkStep},
    },
};
use toposlam_vision::{
    laser::{params::LaserParams, scan::Scan, scene::ScanPlaceSensor},
    visits::Visits,
};

fn main() {
    divan::main();
}

/// A scanner of 360 readings in a furnished building.
fn scanner(world: &CorridorWorld) -> LaserScanner {
    let params = ScannerParams::default();
    LaserScanner::new(&world.plan, &params, 1)
}

/// The scans of a walk: one each 0.25 m, at the speed of the robot two in a second.
fn scans() -> Vec<(Scan, Odometry)> {
    let world = CorridorWorld::random(BuildingKind::Mixed, 1);
    let scanner = scanner(&world);
    let walk = LaserWalk::random(&world, 8, 0.0, 1);
    let scan = |(number, step): (usize, &WalkStep)| {
        (scanner.scan(step.pose, number as u64, step.time).unwrap(), step.odometry)
    };
    walk.steps.iter().enumerate().map(scan).collect()
}

/// Visits from scans: the whole of sensing.
#[divan::bench(sample_count = 5)]
fn visits(bencher: Bencher) {
    let scans = scans();
    bencher.counter(ItemsCount::new(scans.len())).bench(|| {
        let mut visits = Visits::by_laser(LaserParams::default());
        for (scan, odometry) in &scans {
            visits.add_frame((), scan, odometry);
        }
        visits.finish()
    });
}

/// Places from scans, as Algorithm 2 needs them.
#[divan::bench(sample_count = 5)]
fn places(bencher: Bencher) {
    let scans = scans();
    bencher.counter(ItemsCount::new(scans.len())).bench(|| {
        let mut sensor = ScanPlaceSensor::default();
        scans.iter().map(|(scan, odometry)| sensor.sense(scan, odometry)).collect::<Vec<_>>()
    });
}

/// Simulated scans.
#[divan::bench(sample_count = 5)]
fn simulated(bencher: Bencher) {
    let world = CorridorWorld::random(BuildingKind::Mixed, 1);
    let scanner = scanner(&world);
    let walk = LaserWalk::random(&world, 2, 0.0, 1);
    bencher.counter(ItemsCount::new(walk.steps.len())).bench(|| {
        let scans = walk.steps.iter().map(|step| scanner.scan(step.pose, 1, step.time));
        scans.collect::<Vec<_>>()
    });
}
