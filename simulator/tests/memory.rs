//! Sensing takes no more memory for the hundredth frame than for the first.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

#[path = "../../tests/memory/peak.rs"]
#[expect(dead_code, reason = "it is for readers, too")]
mod peak;

use std::hint::black_box;

use image::RgbImage;
use peak::MEMORY;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_model::driving::pose::Pose;
use toposlam_simulator::{
    Building, BuildingLook, Effects, Rig, learned, plan_named, render, view_sampler::ViewSampler,
};
use toposlam_vision::{camera::Camera, sensing::Sensor};

/// Poses in shape-8: in a hallway, at a corner, at a tee.
const POSES: [Pose; 3] = [
    Pose { position: [0.1, 2.1], heading: 1.5 },
    Pose { position: [0.1, 7.6], heading: 1.4 },
    Pose { position: [-0.1, 3.6], heading: 1.7 },
];

/// Memory that images and scenes keep after these rounds, and the peak.
fn taken(sensor: &mut Sensor, images: &[RgbImage], rounds: u32) -> (usize, usize) {
    MEMORY.reset_peak_usage();
    for _ in 0..rounds {
        for image in images {
            black_box(sensor.sense(image).unwrap());
        }
    }
    (MEMORY.current_usage(), MEMORY.peak_usage())
}

fn main() {
    peak::run(
        "no_frame_takes_more_memory_than_the_frames_before_it",
        no_frame_takes_more_memory_than_the_frames_before_it,
    );
}

fn no_frame_takes_more_memory_than_the_frames_before_it() {
    let camera = Camera::superscout().sized([640, 480]);
    let rig = Rig::new(&camera);
    let look = BuildingLook::named("laboratory").unwrap();
    let views = ViewSampler::from_looks([look], camera.image, 1).unwrap();
    let colours = learned(&views, look, &camera, &rig, &()).unwrap();
    let effects = Effects::drawn(&mut Xoshiro256PlusPlus::seed_from_u64(1));
    let building = Building::new(&plan_named("shape-8").unwrap(), look, None, &effects, 1);
    let images = POSES.map(|pose| render(&rig, &building, pose, &effects, 1));
    let mut sensor = Sensor::new(&camera, &colours);
    let first = taken(&mut sensor, &images, 1);
    assert_eq!(taken(&mut sensor, &images, 33), first);
}
