//! The time of a camera for all 640,000 pixels of the ground view, which are computed once at the start.

use std::{fs, path::Path};

use divan::Bencher;
use toposlam_vision::{
    camera::{Camera, calibration},
    ground_view::{GroundView, Unwrapping},
};

const CALIBRATIONS: [&str; 4] = ["superscout", "ocamcalib", "camodocal", "omnidir"];

fn main() {
    divan::main();
}

fn camera(name: &str) -> Camera {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cameras");
    let mut read = |file: &str| fs::read(folder.join(file));
    let text = read(&format!("{name}.toml")).unwrap_or_default();
    calibration::read(&text, &mut read).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The pixel of each point of the floor.
#[divan::bench(args = CALIBRATIONS, sample_count = 20)]
fn ground_to_pixel(bencher: Bencher<'_, '_>, name: &str) {
    let camera = camera(name);
    bencher.bench_local(|| {
        (0..GroundView::SIDE * GroundView::SIDE)
            .filter_map(|index| camera.ground_to_pixel(GroundView::ground(index)))
            .map(|pixel| pixel.coords.sum())
            .sum::<f64>()
    });
}

/// The point of the floor of each pixel.
#[divan::bench(args = CALIBRATIONS, sample_count = 20)]
fn pixel_to_ground(bencher: Bencher<'_, '_>, name: &str) {
    let camera = camera(name);
    bencher.bench_local(|| {
        (0..960)
            .flat_map(|v| (0..1280).map(move |u| [f64::from(u), f64::from(v)]))
            .filter_map(|pixel| camera.pixel_to_ground(pixel))
            .map(|ground| ground.coords.sum())
            .sum::<f64>()
    });
}

#[divan::bench(args = CALIBRATIONS, sample_count = 20)]
fn table(bencher: Bencher<'_, '_>, name: &str) {
    let camera = camera(name);
    bencher.bench_local(|| Unwrapping::new(&camera));
}
