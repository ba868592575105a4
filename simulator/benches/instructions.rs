//! The instructions that sensing one image of 640 x 480 takes, which do not depend on the load of the machine: `cargo
//! bench -p toposlam-simulator --bench instructions`. It needs Valgrind and the program `gungraun-runner`, which
//! `.ci/setup benchmarks` installs.

#![allow(clippy::unwrap_used, reason = "a benchmark may panic")]
#![allow(unused_qualifications, reason = "the macros of gungraun have some")]

use std::hint::black_box;

use gungraun::{library_benchmark, library_benchmark_group, main};
use image::RgbImage;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_model::driving::{pose::Pose, scene::Scene};
use toposlam_simulator::{
    Building, BuildingLook, Effects, Rig, learned, plan_named, render, view_sampler::ViewSampler,
};
use toposlam_vision::{camera::Camera, sensing::Sensor};

/// At a T of the floor plan shape-8, with all effects.
fn at_a_t() -> (Sensor, RgbImage) {
    let look = BuildingLook::named("laboratory").unwrap();
    // Colours are learned from small images, as Valgrind takes fifty times as long.
    let small = Camera::superscout().sized([160, 120]);
    let views = ViewSampler::from_looks([look], small.image, 7).unwrap();
    let colours = learned(&views, look, &small, &Rig::new(&small), &()).unwrap();
    let camera = Camera::superscout().sized([640, 480]);
    let effects = Effects::drawn(&mut Xoshiro256PlusPlus::seed_from_u64(7));
    let building = Building::new(&plan_named("shape-8").unwrap(), look, None, &effects, 7);
    let pose = Pose { position: [-0.1, 3.6], heading: 1.7 };
    let image = render(&Rig::new(&camera), &building, pose, &effects, 7);
    (Sensor::new(&camera, &colours), image)
}

#[library_benchmark]
#[bench::at_a_t(at_a_t())]
fn sense((mut sensor, image): (Sensor, RgbImage)) -> (Sensor, Scene) {
    let scene = sensor.sense(black_box(&image)).unwrap();
    (sensor, scene)
}

library_benchmark_group!(name = sensing, benchmarks = sense);
main!(library_benchmark_groups = sensing);
