//! `toposlam camera train`: learns the colours of a building from labelled images of it. Section 3.

mod report;

use std::{
    collections::BTreeMap,
    ffi::{OsStr, OsString},
    fs,
    io::Write,
    path::{Path, PathBuf},
};

use image::RgbImage;
use toposlam_model::enumerate::Watch;
use toposlam_vision::{
    camera::Camera,
    colour::{ExampleError, PixelClass, Stripe, StripeKind, Training, TrainingError},
};

use crate::cli::{
    CliError, Outcome, exit_codes::help_end, input, json::print_line, output, picture_file,
    progress::Progress,
};
use report::{LeftOut, TrainingReport};

/// Learn the colours of a building's floor, stripe and marker from labelled images
///
/// Each image of the robot's camera (PNG or JPEG) has a PNG of the same name and size that labels
/// every pixel by its colour. Floor and stripe must occur; without a labelled marker, sensing with these
/// colours sees no marker. Pixels beyond 3 m, on the robot's body and outside the mirror are ignored.
/// Images that are too dark or too bright are left out and reported.
#[derive(clap::Args)]
#[command(
    override_usage = "\
toposlam camera train [OPTIONS] --images <DIR> --labels <DIR>
                             --calibration <FILE> --out <FILE>",
    after_help = help_end("\
Colours of labels:
  floor (0,255,0)   stripe (255,0,0)   marker (0,0,255)
  other (0,0,0)     ignore (255,255,255)

Example, with rendered images and labels:
  mkdir -p images labels
  for n in 1 2 3 4 5 6 7; do
    toposlam draw worlds/shape-8.toml --marker directional --pose 0,$n,$((50 * n)) \\
      --seed $n --out images/$n.png --labels labels/$n.png
  done
  toposlam camera calibrate images/*.png --out camera.toml
  toposlam camera train --images images --labels labels \\
    --calibration camera.toml --out colours.toml
  toposlam draw worlds/shape-8.toml --marker directional --pose 0.1,7.5,80 \\
    --seed 8 --out view.png
  toposlam sense view.png --calibration camera.toml --colours colours.toml",
        &[(0, "the colours are learned"), (2, "bad usage or input"), (3, "interrupted")],
    )
)]
pub(super) struct TrainArguments {
    /// Folder of the images: .png, .jpg and .jpeg
    #[arg(long, value_name = "DIR")]
    images: PathBuf,
    /// Folder of the labels: .png
    #[arg(long, value_name = "DIR")]
    labels: PathBuf,
    /// Camera calibration
    #[arg(long, value_name = "FILE")]
    calibration: PathBuf,
    /// Output file: .toml
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    /// The stripe between floor and wall: a tape on the floor along the wall, or a baseboard at the foot of the
    /// wall, and its width in metres, across the floor or up the wall
    #[arg(long, value_name = "floor|wall=METRES", default_value = "floor=0.05", value_parser = stripe)]
    stripe: Stripe,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// The number of parts for cross-validation, if there are as many images: each part is classified with the colours
/// learned from the others.
const FOLDS: usize = 5;

/// An image and its labels.
struct Pair {
    image: PathBuf,
    labels: PathBuf,
}

impl TrainArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        output::check_place(&self.out, &["toml"])?;
        let camera = input::read_camera(&self.calibration)?;
        let pairs = self.pairs()?;
        let progress = Progress::new("learning", "images")?;
        progress.parts(pairs.len());
        let (mut training, mut left_out) = (Training::new(self.stripe), Vec::new());
        for pair in pairs {
            if progress.stop() {
                progress.finish();
                return Err(CliError::Interrupted);
            }
            if let Some(cause) = learn(&mut training, &camera, &pair)? {
                let (image, reason) = (pair.image.display().to_string(), cause.to_string());
                left_out.push(LeftOut { image, reason });
            }
            progress.part_done(1);
        }
        progress.finish();
        for LeftOut { image, reason } in &left_out {
            remark!("left out: {image}: {reason}");
        }
        self.check_classes(&training)?;
        if training.seen(PixelClass::Marker).images == 0 {
            remark!("no marker is labelled: sensing with these colours sees no marker");
        }
        let model = training.model().map_err(|error| CliError::in_file(&self.images, error))?;
        let progress = Progress::new("cross-validating", "parts")?;
        let folds = FOLDS.min(training.images());
        let validation = training.cross_validate(folds, &progress);
        progress.finish();
        let validation = match validation {
            Ok(confusion) => Ok((folds, confusion)),
            Err(TrainingError::Interrupted(stopped)) => return Err(stopped.into()),
            Err(TrainingError::Folds { .. }) => {
                Err("there is only one image to learn from".to_owned())
            }
            Err(error) => Err(error.to_string()),
        };
        output::write_whole(&self.out, model.to_toml().as_bytes())?;
        let report = TrainingReport::new(&training, left_out, self.stripe, validation);
        if self.json {
            print_line(out, "training", &report)?;
        } else {
            report.print(out)?;
        }
        Ok(Outcome::Holds)
    }

    /// Pairs each image with its labels by name.
    fn pairs(&self) -> Result<Vec<Pair>, CliError> {
        let images = by_stem(&self.images, &["png", "jpg", "jpeg"])?;
        let mut labels = by_stem(&self.labels, &["png"])?;
        if images.is_empty() {
            let cause = "there is no image in this folder: no .png, .jpg or .jpeg";
            return Err(CliError::in_file(&self.images, cause));
        }
        let pairs: Result<Vec<Pair>, CliError> = images
            .into_iter()
            .map(|(stem, image)| {
                let labels = labels.remove(&stem).ok_or_else(|| {
                    let expected = named(&self.labels, &stem);
                    let cause = format!("its labels, {}, are not there", expected.display());
                    CliError::in_file(&image, cause)
                })?;
                Ok(Pair { image, labels })
            })
            .collect();
        let pairs = pairs?;
        match labels.values().next() {
            None => Ok(pairs),
            Some(alone) => {
                let images = self.images.display();
                let cause = format!("there is no image of this name in {images}");
                Err(CliError::in_file(alone, cause))
            }
        }
    }

    /// Returns an error if a class is missing that sensing needs.
    fn check_classes(&self, training: &Training) -> Result<(), CliError> {
        if training.images() == 0 {
            return Err(CliError::in_file(&self.images, "every image was left out"));
        }
        let needed = [PixelClass::Floor, PixelClass::Stripe];
        match needed.into_iter().find(|&class| training.seen(class).images == 0) {
            None => Ok(()),
            Some(class) => {
                let [red, green, blue] = class.label();
                let missing = TrainingError::NoPixel { class };
                let cause = format!("{missing} ({red},{green},{blue})");
                Err(CliError::in_file(&self.labels, cause))
            }
        }
    }
}

/// Parses where the stripe is, and its width.
fn stripe(text: &str) -> Result<Stripe, String> {
    let (place, width) = text.split_once('=').unwrap_or((text, "0.05"));
    let kind = match place {
        "floor" => StripeKind::OnFloor,
        "wall" => StripeKind::OnWall,
        _ => return Err("write floor or wall, with a width as in wall=0.1".to_owned()),
    };
    let [least, most] = Stripe::WIDTHS;
    let width = width.parse().ok().filter(|width| (least..=most).contains(width));
    let width = width
        .ok_or_else(|| format!("the width of a stripe lies between {least} and {most} metres"))?;
    Ok(Stripe { kind, width })
}

/// The files in a folder with one of these endings, by name without the ending.
fn by_stem(folder: &Path, endings: &[&str]) -> Result<BTreeMap<OsString, PathBuf>, CliError> {
    let unreadable =
        |error| CliError::in_file(folder, format!("cannot be read as a folder: {error}"));
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        // Skip hidden files: other programs keep their own images there.
        let hidden = path.file_name().is_some_and(|name| name.as_encoded_bytes().starts_with(b"."));
        let ending = path.extension().and_then(OsStr::to_str).map(str::to_ascii_lowercase);
        let fits = ending.is_some_and(|ending| endings.contains(&ending.as_str()));
        if fits && !hidden && !path.is_dir() {
            paths.push(path);
        }
    }
    paths.sort();
    let mut files = BTreeMap::new();
    for path in paths {
        let stem = path.file_stem().unwrap_or_default().to_owned();
        if let Some(other) = files.insert(stem, path.clone()) {
            let cause = format!("its labels would be those of {}", other.display());
            return Err(CliError::in_file(&path, cause));
        }
    }
    Ok(files)
}

/// The path of a label image.
fn named(folder: &Path, stem: &OsStr) -> PathBuf {
    let mut name = stem.to_owned();
    name.push(".png");
    folder.join(name)
}

/// Learns from an image, or returns why it was left out.
fn learn(
    training: &mut Training,
    camera: &Camera,
    pair: &Pair,
) -> Result<Option<ExampleError>, CliError> {
    let image = picture_file::read(&pair.image, camera.image)?;
    let labels = read_labels(&pair.labels, camera.image)?;
    match training.add(camera, &image, &labels) {
        Ok(()) => Ok(None),
        Err(cause @ ExampleError::Light(_)) => Ok(Some(cause)),
        Err(cause @ ExampleError::ImageSize { .. }) => Err(CliError::in_file(&pair.image, cause)),
        Err(cause) => Err(CliError::in_file(&pair.labels, cause)),
    }
}

fn read_labels(path: &Path, expected: [u32; 2]) -> Result<RgbImage, CliError> {
    picture_file::read_if(path, |found| {
        if found == expected { Ok(()) } else { Err(ExampleError::LabelSize { found, expected }) }
    })
}
