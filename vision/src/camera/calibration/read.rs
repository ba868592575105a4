//! Reading a calibration: bytes in, a [`Camera`] or an error out.

use std::{io, ops::RangeInclusive};

use nalgebra::Point2;
use toposlam_model::format::document::{
    Document, DocumentError, DocumentTable, DocumentValue, TextPosition,
};

use super::{CalibrationError, CalibrationErrorKind, SIDES};
use crate::camera::{
    Camera, HiddenFloor, KannalaBrandt, Mask, Mei, OCam, OpticsFileError, OpticsModel, Polygon,
    SeenFrom, SphericalMirror,
};

/// Reads the files that a calibration names, by their names in it.
pub type Files<'a> = dyn FnMut(&str) -> io::Result<Vec<u8>> + 'a;

const COMMON: [&str; 7] = ["kind", "image", "ahead", "seen_from", "mask", "hidden_radius", "hide"];

const FOCAL: RangeInclusive<f64> = 1.0..=1e6;
const MIRROR_RADIUS: RangeInclusive<f64> = 1e-3..=1.0;
const HEIGHT: RangeInclusive<f64> = 0.01..=10.0;
const RIM: RangeInclusive<f64> = 1.0..=1e6;
const ANGLE: RangeInclusive<f64> = -360.0..=360.0;
const TILT: RangeInclusive<f64> = 0.0..=135.0;
const HIDDEN_RADIUS: RangeInclusive<f64> = 0.0..=1.5;
/// Corners of polygons lie at most this far from an image, in pixels.
const CORNER: RangeInclusive<f64> = -1e5..=1e5;

#[derive(Clone, Copy)]
enum Kind {
    SphericalMirror,
    OCamCalib,
    Mei,
    KannalaBrandt,
}

/// Reads a calibration file, and through `files` those that it names.
///
/// Reading takes at most 512 bytes of memory for each byte of the file, and 4096 besides, and what
/// [`Mask::from_png`] takes for an image of the calibration's size.
///
/// # Errors
/// Returns an error if the bytes are not a calibration, or if a file that it names cannot be used. No
/// bytes make it panic.
pub fn read(bytes: &[u8], files: &mut Files<'_>) -> Result<Camera, CalibrationError> {
    let document = Document::parse_toml(bytes).map_err(|error| of_other_program(bytes, error))?;
    let value = document.root().table(&["camera"])?.need("camera")?;
    let table = value.any_table()?;
    let kind = table.need("kind")?.word(&[
        ("spherical-mirror", Kind::SphericalMirror),
        ("ocamcalib", Kind::OCamCalib),
        ("mei", Kind::Mei),
        ("kannala-brandt", Kind::KannalaBrandt),
    ])?;
    let (image, optics) = match kind {
        Kind::SphericalMirror => spherical_mirror(value)?,
        Kind::OCamCalib => single_viewpoint(value, files, &[], |file, bytes, height| {
            let ocam = OCam::read(file, bytes, height)?;
            Ok((Some(ocam.image), OpticsModel::OCamCalib(ocam)))
        })?,
        Kind::Mei => single_viewpoint(value, files, &[], |file, bytes, height| {
            let mei = Mei::read(file, bytes, height)?;
            Ok((mei.image, OpticsModel::Mei(mei)))
        })?,
        Kind::KannalaBrandt => {
            let tilt = |value: DocumentValue<'_>| value.number_in("an angle in degrees", TILT);
            let tilt = table.get("tilt").map(tilt).transpose()?.unwrap_or(0.0).to_radians();
            let axis = [tilt, ahead(&table)?];
            single_viewpoint(value, files, &["tilt"], |file, bytes, height| {
                let fisheye = KannalaBrandt::read(file, bytes, height, axis)?;
                Ok((fisheye.image, OpticsModel::KannalaBrandt(fisheye)))
            })?
        }
    };
    let ahead = ahead(&table)?;
    let seen_from =
        table.need("seen_from")?.word(&[("below", SeenFrom::Below), ("above", SeenFrom::Above)])?;
    let mask = table.get("mask").map(|mask| read_mask(mask, files, image)).transpose()?;
    let hidden = hidden_floor(&table)?;
    Ok(Camera { image, ahead, seen_from, optics, mask, hidden })
}

fn hidden_floor(table: &DocumentTable<'_>) -> Result<HiddenFloor, CalibrationError> {
    let radius = match table.get("hidden_radius") {
        Some(value) => value.number_in("a radius in metres", HIDDEN_RADIUS)?,
        None => HiddenFloor::default().radius,
    };
    let polygons = match table.get("hide") {
        Some(value) => value.list("a list of polygons")?.map(polygon).collect::<Result<_, _>>()?,
        None => Vec::new(),
    };
    Ok(HiddenFloor { radius, polygons })
}

fn polygon(value: DocumentValue<'_>) -> Result<Polygon, CalibrationError> {
    let corner = |value: DocumentValue<'_>| {
        let [u, v] = value.array("a corner of two numbers")?;
        let [u, v] = [u, v].map(|at| at.number_in("a corner in pixels", CORNER));
        Ok::<_, CalibrationError>(Point2::new(u?, v?))
    };
    let corners = value.list("a list of corners")?.map(corner).collect::<Result<Vec<_>, _>>()?;
    let few = CalibrationErrorKind::FewCorners(corners.len());
    Polygon::from_corners(corners).ok_or_else(|| value.position().error(few))
}

fn ahead(table: &DocumentTable<'_>) -> Result<f64, CalibrationError> {
    Ok(table.need("ahead")?.number_in("an angle in degrees", ANGLE)?.to_radians())
}

/// The error for bytes that are no TOML; the files of other programs are none.
fn of_other_program(bytes: &[u8], error: DocumentError) -> CalibrationError {
    const MARKS: [&str; 4] = ["opencv-matrix", "opencv_storage", "model_type:", "camera_model:"];
    let text = String::from_utf8_lossy(bytes);
    let kind = if OCam::read("", bytes, 1.0).is_ok() {
        "ocamcalib"
    } else if MARKS.iter().any(|mark| text.contains(mark)) {
        let is_fisheye = ["KANNALA_BRANDT", "equidistant"].iter().any(|mark| text.contains(mark));
        if is_fisheye { "kannala-brandt" } else { "mei" }
    } else {
        return error.into();
    };
    TextPosition::default().error(CalibrationErrorKind::OtherProgram { kind })
}

fn spherical_mirror(value: DocumentValue<'_>) -> Result<([u32; 2], OpticsModel), CalibrationError> {
    const KEYS: [&str; 6] =
        ["centre", "focal", "mirror_radius", "mirror_distance", "camera_height", "rim"];
    let table = value.table(&[&COMMON[..], &KEYS].concat())?;
    let image = read_image(table.need("image")?)?;
    let [across, down] = table.need("centre")?.array("a list of two numbers")?;
    let in_image = |value: DocumentValue<'_>, side: u32| {
        let what = "the centre of the mirror, in the image,";
        value.number_in(what, 0.0..=f64::from(side) - 1.0)
    };
    let centre = Point2::new(in_image(across, image[0])?, in_image(down, image[1])?);
    let focal = table.need("focal")?.number_in("a focal length in pixels", FOCAL)?;
    let mirror_radius = table
        .need("mirror_radius")?
        .number_in("the radius of a mirror in metres", MIRROR_RADIUS)?;
    let mirror_distance = table.need("mirror_distance")?;
    let camera_height = camera_height(&table, "camera_height")?;
    let mirror = SphericalMirror {
        centre,
        focal,
        mirror_radius,
        mirror_distance: mirror_distance.number_in(
            "the distance of the sphere's centre in metres, more than its radius,",
            mirror_radius * 1.001..=10.0,
        )?,
        camera_height,
    };
    let expected = mirror.rim();
    if let Some(value) = table.get("rim") {
        let rim = value.number_in("the radius of a rim in pixels", RIM)?;
        if (rim - expected).abs() > 0.02 * expected {
            return Err(value.position().error(CalibrationErrorKind::Rim { rim, expected }));
        }
    }
    if !RIM.contains(&expected) {
        let (&low, &high) = (RIM.start(), RIM.end());
        let kind = CalibrationErrorKind::RimOutOfRange { rim: expected, low, high };
        return Err(mirror_distance.position().error(kind));
    }
    Ok((image, OpticsModel::SphericalMirror(mirror)))
}

fn single_viewpoint(
    value: DocumentValue<'_>,
    files: &mut Files<'_>,
    own_keys: &[&'static str],
    read: impl FnOnce(&str, &[u8], f64) -> Result<(Option<[u32; 2]>, OpticsModel), OpticsFileError>,
) -> Result<([u32; 2], OpticsModel), CalibrationError> {
    let table = value.table(&[&COMMON[..], &["file", "viewpoint_height"], own_keys].concat())?;
    let height = camera_height(&table, "viewpoint_height")?;
    let given = table.get("image").map(read_image).transpose()?;
    let file = table.need("file")?;
    let (name, bytes) = open(file, files)?;
    let (found, optics) = read(name, &bytes, height).map_err(|error| {
        file.position().error(CalibrationErrorKind::Optics { file: shown(name), error })
    })?;
    match (given, found, table.get("image")) {
        (Some(given), Some(found), Some(value)) if given != found => {
            Err(value.position().error(CalibrationErrorKind::OtherImage { given, found }))
        }
        (Some(image), ..) | (None, Some(image), _) => Ok((image, optics)),
        (None, None, _) => Err(file.position().error(CalibrationErrorKind::NoImage)),
    }
}

fn read_mask(
    value: DocumentValue<'_>,
    files: &mut Files<'_>,
    image: [u32; 2],
) -> Result<Mask, CalibrationError> {
    let (name, bytes) = open(value, files)?;
    Mask::from_png(name, &bytes, image).map_err(|error| {
        value.position().error(CalibrationErrorKind::Mask { file: shown(name), error })
    })
}

fn open<'d>(
    value: DocumentValue<'d>,
    files: &mut Files<'_>,
) -> Result<(&'d str, Vec<u8>), CalibrationError> {
    let name = value.text()?;
    let bytes = files(name).map_err(|error| {
        value.position().error(CalibrationErrorKind::Unreadable { file: shown(name), error })
    })?;
    Ok((name, bytes))
}

fn shown(name: &str) -> String {
    name.escape_debug().to_string()
}

#[expect(clippy::cast_sign_loss, reason = "the range is that of u32 at most")]
fn read_image(value: DocumentValue<'_>) -> Result<[u32; 2], CalibrationError> {
    let [width, height] = value.array("a list of two whole numbers")?;
    let [low, high] = SIDES.map(i64::from);
    let side = |value: DocumentValue<'_>| {
        value.whole_in("the side of an image in pixels", low..=high).map(|side| side as u32)
    };
    Ok([side(width)?, side(height)?])
}

fn camera_height(table: &DocumentTable<'_>, key: &'static str) -> Result<f64, CalibrationError> {
    Ok(table.need(key)?.number_in("a height above the floor in metres", HEIGHT)?)
}
