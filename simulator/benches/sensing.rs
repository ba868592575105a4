//! Benchmark of sensing and of each stage: `cargo bench -p toposlam-robot --bench sensing`. All run
//! on one thread, without decoding.

#![allow(clippy::unwrap_used, reason = "a benchmark may panic")]

use divan::Bencher;
use image::RgbImage;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_model::driving::pose::Pose;
use toposlam_simulator::{
    Building, BuildingLook, Effects, Rig, learned, render, view_sampler::ViewSampler,
};
use toposlam_vision::{
    boundary::{Bearings, Boundary},
    camera::Camera,
    cluster::clusters,
    colour::{ColourModel, FloorRing},
    corner::corners,
    ground_view::{GroundView, Unwrapping},
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

/// Names and poses of places in the floor plan shape-8.
const PLACES: [(&str, Pose); 3] = [
    ("hallway", Pose { position: [0.1, 2.1], heading: 1.5 }),
    ("corner", Pose { position: [0.1, 7.6], heading: 1.4 }),
    ("tee", Pose { position: [-0.1, 3.6], heading: 1.7 }),
];

/// What is built once, and images with all effects, by image width.
struct Case {
    camera: Camera,
    colours: ColourModel,
    images: [RgbImage; 3],
}

fn case(width: u32) -> Case {
    let camera = Camera::superscout().sized([width, width * 3 / 4]);
    let rig = Rig::new(&camera);
    let look = BuildingLook::named("laboratory").unwrap();
    let views = ViewSampler::from_looks([look], camera.image, 7).unwrap();
    let colours = learned(&views, look, &camera, &rig, &()).unwrap();
    let effects = Effects::drawn(&mut Xoshiro256PlusPlus::seed_from_u64(7));
    let building = Building::new(views.plan("shape-8").unwrap(), look, None, &effects, 7);
    let images = PLACES.map(|(_, pose)| render(&rig, &building, pose, &effects, 7));
    Case { camera, colours, images }
}

/// The whole of sensing, from the decoded image to the scene.
#[divan::bench(args = [640, 1280], consts = [0, 1, 2], sample_count = 200, sample_size = 1)]
fn whole<const PLACE: usize>(bencher: Bencher, width: u32) {
    let case = case(width);
    let mut sensor = Sensor::new(&case.camera, &case.colours);
    bencher.bench_local(|| sensor.sense(&case.images[PLACE]).unwrap());
}

/// The light of an image, and its table.
#[divan::bench(args = [640, 1280], sample_count = 200, sample_size = 1)]
fn step_1_light(bencher: Bencher, width: u32) {
    let case = case(width);
    let (ring, table) = (FloorRing::new(&case.camera), case.colours.table());
    bencher.bench_local(|| {
        let gain = case.colours.gain(&ring.colours(&case.images[0])).unwrap();
        table.lit(gain).class([100; 3])
    });
}

/// The ground view with classified colours.
#[divan::bench(args = [640, 1280], sample_count = 200, sample_size = 1)]
fn step_2_ground_view(bencher: Bencher, width: u32) {
    let case = case(width);
    let (ring, table) = (FloorRing::new(&case.camera), case.colours.table());
    let unwrapping = Unwrapping::new(&case.camera);
    let gain = case.colours.gain(&ring.colours(&case.images[0])).unwrap();
    let lit = table.lit(gain);
    let mut view = GroundView::unseen();
    bencher.bench_local(|| unwrapping.view(&case.images[0], &lit, &mut view));
}

/// A ground view for the following stages.
fn view(case: &Case, place: usize) -> GroundView {
    let (ring, table) = (FloorRing::new(&case.camera), case.colours.table());
    let gain = case.colours.gain(&ring.colours(&case.images[place])).unwrap();
    let mut view = GroundView::unseen();
    Unwrapping::new(&case.camera).view(&case.images[place], &table.lit(gain), &mut view);
    view
}

fn bearings(case: &Case) -> Bearings {
    Bearings::new(case.colours.stripe, case.camera.eye_height())
}

/// The boundary points.
#[divan::bench(sample_count = 200, sample_size = 1)]
fn step_3_boundary(bencher: Bencher) {
    let case = case(1280);
    let (view, bearings) = (view(&case, 2), bearings(&case));
    bencher.bench_local(|| bearings.look(&view));
}

fn walls(boundary: &Boundary) -> Option<(WallFrame, Vec<WallSegment>)> {
    let lines = lines(&clusters(boundary));
    let frame = WallFrame::of(&lines)?;
    let walls = frame.walls(&lines);
    Some((frame, walls))
}

/// Clusters, their lines and the walls.
#[divan::bench(sample_count = 200, sample_size = 1)]
fn step_4_walls(bencher: Bencher) {
    let case = case(1280);
    let boundary = bearings(&case).look(&view(&case, 2));
    bencher.bench_local(|| walls(&boundary));
}

/// Finds a hallway.
#[divan::bench(consts = [0, 1, 2], sample_count = 200, sample_size = 1)]
fn step_5_hallway<const PLACE: usize>(bencher: Bencher) {
    let case = case(1280);
    let boundary = bearings(&case).look(&view(&case, PLACE));
    let (frame, walls) = walls(&boundary).unwrap();
    bencher.bench_local(|| hallway(&walls, &boundary, &frame));
}

/// Finds corners and the junction.
#[divan::bench(consts = [0, 1, 2], sample_count = 200, sample_size = 1)]
fn step_6_junction<const PLACE: usize>(bencher: Bencher) {
    let case = case(1280);
    let boundary = bearings(&case).look(&view(&case, PLACE));
    let (frame, walls) = walls(&boundary).unwrap();
    bencher.bench_local(|| junction(&corners(&walls), &walls, &boundary, &frame));
}

/// The marker.
#[divan::bench(sample_count = 200, sample_size = 1)]
fn step_7_marker(bencher: Bencher) {
    let case = case(1280);
    let view = view(&case, 1);
    let boundary = bearings(&case).look(&view);
    bencher.bench_local(|| marker(&view, &boundary, None));
}
