//! `toposlam calibrate IMAGE...`: centre, rim and focal length of a spherical mirror, from images of it.
//! Section 3.

use std::{
    io::Write,
    path::{Path, PathBuf},
};

use clap::ValueEnum;
use image::{GrayImage, RgbImage, imageops::grayscale};
use serde::Serialize;
use toposlam_vision::camera::{
    Camera, Mask, OpticsModel, SeenFrom, SphericalMirror,
    calibration::{self, CalibrationError},
    fit_picture,
    rim::{self, Rim, RimError},
    unchanging,
};

use super::{Failure, Outcome, input, json::print_object, output, picture_file};

/// Find a spherical mirror in images of it: its centre, its rim and the focal length
///
/// From a few images of one camera (PNG or JPEG), best from different places. The mirror must be
/// brighter than what surrounds it; its rim may be cropped by the image's border. The focal length
/// follows from the rim and from what a ruler tells: the mirror's radius and distance.
#[derive(clap::Args)]
#[command(after_help = "\
Example:
  toposlam calibrate view-*.png --out camera.toml --picture fit.png --mask-out mask.png

What is not given is taken from --start, or else is the SuperScout's: radius 0.05, distance 0.15,
height 0.90, ahead 90, seen from below.")]
pub(super) struct CalibrateArguments {
    /// The images
    #[arg(required = true, value_name = "IMAGE")]
    images: Vec<PathBuf>,
    /// The calibration file to write: .toml [default: standard output]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// A calibration from which to take what is not given here
    #[arg(long, value_name = "FILE")]
    start: Option<PathBuf>,
    /// Radius of the spherical mirror, in metres
    #[arg(long, value_name = "METRES")]
    mirror_radius: Option<f64>,
    /// From the camera's pinhole up to the sphere's centre, in metres
    #[arg(long, value_name = "METRES")]
    mirror_distance: Option<f64>,
    /// From the floor up to the pinhole, in metres
    #[arg(long, value_name = "METRES")]
    camera_height: Option<f64>,
    /// Where ahead is in the image, in degrees counter-clockwise from the right
    #[arg(long, value_name = "DEGREES", allow_hyphen_values = true)]
    ahead: Option<f64>,
    /// From where the camera sees: it looks up into the mirror from below
    #[arg(long, value_name = "WHERE")]
    seen_from: Option<From>,
    /// Also draw the fit over the first image: .png, .jpg or .jpeg
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
    /// Also find what never changes (body, struts, lens), and write a mask without it: .png; needs
    /// at least four images, from different places
    #[arg(long, value_name = "FILE")]
    mask_out: Option<PathBuf>,
    /// Print one JSON object; the calibration then goes to --out only
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum From {
    /// Image right is the robot's left
    Below,
    /// Image right is the robot's right
    Above,
}

/// What `--json` prints.
#[derive(Serialize)]
struct Report {
    schema: u32,
    images: usize,
    image: [u32; 2],
    centre: [f64; 2],
    rim: f64,
    focal: f64,
    /// Over which share of the full circle the rim was seen.
    rim_seen: f64,
    /// How far from the circle it was seen: root mean square, in pixels.
    rim_spread: f64,
    /// Which share of the mirror the mask leaves.
    mask_seen: Option<f64>,
}

impl CalibrateArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, Failure> {
        self.check_places()?;
        let known = self.known()?;
        let images = self.read_images()?;
        let grey: Vec<GrayImage> = images.iter().map(grayscale).collect();
        let rim = rim::find(&grey).map_err(|error| self.no_rim(error))?;
        let mask = match &self.mask_out {
            Some(path) => {
                let found = unchanging::mask(&self.mask_name(path), &images, &rim);
                Some((path, found.map_err(|error| Failure::at("--mask-out", error))?))
            }
            None => None,
        };
        let camera = with_rim(known, images[0].dimensions().into(), &rim)?;
        let camera = Camera { mask: mask.as_ref().map(|(_, mask)| mask.clone()), ..camera };
        let text = calibration::to_toml(&camera);
        if let Some(path) = &self.picture {
            picture_file::write(path, &fit_picture(&images[0], &camera, &rim))?;
        }
        if let Some((path, mask)) = &mask {
            let png = mask.to_png().map_err(|error| Failure::in_file(path, error))?;
            output::write_whole(path, &png)?;
        }
        match &self.out {
            Some(path) => output::write_whole(path, text.as_bytes())?,
            None if self.json => {}
            None => out.write_all(text.as_bytes())?,
        }
        self.report(out, &camera, &rim)?;
        Ok(Outcome::Holds)
    }

    fn check_places(&self) -> Result<(), Failure> {
        let places: [(_, &[&str]); 3] = [
            (&self.out, &["toml"]),
            (&self.picture, &["png", "jpg", "jpeg"]),
            (&self.mask_out, &["png"]),
        ];
        for (path, endings) in places {
            if let Some(path) = path {
                output::check_place(path, endings)?;
            }
        }
        if let (Some(_), None) = (&self.mask_out, &self.out) {
            return Err(Failure::at("--mask-out", "this goes with --out, the file that names it"));
        }
        Ok(())
    }

    /// What is known before any image is looked at.
    fn known(&self) -> Result<(Camera, SphericalMirror), Failure> {
        let start = match &self.start {
            Some(path) => input::read_camera(path)?,
            None => Camera::superscout(),
        };
        let OpticsModel::SphericalMirror(mirror) = start.optics else {
            let path = self.start.as_deref().unwrap_or(Path::new("--start"));
            let cause = "camera.kind: only a spherical mirror is calibrated by its rim";
            return Err(Failure::in_file(path, cause));
        };
        let mirror = SphericalMirror {
            mirror_radius: self.mirror_radius.unwrap_or(mirror.mirror_radius),
            mirror_distance: self.mirror_distance.unwrap_or(mirror.mirror_distance),
            camera_height: self.camera_height.unwrap_or(mirror.camera_height),
            ..mirror
        };
        let ahead = self.ahead.map_or(start.ahead, f64::to_radians);
        let seen_from = match self.seen_from {
            Some(From::Below) => SeenFrom::Below,
            Some(From::Above) => SeenFrom::Above,
            None => start.seen_from,
        };
        let known = Camera {
            optics: OpticsModel::SphericalMirror(mirror),
            ahead,
            seen_from,
            ..Camera::superscout()
        };
        // What is out of range is told before long work begins, with some focal length.
        let some = SphericalMirror { focal: 1000.0, centre: [0.0; 2], ..mirror };
        let probe = OpticsModel::SphericalMirror(some);
        checked(&Camera { optics: probe, ..known.clone() })?;
        Ok((known, mirror))
    }

    /// The images, all of the size of the first.
    fn read_images(&self) -> Result<Vec<RgbImage>, Failure> {
        let mut images: Vec<RgbImage> = Vec::new();
        for path in &self.images {
            let image = match images.first() {
                Some(first) => picture_file::read_if(path, |found| {
                    same_size(&self.images[0], first.dimensions().into(), path, found)
                }),
                None => picture_file::read_if(path, |found| {
                    let [least, most] = calibration::SIDES;
                    if found.iter().all(|side| (least..=most).contains(side)) {
                        return Ok(());
                    }
                    let cause = format!(
                        "the image is {} by {} pixels; its sides should be from {least} to {most}",
                        found[0], found[1]
                    );
                    Err(Failure::in_file(path, cause))
                }),
            };
            images.push(image?);
        }
        Ok(images)
    }

    /// The failure that there is no rim.
    fn no_rim(&self, error: RimError) -> Failure {
        match self.images.as_slice() {
            [path] => Failure::in_file(path, error),
            [first, others @ ..] => {
                let others = others.len();
                Failure::at(format!("{} and {others} more", first.display()), error)
            }
            [] => Failure::at("IMAGE", error),
        }
    }

    /// How the calibration names the mask: by its name where it lies beside it, else by its whole path.
    fn mask_name(&self, path: &Path) -> String {
        let beside = self.out.as_deref().and_then(Path::parent) == path.parent();
        let name = if beside { path.file_name().map(Path::new).map(Path::to_owned) } else { None };
        let whole = || std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        name.unwrap_or_else(whole).to_string_lossy().into_owned()
    }

    fn report(&self, out: &mut dyn Write, camera: &Camera, rim: &Rim) -> Result<(), Failure> {
        let OpticsModel::SphericalMirror(mirror) = &camera.optics else { return Ok(()) };
        let mask_seen = camera.mask.as_ref().map(|mask| share_seen(mask, rim));
        if self.json {
            return print_object(
                out,
                &Report {
                    schema: 1,
                    images: self.images.len(),
                    image: camera.image,
                    centre: mirror.centre,
                    rim: hundredth(rim.radius),
                    focal: mirror.focal,
                    rim_seen: hundredth(rim.seen),
                    rim_spread: hundredth(rim.spread),
                    mask_seen: mask_seen.map(hundredth),
                },
            );
        }
        if self.out.is_none() {
            return Ok(());
        }
        let [u, v] = mirror.centre;
        writeln!(out, "centre  {u:.1}, {v:.1} pixels")?;
        writeln!(
            out,
            "rim     {:.1} pixels, seen over {:.0} % of the circle, within {:.2} pixels of it",
            rim.radius,
            100.0 * rim.seen,
            rim.spread
        )?;
        writeln!(
            out,
            "focal   {:.1} pixels, for a mirror of radius {} m, {} m above the pinhole",
            mirror.focal, mirror.mirror_radius, mirror.mirror_distance
        )?;
        if let Some(seen) = mask_seen {
            writeln!(out, "mask    leaves {:.0} % of the mirror", 100.0 * seen)?;
        }
        Ok(())
    }
}

/// The camera with this rim.
fn with_rim(
    (known, mirror): (Camera, SphericalMirror),
    image: [u32; 2],
    rim: &Rim,
) -> Result<Camera, Failure> {
    let (radius, distance) = (mirror.mirror_radius, mirror.mirror_distance);
    let focal = hundredth(SphericalMirror::focal_of_rim(rim.radius, radius, distance));
    let centre = rim.centre.map(hundredth);
    let optics = OpticsModel::SphericalMirror(SphericalMirror { centre, focal, ..mirror });
    let camera = Camera { image, optics, mask: None, ..known };
    checked(&camera)?;
    Ok(camera)
}

/// Calibrations are read by people, and a hundredth of a pixel is more than images tell.
fn hundredth(number: f64) -> f64 {
    (100.0 * number).round() / 100.0
}

/// Refuses a camera that no calibration file can tell.
fn checked(camera: &Camera) -> Result<(), Failure> {
    let text = calibration::to_toml(camera);
    let nothing = &mut |_: &str| Err(std::io::ErrorKind::NotFound.into());
    match calibration::read(text.as_bytes(), nothing) {
        Ok(_) => Ok(()),
        // The arguments are named as the keys are.
        Err(CalibrationError { position, kind }) if !position.key.is_empty() => {
            let name = position.key.trim_start_matches("camera.").replace('_', "-");
            Err(Failure::at(format!("--{name}"), kind))
        }
        Err(error) => Err(Failure::at("the calibration that was found", error)),
    }
}

fn same_size(
    first: &Path,
    expected: [u32; 2],
    path: &Path,
    found: [u32; 2],
) -> Result<(), Failure> {
    if found == expected {
        return Ok(());
    }
    let [[width, height], [first_width, first_height]] = [found, expected];
    let cause = format!(
        "the image is {width} by {height} pixels, but {} is {first_width} by {first_height}",
        first.display()
    );
    Err(Failure::in_file(path, cause))
}

/// Which share of the mirror's pixels a mask leaves.
fn share_seen(mask: &Mask, rim: &Rim) -> f64 {
    let [width, height] = mask.size();
    let pixels = (0..height).flat_map(|v| (0..width).map(move |u| [u, v]));
    let inside = pixels.filter(|&[u, v]| {
        (f64::from(u) - rim.centre[0]).hypot(f64::from(v) - rim.centre[1]) < rim.radius
    });
    let (mut all, mut seen) = (0_u32, 0_u32);
    for pixel in inside {
        all += 1;
        seen += u32::from(mask.sees(pixel));
    }
    f64::from(seen) / f64::from(all.max(1))
}
