//! Reading a calibration: bytes in, a [`Camera`] out, or the one thing that is wrong.

use std::io;

use super::{
    error::{CalibrationError, Cause},
    table::{Range, Table},
};
use crate::camera::{Camera, Mask, Mei, OCam, Optics, OpticsFileError, SeenFrom, SphericalMirror};

/// How the files are read that a calibration names, by their names in it.
pub type Files<'a> = dyn FnMut(&str) -> io::Result<Vec<u8>> + 'a;

/// The keys of every camera.
const COMMON: [&str; 5] = ["kind", "image", "ahead", "seen_from", "mask"];

/// Between how many pixels each side of an image must have.
pub const SIDES: [u32; 2] = [16, 16384];

const SIDE: Range =
    Range { what: "the side of an image in pixels", low: SIDES[0] as f64, high: SIDES[1] as f64 };
const FOCAL: Range = Range { what: "a focal length in pixels", low: 1.0, high: 1e6 };
const RADIUS: Range = Range { what: "the radius of a mirror in metres", low: 1e-3, high: 1.0 };
const HEIGHT: Range = Range { what: "a height above the floor in metres", low: 0.01, high: 10.0 };
const RIM: Range = Range { what: "the radius of a rim in pixels", low: 1.0, high: 1e6 };
const ANGLE: Range = Range { what: "an angle in degrees", low: -360.0, high: 360.0 };

/// Reads a calibration file, and through `files` those that it names.
///
/// Takes at most 512 bytes of memory for each byte of the file, and 4096 besides, and what
/// [`Mask::from_png`] takes for an image of the size that it says.
///
/// # Errors
/// The first thing that is wrong, with its place. No bytes make it panic.
pub fn read(bytes: &[u8], files: &mut Files<'_>) -> Result<Camera, CalibrationError> {
    let file = parse(bytes)?;
    let values = Table::new("", &file, &["camera"])?.table("camera")?;
    let table = Table::unchecked("camera", values);
    let mut camera = match table.word("kind", &["spherical-mirror", "ocamcalib", "mei"])? {
        "spherical-mirror" => spherical_mirror(values)?,
        "ocamcalib" => single_viewpoint(values, files, |file, bytes, height| {
            let ocam = OCam::read(file, bytes, height)?;
            Ok((Some(ocam.image()), Optics::OCamCalib(ocam)))
        })?,
        _ => single_viewpoint(values, files, |file, bytes, height| {
            let mei = Mei::read(file, bytes, height)?;
            Ok((mei.image(), Optics::Mei(mei)))
        })?,
    };
    if table.has("mask") {
        let file = table.text("mask")?;
        let cause = |cause: Cause| cause.in_named("mask", file);
        let bytes = files(file).map_err(|error| cause(Cause::Unreadable(error)))?;
        let mask = Mask::from_png(file, &bytes, camera.image);
        camera.mask = Some(mask.map_err(|error| cause(error.into()))?);
    }
    Ok(camera)
}

fn parse(bytes: &[u8]) -> Result<toml::Table, CalibrationError> {
    let text = std::str::from_utf8(bytes)
        .map_err(|error| Cause::NotText.at_byte(bytes, error.valid_up_to()))?;
    if text.trim().is_empty() {
        return Err(Cause::Empty.in_file());
    }
    toml::from_str(text).map_err(|error: toml::de::Error| {
        let byte = error.span().map_or(0, |span| span.start);
        Cause::Syntax(error.message().replace('\n', ", ")).at_byte(bytes, byte)
    })
}

fn spherical_mirror(values: &toml::Table) -> Result<Camera, CalibrationError> {
    const KEYS: [&str; 6] =
        ["centre", "focal", "mirror_radius", "mirror_distance", "camera_height", "rim"];
    let table = Table::new("camera", values, &[&COMMON[..], &KEYS].concat())?;
    let image = table.whole_pair("image", SIDE)?;
    let [across, down] = image.map(|side| Range {
        what: "the centre of the mirror, in the image,",
        low: 0.0,
        high: f64::from(side) - 1.0,
    });
    let centre = table.pair("centre", [across, down])?;
    let focal = table.number("focal", FOCAL)?;
    let mirror_radius = table.number("mirror_radius", RADIUS)?;
    let mirror_distance = table.number(
        "mirror_distance",
        Range {
            what: "the distance of the sphere's centre in metres, more than its radius,",
            low: mirror_radius * 1.001,
            high: 10.0,
        },
    )?;
    let camera_height = table.number("camera_height", HEIGHT)?;
    let mirror = SphericalMirror { centre, focal, mirror_radius, mirror_distance, camera_height };
    let expected = mirror.rim();
    if table.has("rim") {
        let rim = table.number("rim", RIM)?;
        if (rim - expected).abs() > 0.02 * expected {
            return Err(table.error("rim", Cause::Rim { rim, expected }));
        }
    }
    let Range { low, high, .. } = RIM;
    if !(low..=high).contains(&expected) {
        let cause = Cause::RimOutOfRange { rim: expected, low, high };
        return Err(table.error("mirror_distance", cause));
    }
    on_robot(&table, image, Optics::SphericalMirror(mirror))
}

/// A camera that another tool has calibrated, by its own file.
fn single_viewpoint(
    values: &toml::Table,
    files: &mut Files<'_>,
    read: impl FnOnce(&str, &[u8], f64) -> Result<(Option<[u32; 2]>, Optics), OpticsFileError>,
) -> Result<Camera, CalibrationError> {
    let table =
        Table::new("camera", values, &[&COMMON[..], &["file", "viewpoint_height"]].concat())?;
    let height = table.number("viewpoint_height", HEIGHT)?;
    let told = table.has("image").then(|| table.whole_pair("image", SIDE)).transpose()?;
    let file = table.text("file")?;
    let cause = |cause: Cause| cause.in_named("file", file);
    let bytes = files(file).map_err(|error| cause(Cause::Unreadable(error)))?;
    let (found, optics) = read(file, &bytes, height).map_err(|error| cause(error.into()))?;
    let image = match (told, found) {
        (Some(told), Some(found)) if told != found => {
            return Err(table.error("image", Cause::OtherImage { told, found }));
        }
        (Some(image), _) | (None, Some(image)) => image,
        (None, None) => return Err(table.error("file", Cause::NoImage)),
    };
    on_robot(&table, image, optics)
}

fn on_robot(table: &Table, image: [u32; 2], optics: Optics) -> Result<Camera, CalibrationError> {
    let ahead = table.number("ahead", ANGLE)?.to_radians();
    let seen_from = match table.word("seen_from", &["below", "above"])? {
        "below" => SeenFrom::Below,
        _ => SeenFrom::Above,
    };
    Ok(Camera { image, ahead, seen_from, optics, mask: None })
}
