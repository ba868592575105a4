//! Benchmark of sensing and of each stage: `cargo bench -p toposlam-simulator --bench sensing`. All run
//! on one thread, without decoding.

#![allow(clippy::unwrap_used, reason = "a benchmark may panic")]

use divan::Bencher;
use image::RgbImage;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_model::driving::pose::Pose;
use toposlam_simulator::{
    Building, BuildingLook, Effects, Rig, learned, plan_named, render, view_sampler::ViewSampler,
};
use toposlam_vision::{
    boundary::{Bearings, Boundary},
    camera::Camera,
    cluster::clusters,
    colour::{ColourModel, ColourTable, FloorRing, Gain},
    corner::corners,
    ground_view::GroundView,
    hallway::hallway,
    junction::junction,
    line::lines,
    marker::marker,
    sensing::Sensor,
    wall::{WallFrame, WallSegment},
};

fn main() {
    divan::main();
}

/// In the floor plan shape-8: in a hallway, at a corner, at a T.
const POSES: [Pose; 3] = [
    Pose { position: [0.1, 2.1], heading: 1.5 },
    Pose { position: [0.1, 7.6], heading: 1.4 },
    Pose { position: [-0.1, 3.6], heading: 1.7 },
];

/// An image with all effects, and what the stages make of it.
struct Case {
    camera: Camera,
    colours: ColourModel,
    image: RgbImage,
    ring: FloorRing,
    table: ColourTable,
    gain: Gain,
    view: GroundView,
    bearings: Bearings,
    boundary: Boundary,
}

impl Case {
    fn new(width: u32, place: usize) -> Self {
        let camera = Camera::superscout().sized([width, width * 3 / 4]);
        let rig = Rig::new(&camera);
        let look = BuildingLook::named("laboratory").unwrap();
        let views = ViewSampler::from_looks([look], camera.image, 7).unwrap();
        let colours = learned(&views, look, &camera, &rig, &()).unwrap();
        let effects = Effects::drawn(&mut Xoshiro256PlusPlus::seed_from_u64(7));
        let building = Building::new(&plan_named("shape-8").unwrap(), look, None, &effects, 7);
        let image = render(&rig, &building, POSES[place], &effects, 7);
        let (ring, table) = (FloorRing::new(&camera), colours.table());
        let gain = colours.gain(&ring.colours(&image)).unwrap();
        let mut view = GroundView::unseen(&camera);
        view.show(&image, &table.lit(gain));
        let bearings = Bearings::new(colours.stripe, camera.eye_height());
        let boundary = bearings.look(&view);
        Self { camera, colours, image, ring, table, gain, view, bearings, boundary }
    }

    fn walls(&self) -> Option<(WallFrame, Vec<WallSegment>)> {
        let lines = lines(&clusters(&self.boundary));
        let frame = WallFrame::fit(&lines)?;
        let walls = frame.walls(&lines);
        Some((frame, walls))
    }
}

/// The whole of sensing, from the decoded image to the scene.
#[divan::bench(args = [640, 1280], consts = [0, 1, 2], sample_count = 200, sample_size = 1)]
fn whole<const PLACE: usize>(bencher: Bencher, width: u32) {
    let case = Case::new(width, PLACE);
    let mut sensor = Sensor::new(&case.camera, &case.colours);
    bencher.bench_local(|| sensor.sense(&case.image).unwrap());
}

/// The light of an image, and its table.
#[divan::bench(args = [640, 1280], sample_count = 200, sample_size = 1)]
fn step_1_light(bencher: Bencher, width: u32) {
    let case = Case::new(width, 0);
    bencher.bench_local(|| {
        let gain = case.colours.gain(&case.ring.colours(&case.image)).unwrap();
        case.table.lit(gain).class([100; 3])
    });
}

/// The ground view with classified colours.
#[divan::bench(args = [640, 1280], sample_count = 200, sample_size = 1)]
fn step_2_ground_view(bencher: Bencher, width: u32) {
    let case = Case::new(width, 0);
    let lit = case.table.lit(case.gain);
    let mut view = case.view.clone();
    bencher.bench_local(|| view.show(&case.image, &lit));
}

/// The boundary points.
#[divan::bench(sample_count = 200, sample_size = 1)]
fn step_3_boundary(bencher: Bencher) {
    let case = Case::new(1280, 2);
    bencher.bench_local(|| case.bearings.look(&case.view));
}

/// Clusters, their lines and the walls.
#[divan::bench(sample_count = 200, sample_size = 1)]
fn step_4_walls(bencher: Bencher) {
    let case = Case::new(1280, 2);
    bencher.bench_local(|| case.walls());
}

/// Finds a hallway.
#[divan::bench(consts = [0, 1, 2], sample_count = 200, sample_size = 1)]
fn step_5_hallway<const PLACE: usize>(bencher: Bencher) {
    let case = Case::new(1280, PLACE);
    let (frame, walls) = case.walls().unwrap();
    bencher.bench_local(|| hallway(&walls, &case.boundary, &frame));
}

/// Finds corners and the junction.
#[divan::bench(consts = [0, 1, 2], sample_count = 200, sample_size = 1)]
fn step_6_junction<const PLACE: usize>(bencher: Bencher) {
    let case = Case::new(1280, PLACE);
    let (frame, walls) = case.walls().unwrap();
    bencher.bench_local(|| junction(&corners(&walls), &walls, &case.boundary, &frame));
}

#[divan::bench(sample_count = 200, sample_size = 1)]
fn step_7_marker(bencher: Bencher) {
    let case = Case::new(1280, 1);
    bencher.bench_local(|| marker(&case.view, &case.boundary, None));
}
