use std::io;

use super::{CalibrationError, read, to_toml};
use crate::camera::Camera;

const DESIGN: &str = r#"
[camera]
kind = "spherical-mirror"
image = [1280, 960]
centre = [640.0, 480.0]
focal = 1272.8
mirror_radius = 0.05
mirror_distance = 0.15
camera_height = 0.90
rim = 450.0
ahead = 90.0
seen_from = "below"
"#;

fn read_alone(text: &str) -> Result<Camera, CalibrationError> {
    read(text.as_bytes(), &mut |_| Err(io::ErrorKind::NotFound.into()))
}

fn refusal(text: &str) -> String {
    read_alone(text).unwrap_err().to_string()
}

#[test]
fn the_design_pages_calibration_is_the_superscouts() {
    assert_eq!(read_alone(DESIGN).unwrap(), Camera::superscout());
}

#[test]
fn what_is_written_is_read_again() {
    assert_eq!(read_alone(&to_toml(&Camera::superscout())).unwrap(), Camera::superscout());
}

#[test]
fn one_thing_that_is_wrong_is_named_with_its_place() {
    let changed = |from: &str, to: &str| {
        assert!(DESIGN.contains(from), "{from}");
        refusal(&DESIGN.replace(from, to))
    };
    assert_eq!(refusal(" \n"), "the file is empty");
    assert_eq!(
        changed("focal =", "focus ="),
        "camera.focus: unknown key; here can stand: kind, image, ahead, seen_from, mask, centre, focal, mirror_radius, mirror_distance, camera_height, rim"
    );
    assert_eq!(changed("focal = 1272.8\n", ""), "camera: the key `focal` is missing");
}
