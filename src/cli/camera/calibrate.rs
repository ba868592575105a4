//! `toposlam camera calibrate IMAGE...`: finds centre, rim and focal length of a spherical mirror in images, or
//! takes the rim that is given.
//! Section 3.

use std::{
    io::{self, Write},
    path::{Path, PathBuf},
};

use image::{GrayImage, RgbImage, imageops::grayscale};
use serde::Serialize;
use toposlam_vision::camera::{
    Camera, HiddenFloor, Mask, OpticsModel, Polygon, SphericalMirror, calibration, fit_picture,
    rim::{self, Rim, RimError},
    unchanging,
};

use crate::cli::{
    CliError, Outcome, exit_codes::help_end, input, json::print_line, output, picture_file,
    text::three_numbers,
};

/// Find centre, rim and focal length of a spherical mirror in images
///
/// Use a few images (PNG or JPEG) that one camera took from different places; often one is enough. The
/// border of the image may cut off parts of the mirror's rim, and what is seen just inside of the rim may
/// be as dark as what is outside. If the rim is not certain, no calibration is written: the error names the
/// likeliest circles as --rim options, which --picture draws over the image. The focal length is computed from the rim and from the mirror's
/// radius and distance, which you measure and write into the file of --initial.
#[derive(clap::Args)]
#[command(after_help = help_end(
    "\
Example:
  toposlam camera calibrate view-*.png --out camera.toml \\
    --picture fit.png --mask-out mask.png
  toposlam camera calibrate view.png --rim 611,480,652 --out camera.toml
  toposlam camera calibrate view.png --hide \"600,300 700,300 700,340 600,340\" \\
    --out camera.toml --picture fit.png

What the images do not show (the mirror's radius and distance, the camera's height, the direction of ahead, and \
the side from which the camera sees the mirror) is taken from --initial. Without it, it is that of the SuperScout: \
radius 0.05, distance 0.15, height 0.90, ahead 90, seen from below. For another robot, write a calibration, change \
these values in the file, and use it as --initial.",
    &[
        (0, "the rim was found, or was given"),
        (2, "bad usage or input, or no rim was found for certain"),
        (3, "interrupted"),
    ],
))]
pub(super) struct CalibrateArguments {
    /// Images: .png or .jpg
    #[arg(required = true, value_name = "IMAGE")]
    images: Vec<PathBuf>,
    /// Calibration file to write: .toml [default: standard output]
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// The mirror's rim, if the images do not show it: its centre, to the right and down from the image's
    /// first pixel, and its radius, in pixels. Check it with --picture
    #[arg(long, value_name = "U,V,R", value_parser = parse_rim, allow_hyphen_values = true)]
    rim: Option<[f64; 3]>,
    /// Calibration from which missing values are taken
    #[arg(long, value_name = "FILE")]
    initial: Option<PathBuf>,
    /// Also draw the fit over the first image: .png, .jpg or .jpeg
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
    /// Also write a mask without the pixels that never change (body, struts, lens): .png; needs at least
    /// four images from different places, or --hide
    #[arg(long, value_name = "FILE", requires = "out")]
    mask_out: Option<PathBuf>,
    /// A polygon that hides the floor, as a housing of the camera: its corners in pixels, as in "300,400
    /// 420,400 360,480"; may be repeated. Without --mask-out, the calibration contains it, and one image is
    /// enough. What is nearer than the hidden_radius of --initial is hidden, too [default: 0.32 m]
    #[arg(long, value_name = "POLYGON", value_parser = parse_polygon)]
    hide: Vec<Polygon>,
    /// Print one JSON object, and the calibration only to --out
    #[arg(long)]
    json: bool,
}

/// What `--json` prints.
#[derive(Serialize)]
struct CalibrationReport {
    images: usize,
    image: [u32; 2],
    centre: [f64; 2],
    rim: f64,
    /// `images` or `option`.
    rim_from: &'static str,
    focal: f64,
    /// The share of the full circle on which the rim is seen.
    rim_seen: f64,
    /// Root mean square distance of the rim from the circle, in pixels.
    rim_spread: f64,
    /// The share of the mirror that the mask keeps.
    mask_seen: Option<f64>,
}

impl CalibrateArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        output::check_place(&self.out, &["toml"])?;
        output::check_place(&self.picture, &["png", "jpg", "jpeg"])?;
        output::check_place(&self.mask_out, &["png"])?;
        let (known, mirror) = self.known()?;
        let images = self.read_images()?;
        let size = images[0].dimensions().into();
        let grey: Vec<GrayImage> = images.iter().map(grayscale).collect();
        let rim = match &self.rim {
            Some(given @ [u, v, radius]) => {
                check_rim(*given, size).map_err(|cause| CliError::at("--rim", cause))?;
                rim::given(&grey, [*u, *v].into(), *radius)
            }
            None => rim::find(&grey),
        };
        let rim = rim.map_err(|error| self.no_rim(&error))?;
        let mirror = with_rim(mirror, &rim);
        let optics = OpticsModel::SphericalMirror(mirror);
        let camera = Camera { image: size, optics, mask: None, ..known };
        let mask = match &self.mask_out {
            Some(path) => {
                let name = self.mask_name(path);
                // What never changes is not seen in few images, but may be drawn.
                let is_drawn = !self.hide.is_empty() && images.len() < unchanging::FEWEST;
                let mut mask = if is_drawn {
                    let mut mask = Mask::circle(&name, size, rim.centre, rim.radius);
                    let ground = |pixel| camera.pixel_to_ground(pixel);
                    mask.hide(|pixel| ground(pixel).is_some_and(|at| camera.is_below_body(at)));
                    mask
                } else {
                    unchanging::mask(&name, &images, &rim)
                        .map_err(|error| CliError::at("--mask-out", error))?
                };
                mask.hide(|pixel| self.hide.iter().any(|polygon| polygon.contains(pixel)));
                Some(mask)
            }
            None => None,
        };
        // A mask contains what the polygons hide.
        let polygons = if mask.is_none() { self.hide.clone() } else { Vec::new() };
        let hidden = HiddenFloor { polygons, ..camera.hidden };
        let camera = Camera { hidden, ..camera };
        checked(&camera)?;
        let camera = Camera { mask, ..camera };
        let text = calibration::to_toml(&camera);
        if let Some(path) = &self.picture {
            picture_file::write(path, &fit_picture(&images[0], &camera, &rim))?;
        }
        if let (Some(path), Some(mask)) = (&self.mask_out, &camera.mask) {
            let png = mask.to_png().map_err(|error| CliError::in_file(path, error))?;
            output::write_whole(path, &png)?;
        }
        match &self.out {
            Some(path) => output::write_whole(path, text.as_bytes())?,
            None if self.json => {}
            None => out.write_all(text.as_bytes())?,
        }
        let report = CalibrationReport {
            images: self.images.len(),
            image: camera.image,
            centre: mirror.centre.into(),
            rim: hundredth(rim.radius),
            rim_from: if self.rim.is_some() { "option" } else { "images" },
            focal: mirror.focal,
            rim_seen: hundredth(rim.seen),
            rim_spread: hundredth(rim.spread),
            mask_seen: camera.mask.as_ref().map(|mask| hundredth(share_seen(mask, &rim))),
        };
        if self.json {
            print_line(out, "calibration", &report)?;
        } else if self.out.is_some() {
            report.print(out, &mirror)?;
        }
        Ok(Outcome::Holds)
    }

    /// The camera as far as it is known without the images.
    fn known(&self) -> Result<(Camera, SphericalMirror), CliError> {
        let initial = match &self.initial {
            Some(path) => input::read_camera(path)?,
            None => Camera::superscout(),
        };
        let OpticsModel::SphericalMirror(mirror) = initial.optics else {
            let path = self.initial.as_deref().unwrap_or(Path::new("--initial"));
            let cause = "camera.kind: only a spherical mirror is calibrated by its rim";
            return Err(CliError::in_file(path, cause));
        };
        // Its polygons are those of other images.
        let hidden = HiddenFloor { radius: initial.hidden.radius, ..HiddenFloor::default() };
        let Camera { ahead, seen_from, .. } = initial;
        Ok((Camera { ahead, seen_from, hidden, ..Camera::superscout() }, mirror))
    }

    /// Reads the images. All must have the size of the first.
    fn read_images(&self) -> Result<Vec<RgbImage>, CliError> {
        let mut images: Vec<RgbImage> = Vec::new();
        for path in &self.images {
            let first = images.first().map(RgbImage::dimensions);
            let image = picture_file::read_if(path, |[width, height]| {
                let [least, most] = calibration::SIDES;
                let sides = least..=most;
                let wrong = match first {
                    Some((first_width, first_height))
                        if (width, height) != (first_width, first_height) =>
                    {
                        let first = self.images[0].display();
                        format!(", but {first} is {first_width} by {first_height}")
                    }
                    None if !sides.contains(&width) || !sides.contains(&height) => {
                        format!("; its sides should be from {least} to {most}")
                    }
                    _ => return Ok(()),
                };
                Err(format!("the image is {width} by {height} pixels{wrong}"))
            });
            images.push(image?);
        }
        Ok(images)
    }

    /// The failure if no rim was found.
    fn no_rim(&self, error: &RimError) -> CliError {
        let error = match error {
            RimError::NoRim => format!("{error}; set it with --rim U,V,R"),
            RimError::Uncertain { circles, .. } => {
                let options = circles.iter().map(|[u, v, r]| format!("--rim {u:.1},{v:.1},{r:.1}"));
                let options: Vec<String> = options.collect();
                let options = options.join(" or ");
                format!(
                    "{error}; try these circles, the likeliest first, with --picture: {options}"
                )
            }
            RimError::NoImage | RimError::Sizes { .. } | RimError::TooSmall(_) => error.to_string(),
        };
        let first = self.images[0].display();
        match self.images.len() - 1 {
            0 => CliError::at(first, error),
            others => CliError::at(format!("{first} and {others} more"), error),
        }
    }

    /// The mask's path in the calibration: its file name if both are in one folder, else its whole path.
    fn mask_name(&self, path: &Path) -> String {
        let beside = self.out.as_deref().and_then(Path::parent) == path.parent();
        let name = path.file_name().filter(|_| beside).map(PathBuf::from);
        let whole = || std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        name.unwrap_or_else(whole).to_string_lossy().into_owned()
    }
}

impl CalibrationReport {
    fn print(&self, out: &mut dyn Write, mirror: &SphericalMirror) -> io::Result<()> {
        let [u, v] = self.centre;
        writeln!(out, "centre  {u:.1}, {v:.1} pixels")?;
        let from = if self.rim_from == "option" { "given, " } else { "" };
        writeln!(
            out,
            "rim     {:.1} pixels, {from}seen over {:.0} % of the circle, within {:.2} pixels of it",
            self.rim,
            100.0 * self.rim_seen,
            self.rim_spread
        )?;
        writeln!(
            out,
            "focal   {:.1} pixels, for a mirror of radius {} m, {} m above the pinhole",
            self.focal, mirror.mirror_radius, mirror.mirror_distance
        )?;
        match self.mask_seen {
            Some(seen) => writeln!(out, "mask    keeps {:.0} % of the mirror", 100.0 * seen),
            None => Ok(()),
        }
    }
}

/// Returns the cause if a rim, centre and radius, cannot be that of a mirror in an image of this size.
fn check_rim([u, v, radius]: [f64; 3], image: [u32; 2]) -> Result<(), String> {
    let [width, height] = image.map(f64::from);
    let most = width.hypot(height);
    // The farthest corner of the image.
    let corner = u.max(width - 1.0 - u).hypot(v.max(height - 1.0 - v));
    if !(0.0..=width - 1.0).contains(&u) || !(0.0..=height - 1.0).contains(&v) {
        Err(format!(
            "the centre {u},{v} is outside of the images, which are {width} by {height} pixels"
        ))
    } else if !(8.0..=most).contains(&radius) {
        Err(format!("the radius is {radius} pixels; it must be from 8 to {most:.0}"))
    } else if radius >= corner {
        Err(format!("the circle of radius {radius} around {u},{v} is nowhere in the images"))
    } else {
        Ok(())
    }
}

/// Parses a rim: centre and radius.
fn parse_rim(text: &str) -> Result<[f64; 3], String> {
    let rim = three_numbers(text);
    rim.ok_or_else(|| "write three numbers of pixels: U,V,R, as in 611,480,652".to_owned())
}

fn parse_polygon(text: &str) -> Result<Polygon, String> {
    let corner = |word: &str| {
        let (u, v) = word.split_once(',')?;
        let [u, v] = [u, v].map(|part| part.parse().ok().filter(|at: &f64| at.is_finite()));
        Some([u?, v?].into())
    };
    let corners: Option<Vec<_>> = text.split_whitespace().map(corner).collect();
    corners
        .and_then(Polygon::from_corners)
        .ok_or_else(|| "write at least three corners, as in \"300,400 420,400 360,480\"".to_owned())
}

/// The calibrated mirror with this rim.
fn with_rim(mirror: SphericalMirror, rim: &Rim) -> SphericalMirror {
    let (radius, distance) = (mirror.mirror_radius, mirror.mirror_distance);
    let focal = hundredth(SphericalMirror::focal_of_rim(rim.radius, radius, distance));
    SphericalMirror { centre: rim.centre.map(hundredth), focal, ..mirror }
}

/// Rounds to hundredths. Images are not more exact than a hundredth of a pixel.
fn hundredth(number: f64) -> f64 {
    (100.0 * number).round() / 100.0
}

/// Returns an error if a calibration file cannot contain this camera.
fn checked(camera: &Camera) -> Result<(), CliError> {
    let text = calibration::to_toml(camera);
    let nothing = &mut |_: &str| Err(io::ErrorKind::NotFound.into());
    let read = calibration::read(text.as_bytes(), nothing);
    read.map(|_| ()).map_err(|error| CliError::at("the calibration that was found", error))
}

/// The share of the mirror's pixels that a mask keeps.
fn share_seen(mask: &Mask, rim: &Rim) -> f64 {
    let [width, height] = mask.size();
    let pixels = (0..height).flat_map(|v| (0..width).map(move |u| [u, v]));
    let inside = pixels.filter(|&[u, v]| {
        (f64::from(u) - rim.centre[0]).hypot(f64::from(v) - rim.centre[1]) < rim.radius
    });
    let (all, seen) = inside
        .fold((0_u32, 0_u32), |(all, seen), pixel| (all + 1, seen + u32::from(mask.sees(pixel))));
    f64::from(seen) / f64::from(all.max(1))
}
