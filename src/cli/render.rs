//! `toposlam render`: the image that the robot's camera takes from a pose. Section 2.5.

use std::{io::Write, path::PathBuf};

use toposlam_model::{
    driving::pose::Pose,
    embedded_graph::Dart,
    floor_plan::{FloorPlan, JunctionKind},
};
use toposlam_robot::simulator::{
    Building, EffectScope, KNOBS, Rig, label_mask, labels, render, start_pose,
};
use toposlam_vision::camera::Camera;

use super::{
    CliError, Outcome,
    appearance::{Appearance, ImageSize, camera_with},
    exit_codes::help_end,
    input, output,
    picture_file::encoded,
    text::{print_hanging, three_numbers},
};

/// Render the image that the robot's camera takes from a pose in a floor plan
#[derive(clap::Args)]
#[command(after_help = after_help())]
#[command(mut_arg("effect", |effect| effect.help("Set one effect (repeatable); they are listed below")))]
pub(super) struct RenderArguments {
    /// Floor plan
    plan: PathBuf,
    /// Position in metres (x east, y north) and heading in degrees counter-clockwise from east
    /// [default: the plan's start, with the back to the facing hallway]
    #[arg(long, value_name = "X,Y,HEADING", value_parser = parse_pose, allow_hyphen_values = true)]
    pose: Option<Pose>,
    /// Output file: .png, .jpg or .jpeg
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
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
    /// Put the marker at the plan's start, along the facing hallway, or, without a start, at the first L
    #[arg(long)]
    with_marker: bool,
    /// Also write the class of each pixel as a .png: floor green, stripe red, marker blue, the robot and
    /// the area outside the mirror white, anything else black
    #[arg(long, value_name = "FILE")]
    labels: Option<PathBuf>,
}

impl RenderArguments {
    pub(super) fn run(self, _: &mut dyn Write) -> Result<Outcome, CliError> {
        output::check_place(&self.out, &["png", "jpg", "jpeg"])?;
        if let Some(path) = &self.labels {
            output::check_place(path, &["png"])?;
        }
        let world = input::read_world(&self.plan)?;
        let plan = input::floor_plan(&self.plan, &world)?;
        let effects = self.appearance.effects(self.seed)?;
        let camera = camera_with(&effects, &self.camera()?)?;
        let pose = self.pose.unwrap_or_else(|| start_pose(plan, world.start.unwrap_or(Dart(0))));
        let marker = if self.with_marker { Some(self.marked(plan, world.start)?) } else { None };
        let building = Building::new(plan, self.appearance.look, marker, &effects, self.seed);
        if !building.has_floor(pose.position) {
            let [x, y] = pose.position;
            return Err(CliError::at("--pose", format!("there is no floor at {x},{y}")));
        }
        let rig = Rig::new(&camera);
        let picture = render(&rig, &building, pose, &effects, self.seed);
        let picture = encoded(&self.out, &picture)?;
        let mask = match &self.labels {
            Some(path) => {
                let mask = label_mask(&rig, &labels(&rig, &building, pose, &effects));
                Some((path, encoded(path, &mask)?))
            }
            None => None,
        };
        output::write_whole(&self.out, &picture)?;
        if let Some((path, mask)) = mask {
            output::write_whole(path, &mask)?;
        }
        Ok(Outcome::Holds)
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

    /// The dart along which the marker points.
    fn marked(&self, plan: &FloorPlan, start: Option<Dart>) -> Result<Dart, CliError> {
        let graph = plan.graph();
        let at_l = |dart: &Dart| plan.junction(graph.vertex(*dart)).kind == JunctionKind::L;
        start
            .or_else(|| graph.darts().find(at_l))
            .ok_or_else(|| CliError::in_file(&self.plan, "it has neither a start nor an L"))
    }
}

fn parse_pose(text: &str) -> Result<Pose, String> {
    let [x, y, degrees] =
        three_numbers(text).ok_or("write three numbers: x,y,heading, as in 2,4,90")?;
    Ok(Pose { position: [x, y], heading: degrees.to_radians() })
}

/// The list of effects, and an example.
fn after_help() -> String {
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
    let example = "\nExample:\n  toposlam render worlds/shape-8.toml --pose 2,8,0 --look vinyl \\\n    \
                   --effect blur=1.5 --out view.png";
    let notes = String::from_utf8_lossy(&text).into_owned() + example;
    help_end(&notes, &[(0, "the image is written"), (2, "bad usage or input")])
}
