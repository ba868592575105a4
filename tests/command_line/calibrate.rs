//! `toposlam camera calibrate IMAGE...`, on rendered images of a known camera.

use std::{fs, path::Path, sync::LazyLock};

use image::{ImageFormat, Rgb, RgbImage, imageops::crop_imm};
use serde_json::json;
use toposlam_vision::camera::{Camera, OpticsModel, SphericalMirror, calibration};

use super::{Scratch, has, names_in, stderr};

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

/// Reads a calibration without a mask.
fn parsed(text: &str) -> Camera {
    let nothing = &mut |_: &str| Err(std::io::ErrorKind::NotFound.into());
    calibration::read(text.as_bytes(), nothing).unwrap()
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
        let picture = image::open(scratch.path("fit.png")).unwrap().into_rgb8();
        assert_eq!(picture.dimensions(), (640, 480));
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
        for number in 0..POSES.len() {
            let text = scratch.out(&format!("camera calibrate {number}.jpg"), 0);
            close(&mirror(&parsed(&text)), &truth());
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
    let text = scratch.out(&format!("camera calibrate {images} --out camera.toml"), 0);
    assert!(text.starts_with("centre  ") && text.lines().count() == 3, "{text}");
    let expected = truth();
    let [u, v] = expected.centre.into();
    let cropped = SphericalMirror { centre: [u - 30.0, v - 60.0].into(), ..expected };
    close(&mirror(&read(&scratch.path("camera.toml"))), &cropped);
}

#[test]
fn known_values_come_from_the_initial_file() {
    let scratch = scratch("calibrate-known");
    scratch.write(
        "start.toml",
        "[camera]\nkind = \"spherical-mirror\"\nimage = [64, 48]\ncentre = [3, 4]\nfocal = 9.0\n\
         mirror_radius = 0.03\nmirror_distance = 0.08\ncamera_height = 0.75\nahead = -12.5\n\
         seen_from = \"above\"\n",
    );
    let text = scratch.out("camera calibrate 0.jpg --initial start.toml", 0);
    let camera = parsed(&text);
    let found = mirror(&camera);
    assert_eq!((found.mirror_radius, found.mirror_distance), (0.03, 0.08));
    assert_eq!((found.camera_height, camera.image), (0.75, [640, 480]));
    assert!((found.rim() - truth().rim()).abs() < 1.0);
    assert!(text.contains("ahead = -12.5 ") && text.contains("seen_from = \"above\"\n"), "{text}");
}

#[test]
fn a_rim_that_is_set_by_hand_needs_no_rim_in_the_image() {
    let scratch = scratch("calibrate-by-hand");
    let seen = |image: &str, rim: &str| {
        let calibrate = format!("camera calibrate {image} --rim {rim} --out camera.toml");
        let report = scratch.last(&calibrate, 0);
        assert_eq!(report["rim_from"], "option");
        let camera = read(&scratch.path("camera.toml"));
        let found = mirror(&camera);
        let [u, v] = found.centre.into();
        assert_eq!(camera.image, [640, 480]);
        assert_eq!(format!("{u},{v},{:.1}", found.rim()), rim);
        report["rim_seen"].as_f64().unwrap()
    };
    assert!(seen("flat.png", "305.5,240.25,326.0").abs() < f64::EPSILON);
    let [u, v] = truth().centre.into();
    assert!(seen("0.jpg", &format!("{u},{v},{:.1}", truth().rim())) > 0.6);
    let by_hand = "camera calibrate flat.png --rim 305.5,240.25,326 --out camera.toml";
    let text = scratch.out(by_hand, 0);
    assert!(text.contains("rim     326.0 pixels, given, seen over 0 % of the circle"), "{text}");
}

#[test]
fn invalid_input_is_refused_with_one_message_and_nothing_is_written() {
    let scratch = scratch("calibrate-rejected");
    for (name, size, colour) in [
        ("small.png", [320, 240], [90, 80, 70]),
        ("tiny.png", [4, 4], [90, 80, 70]),
        ("black.png", [640, 480], [0; 3]),
        ("white.png", [640, 480], [255; 3]),
    ] {
        paint(&scratch, name, size, colour);
    }
    let [jpeg, png] = ["0.jpg", "flat.png"].map(|name| scratch.bytes(name));
    scratch.write("half.jpg", &jpeg[..jpeg.len() / 2]);
    scratch.write("half.png", &png[..png.len() / 2]);
    let known = calibration::to_toml(&Camera::superscout());
    scratch.write("absurd.toml", known.replace("= 0.9 ", "= 90 "));
    scratch.write("bad.toml", "[camera]\nkind = \"pinhole\"\n");
    fs::create_dir(scratch.path("out")).unwrap();
    let much = "fuzz/corpus/image/error-promises-much";
    let other = "vision/tests/cameras/ocamcalib.toml";
    for (arguments, message) in [
        (
            "flat.png",
            "flat.png: no mirror is seen in the images: no circle has an edge along enough of its circumference; take more images from different places, or set it with --rim U,V,R",
        ),
        ("flat.png flat.png", "flat.png and 1 more: no mirror is seen"),
        ("0.jpg small.png", "small.png: the image is 320 by 240 pixels, but 0.jpg is 640 by 480"),
        ("tiny.png", "tiny.png: the image is 4 by 4 pixels; its sides should be from 16 to 16384"),
        ("fuzz/corpus/image/error-text", "fuzz/corpus/image/error-text: this is not an image"),
        ("half.png", "half.png: this cannot be read as an image: "),
        ("half.jpg", "half.jpg: this cannot be read as an image: the file is truncated"),
        (much, &format!("{much}: the image has 16384 x 16384 pixels, which are too many")),
        ("black.png", "black.png: no mirror is seen in the images"),
        ("white.png", "white.png: no mirror is seen in the images"),
        (
            "0.jpg --initial absurd.toml",
            "absurd.toml: line 8, column 17: camera.camera_height: 90 is out of range; a height above the floor in metres lies between 0.01 and 10",
        ),
        ("gone.png", "gone.png: cannot be read: "),
        (
            "0.jpg --initial bad.toml",
            "bad.toml: line 2, column 8: camera.kind: expected \"spherical-mirror\"",
        ),
        (
            &format!("0.jpg --initial {other}"),
            &format!("{other}: camera.kind: only a spherical mirror is calibrated by its rim"),
        ),
        (
            "0.jpg --mask-out out/m.png",
            "--mask-out: 1 images are too few to find what never changes; take at least 4, from different places",
        ),
        (
            "0.jpg 0.jpg 0.jpg 0.jpg --mask-out out/m.png",
            "--mask-out: almost nothing changes from image to image",
        ),
        ("0.jpg --picture fit.bmp", "fit.bmp: the name must end in .png or .jpg or .jpeg"),
        (
            "flat.png --rim 640,240,200",
            "--rim: the centre 640,240 is outside of the images, which are 640 by 480 pixels",
        ),
        ("flat.png --rim -1,240,200", "--rim: the centre -1,240 is outside of the images"),
        ("flat.png --rim 320,240,-5", "--rim: the radius is -5 pixels; it must be from 8 to 800"),
        ("flat.png --rim 320,240,900", "--rim: the radius is 900 pixels; it must be from 8 to 800"),
        (
            "flat.png --rim 320,240,500",
            "--rim: the circle of radius 500 around 320,240 is nowhere in the images",
        ),
        (
            "flat.png --rim 320,240",
            "invalid value '320,240' for '--rim <U,V,R>': write three numbers of pixels: U,V,R, as in 611,480,652",
        ),
        ("flat.png --rim 320,240,inf", "invalid value '320,240,inf' for '--rim <U,V,R>'"),
    ] {
        let output = scratch.run(&format!("camera calibrate --out out/camera.toml {arguments}"));
        let found = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{arguments}: {found}");
        assert!(found.starts_with(&format!("error: {message}")), "{arguments}: {found}");
        assert!(output.stdout.is_empty(), "{arguments}");
        assert!(names_in(&scratch.path("out")).is_empty(), "{arguments}");
    }
    let found = scratch.error("camera calibrate 0.jpg --mask-out m.png");
    assert!(found.contains("not provided:\n  --out <FILE>"), "{found}");
}
