//! `toposlam sense FILE...`: the scene in each panoramic image, or what the laser scans of a log show.
//! Section 3.

mod scans;

use std::{
    collections::BTreeMap,
    ffi::{OsStr, OsString},
    io::Write,
    path::{Path, PathBuf},
};

use serde::Serialize;
use toposlam_model::driving::scene::Scene;
use toposlam_vision::{annotate, camera::Camera, sensing::Sensor};

use scans::ScanRange;

use super::{
    CliError, Outcome,
    exit_codes::help_end,
    input,
    json::{print_line, print_unread},
    laser_options::LaserOptions,
    outcome::SeveralInputs,
    output, picture_file,
    progress::must_stop,
    scene::{SceneLine, rows},
    text::print_hanging,
};

/// Find hallway, junction and marker in panoramic images, or junctions in laser scans
///
/// Each image is a PNG or JPEG of the robot's camera. The result is one of three: the robot's place in
/// a hallway; a junction with its doors and centre lines; or unknown, with a reason. If the marker is
/// in view, its position is reported too.
///
/// A log with laser scans and odometry is read from its beginning. Whenever the robot has moved on, the
/// result is the junctions of the local map: what one live view shows. `conform` uses the whole log, and
/// may find others.
#[derive(clap::Args)]
#[command(after_help = help_end(
    "\
Example:
  toposlam sense view.png --calibration camera.toml --colours colours.toml \\
    --stages steps
  toposlam sense run.mcap --scans 60..=70 --stages steps

A file that cannot be used is reported, and the others are sensed.

Angles and positions are relative to the robot's heading, counter-clockwise. Doors are listed \
clockwise from the entry door.",
    &[
        (0, "all images and scans were sensed, also if a scene is unknown"),
        (2, "bad usage, or an input cannot be used"),
        (3, "interrupted"),
    ],
))]
pub(super) struct SenseArguments {
    /// Images (.png or .jpg), or logs with laser scans
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Camera calibration, for images
    #[arg(long, value_name = "FILE")]
    calibration: Option<PathBuf>,
    /// Colours of the building, from `toposlam camera train`, for images
    #[arg(long, value_name = "FILE")]
    colours: Option<PathBuf>,
    /// For logs: the numbers of the scans that are reported, counted from 0 [default: all]
    #[arg(long, value_name = "N|A..=B")]
    scans: Option<ScanRange>,
    /// For logs: what each topic carries [default: by the message types]
    #[arg(long, value_name = "FILE")]
    topics: Option<PathBuf>,
    #[command(flatten)]
    laser: LaserOptions,
    /// Folder for a picture of each processing stage of each image or scan
    #[arg(long, value_name = "DIR")]
    stages: Option<PathBuf>,
    /// Print one JSON object per image or scan
    #[arg(long)]
    json: bool,
}

/// What `--json` prints of an image.
#[derive(Serialize)]
struct ImageReport {
    image: String,
    #[serde(flatten)]
    scene: SceneLine,
}

impl SenseArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        self.check_options()?;
        input::register(&self.files)?;
        let camera = self.calibration.as_deref().map(input::read_camera).transpose()?;
        let colours = self.colours.as_deref().map(input::read_colours).transpose()?;
        let names = stage_names(&self.files, self.stages.is_some())?;
        if let Some(folder) = &self.stages {
            output::make_folder(folder)?;
        }
        let camera = camera.as_ref();
        let mut eye = camera
            .zip(colours.as_ref())
            .map(|(camera, colours)| (camera, Sensor::new(camera, colours)));
        self.sense_all(&mut eye, &names, out)?.worst()
    }

    /// Returns an error for an option that is missing, or has no effect.
    fn check_options(&self) -> Result<(), CliError> {
        let any_image = self.files.iter().any(|path| is_image(path));
        let any_log = self.files.iter().any(|path| !is_image(path));
        let for_images =
            [("--calibration", self.calibration.is_some()), ("--colours", self.colours.is_some())];
        let wrong = for_images.into_iter().find(|(_, is_given)| *is_given != any_image);
        let for_logs = self.scans.map(|_| "--scans");
        let for_logs = for_logs.or(self.topics.as_ref().map(|_| "--topics")).or(self.laser.given());
        match (wrong, for_logs) {
            (Some((option, false)), _) => Err(CliError::at(option, "this is needed for images")),
            (Some((option, true)), _) => {
                Err(CliError::at(option, "this is for images, and no input is an image"))
            }
            (None, Some(option)) if !any_log => {
                Err(CliError::at(option, "this is for laser scans, and no input is a log"))
            }
            _ if any_log && self.stages.is_some() && self.scans.is_none() => {
                let cause =
                    "for a log this needs --scans: there is a picture for each step of each scan";
                Err(CliError::at("--stages", cause))
            }
            _ => Ok(()),
        }
    }

    /// Senses all files and prints what is seen. A file that cannot be used is reported.
    fn sense_all(
        &self,
        eye: &mut Option<(&Camera, Sensor)>,
        names: &[OsString],
        out: &mut dyn Write,
    ) -> Result<SeveralInputs, CliError> {
        let mut inputs = SeveralInputs::default();
        for (path, name) in self.files.iter().zip(names) {
            if must_stop() {
                inputs.add::<()>(Err(CliError::Interrupted));
                break;
            }
            let sensed = match eye {
                Some((camera, sensor)) if is_image(path) => {
                    self.sense_image(camera, sensor, path, name, out)
                }
                _ => self.sense_scans(path, out),
            };
            if let (true, Err(error @ CliError::Input(_))) = (self.json, &sensed) {
                print_unread(out, &path.display().to_string(), &error.cause_in(path))?;
            }
            inputs.add(sensed.map(|()| ((), Outcome::Holds)));
            out.flush()?;
        }
        Ok(inputs)
    }

    /// Senses an image and prints its scene.
    fn sense_image(
        &self,
        camera: &Camera,
        sensor: &mut Sensor,
        path: &Path,
        name: &OsString,
        out: &mut dyn Write,
    ) -> Result<(), CliError> {
        let scene = self.scene(camera, sensor, path, name)?;
        if self.json {
            let image = path.display().to_string();
            return print_line(
                out,
                "image",
                &ImageReport { image, scene: SceneLine::from(&scene) },
            );
        }
        writeln!(out, "{}", path.display())?;
        for (label, text) in rows(&scene) {
            print_hanging(out, &format!("  {label:<12}"), &text)?;
        }
        Ok(())
    }

    /// The scene of an image. Writes the pictures of the stages.
    fn scene(
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
            picture_file::write_stage(&folder.join(name), &annotate::legend(stage), picture)?;
        }
        Ok(scene)
    }
}

/// Whether a file is an image. Folders, and files with the ending of a log, are logs.
fn is_image(path: &Path) -> bool {
    let ending = path.extension().and_then(OsStr::to_str).map(str::to_ascii_lowercase);
    !path.is_dir() && !ending.is_some_and(|ending| LOGS.contains(&&*ending))
}

/// The endings of logs that can have laser scans.
const LOGS: [&str; 7] = ["mcap", "bag", "db3", "log", "clf", "gz", "zst"];

/// The names of the files without their endings. The pictures of their stages start with them.
fn stage_names(files: &[PathBuf], wanted: bool) -> Result<Vec<OsString>, CliError> {
    let mut names: BTreeMap<OsString, &Path> = BTreeMap::new();
    let name = |path: &PathBuf| input::stem(path);
    for path in files {
        if let Some(other) = names.insert(name(path), path)
            && wanted
        {
            let cause =
                format!("its pictures would have the same names as those of {}", other.display());
            return Err(CliError::in_file(path, cause));
        }
    }
    Ok(files.iter().map(name).collect())
}
