//! `toposlam sense IMAGE...`: the scene in each panoramic image. Section 3.

use std::{
    collections::BTreeMap,
    ffi::OsString,
    io::Write,
    path::{Path, PathBuf},
};

use serde::Serialize;
use toposlam_model::driving::scene::Scene;
use toposlam_vision::{annotate, camera::Camera, sensing::Sensor};

use super::{
    CliError, Outcome,
    exit_codes::help_end,
    input,
    json::print_line,
    outcome::SeveralInputs,
    output, picture_file,
    scene::{SceneLine, rows},
    text::print_hanging,
};

/// Find hallway, junction and marker in panoramic images
///
/// Each image is a PNG or JPEG of the robot's camera. The result is one of three: the robot's place in
/// a hallway; a junction with its doors and centre lines; or unknown, with a reason. If the marker is
/// in view, its position is reported too.
#[derive(clap::Args)]
#[command(after_help = help_end(
    "\
Example:
  toposlam sense view.png --calibration camera.toml --colours colours.toml \\
    --stages steps

An image that cannot be used is reported, and the others are sensed.

Angles are relative to the robot's heading, counter-clockwise. Doors are listed
clockwise from the entry door.",
    &[
        (0, "all images were sensed, also if a scene is unknown"),
        (2, "bad usage, or an input cannot be used"),
    ],
))]
pub(super) struct SenseArguments {
    /// Images: .png or .jpg
    #[arg(required = true, value_name = "IMAGE")]
    images: Vec<PathBuf>,
    /// Camera calibration
    #[arg(long, value_name = "FILE")]
    calibration: PathBuf,
    /// Colours of the building, from `toposlam train`
    #[arg(long, value_name = "FILE")]
    colours: PathBuf,
    /// Folder for a picture of each processing stage of each image
    #[arg(long, value_name = "DIR")]
    stages: Option<PathBuf>,
    /// Print one JSON object per image
    #[arg(long)]
    json: bool,
    /// Output file: .txt, .json or .jsonl [default: standard output]
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// The JSON line of an image.
#[derive(Serialize)]
struct Line {
    image: String,
    #[serde(flatten)]
    scene: SceneLine,
}

impl SenseArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        if let Some(path) = &self.out {
            output::check_place(path, &["json", "jsonl", "txt"])?;
        }
        input::register(&self.images)?;
        let camera = input::read_camera(&self.calibration)?;
        let colours = input::read_colours(&self.colours)?;
        let names = stage_names(&self.images, self.stages.is_some())?;
        if let Some(folder) = &self.stages {
            output::make_folder(folder)?;
        }
        let mut sensor = Sensor::new(&camera, &colours);
        match &self.out {
            None => self.sense_all(&camera, &mut sensor, &names, out)?.worst(),
            Some(path) => {
                let mut text = Vec::new();
                let inputs = self.sense_all(&camera, &mut sensor, &names, &mut text)?;
                // Without any scene there is nothing to write.
                if !text.is_empty() {
                    output::write_whole(path, &text)?;
                }
                inputs.worst()
            }
        }
    }

    /// Senses all images and prints their scenes. An image that cannot be used is reported.
    fn sense_all(
        &self,
        camera: &Camera,
        sensor: &mut Sensor,
        names: &[OsString],
        out: &mut dyn Write,
    ) -> Result<SeveralInputs, CliError> {
        let mut inputs = SeveralInputs::new();
        for (path, name) in self.images.iter().zip(names) {
            let sensed = self.sense(camera, sensor, path, name);
            let sensed = sensed.map(|scene| (scene, Outcome::Holds));
            let Some(scene) = inputs.add(sensed) else { continue };
            if self.json {
                let image = path.display().to_string();
                print_line(out, "image", &Line { image, scene: SceneLine::from(&scene) })?;
            } else {
                writeln!(out, "{}", path.display())?;
                for (label, text) in rows(&scene) {
                    print_hanging(out, &format!("  {label:<12}"), &text)?;
                }
            }
            out.flush()?;
        }
        Ok(inputs)
    }

    /// The scene of an image. Writes the pictures of the stages.
    fn sense(
        &self,
        camera: &Camera,
        sensor: &mut Sensor,
        path: &Path,
        name: &OsString,
    ) -> Result<Scene, CliError> {
        let image = picture_file::read(path, camera.image)?;
        let wrong = |error| CliError::in_file(path, error);
        let Some(folder) = &self.stages else { return sensor.sense(&image).map_err(wrong) };
        let (scene, stages) = annotate::stages(sensor, &image).map_err(wrong)?;
        for (stage, picture) in &stages {
            let mut name = name.clone();
            name.push(format!("-{stage}.png"));
            picture_file::write_stage(&folder.join(name), stage, picture)?;
        }
        Ok(scene)
    }
}

/// The names of the images without their endings. The pictures of their stages start with them.
fn stage_names(images: &[PathBuf], wanted: bool) -> Result<Vec<OsString>, CliError> {
    let mut names: BTreeMap<OsString, &Path> = BTreeMap::new();
    let name = |path: &PathBuf| input::stem(path);
    for path in images {
        if let Some(other) = names.insert(name(path), path)
            && wanted
        {
            let cause =
                format!("its pictures would have the same names as those of {}", other.display());
            return Err(CliError::in_file(path, cause));
        }
    }
    Ok(images.iter().map(name).collect())
}
