//! `toposlam draw WORLD`.

use std::{
    io::Write,
    path::{Path, PathBuf},
};

use clap::ValueEnum;

use toposlam::picture::{Picture, png, svg};

use toposlam_model::format::dot;

use super::{Failure, Outcome, input, output};

/// Draw a world: its vertices with their doors in clockwise order, and its start
#[derive(clap::Args)]
#[command(
    after_help = "Example:\n  toposlam draw worlds/figure-1a.toml --start x:a --out figure-1a.png"
)]
pub(super) struct Arguments {
    /// The world file
    world: PathBuf,
    /// Where the marker lies and points, instead of the file's [start]
    #[arg(long, value_name = "VERTEX:FACING")]
    start: Option<String>,
    /// The file to write, its format by its ending: .svg, .png or .dot; without it, standard output
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// The format, where the ending of the file does not say it; SVG by default
    #[arg(long, value_enum)]
    format: Option<Format>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// A drawing that scales
    Svg,
    /// An image
    Png,
    /// A text that Graphviz draws
    Dot,
}

impl Arguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, Failure> {
        let format = self.format()?;
        let mut world = input::read_world(&self.world)?;
        if let Some(text) = &self.start {
            world.start = Some(input::start_of(&world, Some(text))?);
        }
        let drawn = || svg(&Picture::from(&world));
        let bytes = match format {
            Format::Svg => drawn().into_bytes(),
            Format::Png => png(&drawn()).map_err(|error| Failure::in_file(&self.world, error))?,
            Format::Dot => dot::write(&world).into_bytes(),
        };
        match &self.out {
            Some(path) => output::write_whole(path, &bytes)?,
            None => out.write_all(&bytes)?,
        }
        Ok(Outcome::Holds)
    }

    /// What to write. A format that contradicts the ending of the file is refused.
    fn format(&self) -> Result<Format, Failure> {
        let ending = self.out.as_deref().and_then(Path::extension);
        let said = match ending.map(std::ffi::OsStr::to_ascii_lowercase) {
            Some(ending) if ending == "png" => Some(Format::Png),
            Some(ending) if ending == "svg" => Some(Format::Svg),
            Some(ending) if ending == "dot" => Some(Format::Dot),
            _ => None,
        };
        match (self.format, said, &self.out) {
            (Some(asked), Some(said), Some(path)) if asked != said => Err(Failure::in_file(
                path,
                "--format and the ending of the file say different things",
            )),
            (None, None, Some(path)) if ending.is_some() => Err(Failure::in_file(
                path,
                "a picture's name ends in .svg, .png or .dot, or --format says what it is",
            )),
            (Some(format), ..) | (None, Some(format), _) => Ok(format),
            (None, None, _) => Ok(Format::Svg),
        }
    }
}
