//! `toposlam calibrate IMAGE...`, on rendered images of a known camera.

use std::{fs, path::Path, sync::LazyLock};

use image::{ImageFormat, Rgb, RgbImage, imageops::crop_imm};
use serde_json::Value;
use toposlam_vision::camera::{Camera, OpticsModel, SphericalMirror, calibration};

use super::{folder, names_in, objects, run, stderr, stdout, stdout_of};

/// Poses in shape 8 with different views.
const POSES: [&str; 6] =
    ["0.1,2.3,95", "0.05,5.1,70", "2.9,7.9,200", "4.1,6.5,280", "2.3,0.1,355", "1.9,4.1,33"];

/// Images of one rig, and the class of each pixel of the first.
struct Images {
    files: Vec<String>,
    labels: RgbImage,
}

fn rendered(look: &str) -> Images {
    let folder = folder(&format!("calibrate-{look}"));
    let file = |name: String| folder.join(name).to_str().unwrap().to_owned();
    let labels = file("labels.png".to_owned());
    let files: Vec<String> = (0..POSES.len()).map(|number| file(format!("{number}.jpg"))).collect();
    for (number, (path, pose)) in files.iter().zip(POSES).enumerate() {
        let seed = number.to_string();
        let mut arguments = vec!["draw", "worlds/shape-8.toml", "--pose", pose, "--look", look];
        arguments.extend(["--seed", &seed, "--size", "640x480", "--out", path]);
        // The rig stays the same. Everything else follows from the seed.
        for effect in ["strut-bearing=100", "struts=3", "lens=0.014"] {
            arguments.extend(["--effect", effect]);
        }
        if number == 0 {
            arguments.extend(["--labels", &labels]);
        }
        stdout_of(arguments);
    }
    Images { files, labels: image::open(labels).unwrap().into_rgb8() }
}

static LABORATORY: LazyLock<Images> = LazyLock::new(|| rendered("laboratory"));
static THEATRE: LazyLock<Images> = LazyLock::new(|| rendered("theatre"));

fn truth() -> SphericalMirror {
    mirror(&Camera::superscout().sized([640, 480]))
}

fn mirror(camera: &Camera) -> SphericalMirror {
    match camera.optics {
        OpticsModel::SphericalMirror(mirror) => mirror,
        _ => unreachable!("this camera has a mirror"),
    }
}

fn calibrate<'a>(images: &'a [String], more: &[&'a str]) -> Vec<&'a str> {
    let images: Vec<&str> = images.iter().map(String::as_str).collect();
    [&["camera", "calibrate"], &images[..], more].concat()
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
    for (images, name) in [(&*LABORATORY, "laboratory"), (&*THEATRE, "theatre")] {
        let folder = folder(&format!("calibrated-{name}"));
        let [out, mask, fit] = ["camera.toml", "mask.png", "fit.png"].map(|name| folder.join(name));
        let report = stdout_of(calibrate(
            &images.files,
            &[
                "--json",
                "--out",
                out.to_str().unwrap(),
                "--mask-out",
                mask.to_str().unwrap(),
                "--picture",
                fit.to_str().unwrap(),
            ],
        ));
        assert_eq!(names_in(&folder), ["camera.toml", "fit.png", "mask.png"]);
        assert_eq!(image::open(&fit).unwrap().into_rgb8().dimensions(), (640, 480));
        let camera = read(&out);
        close(&mirror(&camera), &truth());
        let [report]: [Value; 1] = objects(&report).try_into().unwrap();
        assert_eq!(report["images"], 6);
        assert_eq!(report["image"], serde_json::json!([640, 480]));
        assert_eq!(report["focal"], mirror(&camera).focal);
        assert!(report["rim_seen"].as_f64().unwrap() > 0.9, "{report}");
        let (mut robot, mut hidden, mut floor, mut lost) = (0, 0, 0, 0);
        for (u, v, label) in images.labels.enumerate_pixels() {
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
    }
}

#[test]
fn one_image_is_enough_for_the_rim() {
    for images in [&*LABORATORY, &*THEATRE] {
        for image in images.files.chunks(1) {
            let text = stdout_of(calibrate(image, &[]));
            let nothing = &mut |_: &str| Err(std::io::ErrorKind::NotFound.into());
            close(&mirror(&calibration::read(text.as_bytes(), nothing).unwrap()), &truth());
        }
    }
}

#[test]
fn a_rim_cut_off_by_the_border_is_found_by_its_arcs() {
    let folder = folder("calibrate-cropped");
    let files: Vec<String> = LABORATORY
        .files
        .iter()
        .enumerate()
        .map(|(number, file)| {
            let path = folder.join(format!("{number}.png"));
            let image = image::open(file).unwrap().into_rgb8();
            crop_imm(&image, 30, 60, 600, 370).to_image().save(&path).unwrap();
            path.to_str().unwrap().to_owned()
        })
        .collect();
    let out = folder.join("camera.toml");
    let text = stdout_of(calibrate(&files, &["--out", out.to_str().unwrap()]));
    assert!(text.starts_with("centre  ") && text.lines().count() == 3, "{text}");
    let expected = truth();
    let [u, v] = expected.centre.into();
    close(
        &mirror(&read(&out)),
        &SphericalMirror { centre: [u - 30.0, v - 60.0].into(), ..expected },
    );
}

#[test]
fn known_values_come_from_the_initial_file() {
    let folder = folder("calibrate-known");
    let start = folder.join("start.toml");
    fs::write(
        &start,
        "[camera]\nkind = \"spherical-mirror\"\nimage = [64, 48]\ncentre = [3, 4]\nfocal = 9.0\n\
         mirror_radius = 0.03\nmirror_distance = 0.08\ncamera_height = 0.75\nahead = -12.5\n\
         seen_from = \"above\"\n",
    )
    .unwrap();
    let more = ["--initial", start.to_str().unwrap()];
    let text = stdout_of(calibrate(&LABORATORY.files[..1], &more));
    let nothing = &mut |_: &str| Err(std::io::ErrorKind::NotFound.into());
    let camera = calibration::read(text.as_bytes(), nothing).unwrap();
    let found = mirror(&camera);
    assert_eq!((found.mirror_radius, found.mirror_distance), (0.03, 0.08));
    assert_eq!((found.camera_height, camera.image), (0.75, [640, 480]));
    assert!((found.rim() - truth().rim()).abs() < 1.0);
    assert!(text.contains("ahead = -12.5 ") && text.contains("seen_from = \"above\"\n"), "{text}");
}

#[test]
fn a_rim_that_is_set_by_hand_needs_no_rim_in_the_image() {
    let folder = folder("calibrate-by-hand");
    let flat = folder.join("flat.png");
    RgbImage::from_pixel(640, 480, Rgb([90, 80, 70])).save(&flat).unwrap();
    let out = folder.join("camera.toml");
    let [out, flat] = [&out, &flat].map(|path| path.to_str().unwrap());
    let seen = |image: &str, rim: &str| {
        let report =
            stdout_of(["camera", "calibrate", image, "--rim", rim, "--json", "--out", out]);
        let [report]: [Value; 1] = objects(&report).try_into().unwrap();
        assert_eq!(report["rim_from"], "option");
        let camera = read(Path::new(out));
        let found = mirror(&camera);
        let [u, v] = found.centre.into();
        assert_eq!(camera.image, [640, 480]);
        assert_eq!(format!("{u},{v},{:.1}", found.rim()), rim);
        report["rim_seen"].as_f64().unwrap()
    };
    assert!(seen(flat, "305.5,240.25,326.0").abs() < f64::EPSILON);
    let [u, v] = truth().centre.into();
    let rim = format!("{u},{v},{:.1}", truth().rim());
    assert!(seen(&LABORATORY.files[0], &rim) > 0.6);
    let text = stdout_of(["camera", "calibrate", flat, "--rim", "305.5,240.25,326", "--out", out]);
    assert!(text.contains("rim     326.0 pixels, given, seen over 0 % of the circle"), "{text}");
}

#[test]
fn a_rim_that_cannot_be_that_of_a_mirror_in_the_image_is_refused() {
    let folder = folder("calibrate-no-rim");
    let flat = folder.join("flat.png");
    RgbImage::from_pixel(640, 480, Rgb([90, 80, 70])).save(&flat).unwrap();
    let cases = [
        (
            "640,240,200",
            "--rim: the centre 640,240 is outside of the images, which are 640 by 480 pixels",
        ),
        ("-1,240,200", "--rim: the centre -1,240 is outside of the images"),
        ("320,240,-5", "--rim: the radius is -5 pixels; it must be from 8 to 800"),
        ("320,240,900", "--rim: the radius is 900 pixels; it must be from 8 to 800"),
        ("320,240,500", "--rim: the circle of radius 500 around 320,240 is nowhere in the images"),
        (
            "320,240",
            "invalid value '320,240' for '--rim <U,V,R>': write three numbers of pixels: U,V,R, as in 611,480,652",
        ),
        ("320,240,inf", "invalid value '320,240,inf' for '--rim <U,V,R>'"),
    ];
    for (rim, message) in cases {
        let output = run(["camera", "calibrate", flat.to_str().unwrap(), "--rim", rim]);
        assert_eq!(output.status.code(), Some(2), "{rim}");
        assert!(stderr(&output).contains(message), "{rim}: {}", stderr(&output));
        assert!(stdout(&output).is_empty(), "{rim}");
    }
}

#[test]
fn invalid_input_is_refused_with_one_message_and_nothing_is_written() {
    let folder = folder("calibrate-rejected");
    let inputs = super::folder("calibrate-rejected-inputs");
    let input = |name: &str, bytes: &[u8]| {
        fs::write(inputs.join(name), bytes).unwrap();
        inputs.join(name).to_str().unwrap().to_owned()
    };
    let picture = |name: &str, size: [u32; 2], colour: [u8; 3]| {
        let path = inputs.join(name);
        let image = RgbImage::from_pixel(size[0], size[1], Rgb(colour));
        image.save_with_format(&path, ImageFormat::Png).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let image = LABORATORY.files[0].as_str();
    let [flat, small, tiny] = [
        picture("flat.png", [640, 480], [90, 80, 70]),
        picture("small.png", [320, 240], [90, 80, 70]),
        picture("tiny.png", [4, 4], [90, 80, 70]),
    ];
    let text = input("text.png", b"this is no image");
    let jpeg = fs::read(image).unwrap();
    let half_jpeg = input("half.jpg", &jpeg[..jpeg.len() / 2]);
    let png = fs::read(&flat).unwrap();
    let half_png = input("half.png", &png[..png.len() / 2]);
    let black = picture("black.png", [640, 480], [0; 3]);
    let white = picture("white.png", [640, 480], [255; 3]);
    let known = calibration::to_toml(&Camera::superscout());
    let absurd = input("absurd.toml", known.replace("= 0.9 ", "= 90 ").as_bytes());
    let promises_much =
        concat!(env!("CARGO_MANIFEST_DIR"), "/fuzz/corpus/image/error-promises-much");
    let bad = input("bad.toml", b"[camera]\nkind = \"pinhole\"\n");
    let other = concat!(env!("CARGO_MANIFEST_DIR"), "/vision/tests/cameras/ocamcalib.toml");
    let out = folder.join("camera.toml").to_str().unwrap().to_owned();
    let mask = folder.join("mask.png").to_str().unwrap().to_owned();
    let cases: [(&[&str], String); 17] = [
        (&[&flat], format!("{flat}: no mirror is seen in the images: no circle has an edge along enough of its circumference; take more images from different places, or set it with --rim U,V,R")),
        (&[&flat, &flat], format!("{flat} and 1 more: no mirror is seen")),
        (&[image, &small], format!("{small}: the image is 320 by 240 pixels, but {image} is 640 by 480")),
        (&[&tiny], format!("{tiny}: the image is 4 by 4 pixels; its sides should be from 16 to 16384")),
        (&[&text], format!("{text}: this is not an image")),
        (&[&half_png], format!("{half_png}: this cannot be read as an image: ")),
        (&[&half_jpeg], format!("{half_jpeg}: this cannot be read as an image: the file is truncated")),
        (&[promises_much], format!("{promises_much}: the image has 16384 x 16384 pixels, which are too many")),
        (&[&black], format!("{black}: no mirror is seen in the images")),
        (&[&white], format!("{white}: no mirror is seen in the images")),
        (&[image, "--initial", &absurd], format!("{absurd}: line 8, column 17: camera.camera_height: 90 is out of range; a height above the floor in metres lies between 0.01 and 10")),
        (&["gone.png"], "gone.png: cannot be read: ".to_owned()),
        (&[image, "--initial", &bad], format!("{bad}: line 2, column 8: camera.kind: expected \"spherical-mirror\"")),
        (&[image, "--initial", other], format!("{other}: camera.kind: only a spherical mirror is calibrated by its rim")),
        (&[image, "--mask-out", &mask], "--mask-out: 1 images are too few to find what never changes; take at least 4, from different places".to_owned()),
        (&[image, image, image, image, "--mask-out", &mask], "--mask-out: almost nothing changes from image to image".to_owned()),
        (&[image, "--picture", "fit.bmp"], "fit.bmp: the name must end in .png or .jpg or .jpeg".to_owned()),
    ];
    for (arguments, message) in cases {
        let output = run([&["camera", "calibrate", "--out", &out], arguments].concat());
        let found = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {found}");
        assert!(found.starts_with(&format!("error: {message}")), "{arguments:?}: {found}");
        assert_eq!(found.lines().count(), 1, "{arguments:?}: {found}");
        assert!(stdout(&output).is_empty() && names_in(&folder).is_empty(), "{arguments:?}");
    }
    let output = run(["camera", "calibrate", image, "--mask-out", &mask]);
    assert!(stderr(&output).contains("not provided:\n  --out <FILE>"));
}
