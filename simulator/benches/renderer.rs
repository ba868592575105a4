//! Benchmark of rendering: `cargo bench -p toposlam-robot --bench renderer`. An image takes one
//! thread.

#![allow(clippy::unwrap_used, reason = "a benchmark may panic")]

use divan::Bencher;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_model::{driving::pose::Pose, floor_plan::FloorPlan, format::world_file};
use toposlam_simulator::{Building, BuildingLook, Effects, Rig, labels, render};
use toposlam_vision::camera::Camera;

fn main() {
    divan::main();
}

fn plan(name: &str) -> FloorPlan {
    let path = format!("{}/../worlds/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    world_file::read(&std::fs::read(path).unwrap()).unwrap().plan.unwrap()
}

fn rig(width: u32) -> Rig {
    Rig::new(&Camera::superscout().sized([width, width * 3 / 4]))
}

const POSE: Pose = Pose { position: [0.3, 4.2], heading: 1.2 };

/// One image with all effects, including JPEG compression.
#[divan::bench(args = [
    (640, "laboratory"), (640, "tiles"), (640, "vinyl"), (640, "school"),
    (1280, "laboratory"), (1280, "tiles"), (1280, "vinyl"), (1280, "school"),
], sample_count = 20, sample_size = 1)]
fn image(bencher: Bencher, (width, look): (u32, &str)) {
    let mut effects = Effects::drawn(&mut Xoshiro256PlusPlus::seed_from_u64(7));
    effects.blur = 1.1;
    let plan = plan("shape-8");
    let building = Building::new(&plan, BuildingLook::named(look).unwrap(), None, &effects, 7);
    let rig = rig(width);
    bencher.bench_local(|| render(&rig, &building, POSE, &effects, 7));
}

/// The classes of all pixels of an image.
#[divan::bench(args = [640, 1280], sample_count = 20, sample_size = 1)]
fn classes(bencher: Bencher, width: u32) {
    let effects = Effects::drawn(&mut Xoshiro256PlusPlus::seed_from_u64(7));
    let plan = plan("shape-8");
    let building = Building::new(&plan, BuildingLook::named("tiles").unwrap(), None, &effects, 7);
    let rig = rig(width);
    bencher.bench_local(|| labels(&rig, &building, POSE, &effects));
}

/// A building with all effects.
#[divan::bench(args = ["shape-8", "building-25"], sample_count = 20, sample_size = 1)]
fn building(bencher: Bencher, name: &str) {
    let effects = Effects::drawn(&mut Xoshiro256PlusPlus::seed_from_u64(7));
    let plan = plan(name);
    bencher.bench_local(|| {
        Building::new(&plan, BuildingLook::named("tiles").unwrap(), None, &effects, 7)
    });
}

/// The rays of all pixels, computed once per camera.
#[divan::bench(args = [640, 1280], sample_count = 10, sample_size = 1)]
fn rays(width: u32) -> Rig {
    rig(width)
}
