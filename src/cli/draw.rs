//! `toposlam draw WORLD`.

mod view;

use std::{
    ffi::OsStr,
    io::Write,
    path::{Path, PathBuf},
};

use toposlam_model::aid::AidKind;

use super::{CliError, Outcome, aid_kinds, exit_codes::help_end, input, output, write_drawing};
use view::ViewOptions;

use crate::picture::{WorldPicture, svg};

/// Draw a world, or what a robot's camera sees in a floor plan
///
/// A picture of a world shows the clockwise order of the doors at each vertex, and the start.
#[derive(clap::Args)]
#[command(after_help = help_end(
    &format!("\
{}
Examples:
  toposlam draw worlds/figure-1a.toml --start x:a --out figure-1a.png
  toposlam draw worlds/shape-8.toml --pose 2,8,0 --look vinyl \\
    --effect blur=1.5 --out view.png", view::list_of_effects()),
    &[(0, "the picture is written"), (2, "bad usage or input"), (3, "interrupted")],
))]
#[command(mut_args(view::only_with_a_pose))]
pub(super) struct DrawArguments {
    /// The world file
    world: PathBuf,
    /// Where the robot and its marker start [default: the start in the file]
    #[arg(long, value_name = "VERTEX:FACING")]
    start: Option<String>,
    /// Kind of marker [default: the one in the file, or else directional; with --pose, none]. With --pose, a
    /// directional one lies at the plan's start, along the facing hallway, or, without a start, at the first L
    #[arg(long, value_name = "KIND", value_parser = aid_kinds())]
    marker: Option<AidKind>,
    /// The file to write: .svg, .png or .dot [default: standard output, as SVG]
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    view: ViewOptions,
}

impl DrawArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        if let (Some(pose), Some(out)) = (self.view.pose(), &self.out) {
            output::check_place(out, &["png", "jpg", "jpeg"])?;
            self.view.write(&self.world, pose, self.marker, out)?;
            return Ok(Outcome::Holds);
        }
        output::check_place(&self.out, &["svg", "png", "dot"])?;
        let ending = self.out.as_deref().and_then(Path::extension).and_then(OsStr::to_str);
        if ending == Some("dot") && self.marker.is_some() {
            return Err(CliError::at("--marker", "a DOT file does not show the marker"));
        }
        let mut world = input::read_world(&self.world)?;
        world.marker = self.marker.or(world.marker);
        if let Some(text) = &self.start {
            world.start = Some(input::start_of(&world, Some(text))?);
        }
        match &self.out {
            Some(path) if ending == Some("dot") => output::write_world(path, &world)?,
            Some(path) => write_drawing(path, &svg(&WorldPicture::from(&world)))?,
            None => out.write_all(svg(&WorldPicture::from(&world)).as_bytes())?,
        }
        Ok(Outcome::Holds)
    }
}
