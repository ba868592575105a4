//! Benchmark of rendering: `cargo bench -p toposlam-simulator --bench renderer`. An image takes one
//! thread.

#![allow(clippy::unwrap_used, reason = "a benchmark may panic")]

use divan::Bencher;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_model::driving::pose::Pose;
use toposlam_simulator::{Building, BuildingLook, Effects, Rig, labels, plan_named, render};
use toposlam_vision::camera::Camera;

fn main() {
    divan::main();
}

fn rig(width: u32) -> Rig {
    Rig::new(&Camera::superscout().sized([width, width * 3 / 4]))
}

const POSE: Pose = Pose { position: [0.3, 4.2], heading: 1.2 };

fn effects() -> Effects {
    Effects { blur: 1.1, ..Effects::drawn(&mut Xoshiro256PlusPlus::seed_from_u64(7)) }
}

/// A building with all effects.
fn built(plan: &str, look: &str) -> Building {
    let (plan, look) = (plan_named(plan).unwrap(), BuildingLook::named(look).unwrap());
    Building::new(&plan, look, None, &effects(), 7)
}

/// One image with all effects, including JPEG compression.
#[divan::bench(args = [
    (640, "laboratory"), (640, "tiles"), (640, "vinyl"), (640, "school"),
    (1280, "laboratory"), (1280, "tiles"), (1280, "vinyl"), (1280, "school"),
], sample_count = 20, sample_size = 1)]
fn image(bencher: Bencher, (width, look): (u32, &str)) {
    let (building, rig, effects) = (built("shape-8", look), rig(width), effects());
    bencher.bench_local(|| render(&rig, &building, POSE, &effects, 7));
}

/// The classes of all pixels of an image.
#[divan::bench(args = [640, 1280], sample_count = 20, sample_size = 1)]
fn classes(bencher: Bencher, width: u32) {
    let (building, rig, effects) = (built("shape-8", "tiles"), rig(width), effects());
    bencher.bench_local(|| labels(&rig, &building, POSE, &effects));
}

#[divan::bench(args = ["shape-8", "building-25"], sample_count = 20, sample_size = 1)]
fn building(bencher: Bencher, name: &str) {
    bencher.bench_local(|| built(name, "tiles"));
}

/// The rays of all pixels, computed once per camera.
#[divan::bench(args = [640, 1280], sample_count = 10, sample_size = 1)]
fn rays(width: u32) -> Rig {
    rig(width)
}
