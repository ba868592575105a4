//! `toposlam camera calibrate IMAGE...`, on rendered images of a known camera.

use std::{fs, path::Path, sync::LazyLock};

use image::{ImageFormat, Rgb, RgbImage, imageops::crop_imm};
use serde_json::json;
use toposlam_vision::camera::{Camera, OpticsModel, SphericalMirror, calibration};

use super::{Scratch, has};

/// Poses in shape 8 with different views.
const POSES: [&str; 6] =
    ["0.1,2.3,95", "0.05,5.1,70", "2.9,7.9,200", "4.1,6.5,280", "2.3,0.1,355", "1.9,4.1,33"];
const SIX: &str = "0.jpg 1.jpg 2.jpg 3.jpg 4.jpg 5.jpg";

/// A folder with six images of one rig, and the class of each pixel of the first, `labels.png`.
fn rendered(look: &str) -> Scratch {
    let scratch = Scratch::new(&format!("calibrate-{look}"));
    // The rig stays the same. Everything else follows from the seed.
    let rig = "--effect strut-bearing=100 --effect struts=3 --effect lens=0.014";
    for (number, pose) in POSES.iter().enumerate() {
        let labels = if number == 0 { "--labels labels.png" } else { "" };
        let how = format!("--look {look} --seed {number} --size 640x480 {rig} {labels}");
        let draw = format!("draw worlds/shape-8.toml --pose {pose} --out {number}.jpg {how}");
        scratch.out(&draw, 0);
    }
    scratch
}

static LABORATORY: LazyLock<Scratch> = LazyLock::new(|| rendered("laboratory"));
static THEATRE: LazyLock<Scratch> = LazyLock::new(|| rendered("theatre"));

/// A folder with the first image of the laboratory, `0.jpg`, and one without a rim, `flat.png`.
fn scratch(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    scratch.write("0.jpg", LABORATORY.bytes("0.jpg"));
    paint(&scratch, "flat.png", [640, 480], [90, 80, 70]);
    scratch
}

fn paint(scratch: &Scratch, name: &str, size: [u32; 2], colour: [u8; 3]) {
    let image = RgbImage::from_pixel(size[0], size[1], Rgb(colour));
    image.save_with_format(scratch.path(name), ImageFormat::Png).unwrap();
}

fn truth() -> SphericalMirror {
    mirror(&Camera::superscout().sized([640, 480]))
}

fn mirror(camera: &Camera) -> SphericalMirror {
    match camera.optics {
        OpticsModel::SphericalMirror(mirror) => mirror,
        _ => unreachable!("this camera has a mirror"),
    }
}

/// Reads the camera of a calibration file.
fn read(path: &Path) -> Camera {
    let beside = path.parent().unwrap();
    let mut read = |name: &str| fs::read(beside.join(name));
    calibration::read(&fs::read(path).unwrap(), &mut read).unwrap()
}

fn close(found: &SphericalMirror, expected: &SphericalMirror) {
    let [u, v] = [0, 1].map(|axis| found.centre[axis] - expected.centre[axis]);
    assert!(u.hypot(v) < 1.0, "{found:?}");
    assert!((found.rim() - expected.rim()).abs() < 1.0, "{found:?}");
    let known = |mirror: &SphericalMirror| {
        (mirror.mirror_radius, mirror.mirror_distance, mirror.camera_height)
    };
    assert_eq!(known(found), known(expected));
}

#[test]
fn the_rim_is_found_within_a_pixel_and_the_mask_hides_the_robot() {
    for scratch in [&*LABORATORY, &*THEATRE] {
        let files = "--out camera.toml --mask-out mask.png --picture fit.png";
        let calibrate = format!("camera calibrate {SIX} {files}");
        let report = scratch.last(&calibrate, 0);
        let picture = image::open(scratch.path("fit.png")).unwrap();
        assert_eq!((picture.width(), picture.height()), (640, 480));
        let camera = read(&scratch.path("camera.toml"));
        close(&mirror(&camera), &truth());
        let expected = json!({ "images": 6, "image": [640, 480], "focal": mirror(&camera).focal });
        has(&report, &expected, &calibrate);
        assert!(report["rim_seen"].as_f64().unwrap() > 0.9, "{report}");
        let labels = image::open(scratch.path("labels.png")).unwrap().into_rgb8();
        let (mut robot, mut hidden, mut floor, mut lost) = (0, 0, 0, 0);
        for (u, v, label) in labels.enumerate_pixels() {
            let at = [f64::from(u), f64::from(v)];
            let near = |[x, y]: [f64; 2]| x.hypot(y) < 3.0;
            if camera.pixel_to_ground(at).is_none_or(|ground| !near(ground.into())) {
                continue;
            }
            let seen = camera.mask.as_ref().unwrap().sees([u, v]);
            if *label == Rgb([255; 3]) {
                robot += 1;
                hidden += u32::from(!seen);
            } else {
                floor += 1;
                lost += u32::from(!seen);
            }
        }
        assert!(robot > 3000 && f64::from(hidden) > 0.99 * f64::from(robot), "{hidden}/{robot}");
        assert!(floor > 50_000 && f64::from(lost) < 0.06 * f64::from(floor), "{lost}/{floor}");
        // One image is enough for the rim.
        for number in [0, POSES.len() - 1] {
            scratch.out(&format!("camera calibrate {number}.jpg --out one.toml"), 0);
            close(&mirror(&read(&scratch.path("one.toml"))), &truth());
        }
    }
}

#[test]
fn a_rim_cut_off_by_the_border_is_found_by_its_arcs() {
    let scratch = Scratch::new("calibrate-cropped");
    for name in SIX.split(' ') {
        let image = image::open(LABORATORY.path(name)).unwrap().into_rgb8();
        let name = name.replace("jpg", "png");
        crop_imm(&image, 30, 60, 600, 370).to_image().save(scratch.path(&name)).unwrap();
    }
    let images = SIX.replace("jpg", "png");
    scratch.out(&format!("camera calibrate {images} --out camera.toml"), 0);
    let expected = truth();
    let [u, v] = expected.centre.into();
    let cropped = SphericalMirror { centre: [u - 30.0, v - 60.0].into(), ..expected };
    close(&mirror(&read(&scratch.path("camera.toml"))), &cropped);
}

#[test]
fn known_values_come_from_the_initial_file_and_a_rim_can_be_set_by_hand() {
    let scratch = scratch("calibrate-known");
    scratch.write(
        "start.toml",
        "[camera]\nkind = \"spherical-mirror\"\nimage = [64, 48]\ncentre = [3, 4]\nfocal = 9.0\n\
         mirror_radius = 0.03\nmirror_distance = 0.08\ncamera_height = 0.75\nahead = -12.5\n\
         seen_from = \"above\"\n",
    );
    scratch.out("camera calibrate 0.jpg --initial start.toml --out camera.toml", 0);
    let camera = read(&scratch.path("camera.toml"));
    let found = mirror(&camera);
    assert_eq!((found.mirror_radius, found.mirror_distance), (0.03, 0.08));
    assert_eq!((found.camera_height, camera.image), (0.75, [640, 480]));
    assert!((found.rim() - truth().rim()).abs() < 1.0);
    let text = scratch.text("camera.toml");
    assert!(text.contains("ahead = -12.5 ") && text.contains("seen_from = \"above\"\n"), "{text}");
    // The rim may be nowhere in the image.
    let [u, v] = truth().centre.into();
    let rim = format!("{u},{v},{:.1}", truth().rim());
    for (image, rim, seen) in
        [("flat.png", "305.5,240.25,326.0", 0.0..=0.0), ("0.jpg", &rim, 0.6..=1.0)]
    {
        let calibrate = format!("camera calibrate {image} --rim {rim} --out camera.toml");
        let report = scratch.last(&calibrate, 0);
        assert_eq!(report["rim_from"], "option");
        let found = mirror(&read(&scratch.path("camera.toml")));
        let [u, v] = found.centre.into();
        assert_eq!(format!("{u},{v},{:.1}", found.rim()), rim);
        assert!(seen.contains(&report["rim_seen"].as_f64().unwrap()), "{report}");
    }
}

/// Other invalid input is in `tests/facts/calibrate.txt`.
#[test]
fn invalid_images_and_calibrations_are_refused_and_nothing_is_written() {
    let scratch = scratch("calibrate-rejected");
    paint(&scratch, "tiny.png", [4, 4], [90, 80, 70]);
    let jpeg = scratch.bytes("0.jpg");
    scratch.write("half.jpg", &jpeg[..jpeg.len() / 2]);
    let known = calibration::to_toml(&Camera::superscout());
    scratch.write("absurd.toml", known.replace("= 0.9 ", "= 90 "));
    let before = scratch.written();
    facts! { scratch;
        "camera calibrate tiny.png --out c.toml" => 2 "tiny.png: the image is 4 by 4 pixels; its sides should be";
        "camera calibrate half.jpg --out c.toml" => 2 "half.jpg: this cannot be read as an image: the file is";
        "camera calibrate 0.jpg --initial absurd.toml --out c.toml" => 2
            "absurd.toml: line 8, column 17: camera.camera_height: 90 is out of range";
    }
    assert_eq!(scratch.written(), before);
}
