//! Calibration files: an error has one message, and no bytes break the reader.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

use std::{fs, io, path::Path};

use proptest::{collection::vec, prelude::*, sample::Index};
use toposlam_vision::{
    camera::{
        Camera, Mask,
        calibration::{self, CalibrationError},
    },
    fuzz,
};

fn file(name: &str) -> Vec<u8> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cameras");
    fs::read(folder.join(name)).unwrap()
}

fn text(name: &str) -> String {
    String::from_utf8(file(name)).unwrap()
}

/// Reads a calibration; each file that it names has these bytes.
fn read(calibration: &[u8], named: &[u8]) -> Result<Camera, CalibrationError> {
    calibration::read(calibration, &mut |_| Ok(named.to_vec()))
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
    assert_eq!(read(&file("superscout.toml"), b"").unwrap(), Camera::superscout());
}

const MIRROR_ERRORS: &str = r#"
"below" | "beneath" | line 12, column 13: camera.seen_from: expected "below" or "above", found another text
"spherical-mirror" | "mirror" | line 3, column 8: camera.kind: expected "spherical-mirror" or "ocamcalib" or "mei", found another text
kind = "spherical-mirror" |  | line 2, column 2: camera: the key `kind` is missing
focal = 1272.8  | focus = 1272.8 | line 6, column 1: camera.focus: unknown key; expected one of: kind, image, ahead, seen_from, mask, centre, focal, mirror_radius, mirror_distance, camera_height, rim
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
[camera] | [[camera]] | line 2, column 1: camera: expected a table, found a list
[camera] | colour = 1\n[camera] | line 2, column 1: colour: unknown key; expected one of: camera
[camera] | [camera | line 2, column 8:"#;

#[test]
fn an_error_in_a_calibration_has_its_place() {
    let toml = text("superscout.toml");
    for [from, to, message] in rows(MIRROR_ERRORS) {
        let found = read(changed(&toml, &from, &to).as_bytes(), b"").unwrap_err().to_string();
        assert!(found.starts_with(&message) && !found.contains('\n'), "{to}: {found}");
    }
    let far = changed(&changed(&toml, "rim = 450.0", ""), "focal = 1272.8", "focal = 2.5");
    assert_eq!(
        read(far.as_bytes(), b"").unwrap_err().to_string(),
        "line 8, column 19: camera.mirror_distance: focal, mirror_radius and mirror_distance give a rim \
         of 0.88 pixels; it must be between 1 and 1000000"
    );
    assert!(read(changed(&toml, "rim = 450.0", "rim = 458.9").as_bytes(), b"").is_ok());
    assert!(read(changed(&toml, "rim = 450.0", "").as_bytes(), b"").is_ok());
    assert_eq!(read(b" \n", b"").unwrap_err().to_string(), "the file is empty");
    assert_eq!(read(b"#", b"").unwrap_err().to_string(), "the key `camera` is missing");
    let message = "line 2, column 3: this is not UTF-8 text";
    assert_eq!(read(b"#\n##\xff", b"").unwrap_err().to_string(), message);
}

#[test]
fn an_error_in_a_file_that_a_calibration_names_has_both_names() {
    let toml = changed(&text("superscout.toml"), "[camera]", "[camera]\nmask = \"m.png\"");
    let gone = calibration::read(toml.as_bytes(), &mut |_| Err(io::ErrorKind::NotFound.into()));
    let message = "line 3, column 8: camera.mask: m.png: cannot be read: entity not found";
    assert_eq!(gone.unwrap_err().to_string(), message);
    let small = Mask::new("m.png", [640, 480], vec![true; 640 * 480]).to_png().unwrap();
    let message = "line 3, column 8: camera.mask: m.png: the mask is 640 by 480 pixels, the camera's images are 1280 by 960";
    assert_eq!(read(toml.as_bytes(), &small).unwrap_err().to_string(), message);
    let message = "line 3, column 8: camera.mask: m.png: this is not a PNG image: ";
    assert!(read(toml.as_bytes(), b"GIF89a").unwrap_err().to_string().starts_with(message));
    let half = Mask::new("m.png", [1280, 960], vec![true; 1280 * 960]).to_png().unwrap();
    assert!(read(toml.as_bytes(), &half[..half.len() / 2]).is_err());
}

const OCAMCALIB_ERRORS: &str = r"
-2.553753e+02 | ? | line 3: expected a number, found `?`
-2.553753e+02 | inf | line 3: expected a number, found `inf`
-2.553753e+02 | 0 | the size of the first coefficient is 0; it must be between 1 and 1000000
-2.553753e+02 | -2 -2e2 | line 3: expected 5 coefficients of the polynomial, found 6
5 -2.553753e+02 | 99 -2.553753e+02 | the number of coefficients is 99; it must be between 1 and 64
480.000000 640.000000 | 480 | line 11: expected 2 numbers, the centre's row and column, found 1
480.000000 640.000000 | 640 1480 | the centre's column is 1480; it must be between 0 and 1279
1.000000 0.000000 0.000000 | 0.0 0.0 0.0 | the affine c is 0; it must be between 0.5 and 2
960 1280 | 960 | line 19: expected 2 numbers, the height and the width of the image, found 1
960 1280 | 960 1280\n5 | line 20: nothing should follow the size of the image
960 1280 | 960.5 1280 | the side of the image is 960.5; it must be a whole number
0.000000e+00 1.770647e-03 -2.520355e-06 9.359533e-09 | 0 300 0 0 | with these numbers no floor is seen around the middle of the image";

#[test]
fn an_error_in_ocamcalibs_file_has_its_line() {
    let (toml, results) = (text("ocamcalib.toml"), text("calib_results.txt"));
    let refusal = |from: &str, to: &str| {
        let named = changed(&results, from, to);
        let message = read(toml.as_bytes(), named.as_bytes()).unwrap_err().to_string();
        message
            .strip_prefix("line 3, column 8: camera.file: calib_results.txt: ")
            .unwrap()
            .to_owned()
    };
    for [from, to, message] in rows(OCAMCALIB_ERRORS) {
        assert_eq!(refusal(&from, &to), message, "{to}");
    }
    let short = results.split_once("#image size").unwrap().0;
    let message = "line 3, column 8: camera.file: calib_results.txt: the file ends before the height and the width of the image";
    assert_eq!(read(toml.as_bytes(), short.as_bytes()).unwrap_err().to_string(), message);
    let other = changed(&toml, "[camera]", "[camera]\nimage = [640, 480]");
    let message = "line 2, column 9: camera.image: 640 by 480 pixels do not agree with the file, which is for images of 1280 by 960";
    assert_eq!(read(other.as_bytes(), results.as_bytes()).unwrap_err().to_string(), message);
    let message = "line 3, column 8: camera.file: calib_results.txt: this is not UTF-8 text";
    assert_eq!(read(toml.as_bytes(), b"\xff").unwrap_err().to_string(), message);
    let other = changed(&toml, "[camera]", "[camera]\nrim = 450");
    let message = "line 2, column 1: camera.rim: unknown key; expected one of: kind, image, ahead, seen_from, mask, file, viewpoint_height";
    assert_eq!(read(other.as_bytes(), results.as_bytes()).unwrap_err().to_string(), message);
}

const MEI_ERRORS: &str = r"
MEI | PINHOLE | `model_type` is `PINHOLE`, not `MEI`
   xi: 1.6901164600000000e+00\n |  | the key `mirror_parameters.xi` is missing
   xi: 1.6901164600000000e+00 |    xi: much | line 8: expected a number, found `much`
   xi: 1.6901164600000000e+00 |    xi: -1 | xi is -1; it must be between 0 and 100
   xi: 1.6901164600000000e+00 |    xi: 1\n   xi: 1 | line 9: the key `mirror_parameters.xi` is repeated
   xi: 1.6901164600000000e+00 |    xi: *other | line 8: while parsing node, found unknown anchor
   xi: 1.6901164600000000e+00 |    xi: [ | line 9:
image_width: 1280 | image_width: 1280.5 | image_width is 1280.5; it must be a whole number
image_width: 1280\n |  | the key `image_width` is missing
k1: -4.8503199300000001e-01 | k1: -1e9 | k1 is -1000000000; it must be between -1000 and 1000
image_width: 1280\nimage_height: 960\n |  | the file does not give the size of the images; the key `image` must";

#[test]
fn an_error_in_a_file_of_the_unified_model_has_its_line_or_key() {
    let (toml, yaml) = (text("camodocal.toml"), text("camodocal.yaml"));
    let refusal = |from: &str, to: &str| {
        let named = changed(&yaml, from, to);
        let message = read(toml.as_bytes(), named.as_bytes()).unwrap_err().to_string();
        message.strip_prefix("line 3, column 8: camera.file: camodocal.yaml: ").unwrap().to_owned()
    };
    for [from, to, message] in rows(MEI_ERRORS) {
        if message.starts_with("the file does not") {
            let named = changed(&yaml, &from, &to);
            let found = read(toml.as_bytes(), named.as_bytes()).unwrap_err().to_string();
            assert_eq!(found, format!("line 3, column 8: camera.file: {message}"));
        } else {
            let found = refusal(&from, &to);
            assert!(found.starts_with(&message) && !found.contains('\n'), "{to}: {found}");
        }
    }
    let (toml, yaml) = (text("omnidir.toml"), text("omnidir.yml"));
    let named = changed(&yaml, "2.7131395400000002e-01,", "2.7131395400000002e-01, 0.,");
    let message = "line 3, column 8: camera.file: omnidir.yml: `distortion_coefficients.data` has 5 numbers; it must have 4";
    assert_eq!(read(toml.as_bytes(), named.as_bytes()).unwrap_err().to_string(), message);
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
        let _ = read(&file("camodocal.toml"), deep.as_bytes());
        let _ = read(deep.as_bytes(), b"");
        let _ = read(format!("a = {deep}").as_bytes(), b"");
    }
}

const SAMPLES: [(&str, &str); 4] = [
    ("superscout.toml", "omnidir.yml"),
    ("ocamcalib.toml", "calib_results.txt"),
    ("camodocal.toml", "camodocal.yaml"),
    ("omnidir.toml", "omnidir.yml"),
];

fn asked(toml: &[u8], named: &[u8]) {
    fuzz::calibration(&[toml, b"\0", named].concat());
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1000) })]

    #[test]
    fn no_bytes_break_the_reader(bytes in vec(any::<u8>(), 0..200), named in vec(any::<u8>(), 0..200)) {
        asked(&bytes, &named);
        for (toml, _) in SAMPLES {
            asked(&file(toml), &named);
        }
    }

    #[test]
    fn no_change_to_a_calibration_breaks_the_reader(
        sample in any::<Index>(), at in any::<Index>(), length in 0_usize..6,
        inserted in prop_oneof![vec(any::<u8>(), 0..4), "[0-9.e+-]{0,5}".prop_map(String::into_bytes)],
        in_named in any::<bool>(),
    ) {
        let (toml, named) = SAMPLES[sample.index(SAMPLES.len())];
        let (mut toml, mut named) = (file(toml), file(named));
        let bytes = if in_named { &mut named } else { &mut toml };
        let start = at.index(bytes.len());
        let end = (start + length).min(bytes.len());
        bytes.splice(start..end, inserted);
        asked(&toml, &named);
    }

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
