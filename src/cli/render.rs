//! `toposlam render`: what the robot's camera would see from a pose in a floor plan. Section 2.5.

use std::{io::Write, path::PathBuf};

use toposlam_model::{
    embedded_graph::Dart,
    floor_plan::{FloorPlan, JunctionKind},
};
use toposlam_robot::simulator::{
    Building, EffectScope, KNOBS, Pose, Rig, label_mask, labels, render, start_pose,
};
use toposlam_vision::camera::Camera;

use super::{
    Failure, Outcome,
    appearance::{Appearance, ImageSize},
    input, output,
    picture_file::encoded,
};

/// Render what the robot's camera would see from a pose in a floor plan
#[derive(clap::Args)]
#[command(after_help = after_help())]
pub(super) struct RenderArguments {
    /// The floor plan
    plan: PathBuf,
    /// Where the robot is, in metres, x to the east, y to the north, and its heading in degrees
    /// counter-clockwise from east [default: at the plan's start, its back to the facing hallway]
    #[arg(long, value_name = "X,Y,HEADING", value_parser = read_pose, allow_hyphen_values = true)]
    pose: Option<Pose>,
    /// The file to write: .png, .jpg or .jpeg
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// The camera [default: a spherical mirror, 1280x960]
    #[arg(long, value_name = "FILE")]
    calibration: Option<PathBuf>,
    /// Width and height of the picture, in pixels [default: the camera's]
    #[arg(long, value_name = "SIZE")]
    size: Option<ImageSize>,
    #[command(flatten)]
    appearance: Appearance,
    /// From which everything follows that is left to chance
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Put the marker at the plan's start, along the facing hallway; without a start at the first L
    #[arg(long)]
    marker: bool,
    /// Also write what each pixel shows, as a .png: floor green, stripe red, marker blue, anything
    /// else black, the robot and what lies beyond the mirror white
    #[arg(long, value_name = "FILE")]
    labels: Option<PathBuf>,
}

impl RenderArguments {
    pub(super) fn run(self, _: &mut dyn Write) -> Result<Outcome, Failure> {
        output::check_place(&self.out, &["png", "jpg", "jpeg"])?;
        if let Some(path) = &self.labels {
            output::check_place(path, &["png"])?;
        }
        let world = input::read_world(&self.plan)?;
        let plan = input::floor_plan(&self.plan, &world)?;
        let camera = self.camera()?;
        let pose = self.pose.unwrap_or_else(|| start_pose(plan, world.start.unwrap_or(Dart(0))));
        let marker = if self.marker { Some(self.marked(plan, world.start)?) } else { None };
        let effects = self.appearance.effects(self.seed)?;
        let building = Building::new(plan, self.appearance.look, marker, &effects, self.seed);
        if !building.has_floor(pose.position) {
            let [x, y] = pose.position;
            return Err(Failure::at("--pose", format!("there is no floor at {x},{y}")));
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

    fn camera(&self) -> Result<Camera, Failure> {
        let camera = match &self.calibration {
            Some(path) => input::read_camera(path)?,
            None => Camera::superscout(),
        };
        Ok(match self.size {
            Some(size) => camera.sized(size.pixels()),
            None => camera,
        })
    }

    /// The dart that the marker points along.
    fn marked(&self, plan: &FloorPlan, start: Option<Dart>) -> Result<Dart, Failure> {
        let graph = plan.graph();
        let at_l = |dart: &Dart| plan.junction(graph.vertex(*dart)).kind == JunctionKind::L;
        start
            .or_else(|| graph.darts().find(at_l))
            .ok_or_else(|| Failure::in_file(&self.plan, "there is neither a start nor an L in it"))
    }
}

fn read_pose(text: &str) -> Result<Pose, String> {
    let numbers: Option<Vec<f64>> = text
        .split(',')
        .map(|number| number.trim().parse().ok().filter(|number: &f64| number.is_finite()))
        .collect();
    match numbers.as_deref() {
        Some(&[x, y, degrees]) => Ok(Pose { position: [x, y], heading: degrees.to_radians() }),
        _ => Err("write three numbers: x,y,heading, as in 2,4,90".to_owned()),
    }
}

/// The effects, and an example.
fn after_help() -> String {
    let mut text = "Effects, the range that each is drawn from, and what it is:\n".to_owned();
    for (of, title) in
        [(EffectScope::Building, "Of the building:"), (EffectScope::Picture, "Of the picture:")]
    {
        text.extend(["  ", title, "\n"]);
        for knob in KNOBS.iter().filter(|knob| knob.of == of) {
            let range = format!("{}..{}", knob.default.start(), knob.default.end());
            let head = format!("    {:<14} {range:<12} ", knob.name);
            text += &hanging(&head, knob.about);
        }
    }
    text + "\nExample:\n  toposlam render worlds/shape-8.toml --pose 2,8,0 --look vinyl \
            --effect blur=1.5 --out view.png"
}

/// Words in lines of a hundred columns, those after the first as far in as the head is long.
fn hanging(head: &str, words: &str) -> String {
    let (mut text, mut line) = (String::new(), head.trim_end().to_owned());
    let mut gap = head.len() - line.len();
    for word in words.split(' ') {
        if line.len() + gap + word.len() > 98 {
            text += &line;
            text.push('\n');
            (line, gap) = (String::new(), head.len());
        }
        line += &" ".repeat(gap);
        line += word;
        gap = 1;
    }
    text + &line + "\n"
}
