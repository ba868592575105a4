//! Benchmark of sensing against OpenCV, frame by frame in turn, on one thread each. It compares the
//! common stages, from an image of 1280 x 960 pixels to pieces of wall in a ground view of 800 x
//! 800.
//!
//! `cargo bench -p toposlam-simulator --bench opencv` needs Python with
//! `opencv-python-headless`, which `.ci/setup benchmarks` installs for the interpreter
//! `target/opencv/bin/python`. `PYTHON` names another one. `--test` is one
//! frame.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a benchmark may panic")]

use std::{
    hint::black_box,
    io::{BufRead, BufReader, Write},
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    time::Instant,
};

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_model::{counts::grouped, driving::pose::Pose};
use toposlam_simulator::{
    Building, BuildingLook, Effects, Rig, label_mask, labels, learned, plan_named, render,
    view_sampler::ViewSampler,
};
use toposlam_vision::{
    boundary::Bearings, camera::Camera, cluster::clusters, colour::FloorRing,
    ground_view::GroundView,
};

/// The number of frames of each.
const FRAMES: usize = 101;
const OURS: [&str; 3] = ["common light", "classes on the ground", "boundary, clusters"];
const THEIRS: [&str; 4] = ["HSV", "back-projection", "unwrapping", "connected components"];

fn main() {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("opencv");
    std::fs::create_dir_all(&folder).unwrap();
    let look = BuildingLook::named("laboratory").unwrap();
    let camera = Camera::superscout();
    let rig = Rig::new(&camera);
    let views = ViewSampler::from_looks([look], camera.image, 7).unwrap();
    let colours = learned(&views, look, &camera, &rig, &()).unwrap();
    let effects = Effects::drawn(&mut Xoshiro256PlusPlus::seed_from_u64(7));
    let building = Building::new(&plan_named("shape-8").unwrap(), look, None, &effects, 7);
    let pose = Pose { position: [-0.1, 3.6], heading: 1.7 };
    let image = render(&rig, &building, pose, &effects, 7);
    image.save(folder.join("image.png")).unwrap();
    let mask = label_mask(&rig, &labels(&rig, &building, pose, &effects));
    mask.save(folder.join("labels.png")).unwrap();
    write_maps(&camera, &folder);

    let mut opencv = OpenCv::start(&folder);
    let (ring, table) = (FloorRing::new(&camera), colours.table());
    let bearings = Bearings::new(colours.stripe, camera.eye_height());
    let mut view = GroundView::unseen(&camera);
    let mut ours = || {
        let begun = Instant::now();
        let gain = colours.gain(&ring.colours(&image)).unwrap();
        let lit = table.lit(gain);
        let lighted = Instant::now();
        view.show(&image, &lit);
        let classified = Instant::now();
        black_box(clusters(&bearings.look(&view)));
        let done = Instant::now();
        [lighted - begun, classified - lighted, done - classified]
            .map(|time| time.as_secs_f64() * 1e6)
    };
    let mut times = (Vec::new(), Vec::new());
    let is_test = std::env::args().any(|word| word == "--test");
    for _ in 0..if is_test { 1 } else { FRAMES } {
        times.0.push(ours());
        times.1.push(opencv.frame());
    }
    let whole_ours = print("toposlam", &OURS, &times.0);
    let whole_theirs = print(&opencv.version, &THEIRS, &times.1);
    println!("OpenCV takes {:.1} times as long", whole_theirs / whole_ours);
}

/// Prints the median of each stage. Returns their sum, in microseconds.
fn print<const STAGES: usize>(name: &str, stages: &[&str; STAGES], times: &[[f64; STAGES]]) -> f64 {
    let medians: [f64; STAGES] = std::array::from_fn(|stage| {
        let mut times: Vec<f64> = times.iter().map(|time| time[stage]).collect();
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    });
    let whole = medians.iter().sum();
    let number = |microseconds: f64| grouped(microseconds.round() as u128);
    println!("{name}: {} us a frame, medians of {}", number(whole), times.len());
    for (stage, median) in stages.iter().zip(medians) {
        println!("  {stage:<22} {:>6} us", number(median));
    }
    whole
}

/// The pixel of the image for each pixel of the ground view, for OpenCV's remap.
fn write_maps(camera: &Camera, folder: &Path) {
    let pixels: Vec<[f32; 2]> = (0..GroundView::SIDE * GroundView::SIDE)
        .map(|index| camera.ground_to_pixel(GroundView::ground(index)))
        .map(|pixel| pixel.map_or([-1.0; 2], |pixel| pixel.map(|part| part as f32).into()))
        .collect();
    for (axis, name) in ["u.f32", "v.f32"].into_iter().enumerate() {
        let bytes: Vec<u8> = pixels.iter().flat_map(|pixel| pixel[axis].to_le_bytes()).collect();
        std::fs::write(folder.join(name), bytes).unwrap();
    }
}

/// A Python process that times OpenCV.
struct OpenCv {
    child: Child,
    answers: BufReader<std::process::ChildStdout>,
    version: String,
}

impl OpenCv {
    /// Panics if the program fails.
    fn start(folder: &Path) -> Self {
        let setup = concat!(env!("CARGO_MANIFEST_DIR"), "/../target/opencv/bin/python");
        let python = std::env::var_os("PYTHON").unwrap_or_else(|| setup.into());
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/opencv.py");
        let mut child = Command::new(python)
            .args([script.as_path(), folder])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("PYTHON names an interpreter with opencv-python-headless");
        let mut answers = BufReader::new(child.stdout.take().unwrap());
        let mut ready = String::new();
        answers.read_line(&mut ready).unwrap();
        let version = ready.strip_prefix("ready ").expect("the program says that it is ready");
        let version = format!("OpenCV {}", version.trim());
        Self { child, answers, version }
    }

    /// The microseconds of each stage of a frame.
    fn frame(&mut self) -> [f64; 4] {
        self.child.stdin.as_mut().unwrap().write_all(b"go\n").unwrap();
        let mut answer = String::new();
        self.answers.read_line(&mut answer).unwrap();
        let times: Vec<f64> = answer.split_whitespace().map(|time| time.parse().unwrap()).collect();
        times.try_into().unwrap()
    }
}

impl Drop for OpenCv {
    fn drop(&mut self) {
        drop(self.child.stdin.take());
        let _ = self.child.wait();
    }
}
