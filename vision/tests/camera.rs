//! Cameras: the point of the floor that a pixel shows, for each kind of calibration file.

use nalgebra::{Point2, Vector3};
use proptest::prelude::*;
use toposlam_vision::{
    camera::{
        Camera, Mask, OpticsModel, Polygon, SeenFrom, SphericalMirror,
        calibration::{self, CalibrationError},
    },
    geometry::distance,
};

use crate::{file, text};

fn camera(name: &str) -> Camera {
    calibration::read(&file(name).unwrap(), &mut file).unwrap()
}

/// The camera of a calibration, given with the file that it names.
fn camera_of(text: &str, named: &str) -> Result<Camera, CalibrationError> {
    calibration::read(text.as_bytes(), &mut |_| Ok(named.as_bytes().to_vec()))
}

fn mirror(camera: &Camera) -> SphericalMirror {
    match camera.optics {
        OpticsModel::SphericalMirror(mirror) => mirror,
        _ => unreachable!("this camera has a mirror"),
    }
}

/// The floor that a pixel on the mirror shows, by ray tracing: from the pinhole at the origin to the
/// sphere's surface, reflected there, to the floor.
fn traced(mirror: &SphericalMirror, pixel: impl Into<Point2<f64>>) -> Option<Point2<f64>> {
    let off = pixel.into() - mirror.centre;
    let out = Vector3::new(off.x, -off.y, mirror.focal).normalize();
    let middle = mirror.mirror_distance * Vector3::z();
    let along = out.dot(&middle);
    let half_chord = mirror.mirror_radius.powi(2) - (middle - along * out).norm_squared();
    let met = (along - half_chord.sqrt()) * out;
    let normal = (met - middle).normalize();
    let back = out - 2.0 * out.dot(&normal) * normal;
    let length = -(met.z + mirror.camera_height) / back.z;
    (half_chord >= 0.0 && back.z < 0.0).then(|| Point2::from((met + length * back).xy()))
}

// paper: hardware.height
#[test]
fn the_superscouts_pixels_cover_the_expected_centimetres_of_floor() {
    let mirror = mirror(&Camera::superscout());
    // Published values, which are rounded to a tenth.
    for (range, table) in [(0.5, 0.5), (1.0, 0.9), (2.0, 2.4), (3.0, 5.2), (4.0, 9.2)] {
        let next = mirror.range(mirror.radius(range).unwrap() + 1.0).unwrap();
        let covered = 100.0 * (next - range);
        assert!((covered - table).abs() < 0.06, "{covered} centimetres at {range} metres");
    }
    assert!((mirror.rim() - 450.0).abs() < 0.01);
    assert!(mirror.range(mirror.horizon() - 1e-6).unwrap() > 1e5);
    assert_eq!(mirror.range(mirror.horizon() + 1e-6), None);
}

// paper: hardware.camera
#[test]
fn the_mirror_agrees_with_ray_tracing() {
    let camera = Camera { seen_from: SeenFrom::Above, ahead: 0.0, ..Camera::superscout() };
    let mirror = mirror(&camera);
    let mut most: f64 = 0.0;
    for v in (0..960).step_by(7) {
        for u in (0..1280).step_by(7) {
            let pixel = [f64::from(u), f64::from(v)];
            let (shown, traced) = (camera.pixel_to_ground(pixel), traced(&mirror, pixel));
            assert_eq!(shown.is_some(), traced.is_some(), "{pixel:?}");
            if let (Some(shown), Some(traced)) = (shown, traced)
                && shown.coords.norm() < 10.0
            {
                most = most.max(distance(shown, traced));
            }
        }
    }
    assert!(most < 2e-12, "{most}");
}

#[test]
fn opencv_maps_points_to_the_same_pixels() {
    // cv2.omnidir.projectPoints of OpenCV 5.0.0 for the numbers of omnidir.yml.
    let pixels = [
        ([0.5, 0.0], [643.191_222_613_784, 362.171_775_864_171]),
        ([0.0, 0.5], [758.006_890_452_049, 476.582_989_074_628]),
        ([-1.0, 0.7], [766.249_952_386_769, 652.220_379_261_138]),
        ([2.0, -1.5], [475.265_581_311_766, 254.018_766_666_357]),
        ([-0.1, -3.0], [350.651_715_775_011, 486.856_408_542_945]),
        ([10.0, 20.0], [947.827_455_083_835, 325.324_941_607_770]),
        ([0.0, 0.0], [643.25, 476.5]),
    ];
    let camera = camera("omnidir.toml");
    for (ground, pixel) in pixels {
        let found = camera.ground_to_pixel(ground).unwrap();
        assert!(distance(found, pixel) < 1e-9, "{ground:?} is at {found:?}");
        assert!(distance(camera.pixel_to_ground(pixel).unwrap(), ground) < 1e-8, "{ground:?}");
    }
}

#[test]
fn a_pixel_of_ocamcalib_looks_along_its_polynomial() {
    // cam2world as the paper prints it, computed in another language.
    let results = text("calib_results.txt");
    let results = results
        .replace("480.000000 640.000000", "471.25 655.5")
        .replace("1.000000 0.000000 0.000000", "1.0021 -0.0130 0.0085");
    let toml = text("ocamcalib.toml");
    let camera = camera_of(&toml, &results).unwrap();
    let shown = [
        ([700.0, 400.0], [0.294_792_844_901, 0.188_539_424_042]),
        ([655.5, 471.25], [0.0, 0.0]),
        ([500.0, 600.0], [-0.682_982_046_501, -0.845_699_069_233]),
        ([640.0, 200.0], [2.213_400_329_736, -0.107_851_605_743]),
        ([955.0, 471.0], [-0.041_682_698_093, 3.433_586_657_755]),
    ];
    for (pixel, ground) in shown {
        let found = camera.pixel_to_ground(pixel).unwrap();
        assert!(distance(found, ground) < 1e-10, "{pixel:?} shows {found:?}");
    }
}

#[test]
fn other_tools_calibrations_of_the_superscout_agree_with_its_mirror() {
    let mirror = Camera::superscout();
    for (name, pixels) in [("superscout", 1e-9), ("camodocal", 0.002), ("ocamcalib", 0.21)] {
        let other = camera(&format!("{name}.toml"));
        assert_eq!((other.image, other.middle()), (mirror.image, mirror.middle()));
        for step in 0..200 {
            let (range, turn) = (0.2 + 0.019 * f64::from(step), f64::from(step));
            let ground = [range * turn.cos(), range * turn.sin()];
            let found = other.ground_to_pixel(ground).unwrap();
            let expected = mirror.ground_to_pixel(ground).unwrap();
            assert!(distance(found, expected) < pixels, "{name}: {ground:?} is at {found:?}");
        }
    }
}

#[test]
fn ahead_and_left_are_as_in_the_calibration() {
    for name in ["superscout.toml", "ocamcalib.toml", "camodocal.toml"] {
        let text = text(name);
        // Ahead at the top: left is on the right when seen from below, on the left from above.
        // Ahead at the right: left is below, or above.
        for (ahead, seen_from, ahead_at, left_at) in [
            ("90.0", "below", [0.0, -1.0], [1.0, 0.0]),
            ("90.0", "above", [0.0, -1.0], [-1.0, 0.0]),
            ("0.0", "below", [1.0, 0.0], [0.0, 1.0]),
            ("-360", "above", [1.0, 0.0], [0.0, -1.0]),
        ] {
            let text = text
                .replace("ahead = 90.0", &format!("ahead = {ahead}"))
                .replace("\"below\"", &format!("\"{seen_from}\""));
            let camera = calibration::read(text.as_bytes(), &mut file).unwrap();
            let [u, v] = camera.middle().into();
            for (ground, [right, down]) in [([1.0, 0.0], ahead_at), ([0.0, 1.0], left_at)] {
                let pixel = camera.ground_to_pixel(ground).unwrap();
                let far = distance(pixel, [u, v]);
                assert!(
                    distance(pixel, [u + far * right, v + far * down]) < 1e-9,
                    "{name} {ahead}"
                );
            }
        }
    }
}

#[test]
fn either_sign_of_the_polynomial_looks_down() {
    let results = text("calib_results.txt");
    let turned = results.replace(
        "5 -2.553753e+02 0.000000e+00 1.770647e-03 -2.520355e-06 9.359533e-09",
        "5 2.553753e+02 0.000000e+00 -1.770647e-03 2.520355e-06 -9.359533e-09",
    );
    assert_ne!(results, turned);
    let toml = text("ocamcalib.toml");
    let [one, other] = [results, turned].map(|text| camera_of(&toml, &text).unwrap());
    assert_eq!(one.ground_to_pixel([1.0, 2.0]), other.ground_to_pixel([1.0, 2.0]));
}

// paper: sense.contour
#[test]
fn without_a_mask_the_floor_is_seen_from_where_the_body_ends() {
    let camera = Camera::superscout();
    let sees = |ground| {
        camera.sees(camera.ground_to_pixel(ground).unwrap().map(|at| at.round() as u32).into())
    };
    assert!(!sees([0.0, 0.0]) && !sees([0.31, 0.0]) && !sees([0.0, -0.31]));
    assert!(sees([0.33, 0.0]) && sees([0.0, -0.33]) && sees([-2.0, 1.0]));
    // The corner is outside of the mirror, the next pixel outside of the image.
    assert!(!camera.sees([0, 0]) && !camera.sees([1280, 480]) && !camera.sees([640, u32::MAX]));
}

#[test]
fn a_mask_gives_the_pixels_in_which_the_floor_is_seen() {
    let all = vec![true; 1280 * 960];
    let hidden = 300 * 1280 + 500;
    let seen = (0..all.len()).map(|pixel| pixel != hidden).collect();
    let png = Mask::new("mask.png", [1280, 960], seen).to_png().unwrap();
    let text = format!("{}mask = \"mask.png\"\n", calibration::to_toml(&Camera::superscout()));
    let camera = calibration::read(text.as_bytes(), &mut |name| {
        assert_eq!(name, "mask.png");
        Ok(png.clone())
    })
    .unwrap();
    assert!(!camera.sees([500, 300]) && camera.sees([501, 300]) && camera.sees([640, 480]));
    // Above the horizon there is no floor, whatever the mask says.
    assert!(!camera.sees([0, 0]) && !camera.sees([640 + 440, 480]));
    assert!(calibration::to_toml(&camera).contains("\nmask = \"mask.png\" "));
}

#[test]
fn what_a_calibration_hides_is_not_seen_and_the_hidden_radius_follows() {
    let camera = |more: &str| {
        let text = format!("{}{more}", calibration::to_toml(&Camera::superscout()));
        calibration::read(text.as_bytes(), &mut |_| unreachable!()).unwrap()
    };
    let corners = "[[600, 300], [700, 300], [700, 350], [600, 350]]";
    let drawn = camera(&format!("hidden_radius = 0.4\nhide = [{corners}]\n"));
    let sees_ahead = |x: f64| drawn.seen_pixel(Point2::new(x, 0.0)).is_some();
    assert!(!sees_ahead(0.39) && sees_ahead(0.41));
    assert!(!drawn.sees([650, 320]) && drawn.sees([650, 360]) && drawn.sees([590, 320]));
    let half = drawn.sized([640, 480]);
    assert!(!half.sees([325, 160]) && half.sees([325, 181]));
    let again = calibration::read(calibration::to_toml(&drawn).as_bytes(), &mut |_| unreachable!());
    assert_eq!(again.unwrap(), drawn);
    // A small polygon does not move the ring in which the floor is measured, one all round does.
    assert!((Camera::superscout().hidden_radius() - 0.32).abs() < 1e-12);
    assert!((drawn.hidden_radius() - 0.4).abs() < 0.011, "{}", drawn.hidden_radius());
    let round = |range: f64| {
        let superscout = Camera::superscout();
        let corner = |nth: u32| {
            let (y, x) = (f64::from(nth) * std::f64::consts::TAU / 60.0).sin_cos();
            let [u, v] = superscout.ground_to_pixel([range * x, range * y]).unwrap().into();
            format!("[{u:.2}, {v:.2}]")
        };
        (0..60).map(corner).collect::<Vec<_>>().join(", ")
    };
    let housing = camera(&format!("hide = [[{}]]\n", round(0.8)));
    assert!((housing.hidden_radius() - 0.8).abs() < 0.02, "{}", housing.hidden_radius());
}

#[test]
fn an_image_twice_as_large_shows_the_same_in_twice_as_many_pixels() {
    for name in ["superscout.toml", "ocamcalib.toml", "camodocal.toml", "omnidir.toml"] {
        let camera = camera(name);
        let large = camera.sized([2560, 1920]);
        for ground in [[0.0, 0.0], [0.5, 0.1], [-2.0, 1.0], [0.1, -3.0]] {
            let [u, v] = camera.ground_to_pixel(ground).unwrap().into();
            let found = large.ground_to_pixel(ground).unwrap();
            assert!(distance(found, [2.0 * u + 0.5, 2.0 * v + 0.5]) < 1e-9, "{name} {ground:?}");
            assert!(distance(large.pixel_to_ground(found).unwrap(), ground) < 1e-9, "{name}");
        }
    }
}

/// Calibrations with a spherical mirror, with and without optional keys.
fn spherical() -> impl Strategy<Value = (String, String)> {
    let optics = (100.0..4000.0, 0.01..0.3, 1.2..6.0, 0.2..2.0);
    (optics, centre(), pose()).prop_map(|((focal, radius, farther, height), [u, v], pose)| {
        let distance = radius * farther;
        let text = format!(
            "[camera]\nkind = \"spherical-mirror\"\nimage = [1280, 960]\ncentre = [{u:?}, {v:?}]\n\
             focal = {focal:?}\nmirror_radius = {radius:?}\nmirror_distance = {distance:?}\n\
             camera_height = {height:?}\n{pose}"
        );
        (text, String::new())
    })
}

/// Calibrations by OCamCalib: polynomials of mirrors and fisheyes, affine distortion, and an inverse
/// that is roughly right or wrong.
fn ocamcalib() -> impl Strategy<Value = (String, String)> {
    let polynomial = (100.0..600.0_f64, 0.2..1.2, -0.2..0.2, -0.1..0.2);
    let affine = (0.95..1.05, -0.02..0.02, -0.02..0.02);
    (polynomial, affine, centre(), height_and_pose(), any::<bool>()).prop_map(
        |((focal, a2, a3, a4), (c, d, e), [column, row], pose, wrong)| {
            let scaled = [a2 / focal, a3 / focal.powi(2), a4 / focal.powi(3)];
            let inverse = if wrong { -7.0 } else { focal };
            let results = format!(
                "#polynomial\n\n5 {:e} 0 {:e} {:e} {:e} \n\n#inverse\n\n2 {inverse} {inverse}\n\n\
                 #center\n\n{row} {column}\n\n#affine\n\n{c} {d} {e}\n\n#size\n\n960 1280\n",
                -focal, scaled[0], scaled[1], scaled[2]
            );
            (format!("[camera]\nkind = \"ocamcalib\"\nfile = \"f\"\n{pose}"), results)
        },
    )
}

/// Calibrations in the unified model, in camodocal's form or in OpenCV's.
fn mei() -> impl Strategy<Value = (String, String)> {
    let optics = (0.0..3.0, 200.0..1500.0, 0.97..1.03, -2.0..2.0);
    let distortion = (-0.5..0.5, -0.3..2.0, -0.005..0.005, -0.005..0.005);
    (optics, distortion, centre(), height_and_pose(), any::<bool>()).prop_map(
        |((xi, focal, ratio, skew), (k1, k2, p1, p2), [u, v], pose, opencv)| {
            let down = focal * ratio;
            let yaml = if opencv {
                format!(
                    "%YAML:1.0\n---\nK: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   \
                     data: [ {focal}, {skew}, {u},\n       0., {down}, {v}, 0., 0., 1. ]\n\
                     xi: !!opencv-matrix\n   rows: 1\n   cols: 1\n   dt: d\n   data: [ {xi} ]\n\
                     D: !!opencv-matrix\n   rows: 1\n   cols: 4\n   dt: d\n   \
                     data: [ {k1}, {k2}, {p1}, {p2} ]\n"
                )
            } else {
                format!(
                    "%YAML:1.0\n---\nmodel_type: MEI\ncamera_name: c\nimage_width: 1280\n\
                     image_height: 960\nmirror_parameters:\n   xi: {xi}\ndistortion_parameters:\n   \
                     k1: {k1}\n   k2: {k2}\n   p1: {p1}\n   p2: {p2}\nprojection_parameters:\n   \
                     gamma1: {focal}\n   gamma2: {down}\n   u0: {u}\n   v0: {v}\n"
                )
            };
            let text = format!(
                "[camera]\nkind = \"mei\"\nfile = \"f\"\nimage = [1280, 960]\n{pose}"
            );
            (text, yaml)
        },
    )
}

/// Calibrations of fisheyes, tilted from straight down, in Kalibr's form or in OpenCV's.
fn fisheye() -> impl Strategy<Value = (String, String)> {
    let optics = (200.0..900.0, 0.97..1.03, 0..=60_i32);
    let distortion = (-0.03..0.1, -0.01..0.02, -0.002..0.003, -0.0003..0.0004);
    (optics, distortion, centre(), height_and_pose(), any::<bool>()).prop_map(
        |((focal, ratio, tilt), (k1, k2, k3, k4), [u, v], pose, opencv)| {
            let down = focal * ratio;
            let yaml = if opencv {
                format!("K: [[{focal}, 0.1, {u}], [0, {down}, {v}], [0, 0, 1]]\nD: [{k1}, {k2}, {k3}, {k4}]\n")
            } else {
                format!(
                    "cam0:\n  camera_model: pinhole\n  distortion_model: equidistant\n  intrinsics: [{focal}, \
                     {down}, {u}, {v}]\n  distortion_coeffs: [{k1}, {k2}, {k3}, {k4}]\n"
                )
            };
            let text = format!(
                "[camera]\nkind = \"kannala-brandt\"\nfile = \"f\"\nimage = [1280, 960]\ntilt = {tilt}\n{pose}"
            );
            (text, yaml)
        },
    )
}

fn centre() -> impl Strategy<Value = [f64; 2]> {
    [500.0..780.0, 380.0..580.0]
}

fn pose() -> impl Strategy<Value = String> {
    (-360.0..360.0, any::<bool>()).prop_map(|(ahead, above)| {
        let seen_from = if above { "above" } else { "below" };
        format!("ahead = {ahead:?}\nseen_from = \"{seen_from}\"\n")
    })
}

fn height_and_pose() -> impl Strategy<Value = String> {
    (0.2..2.0, pose()).prop_map(|(height, pose)| format!("viewpoint_height = {height:?}\n{pose}"))
}

/// From pixel to floor and back, and from floor to pixel and back.
fn round_trips(camera: &Camera, pixel: [f64; 2], ground: [f64; 2]) -> Result<(), TestCaseError> {
    if let Some(shown) = camera.pixel_to_ground(pixel).filter(|at| at.coords.norm() < 200.0) {
        let back = camera.ground_to_pixel(shown).unwrap();
        prop_assert!(
            distance(back, pixel) < 1e-3,
            "{pixel:?} shows {shown:?}, which is at {back:?}"
        );
    }
    let height = camera.height();
    prop_assert!(camera.ground_to_pixel([0.4 * height, 0.3 * height]).is_some());
    if let Some(at) = camera.ground_to_pixel(ground) {
        let back = camera.pixel_to_ground(at).unwrap();
        prop_assert!(
            distance(back, ground) < 1e-6,
            "{ground:?} is at {at:?}, which shows {back:?}"
        );
        let ray = camera.ray(at).unwrap();
        prop_assert!((ray.direction.norm() - 1.0).abs() < 1e-12);
        prop_assert!(distance(ray.floor().unwrap(), ground) < 1e-6);
    }
    Ok(())
}

fn pixel() -> impl Strategy<Value = [f64; 2]> {
    [0.0..1280.0, 0.0..960.0]
}

/// Floor from a millimetre to 200 m away.
fn ground() -> impl Strategy<Value = [f64; 2]> {
    (-3.0..2.3, 0.0..std::f64::consts::TAU).prop_map(|(power, turn): (f64, f64)| {
        let range = 10.0_f64.powf(power);
        [range * turn.cos(), range * turn.sin()]
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

    #[test]
    fn a_spherical_mirror_maps_pixels_to_floor_and_back(
        (text, named) in spherical(), pixel in pixel(), ground in ground(),
    ) {
        let camera = camera_of(&text, &named).unwrap();
        prop_assert!(camera.ground_to_pixel(ground).is_some());
        round_trips(&camera, pixel, ground)?;
        let traced = traced(&mirror(&camera), camera.ground_to_pixel(ground).unwrap()).unwrap();
        let range = ground[0].hypot(ground[1]);
        prop_assert!((traced.coords.norm() - range).abs() < 1e-10 * (1.0 + range * range));
    }

    #[test]
    fn a_single_viewpoint_maps_pixels_to_floor_and_back(
        (text, named) in prop_oneof![ocamcalib(), mei(), fisheye()], pixel in pixel(), ground in ground(),
    ) {
        round_trips(&camera_of(&text, &named).unwrap(), pixel, ground)?;
    }

    #[test]
    fn a_calibration_is_written_as_it_was_read(
        (text, named) in prop_oneof![spherical(), ocamcalib(), mei()],
    ) {
        let camera = camera_of(&text, &named).unwrap();
        let mut again = camera_of(&calibration::to_toml(&camera), &named).unwrap();
        prop_assert!((again.ahead - camera.ahead).abs() < 1e-14);
        again.ahead = camera.ahead;
        prop_assert_eq!(again, camera);
    }
}

#[test]
fn a_mask_hides_a_drawn_polygon_inside_of_the_rim() {
    let mut mask = Mask::circle("m", [20, 10], [9.0, 5.0].into(), 4.5);
    assert!(mask.sees([13, 5]) && !mask.sees([14, 5]) && !mask.sees([9, 0]));
    // An arrow's head: its notch is seen.
    let corners = [[5.5, 2.5], [12.5, 2.5], [9.0, 4.8], [12.5, 7.5], [5.5, 7.5]];
    let polygon = Polygon::from_corners(corners.map(Point2::from).to_vec()).unwrap();
    mask.hide(|pixel| polygon.contains(pixel));
    assert!(!mask.sees([6, 5]) && !mask.sees([11, 3]) && mask.sees([11, 5]) && mask.sees([9, 8]));
}

/// The numbers of a fisheye in OpenCV's form, and its calibration.
fn lens(numbers: &str, more: &str) -> Camera {
    let text = format!(
        "[camera]\nkind = \"kannala-brandt\"\nfile = \"f\"\nimage = [1280, 960]\nviewpoint_height = 0.5\n\
         ahead = 90\nseen_from = \"above\"\n{more}"
    );
    let yaml = format!("K: [300, 0, 640, 0, 300, 480, 0, 0, 1]\nD: [{numbers}]\n");
    camera_of(&text, &yaml).unwrap()
}

#[test]
fn a_fisheye_sees_an_angle_where_the_published_polynomial_is() {
    let camera = lens("0.1, -0.02, 0.003, -0.0004", "");
    // 300 (theta + 0.1 theta^3 - 0.02 theta^5 + 0.003 theta^7 - 0.0004 theta^9) at 45 degrees.
    let radius = 248.512_821_262;
    let [u, v] = camera.ground_to_pixel([0.5, 0.0]).unwrap().into();
    assert!((u - 640.0).abs() < 1e-9 && (v - (480.0 - radius)).abs() < 1e-6, "{u} {v}");
    let [x, y] = camera.pixel_to_ground([640.0 + radius, 480.0]).unwrap().into();
    assert!(x.abs() < 1e-9 && (y + 0.5).abs() < 1e-9, "{x} {y}");
}

#[test]
fn a_forward_camera_sees_the_floor_below_the_middle_of_its_image() {
    let camera = lens("0, 0, 0, 0", "tilt = 90\n");
    assert_eq!(camera.pixel_to_ground([640.0, 479.0]), None);
    let eighth = std::f64::consts::FRAC_PI_4;
    let [x, y] = camera.pixel_to_ground([640.0, 480.0 + 300.0 * eighth]).unwrap().into();
    assert!((x - 0.5).abs() < 1e-9 && y.abs() < 1e-9, "{x} {y}");
    assert!(camera.pixel_to_ground([600.0, 600.0]).unwrap().y > 0.0);
    // Straight down is a quarter turn below the axis.
    assert!((camera.middle().y - (480.0 + 600.0 * eighth)).abs() < 1e-9);
    let again = calibration::to_toml(&camera);
    let yaml = "K: [300, 0, 640, 0, 300, 480, 0, 0, 1]\nD: [0, 0, 0, 0]\n";
    assert_eq!(camera_of(&again, yaml).unwrap(), camera);
}
