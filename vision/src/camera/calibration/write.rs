//! Writing a calibration.

use std::fmt::Write;

use nalgebra::Point2;
use toml::Value;

use crate::camera::{
    Camera, HiddenFloor, KannalaBrandt, Mei, OCam, OpticsModel, Polygon, SeenFrom,
};

pub fn to_toml(camera: &Camera) -> String {
    let mut text = String::from("[camera]\n");
    let mut line = |key: &str, value: String, comment: &str| {
        let entry = format!("{key} = {value}");
        // Writing to a string cannot fail.
        let _ = if comment.is_empty() {
            writeln!(text, "{entry}")
        } else {
            writeln!(text, "{entry:<28} # {comment}")
        };
    };
    let kind = match &camera.optics {
        OpticsModel::SphericalMirror(_) => "spherical-mirror",
        OpticsModel::OCamCalib(_) => "ocamcalib",
        OpticsModel::Mei(_) => "mei",
        OpticsModel::KannalaBrandt(_) => "kannala-brandt",
    };
    line("kind", quoted(kind), "");
    let [width, height] = camera.image;
    line("image", format!("[{width}, {height}]"), "pixels");
    match &camera.optics {
        OpticsModel::SphericalMirror(mirror) => {
            let [u, v] = mirror.centre.into();
            let centre = format!("[{}, {}]", number(u), number(v));
            line("centre", centre, "of the mirror in the image, u to the right, v down");
            line("focal", number(mirror.focal), "pixels");
            line("mirror_radius", number(mirror.mirror_radius), "metres");
            let distance = number(mirror.mirror_distance);
            line("mirror_distance", distance, "sphere's centre above the pinhole");
            let height = number(mirror.camera_height);
            line("camera_height", height, "pinhole above the floor");
            let rim = number((100.0 * mirror.rim()).round() / 100.0);
            line("rim", rim, "pixels; follows from the others");
        }
        OpticsModel::OCamCalib(OCam { file, viewpoint_height, .. })
        | OpticsModel::Mei(Mei { file, viewpoint_height, .. })
        | OpticsModel::KannalaBrandt(KannalaBrandt { file, viewpoint_height, .. }) => {
            line("file", quoted(file), "");
            line("viewpoint_height", number(*viewpoint_height), "metres above the floor");
        }
    }
    if let OpticsModel::KannalaBrandt(KannalaBrandt { tilt, .. }) = &camera.optics
        && *tilt > 0.0
    {
        let tilt = number(degrees(*tilt));
        line("tilt", tilt, "degrees from straight down towards ahead");
    }
    let ahead = number(degrees(camera.ahead));
    line("ahead", ahead, "degrees in the image, counter-clockwise from u, where \"ahead\" is");
    let seen_from = match camera.seen_from {
        SeenFrom::Below => "below",
        SeenFrom::Above => "above",
    };
    line("seen_from", quoted(seen_from), "");
    if let Some(mask) = &camera.mask {
        line("mask", quoted(&mask.file), "white where the floor can be seen");
    }
    let HiddenFloor { radius, polygons } = &camera.hidden;
    if radius.to_bits() != HiddenFloor::default().radius.to_bits() {
        line("hidden_radius", number(*radius), "metres; the body hides the floor nearer than this");
    }
    if !polygons.is_empty() {
        line("hide", shown(polygons), "polygons that hide the floor, in pixels");
    }
    text
}

fn number(number: f64) -> String {
    Value::from(number).to_string()
}

fn shown(polygons: &[Polygon]) -> String {
    let list = |parts: Vec<String>| format!("[{}]", parts.join(", "));
    let corner = |corner: &Point2<f64>| list([corner.x, corner.y].map(number).to_vec());
    let polygon = |polygon: &Polygon| list(polygon.corners().iter().map(corner).collect());
    list(polygons.iter().map(polygon).collect())
}

fn quoted(text: &str) -> String {
    Value::from(text).to_string()
}

/// An angle in degrees, with as few digits as possible.
fn degrees(radians: f64) -> f64 {
    let exactly = radians.to_degrees();
    let rounded = (0..12).map(|digits| {
        let scale = 10.0_f64.powi(digits);
        (exactly * scale).round() / scale
    });
    let mut same = rounded.filter(|degrees| degrees.to_radians().to_bits() == radians.to_bits());
    same.next().unwrap_or(exactly)
}
