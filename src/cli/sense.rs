//! `toposlam sense IMAGE...`: what the sensing module sees in panoramic images. Section 3.

use std::{
    collections::BTreeMap,
    ffi::OsString,
    io::Write,
    path::{Path, PathBuf},
};

use serde::Serialize;
use toposlam_vision::{annotate, camera::Camera, sensing::Sensor};

use super::{
    Failure, Outcome, input,
    json::print_object,
    output, picture_file,
    scene::{SceneLine, in_words},
};

/// Tell what is to be seen in panoramic images: hallway, junction and marker
///
/// From one image of the robot's camera (PNG or JPEG), how it lies in a hallway, or which junction it
/// is at, entered from where, with its centre lines; or that the image does not tell, and why; and
/// where the marker lies.
#[derive(clap::Args)]
#[command(after_help = "\
Example:
  toposlam sense view.png --calibration camera.toml --colours colours.toml --stages steps

Angles are relative to the robot's heading, counter-clockwise; doors stand clockwise from the entry.")]
pub(super) struct SenseArguments {
    /// The images
    #[arg(required = true, value_name = "IMAGE")]
    images: Vec<PathBuf>,
    /// The calibration of the camera
    #[arg(long, value_name = "FILE")]
    calibration: PathBuf,
    /// The colours of the building, as `toposlam train` learned them
    #[arg(long, value_name = "FILE")]
    colours: PathBuf,
    /// The folder for a picture of each step of sensing, for each image
    #[arg(long, value_name = "DIR")]
    stages: Option<PathBuf>,
    /// Print one JSON object for each image
    #[arg(long)]
    json: bool,
    /// The file to write [default: standard output]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// What `--json` prints for an image.
#[derive(Serialize)]
struct Line {
    schema: u32,
    image: String,
    #[serde(flatten)]
    scene: SceneLine,
}

impl SenseArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, Failure> {
        if let Some(path) = &self.out {
            output::check_place(path, &["json", "jsonl", "txt"])?;
        }
        let camera = input::read_camera(&self.calibration)?;
        let colours = input::read_colours(&self.colours)?;
        let names = stage_names(&self.images, self.stages.is_some())?;
        if let Some(folder) = &self.stages {
            output::make_folder(folder)?;
        }
        let mut sensor = Sensor::new(&camera, &colours);
        match &self.out {
            None => self.sense(&camera, &mut sensor, &names, out)?,
            Some(path) => {
                let mut text = Vec::new();
                self.sense(&camera, &mut sensor, &names, &mut text)?;
                output::write_whole(path, &text)?;
            }
        }
        Ok(Outcome::Holds)
    }

    fn sense(
        &self,
        camera: &Camera,
        sensor: &mut Sensor,
        names: &[OsString],
        out: &mut dyn Write,
    ) -> Result<(), Failure> {
        for (path, name) in self.images.iter().zip(names) {
            let image = picture_file::read(path, camera.image)?;
            let wrong = |error| Failure::in_file(path, error);
            let scene = match &self.stages {
                None => sensor.sense(&image).map_err(wrong)?,
                Some(folder) => {
                    let (scene, stages) = annotate::stages(sensor, &image).map_err(wrong)?;
                    for (stage, picture) in &stages {
                        let mut name = name.clone();
                        name.push(format!("-{stage}.png"));
                        picture_file::write(&folder.join(name), picture)?;
                    }
                    scene
                }
            };
            if self.json {
                let image = path.display().to_string();
                print_object(out, &Line { schema: 1, image, scene: SceneLine::from(&scene) })?;
            } else {
                writeln!(out, "{}: {}", path.display(), in_words(&scene))?;
            }
            out.flush()?;
        }
        Ok(())
    }
}

/// How the pictures of the steps of each image begin: as the image is called, without its ending.
fn stage_names(images: &[PathBuf], wanted: bool) -> Result<Vec<OsString>, Failure> {
    let mut names: BTreeMap<OsString, &Path> = BTreeMap::new();
    let name = |path: &PathBuf| path.file_stem().unwrap_or_default().to_owned();
    for path in images {
        if let Some(other) = names.insert(name(path), path)
            && wanted
        {
            let cause = format!("its pictures would be called as those of {}", other.display());
            return Err(Failure::in_file(path, cause));
        }
    }
    Ok(images.iter().map(name).collect())
}
