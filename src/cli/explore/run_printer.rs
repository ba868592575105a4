//! What is printed of a run while it goes on.

use std::io::{self, Write};

use toposlam_model::mapping::{MapWalk, MappingEvent, Observer};

use super::{doors_writer::DoorsWriter, summary::Summary};
use crate::story::PrintedStory;

/// Prints a run.
pub(super) enum RunPrinter<'o, W: Write> {
    /// The beginning of a JSON object.
    Doors(DoorsWriter<'o, W>),
    /// Counts, at the end.
    Summary(Summary, &'o mut W),
    /// Each round.
    Story(Box<PrintedStory<&'o mut W>>),
}

impl<W: Write> RunPrinter<'_, W> {
    /// Prints what is left after the run.
    pub(super) fn finish(self) -> io::Result<()> {
        match self {
            Self::Doors(doors) => doors.finish(),
            Self::Summary(summary, out) => summary.print(out),
            Self::Story(story) => story.finish().map(|_| ()),
        }
    }
}

impl<W: ?Sized, O: Write> Observer<W> for RunPrinter<'_, O> {
    fn event(&mut self, world: &mut W, journey: &MapWalk, event: MappingEvent) {
        match self {
            Self::Doors(doors) => doors.event(world, journey, event),
            Self::Summary(summary, _) => summary.event(world, journey, event),
            Self::Story(story) => story.event(world, journey, event),
        }
    }
}
