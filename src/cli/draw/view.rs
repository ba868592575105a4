//! `toposlam draw PLAN --pose POSE`: the image that the robot's camera takes from a pose. Section 2.5.

use std::{
    io::Write,
    path::{Path, PathBuf},
};

use clap::Arg;
use toposlam_model::{
    aid::AidKind,
    driving::pose::Pose,
    embedded_graph::Dart,
    floor_plan::{FloorPlan, JunctionKind},
    marker::{Directional, NoMarker},
};
use toposlam_simulator::{
    Building, EffectScope, KNOBS, Rig, label_mask, labels, render, start_pose,
};
use toposlam_vision::camera::Camera;

use crate::cli::{
    CliError,
    appearance::{Appearance, ImageSize, camera_with},
    input, output,
    picture_file::encoded,
    text::{print_hanging, three_numbers},
};

/// Where a camera takes an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ViewPose {
    /// At the plan's start, with the back to the facing hallway.
    Start,
    At(Pose),
}

/// The image that a robot's camera takes in a floor plan.
#[derive(clap::Args)]
#[command(next_help_heading = "The view of a robot's camera")]
#[group(id = "view")]
pub(super) struct ViewOptions {
    /// Draw what the robot's camera sees in a floor plan: .png, .jpg or .jpeg. Position in metres (x east, y
    /// north) and heading in degrees counter-clockwise from east; start is the plan's start
    #[arg(long, value_name = "X,Y,HEADING", value_parser = parse_pose, allow_hyphen_values = true,
        requires = "out", conflicts_with = "start")]
    pose: Option<ViewPose>,
    /// Camera calibration [default: a spherical mirror, 1280x960]
    #[arg(long, value_name = "FILE")]
    calibration: Option<PathBuf>,
    /// Image size in pixels [default: the camera's]
    #[arg(long, value_name = "SIZE")]
    size: Option<ImageSize>,
    #[command(flatten)]
    appearance: Appearance,
    /// Random seed
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Also write the class of each pixel as a .png: floor green, stripe red, marker blue, the robot and
    /// the area outside the mirror white, anything else black
    #[arg(long, value_name = "FILE")]
    labels: Option<PathBuf>,
}

impl ViewOptions {
    /// Where the camera is, if its image is to be drawn.
    pub(super) fn pose(&self) -> Option<ViewPose> {
        self.pose
    }

    /// Writes the image.
    pub(super) fn write(
        &self,
        path: &Path,
        at: ViewPose,
        marker: Option<AidKind>,
        out: &Path,
    ) -> Result<(), CliError> {
        let is_marked = match marker.map(AidKind::name) {
            None => false,
            Some(name) if name == NoMarker.name() => false,
            Some(name) if name == Directional.name() => true,
            Some(_) => {
                let cause = "with --pose, the marker is directional, or there is none";
                return Err(CliError::at("--marker", cause));
            }
        };
        output::check_place(&self.labels, &["png"])?;
        let world = input::read_world(path)?;
        let plan = input::floor_plan(path, &world)?;
        let effects = self.appearance.effects(self.seed)?;
        let camera = camera_with(&effects, &self.camera()?)?;
        let pose = match at {
            ViewPose::Start => start_pose(plan, world.start.unwrap_or(Dart(0))),
            ViewPose::At(pose) => pose,
        };
        let marker = if is_marked { Some(marked(path, plan, world.start)?) } else { None };
        let building = Building::new(plan, self.appearance.look, marker, &effects, self.seed);
        if !building.has_floor(pose.position) {
            let [x, y] = pose.position;
            return Err(CliError::at("--pose", format!("there is no floor at {x},{y}")));
        }
        let rig = Rig::new(&camera);
        let picture = encoded(out, &render(&rig, &building, pose, &effects, self.seed))?;
        let mask = match &self.labels {
            Some(path) => {
                let mask = label_mask(&rig, &labels(&rig, &building, pose, &effects));
                Some((path, encoded(path, &mask)?))
            }
            None => None,
        };
        output::write_whole(out, &picture)?;
        if let Some((path, mask)) = mask {
            output::write_whole(path, &mask)?;
        }
        Ok(())
    }

    fn camera(&self) -> Result<Camera, CliError> {
        let camera = match &self.calibration {
            Some(path) => input::read_camera(path)?,
            None => Camera::superscout(),
        };
        Ok(match self.size {
            Some(size) => camera.sized(size.pixels()),
            None => camera,
        })
    }
}

/// The dart along which the marker points.
fn marked(path: &Path, plan: &FloorPlan, start: Option<Dart>) -> Result<Dart, CliError> {
    let graph = plan.graph();
    let at_l = |dart: &Dart| plan.junction(graph.vertex(*dart)).kind == JunctionKind::L;
    start
        .or_else(|| graph.darts().find(at_l))
        .ok_or_else(|| CliError::in_file(path, "it has neither a start nor an L"))
}

fn parse_pose(text: &str) -> Result<ViewPose, String> {
    if text == "start" {
        return Ok(ViewPose::Start);
    }
    let [x, y, degrees] =
        three_numbers(text).ok_or("write three numbers: x,y,heading, as in 2,4,90, or start")?;
    Ok(ViewPose::At(Pose { position: [x, y], heading: degrees.to_radians() }))
}

/// The options of a view need `--pose`. Clap does not ask for it beside the options that exclude it, so they exclude
/// these, too.
pub(super) fn only_with_a_pose(option: Arg) -> Arg {
    match option.get_id().as_str() {
        "effect" => option
            .help("Set one effect; none sets all others to nothing (repeatable). They are listed below")
            .requires("pose")
            .conflicts_with("start"),
        "calibration" | "size" | "look" | "seed" | "labels" => {
            option.requires("pose").conflicts_with("start")
        }
        _ => option,
    }
}

pub(super) fn list_of_effects() -> String {
    let mut text = b"Effects, with the range from which each is drawn:\n".to_vec();
    for (scope, title) in
        [(EffectScope::Building, "Of the building:"), (EffectScope::Image, "Of the image:")]
    {
        // Writing to memory does not fail.
        let _ = writeln!(text, "  {title}");
        for knob in KNOBS.iter().filter(|knob| knob.scope == scope) {
            let (start, end) = (knob.default.start(), knob.default.end());
            let range = if start < end { format!("{start}..{end}") } else { start.to_string() };
            let _ = print_hanging(
                &mut text,
                &format!("    {:<14} {range:<12} ", knob.name),
                knob.about,
            );
        }
    }
    String::from_utf8_lossy(&text).into_owned()
}
