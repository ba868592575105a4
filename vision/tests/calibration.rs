//! Calibration files: an error has one message, and no bytes break the reader.

use std::io;

use proptest::{prelude::*, sample::Index};
use toposlam_vision::camera::{
    Camera, Mask,
    calibration::{self, CalibrationError},
};

use crate::{file, text};

/// Reads a calibration; each file that it names has these bytes.
fn read(calibration: &[u8], named: &[u8]) -> Result<Camera, CalibrationError> {
    calibration::read(calibration, &mut |_| Ok(named.to_vec()))
}

/// The one line of the error of a calibration; each file that it names has these bytes.
fn refusal(calibration: &[u8], named: &[u8]) -> String {
    let message = read(calibration, named).unwrap_err().to_string();
    assert!(!message.contains('\n'), "{message}");
    message
}

/// Each row changes the file that a calibration names.
fn named_file_is_refused(toml: &str, named: &str, errors: &str) {
    for [from, to, message] in rows(errors) {
        let found = refusal(&file(toml).unwrap(), changed(&text(named), &from, &to).as_bytes());
        let found = found.strip_prefix("line 3, column 8: camera.file: ").unwrap();
        assert!(found.starts_with(&message), "{to}: {found}");
    }
}

fn changed(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "{from}");
    text.replace(from, to)
}

/// The rows of a table with three columns: what is replaced, by what, and how the error begins.
fn rows(table: &str) -> impl Iterator<Item = [String; 3]> {
    table.lines().skip(1).map(|row| {
        let cells: Vec<_> = row.split(" | ").map(|cell| cell.replace(r"\n", "\n")).collect();
        cells.try_into().unwrap()
    })
}

#[test]
fn the_default_camera_has_the_superscouts_calibration() {
    assert_eq!(read(&file("superscout.toml").unwrap(), b"").unwrap(), Camera::superscout());
}

const MIRROR_ERRORS: &str = r#"
"below" | "beneath" | line 12, column 13: camera.seen_from: expected "below" or "above", found another text
"spherical-mirror" | "mirror" | line 3, column 8: camera.kind: expected "spherical-mirror" or "ocamcalib" or "mei" or "kannala-brandt", found another text
kind = "spherical-mirror" |  | line 2, column 2: camera: the key `kind` is missing
focal = 1272.8  | focus = 1272.8 | line 6, column 1: camera.focus: unknown key; expected one of: kind, image, ahead, seen_from, mask, hidden_radius, hide, centre, focal, mirror_radius, mirror_distance, camera_height, rim
focal = 1272.8  |  | line 2, column 2: camera: the key `focal` is missing
focal = 1272.8  | focal = "long" | line 6, column 9: camera.focal: expected a number, found a text
focal = 1272.8  | focal = -3 | line 6, column 9: camera.focal: -3 is out of range; a focal length in pixels lies between 1 and 1000000
focal = 1272.8  | focal = nan | line 6, column 9: camera.focal: NaN is out of range; a focal length in pixels lies between 1 and 1000000
focal = 1272.8  | focal = 1272.8 # much\nfocal = 2 | line 7, column 1: duplicate key
[640.0, 480.0] | [640.0, 960.0] | line 5, column 18: camera.centre[1]: 960 is out of range; the centre of the mirror, in the image, lies between 0 and 959
[640.0, 480.0] | [640.0] | line 5, column 10: camera.centre: expected a list of two numbers, found a list of another length
[1280, 960] | [1280, 960.5] | line 4, column 16: camera.image[1]: expected a whole number, found a decimal number
[1280, 960] | [1280, 99999] | line 4, column 16: camera.image[1]: 99999 is out of range; the side of an image in pixels lies between 16 and 16384
= 0.15  | = 0.04 | line 8, column 19: camera.mirror_distance: 0.04 is out of range; the distance of the sphere's centre in metres, more than its radius, lies between 0.05005 and 10
= 0.90  | = 90 | line 9, column 17: camera.camera_height: 90 is out of range; a height above the floor in metres lies between 0.01 and 10
rim = 450.0 | rim = 460.0 | line 10, column 7: camera.rim: 460 pixels do not agree with focal, mirror_radius and mirror_distance, which give a rim of 450.0; they must agree within 2 %
ahead = 90.0 | ahead = 1e3 | line 11, column 9: camera.ahead: 1000 is out of range; an angle in degrees lies between -360 and 360
ahead = 90.0 | ahead = 90.0\nhidden_radius = 2 | line 12, column 17: camera.hidden_radius: 2 is out of range; a radius in metres lies between 0 and 1.5
ahead = 90.0 | ahead = 90.0\nhide = [[1, 2]] | line 12, column 10: camera.hide[0][0]: expected a corner of two numbers, found a whole number
ahead = 90.0 | ahead = 90.0\nhide = [[[1, 2], [3, 4]]] | line 12, column 9: camera.hide[0]: a polygon has at least 3 corners, this one has 2
ahead = 90.0 | ahead = 90.0\nhide = [[[1, 2], [3, nan]]] | line 12, column 22: camera.hide[0][1][1]: NaN is out of range; a corner in pixels lies between -100000 and 100000
[camera] | [[camera]] | line 2, column 1: camera: expected a table, found a list
[camera] | colour = 1\n[camera] | line 2, column 1: colour: unknown key; expected one of: camera
[camera] | [camera | line 2, column 8:"#;

#[test]
fn an_error_in_a_calibration_has_its_place() {
    let toml = text("superscout.toml");
    for [from, to, message] in rows(MIRROR_ERRORS) {
        let found = refusal(changed(&toml, &from, &to).as_bytes(), b"");
        assert!(found.starts_with(&message), "{to}: {found}");
    }
    let far = changed(&changed(&toml, "rim = 450.0", ""), "focal = 1272.8", "focal = 2.5");
    for (bytes, message) in [
        (
            far.as_bytes(),
            "line 8, column 19: camera.mirror_distance: focal, mirror_radius and mirror_distance give a \
             rim of 0.88 pixels; it must be between 1 and 1000000",
        ),
        (b" \n", "the file is empty"),
        (b"#", "the key `camera` is missing"),
        (b"#\n##\xff", "line 2, column 3: this is not UTF-8 text"),
    ] {
        assert_eq!(refusal(bytes, b""), message);
    }
    for rim in ["rim = 458.9", ""] {
        assert!(read(changed(&toml, "rim = 450.0", rim).as_bytes(), b"").is_ok(), "{rim}");
    }
}

#[test]
fn an_error_in_a_file_that_a_calibration_names_has_both_names() {
    let toml = changed(&text("superscout.toml"), "[camera]", "[camera]\nmask = \"m.png\"");
    let gone = calibration::read(toml.as_bytes(), &mut |_| Err(io::ErrorKind::NotFound.into()));
    let message = "line 3, column 8: camera.mask: m.png: cannot be read: entity not found";
    assert_eq!(gone.unwrap_err().to_string(), message);
    let mask = |[width, height]: [u32; 2]| {
        let seen = vec![true; width as usize * height as usize];
        Mask::new("m.png", [width, height], seen).to_png().unwrap()
    };
    let whole = mask([1280, 960]);
    for (png, message) in [
        (
            &mask([640, 480])[..],
            "the mask is 640 by 480 pixels, the camera's images are 1280 by 960",
        ),
        (b"GIF89a", "this is not a PNG image: "),
        (&whole[..whole.len() / 2], "this is not a PNG image: "),
    ] {
        let found = refusal(toml.as_bytes(), png);
        let message = format!("line 3, column 8: camera.mask: m.png: {message}");
        assert!(found.starts_with(&message), "{found}");
    }
}

const OCAMCALIB_ERRORS: &str = r"
-2.553753e+02 | ? | calib_results.txt: line 3: expected a number, found `?`
-2.553753e+02 | inf | calib_results.txt: line 3: expected a number, found `inf`
-2.553753e+02 | 0 | calib_results.txt: the size of the first coefficient is 0; it must be between 1 and 1000000
-2.553753e+02 | -2 -2e2 | calib_results.txt: line 3: expected 5 coefficients of the polynomial, found 6
5 -2.553753e+02 | 99 -2.553753e+02 | calib_results.txt: the number of coefficients is 99; it must be between 1 and 64
480.000000 640.000000 | 480 | calib_results.txt: line 11: expected 2 numbers, the centre's row and column, found 1
480.000000 640.000000 | 640 1480 | calib_results.txt: the centre's column is 1480; it must be between 0 and 1279
1.000000 0.000000 0.000000 | 0.0 0.0 0.0 | calib_results.txt: the affine c is 0; it must be between 0.5 and 2
960 1280 | 960 | calib_results.txt: line 19: expected 2 numbers, the height and the width of the image, found 1
960 1280 |  | calib_results.txt: the file ends before the height and the width of the image
960 1280 | 960 1280\n5 | calib_results.txt: line 20: nothing should follow the size of the image
960 1280 | 960.5 1280 | calib_results.txt: the side of the image is 960.5; it must be a whole number
0.000000e+00 1.770647e-03 -2.520355e-06 9.359533e-09 | 0 300 0 0 | calib_results.txt: with these numbers no floor is seen around the middle of the image";

#[test]
fn an_error_in_ocamcalibs_file_has_its_line() {
    named_file_is_refused("ocamcalib.toml", "calib_results.txt", OCAMCALIB_ERRORS);
    let (toml, results) = (text("ocamcalib.toml"), text("calib_results.txt"));
    for (key, named, message) in [
        (
            "image = [640, 480]",
            results.as_bytes(),
            "line 2, column 9: camera.image: 640 by 480 pixels do not agree with the file, which is for images \
             of 1280 by 960",
        ),
        ("", b"\xff", "line 4, column 8: camera.file: calib_results.txt: this is not UTF-8 text"),
        (
            "rim = 450",
            results.as_bytes(),
            "line 2, column 1: camera.rim: unknown key; expected one of: kind, image, ahead, seen_from, mask, \
             hidden_radius, hide, file, viewpoint_height",
        ),
    ] {
        let toml = changed(&toml, "[camera]", &format!("[camera]\n{key}"));
        assert_eq!(refusal(toml.as_bytes(), named), message);
    }
}

const MEI_ERRORS: &str = r"
MEI | PINHOLE | camodocal.yaml: `model_type` is `PINHOLE`, not `MEI`
   xi: 1.6901164600000000e+00\n |  | camodocal.yaml: the key `mirror_parameters.xi` is missing
   xi: 1.6901164600000000e+00 |    xi: much | camodocal.yaml: line 8: expected a number, found `much`
   xi: 1.6901164600000000e+00 |    xi: -1 | camodocal.yaml: xi is -1; it must be between 0 and 100
   xi: 1.6901164600000000e+00 |    xi: 1\n   xi: 1 | camodocal.yaml: line 9: the key `mirror_parameters.xi` is repeated
   xi: 1.6901164600000000e+00 |    xi: *other | camodocal.yaml: line 8: while parsing node, found unknown anchor
   xi: 1.6901164600000000e+00 |    xi: [ | camodocal.yaml: line 9:
image_width: 1280 | image_width: 1280.5 | camodocal.yaml: image_width is 1280.5; it must be a whole number
image_width: 1280\n |  | camodocal.yaml: the key `image_width` is missing
k1: -4.8503199300000001e-01 | k1: -1e9 | camodocal.yaml: k1 is -1000000000; it must be between -1000 and 1000
image_width: 1280\nimage_height: 960\n |  | the file does not give the size of the images; the key `image` must";

#[test]
fn an_error_in_a_file_of_the_unified_model_has_its_line_or_key() {
    named_file_is_refused("camodocal.toml", "camodocal.yaml", MEI_ERRORS);
    let five = r"
2.7131395400000002e-01, | 2.7131395400000002e-01, 0., | omnidir.yml: `distortion_coefficients.data` has 5 numbers; it must have 4";
    named_file_is_refused("omnidir.toml", "omnidir.yml", five);
}

#[test]
fn opencvs_header_may_be_that_of_yaml_or_its_own() {
    let (toml, yaml) = (text("camodocal.toml"), text("camodocal.yaml"));
    let camera = read(toml.as_bytes(), yaml.as_bytes()).unwrap();
    for header in ["%YAML:1.0\n", "%YAML:1.0\n\n", "%YAML 1.0\n---\n", "---\n", "", "# camera\n"] {
        let named = changed(&yaml, "%YAML:1.0\n---\n", header);
        assert_eq!(read(toml.as_bytes(), named.as_bytes()).unwrap(), camera, "{header:?}");
    }
    let named = yaml.replace('\n', "\r\n");
    assert_eq!(read(toml.as_bytes(), named.as_bytes()).unwrap(), camera);
}

#[test]
fn nested_files_do_not_exhaust_the_stack() {
    for unit in ["[", "{a: ", "- ", "? ", "a:\n ", "a: [b,\n", "&a [*a, "] {
        let deep = unit.repeat(100_000);
        let _ = read(&file("camodocal.toml").unwrap(), deep.as_bytes());
        let _ = read(deep.as_bytes(), b"");
        let _ = read(format!("a = {deep}").as_bytes(), b"");
    }
}

proptest! {
    #[test]
    fn no_bytes_break_the_reader_of_masks(at in any::<Index>(), byte in any::<u8>(), cut in any::<Index>()) {
        let mut png = Mask::new("m", [16, 16], vec![true; 256]).to_png().unwrap();
        let index = at.index(png.len());
        png[index] = byte;
        let _ = Mask::from_png("m", &png, [16, 16]);
        png.truncate(cut.index(png.len()));
        prop_assert!(Mask::from_png("m", &png, [16, 16]).is_err() || png.len() > 40);
    }
}

const MEI: &str = "[camera]\nkind = \"mei\"\nfile = \"f\"\nviewpoint_height = 1.0\nahead = 90\n\
                   seen_from = \"below\"\nimage = [1280, 960]\n";

/// The same camera in each form in which a program writes it.
#[test]
fn the_forms_of_one_file_are_one_camera() {
    let camera = |file: &str| read(MEI.as_bytes(), file.as_bytes()).unwrap();
    let omnidir = camera(
        "%YAML:1.0\n---\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 900., 0., \
         640., 0., 910., 480., 0., 0., 1. ]\ndistortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 4\n   \
         dt: d\n   data: [ -0.2, 0.1, 0.001, -0.002 ]\nxi: 1.5\n",
    );
    assert!(omnidir.pixel_to_ground([700.0, 500.0]).is_some());
    let others = [
        // OpenCV's sample omni_calibration writes this.
        "<?xml version=\"1.0\"?>\n<opencv_storage>\n<calibration_time>\"Thu\"</calibration_time>\n\
         <camera_matrix type_id=\"opencv-matrix\">\n  <rows>3</rows>\n  <cols>3</cols>\n  <dt>d</dt>\n  <data>\n    \
         900. 0. 640. 0. 910. 480. 0.\n    0. 1.</data></camera_matrix>\n<distortion_coefficients \
         type_id=\"opencv-matrix\">\n  <rows>1</rows>\n  <cols>4</cols>\n  <dt>d</dt>\n  <data>\n    -0.2 0.1 0.001 \
         -0.002</data></distortion_coefficients>\n<xi>1.5</xi>\n</opencv_storage>\n",
        "cam0:\n  camera_model: omni\n  intrinsics: [1.5, 900.0, 910.0, 640.0, 480.0]\n  distortion_model: radtan\n  \
         distortion_coeffs: [-0.2, 0.1, 0.001, -0.002]\n  T_cn_cnm1: [[1, 0], [0, 1]]\n",
        "K: [900, 0, 640, 0, 910, 480, 0, 0, 1]\nD: [-0.2, 0.1, 0.001, -0.002]\nxi: 1.5\n",
        "K: [[900, 0, 640], [0, 910, 480], [0, 0, 1]]\nD: [[-0.2, 0.1, 0.001, -0.002]]\nxi: [1.5]\n",
    ];
    for file in others {
        assert_eq!(camera(file), omnidir, "{file}");
    }
    let kalibr = others[1].replace("T_cn_cnm1", "resolution: [1280, 960]\n  T_cn_cnm1");
    assert_eq!(camera(&kalibr).image, [1280, 960]);
}

#[test]
fn errors_in_other_forms_have_their_line() {
    let refusal = |file: &str| refusal(MEI.as_bytes(), file.as_bytes());
    for (file, message) in [
        ("<a>\n<xi>1</b></a>", "f: line 2: "),
        ("<a>\n<xi>1</xi>\n<xi>2</xi>\n</a>", "f: line 3: the key `xi` is repeated"),
        ("<a><xi>1</xi></a>", "f: the key `camera_matrix.data` is missing"),
        ("cam0:\n  camera_model: pinhole\n", "f: `cam0.camera_model` is `pinhole`, not `omni`"),
        (
            "cam0:\n  camera_model: omni\n  distortion_model: equidistant\n",
            "f: `cam0.distortion_model` is `equidistant`, not `radtan`",
        ),
    ] {
        let found = refusal(file);
        let found = found.strip_prefix("line 3, column 8: camera.file: ").unwrap();
        assert!(found.starts_with(message), "{found}");
    }
}

#[test]
fn sections_that_other_programs_add_to_ocamcalibs_file_are_ignored() {
    let (toml, results) = (file("ocamcalib.toml").unwrap(), text("calib_results.txt"));
    let more = format!("{results}\n# image circle\n\n640 480 450\n# by\n a program\n");
    assert_eq!(read(&toml, more.as_bytes()).unwrap(), read(&toml, results.as_bytes()).unwrap());
}

#[test]
fn the_file_of_another_program_is_named_with_what_to_do() {
    let kalibr = "cam0:\n  camera_model: omni\n";
    let fisheye = "cam0:\n  camera_model: pinhole\n  distortion_model: equidistant\n";
    for (file, kind) in [
        (text("calib_results.txt"), "ocamcalib"),
        (text("omnidir.yml"), "mei"),
        (text("camodocal.yaml"), "mei"),
        (kalibr.to_owned(), "mei"),
        (fisheye.to_owned(), "kannala-brandt"),
        ("<?xml version=\"1.0\"?>\n<opencv_storage>\n</opencv_storage>\n".to_owned(), "mei"),
    ] {
        let found = refusal(file.as_bytes(), b"");
        let expected = format!(
            "this is the file of another calibration program; name it in a calibration: [camera], kind = \
             \"{kind}\", file = \"...\""
        );
        assert!(found.starts_with(&expected), "{found}");
    }
}
